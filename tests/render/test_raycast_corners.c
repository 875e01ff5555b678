// The style "raycast" at the edge of a block of water: both faces keep their normals up to near it.
#include "tests/render/cloud.h"

#include <math.h>
#include <stdlib.h>

#define WIDTH 120
#define HEIGHT 90
#define PIXELS (WIDTH * HEIGHT)
#define RADIUS 0.02f
#define SPACING (2 * RADIUS)
#define DEGREES (180 / 3.14159265358979323846)

// Across the edge at the top of the front: bins of a tenth of a spacing, from the front face to the top face.
enum { REACH = 40, BINS = 2 * REACH + 1 };
typedef struct Edge {
  double angle[BINS]; // degrees from +z to +y, mean
  int pixels[BINS];
} Edge;

static int bin_of(double spacings) {
  return (int)lround(10 * spacings) + REACH;
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

typedef struct Point {
  double at[3]; // spacings
} Point;

// Where the face across an axis lies, far from its edges: spacings from the middle of the block.
static double face_of(const Point *points, const float *normal, int axis) {
  double *values = malloc(PIXELS * sizeof *values), middle;
  int count = 0;
  for (int i = 0; i < PIXELS; ++i) {
    if (normal[3 * i + axis] > 0.9f) values[count++] = points[i].at[axis];
  }
  assert_true(count > 200);
  qsort(values, (size_t)count, sizeof *values, ascending);
  middle = values[count / 2];
  free(values);
  return middle;
}

static Edge measure(Harness *harness, const SimFrame *frame, RenderNormals normals, const char *layer) {
  const RenderView view = {{0.05f, 0.65f, 0.8f}, {0, 0.17f, 0.25f}, 34};
  RenderSettings settings = harness_pinned_settings();
  settings.style = "raycast";
  settings.floor = RENDER_FLOOR_NONE;
  settings.raycast.normals = normals;
  float *depth = harness_layer(harness, "depth", 1, frame, &view, &settings);
  float *normal = harness_layer(harness, layer, 3, frame, &view, &settings);
  Point *points = calloc(PIXELS, sizeof *points);
  for (int i = 0; i < PIXELS; ++i) {
    const Ray ray = harness_ray(&view, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
    for (int k = 0; k < 3; ++k) {
      points[i].at[k] = (ray.origin[k] + (double)depth[i] * ray.direction[k]) / (double)SPACING;
    }
  }
  const double top = face_of(points, normal, 1), front = face_of(points, normal, 2);
  Edge edge = {0};
  for (int i = 0; i < PIXELS; ++i) {
    const double *at = points[i].at, along = (front - at[2]) - (top - at[1]);
    if (depth[i] <= 0 || fabs(at[0]) > 3 || fabs(along) > REACH / 10) continue;
    edge.angle[bin_of(along)] += atan2((double)normal[3 * i + 1], (double)normal[3 * i + 2]) * DEGREES;
    ++edge.pixels[bin_of(along)];
  }
  for (int b = 0; b < BINS; ++b) edge.angle[b] /= fmax(edge.pixels[b], 1);
  free(depth);
  free(normal);
  free(points);
  return edge;
}

// Mean angle within a fifth of a spacing of a place.
static double angle_at(const Edge *edge, double spacings) {
  double sum = 0;
  int pixels = 0;
  for (int b = bin_of(spacings) - 2; b <= bin_of(spacings) + 2; ++b) {
    sum += edge->angle[b] * edge->pixels[b];
    pixels += edge->pixels[b];
  }
  assert_true(pixels > 20);
  return sum / pixels;
}

// Spacings between the last place at the front with less than 15° and the first one at the top with more than 75°.
static double width_of(const Edge *edge) {
  int low = 0, high = BINS - 1;
  for (int b = 0; b < BINS; ++b) {
    if (edge->pixels[b] > 3 && edge->angle[b] < 15) low = b;
  }
  for (int b = BINS - 1; b >= 0; --b) {
    if (edge->pixels[b] > 3 && edge->angle[b] > 75) high = b;
  }
  return 0.1 * (high - low);
}

// How far the normal turns between places on either side of the edge.
static double turn_of(const Edge *edge, double spacings) {
  return angle_at(edge, spacings) - angle_at(edge, -spacings);
}

static Edge measure_and_print(Harness *harness, const TestWater *water, float disorder, RenderNormals normals,
                              const char *layer) {
  const Edge edge = measure(harness, &water->frame, normals, layer);
  print_message(
      "disorder %.1f, %-8s %-10s: from 15 to 75 degrees in %.1f spacings; between 1, 1.5, 2, 3 spacings on either "
      "side %.1f, %.1f, %.1f, %.1f degrees\n",
      (double)disorder, normals == RENDER_NORMALS_BLEND ? "blend" : "gradient", layer, width_of(&edge),
      turn_of(&edge, 1), turn_of(&edge, 1.5), turn_of(&edge, 2), turn_of(&edge, 3));
  return edge;
}

// The iso-surface itself is round there: the blend follows it, the gradient is rounder, and the filter adds a little.
static void expect_sharp(float disorder) {
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  Cloud *cloud = cloud_create(RADIUS);
  cloud_add_block(cloud, 16, 10, 14, disorder);
  TestWater water = cloud_water(cloud, CLOUD_PLAIN, NULL);
  const Edge gradient = measure_and_print(&harness, &water, disorder, RENDER_NORMALS_GRADIENT, "raw_normal");
  const Edge raw = measure_and_print(&harness, &water, disorder, RENDER_NORMALS_BLEND, "raw_normal");
  const Edge blend = measure_and_print(&harness, &water, disorder, RENDER_NORMALS_BLEND, "normal");
  assert_true(fabs(turn_of(&raw, 1.5) - 90) <= 15);
  assert_true(fabs(turn_of(&blend, 1.5) - 90) <= 15);
  assert_true(fabs(turn_of(&blend, 3) - 90) <= 5);
  assert_true(turn_of(&raw, 1) > turn_of(&gradient, 1) + 8);
  assert_true(width_of(&blend) < width_of(&gradient));
  test_water_destroy(&water);
  free(cloud);
  harness_close(&harness);
}

static void test_lattice(void **state) {
  (void)state;
  expect_sharp(0);
}

static void test_disorder(void **state) {
  (void)state;
  expect_sharp(0.1f);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_lattice), cmocka_unit_test(test_disorder)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
