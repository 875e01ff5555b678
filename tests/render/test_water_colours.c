// Colours of particles in the style "heightfield": means of columns, apart for what hangs over, and what they do to a picture.
#include "render/water_colours.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/render/harness.h"

#define WIDTH 160
#define HEIGHT 120
#define PIXELS ((size_t)WIDTH * HEIGHT)
#define SPACING 0.04f
#define LEVEL 0.5f
enum { NODES = 41, COUNT = NODES * NODES, MOST = 4 * COUNT };

static const float dark_red[3] = {0.6f, 0.2f, 0.1f}, blue[3] = {0.1f, 0.3f, 0.9f};

typedef struct Pool {
  TestFrame *frame;
  float height[COUNT], underside[COUNT], second[COUNT];
  float colour[3 * MOST];
  uint8_t classes[MOST];
} Pool;

// Level water in a tank of 1.6 × 1.6 m.
static Pool *pool_create(void) {
  Pool *s = calloc(1, sizeof *s);
  assert_non_null(s);
  s->frame = test_frame_create(MOST, SPACING / 2);
  SimFrame *frame = &s->frame->frame;
  frame->container = (SimContainer){.min = {0, 0, 0}, .max = {1.6f, 1.2f, 1.6f}};
  memcpy(frame->bounds_max, frame->container.max, sizeof frame->bounds_max);
  for (int node = 0; node < COUNT; ++node) s->height[node] = LEVEL;
  memset(s->classes, SIM_AGGREGATED, sizeof s->classes);
  frame->height_field = (SimHeightField){
      .size = {NODES, NODES}, .spacing = SPACING, .height = s->height, .underside = s->underside, .second = s->second};
  frame->colour = s->colour;
  frame->particle_class = s->classes;
  return s;
}

static void pool_destroy(Pool *s) {
  test_frame_destroy(s->frame);
  free(s);
}

static void add(Pool *s, float x, float y, float z, const float colour[3]) {
  memcpy(s->colour + 3 * s->frame->frame.count, colour, sizeof dark_red);
  test_frame_add(s->frame, x, y, z);
}

// A particle under every node whose column is from `first` to `last`.
static void add_columns(Pool *s, int first, int last, float y, const float colour[3]) {
  for (int node = 0; node < COUNT; ++node) {
    if (node % NODES < first || node % NODES > last) continue;
    add(s, SPACING * (float)(node % NODES), y, SPACING * (float)(node / NODES), colour);
  }
}

static const float *find(RenderWaterColours *colours, const Pool *s) {
  RenderError error = {0};
  if (!render_water_colours_find(colours, &s->frame->frame, &s->frame->frame.height_field, &error))
    fail_msg("%s", error.message);
  return colours->sums;
}

static void expect_colour(const float *value, const float want[3]) {
  for (int c = 0; c < 3; ++c) {
    if (fabsf(value[c] - want[c]) > 1e-5f)
      fail_msg("channel %d: %g instead of %g", c, (double)value[c], (double)want[c]);
  }
}

static void test_means(void **state) {
  (void)state;
  Pool *s = pool_create();
  RenderWaterColours colours = {0};
  add_columns(s, 0, 14, 0.1f, dark_red);
  add_columns(s, 0, 14, 0.3f, blue); // the mean of both
  add_columns(s, 15, 20, 0.2f, blue);
  const float *below = find(&colours, s), mean[3] = {0.35f, 0.25f, 0.5f}, clear[3] = {1, 1, 1};
  assert_int_equal(colours.size[0], NODES);
  assert_true(fabsf(colours.thin - 3 * SPACING / 2) < 1e-6f);
  for (int node = 0; node < COUNT; ++node) {
    const int column = node % NODES;
    if (column < 14) expect_colour(below + 4 * node, mean);
    if (column > 15 && column <= 24) expect_colour(below + 4 * node, blue); // and on, where there are no particles
    if (column > 24) expect_colour(below + 4 * node, clear);
    expect_colour(below + 4 * (COUNT + node), clear); // nothing hangs over
  }
  render_water_colours_destroy(&colours);
  pool_destroy(s);
}

static void test_what_hangs_over(void **state) {
  (void)state;
  Pool *s = pool_create();
  RenderWaterColours colours = {0};
  for (int node = 0; node < COUNT; ++node) s->height[node] = 0.9f, s->underside[node] = 0.8f, s->second[node] = LEVEL;
  add_columns(s, 0, NODES, 0.2f, dark_red);
  add_columns(s, 0, NODES, 0.85f, blue);
  const float *below = find(&colours, s);
  for (int node = 0; node < COUNT; ++node) {
    expect_colour(below + 4 * node, dark_red);
    expect_colour(below + 4 * (COUNT + node), blue);
  }
  render_water_colours_destroy(&colours);
  pool_destroy(s);
}

// More nodes than places; particles anywhere; none; no colours.
static void test_odd_frames(void **state) {
  (void)state;
  Pool *s = pool_create();
  RenderWaterColours colours = {0};
  const float odd[3] = {NAN, -INFINITY, 7};
  const float where[] = {NAN, INFINITY, -1e30f, 1e30f, -0.01f, 1.61f};
  for (size_t i = 0; i < sizeof where / sizeof where[0]; ++i) {
    add(s, where[i], 0.1f, 0.4f, odd);
    add(s, 0.4f, where[i], 0.4f, odd);
    add(s, 0.4f, 0.1f, where[i], odd);
  }
  const float *values = find(&colours, s);
  for (int i = 0; i < 4 * 2 * COUNT; ++i) assert_true(values[i] >= 0 && values[i] < RENDER_FARTHEST);
  const int32_t many[2] = {4 * COUNT, 10};
  memcpy(s->frame->frame.height_field.size, many, sizeof many);
  s->frame->frame.height_field.underside = NULL;
  find(&colours, s);
  assert_true(colours.size[0] * colours.size[1] <= 30000 && colours.size[0] > 1000);
  s->frame->frame.count = 0;
  find(&colours, s);
  assert_false(colours.any);
  s->frame->frame.count = 1;
  s->frame->frame.colour = NULL;
  find(&colours, s);
  assert_false(colours.any);
  render_water_colours_destroy(&colours);
  pool_destroy(s);
}

// Without sky and sun a pixel is what comes up from the floor: water of one colour takes from it what it says, by the length of the
// way in it. White water is clear.
static void test_picture(void **state) {
  Harness *harness = *state;
  Pool *s = pool_create();
  const float white[3] = {1, 1, 1};
  RenderSettings settings = harness_pinned_settings();
  settings.style = "heightfield";
  settings.sun = false;
  for (int k = 0; k < 3; ++k) {
    settings.scattering[k] = settings.absorption[k] = 0;
    settings.floor_colour[0][k] = settings.floor_colour[1][k] = 0.9f;
    settings.sky_zenith[k] = settings.sky_horizon[k] = 0;
  }
  const RenderView view = harness_view(0.8f, 2.5f, 1.9f, 0.8f, LEVEL, 0.8f, 24);
  s->frame->frame.colour = NULL;
  uint8_t *clear = harness_draw(harness, &s->frame->frame, &view, &settings);
  s->frame->frame.colour = s->colour;
  add_columns(s, 0, NODES, 0.2f, white);
  uint8_t *whitened = harness_draw(harness, &s->frame->frame, &view, &settings);
  assert_memory_equal(clear, whitened, 3 * PIXELS);
  for (int i = 0; i < s->frame->frame.count; ++i) memcpy(s->colour + 3 * i, dark_red, sizeof dark_red);
  uint8_t *red = harness_draw(harness, &s->frame->frame, &view, &settings);
  double sums[3] = {0}, wanted[3] = {0};
  int inner = 0;
  for (int32_t y = 0; y < HEIGHT; ++y) {
    for (int32_t x = 0; x < WIDTH; ++x) {
      const Ray ray = harness_ray(&view, WIDTH, HEIGHT, x, y);
      const double t = ((double)LEVEL - ray.origin[1]) / ray.direction[1];
      const double at[2] = {ray.origin[0] + t * ray.direction[0], ray.origin[2] + t * ray.direction[2]};
      const size_t pixel = 3 * ((size_t)y * WIDTH + (size_t)x);
      if (!(t > 0 && fmin(at[0], at[1]) > 0.5 && fmax(at[0], at[1]) < 1.1)) continue;
      ++inner;
      for (int c = 0; c < 3; ++c) { // some 13 times the length in which 1 − 1/e of the colour show
        sums[c] += red[pixel + (size_t)c];
        wanted[c] += clear[pixel + (size_t)c] * (double)dark_red[c];
      }
    }
  }
  assert_true(inner > 1000);
  for (int c = 0; c < 3; ++c) {
    print_message("channel %d: %.2f in the mean, %.2f by the colour\n", c, sums[c] / inner, wanted[c] / inner);
    assert_true(fabs(sums[c] - wanted[c]) / inner < 0.5);
  }
  free(clear);
  free(whitened);
  free(red);
  pool_destroy(s);
}

static int open_group(void **state) {
  return harness_open_group(state, WIDTH, HEIGHT);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_means),
      cmocka_unit_test(test_what_hangs_over),
      cmocka_unit_test(test_odd_frames),
      cmocka_unit_test(test_picture),
  };
  return cmocka_run_group_tests(tests, open_group, harness_close_group);
}
