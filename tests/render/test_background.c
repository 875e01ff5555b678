// Sky, floor and obstacles against computed truth.
#include "tests/render/harness.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 200
#define HEIGHT 120

static const TestFrame *empty_frame(void) {
  static TestFrame frame;
  if (frame.frame.particle_radius == 0) {
    TestFrame *made = test_frame_create(1, 0.0175f);
    frame.frame = made->frame;
    frame.frame.has_container = false;
    frame.frame.position = NULL;
    frame.frame.obstacles = NULL;
    test_frame_destroy(made);
  }
  return &frame;
}

static int expected_byte(double linear) {
  const double clamped = linear < 0 ? 0 : (linear > 1 ? 1 : linear);
  return (int)floor(255 * clamped + 0.5);
}

static void assert_pixel(const uint8_t *rgb, int32_t x, int32_t y, const double truth[3]) {
  for (int k = 0; k < 3; ++k) {
    const int got = rgb[3 * (y * WIDTH + x) + k], want = expected_byte(truth[k]);
    if (abs(got - want) > 1) fail_msg("pixel %d, %d, channel %d: %d, should be %d", x, y, k, got, want);
  }
}

static void sky_truth(const RenderSettings *settings, const Ray *ray, double truth[3]) {
  const double *d = ray->direction;
  const double up = fmax(0, d[1] / sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]));
  for (int k = 0; k < 3; ++k) {
    truth[k] = (double)settings->sky_horizon[k] * (1 - up) + (double)settings->sky_zenith[k] * up;
  }
}

static void test_gradient_sky(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  RenderSettings settings = harness_pinned_settings();
  settings.floor = RENDER_FLOOR_NONE;
  const RenderView view = harness_view(0, 1, 0, 0.3f, 1.2f, -1, 100);
  uint8_t *rgb = harness_draw(&harness, &empty_frame()->frame, &view, &settings);
  for (int32_t y = 0; y < HEIGHT; ++y) {
    for (int32_t x = 0; x < WIDTH; ++x) {
      const Ray ray = harness_ray(&view, WIDTH, HEIGHT, x, y);
      double truth[3];
      sky_truth(&settings, &ray, truth);
      assert_pixel(rgb, x, y, truth);
    }
  }
  free(rgb);
  harness_close(&harness);
}

// The checker, its horizon and the sky above it, over a floor that is not at zero.
static void test_checker_floor(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  RenderSettings settings = harness_pinned_settings();
  settings.floor_level = -0.25f;
  settings.tile_size = 0.3f;
  memcpy(settings.floor_colour, (float[2][3]){{0.9f, 0.5f, 0.1f}, {0.1f, 0.2f, 0.35f}}, sizeof settings.floor_colour);
  const RenderView view = harness_view(-1, 1.5f, 2, 0.5f, 0.6f, -1, 60);
  uint8_t *rgb = harness_draw(&harness, &empty_frame()->frame, &view, &settings);
  int floors = 0;
  for (int32_t y = 0; y < HEIGHT; ++y) {
    for (int32_t x = 0; x < WIDTH; ++x) {
      const Ray ray = harness_ray(&view, WIDTH, HEIGHT, x, y);
      double truth[3];
      const double t = (-0.25 - ray.origin[1]) / ray.direction[1];
      if (t <= 0) {
        sky_truth(&settings, &ray, truth);
        assert_pixel(rgb, x, y, truth);
        continue;
      }
      const double u = (ray.origin[0] + t * ray.direction[0]) / (double)settings.tile_size;
      const double v = (ray.origin[2] + t * ray.direction[2]) / (double)settings.tile_size;
      // On the very border of a square, single precision may decide either way.
      if (fabs(u - round(u)) < 1e-5 * t * t || fabs(v - round(v)) < 1e-5 * t * t) continue;
      const int odd = (int)fmod(fabs(floor(u) + floor(v)), 2);
      for (int k = 0; k < 3; ++k) truth[k] = (double)settings.floor_colour[odd][k];
      assert_pixel(rgb, x, y, truth);
      ++floors;
    }
  }
  assert_true(floors > WIDTH * HEIGHT / 2);
  free(rgb);
  harness_close(&harness);
}

static void test_tone_none_clamps_and_scales(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  RenderSettings settings = harness_pinned_settings();
  const float colours[2][3] = {{0, 0.25f, 7}, {0, 0.25f, 7}};
  memcpy(settings.floor_colour, colours, sizeof colours);
  settings.exposure = 0.5f; // has no say here
  const RenderView view = harness_view(0, 2, 0, 0.1f, 0, 0, 40);
  uint8_t *rgb = harness_draw(&harness, &empty_frame()->frame, &view, &settings);
  for (int32_t i = 0; i < WIDTH * HEIGHT; ++i) {
    assert_int_equal(rgb[3 * i], 0);
    assert_in_range(rgb[3 * i + 1], 63, 64);
    assert_int_equal(rgb[3 * i + 2], 255);
  }
  free(rgb);
  harness_close(&harness);
}

// ---- Obstacles -------------------------------------------------------------------------------------------------------

// Is the point inside the body? The slow truth below needs nothing else.
static double outside_distance(const SimObstacle *o, const double local[3]) {
  const double r = (double)o->size[0] / 2;
  switch (o->shape) {
  case SIM_SPHERE:
    return sqrt(local[0] * local[0] + local[1] * local[1] + local[2] * local[2]) - r;
  case SIM_CYLINDER:
    return fmax(sqrt(local[0] * local[0] + local[2] * local[2]) - r, fabs(local[1]) - (double)o->size[1] / 2);
  default:
    return fmax(fabs(local[0]) - (double)o->size[0] / 2,
                fmax(fabs(local[1]) - (double)o->size[1] / 2, fabs(local[2]) - (double)o->size[2] / 2));
  }
}

// March along the ray in small steps, then bisect: no formula in common with the shader. 0 when nothing is met.
// *grazing: how near to its surface the ray passes when it misses, or how deep it goes when it hits.
static double marched_depth(const SimObstacle *o, const Ray *ray, double *grazing) {
  double best = 1e30, hit = 0;
  const double step = 0.004;
  for (double t = 0.5; t < 6; t += step) {
    double local[3];
    for (int k = 0; k < 3; ++k) local[k] = ray->origin[k] + t * ray->direction[k] - (double)o->position[k];
    harness_to_body(local, o->rotation);
    const double d = outside_distance(o, local);
    if (d < best) best = d;
    if (d < 0 && hit == 0) {
      double low = t - step, high = t;
      for (int i = 0; i < 40; ++i) {
        const double middle = (low + high) / 2;
        for (int k = 0; k < 3; ++k) local[k] = ray->origin[k] + middle * ray->direction[k] - (double)o->position[k];
        harness_to_body(local, o->rotation);
        if (outside_distance(o, local) < 0) {
          high = middle;
        } else {
          low = middle;
        }
      }
      hit = high;
    }
  }
  *grazing = fabs(best);
  return hit;
}

static void check_obstacle(const SimObstacle *obstacle) {
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  RenderSettings settings = harness_pinned_settings();
  settings.floor = RENDER_FLOOR_NONE;
  const RenderView view = harness_view(0.8f, 1.6f, 3, 0, 0.5f, 0, 35);
  SimFrame frame = empty_frame()->frame;
  frame.obstacle_count = 1;
  frame.obstacles = obstacle;
  float *depth = harness_layer(&harness, "background_depth", 1, &frame, &view, &settings);
  int covered = 0;
  for (int32_t y = 0; y < HEIGHT; y += 2) {
    for (int32_t x = 0; x < WIDTH; x += 2) {
      const Ray ray = harness_ray(&view, WIDTH, HEIGHT, x, y);
      double grazing;
      const double truth = marched_depth(obstacle, &ray, &grazing);
      if (grazing < 0.01) continue;
      covered += truth > 0;
      if (fabs((double)depth[y * WIDTH + x] - truth) > 2e-4) {
        fail_msg("pixel %d, %d: depth %.7g, should be %.7g", x, y, (double)depth[y * WIDTH + x], truth);
      }
    }
  }
  assert_true(covered > 200);
  free(depth);
  harness_close(&harness);
}

static void test_box_depth(void **state) {
  (void)state;
  const SimObstacle box = {SIM_BOX, {0.9f, 0.5f, 0.6f}, {0.1f, 0.5f, 0}, {0.2f, 0.3f, 0.1f, 0.9273618f}, {1, 1, 1}};
  check_obstacle(&box);
}

static void test_sphere_depth(void **state) {
  (void)state;
  const SimObstacle sphere = {SIM_SPHERE, {0.9f, 0, 0}, {-0.1f, 0.6f, 0.2f}, {0, 0, 0, 1}, {1, 1, 1}};
  check_obstacle(&sphere);
}

static void test_cylinder_depth(void **state) {
  (void)state;
  const SimObstacle cylinder = {
      SIM_CYLINDER, {0.6f, 0.8f, 0}, {0.1f, 0.5f, 0}, {0.4f, 0.1f, 0.2f, 0.8888194f}, {1, 1, 1}};
  check_obstacle(&cylinder);
  const SimObstacle upright = {SIM_CYLINDER, {0.6f, 0.8f, 0}, {0.1f, 0.5f, 0}, {0, 0, 0, 1}, {1, 1, 1}};
  check_obstacle(&upright);
}

// ---- Light -----------------------------------------------------------------------------------------------------------

static double mean_red(const uint8_t *rgb, int32_t x0, int32_t y0, int32_t x1, int32_t y1, int channel) {
  double sum = 0;
  for (int32_t y = y0; y < y1; ++y) {
    for (int32_t x = x0; x < x1; ++x) sum += rgb[3 * (y * WIDTH + x) + channel];
  }
  return sum / ((x1 - x0) * (y1 - y0));
}

// Straight sunlight from the left, 45°: a box at the origin of height 0.5 darkens the floor to x = 0.25 + 0.5.
static void test_obstacle_shadow_falls_where_it_should(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  RenderSettings settings = render_default_settings();
  settings.tone_map = RENDER_TONE_NONE;
  settings.floor_level = 0;
  settings.tile_size = 100;
  memcpy(settings.sun_direction, (float[3]){-1, 1, 0}, sizeof settings.sun_direction);
  const SimObstacle box = {SIM_BOX, {0.5f, 0.5f, 0.5f}, {0, 0.25f, 0}, {0, 0, 0, 1}, {0.5f, 0.5f, 0.5f}};
  SimFrame frame = empty_frame()->frame;
  frame.obstacles = &box;
  // From high above: 40 pixels a metre and more; x to the right, z downwards.
  const RenderView view = harness_view(0, 20, 0.01f, 0, 0, 0, 8);
  uint8_t *open = harness_draw(&harness, &frame, &view, &settings);
  frame.obstacle_count = 1;
  uint8_t *shaded = harness_draw(&harness, &frame, &view, &settings);
  settings.shadow = false;
  uint8_t *unshaded = harness_draw(&harness, &frame, &view, &settings);
  const double metre = HEIGHT / (2 * 20 * tan(4 * 3.14159265 / 180));
  const int32_t cx = WIDTH / 2, cy = HEIGHT / 2, x0 = cx + (int32_t)(0.35 * metre), x1 = cx + (int32_t)(0.65 * metre);
  const double lit = mean_red(open, x0, cy - 4, x1, cy + 4, 0);
  assert_true(lit > 60);
  assert_true(mean_red(shaded, x0, cy - 4, x1, cy + 4, 0) < 0.5 * lit);
  assert_true(fabs(mean_red(unshaded, x0, cy - 4, x1, cy + 4, 0) - lit) < 2);
  // Beyond its end, and on the sunny side, there is none.
  const int32_t far_x = cx + (int32_t)(0.9 * metre), near_x = cx - (int32_t)(0.6 * metre);
  assert_true(fabs(mean_red(shaded, far_x, cy - 4, far_x + 6, cy + 4, 0) -
                   mean_red(open, far_x, cy - 4, far_x + 6, cy + 4, 0)) < 2);
  assert_true(fabs(mean_red(shaded, near_x, cy - 4, near_x + 6, cy + 4, 0) -
                   mean_red(open, near_x, cy - 4, near_x + 6, cy + 4, 0)) < 2);
  free(open);
  free(shaded);
  free(unshaded);
  harness_close(&harness);
}

// The shadow of water lets green and blue through rather than red.
static void test_water_shadow_is_tinted(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  RenderSettings settings = render_default_settings();
  settings.tone_map = RENDER_TONE_NONE;
  settings.floor_level = -1;
  settings.tile_size = 100;
  settings.container_visible = false;
  memcpy(settings.sun_direction, (float[3]){-1, 1, 0}, sizeof settings.sun_direction);
  TestFrame *t = test_frame_create(16 * 16 * 16, 0.02f);
  uint8_t *pictures[2];
  // The block hangs at x ≈ 0, y ≈ 0, one metre over the floor, so its shadow lies around x = 1.
  const RenderView view = harness_view(1, 20, 0.01f, 1, 0, 0, 8);
  pictures[0] = harness_draw(&harness, &t->frame, &view, &settings);
  for (int i = 0; i < 16 * 16 * 16; ++i) {
    test_frame_add(t, 0.04f * ((float)(i % 16) - 7.5f), 0.04f * ((float)(i / 16 % 16) - 7.5f),
                   0.04f * ((float)(i / 256) - 7.5f));
  }
  t->frame.has_container = false;
  pictures[1] = harness_draw(&harness, &t->frame, &view, &settings);
  double kept[3];
  for (int k = 0; k < 3; ++k) {
    kept[k] = mean_red(pictures[1], WIDTH / 2 - 5, HEIGHT / 2 - 5, WIDTH / 2 + 5, HEIGHT / 2 + 5, k) /
              mean_red(pictures[0], WIDTH / 2 - 5, HEIGHT / 2 - 5, WIDTH / 2 + 5, HEIGHT / 2 + 5, k);
  }
  assert_true(kept[0] < 0.6);
  assert_true(kept[1] < 0.95 && kept[1] > kept[0] + 0.1);
  assert_true(kept[2] > kept[0] + 0.1);
  free(pictures[0]);
  free(pictures[1]);
  test_frame_destroy(t);
  harness_close(&harness);
}

// The container is drawn when asked for, and then only as thin lines and faint glass.
static void test_container_edges(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  RenderSettings settings = harness_pinned_settings();
  const float colours[2][3] = {{0.2f, 0.2f, 0.2f}, {0.2f, 0.2f, 0.2f}};
  memcpy(settings.floor_colour, colours, sizeof colours);
  const RenderView view = harness_view(1.5f, 3, 5, 1.5f, 0.5f, 0.5f, 38);
  TestFrame *t = test_frame_create(1, 0.0175f);
  uint8_t *without = harness_draw(&harness, &t->frame, &view, &settings);
  settings.container_visible = true;
  uint8_t *with = harness_draw(&harness, &t->frame, &view, &settings);
  int strong = 0;
  for (int32_t i = 0; i < WIDTH * HEIGHT; ++i) strong += abs(with[3 * i] - without[3 * i]) > 40;
  assert_in_range(strong, 150, WIDTH * HEIGHT / 8);
  free(without);
  free(with);
  test_frame_destroy(t);
  harness_close(&harness);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_gradient_sky),
      cmocka_unit_test(test_checker_floor),
      cmocka_unit_test(test_tone_none_clamps_and_scales),
      cmocka_unit_test(test_box_depth),
      cmocka_unit_test(test_sphere_depth),
      cmocka_unit_test(test_cylinder_depth),
      cmocka_unit_test(test_obstacle_shadow_falls_where_it_should),
      cmocka_unit_test(test_water_shadow_is_tinted),
      cmocka_unit_test(test_container_edges),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
