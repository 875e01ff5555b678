// The style "refraction" on frames that nobody checked: it draws, no layer holds what is not a number, GL says nothing.
#include "tests/render/degenerate.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST 4000
#define RADIUS DEGENERATE_RADIUS

// ---- Frames by hand --------------------------------------------------------------------------------------------------

typedef struct Hand {
  SimFrame frame;
  float position[3 * MOST], smoothed[3 * MOST], ellipsoid[6 * MOST], radius[MOST];
  uint8_t particle_class[MOST], near_surface[MOST];
} Hand;

static Hand *hand_create(void) {
  Hand *h = calloc(1, sizeof *h);
  assert_non_null(h);
  h->frame = (SimFrame){.particle_radius = RADIUS,
                        .position = h->position,
                        .smoothed = h->smoothed,
                        .ellipsoid = h->ellipsoid,
                        .particle_class = h->particle_class,
                        .near_surface = h->near_surface,
                        .bounds_max = {1, 1, 0.5f},
                        .container = degenerate_tank,
                        .has_container = true};
  return h;
}

// A ball at rest, of either class, that can be seen.
static int32_t add(Hand *h, float x, float y, float z, SimClass class) {
  const int32_t i = h->frame.count++;
  const float p[3] = {x, y, z};
  assert_true(i < MOST);
  memcpy(h->position + 3 * i, p, sizeof p);
  memcpy(h->smoothed + 3 * i, p, sizeof p);
  for (int k = 0; k < 3; ++k) h->ellipsoid[6 * i + k] = RADIUS;
  h->particle_class[i] = (uint8_t) class;
  h->near_surface[i] = 1;
  h->radius[i] = RADIUS;
  return i;
}

static void add_of_pool(void *to, float x, float y, float z, bool drop) {
  add(to, x, y, z, drop ? SIM_SPLASH : SIM_AGGREGATED);
}

static void add_pool(Hand *h) {
  degenerate_pool(h, add_of_pool);
}

// ---- What must hold --------------------------------------------------------------------------------------------------

static RenderSettings settings_of(RenderSmoothing smoothing) {
  RenderSettings settings = render_default_settings();
  settings.style = "refraction";
  settings.refraction.smoothing = smoothing;
  return settings;
}

static void expect_clean(Harness *harness, const char *what, const SimFrame *frame, const RenderView *view,
                         const RenderSettings *settings) {
  if (settings->refraction.smoothing == RENDER_SMOOTHING_REGRESSION) {
    degenerate_expect_clean(harness, what, frame, view, settings);
    return;
  }
  // Only these depend on the filter, besides what is made of them.
  static const char *const maps[] = {"front_depth", "front_normal", "back_depth", "back_normal"};
  degenerate_expect_picture(harness, what, frame, view, settings);
  for (int i = 0; i < 4; ++i) degenerate_expect_layer(harness, what, maps[i], frame, view, settings);
}

// With the default filter and with each other one.
static void expect_clean_always(Harness *harness, const char *what, const SimFrame *frame, const RenderView *view) {
  for (int smoothing = 0; smoothing <= RENDER_SMOOTHING_NONE; ++smoothing) {
    const RenderSettings settings = settings_of((RenderSmoothing)smoothing);
    expect_clean(harness, what, frame, view, &settings);
  }
}

// Without shadows, which all particles throw that have a place.
static bool same_picture(Harness *harness, const SimFrame *a, const SimFrame *b) {
  RenderSettings settings = settings_of(RENDER_SMOOTHING_REGRESSION);
  settings.sun = false;
  settings.shadow = false;
  uint8_t *of_a = harness_draw(harness, a, &degenerate_view, &settings);
  uint8_t *of_b = harness_draw(harness, b, &degenerate_view, &settings);
  const bool same = memcmp(of_a, of_b, 3 * (size_t)harness->width * (size_t)harness->height) == 0;
  free(of_a);
  free(of_b);
  return same;
}

// ---- Particles -------------------------------------------------------------------------------------------------------

static void test_few_particles(void **state) {
  Harness *harness = *state;
  Hand *h = hand_create();
  expect_clean_always(harness, "none", &h->frame, &degenerate_view);
  add(h, 0.5f, 0.3f, 0.25f, SIM_AGGREGATED);
  expect_clean_always(harness, "one aggregated", &h->frame, &degenerate_view);
  h->particle_class[0] = SIM_SPLASH;
  expect_clean_always(harness, "one splash", &h->frame, &degenerate_view);
  for (int i = 0; i < 300; ++i) add(h, 0.5f, 0.3f, 0.25f, i % 2 ? SIM_SPLASH : SIM_AGGREGATED);
  expect_clean_always(harness, "all in one place", &h->frame, &degenerate_view);
  free(h);
}

// What makes no sense is left out, and the rest is as it would be without.
static void test_invalid_particles(void **state) {
  Harness *harness = *state;
  Hand *clean = hand_create(), *dirty = hand_create();
  add_pool(clean);
  add_pool(dirty);
  const float *bad = degenerate_places;
  for (int i = 0; i < 36; ++i) {
    const SimClass class = i % 2 ? SIM_SPLASH : SIM_AGGREGATED;
    const int32_t n = add(dirty, 0.5f, 0.6f, 0.25f, class);
    dirty->position[3 * n + i % 3] = bad[i % 6];
    dirty->smoothed[3 * n + i % 3] = bad[i % 6];
  }
  static const float shapes[] = {NAN, INFINITY, 0, 1e30f, -RADIUS, 1e-30f};
  for (int i = 0; i < 6; ++i) {
    const int32_t n = add(dirty, 0.5f, 0.6f, 0.25f, SIM_AGGREGATED);
    for (int k = 0; k < 6; ++k) dirty->ellipsoid[6 * n + k] = shapes[i];
  }
  assert_true(same_picture(harness, &clean->frame, &dirty->frame));
  expect_clean_always(harness, "invalid", &dirty->frame, &degenerate_view);
  free(clean);
  free(dirty);
}

static void test_odd_shapes(void **state) {
  Harness *harness = *state;
  Hand *h = hand_create();
  static const float shapes[][6] = {{RADIUS, 1e-5f, RADIUS, 0, 0, 0}, // a flat disc
                                    {1e-5f, RADIUS, 1e-5f, 0, 0, 0},  // a needle
                                    {50, 50, 50, 0, 0, 0},            // larger than everything, with the eye in it
                                    {1e-6f, 1e-6f, 1e-6f, 0, 0, 0},   // smaller than a pixel
                                    {RADIUS, RADIUS, RADIUS, RADIUS, 0, 0}};
  for (size_t i = 0; i < sizeof shapes / sizeof *shapes; ++i) {
    const int32_t n = add(h, 0.2f * (float)i + 0.1f, 0.3f, 0.25f, SIM_AGGREGATED);
    memcpy(h->ellipsoid + 6 * n, shapes[i], sizeof shapes[i]);
    h->position[3 * n + 1] += 0.5f * RADIUS; // lifted
  }
  expect_clean_always(harness, "odd shapes", &h->frame, &degenerate_view);
  free(h);
}

static void test_odd_radii(void **state) {
  Harness *harness = *state;
  Hand *h = hand_create();
  add_pool(h);
  for (int32_t i = 0; i < h->frame.count; ++i) h->radius[i] = degenerate_radii[i % DEGENERATE_RADII];
  h->frame.radius = h->radius;
  expect_clean_always(harness, "radii", &h->frame, &degenerate_view);
  h->frame.radius = NULL;
  for (int k = 0; k < DEGENERATE_FRAME_RADII; ++k) {
    h->frame.particle_radius = degenerate_frame_radii[k];
    expect_clean_always(harness, "a frame's radius", &h->frame, &degenerate_view);
  }
  free(h);
}

// ---- Eyes ------------------------------------------------------------------------------------------------------------

static void test_eyes(void **state) {
  Harness *harness = *state;
  Hand *h = hand_create();
  add_pool(h);
  for (int k = 0; k < DEGENERATE_EYES; ++k) {
    char what[32];
    snprintf(what, sizeof what, "view %d", k);
    const RenderSettings settings = settings_of(RENDER_SMOOTHING_REGRESSION);
    expect_clean(harness, what, &h->frame, &degenerate_eyes[k], &settings);
  }
  expect_clean_always(harness, "eye in the water", &h->frame, &degenerate_eyes[0]);
  h->frame.has_container = false;
  expect_clean_always(harness, "eye in open water", &h->frame, &degenerate_eyes[0]);
  free(h);
}

// ---- Containers ------------------------------------------------------------------------------------------------------

static void test_odd_containers(void **state) {
  Harness *harness = *state;
  Hand *h = hand_create();
  add_pool(h);
  const RenderSettings settings = settings_of(RENDER_SMOOTHING_REGRESSION);
  for (int k = 0; k < DEGENERATE_CONTAINERS; ++k) {
    for (int shape = 0; shape < 3; ++shape) { // the last is none
      char what[48];
      snprintf(what, sizeof what, "container %d of shape %d", k, shape);
      h->frame.container = degenerate_containers[k];
      h->frame.container.shape = (SimContainerShape)(shape == 2 ? 9 : shape);
      expect_clean(harness, what, &h->frame, &degenerate_view, &settings);
    }
  }
  free(h);
}

// ---- Pictures --------------------------------------------------------------------------------------------------------

static void test_odd_pictures(void **state) {
  (void)state;
  Hand *h = hand_create();
  add_pool(h);
  for (int k = 0; k < DEGENERATE_SIZES; ++k) {
    Harness harness = harness_open(CONTEXT_AUTO, degenerate_sizes[k][0], degenerate_sizes[k][1]);
    const RenderSettings settings = settings_of(RENDER_SMOOTHING_REGRESSION);
    expect_clean(&harness, "odd picture", &h->frame, &degenerate_view, &settings);
    harness_close(&harness);
  }
  free(h);
}

static int open_harness(void **state) {
  return harness_open_group(state, 70, 45);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_few_particles), cmocka_unit_test(test_invalid_particles),
      cmocka_unit_test(test_odd_shapes),    cmocka_unit_test(test_odd_radii),
      cmocka_unit_test(test_eyes),          cmocka_unit_test(test_odd_containers),
      cmocka_unit_test(test_odd_pictures),
  };
  return cmocka_run_group_tests(tests, open_harness, harness_close_group);
}
