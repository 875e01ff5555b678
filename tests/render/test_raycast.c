// The style "raycast" against its slow twin: surface, normals and colours of small bodies of water.
#include "tests/render/cloud.h"
#include "tests/render/reference/iso.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 96
#define HEIGHT 72
#define PIXELS (WIDTH * HEIGHT)
#define RADIUS 0.02f
#define SPACING 0.04f
#define DEGREES (180 / 3.14159265358979323846)

static const RenderView from_front = {{0.02f, 0.03f, 1.3f}, {0, 0, 0}, 28};
static const RenderView from_above = {{0.7f, 0.8f, 0.75f}, {0, 0, 0}, 28};

static RenderSettings settings_of_raycast(void) {
  RenderSettings settings = harness_pinned_settings();
  settings.style = "raycast";
  settings.floor = RENDER_FLOOR_NONE;
  return settings;
}

// ---- The comparison --------------------------------------------------------------------------------------------------

// The renderer looks for the surface in steps of this many spacings at least: a ray that only grazes the water and is in it
// for less may miss it.
#define GRAZE 0.1

// What the renderer makes of a frame.
typedef struct Drawn {
  float *depth, *normal;
} Drawn;

static Drawn draw(const SimFrame *frame, const RenderView *view, const RenderSettings *settings) {
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  const Drawn drawn = {harness_layer(&harness, "depth", 1, frame, view, settings),
                       harness_layer(&harness, "raw_normal", 3, frame, view, settings)};
  harness_close(&harness);
  return drawn;
}

static void drawn_destroy(Drawn *drawn) {
  free(drawn->depth);
  free(drawn->normal);
}

typedef struct Errors {
  int both, other;      // pixels in which both have the same side of a surface; in which they differ
  int grazed;           // rays that the renderer let pass where they graze the water
  int far;              // of both, those with depths more than 5 % of a spacing apart
  double depth;         // greatest, spacings
  int angles;           // how many
  double angle[PIXELS]; // degrees
} Errors;

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// Of ascending angles, the one that a share of them does not exceed.
static double quantile(const Errors *e, double share) {
  return e->angles > 0 ? e->angle[(int)(share * (e->angles - 1))] : 0;
}

static void point_on(const Ray *ray, double t, double p[3]) {
  for (int k = 0; k < 3; ++k) p[k] = ray->origin[k] + t * ray->direction[k];
}

static double angle_between(const float a[3], const double b[3]) {
  double cosine = 0, length = 0;
  for (int k = 0; k < 3; ++k) {
    cosine += (double)a[k] * b[k];
    length += (double)a[k] * (double)a[k];
  }
  return acos(fmax(-1, fmin(1, cosine / sqrt(length)))) * DEGREES;
}

// The first crossing behind the water that the ray grazes at t; t itself where it does more than that.
static double past_grazing(const IsoWater *twin, const Ray *ray, double t) {
  const double *d = ray->direction, along = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  const double out = t > 0 ? -iso_crossing(twin, ray->origin, d, t * (1 + 1e-9), INFINITY) : 0;
  if (out <= 0 || (out - t) * along >= GRAZE * twin->spacing) return t;
  return iso_crossing(twin, ray->origin, d, out * (1 + 1e-9), INFINITY);
}

static void compare_pixel(const IsoWater *twin, const Ray *ray, double depth, const float normal[3], Errors *e) {
  double truth = iso_crossing(twin, ray->origin, ray->direction, 1e-3, INFINITY);
  double p[3], expected[3];
  if (fabs(truth - depth) > 0.05 * twin->spacing) {
    const double next = past_grazing(twin, ray, truth);
    e->grazed += next != truth;
    truth = next;
  }
  if (truth == 0 && depth == 0) return;
  if (truth * depth <= 0) {
    ++e->other;
    return;
  }
  const double off = fabs(depth - truth) / (double)SPACING;
  ++e->both;
  e->far += off > 0.05;
  e->depth = fmax(e->depth, off);
  point_on(ray, fabs(truth), p);
  if (iso_normal(twin, p, expected)) e->angle[e->angles++] = angle_between(normal, expected);
}

static Errors *compare(const SimFrame *frame, const RenderView *view, const RenderSettings *settings) {
  Drawn drawn = draw(frame, view, settings);
  IsoWater twin = iso_water_create(frame, &settings->raycast);
  Errors *e = calloc(1, sizeof *e);
  for (int i = 0; i < PIXELS; ++i) {
    const Ray ray = harness_ray(view, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
    compare_pixel(&twin, &ray, (double)drawn.depth[i], drawn.normal + 3 * i, e);
  }
  qsort(e->angle, (size_t)e->angles, sizeof *e->angle, ascending);
  iso_water_destroy(&twin);
  drawn_destroy(&drawn);
  return e;
}

// `least`: of pixels that must show the surface.
static void expect_like_twin(const char *what, const SimFrame *frame, const RenderView *view,
                             const RenderSettings *settings, int least) {
  Errors *e = compare(frame, view, settings);
  print_message("%s: %d pixels, %d grazed, %d differ in coverage; depth: %d beyond 5 %% of a spacing, at most %.2g %%; "
                "normals: median %.2g, 95 %% %.2g, at most %.2g degrees\n",
                what, e->both, e->grazed, e->other, e->far, 100 * e->depth, quantile(e, 0.5), quantile(e, 0.95),
                quantile(e, 1));
  assert_true(e->both >= least);
  assert_true(e->grazed <= 0.005 * e->both);
  assert_int_equal(e->other, 0);
  assert_int_equal(e->far, 0);
  assert_true(e->angles > 0.99 * e->both);
  assert_true(quantile(e, 0.95) < 0.1);
  assert_true(quantile(e, 1) < 1);
  free(e);
}

// From two sides.
static void expect_cloud_like_twin(const char *what, const Cloud *cloud, unsigned own) {
  const RenderSettings settings = settings_of_raycast();
  TestWater water = cloud_water(cloud, own, NULL);
  char name[64];
  snprintf(name, sizeof name, "%s from the front", what);
  expect_like_twin(name, &water.frame, &from_front, &settings, 500);
  snprintf(name, sizeof name, "%s from above", what);
  expect_like_twin(name, &water.frame, &from_above, &settings, 500);
  test_water_destroy(&water);
}

// ---- Bodies of water -------------------------------------------------------------------------------------------------

static void test_block(void **state) {
  (void)state;
  Cloud *cloud = cloud_create(RADIUS);
  cloud_add_block(cloud, 12, 7, 9, 0);
  expect_cloud_like_twin("block", cloud, CLOUD_PLAIN);
  free(cloud);
}

static void test_disorder(void **state) {
  (void)state;
  Cloud *cloud = cloud_create(RADIUS);
  cloud_add_block(cloud, 12, 7, 9, 0.3f);
  expect_cloud_like_twin("disordered block", cloud, CLOUD_PLAIN);
  free(cloud);
}

static void test_balls(void **state) {
  (void)state;
  Cloud *cloud = cloud_create(RADIUS);
  cloud_add_ball(cloud, 0, 4.7f);
  expect_cloud_like_twin("ball", cloud, CLOUD_PLAIN);
  cloud->count = 0;
  cloud_add_ball(cloud, -3.6f, 3.3f);
  cloud_add_ball(cloud, 3.6f, 3.3f);
  expect_cloud_like_twin("merging balls", cloud, CLOUD_PLAIN);
  free(cloud);
}

// Sparse spray: most cells of the grid are empty.
static void test_spray(void **state) {
  (void)state;
  Cloud *cloud = cloud_create(RADIUS);
  uint32_t seed = 3;
  for (int i = 0; i < 250; ++i) {
    const float x = 0.35f * cloud_noise(&seed), y = 0.25f * cloud_noise(&seed);
    cloud_add(cloud, x, y, 0.35f * cloud_noise(&seed));
  }
  expect_cloud_like_twin("spray", cloud, CLOUD_PLAIN);
  free(cloud);
}

static void test_own_radii(void **state) {
  (void)state;
  Cloud *cloud = cloud_create(RADIUS);
  uint32_t seed = 5;
  cloud_add_block(cloud, 10, 6, 8, 0.2f);
  for (int32_t i = 0; i < cloud->count; ++i) cloud->radius[i] = RADIUS * (0.95f + 0.25f * cloud_noise(&seed));
  expect_cloud_like_twin("radii of their own", cloud, CLOUD_RADII);
  free(cloud);
}

// Its surface is a sphere, whose radius follows from the kernel alone, and its normals are the sphere's.
static void test_one_particle(void **state) {
  (void)state;
  Cloud *cloud = cloud_create(RADIUS);
  cloud_add(cloud, 0, 0, 0);
  TestWater water = cloud_water(cloud, CLOUD_PLAIN, NULL);
  RenderSettings settings = settings_of_raycast();
  const RenderView near = {{0.05f, 0.1f, 0.3f}, {0, 0, 0}, 12};
  for (int normals = RENDER_NORMALS_BLEND; normals <= RENDER_NORMALS_PCA; ++normals) {
    settings.raycast.normals = (RenderNormals)normals;
    char name[32];
    snprintf(name, sizeof name, "one particle, normals %d", normals);
    expect_like_twin(name, &water.frame, &near, &settings, 1000);
    Errors *e = compare(&water.frame, &near, &settings);
    assert_true(quantile(e, 0.95) < 1); // not only the median: it is the same everywhere
    free(e);
  }
  test_water_destroy(&water);
  free(cloud);
}

// ---- Settings --------------------------------------------------------------------------------------------------------

static void test_iso_values(void **state) {
  (void)state;
  Cloud *cloud = cloud_create(RADIUS);
  cloud_add_block(cloud, 9, 6, 8, 0.3f);
  TestWater water = cloud_water(cloud, CLOUD_PLAIN, NULL);
  RenderSettings settings = settings_of_raycast();
  static const float values[] = {0.125f, 0.1875f, 0.3125f, 0.375f};
  for (int i = 0; i < 4; ++i) {
    settings.raycast.iso = values[i];
    char name[32];
    snprintf(name, sizeof name, "iso-value %g", (double)values[i]);
    expect_like_twin(name, &water.frame, &from_above, &settings, 500);
  }
  test_water_destroy(&water);
  free(cloud);
}

static void test_other_settings(void **state) {
  (void)state;
  Cloud *cloud = cloud_create(RADIUS);
  cloud_add_block(cloud, 9, 6, 8, 0.2f);
  TestWater water = cloud_water(cloud, CLOUD_PLAIN, NULL);
  RenderSettings settings = settings_of_raycast();
  settings.raycast.support = 3;
  expect_like_twin("support 3", &water.frame, &from_above, &settings, 500);
  settings.raycast.support = 7;
  settings.raycast.normal_reach = 8;
  expect_like_twin("support 7, normals 8", &water.frame, &from_above, &settings, 500);
  settings = settings_of_raycast();
  settings.raycast.normals = RENDER_NORMALS_GRADIENT;
  expect_like_twin("gradient", &water.frame, &from_above, &settings, 500);
  settings.raycast.normals = RENDER_NORMALS_PCA;
  expect_like_twin("PCA", &water.frame, &from_above, &settings, 500);
  settings.raycast.normals = RENDER_NORMALS_BLEND;
  settings.raycast.blend_weight = 0.5f;
  expect_like_twin("weight 0.5", &water.frame, &from_above, &settings, 500);
  test_water_destroy(&water);
  free(cloud);
}

static void expect_refused(Harness *harness, const SimFrame *frame, const RenderSettings *settings, const char *why) {
  RenderError error = {0};
  assert_false(render_draw(harness->render, frame, &from_front, settings, &error));
  if (strstr(error.message, why) == NULL) fail_msg("\"%s\" does not tell of %s", error.message, why);
}

static void test_refused_settings(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, 16, 16);
  Cloud *cloud = cloud_create(RADIUS);
  cloud_add(cloud, 0, 0, 0);
  TestWater water = cloud_water(cloud, CLOUD_PLAIN, NULL);
  const RenderSettings fine = settings_of_raycast();
  static const float isos[] = {0, -0.25f, 1, 30, NAN, INFINITY};
  for (int i = 0; i < 6; ++i) {
    RenderSettings settings = fine;
    settings.raycast.iso = isos[i];
    expect_refused(&harness, &water.frame, &settings, "iso-value");
  }
  RenderSettings settings = fine;
  settings.raycast.support = 1.9f;
  expect_refused(&harness, &water.frame, &settings, "support");
  settings = fine;
  settings.raycast.normals = (RenderNormals)3;
  expect_refused(&harness, &water.frame, &settings, "normals");
  settings = fine;
  settings.raycast.normal_reach = 12.1f;
  expect_refused(&harness, &water.frame, &settings, "reach of normals");
  settings = fine;
  settings.raycast.blend_k = 1.1f;
  expect_refused(&harness, &water.frame, &settings, "k of the blend");
  free(harness_draw(&harness, &water.frame, &from_front, &fine));
  test_water_destroy(&water);
  free(cloud);
  harness_close(&harness);
}

// ---- Colours ---------------------------------------------------------------------------------------------------------

static void test_colours(void **state) {
  (void)state;
  Cloud *cloud = cloud_create(RADIUS);
  cloud_add_block(cloud, 12, 7, 9, 0.1f);
  for (int32_t i = 0; i < cloud->count; ++i) {
    const bool left = cloud->position[3 * i] < 0;
    const float tint[3] = {left ? 0.9f : 0.1f, 0.3f, left ? 0 : 0.8f};
    memcpy(cloud->colour + 3 * i, tint, sizeof tint);
  }
  TestWater water = cloud_water(cloud, CLOUD_COLOURS, NULL);
  const RenderSettings settings = settings_of_raycast();
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  float *depth = harness_layer(&harness, "depth", 1, &water.frame, &from_above, &settings);
  float *colour = harness_layer(&harness, "colour", 3, &water.frame, &from_above, &settings);
  IsoWater twin = iso_water_create(&water.frame, &settings.raycast);
  double worst = 0, least = 1, most = 0;
  int between = 0;
  for (int i = 0; i < PIXELS; ++i) {
    if (depth[i] == 0) continue;
    const Ray ray = harness_ray(&from_above, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
    double p[3], expected[3];
    point_on(&ray, (double)depth[i], p);
    iso_colour(&twin, p, expected);
    for (int k = 0; k < 3; ++k) worst = fmax(worst, fabs((double)colour[3 * i + k] - expected[k]));
    least = fmin(least, expected[0]);
    most = fmax(most, expected[0]);
    between += expected[0] > 0.2 && expected[0] < 0.8;
  }
  print_message("colours: off by at most %.2g; red from %.2g to %.2g, %d pixels between\n", worst, least, most,
                between);
  assert_true(least < 0.101 && most > 0.899 && between > 20);
  assert_true(worst < 1.0 / 255);
  iso_water_destroy(&twin);
  free(depth);
  free(colour);
  harness_close(&harness);
  test_water_destroy(&water);
  free(cloud);
}

// Water whose particles have no colours of their own is white, so that its absorption alone colours it.
static void test_no_colours(void **state) {
  (void)state;
  Cloud *cloud = cloud_create(RADIUS);
  cloud_add_block(cloud, 9, 6, 8, 0.1f);
  TestWater water = cloud_water(cloud, CLOUD_PLAIN, NULL);
  const RenderSettings settings = settings_of_raycast();
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  float *depth = harness_layer(&harness, "depth", 1, &water.frame, &from_above, &settings);
  float *colour = harness_layer(&harness, "colour", 3, &water.frame, &from_above, &settings);
  for (int i = 0; i < PIXELS; ++i) {
    for (int k = 0; k < 3; ++k) assert_true(depth[i] == 0 || fabsf(colour[3 * i + k] - 1) < 1e-5f);
  }
  free(depth);
  free(colour);
  harness_close(&harness);
  test_water_destroy(&water);
  free(cloud);
}

// ---- An eye in the water ---------------------------------------------------------------------------------------------

// Every ray begins in water: what it meets first is the way out.
static void test_eye_in_water(void **state) {
  (void)state;
  Cloud *cloud = cloud_create(RADIUS);
  cloud_add_block(cloud, 13, 13, 13, 0.25f);
  TestWater water = cloud_water(cloud, CLOUD_PLAIN, NULL);
  const RenderSettings settings = settings_of_raycast();
  const RenderView views[] = {{{0, 0.1f, 0}, {0.02f, 1, 0.03f}, 70}, {{0.03f, 0.02f, 0}, {1, 0.1f, 0.6f}, 60}};
  for (int k = 0; k < 2; ++k) {
    IsoWater twin = iso_water_create(&water.frame, &settings.raycast);
    const double eye[3] = {(double)views[k].eye[0], (double)views[k].eye[1], (double)views[k].eye[2]};
    assert_true(iso_field(&twin, eye) > 0.8);
    iso_water_destroy(&twin);
    char name[32];
    snprintf(name, sizeof name, "eye in the water %d", k);
    expect_like_twin(name, &water.frame, &views[k], &settings, PIXELS * 99 / 100);
    Drawn drawn = draw(&water.frame, &views[k], &settings);
    for (int i = 0; i < PIXELS; ++i) assert_true(drawn.depth[i] <= 0);
    drawn_destroy(&drawn);
  }
  test_water_destroy(&water);
  free(cloud);
}

// ---- Frames without a sensible grid ----------------------------------------------------------------------------------

static void test_refused_grids(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, 16, 16);
  const RenderSettings settings = settings_of_raycast();
  TestFrame *t = test_frame_create(4, RADIUS);
  for (int i = 0; i < 4; ++i) test_frame_add(t, 0.1f * (float)i, 0.3f, 0.2f);
  expect_refused(&harness, &t->frame, &settings, "sorted"); // none at all
  static const int32_t starts[][3] = {{0, 2, 4}, {1, 2, 4}, {0, 5, 4}, {0, 2, 3}, {0, -1, 4}, {0, 2, 5}};
  static const int32_t sizes[][3] = {{0, 1, 1}, {2, -1, 1}, {2, 1, 0}, {65536, 65536, 1}};
  static const float edges[] = {0, -1, NAN};
  SimGrid fine = {.cell_size = 0.2f, .size = {2, 1, 1}, .cell_start = starts[0]};
  for (int i = 1; i < 6; ++i) {
    t->frame.grid = fine;
    t->frame.grid.cell_start = starts[i];
    expect_refused(&harness, &t->frame, &settings, "sorted");
  }
  for (int i = 0; i < 4; ++i) {
    t->frame.grid = fine;
    memcpy(t->frame.grid.size, sizes[i], sizeof sizes[i]);
    expect_refused(&harness, &t->frame, &settings, "sorted");
  }
  for (int i = 0; i < 3; ++i) {
    t->frame.grid = fine;
    t->frame.grid.cell_size = edges[i];
    expect_refused(&harness, &t->frame, &settings, "sorted");
  }
  t->frame.grid = fine;
  free(harness_draw(&harness, &t->frame, &from_front, &settings));
  // Without particles nobody asks for the grid.
  t->frame.count = 0;
  t->frame.grid = (SimGrid){0};
  free(harness_draw(&harness, &t->frame, &from_front, &settings));
  test_frame_destroy(t);
  harness_close(&harness);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_block),
      cmocka_unit_test(test_disorder),
      cmocka_unit_test(test_balls),
      cmocka_unit_test(test_spray),
      cmocka_unit_test(test_own_radii),
      cmocka_unit_test(test_one_particle),
      cmocka_unit_test(test_iso_values),
      cmocka_unit_test(test_other_settings),
      cmocka_unit_test(test_refused_settings),
      cmocka_unit_test(test_colours),
      cmocka_unit_test(test_no_colours),
      cmocka_unit_test(test_eye_in_water),
      cmocka_unit_test(test_refused_grids),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
