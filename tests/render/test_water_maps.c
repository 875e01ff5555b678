// The maps of aggregated water and of splashes: every pass against its slow twin.
#include "tests/render/water.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/render/reference/smooth.h"

#define WIDTH 200
#define HEIGHT 150
#define PIXELS ((size_t)WIDTH * HEIGHT)

// Waves and drops from a little above; a radius covers 2 to 4 pixels, and water reaches the picture's rim.
static const RenderView over_pool = {{1.9f, 0.75f, 1.7f}, {1.7f, 0.25f, 0.5f}, 40};

// Closely over the water, towards its far end: a radius covers 27 pixels, and a few at the far end.
static const RenderView near_pool = {{0.8f, 0.36f, 0.9f}, {1.4f, 0.2f, 0.5f}, 25};

// What a view shows of the pool with `none` at the default shape.
typedef struct Look {
  const RenderView *view;
  Pinhole pinhole;
  WaterMaps raw;
} Look;

typedef struct Scene {
  Harness harness;
  TestWater pool;
  Look over, near;
} Scene;

static RenderSettings style_settings(RenderSmoothing smoothing) {
  RenderSettings settings = harness_pinned_settings();
  settings.style = "refraction";
  settings.refraction.smoothing = smoothing;
  return settings;
}

static Look look(Scene *s, const RenderView *view) {
  const RenderSettings settings = style_settings(RENDER_SMOOTHING_NONE);
  return (Look){view, water_pinhole(view, WIDTH, HEIGHT),
                water_maps_draw(&s->harness, &s->pool.frame, view, &settings)};
}

static int open_scene(void **state) {
  Scene *s = calloc(1, sizeof *s);
  s->harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  TestFrame *t = test_frame_pool();
  s->pool = test_water_create(t->position, t->frame.count, t->frame.particle_radius, NULL);
  test_frame_destroy(t);
  s->over = look(s, &over_pool);
  s->near = look(s, &near_pool);
  *state = s;
  return 0;
}

static int close_scene(void **state) {
  Scene *s = *state;
  water_maps_destroy(&s->over.raw);
  water_maps_destroy(&s->near.raw);
  test_water_destroy(&s->pool);
  harness_close(&s->harness);
  free(s);
  return 0;
}

// ---- Particles -------------------------------------------------------------------------------------------------------

static void splat_both(const Scene *s, SimClass class, SplatShape shape, SplatMap out[2]) {
  for (int side = 0; side < 2; ++side) {
    out[side] = splat_map_create(&s->over.pinhole.lens);
    splat_frame(&s->over.pinhole, (SplatSide)side, &s->pool.frame, class, shape, &out[side]);
  }
}

static void expect_raw_maps(const char *what, const Scene *s, const SplatMap got[2], const SplatMap want[2]) {
  for (int side = 0; side < 2; ++side) {
    water_expect_raw(what, (SplatSide)side, &got[side], &want[side], PIXELS, (double)s->pool.frame.particle_radius);
  }
}

static void test_ellipsoids(void **state) {
  Scene *s = *state;
  const SplatShape shapes[2] = {SPLAT_DEFAULT_SHAPE, {1, 0}};
  for (int k = 0; k < 2; ++k) {
    RenderSettings settings = style_settings(RENDER_SMOOTHING_NONE);
    if (k == 1) {
      settings.refraction.scale = 1;
      settings.refraction.lift = 0;
    }
    WaterMaps maps = water_maps_draw(&s->harness, &s->pool.frame, &over_pool, &settings);
    SplatMap twin[2];
    splat_both(s, SIM_AGGREGATED, shapes[k], twin);
    expect_raw_maps(k == 0 ? "ellipsoids" : "ellipsoids of the paper", s, maps.side, twin);
    for (int side = 0; side < 2; ++side) splat_map_destroy(&twin[side]);
    water_maps_destroy(&maps);
  }
}

static void test_splashes(void **state) {
  Scene *s = *state;
  static const char *const names[2] = {"splash_front", "splash_back"};
  const RenderSettings settings = style_settings(RENDER_SMOOTHING_REGRESSION);
  SplatMap twin[2], maps[2];
  splat_both(s, SIM_SPLASH, SPLAT_DEFAULT_SHAPE, twin);
  for (int side = 0; side < 2; ++side) {
    maps[side].depth = harness_layer(&s->harness, names[side], 1, &s->pool.frame, &over_pool, &settings);
    maps[side].normal = twin[side].normal; // no layer shows theirs
  }
  expect_raw_maps("splashes", s, maps, twin);
  for (int side = 0; side < 2; ++side) {
    free(maps[side].depth);
    splat_map_destroy(&twin[side]);
  }
}

// What cannot be seen from outside the water makes no difference: with it the picture is the same, but where a flag was
// wrong and a pixel looks between the flagged particles at one that is not.
static int pixels_that_differ(Scene *s, const SimFrame *frame, const RenderView *view) {
  RenderSettings settings = style_settings(RENDER_SMOOTHING_REGRESSION);
  uint8_t *some = harness_draw(&s->harness, frame, view, &settings);
  settings.refraction.surface_only = false;
  uint8_t *all = harness_draw(&s->harness, frame, view, &settings);
  int differ = 0;
  for (size_t i = 0; i < PIXELS; ++i) differ += memcmp(some + 3 * i, all + 3 * i, 3) != 0;
  free(some);
  free(all);
  return differ;
}

// Deep water with waves and a few drops over it.
static TestWater deep_pool(const SimContainer *tank) {
  const float spacing = 0.035f, wobble = 0.08f * spacing;
  TestFrame *t = test_frame_create(20000, spacing / 2);
  for (float z = spacing / 2; z < tank->max[2]; z += spacing)
    for (float x = spacing / 2; x < tank->max[0]; x += spacing)
      for (float y = spacing / 2; y < 0.5f + 0.06f * sinf(6 * x) * cosf(4 * z); y += spacing)
        test_frame_add(t, x + wobble * sinf(91 * y + 37 * z), y + wobble * sinf(57 * x + 83 * z),
                       z + wobble * sinf(71 * x + 47 * y));
  for (int i = 0; i < 12; ++i) test_frame_add(t, 0.1f + 0.08f * (float)i, 0.75f, 0.1f + 0.04f * (float)i);
  TestWater water = test_water_create(t->position, t->frame.count, t->frame.particle_radius, tank);
  test_frame_destroy(t);
  return water;
}

static void test_surface_only(void **state) {
  Scene *s = *state;
  const SimContainer tank = {{0, 0, 0}, {1.05f, 1.2f, 0.7f}, SIM_CONTAINER_BOX};
  TestWater deep = deep_pool(&tank);
  int32_t hidden = 0;
  for (int32_t i = 0; i < deep.frame.count; ++i) hidden += !deep.frame.near_surface[i];
  print_message("surface_only: %d of %d particles hidden\n", hidden, deep.frame.count);
  assert_true(hidden > deep.frame.count / 4);
  const RenderView over_deep = {{0.9f, 1.1f, 2.1f}, {0.5f, 0.35f, 0.3f}, 40},
                   low = {{-0.9f, 0.2f, 1.9f}, {0.5f, 0.35f, 0.3f}, 40};
  SimFrame open = deep.frame;
  open.has_container = false;
  const int differ[] = {pixels_that_differ(s, &s->pool.frame, &over_pool),
                        pixels_that_differ(s, &deep.frame, &over_deep), pixels_that_differ(s, &deep.frame, &low),
                        pixels_that_differ(s, &open, &over_deep), pixels_that_differ(s, &open, &low)};
  for (size_t k = 0; k < sizeof differ / sizeof *differ; ++k) {
    print_message("surface_only: %d pixels differ\n", differ[k]);
    assert_true(differ[k] <= 3);
  }
  test_water_destroy(&deep);
}

// ---- Filters ---------------------------------------------------------------------------------------------------------

// Smooth both raw maps into both others.
typedef void Twin(const SmoothInput side[2], const void *parameters, float *const smoothed[2]);

static void regression(const SmoothInput side[2], const void *parameters, float *const smoothed[2]) {
  for (int k = 0; k < 2; ++k) smooth_regression(&side[k], parameters, smoothed[k]);
}

static void narrow_range(const SmoothInput side[2], const void *parameters, float *const smoothed[2]) {
  smooth_narrow_range_sides(side, 2, parameters, smoothed);
}

static void plane_fit(const SmoothInput side[2], const void *parameters, float *const smoothed[2]) {
  for (int k = 0; k < 2; ++k) smooth_plane_fit(&side[k], parameters, smoothed[k]);
}

static void bilateral(const SmoothInput side[2], const void *parameters, float *const smoothed[2]) {
  for (int k = 0; k < 2; ++k) smooth_bilateral(&side[k], parameters, smoothed[k]);
}

// What the twin makes of the renderer's own raw maps; normals outward, as the renderer has them.
static WaterMaps smooth_twin(const Look *seen, double radius, Twin *twin, const void *parameters) {
  const Lens *lens = &seen->pinhole.lens;
  const SplatMap *raw = seen->raw.side;
  const SmoothInput in[2] = {{*lens, radius, raw[0].depth, raw[0].normal},
                             {*lens, radius, raw[1].depth, raw[1].normal}};
  WaterMaps out;
  for (int side = 0; side < 2; ++side) out.side[side] = splat_map_create(lens);
  twin(in, parameters, (float *const[2]){out.side[0].depth, out.side[1].depth});
  for (int side = 0; side < 2; ++side) smooth_normals(lens, radius, out.side[side].depth, out.side[side].normal);
  for (size_t i = 0; i < 3 * PIXELS; ++i) out.side[1].normal[i] *= -1;
  return out;
}

// Both read the same maps, so that all that differs is rounding: a float of 1.5 m has a spacing of 1.2e-7 m, which is 7e-6
// radii, and inverting a depth and adding up a window lose some of them.
static void expect_filter_of(Scene *s, const Look *seen, const char *what, const RenderSettings *settings, Twin *twin,
                             const void *parameters) {
  const double r = (double)s->pool.frame.particle_radius;
  WaterMaps got = water_maps_draw(&s->harness, &s->pool.frame, seen->view, settings);
  WaterMaps want = smooth_twin(seen, r, twin, parameters);
  WaterDifference d[2];
  for (int side = 0; side < 2; ++side) {
    d[side] = water_maps_compare(&got.side[side], &want.side[side], PIXELS, r);
    water_difference_print(what, (SplatSide)side, &d[side]);
  }
  for (int side = 0; side < 2; ++side) {
    assert_int_equal(d[side].one, 0);
    assert_true(d[side].depth < 2e-4);
    assert_true(d[side].largest_depth < 1e-3);
    assert_true(d[side].largest_normal < 1e-3);
  }
  water_maps_destroy(&got);
  water_maps_destroy(&want);
}

static void expect_filter(Scene *s, const char *what, const RenderSettings *settings, Twin *twin,
                          const void *parameters) {
  expect_filter_of(s, &s->over, what, settings, twin, parameters);
}

static void test_regression(void **state) {
  const RenderSettings settings = style_settings(RENDER_SMOOTHING_REGRESSION);
  expect_filter(*state, "regression", &settings, regression, &smooth_regression_default);
}

// Pixels that a radius covers where a centre of the aggregated water in the picture is nearest. Smoothed centres will do:
// that the drawn ones are lifted matters only by a few percent.
static double largest_radius(const Scene *s, const Pinhole *p) {
  const SimFrame *frame = &s->pool.frame;
  const double r = (double)frame->particle_radius;
  double nearest = INFINITY;
  for (size_t i = 0; i < (size_t)frame->count; ++i) {
    if (frame->particle_class[i] != SIM_AGGREGATED || !frame->near_surface[i]) continue;
    double v[3], view[3];
    for (size_t k = 0; k < 3; ++k) v[k] = (double)frame->smoothed[3 * i + k] - p->eye[k];
    pinhole_to_view(p, v, view);
    const double depth = -view[2];
    if (depth > 1.5 * r && depth < nearest && fabs(view[0]) < depth * p->lens.tan_x + r &&
        fabs(view[1]) < depth * p->lens.tan_y + r)
      nearest = depth;
  }
  return r / nearest / lens_pixel(&p->lens);
}

// Near the eye the default has more taps and finer steps.
static void test_regression_near(void **state) {
  Scene *s = *state;
  const double pixels = largest_radius(s, &s->near.pinhole);
  const SmoothRegression steps = smooth_regression_near(pixels);
  print_message("regression near: a radius covers %.1f pixels, %d steps\n", pixels, steps.step_count);
  assert_true(pixels > 20 && steps.step_count > 4);
  // No step hangs on how exactly that is known.
  assert_int_equal(smooth_regression_near(0.9 * pixels).step_count, steps.step_count);
  assert_int_equal(smooth_regression_near(1.1 * pixels).step_count, steps.step_count);
  const RenderSettings settings = style_settings(RENDER_SMOOTHING_REGRESSION);
  expect_filter_of(s, &s->near, "regression near", &settings, regression, &steps);
}

static void test_plane_fit(void **state) {
  const struct {
    const char *what;
    SmoothPlaneFit p;
  } cases[] = {{"plane fit, 2", {9, 0, 2, 5.3, false}},
               {"plane fit, 5", {9, 0, 5, 5.3, false}},
               {"plane fit, no view, 2", {9, 0, 2, 5.3, true}},
               {"plane fit, no view, 5", {9, 0, 5, 5.3, true}},
               {"plane fit of 5 r", {9, 5, 2, 5.3, false}}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    RenderSettings settings = style_settings(RENDER_SMOOTHING_PLANE_FIT);
    settings.refraction.window = cases[k].p.window;
    settings.refraction.reach = (float)cases[k].p.reach;
    settings.refraction.iterations = cases[k].p.iterations;
    settings.refraction.sigma = (float)cases[k].p.sigma;
    settings.refraction.view_dependent = !cases[k].p.view_independent;
    expect_filter(*state, cases[k].what, &settings, plane_fit, &cases[k].p);
  }
}

static void test_bilateral(void **state) {
  RenderSettings settings = style_settings(RENDER_SMOOTHING_BILATERAL);
  settings.refraction.window = 11;
  settings.refraction.sigma = 2.6f;
  settings.refraction.iterations = 2;
  expect_filter(*state, "bilateral", &settings, bilateral, &(SmoothBilateral){11, 2, 2.6});
}

// The constants of render/water_surface.c.
static void test_narrow_range(void **state) {
  RenderSettings settings = style_settings(RENDER_SMOOTHING_NARROW_RANGE);
  settings.refraction.iterations = 2;
  expect_filter(*state, "narrow range", &settings, narrow_range, &(SmoothNarrowRange){9, 7, 2, 2, 4, 1});
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_ellipsoids), cmocka_unit_test(test_splashes),        cmocka_unit_test(test_surface_only),
      cmocka_unit_test(test_regression), cmocka_unit_test(test_regression_near), cmocka_unit_test(test_plane_fit),
      cmocka_unit_test(test_bilateral),  cmocka_unit_test(test_narrow_range),
  };
  return cmocka_run_group_tests(tests, open_scene, close_scene);
}
