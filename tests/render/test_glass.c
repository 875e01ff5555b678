// The round container: its lines lie where its rim, its foot and its outlines are, and nowhere else.
#include "tests/render/harness.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 400
#define HEIGHT 300
#define PI 3.14159265358979323846

// The inside is as wide as the shorter side of the box, 0.8 m; the wall is as thick as glass.glsl says.
static const double centre[2] = {1, 0.4}, inner = 0.4, outer = 0.4 / 0.96, bottom = 0.1, top = 1.1;

static TestFrame *glass_frame(void) {
  TestFrame *t = test_frame_create(1, 0.0175f);
  t->frame.container = (SimContainer){{0, 0.1f, 0}, {2, 1.1f, 0.8f}, SIM_CONTAINER_GLASS};
  return t;
}

static RenderSettings grey_settings(void) {
  RenderSettings settings = harness_pinned_settings();
  const float colours[2][3] = {{0.2f, 0.2f, 0.2f}, {0.2f, 0.2f, 0.2f}};
  memcpy(settings.floor_colour, colours, sizeof colours);
  memcpy(settings.sky_horizon, (float[3]){0.5f, 0.5f, 0.5f}, sizeof settings.sky_horizon);
  memcpy(settings.sky_zenith, (float[3]){0.9f, 0.9f, 0.9f}, sizeof settings.sky_zenith);
  settings.floor_level = 0.1f;
  return settings;
}

// What drawing the container adds to the green of every pixel.
static int *container_shows(const RenderView *view, const TestFrame *t) {
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  RenderSettings settings = grey_settings();
  uint8_t *without = harness_draw(&harness, &t->frame, view, &settings);
  settings.container_visible = true;
  uint8_t *with = harness_draw(&harness, &t->frame, view, &settings);
  int *added = malloc(sizeof *added * WIDTH * HEIGHT);
  for (int i = 0; i < WIDTH * HEIGHT; ++i) added[i] = with[3 * i + 1] - without[3 * i + 1];
  free(without);
  free(with);
  harness_close(&harness);
  return added;
}

// ---- Where the lines are ---------------------------------------------------------------------------------------------

typedef struct Lines {
  double pixel[4000][2];
  int count;
} Lines;

static void add_point(Lines *lines, const RenderView *view, double angle, double radius, double y) {
  const double p[3] = {centre[0] + radius * cos(angle), y, centre[1] + radius * sin(angle)};
  double pixel[2];
  if (harness_project(view, WIDTH, HEIGHT, p, pixel) < 0.05) return;
  memcpy(lines->pixel[lines->count++], pixel, sizeof pixel);
}

static void add_circle(Lines *lines, const RenderView *view, double radius, double y) {
  for (int i = 0; i < 720; ++i) add_point(lines, view, i * PI / 360, radius, y);
}

// Where a line from the eye touches the cylinder: found by trying angles, the outward normal is across the line there.
static void add_outlines(Lines *lines, const RenderView *view) {
  const double ex = (double)view->eye[0] - centre[0], ez = (double)view->eye[2] - centre[1];
  double last = 0;
  for (int i = 0; i <= 36000; ++i) {
    const double angle = i * PI / 18000;
    const double facing = (ex - outer * cos(angle)) * cos(angle) + (ez - outer * sin(angle)) * sin(angle);
    if (i > 0 && (facing > 0) != (last > 0)) {
      for (int k = 0; k < 400; ++k) add_point(lines, view, angle, outer, bottom + (top - bottom) * k / 400);
    }
    last = facing;
  }
}

static double distance_to(const Lines *lines, double x, double y) {
  double best = 1e30;
  for (int i = 0; i < lines->count; ++i) best = fmin(best, hypot(lines->pixel[i][0] - x, lines->pixel[i][1] - y));
  return best;
}

static int brightest_near(const int *added, const double pixel[2]) {
  int best = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const int x = (int)floor(pixel[0]) + dx, y = (int)floor(pixel[1]) + dy;
      if (x >= 0 && x < WIDTH && y >= 0 && y < HEIGHT && added[y * WIDTH + x] > best) best = added[y * WIDTH + x];
    }
  }
  return best;
}

static void check_lines(const RenderView *view, bool outlines) {
  TestFrame *t = glass_frame();
  int *added = container_shows(view, t);
  Lines *lines = calloc(1, sizeof *lines);
  add_circle(lines, view, outer, top);
  add_circle(lines, view, inner, top);
  add_circle(lines, view, outer, bottom);
  const int circles = lines->count;
  add_outlines(lines, view);
  assert_int_equal(lines->count > circles, outlines);
  int seen = 0;
  for (int i = 0; i < lines->count; ++i) {
    const double *p = lines->pixel[i];
    if (p[0] < 2 || p[0] > WIDTH - 2 || p[1] < 2 || p[1] > HEIGHT - 2) continue;
    ++seen;
    if (brightest_near(added, p) < 25) fail_msg("no line at %.1f, %.1f (point %d)", p[0], p[1], i);
  }
  assert_true(seen > 300);
  for (int i = 0; i < WIDTH * HEIGHT; ++i) {
    const double distance = distance_to(lines, i % WIDTH + 0.5, i / WIDTH + 0.5);
    if (added[i] > 60 && distance > 4) fail_msg("a line at %d, %d, %.1f pixels off", i % WIDTH, i / WIDTH, distance);
    if (abs(added[i]) > 5 && distance > 4 && !outlines) fail_msg("%d, %d is changed", i % WIDTH, i / WIDTH);
  }
  free(lines);
  free(added);
  test_frame_destroy(t);
}

static void test_from_above(void **state) {
  (void)state;
  const RenderView view = harness_view(0.3f, 2.2f, 3, 1, 0.55f, 0.4f, 36);
  check_lines(&view, true);
}

static void test_close_up(void **state) {
  (void)state;
  const RenderView view = harness_view(1.5f, 1.3f, 1.0f, 1, 1.0f, 0.4f, 60);
  check_lines(&view, true);
}

// From within, no wall turns its outside to the eye: neither outlines nor panes, only the circles.
static void test_from_within(void **state) {
  (void)state;
  const RenderView view = harness_view(1.1f, 0.8f, 0.5f, 1, 0.1f, 0.2f, 100);
  check_lines(&view, false);
}

// The wall is nearly clear in the middle and shows more of itself towards the outlines, the same on both sides.
static void test_wall(void **state) {
  (void)state;
  const RenderView view = harness_view(1, 0.6f, 4, 1, 0.6f, 0.4f, 24);
  TestFrame *t = glass_frame();
  int *added = container_shows(&view, t);
  double pixel[2];
  const double edge[3] = {centre[0] - outer, 0.6, centre[1]};
  harness_project(&view, WIDTH, HEIGHT, edge, pixel);
  const int left = (int)pixel[0], row = HEIGHT / 2 + 30, middle = row * WIDTH + WIDTH / 2;
  const int near_edge = row * WIDTH + left + 5, mirrored = row * WIDTH + WIDTH - 1 - left - 5;
  assert_in_range(added[middle], 1, 12);
  assert_true(added[near_edge] > 2 * added[middle]);
  assert_true(abs(added[near_edge] - added[mirrored]) <= 1);
  // Outside there is nothing.
  for (int x = 0; x < left - 6; ++x) assert_int_equal(added[row * WIDTH + x], 0);
  free(added);
  test_frame_destroy(t);
}

// The sun gleams upright on the wall, on the side that it comes from; without it there is no gleam.
static void test_gleam(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  TestFrame *t = glass_frame();
  const RenderView view = harness_view(1, 0.9f, 4, 1, 0.6f, 0.4f, 24);
  RenderSettings settings = grey_settings();
  settings.container_visible = true;
  uint8_t *dull = harness_draw(&harness, &t->frame, &view, &settings);
  settings.sun = true;
  memcpy(settings.sun_direction, (float[3]){-1, 1, 0.2f}, sizeof settings.sun_direction);
  uint8_t *sunny = harness_draw(&harness, &t->frame, &view, &settings);
  const int row = HEIGHT / 2;
  int brightest = 0;
  for (int x = 120; x < WIDTH - 120; ++x) {
    const int i = 3 * (row * WIDTH + x);
    if (sunny[i] - dull[i] > sunny[3 * (row * WIDTH + brightest)] - dull[3 * (row * WIDTH + brightest)]) brightest = x;
  }
  // Halfway between the ways to eye and sun, seen from above.
  const double to_eye = PI / 2, to_sun = atan2(0.2, -1), angle = (to_eye + to_sun) / 2;
  const double p[3] = {centre[0] + outer * cos(angle), 0.6, centre[1] + outer * sin(angle)};
  double pixel[2];
  harness_project(&view, WIDTH, HEIGHT, p, pixel);
  assert_true(fabs(brightest + 0.5 - pixel[0]) < 4);
  assert_true(sunny[3 * (row * WIDTH + brightest)] - dull[3 * (row * WIDTH + brightest)] > 20);
  free(dull);
  free(sunny);
  test_frame_destroy(t);
  harness_close(&harness);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_from_above), cmocka_unit_test(test_close_up), cmocka_unit_test(test_from_within),
      cmocka_unit_test(test_wall),       cmocka_unit_test(test_gleam),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
