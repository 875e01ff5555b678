// More particles than a storage block of the driver holds, or than go to the GPU at a time: the picture is the same.
#include "render/gpu.h"
#include "tests/render/water.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 128
#define HEIGHT 80

static const RenderView view = {{1.5f, 1.1f, 3.4f}, {1.5f, 0.3f, 0.5f}, 38};

static RenderSettings settings_of(const char *style) {
  RenderSettings settings = render_default_settings();
  settings.style = style;
  return settings;
}

static uint8_t *draw(const SimFrame *frame, const char *style, size_t limit) {
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  const RenderSettings settings = settings_of(style);
  gpu_limit_blocks(limit);
  uint8_t *rgb = harness_draw(&harness, frame, &view, &settings);
  gpu_limit_blocks(0);
  harness_close(&harness);
  return rgb;
}

static void expect_same(const uint8_t *a, const uint8_t *b, const char *what) {
  int differ = 0;
  for (int i = 0; i < 3 * WIDTH * HEIGHT; ++i) differ += a[i] != b[i];
  if (differ > 0) fail_msg("%s: %d bytes differ", what, differ);
}

static const char *const styles[] = {"points", "refraction", "raycast"};
#define STYLES (sizeof styles / sizeof styles[0])

static TestWater pool(void) {
  TestFrame *t = test_frame_pool();
  TestWater water = test_water_create(t->position, t->frame.count, t->frame.particle_radius, &t->frame.container);
  test_frame_destroy(t);
  assert_true(water.frame.count > 15000);
  return water;
}

// In colours, so that one that belongs to another particle shows.
static TestWater coloured_pool(float **colour) {
  TestWater water = pool();
  const int32_t count = water.frame.count;
  *colour = malloc(3 * sizeof(float) * (size_t)count);
  for (int32_t i = 0; i < 3 * count; ++i) (*colour)[i] = fabsf(sinf(8 * water.frame.position[i] + (float)(i % 3)));
  water.frame.colour = *colour;
  return water;
}

static void test_parts_of_blocks_make_the_same_picture(void **state) {
  (void)state;
  float *colour;
  TestWater water = coloured_pool(&colour);
  for (size_t k = 0; k < STYLES; ++k) {
    uint8_t *whole = draw(&water.frame, styles[k], 0);
    const size_t limits[] = {16 * 4096, 100000, 64 * 1024 * 3};
    for (int i = 0; i < 3; ++i) {
      uint8_t *parts = draw(&water.frame, styles[k], limits[i]);
      expect_same(whole, parts, styles[k]);
      free(parts);
    }
    free(whole);
  }
  free(colour);
  test_water_destroy(&water);
}

// A block that holds no single element: the message says what it could hold.
static void test_a_limit_that_is_too_small_is_told(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  TestFrame *t = test_frame_pool();
  const RenderSettings settings = settings_of("points");
  RenderError error = {0};
  gpu_limit_blocks(12);
  assert_false(render_draw(harness.render, &t->frame, &view, &settings, &error));
  gpu_limit_blocks(0);
  if (strstr(error.message, "storage blocks of 12") == NULL) fail_msg("\"%s\" does not tell the limit", error.message);
  assert_true(render_draw(harness.render, &t->frame, &view, &settings, &error));
  test_frame_destroy(t);
  harness_close(&harness);
}

// More particles, or more cells, than a view holds: it cannot be split, so the message says what it could hold.
static void test_a_limit_of_views_is_told(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  TestWater water = pool();
  const SimGrid *grid = &water.frame.grid;
  const size_t count = (size_t)water.frame.count, cells = (size_t)grid->size[0] * grid->size[1] * grid->size[2] + 1;
  const size_t limits[] = {cells - 1, count - 1}, most = count > cells ? count : cells;
  const RenderSettings settings = settings_of("raycast");
  for (int k = 0; k < 2; ++k) {
    RenderError error = {0};
    char told[64];
    snprintf(told, sizeof told, "texture buffers hold: %zu", limits[k]);
    gpu_limit_views(limits[k]);
    assert_false(render_draw(harness.render, &water.frame, &view, &settings, &error));
    gpu_limit_views(0);
    if (strstr(error.message, told) == NULL) fail_msg("\"%s\" does not tell the limit", error.message);
  }
  RenderError error = {0};
  gpu_limit_views(most);
  const bool drawn = render_draw(harness.render, &water.frame, &view, &settings, &error);
  gpu_limit_views(0);
  if (!drawn) fail_msg("%s", error.message);
  test_water_destroy(&water);
  harness_close(&harness);
}

// Without colours all particles share one, which is that of water and takes no room.
static void test_one_colour_for_all_is_white(void **state) {
  (void)state;
  TestWater water = pool();
  const size_t count = (size_t)water.frame.count, before = gpu_buffer_bytes();
  float *colour = malloc(3 * sizeof(float) * count);
  for (size_t i = 0; i < 3 * count; ++i) colour[i] = 1;
  for (size_t k = 0; k < STYLES; ++k) {
    size_t bytes[2];
    uint8_t *rgb[2];
    for (int shared = 0; shared < 2; ++shared) {
      Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
      const RenderSettings settings = settings_of(styles[k]);
      water.frame.colour = shared ? NULL : colour;
      rgb[shared] = harness_draw(&harness, &water.frame, &view, &settings);
      bytes[shared] = gpu_buffer_bytes() - before;
      harness_close(&harness);
      assert_true(gpu_buffer_bytes() == before);
    }
    expect_same(rgb[0], rgb[1], styles[k]);
    assert_true(bytes[0] - bytes[1] == 16 * (count - 1));
    for (int i = 0; i < 2; ++i) free(rgb[i]);
  }
  free(colour);
  test_water_destroy(&water);
}

// Where nobody looks at spray, no colours are made for it.
static void test_spray_is_left_out(void **state) {
  (void)state;
  TestWater water = pool();
  const size_t count = (size_t)water.frame.count, before = gpu_buffer_bytes();
  const size_t cells = (size_t)water.frame.grid.size[0] * water.frame.grid.size[1] * water.frame.grid.size[2];
  float *some = calloc(3 * count, sizeof *some);
  water.frame.velocity = water.frame.density = some;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  const RenderSettings settings = settings_of("raycast");
  free(harness_draw(&harness, &water.frame, &view, &settings));
  const size_t most = 16 * count + 4 * cells + 65536; // uniforms, tiles, obstacles
  if (gpu_buffer_bytes() - before > most) fail_msg("%zu bytes in buffers", gpu_buffer_bytes() - before);
  harness_close(&harness);
  free(some);
  test_water_destroy(&water);
}

// A few particles behind very many that cannot be drawn: each batch arrives in its place, with its colour.
static void test_the_last_of_many_are_drawn(void **state) {
  (void)state;
  const int32_t invisible = 200000, visible = 3;
  TestFrame *t = test_frame_create(invisible + visible, 0.1f);
  float *colour = calloc(3 * (size_t)(invisible + visible), sizeof *colour);
  for (int32_t i = 0; i < invisible; ++i) test_frame_add(t, NAN, 0, 0);
  for (int32_t i = 0; i < visible; ++i) {
    test_frame_add(t, 1 + 0.5f * (float)i, 0.5f, 0.5f);
    colour[3 * (invisible + i) + i] = 1;
  }
  t->frame.colour = colour;
  uint8_t *many = draw(&t->frame, "points", 16 * 4096);
  SimFrame few = t->frame;
  few.count = visible;
  few.position += 3 * invisible;
  few.velocity += 3 * invisible;
  few.density += invisible;
  few.colour += 3 * invisible;
  uint8_t *alone = draw(&few, "points", 0);
  expect_same(many, alone, "the last ones");
  few.count = 0;
  uint8_t *nothing = draw(&few, "points", 0);
  assert_true(memcmp(alone, nothing, 3 * WIDTH * HEIGHT) != 0);
  free(many);
  free(alone);
  free(nothing);
  free(colour);
  test_frame_destroy(t);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_parts_of_blocks_make_the_same_picture),
      cmocka_unit_test(test_a_limit_that_is_too_small_is_told),
      cmocka_unit_test(test_a_limit_of_views_is_told),
      cmocka_unit_test(test_one_colour_for_all_is_white),
      cmocka_unit_test(test_spray_is_left_out),
      cmocka_unit_test(test_the_last_of_many_are_drawn),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
