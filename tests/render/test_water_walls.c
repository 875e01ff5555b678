// Water in a container: it lies flat on the glass and on the floor, whatever its particles do there.
#include "tests/render/water.h"

#include <math.h>
#include <stdlib.h>

#define WIDTH 240
#define HEIGHT 180
#define RADIUS 0.0175f
#define MARGIN 2 // radii from the edges: where the water's own surface, which is smoothed, may round them off
#define DEGREES (180 / 3.14159265358979323846)

static const SimContainer tank = {{0, 0, 0}, {1.05f, 0.9f, 0.525f}, SIM_CONTAINER_BOX};
static const SimContainer glass = {{0, 0, 0}, {0.7f, 0.9f, 0.7f}, SIM_CONTAINER_GLASS};
#define LEVEL 0.42f

// ---- The pool --------------------------------------------------------------------------------------------------------

// A column with some disorder, from a radius above the floor on.
static void add_column(TestFrame *t, float x, float z) {
  const float wobble = 0.2f * RADIUS;
  for (float y = RADIUS; y < LEVEL; y += 2 * RADIUS) {
    test_frame_add(t, x + wobble * sinf(91 * y + 37 * z), y + wobble * sinf(57 * x + 83 * z),
                   z + wobble * sinf(71 * x + 47 * y));
  }
}

// Columns in rows, or in rings in a round container; the outermost lie a radius inside the walls.
static TestWater pool(const SimContainer *container) {
  TestFrame *t = test_frame_create(20000, RADIUS);
  const float spacing = 2 * RADIUS, middle = container->max[0] / 2;
  if (container->shape == SIM_CONTAINER_BOX) {
    for (float z = RADIUS; z < container->max[2]; z += spacing)
      for (float x = RADIUS; x < container->max[0]; x += spacing) add_column(t, x, z);
  } else {
    for (float ring = middle - RADIUS; ring > 0; ring -= spacing) {
      const int count = (int)(6.2831853f * ring / spacing);
      for (int i = 0; i < count; ++i) {
        const float a = 6.2831853f * (float)i / (float)count;
        add_column(t, middle + ring * cosf(a), middle + ring * sinf(a));
      }
    }
  }
  TestWater water = test_water_create(t->position, t->frame.count, RADIUS, container);
  test_frame_destroy(t);
  return water;
}

// ---- The walls -------------------------------------------------------------------------------------------------------

// Where a ray meets a wall: depth, outward normal, distance to the nearest edge of the wetted face in radii, as the eye
// sees it: windows of the smoothing are as large across the ray, and larger on a wall that lies aslant.
typedef struct Meeting {
  double depth, normal[3], from_edge;
} Meeting;

static void point_of(const Ray *ray, double depth, double p[3]) {
  for (int k = 0; k < 3; ++k) p[k] = ray->origin[k] + depth * ray->direction[k];
}

// How much shorter the distance to an edge along axis e looks to the ray, where the edge runs along axis f.
static double foreshortened(const Ray *ray, const double e[3], const double f[3]) {
  double dd = 0, de = 0, df = 0, ef = 0, ff = 0, ee = 0;
  for (int k = 0; k < 3; ++k) {
    dd += ray->direction[k] * ray->direction[k];
    de += ray->direction[k] * e[k];
    df += ray->direction[k] * f[k];
  }
  for (int k = 0; k < 3; ++k) {
    const double across_e = e[k] - de / dd * ray->direction[k], across_f = f[k] - df / dd * ray->direction[k];
    ee += across_e * across_e;
    ef += across_e * across_f;
    ff += across_f * across_f;
  }
  return sqrt(fmax(ee - ef * ef / ff, 0));
}

// The tank's face through which the ray comes in (side 0) or goes out (1); false: none, or the water's surface.
static bool meet_tank(const Ray *ray, int side, Meeting *m) {
  double depth = side == 0 ? -INFINITY : INFINITY;
  int face = 0;
  const double top[3] = {(double)tank.max[0], (double)LEVEL, (double)tank.max[2]};
  for (int k = 0; k < 3; ++k) {
    const double a = -ray->origin[k] / ray->direction[k], b = (top[k] - ray->origin[k]) / ray->direction[k];
    const double t = side == 0 ? fmin(a, b) : fmax(a, b);
    if (side == 0 ? t > depth : t < depth) {
      depth = t;
      face = k;
    }
  }
  double p[3];
  point_of(ray, depth, p);
  const bool low = p[face] < top[face] / 2;
  *m = (Meeting){.depth = depth, .from_edge = INFINITY};
  m->normal[face] = low ? -1 : 1;
  for (int k = 0; k < 3; ++k) {
    double e[3] = {0}, f[3] = {0};
    if (k == face) continue;
    e[k] = 1;
    f[3 - face - k] = 1;
    m->from_edge = fmin(m->from_edge, foreshortened(ray, e, f) * fmin(p[k], top[k] - p[k]) / (double)RADIUS);
  }
  return m->from_edge > 0 && (face != 1 || low);
}

// The same of the round glass's wall.
static bool meet_glass(const Ray *ray, int side, Meeting *m) {
  const double radius = (double)glass.max[0] / 2, *d = ray->direction;
  const double x = ray->origin[0] - radius, z = ray->origin[2] - radius, a = d[0] * d[0] + d[2] * d[2];
  const double b = (x * d[0] + z * d[2]) / a, h = b * b - (x * x + z * z - radius * radius) / a;
  if (h <= 0) return false;
  double p[3];
  m->depth = -b + (side == 0 ? -sqrt(h) : sqrt(h));
  point_of(ray, m->depth, p);
  m->normal[0] = (p[0] - radius) / radius;
  m->normal[1] = 0;
  m->normal[2] = (p[2] - radius) / radius;
  const double up[3] = {0, 1, 0}, along[3] = {-m->normal[2], 0, m->normal[0]};
  const double silhouette = radius - fabs(x * d[2] - z * d[0]) / sqrt(a);
  m->from_edge = fmin(foreshortened(ray, up, along) * fmin((double)LEVEL - p[1], p[1]), silhouette) / (double)RADIUS;
  return m->from_edge > 0;
}

typedef bool Meet(const Ray *ray, int side, Meeting *m);

// ---- The comparison --------------------------------------------------------------------------------------------------

typedef struct Worst {
  double depth, angle; // radii, degrees
  int pixels;
} Worst;

static Worst measure(Harness *harness, const TestWater *water, const RenderView *view, Meet *meet, int side,
                     double margin) {
  static const char *const names[2][2] = {{"front_depth", "front_normal"}, {"back_depth", "back_normal"}};
  RenderSettings settings = harness_pinned_settings();
  settings.style = "refraction";
  float *depth = harness_layer(harness, names[side][0], 1, &water->frame, view, &settings);
  float *normal = harness_layer(harness, names[side][1], 3, &water->frame, view, &settings);
  Worst worst = {0};
  for (int y = 0; y < HEIGHT; ++y) {
    for (int x = 0; x < WIDTH; ++x) {
      const Ray ray = harness_ray(view, WIDTH, HEIGHT, x, y);
      Meeting m;
      if (!meet(&ray, side, &m) || m.from_edge < margin) continue;
      const size_t i = (size_t)y * WIDTH + (size_t)x;
      double sine = 0;
      for (size_t k = 0; k < 3; ++k) sine += pow((double)normal[3 * i + k] - m.normal[k], 2);
      worst.depth = fmax(worst.depth, fabs((double)depth[i] - m.depth) / (double)RADIUS);
      worst.angle = fmax(worst.angle, 2 * asin(fmin(sqrt(sine) / 2, 1)) * DEGREES);
      ++worst.pixels;
    }
  }
  free(depth);
  free(normal);
  return worst;
}

static void expect_flush(const char *what, const SimContainer *container, Meet *meet, const RenderView *view) {
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  TestWater water = pool(container);
  for (int side = 0; side < 2; ++side) {
    const Worst worst = measure(&harness, &water, view, meet, side, MARGIN);
    print_message("%s, %s: %d pixels: %.2g r, %.2g degrees\n", what, side == 0 ? "front" : "back", worst.pixels,
                  worst.depth, worst.angle);
    assert_true(worst.pixels > WIDTH * HEIGHT / 8);
    assert_true(worst.depth < 1e-3);
    assert_true(worst.angle < 0.1);
  }
  test_water_destroy(&water);
  harness_close(&harness);
}

static void test_tank(void **state) {
  (void)state;
  const RenderView level = {{0.5f, 0.25f, 2.1f}, {0.52f, 0.22f, 0}, 30};
  expect_flush("tank", &tank, meet_tank, &level);
  const RenderView above = {{0.1f, 0.9f, 1.9f}, {0.5f, 0.2f, 0.2f}, 30};
  expect_flush("tank from above", &tank, meet_tank, &above);
}

static void test_glass(void **state) {
  (void)state;
  const RenderView level = {{0.35f, 0.25f, 2.1f}, {0.35f, 0.22f, 0}, 25};
  expect_flush("glass", &glass, meet_glass, &level);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_tank), cmocka_unit_test(test_glass)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
