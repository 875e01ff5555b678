// The second layer of the style "heightfield": a level sheet of water in the air against the formula, what it must leave alone, drops
// around it, and fields that nobody checked.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/drops.h"
#include "render/overhang.h"
#include "tests/render/degenerate.h"
#include "tests/render/harness.h"

#define WIDTH 320
#define HEIGHT 240
#define PIXELS ((size_t)WIDTH * HEIGHT)
#define SPACING 0.04f
#define PI 3.14159265358979323846
#define TOP 0.8
#define UNDERSIDE 0.7
enum { NODES = 101, COUNT = NODES * NODES };

static const RenderView above = {{2.2f, 2.3f, 4.8f}, {2, 0.4f, 2.1f}, 34};

typedef struct Pool {
  TestFrame *frame;
  float height[COUNT], underside[COUNT], second[COUNT];
} Pool;

static void set_node(Pool *s, int node, float height, float underside, float second) {
  s->height[node] = height;
  s->underside[node] = underside;
  s->second[node] = second;
}

// A tank of 4 × 4 m, with water up to `level`; 0: dry.
static Pool *pool_create(float level) {
  Pool *s = calloc(1, sizeof *s);
  assert_non_null(s);
  s->frame = test_frame_create(8, SPACING / 2);
  SimFrame *frame = &s->frame->frame;
  frame->container = (SimContainer){.min = {0, 0, 0}, .max = {4, 1.2f, 4}};
  memcpy(frame->bounds_max, frame->container.max, sizeof frame->bounds_max);
  for (int node = 0; node < COUNT; ++node) set_node(s, node, level, 0, 0);
  frame->height_field = (SimHeightField){
      .size = {NODES, NODES}, .spacing = SPACING, .height = s->height, .underside = s->underside, .second = s->second};
  return s;
}

static void pool_destroy(Pool *s) {
  test_frame_destroy(s->frame);
  free(s);
}

// A sheet over the nodes whose columns and rows are from `first` to `last`.
static void hang(Pool *s, int first, int last, float top, float underside) {
  for (int k = first; k <= last; ++k)
    for (int i = first; i <= last; ++i) set_node(s, k * NODES + i, top, underside, s->height[k * NODES + i]);
}

static RenderSettings settings_of_style(void) {
  RenderSettings settings = harness_pinned_settings();
  settings.style = "heightfield";
  settings.heightfield.second_layer = true;
  for (int k = 0; k < 3; ++k) settings.scattering[k] = 0;
  const float colours[4][3] = {{0.9f, 0.7f, 0.5f}, {0.2f, 0.3f, 0.4f}, {0.1f, 0.3f, 0.9f}, {0.8f, 0.9f, 0.7f}};
  memcpy(settings.floor_colour, colours, 2 * sizeof colours[0]);
  memcpy(settings.sky_zenith, colours[2], sizeof colours[2]);
  memcpy(settings.sky_horizon, colours[3], sizeof colours[3]);
  return settings;
}

// ---- A level sheet -------------------------------------------------------------------------------------------------------

static double fresnel(double cosine, double index) {
  const double bent = sqrt(1 - (1 - cosine * cosine) / (index * index));
  const double across = (cosine - index * bent) / (cosine + index * bent);
  const double along = (index * cosine - bent) / (index * cosine + bent);
  return 0.5 * (across * across + along * along);
}

// What the pixel of a ray shows: the sheet mirrors the sky and lets through, bent aside, the floor, in water of the depth `level`
// or dry. false where rays are near the border of something.
static bool truth_of(const RenderSettings *s, const Ray *ray, double level, double rgb[3]) {
  double d[3], length = 0;
  for (int k = 0; k < 3; ++k) length += ray->direction[k] * ray->direction[k];
  for (int k = 0; k < 3; ++k) d[k] = ray->direction[k] / sqrt(length);
  if (d[1] > -0.05) return false;
  const double index = (double)s->refractive_index, down = sqrt(1 - (1 - d[1] * d[1]) / (index * index));
  // Along a unit of x or z: outside straight on, in water less.
  const double outside = (ray->origin[1] - TOP + UNDERSIDE - level) / -d[1];
  const double inside = (TOP - UNDERSIDE + level) / down / index, tile = (double)s->tile_size;
  const double top = (ray->origin[1] - TOP) / -d[1], x = ray->origin[0] + top * d[0], z = ray->origin[2] + top * d[2];
  const double fx = ray->origin[0] + (outside + inside) * d[0], fz = ray->origin[2] + (outside + inside) * d[2];
  if (!(x > 1 && x < 3 && z > 1 && z < 3 && fx > 0.1 && fx < 3.9 && fz > 0.1 && fz < 3.9)) return false;
  const double u = fx / tile - floor(fx / tile), v = fz / tile - floor(fz / tile);
  if (fmin(fmin(u, 1 - u), fmin(v, 1 - v)) < 0.1) return false;
  const float *square = s->floor_colour[((int)floor(fx / tile) + (int)floor(fz / tile)) & 1];
  const double one = fresnel(-d[1], index), through = (1 - one) / (1 + one); // both faces, any number of times
  for (int k = 0; k < 3; ++k) {
    const double sky = (double)s->sky_horizon[k] - d[1] * ((double)s->sky_zenith[k] - (double)s->sky_horizon[k]);
    const double deep = level > 0 ? exp(-(double)s->absorption[k] * level / down) : 1, mirror = level > 0 ? one : 0;
    const double below = mirror * sky + (1 - mirror) * deep * (double)square[k];
    rgb[k] = (1 - through) * sky + through * below * exp(-(double)s->absorption[k] * (TOP - UNDERSIDE) / down);
  }
  return true;
}

static int by_size(const void *a, const void *b) {
  const int x = *(const uint8_t *)a, y = *(const uint8_t *)b;
  return (x > y) - (x < y);
}

static void expect_truth(Harness *harness, double level, int degrees) {
  Pool *s = pool_create((float)level);
  hang(s, 10, 90, (float)TOP, (float)UNDERSIDE);
  const RenderSettings settings = settings_of_style();
  const double turn = degrees * PI / 180;
  const RenderView view =
      harness_view(2, (float)(TOP + 4 * sin(turn)), 2 + (float)(4 * cos(turn)), 2, (float)TOP, 2, 20);
  uint8_t *drawn = harness_draw(harness, &s->frame->frame, &view, &settings), *off = malloc(3 * PIXELS);
  assert_non_null(off);
  size_t count = 0;
  double mean = 0;
  for (int32_t y = 0; y < HEIGHT; ++y) {
    for (int32_t x = 0; x < WIDTH; ++x) {
      const Ray ray = harness_ray(&view, WIDTH, HEIGHT, x, y);
      double rgb[3];
      if (!truth_of(&settings, &ray, level, rgb)) continue;
      for (int k = 0; k < 3; ++k) {
        off[count] = (uint8_t)abs(drawn[3 * (y * WIDTH + x) + k] - (int)lrint(255 * fmin(rgb[k], 1)));
        mean += off[count++];
      }
    }
  }
  assert_true(count > PIXELS / 4);
  qsort(off, count, 1, by_size);
  print_message("over %g m of water, %d degrees: %zu values, differences %.2f in the mean, %d at 95 %%\n", level,
                degrees, count, mean / (double)count, off[(count - 1) * 95 / 100]);
  assert_true(mean / (double)count < 0.5 && off[(count - 1) * 95 / 100] <= 2);
  free(off);
  free(drawn);
  pool_destroy(s);
}

static void test_level_sheet(void **state) {
  for (int degrees = 20; degrees <= 70; degrees += 25) {
    expect_truth(*state, 0, degrees);
    expect_truth(*state, 0.3, degrees);
  }
}

// ---- What is left alone ----------------------------------------------------------------------------------------------------

static void draw_both(Harness *harness, const Pool *s, const RenderSettings *a, const RenderSettings *b, bool same) {
  uint8_t *first = harness_draw(harness, &s->frame->frame, &above, a);
  uint8_t *second = harness_draw(harness, &s->frame->frame, &above, b);
  assert_int_equal(memcmp(first, second, 3 * PIXELS) == 0, same);
  free(first);
  free(second);
}

// Without water that hangs over the switch changes nothing; off, there is no second layer.
static void test_switch(void **state) {
  Harness *harness = *state;
  Pool *s = pool_create(0.3f);
  const RenderSettings on = settings_of_style();
  RenderSettings off = on;
  off.heightfield.second_layer = false;
  draw_both(harness, s, &on, &off, true);
  hang(s, 40, 60, 0.8f, 0.7f);
  draw_both(harness, s, &on, &off, false);
  s->frame->frame.height_field.underside = s->frame->frame.height_field.second = NULL;
  RenderError error = {0};
  assert_false(render_draw(harness->render, &s->frame->frame, &above, &on, &error));
  assert_non_null(strstr(error.message, "second layer"));
  assert_int_equal(render_style_needs("heightfield", &on) ^ render_style_needs("heightfield", &off),
                   SIM_NEED_SECOND_LAYER);
  assert_int_equal(render_style_needs("points", &on), render_style_needs("points", NULL));
  pool_destroy(s);
}

// A lip at a wave: the water below it, the sheet, and how far that goes on into the wave, ever lower, so that its end is hidden.
static void test_water_below(void **state) {
  (void)state;
  Pool *s = pool_create(0.3f);
  for (int node = 0; node < COUNT; ++node)
    if (node % NODES < 40) set_node(s, node, 0.9f, 0, 0);
  for (int node = 0; node < COUNT; ++node)
    if (node % NODES >= 40 && node % NODES < 50) set_node(s, node, 0.85f, 0.7f, 0.3f);
  RenderOverhang overhang = {0};
  RenderError error;
  assert_true(render_overhang_find(&overhang, &s->frame->frame, 1, &error));
  const float *below = overhang.nodes, *top = below + COUNT, *underside = top + COUNT;
  for (int node = 0; node < COUNT; ++node) {
    const int column = node % NODES;
    assert_true(below[node] == (column < 40 ? 0.9f : 0.3f));
    if (column >= 40 && column < 50) assert_true(top[node] == 0.85f && underside[node] == 0.7f);
    if (column >= 36 && column < 40) assert_true(top[node] == 0.9f && underside[node] < 0.7f); // into the wave
    if (column < 36 || column >= 50) assert_true(isnan(top[node]) && isnan(underside[node]));
  }
  assert_int_equal(overhang.low[0], 36);
  assert_int_equal(overhang.high[0], 49);
  render_overhang_destroy(&overhang);
  pool_destroy(s);
}

static void test_drops_around(void **state) {
  (void)state;
  Pool *s = pool_create(0.3f);
  hang(s, 40, 60, 0.8f, 0.7f);
  SimFrame *frame = &s->frame->frame;
  const float heights[] = {0.2f, 0.5f, 0.75f, 0.66f, 0.9f};
  const bool want[] = {false, true, false, true, true};
  const uint8_t classes[8] = {SIM_SPLASH, SIM_SPLASH, SIM_SPLASH, SIM_SPLASH, SIM_SPLASH, SIM_SPLASH};
  for (int i = 0; i < 5; ++i) test_frame_add(s->frame, 2, heights[i], 2);
  test_frame_add(s->frame, 3.5f, 0.75f, 2); // as high as the sheet, but beside it
  frame->particle_class = classes;
  SimHeightField lowest = frame->height_field;
  lowest.height = s->second;
  for (int node = 0; node < COUNT; ++node) s->second[node] = 0.3f;
  for (int i = 0; i < 5; ++i) assert_int_equal(render_is_drop(frame, &lowest, i), want[i]);
  assert_true(render_is_drop(frame, &lowest, 5));
  const float nowhere[3] = {-5, NAN, INFINITY};
  assert_false(render_in_overhang(&frame->height_field, nowhere, 0.1f));
  pool_destroy(s);
}

// ---- Fields that nobody checked --------------------------------------------------------------------------------------------

static void expect_clean(Harness *harness, const char *what, const Pool *s, const RenderView *view) {
  const RenderSettings settings = settings_of_style();
  degenerate_expect_clean(harness, what, &s->frame->frame, view, &settings);
}

static void test_absurd_fields(void **state) {
  Harness *harness = *state;
  Pool *s = pool_create(0.3f);
  const RenderView eyes[] = {above, harness_view(2, 0.75f, 2, 2.5f, 0.7f, 2, 40),
                             harness_view(2, 0.5f, 2, 2, 2, 2.01f, 40), harness_view(2, 0.5f, 3.9f, 2, 0.6f, 2, 60)};
  s->frame->frame.height_field.size[0] = s->frame->frame.height_field.size[1] = 41;
  s->frame->frame.height_field.spacing = 0.1f;
  for (int places = 0; places < DEGENERATE_PLACES; ++places) {
    float *const arrays[] = {s->height, s->underside, s->second};
    for (int array = 0; array < 3; ++array) {
      for (int node = 0; node < COUNT; ++node) set_node(s, node, 0.8f, 0.7f, 0.3f);
      for (int node = 0; node < COUNT; node += 3) arrays[array][node] = degenerate_places[places];
      expect_clean(harness, "some heights are absurd", s, &above);
    }
  }
  for (int node = 0; node < COUNT; ++node) set_node(s, node, 0.8f, 0.7f, 0.3f);
  for (size_t i = 0; i < sizeof eyes / sizeof eyes[0]; ++i)
    expect_clean(harness, "a sheet from wall to wall", s, &eyes[i]);
  for (int node = 0; node < COUNT; ++node) set_node(s, node, 0.8f, node % 2 ? 0.7f : 0, node % 2 ? 0 : 0.3f);
  expect_clean(harness, "every other node hangs", s, &above);
  for (int node = 0; node < COUNT; ++node) set_node(s, node, 0.7f, 0.8f, 0.9f);
  expect_clean(harness, "upside down", s, &above);
  for (int node = 0; node < COUNT; ++node) set_node(s, node, 0.8f, 0.7f, 0.3f);
  s->frame->frame.container.shape = SIM_CONTAINER_GLASS;
  expect_clean(harness, "in a glass", s, &above);
  s->frame->frame.has_container = false;
  expect_clean(harness, "without a container", s, &above);
  const int32_t sizes[][2] = {{0, 0}, {1, 1}, {2, 1}, {1, 2}, {3, 3}};
  for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
    memcpy(s->frame->frame.height_field.size, sizes[i], sizeof sizes[i]);
    expect_clean(harness, "few nodes", s, &above);
  }
  pool_destroy(s);
}

static int open_group(void **state) {
  return harness_open_group(state, WIDTH, HEIGHT);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_level_sheet),  cmocka_unit_test(test_switch),        cmocka_unit_test(test_water_below),
      cmocka_unit_test(test_drops_around), cmocka_unit_test(test_absurd_fields),
  };
  return cmocka_run_group_tests(tests, open_group, harness_close_group);
}
