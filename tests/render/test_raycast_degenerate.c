// The style "raycast" on frames that nobody checked: it draws, no layer holds what is not a number, GL says nothing.
#include "tests/render/cloud.h"
#include "tests/render/degenerate.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define RADIUS DEGENERATE_RADIUS
#define SPACING (2 * RADIUS)

static RenderSettings settings_of_raycast(void) {
  RenderSettings settings = render_default_settings();
  settings.style = "raycast";
  return settings;
}

// The picture, and the layers from which a number that is none could still be lost on the way to it.
static void expect_clean(Harness *harness, const char *what, const SimFrame *frame, const RenderView *view) {
  static const char *const maps[] = {"depth", "normal", "behind"};
  const RenderSettings settings = settings_of_raycast();
  degenerate_expect_picture(harness, what, frame, view, &settings);
  for (int i = 0; i < 3; ++i) degenerate_expect_layer(harness, what, maps[i], frame, view, &settings);
}

// ---- Frames ----------------------------------------------------------------------------------------------------------

// Particles in one cell, which may be anywhere.
typedef struct Hand {
  SimFrame frame;
  float position[3 * 64], radius[64];
  int32_t cell_start[2];
} Hand;

static void hand_add(Hand *h, float x, float y, float z) {
  const int32_t i = h->frame.count++;
  const float p[3] = {x, y, z};
  assert_true(i < 64);
  memcpy(h->position + 3 * i, p, sizeof p);
  h->radius[i] = RADIUS;
  h->cell_start[1] = h->frame.count;
}

// A block of 3 × 3 × 3 particles in the tank.
static Hand *hand_create(void) {
  Hand *h = calloc(1, sizeof *h);
  assert_non_null(h);
  h->frame = (SimFrame){.particle_radius = RADIUS,
                        .position = h->position,
                        .bounds_max = {1, 1, 0.5f},
                        .container = degenerate_tank,
                        .has_container = true,
                        .grid = {.cell_size = 1, .size = {1, 1, 1}, .cell_start = h->cell_start}};
  return h;
}

static void hand_add_block(Hand *h) {
  for (int i = 0; i < 27; ++i) {
    hand_add(h, 0.5f + SPACING * (float)(i % 3), 0.3f + SPACING * (float)(i / 3 % 3), 0.25f + SPACING * (float)(i / 9));
  }
}

static void add_to_cloud(void *to, float x, float y, float z, bool drop) {
  (void)drop;
  cloud_add(to, x, y, z);
}

static TestWater pool_in_tank(void) {
  Cloud *cloud = cloud_create(RADIUS);
  degenerate_pool(cloud, add_to_cloud);
  TestWater water = cloud_water(cloud, CLOUD_PLAIN, &degenerate_tank);
  free(cloud);
  return water;
}

// ---- Particles -------------------------------------------------------------------------------------------------------

static void test_few_particles(void **state) {
  Harness *harness = *state;
  Hand *h = hand_create();
  expect_clean(harness, "none", &h->frame, &degenerate_view);
  hand_add(h, 0.5f, 0.3f, 0.25f);
  expect_clean(harness, "one", &h->frame, &degenerate_view);
  hand_add(h, 0.5f + SPACING, 0.3f, 0.25f);
  expect_clean(harness, "two", &h->frame, &degenerate_view);
  hand_add(h, 0.5f - SPACING, 0.3f, 0.25f);
  expect_clean(harness, "three in a row", &h->frame, &degenerate_view);
  const RenderSettings settings = settings_of_raycast();
  degenerate_expect_clean(harness, "every layer", &h->frame, &degenerate_view, &settings);
  h->frame.has_container = false;
  expect_clean(harness, "without a container", &h->frame, &degenerate_view);
  free(h);
}

static void test_none_is_the_background(void **state) {
  Harness *harness = *state;
  Hand *h = hand_create();
  RenderSettings settings = settings_of_raycast();
  uint8_t *empty = harness_draw(harness, &h->frame, &degenerate_view, &settings);
  settings.style = "points";
  uint8_t *points = harness_draw(harness, &h->frame, &degenerate_view, &settings);
  settings.style = "raycast";
  const size_t size = 3 * (size_t)harness->width * (size_t)harness->height;
  assert_memory_equal(empty, points, size);
  // Particles that are all invalid are none.
  hand_add(h, NAN, 0, 0);
  hand_add(h, 0, INFINITY, 0);
  hand_add(h, 0, 0, -1e30f);
  uint8_t *invalid = harness_draw(harness, &h->frame, &degenerate_view, &settings);
  assert_memory_equal(empty, invalid, size);
  free(empty);
  free(points);
  free(invalid);
  free(h);
}

// What makes no sense is left out, and the rest is as it would be without.
static void test_invalid_particles(void **state) {
  Harness *harness = *state;
  Hand *clean = hand_create(), *dirty = hand_create();
  const float *bad = degenerate_places;
  hand_add_block(clean);
  hand_add_block(dirty);
  for (int i = 0; i < 18; ++i) {
    hand_add(dirty, 0.5f, 0.6f, 0.25f);
    dirty->position[3 * (dirty->frame.count - 1) + i % 3] = bad[i % 6];
  }
  RenderSettings settings = settings_of_raycast();
  settings.sun = false; // its shadows are of all that has a place
  uint8_t *a = harness_draw(harness, &clean->frame, &degenerate_view, &settings);
  uint8_t *b = harness_draw(harness, &dirty->frame, &degenerate_view, &settings);
  assert_memory_equal(a, b, 3 * (size_t)harness->width * (size_t)harness->height);
  expect_clean(harness, "invalid", &dirty->frame, &degenerate_view);
  free(a);
  free(b);
  free(clean);
  free(dirty);
}

// Valid ones that are far out of the grid are in the cells at its border.
static void test_far_particles(void **state) {
  Harness *harness = *state;
  Hand *h = hand_create();
  hand_add_block(h);
  static const float far[] = {1e3f, -1e3f, 9e5f, -9e5f};
  for (int i = 0; i < 12; ++i) {
    hand_add(h, 0.5f, 0.6f, 0.25f);
    h->position[3 * (h->frame.count - 1) + i % 3] = far[i % 4];
  }
  expect_clean(harness, "far", &h->frame, &degenerate_view);
  h->frame.has_container = false;
  expect_clean(harness, "far, no container", &h->frame, &degenerate_view);
  free(h);
}

static void test_odd_radii(void **state) {
  Harness *harness = *state;
  Hand *h = hand_create();
  hand_add_block(h);
  for (int i = 0; i < 27; ++i) h->radius[i] = degenerate_radii[i % DEGENERATE_RADII];
  h->frame.radius = h->radius;
  expect_clean(harness, "radii", &h->frame, &degenerate_view);
  h->frame.radius = NULL;
  for (int k = 0; k < DEGENERATE_FRAME_RADII; ++k) {
    char what[48];
    snprintf(what, sizeof what, "a frame's radius of %g", (double)degenerate_frame_radii[k]);
    h->frame.particle_radius = degenerate_frame_radii[k];
    expect_clean(harness, what, &h->frame, &degenerate_view);
  }
  free(h);
}

// Every sample of the field asks all of them: it must still come to an end.
static void test_all_in_one_place(void **state) {
  Harness *harness = *state;
  const int32_t count = 50000;
  float *position = malloc(3 * (size_t)count * sizeof *position);
  for (int32_t i = 0; i < count; ++i) {
    const float p[3] = {0.5f, 0.3f, 0.25f};
    memcpy(position + 3 * i, p, sizeof p);
  }
  const SimParticleSet set = {.count = count, .position = position, .particle_radius = RADIUS};
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  SimError error = {0};
  const SimFrame *frame = sim_frame_from_particles(&set, SIM_NEED_NOTHING, 1, buffer, &error);
  if (frame == NULL) fail_msg("%s", error.message);
  const RenderSettings settings = settings_of_raycast();
  struct timespec begin, end;
  timespec_get(&begin, TIME_UTC);
  degenerate_expect_picture(harness, "all in one place", frame, &degenerate_view, &settings);
  timespec_get(&end, TIME_UTC);
  const double seconds = (double)(end.tv_sec - begin.tv_sec) + 1e-9 * (double)(end.tv_nsec - begin.tv_nsec);
  print_message("%d particles in one place: %.2f s\n", (int)count, seconds);
  assert_true(seconds < 60);
  degenerate_expect_layer(harness, "all in one place", "normal", frame, &degenerate_view, &settings);
  sim_frame_buffer_destroy(buffer);
  free(position);
}

// ---- Eyes ------------------------------------------------------------------------------------------------------------

static void test_eyes(void **state) {
  Harness *harness = *state;
  TestWater water = pool_in_tank();
  for (int k = 0; k < DEGENERATE_EYES; ++k) {
    char what[32];
    snprintf(what, sizeof what, "view %d", k);
    expect_clean(harness, what, &water.frame, &degenerate_eyes[k]);
  }
  water.frame.has_container = false;
  expect_clean(harness, "eye in open water", &water.frame, &degenerate_eyes[0]);
  RenderView at_particle = degenerate_eyes[0];
  memcpy(at_particle.eye, water.frame.position + 3 * (water.frame.count / 2), sizeof at_particle.eye);
  expect_clean(harness, "eye at a particle", &water.frame, &at_particle);
  test_water_destroy(&water);
}

// ---- Containers ------------------------------------------------------------------------------------------------------

static void test_odd_containers(void **state) {
  Harness *harness = *state;
  const RenderSettings settings = settings_of_raycast();
  Hand *h = hand_create();
  hand_add_block(h);
  for (int k = 0; k < DEGENERATE_CONTAINERS; ++k) {
    for (int shape = 0; shape < 3; ++shape) { // the last is none
      char what[48];
      snprintf(what, sizeof what, "container %d of shape %d", k, shape);
      h->frame.container = degenerate_containers[k];
      h->frame.container.shape = (SimContainerShape)(shape == 2 ? 9 : shape);
      degenerate_expect_picture(harness, what, &h->frame, &degenerate_view, &settings);
      degenerate_expect_layer(harness, what, "normal", &h->frame, &degenerate_view, &settings);
    }
  }
  free(h);
}

// ---- Pictures --------------------------------------------------------------------------------------------------------

static void test_odd_pictures(void **state) {
  (void)state;
  Hand *h = hand_create();
  hand_add_block(h);
  for (int k = 0; k < DEGENERATE_SIZES; ++k) {
    Harness harness = harness_open(CONTEXT_AUTO, degenerate_sizes[k][0], degenerate_sizes[k][1]);
    expect_clean(&harness, "odd picture", &h->frame, &degenerate_view);
    harness_close(&harness);
  }
  free(h);
}

// One renderer, whose size and style change between frames, draws what a new one draws.
static void test_changes(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, 70, 45);
  Hand *h = hand_create();
  hand_add_block(h);
  static const char *const styles[] = {"raycast", "points", "raycast"};
  RenderError error = {0};
  for (int k = 0; k < DEGENERATE_SIZES; ++k) {
    harness.width = degenerate_sizes[k][0];
    harness.height = degenerate_sizes[k][1];
    assert_true(render_resize(harness.render, harness.width, harness.height, &error));
    for (int s = 0; s < 3; ++s) {
      RenderSettings settings = settings_of_raycast();
      settings.style = styles[s];
      degenerate_expect_picture(&harness, styles[s], &h->frame, &degenerate_view, &settings);
    }
  }
  const RenderSettings settings = settings_of_raycast();
  uint8_t *old = harness_draw(&harness, &h->frame, &degenerate_view, &settings);
  Harness fresh = harness_open(CONTEXT_AUTO, harness.width, harness.height);
  uint8_t *new = harness_draw(&fresh, &h->frame, &degenerate_view, &settings);
  assert_memory_equal(old, new, 3 * (size_t)harness.width * (size_t)harness.height);
  free(old);
  free(new);
  harness_close(&fresh);
  harness_close(&harness);
  free(h);
}

static int open_harness(void **state) {
  return harness_open_group(state, 70, 45);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_few_particles),     cmocka_unit_test(test_none_is_the_background),
      cmocka_unit_test(test_invalid_particles), cmocka_unit_test(test_far_particles),
      cmocka_unit_test(test_odd_radii),         cmocka_unit_test(test_eyes),
      cmocka_unit_test(test_odd_containers),    cmocka_unit_test(test_all_in_one_place),
      cmocka_unit_test(test_odd_pictures),      cmocka_unit_test(test_changes),
  };
  return cmocka_run_group_tests(tests, open_harness, harness_close_group);
}
