// The style "cartoon" on frames that nobody checked: it draws, no layer holds what is not a number, GL says nothing.
#include "tests/render/degenerate.h"
#include "tests/render/drawn.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define RADIUS DEGENERATE_RADIUS

// ---- Frames and what must hold ---------------------------------------------------------------------------------------

static DrawnWater *tank_create(void) {
  DrawnWater *water = drawn_create(RADIUS);
  water->frame.container = degenerate_tank;
  water->frame.has_container = true;
  return water;
}

static void add_of_pool(void *to, float x, float y, float z, bool drop) {
  drawn_add(to, x, y, z, drop ? SIM_SPLASH : SIM_AGGREGATED);
}

static void add_pool(DrawnWater *water) {
  degenerate_pool(water, add_of_pool);
}

// The default, the separated filter, a fixed kernel of means, curvature flow at full resolution, and one surface unsmoothed.
enum { WAYS = 5 };
static RenderSettings settings_of(int way) {
  RenderSettings settings = render_default_settings();
  settings.style = "cartoon";
  RenderCartoon *c = &settings.cartoon;
  c->separated = way == 1;
  if (way == 2) c->kernel = 21, c->fitted = false;
  if (way == 3) c->smoothing = RENDER_CARTOON_CURVATURE, c->half_resolution = false;
  if (way == 4) c->smoothing = RENDER_CARTOON_NONE, c->splashes_apart = false;
  return settings;
}

static void expect_clean(Harness *harness, const char *what, const SimFrame *frame, const RenderView *view) {
  const RenderSettings settings = settings_of(0);
  degenerate_expect_clean(harness, what, frame, view, &settings);
}

static void expect_clean_always(Harness *harness, const char *what, const SimFrame *frame, const RenderView *view) {
  expect_clean(harness, what, frame, view);
  for (int way = 1; way < WAYS; ++way) {
    const RenderSettings settings = settings_of(way);
    degenerate_expect_picture(harness, what, frame, view, &settings);
    degenerate_expect_layer(harness, what, "normal", frame, view, &settings);
    degenerate_expect_layer(harness, what, "depth", frame, view, &settings);
  }
}

static uint8_t *picture_of(Harness *harness, const SimFrame *frame, const char *style) {
  RenderSettings settings = settings_of(0);
  settings.style = style;
  return harness_draw(harness, frame, &degenerate_view, &settings);
}

static bool same_picture(Harness *harness, const SimFrame *a, const SimFrame *b) {
  RenderSettings settings = settings_of(0);
  settings.shadow = false; // which all particles throw that have a place
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
  DrawnWater *w = tank_create();
  expect_clean_always(harness, "none", &w->frame, &degenerate_view);
  drawn_add(w, 0.5f, 0.3f, 0.25f, SIM_AGGREGATED);
  expect_clean_always(harness, "one of the body", &w->frame, &degenerate_view);
  w->particle_class[0] = SIM_SPLASH;
  expect_clean_always(harness, "one drop", &w->frame, &degenerate_view);
  for (int i = 0; i < 9; ++i) drawn_add(w, 0.1f * (float)i, 0.3f, 0.25f, SIM_SPLASH);
  expect_clean_always(harness, "only drops", &w->frame, &degenerate_view);
  w->near_surface[3] = w->near_surface[5] = 0;
  expect_clean_always(harness, "hidden drops", &w->frame, &degenerate_view);
  w->frame.has_container = false;
  expect_clean_always(harness, "without a container", &w->frame, &degenerate_view);
  free(w);
}

// The water leaves nothing behind when it is gone, neither in the picture nor in the layers.
static void test_none_after_some(void **state) {
  Harness *harness = *state;
  DrawnWater *none = tank_create(), *some = tank_create();
  add_pool(some);
  uint8_t *before = picture_of(harness, &none->frame, "cartoon");
  free(picture_of(harness, &some->frame, "cartoon"));
  uint8_t *after = picture_of(harness, &none->frame, "cartoon");
  assert_memory_equal(before, after, 3 * (size_t)harness->width * (size_t)harness->height);
  static const char *const names[] = {"depth", "tone", "thickness", "cover", "smooth_depth", "raw_depth"};
  for (int k = 1; k < 6; ++k) {
    const RenderSettings settings = settings_of(0);
    free(harness_layer(harness, names[k], 1, &some->frame, &degenerate_view, &settings));
    float *layer = harness_layer(harness, names[k], 1, &none->frame, &degenerate_view, &settings);
    for (int i = 0; i < harness->width * harness->height; ++i) {
      if (layer[i] != 0) fail_msg("%s is left: %g", names[k], (double)layer[i]);
    }
    free(layer);
  }
  free(before);
  free(after);
  free(none);
  free(some);
}

// What makes no sense is left out, and the rest is as it would be without.
static void test_invalid_particles(void **state) {
  Harness *harness = *state;
  DrawnWater *clean = tank_create(), *dirty = tank_create();
  add_pool(clean);
  add_pool(dirty);
  const float *bad = degenerate_places;
  for (int i = 0; i < 36; ++i) {
    const int32_t n = drawn_add(dirty, 0.5f, 0.6f, 0.25f, i % 2 ? SIM_SPLASH : SIM_AGGREGATED);
    dirty->position[3 * n + i % 3] = bad[i % 6];
  }
  assert_true(same_picture(harness, &clean->frame, &dirty->frame));
  expect_clean_always(harness, "invalid", &dirty->frame, &degenerate_view);
  // Nothing else but invalid ones.
  dirty->frame.count = 0;
  for (int i = 0; i < 6; ++i) drawn_add(dirty, bad[i], 0.5f, 0.25f, i % 2 ? SIM_SPLASH : SIM_AGGREGATED);
  expect_clean_always(harness, "all invalid", &dirty->frame, &degenerate_view);
  free(clean);
  free(dirty);
}

static void test_odd_radii(void **state) {
  Harness *harness = *state;
  DrawnWater *w = tank_create();
  add_pool(w);
  for (int32_t i = 0; i < w->frame.count; ++i) w->radius[i] = degenerate_radii[i % DEGENERATE_RADII];
  w->frame.radius = w->radius;
  expect_clean_always(harness, "radii", &w->frame, &degenerate_view);
  w->frame.radius = NULL;
  for (int k = 0; k < DEGENERATE_FRAME_RADII; ++k) {
    w->frame.particle_radius = degenerate_frame_radii[k];
    expect_clean(harness, "a frame's radius", &w->frame, &degenerate_view);
  }
  free(w);
}

// Colours of the particles' own, sensible or not.
static void test_odd_colours(void **state) {
  Harness *harness = *state;
  DrawnWater *w = tank_create();
  add_pool(w);
  const size_t size = 3 * sizeof(float) * (size_t)w->frame.count;
  float *colour = calloc(1, size);
  w->frame.colour = colour;
  expect_clean_always(harness, "black water", &w->frame, &degenerate_view);
  static const float odd[] = {NAN, INFINITY, -1, 0, 1, 1e-30f, 0.3f};
  for (int32_t i = 0; i < 3 * w->frame.count; ++i) colour[i] = odd[i % 7];
  expect_clean_always(harness, "odd colours", &w->frame, &degenerate_view);
  free(colour);
  free(w);
}

static void test_all_in_one_place(void **state) {
  Harness *harness = *state;
  DrawnWater *w = tank_create();
  for (int i = 0; i < 50000; ++i) drawn_add(w, 0.5f, 0.3f, 0.25f, SIM_AGGREGATED);
  const RenderSettings settings = settings_of(0);
  struct timespec begin, end;
  timespec_get(&begin, TIME_UTC);
  degenerate_expect_picture(harness, "all in one place", &w->frame, &degenerate_view, &settings);
  timespec_get(&end, TIME_UTC);
  const double seconds = (double)(end.tv_sec - begin.tv_sec) + 1e-9 * (double)(end.tv_nsec - begin.tv_nsec);
  print_message("50000 particles in one place: %.2f s\n", seconds);
  assert_true(seconds < 30);
  expect_clean(harness, "all in one place", &w->frame, &degenerate_view);
  for (int i = 0; i < 50000; i += 2) w->particle_class[i] = SIM_SPLASH;
  expect_clean(harness, "half of them drops", &w->frame, &degenerate_view);
  free(w);
}

// ---- Eyes, containers, settings --------------------------------------------------------------------------------------

static void test_eyes(void **state) {
  Harness *harness = *state;
  DrawnWater *w = tank_create();
  add_pool(w);
  for (int k = 0; k < DEGENERATE_EYES; ++k) {
    char what[32];
    snprintf(what, sizeof what, "view %d", k);
    expect_clean(harness, what, &w->frame, &degenerate_eyes[k]);
  }
  expect_clean_always(harness, "eye in the water", &w->frame, &degenerate_eyes[0]);
  w->frame.has_container = false;
  expect_clean_always(harness, "eye in open water", &w->frame, &degenerate_eyes[0]);
  RenderView at_particle = degenerate_eyes[0];
  memcpy(at_particle.eye, w->position + 3 * (w->frame.count / 2), sizeof at_particle.eye);
  expect_clean(harness, "eye at a particle", &w->frame, &at_particle);
  free(w);
}

static void test_odd_containers(void **state) {
  Harness *harness = *state;
  DrawnWater *w = tank_create();
  add_pool(w);
  const RenderSettings settings = settings_of(0);
  for (int k = 0; k < DEGENERATE_CONTAINERS; ++k) {
    for (int shape = 0; shape < 3; ++shape) { // the last is none
      char what[48];
      snprintf(what, sizeof what, "container %d of shape %d", k, shape);
      w->frame.container = degenerate_containers[k];
      w->frame.container.shape = (SimContainerShape)(shape == 2 ? 9 : shape);
      degenerate_expect_picture(harness, what, &w->frame, &degenerate_view, &settings);
      degenerate_expect_layer(harness, what, "normal", &w->frame, &degenerate_view, &settings);
    }
  }
  free(w);
}

// Settings at the ends of their ranges.
static void test_extreme_settings(void **state) {
  Harness *harness = *state;
  DrawnWater *w = tank_create();
  add_pool(w);
  for (int k = 0; k < 14; ++k) {
    RenderSettings settings = settings_of(0);
    RenderCartoon *c = &settings.cartoon;
    char what[32];
    snprintf(what, sizeof what, "extreme %d", k);
    switch (k) {
    case 0:
      c->scale = 0.5f;
      break;
    case 1:
      c->scale = 4;
      break;
    case 2:
      c->kernel = 63;
      break;
    case 3:
      c->kernel = 1;
      break;
    case 4:
      c->reach = 0;
      break;
    case 5:
      c->reach = 50;
      break;
    case 6:
      c->range = 1e-3f;
      break;
    case 7:
      c->range = 100;
      break;
    case 8:
      c->levels = 1;
      break;
    case 9:
      c->levels = 32, c->bright_threshold = 0, c->dark_threshold = 1;
      break;
    case 10:
      c->critical_angle = 0, c->angle_interval = 0;
      break;
    case 11:
      c->critical_angle = 90, c->angle_interval = 90;
      break;
    case 12:
      c->clearness = 1e6f, c->bending = 10;
      break;
    default:
      c->outline = 16, c->crease_angle = 0;
      break;
    }
    degenerate_expect_picture(harness, what, &w->frame, &degenerate_view, &settings);
    degenerate_expect_layer(harness, what, "normal", &w->frame, &degenerate_view, &settings);
  }
  free(w);
}

// ---- Pictures --------------------------------------------------------------------------------------------------------

static void test_odd_pictures(void **state) {
  (void)state;
  DrawnWater *w = tank_create();
  add_pool(w);
  for (int k = 0; k < DEGENERATE_SIZES; ++k) {
    Harness harness = harness_open(CONTEXT_AUTO, degenerate_sizes[k][0], degenerate_sizes[k][1]);
    expect_clean(&harness, "odd picture", &w->frame, &degenerate_view);
    harness_close(&harness);
  }
  free(w);
}

// One renderer, whose size, style and resolution of maps change between frames, draws what a new one draws.
static void test_changes(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, 70, 45);
  DrawnWater *w = tank_create(), *none = tank_create();
  add_pool(w);
  // Every particle is of a colour of its own, but in the first picture of each size.
  float *colour = malloc(3 * sizeof *colour * (size_t)w->frame.count);
  for (int32_t i = 0; i < 3 * w->frame.count; ++i) colour[i] = 0.1f * (float)(i % 11);
  RenderError error = {0};
  for (int k = 0; k < DEGENERATE_SIZES; ++k) {
    harness.width = degenerate_sizes[k][0];
    harness.height = degenerate_sizes[k][1];
    assert_true(render_resize(harness.render, harness.width, harness.height, &error));
    for (int way = 0; way < WAYS; ++way) {
      const RenderSettings settings = settings_of((way + k) % WAYS);
      w->frame.colour = way == 0 ? NULL : colour;
      degenerate_expect_picture(&harness, "changes", way == 2 ? &none->frame : &w->frame, &degenerate_view, &settings);
    }
    free(picture_of(&harness, &w->frame, "points"));
  }
  const size_t size = 3 * (size_t)harness.width * (size_t)harness.height;
  uint8_t *old[WAYS];
  for (int way = 0; way < WAYS; ++way) {
    const RenderSettings settings = settings_of(way);
    old[way] = harness_draw(&harness, &w->frame, &degenerate_view, &settings);
  }
  harness_close(&harness);
  for (int way = 0; way < WAYS; ++way) {
    Harness fresh = harness_open(CONTEXT_AUTO, degenerate_sizes[DEGENERATE_SIZES - 1][0],
                                 degenerate_sizes[DEGENERATE_SIZES - 1][1]);
    const RenderSettings settings = settings_of(way);
    uint8_t *new = harness_draw(&fresh, &w->frame, &degenerate_view, &settings);
    assert_memory_equal(old[way], new, size);
    free(old[way]);
    free(new);
    harness_close(&fresh);
  }
  free(colour);
  free(w);
  free(none);
}

static int open_harness(void **state) {
  return harness_open_group(state, 70, 45);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_few_particles),
      cmocka_unit_test(test_none_after_some),
      cmocka_unit_test(test_invalid_particles),
      cmocka_unit_test(test_odd_radii),
      cmocka_unit_test(test_odd_colours),
      cmocka_unit_test(test_all_in_one_place),
      cmocka_unit_test(test_eyes),
      cmocka_unit_test(test_odd_containers),
      cmocka_unit_test(test_extreme_settings),
      cmocka_unit_test(test_odd_pictures),
      cmocka_unit_test(test_changes),
  };
  return cmocka_run_group_tests(tests, open_harness, harness_close_group);
}
