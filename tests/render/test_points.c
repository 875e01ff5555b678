// The points style against computed truth: the sphere that each pixel's ray meets first, worked out in C.
#include "tests/render/harness.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define WIDTH 160
#define HEIGHT 120
#define RADIUS 0.2f

// A row of spheres through the picture, some overlapping, some cut by its border, one far away.
static TestFrame *spheres(void) {
  TestFrame *t = test_frame_create(8, RADIUS);
  test_frame_add(t, 0, 1, 0);
  test_frame_add(t, 0.3f, 1.1f, 0.1f);
  test_frame_add(t, -1.9f, 1.9f, 0.5f);
  test_frame_add(t, 2.0f, -0.1f, 0.2f);
  test_frame_add(t, -0.9f, 0.6f, -6);
  test_frame_add(t, 0.75f, 1.3f, 2.6f);
  t->frame.has_container = false;
  return t;
}

typedef struct Truth {
  int32_t sphere; // −1: none
  double depth, normal[3];
  double margin; // of the ray against the silhouette that is nearest to it, in radii
  double exit;
} Truth;

static Truth truth_at(const SimFrame *frame, const Ray *ray, double radius) {
  Truth truth = {.sphere = -1, .depth = 1e30, .margin = 1e30};
  for (int32_t i = 0; i < frame->count; ++i) {
    const float *centre = frame->position + 3 * i;
    double t[2], margin;
    const bool hit = harness_ray_sphere(ray, centre, radius, t, &margin);
    if (fabs(margin) < fabs(truth.margin)) truth.margin = margin;
    if (!hit || t[0] >= truth.depth || t[0] < 1e-3) continue;
    truth.sphere = i;
    truth.depth = t[0];
    for (int k = 0; k < 3; ++k) {
      truth.normal[k] = (ray->origin[k] + ray->direction[k] * t[0] - (double)centre[k]) / radius;
    }
  }
  return truth;
}

// Compare both layers with the truth at every pixel that is not on a silhouette; returns the number of pixels with water.
static int compare_layers(const SimFrame *frame, const RenderView *view, double radius, const float *depth,
                          const float *normal) {
  int covered = 0;
  for (int32_t y = 0; y < HEIGHT; ++y) {
    for (int32_t x = 0; x < WIDTH; ++x) {
      const size_t i = (size_t)y * WIDTH + (size_t)x;
      const Ray ray = harness_ray(view, WIDTH, HEIGHT, x, y);
      const Truth truth = truth_at(frame, &ray, radius);
      if (fabs(truth.margin) < 2e-3) continue;
      if (truth.sphere < 0) {
        if (depth[i] != 0) fail_msg("pixel %d, %d: depth %g where there is nothing", x, y, (double)depth[i]);
        continue;
      }
      ++covered;
      if (fabs((double)depth[i] - truth.depth) > 1e-4 * truth.depth) {
        fail_msg("pixel %d, %d: depth %.7g, should be %.7g", x, y, (double)depth[i], truth.depth);
      }
      for (int k = 0; k < 3; ++k) {
        if (fabs((double)normal[3 * i + (size_t)k] - truth.normal[k]) > 5e-3) {
          fail_msg("pixel %d, %d: normal[%d] %.5g, should be %.5g", x, y, k, (double)normal[3 * i + (size_t)k],
                   truth.normal[k]);
        }
      }
    }
  }
  return covered;
}

static void check_surface(float scale, const RenderView *view, int least_covered) {
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  RenderSettings settings = harness_pinned_settings();
  settings.floor = RENDER_FLOOR_NONE;
  settings.points.scale = scale;
  TestFrame *t = spheres();
  float *depth = harness_layer(&harness, "depth", 1, &t->frame, view, &settings);
  float *normal = harness_layer(&harness, "normal", 3, &t->frame, view, &settings);
  const int covered = compare_layers(&t->frame, view, (double)(RADIUS * scale), depth, normal);
  if (covered < least_covered) fail_msg("only %d pixels of water", covered);
  free(depth);
  free(normal);
  test_frame_destroy(t);
  harness_close(&harness);
}

static void test_surface_from_the_front(void **state) {
  (void)state;
  const RenderView view = harness_view(0, 1, 5, 0, 1, 0, 45);
  check_surface(1.25f, &view, 900);
}

static void test_surface_wide_and_tilted(void **state) {
  (void)state;
  const RenderView view = harness_view(1, 2.5f, 2.5f, 0.1f, 0.7f, -0.3f, 110);
  check_surface(1.0f, &view, 250);
}

static void test_surface_from_straight_above(void **state) {
  (void)state;
  // Nearly vertical, so that "up" is at its limit; the truth's camera still has one.
  const RenderView view = harness_view(0.2f, 5, 0.201f, 0.2f, 1, 0.1f, 40);
  check_surface(1.25f, &view, 300);
}

// Chords add up to the volume of water: of one sphere, each chord counts 6/(π scale³).
static void test_thickness_is_the_chord(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  RenderSettings settings = harness_pinned_settings();
  settings.floor = RENDER_FLOOR_NONE;
  const RenderView view = harness_view(0, 1, 3, 0, 1, 0, 30);
  TestFrame *t = test_frame_create(1, RADIUS);
  test_frame_add(t, 0, 1, 0);
  float *thickness = harness_layer(&harness, "thickness", 1, &t->frame, &view, &settings);
  const double radius = 1.25 * (double)RADIUS;
  int covered = 0;
  for (int32_t y = 0; y < HEIGHT; y += 2) {
    for (int32_t x = 0; x < WIDTH; x += 2) {
      // The layer has half the resolution: its pixel is as large as four of the picture.
      const Ray ray = harness_ray(&view, WIDTH / 2, HEIGHT / 2, x / 2, y / 2);
      const double length = sqrt(ray.direction[0] * ray.direction[0] + ray.direction[1] * ray.direction[1] +
                                 ray.direction[2] * ray.direction[2]);
      double hit[2] = {0, 0}, margin;
      harness_ray_sphere(&ray, t->position, radius, hit, &margin);
      if (fabs(margin) < 2e-3) continue;
      const double truth = (hit[1] - hit[0]) * length * 6 / (3.14159265 * 1.25 * 1.25 * 1.25);
      covered += truth > 0;
      if (fabs((double)thickness[y * WIDTH + x] - truth) > 1e-4) {
        fail_msg("pixel %d, %d: %.6g m, should be %.6g", x, y, (double)thickness[y * WIDTH + x], truth);
      }
    }
  }
  assert_true(covered > 200);
  free(thickness);
  test_frame_destroy(t);
  harness_close(&harness);
}

// Water behind a wall does not count, water before it does.
static void test_thickness_ends_at_obstacles(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  RenderSettings settings = harness_pinned_settings();
  settings.floor = RENDER_FLOOR_NONE;
  const RenderView view = harness_view(0, 1, 4, 0, 1, 0, 30);
  TestFrame *t = test_frame_create(2, RADIUS);
  test_frame_add(t, 0, 1, 0.5f);
  test_frame_add(t, 0, 1, -2);
  t->obstacles[0] = (SimObstacle){SIM_BOX, {2, 2, 0.1f}, {0, 1, -0.5f}, {0, 0, 0, 1}, {0.5f, 0.5f, 0.5f}};
  float *open = harness_layer(&harness, "thickness", 1, &t->frame, &view, &settings);
  t->frame.obstacle_count = 1;
  float *walled = harness_layer(&harness, "thickness", 1, &t->frame, &view, &settings);
  const size_t middle = (size_t)(HEIGHT / 2) * WIDTH + WIDTH / 2;
  const float one = 2 * 1.25f * RADIUS * 6 / (3.14159265f * 1.25f * 1.25f * 1.25f);
  assert_float_equal(open[middle], 2 * one, 0.02f * one);
  assert_float_equal(walled[middle], one, 0.02f * one);
  free(open);
  free(walled);
  test_frame_destroy(t);
  harness_close(&harness);
}

// A sphere hides the checker exactly where its disc is, and nowhere else.
static void test_sphere_occludes_the_checker(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  RenderSettings settings = harness_pinned_settings();
  settings.absorption[0] = settings.absorption[1] = settings.absorption[2] = 50;
  const RenderView view = harness_view(0.3f, 1.5f, 3, 0, 0.3f, 0, 45);
  TestFrame *t = test_frame_create(1, RADIUS);
  uint8_t *empty = harness_draw(&harness, &t->frame, &view, &settings);
  test_frame_add(t, 0, 0.5f, 0);
  uint8_t *full = harness_draw(&harness, &t->frame, &view, &settings);
  int inside = 0;
  for (int32_t y = 0; y < HEIGHT; ++y) {
    for (int32_t x = 0; x < WIDTH; ++x) {
      const Ray ray = harness_ray(&view, WIDTH, HEIGHT, x, y);
      double hit[2], margin;
      const bool water = harness_ray_sphere(&ray, t->position, 1.25 * (double)RADIUS, hit, &margin);
      const size_t i = 3 * ((size_t)y * WIDTH + (size_t)x);
      const bool changed = empty[i] != full[i] || empty[i + 1] != full[i + 1] || empty[i + 2] != full[i + 2];
      if (fabs(margin) < 2e-2) continue;
      inside += water;
      if (changed != water) fail_msg("pixel %d, %d is %s the sphere", x, y, water ? "not changed by" : "changed by");
    }
  }
  assert_true(inside > 300);
  free(empty);
  free(full);
  test_frame_destroy(t);
  harness_close(&harness);
}

// Froth is for what is sparse and fast: neither alone will do.
static void test_spray_needs_speed_and_sparseness(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  const RenderSettings settings = harness_pinned_settings();
  const RenderView view = harness_view(0, 1, 4, 0, 1, 0, 30);
  TestFrame *t = test_frame_create(64, 0.05f);
  for (int i = 0; i < 50; ++i) test_frame_add(t, 0.1f * (float)i - 2.5f, -3, 0); // the bulk, out of view
  test_frame_add(t, 0, 1, 0);
  const float speeds[2] = {0, 8}, densities[2] = {1000, 300};
  for (int fast = 0; fast < 2; ++fast) {
    for (int sparse = 0; sparse < 2; ++sparse) {
      t->velocity[3 * 50] = speeds[fast];
      t->density[50] = densities[sparse];
      float *spray = harness_layer(&harness, "spray", 1, &t->frame, &view, &settings);
      const float middle = spray[(HEIGHT / 2) * WIDTH + WIDTH / 2];
      if (fast && sparse) {
        assert_true(middle > 0.9f);
      } else {
        assert_true(middle == 0);
      }
      free(spray);
    }
  }
  test_frame_destroy(t);
  harness_close(&harness);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_surface_from_the_front),           cmocka_unit_test(test_surface_wide_and_tilted),
      cmocka_unit_test(test_surface_from_straight_above),      cmocka_unit_test(test_thickness_is_the_chord),
      cmocka_unit_test(test_thickness_ends_at_obstacles),      cmocka_unit_test(test_sphere_occludes_the_checker),
      cmocka_unit_test(test_spray_needs_speed_and_sparseness),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
