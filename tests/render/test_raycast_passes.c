// Passes of the style "raycast" behind its normals: the bilateral filter, and the metres of water behind the surface.
#include "tests/render/cloud.h"
#include "tests/render/reference/bilateral_normals.h"
#include "tests/render/reference/iso.h"

#include <math.h>
#include <stdlib.h>

#define WIDTH 96
#define HEIGHT 72
#define PIXELS (WIDTH * HEIGHT)
#define RADIUS 0.02f
#define SPACING (2 * RADIUS)
#define DEGREES (180 / 3.14159265358979323846)

static RenderSettings settings_of_raycast(void) {
  RenderSettings settings = harness_pinned_settings();
  settings.style = "raycast";
  settings.floor = RENDER_FLOOR_NONE;
  return settings;
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// ---- The bilateral filter --------------------------------------------------------------------------------------------

static double angle_between(const float a[3], const float b[3]) {
  double squares = 0;
  for (int k = 0; k < 3; ++k) squares += pow((double)a[k] - (double)b[k], 2);
  return 2 * asin(fmin(sqrt(squares) / 2, 1)) * DEGREES;
}

// The renderer takes nine taps along each axis of the window, the twin all pixels: they differ the more, the larger the window
// is and the narrower the filter. `most`: degrees by which 95 % of the normals may be off.
static void expect_filtered(Harness *harness, const TestWater *water, const RenderView *view, float reach, float angle,
                            double most) {
  RenderSettings settings = settings_of_raycast();
  settings.raycast.filter_reach = reach;
  settings.raycast.filter_angle = angle;
  float *depth = harness_layer(harness, "depth", 1, &water->frame, view, &settings);
  float *raw = harness_layer(harness, "raw_normal", 3, &water->frame, view, &settings);
  float *got = harness_layer(harness, "normal", 3, &water->frame, view, &settings);
  float *want = malloc(3 * PIXELS * sizeof *want);
  double *off = malloc(2 * PIXELS * sizeof *off), *moved = off + PIXELS;
  const BilateralNormals filter = {WIDTH, HEIGHT, tan((double)view->vertical_fov / 2 / DEGREES),
                                   (double)(reach * RADIUS), (double)angle};
  bilateral_normals(&filter, depth, raw, want);
  int pixels = 0;
  for (int i = 0; i < PIXELS; ++i) {
    if (depth[i] == 0) continue;
    off[pixels] = angle_between(got + 3 * i, want + 3 * i);
    moved[pixels++] = angle_between(raw + 3 * i, want + 3 * i);
  }
  qsort(off, (size_t)pixels, sizeof *off, ascending);
  qsort(moved, (size_t)pixels, sizeof *moved, ascending);
  print_message(
      "filter %g r, %.2g: %d pixels, off by %.2g, 95 %% by %.2g, at most %.2g; moved by %.2g, 95 %% by %.2g degrees\n",
      (double)reach, (double)angle, pixels, off[pixels / 2], off[pixels * 95 / 100], off[pixels - 1], moved[pixels / 2],
      moved[pixels * 95 / 100]);
  assert_true(pixels > PIXELS / 4);
  assert_true(off[pixels / 2] < 0.3);
  assert_true(off[pixels * 95 / 100] < most);
  assert_true(moved[pixels / 2] > 2 * off[pixels / 2]);
  free(depth);
  free(raw);
  free(got);
  free(want);
  free(off);
}

static void test_filter(void **state) {
  Harness *harness = *state;
  const RenderView far = {{0.7f, 0.8f, 0.75f}, {0, 0, 0}, 40}, middle = {{0.7f, 0.8f, 0.75f}, {0, 0, 0}, 28},
                   near = {{0.3f, 0.5f, 0.6f}, {0, 0.05f, 0.05f}, 16};
  Cloud *cloud = cloud_create(RADIUS);
  cloud_add_block(cloud, 14, 8, 12, 0.2f);
  TestWater water = cloud_water(cloud, CLOUD_PLAIN, NULL);
  expect_filtered(harness, &water, &middle, 3, 0.3f, 1);
  expect_filtered(harness, &water, &far, 3, 0.3f, 1);
  expect_filtered(harness, &water, &near, 3, 0.3f, 1.5);
  expect_filtered(harness, &water, &middle, 6, 0.1f, 2);
  expect_filtered(harness, &water, &middle, 1, 1, 1);
  test_water_destroy(&water);
  free(cloud);
}

// ---- Metres of water -------------------------------------------------------------------------------------------------

#define DEEP 8 // spacings: more is not followed

// At half the resolution one pixel of four is followed: the first with a surface, from the bottom. −1: there is none.
static int followed_pixel(const float *depth, int x, int y) {
  for (int k = 0; k < 4; ++k) {
    const int i = (2 * y + 1 - k / 2) * WIDTH + 2 * x + k % 2;
    if (depth[i] > 0) return i;
  }
  return -1;
}

// Snell's law where a ray comes into water; a normal that looks away from the eye is turned until the ray just comes in.
static void bend(const double ray[3], const float normal[3], double index, double way[3]) {
  double d[3], n[3], cosine = 0, length = 0;
  for (int k = 0; k < 3; ++k) length += ray[k] * ray[k];
  for (int k = 0; k < 3; ++k) cosine += (d[k] = ray[k] / sqrt(length)) * (double)normal[k];
  const double away = fmax(cosine + 0.02, 0);
  for (int k = 0; k < 3; ++k) n[k] = (double)normal[k] - away * d[k];
  length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  cosine = (d[0] * n[0] + d[1] * n[1] + d[2] * n[2]) / length;
  const double down = sqrt(1 - (1 - cosine * cosine) / (index * index)) + cosine / index;
  for (int k = 0; k < 3; ++k) way[k] = d[k] / index - down * n[k] / length;
}

// Errors of the metres of water along the bent ray, in spacings.
static void expect_metres(Harness *harness, const char *what, const Cloud *cloud) {
  const RenderView view = {{0.5f, 0.35f, 1.1f}, {0, 0, 0}, 28};
  const RenderSettings settings = settings_of_raycast();
  TestWater water = cloud_water(cloud, CLOUD_PLAIN, NULL);
  float *depth = harness_layer(harness, "depth", 1, &water.frame, &view, &settings);
  float *normal = harness_layer(harness, "normal", 3, &water.frame, &view, &settings);
  float *metres = harness_layer(harness, "behind", 1, &water.frame, &view, &settings);
  IsoWater twin = iso_water_create(&water.frame, &settings.raycast);
  double *off = malloc(PIXELS * sizeof *off), most = 0;
  int pixels = 0;
  for (int at = 0; at < (WIDTH / 2) * (HEIGHT / 2); at += 2) {
    const int x = at % (WIDTH / 2), y = at / (WIDTH / 2), i = followed_pixel(depth, x, y);
    const float shown = metres[2 * y * WIDTH + 2 * x];
    if (i < 0) {
      assert_true(shown == 0);
      continue;
    }
    const Ray ray = harness_ray(&view, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
    double p[3], way[3];
    for (int k = 0; k < 3; ++k) p[k] = ray.origin[k] + (double)depth[i] * ray.direction[k];
    bend(ray.direction, normal + 3 * i, (double)settings.refractive_index, way);
    const double out = -iso_crossing(&twin, p, way, 1e-3 * twin.spacing, INFINITY);
    if (out <= 0) continue; // it only grazes the water
    const double truth = fmin(out / twin.spacing, DEEP);
    off[pixels++] = fabs((double)shown / twin.spacing - truth);
    most = fmax(most, truth);
  }
  qsort(off, (size_t)pixels, sizeof *off, ascending);
  print_message("%s: %d pixels, up to %.2f spacings of water: off by %.2g, 99 %% by %.2g, at most by %.2g\n", what,
                pixels, most, off[pixels / 2], off[pixels * 99 / 100], off[pixels - 1]);
  assert_true(pixels > 200);
  assert_true(off[pixels * 99 / 100] < 0.05);
  assert_true(off[pixels - 1] < 1.8); // air between two looks at the field, which are up to that far apart, is not seen
  iso_water_destroy(&twin);
  free(off);
  free(depth);
  free(normal);
  free(metres);
  test_water_destroy(&water);
}

static void test_metres(void **state) {
  Harness *harness = *state;
  Cloud *cloud = cloud_create(RADIUS);
  cloud_add_block(cloud, 10, 6, 12, 0.2f);
  expect_metres(harness, "block", cloud);
  cloud->count = 0;
  cloud_add_ball(cloud, -3.6f, 3.3f);
  cloud_add_ball(cloud, 3.6f, 3.3f);
  expect_metres(harness, "merging balls", cloud);
  cloud->count = 0;
  cloud_add_block(cloud, 14, 14, 1, 0.1f);
  expect_metres(harness, "sheet", cloud);
  free(cloud);
}

static int open_harness(void **state) {
  return harness_open_group(state, WIDTH, HEIGHT);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_filter), cmocka_unit_test(test_metres)};
  return cmocka_run_group_tests(tests, open_harness, harness_close_group);
}
