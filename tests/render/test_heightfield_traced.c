// The style "heightfield" against light computed ray by ray in double precision: level water, bodies in it, waves, the tank's
// sides, an eye in the water, and colours that are bent by their own indices.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/render/pool_scene.h"
#include "tests/render/pool_trace.h"

#define WIDTH 256
#define HEIGHT 192
#define PIXELS ((size_t)WIDTH * HEIGHT)

static const PoolWave level = {0.5, 0, {0, 0}};

static PoolDifference compare(Harness *harness, const PoolScene *s, const RenderView *view, const char *what) {
  PoolTrace pool = pool_trace_create(&s->frame->frame, &s->settings, s->wave);
  uint8_t *water = malloc(PIXELS), *drawn = harness_draw(harness, &s->frame->frame, view, &s->settings);
  float *truth = pool_trace_picture(&pool, view, WIDTH, HEIGHT, water);
  const PoolDifference d = pool_difference(drawn, truth, water, PIXELS);
  print_message("%-34s: mean %.2f, median %.2f, 95 %% %.2f of 255 (%d pixels)\n", what, d.mean, d.median, d.most,
                (int)d.pixels);
  free(water);
  free(drawn);
  free(truth);
  pool_trace_destroy(&pool);
  return d;
}

// ---- From above ------------------------------------------------------------------------------------------------------

// Squares of the floor have sharp edges: a few pixels there may be on the other side.
static void expect_close(PoolDifference d) {
  assert_true(d.median <= 1);
  assert_true(d.most <= 1);
  assert_true(d.mean <= 1);
}

static const double angles[] = {20, 45, 70};

// What the water mirrors and what goes through it, by Fresnel, Snell and Beer and Lambert.
static void test_level_water(void **state) {
  PoolScene *s = pool_scene_create(level);
  for (int i = 0; i < 3; ++i) {
    const RenderView view = pool_scene_view(angles[i]);
    expect_close(compare(*state, s, &view, "level water"));
  }
  const float strong[3] = {4, 0.2f, 2}, milk[3] = {0.5f, 3, 1};
  memcpy(s->settings.absorption, strong, sizeof strong);
  memcpy(s->settings.scattering, milk, sizeof milk);
  s->settings.refractive_index = 1.6f;
  const RenderView view = pool_scene_view(45);
  expect_close(compare(*state, s, &view, "a coloured, milky liquid"));
  pool_scene_destroy(s);
}

static void test_bodies(void **state) {
  PoolScene *s = pool_scene_create(level);
  pool_scene_add_bodies(s);
  for (int i = 0; i < 3; ++i) {
    const RenderView view = pool_scene_view(angles[i]);
    s->settings.heightfield.mapped = true;
    expect_close(compare(*state, s, &view, "bodies, maps"));
    s->settings.heightfield.mapped = false;
    expect_close(compare(*state, s, &view, "bodies, rays"));
  }
  pool_scene_destroy(s);
}

// Without the pull to the objects' planes, so that the surface is the waves alone. The paper's access by direction is what it
// is: much worse.
static void test_waves(void **state) {
  PoolScene *s = pool_scene_create((PoolWave){0.5, 0.008, {6, 9}});
  pool_scene_add_bodies(s);
  s->settings.heightfield.pull_reach = 0;
  for (int i = 0; i < 3; ++i) {
    const RenderView view = pool_scene_view(angles[i]);
    s->settings.heightfield.mapped = true;
    s->settings.heightfield.access = RENDER_ACCESS_POINT;
    const PoolDifference point = compare(*state, s, &view, "waves, maps by points");
    s->settings.heightfield.access = RENDER_ACCESS_DIRECTION;
    const PoolDifference direction = compare(*state, s, &view, "waves, maps by directions");
    s->settings.heightfield.mapped = false;
    const PoolDifference rays = compare(*state, s, &view, "waves, rays");
    assert_true(rays.mean <= 1.5 && rays.most <= 1.5 && rays.median <= 1);
    assert_true(point.mean <= 2 && point.most <= 7 && point.median <= 1);
    assert_true(direction.mean > 3 * point.mean && direction.most > 3 * point.most);
  }
  pool_scene_destroy(s);
}

// Each colour by its own index, red by the smallest.
static void test_dispersion(void **state) {
  Harness *harness = *state;
  PoolScene *s = pool_scene_create(level);
  const RenderView view = pool_scene_view(55);
  uint8_t *without = harness_draw(harness, &s->frame->frame, &view, &s->settings);
  s->settings.heightfield.dispersion = 1e-9f;
  uint8_t *none = harness_draw(harness, &s->frame->frame, &view, &s->settings);
  s->settings.heightfield.dispersion = 0.1f;
  uint8_t *drawn = harness_draw(harness, &s->frame->frame, &view, &s->settings), *water = malloc(PIXELS);
  assert_memory_equal(none, without, 3 * PIXELS);
  float *truth = malloc(3 * PIXELS * sizeof *truth);
  for (size_t k = 0; k < 3; ++k) {
    PoolTrace pool = pool_trace_create(&s->frame->frame, &s->settings, s->wave);
    pool.index += 0.05 * ((double)k - 1);
    float *one = pool_trace_picture(&pool, &view, WIDTH, HEIGHT, water);
    for (size_t i = k; i < 3 * PIXELS; i += 3) truth[i] = one[i];
    free(one);
    pool_trace_destroy(&pool);
  }
  const PoolDifference right = pool_difference(drawn, truth, water, PIXELS);
  const PoolDifference wrong = pool_difference(without, truth, water, PIXELS);
  print_message("dispersion: mean %.2f, 95 %% %.2f of 255; without it %.2f, %.2f\n", right.mean, right.most, wrong.mean,
                wrong.most);
  // Fresnel's share is that of the middle colour.
  assert_true(right.most <= 2 && right.mean <= 2);
  assert_true(wrong.mean > 5 * right.mean);
  free(without);
  free(none);
  free(drawn);
  free(water);
  free(truth);
  pool_scene_destroy(s);
}

// ---- From beside and within ------------------------------------------------------------------------------------------

static void test_sides(void **state) {
  PoolScene *s = pool_scene_create(level);
  pool_scene_add_bodies(s);
  const RenderView views[] = {harness_view(0.6f, 0.45f, 4.6f, 0, 0.3f, 0, 38),
                              harness_view(3.4f, 0.2f, 3.6f, 0, 0.4f, 0, 30),
                              harness_view(0.2f, 0.08f, 3.2f, 0, 0.6f, 0.6f, 45)};
  for (int i = 0; i < 3; ++i) expect_close(compare(*state, s, &views[i], "through the sides"));
  pool_scene_destroy(s);
}

// Into the tank, where the surface above mirrors all; and up, to the round window through which the sky is seen. What that
// window mirrors of the tank besides is not drawn.
static void test_submerged(void **state) {
  PoolScene *s = pool_scene_create(level);
  pool_scene_add_bodies(s);
  const RenderView across = harness_view(0.3f, 0.2f, 1.7f, 0, 0.3f, 0, 60);
  const RenderView up = harness_view(1, 0.1f, 1.4f, 0.3f, 0.9f, 0.3f, 70);
  expect_close(compare(*state, s, &across, "eye in the water"));
  const PoolDifference d = compare(*state, s, &up, "eye in the water, upwards");
  assert_true(d.median <= 1 && d.mean <= 3.5 && d.most <= 14);
  pool_scene_destroy(s);
}

static int open_harness(void **state) {
  return harness_open_group(state, WIDTH, HEIGHT);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_level_water), cmocka_unit_test(test_bodies), cmocka_unit_test(test_waves),
      cmocka_unit_test(test_dispersion),  cmocka_unit_test(test_sides),  cmocka_unit_test(test_submerged),
  };
  return cmocka_run_group_tests(tests, open_harness, harness_close_group);
}
