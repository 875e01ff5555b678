// The style "raycast" on water with a flat surface: how far its normals are from vertical, and its level from the truth.
#include "tests/render/cloud.h"

#include <math.h>
#include <stdlib.h>

#define WIDTH 72
#define HEIGHT 54
#define PIXELS (WIDTH * HEIGHT)
#define RADIUS 0.02f
#define SPACING (2 * RADIUS)
#define DEGREES (180 / 3.14159265358979323846)
#define ACROSS 22 // spacings
#define DEEP 6
#define MARGIN 6 // what lies nearer to the sides is not looked at; farther than any kernel reaches

// ---- Pools -----------------------------------------------------------------------------------------------------------

typedef struct Pool {
  const char *name;
  TestWater water;
} Pool;

// A lattice, the middle of whose surface is the origin.
static TestWater lattice_pool(float disorder) {
  Cloud *cloud = cloud_create(RADIUS);
  cloud_add_block(cloud, ACROSS, DEEP, ACROSS, disorder);
  for (int32_t i = 0; i < cloud->count; ++i) cloud->position[3 * i + 1] -= 0.5f * DEEP * SPACING;
  TestWater water = cloud_water(cloud, CLOUD_PLAIN, NULL);
  free(cloud);
  return water;
}

// Its walls are left out of the frame.
static TestWater settled_pool(void) {
  const float half = 0.5f * ACROSS * SPACING;
  const SimContainer box = {{-half, -DEEP * SPACING, -half}, {half, 1, half}, SIM_CONTAINER_BOX};
  TestWater water = test_water_settled(&box, RADIUS, 0);
  water.frame.has_container = false;
  return water;
}

// ---- Measuring -------------------------------------------------------------------------------------------------------

typedef struct Flatness {
  int pixels;
  double mean, p95;    // degrees from vertical
  double level, rough; // spacings: mean height over the origin, standard deviation
  double angle[3 * PIXELS];
} Flatness;

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void add_view(Harness *harness, const SimFrame *frame, const RenderView *view, const RenderSettings *settings,
                     const char *layer, Flatness *f) {
  float *depth = harness_layer(harness, "depth", 1, frame, view, settings);
  float *normal = harness_layer(harness, layer, 3, frame, view, settings);
  for (int i = 0; i < PIXELS; ++i) {
    const Ray ray = harness_ray(view, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
    double p[3];
    for (int k = 0; k < 3; ++k) p[k] = (ray.origin[k] + (double)depth[i] * ray.direction[k]) / (double)SPACING;
    if (depth[i] <= 0 || fmax(fabs(p[0]), fabs(p[2])) > ACROSS / 2 - MARGIN) continue;
    f->angle[f->pixels++] = acos(fmin((double)normal[3 * i + 1], 1)) * DEGREES;
    f->level += p[1];
    f->rough += p[1] * p[1];
  }
  free(depth);
  free(normal);
}

// From straight above, aslant, and low over the water.
static Flatness measure(Harness *harness, const Pool *pool, RenderNormals normals, float iso, const char *layer) {
  static const RenderView views[] = {{{0.02f, 1.2f, 0.03f}, {0, 0, 0}, 20},
                                     {{-0.7f, 0.8f, 0.6f}, {0, 0, 0}, 20},
                                     {{0.4f, 0.35f, -1.1f}, {0, 0, 0}, 17}};
  RenderSettings settings = harness_pinned_settings();
  settings.style = "raycast";
  settings.floor = RENDER_FLOOR_NONE;
  settings.raycast.normals = normals;
  settings.raycast.iso = iso;
  Flatness f = {0};
  for (int k = 0; k < 3; ++k) add_view(harness, &pool->water.frame, &views[k], &settings, layer, &f);
  assert_true(f.pixels > PIXELS);
  qsort(f.angle, (size_t)f.pixels, sizeof *f.angle, ascending);
  for (int i = 0; i < f.pixels; ++i) f.mean += f.angle[i] / f.pixels;
  f.p95 = f.angle[(int)(0.95 * (f.pixels - 1))];
  f.level /= f.pixels;
  f.rough = sqrt(fmax(f.rough / f.pixels - f.level * f.level, 0));
  static const char *const names[] = {"blend", "gradient", "PCA"};
  print_message("%-13s iso %-5g %-8s %-10s: mean %.2f, 95 %% %.2f degrees; level %+.3f, rough %.3f spacings\n",
                pool->name, (double)iso, names[normals], layer, f.mean, f.p95, f.level, f.rough);
  return f;
}

// ---- What must hold --------------------------------------------------------------------------------------------------

typedef struct Pools {
  Harness harness;
  Pool pool[3];
} Pools;

// Water ends half a spacing over its topmost particles. There the field of a half space is 1/2: smaller iso-values lie
// farther out, the default one by a third of a spacing.

// What the style makes of it, with the bilateral filter, against the gradient alone.
static void test_blend_is_flatter_than_the_gradient(void **state) {
  Pools *pools = *state;
  const float iso = render_default_settings().raycast.iso;
  for (int i = 0; i < 3; ++i) {
    const Flatness gradient = measure(&pools->harness, &pools->pool[i], RENDER_NORMALS_GRADIENT, iso, "raw_normal");
    const Flatness raw = measure(&pools->harness, &pools->pool[i], RENDER_NORMALS_BLEND, iso, "raw_normal");
    const Flatness blend = measure(&pools->harness, &pools->pool[i], RENDER_NORMALS_BLEND, iso, "normal");
    assert_true(blend.mean < 0.5 * gradient.mean);
    assert_true(blend.p95 < 0.5 * gradient.p95);
    assert_true(blend.mean < 0.75 * raw.mean);
    assert_true(blend.mean < 1.5);
    assert_true(blend.level > -0.2 && blend.level < 0.35);
    assert_true(blend.rough < 0.1);
  }
}

// The same without the filter, where the surface is at the water's own level. Farther out the gradient is about as good:
// then all particles lie on one side of the point, at some distance, and pull in the same direction.
static void test_blend_before_the_filter(void **state) {
  Pools *pools = *state;
  for (int i = 0; i < 2; ++i) {
    const Flatness gradient = measure(&pools->harness, &pools->pool[i], RENDER_NORMALS_GRADIENT, 0.5f, "raw_normal");
    const Flatness blend = measure(&pools->harness, &pools->pool[i], RENDER_NORMALS_BLEND, 0.5f, "raw_normal");
    assert_true(blend.mean < 0.5 * gradient.mean);
    assert_true(blend.p95 < 0.5 * gradient.p95);
    assert_true(fabs(blend.level) < 0.02);
  }
}

static int open_pools(void **state) {
  Pools *pools = calloc(1, sizeof *pools);
  *pools = (Pools){
      harness_open(CONTEXT_AUTO, WIDTH, HEIGHT),
      {{"disorder 0.1", lattice_pool(0.1f)}, {"disorder 0.2", lattice_pool(0.2f)}, {"settled", settled_pool()}}};
  *state = pools;
  return 0;
}

static int close_pools(void **state) {
  Pools *pools = *state;
  for (int i = 0; i < 3; ++i) test_water_destroy(&pools->pool[i].water);
  harness_close(&pools->harness);
  free(pools);
  return 0;
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_blend_is_flatter_than_the_gradient),
      cmocka_unit_test(test_blend_before_the_filter),
  };
  return cmocka_run_group_tests(tests, open_pools, close_pools);
}
