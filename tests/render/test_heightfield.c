// The style "heightfield" against what can be computed: level water over a checker, maps of objects against rays that meet the
// objects themselves, meshes against the bodies they are, drops, and switches that must change nothing.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/drops.h"
#include "tests/render/harness.h"

#define WIDTH 320
#define HEIGHT 240
#define PIXELS ((size_t)WIDTH * HEIGHT)
#define LEVEL 0.5f
#define SPACING 0.04f
#define PI 3.14159265358979323846
enum { NODES = 101 };

typedef struct Pool {
  TestFrame *frame;
  float height[NODES * NODES];
} Pool;

// A pool of 4 × 4 m with a slanted wave.
static Pool *pool_create(double amplitude) {
  Pool *s = calloc(1, sizeof *s);
  assert_non_null(s);
  s->frame = test_frame_create(8, SPACING / 2);
  SimFrame *frame = &s->frame->frame;
  frame->container = (SimContainer){.min = {0, 0, 0}, .max = {4, 1.2f, 4}};
  memcpy(frame->bounds_max, frame->container.max, sizeof frame->bounds_max);
  for (int k = 0; k < NODES; ++k) {
    for (int i = 0; i < NODES; ++i) {
      const double x = (double)SPACING * i, z = (double)SPACING * k;
      s->height[k * NODES + i] = (float)((double)LEVEL + amplitude * sin(2 * PI / 0.9 * (0.8 * x + 0.6 * z)));
    }
  }
  frame->height_field = (SimHeightField){{NODES, NODES}, {0, 0}, SPACING, s->height, NULL};
  return s;
}

static void pool_destroy(Pool *s) {
  test_frame_destroy(s->frame);
  free(s);
}

static SimObstacle *add(Pool *s, SimShape shape, float x, float z, float size, float height) {
  SimObstacle *o = &s->frame->obstacles[s->frame->frame.obstacle_count++];
  *o = (SimObstacle){.shape = shape,
                     .size = {size, height, size},
                     .position = {x, 0.5f * height, z},
                     .rotation = {0, 0, 0, 1},
                     .colour = {0.8f, 0.5f, 0.2f},
                     .steps = 4};
  return o;
}

static RenderSettings settings_of_style(void) {
  RenderSettings settings = harness_pinned_settings();
  settings.style = "heightfield";
  for (int k = 0; k < 3; ++k) settings.scattering[k] = 0;
  return settings;
}

static int by_size(const void *a, const void *b) {
  const int x = *(const uint8_t *)a, y = *(const uint8_t *)b;
  return (x > y) - (x < y);
}

// Differences of two pictures: the mean, and what 95 % stay below; in 1/255.
typedef struct Difference {
  double mean;
  int most;
} Difference;
static Difference difference(const uint8_t *a, const uint8_t *b, size_t count) {
  uint8_t *sizes = malloc(count);
  assert_non_null(sizes);
  Difference d = {0};
  for (size_t i = 0; i < count; ++i) {
    sizes[i] = (uint8_t)abs(a[i] - b[i]);
    d.mean += (double)sizes[i] / (double)count;
  }
  qsort(sizes, count, 1, by_size);
  d.most = sizes[(count - 1) * 95 / 100];
  free(sizes);
  return d;
}

// ---- Level water -----------------------------------------------------------------------------------------------------

static double fresnel(double cosine, double index) {
  const double bent = sqrt(1 - (1 - cosine * cosine) / (index * index));
  const double across = (cosine - index * bent) / (cosine + index * bent);
  const double along = (index * cosine - bent) / (index * cosine + bent);
  return 0.5 * (across * across + along * along);
}

// What the pixel of a ray shows of level water over the checker; false where its ray, or the refracted one, is near the pool's
// border or a square's.
static bool truth_of(const RenderSettings *s, const Ray *ray, double rgb[3]) {
  double d[3], length = 0;
  for (int k = 0; k < 3; ++k) length += ray->direction[k] * ray->direction[k];
  for (int k = 0; k < 3; ++k) d[k] = ray->direction[k] / sqrt(length);
  if (d[1] > -0.05) return false;
  const double t = ((double)LEVEL - ray->origin[1]) / d[1], index = (double)s->refractive_index;
  const double x = ray->origin[0] + t * d[0], z = ray->origin[2] + t * d[2];
  const double down = sqrt(1 - (1 - d[1] * d[1]) / (index * index)), path = (double)LEVEL / down;
  const double fx = x + path * d[0] / index, fz = z + path * d[2] / index, tile = (double)s->tile_size;
  if (!(x > 0.2 && x < 3.8 && z > 0.2 && z < 3.8 && fx > 0.1 && fx < 3.9 && fz > 0.1 && fz < 3.9)) return false;
  const double u = fx / tile - floor(fx / tile), v = fz / tile - floor(fz / tile);
  if (fmin(fmin(u, 1 - u), fmin(v, 1 - v)) < 0.1) return false;
  const float *square = s->floor_colour[((int)floor(fx / tile) + (int)floor(fz / tile)) & 1];
  const double mirror = fresnel(-d[1], index);
  for (int k = 0; k < 3; ++k) {
    const double sky = (double)s->sky_horizon[k] - d[1] * ((double)s->sky_zenith[k] - (double)s->sky_horizon[k]);
    rgb[k] = mirror * sky + (1 - mirror) * (double)square[k] * exp(-(double)s->absorption[k] * path);
  }
  return true;
}

static void test_level_water(void **state) {
  Harness *harness = *state;
  Pool *s = pool_create(0);
  RenderSettings settings = settings_of_style();
  const float colours[4][3] = {{0.9f, 0.7f, 0.5f}, {0.2f, 0.3f, 0.4f}, {0.1f, 0.3f, 0.9f}, {0.8f, 0.9f, 0.7f}};
  memcpy(settings.floor_colour, colours, 2 * sizeof colours[0]);
  memcpy(settings.sky_zenith, colours[2], sizeof colours[2]);
  memcpy(settings.sky_horizon, colours[3], sizeof colours[3]);
  for (int angle = 20; angle <= 70; angle += 25) {
    const double turn = angle * PI / 180;
    const RenderView view =
        harness_view(2, LEVEL + (float)(4 * sin(turn)), 2 + (float)(4 * cos(turn)), 2, LEVEL, 2, 30);
    uint8_t *drawn = harness_draw(harness, &s->frame->frame, &view, &settings);
    uint8_t got[3 * PIXELS], want[3 * PIXELS];
    size_t count = 0;
    for (int32_t y = 0; y < HEIGHT; ++y) {
      for (int32_t x = 0; x < WIDTH; ++x) {
        const Ray ray = harness_ray(&view, WIDTH, HEIGHT, x, y);
        double rgb[3];
        if (!truth_of(&settings, &ray, rgb)) continue;
        for (int k = 0; k < 3; ++k) {
          want[count] = (uint8_t)lrint(255 * fmin(rgb[k], 1));
          got[count++] = drawn[3 * (y * WIDTH + x) + k];
        }
      }
    }
    assert_true(count > PIXELS / 4);
    const Difference d = difference(got, want, count);
    print_message("%d degrees: %zu values, differences %.2f in the mean, %d at 95 %%\n", angle, count, d.mean, d.most);
    assert_true(d.mean < 0.1 && d.most <= 1);
    free(drawn);
  }
  pool_destroy(s);
}

// ---- Maps ------------------------------------------------------------------------------------------------------------

static const RenderView above = {{2.2f, 2.3f, 4.8f}, {2, 0.4f, 2.1f}, 34};

static void add_bodies(Pool *s) {
  add(s, SIM_BOX, 1.3f, 2, 0.2f, 0.9f);
  add(s, SIM_CYLINDER, 2, 2.4f, 0.16f, 0.9f);
  add(s, SIM_SPHERE, 2.7f, 2.2f, 0.5f, 0.9f);
  add(s, SIM_CAPSULE, 1.7f, 3, 0.14f, 0.3f);
}

static Difference against_rays(Harness *harness, double amplitude, RenderMapAccess access) {
  Pool *s = pool_create(amplitude);
  add_bodies(s);
  RenderSettings settings = settings_of_style();
  settings.heightfield.access = access;
  uint8_t *mapped = harness_draw(harness, &s->frame->frame, &above, &settings);
  settings.heightfield.mapped = false;
  uint8_t *met = harness_draw(harness, &s->frame->frame, &above, &settings);
  const Difference d = difference(mapped, met, 3 * PIXELS);
  print_message("waves of %.3f m, access %d: %.3f in the mean, %d at 95 %%\n", amplitude, (int)access, d.mean, d.most);
  free(mapped);
  free(met);
  pool_destroy(s);
  return d;
}

static void test_maps_against_rays(void **state) {
  Harness *harness = *state;
  const Difference level = against_rays(harness, 0, RENDER_ACCESS_POINT);
  assert_true(level.mean < 0.02 && level.most <= 1);
  const Difference waves = against_rays(harness, 0.015, RENDER_ACCESS_POINT);
  assert_true(waves.mean < 0.2 && waves.most <= 1);
  assert_true(against_rays(harness, 0.015, RENDER_ACCESS_DIRECTION).mean > 5 * waves.mean);
}

static SimMesh *cuboid(float width, float height) {
  static const int32_t faces[12][3] = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                                       {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  SimMesh *mesh = test_mesh_create(8, 12);
  float *vertex = (float *)(uintptr_t)mesh->vertex;
  for (int i = 0; i < 8; ++i) {
    vertex[3 * i] = (i & 1 ? 0.5f : -0.5f) * width;
    vertex[3 * i + 1] = (i & 2 ? 0.5f : -0.5f) * height;
    vertex[3 * i + 2] = (i & 4 ? 0.5f : -0.5f) * width;
  }
  memcpy((int32_t *)(uintptr_t)mesh->triangle, faces, sizeof faces);
  return mesh;
}

static void test_mesh_like_the_box(void **state) {
  Harness *harness = *state;
  Pool *s = pool_create(0.01);
  SimObstacle *body = add(s, SIM_BOX, 2, 2.2f, 0.3f, 0.9f);
  SimMesh *mesh = cuboid(0.3f, 0.9f);
  const RenderSettings settings = settings_of_style();
  uint8_t *bare = harness_draw(harness, &s->frame->frame, &above, &settings);
  body->shape = SIM_MESH;
  body->mesh = mesh;
  uint8_t *of_mesh = harness_draw(harness, &s->frame->frame, &above, &settings);
  s->frame->frame.obstacle_count = 0;
  uint8_t *none = harness_draw(harness, &s->frame->frame, &above, &settings);
  const Difference same = difference(bare, of_mesh, 3 * PIXELS), other = difference(bare, none, 3 * PIXELS);
  print_message("mesh against box: %.3f in the mean; nothing against box: %.3f\n", same.mean, other.mean);
  assert_true(same.mean < 0.05 * other.mean && same.most <= 1);
  free(bare);
  free(of_mesh);
  free(none);
  test_mesh_destroy(mesh);
  pool_destroy(s);
}

// ---- Drops -----------------------------------------------------------------------------------------------------------

static void test_drops(void **state) {
  Harness *harness = *state;
  Pool *s = pool_create(0);
  SimFrame *frame = &s->frame->frame;
  const float heights[] = {LEVEL - 0.1f, LEVEL + 0.005f, LEVEL + 0.03f, LEVEL + 0.03f, LEVEL + 0.05f, LEVEL + 0.5f};
  const uint8_t classes[8] = {SIM_SPLASH, SIM_SPLASH, SIM_SPLASH, SIM_AGGREGATED, SIM_AGGREGATED, SIM_SPLASH};
  const bool want[] = {false, false, true, false, true, true}; // from half a radius on, from two radii on
  for (int i = 0; i < 6; ++i) test_frame_add(s->frame, 2, heights[i], 2);
  frame->particle_class = classes;
  for (int i = 0; i < 6; ++i) assert_int_equal(render_is_drop(frame, &frame->height_field, i), want[i]);
  s->height[50 * NODES + 50] = NAN; // no water there
  assert_true(render_is_drop(frame, &frame->height_field, 0));
  s->height[50 * NODES + 50] = LEVEL;

  RenderSettings settings = settings_of_style();
  uint8_t *with = harness_draw(harness, frame, &above, &settings);
  settings.heightfield.drops = false;
  uint8_t *without = harness_draw(harness, frame, &above, &settings);
  // What differs lies in the balls.
  int changed = 0;
  for (int32_t y = 0; y < HEIGHT; ++y) {
    for (int32_t x = 0; x < WIDTH; ++x) {
      const size_t i = 3 * ((size_t)y * WIDTH + (size_t)x);
      if (memcmp(with + i, without + i, 3) == 0) continue;
      const Ray ray = harness_ray(&above, WIDTH, HEIGHT, x, y);
      bool in_one = false;
      for (int p = 0; p < 6; ++p) {
        const float centre[3] = {2, heights[p], 2};
        double t[2], margin;
        in_one = in_one || (want[p] && harness_ray_sphere(&ray, centre, 1.01 * (double)SPACING / 2, t, &margin));
      }
      assert_true(in_one);
      ++changed;
    }
  }
  assert_true(changed > 20);
  free(with);
  free(without);
  pool_destroy(s);
}

// ---- Switches --------------------------------------------------------------------------------------------------------

static void expect_same(Harness *harness, const Pool *s, const RenderSettings *a, const RenderSettings *b, bool same) {
  uint8_t *first = harness_draw(harness, &s->frame->frame, &above, a);
  uint8_t *second = harness_draw(harness, &s->frame->frame, &above, b);
  assert_int_equal(memcmp(first, second, 3 * PIXELS) == 0, same);
  free(first);
  free(second);
}

// What is about objects changes nothing where there are none, and something where there are.
static void test_switches(void **state) {
  Harness *harness = *state;
  Pool *s = pool_create(0.01);
  const RenderSettings plain = settings_of_style();
  RenderSettings changed[5] = {plain, plain, plain, plain, plain};
  changed[0].heightfield.eyes = RENDER_EYES_ONE;
  changed[1].heightfield.eyes = RENDER_EYES_SCALED;
  changed[2].heightfield.access = RENDER_ACCESS_DIRECTION;
  changed[3].heightfield.trapezium_a = changed[3].heightfield.trapezium_b = 0.1f;
  changed[4].heightfield.pull_reach = 0;
  for (int i = 0; i < 5; ++i) expect_same(harness, s, &plain, &changed[i], true);
  add_bodies(s);
  for (int i = 0; i < 5; ++i) expect_same(harness, s, &plain, &changed[i], false);
  RenderSettings spread = plain;
  spread.heightfield.dispersion = 0.05f;
  expect_same(harness, s, &plain, &spread, false);
  pool_destroy(s);
}

// A frame that lacks what the style needs is refused.
static void test_needs(void **state) {
  Harness *harness = *state;
  Pool *s = pool_create(0);
  const RenderSettings settings = settings_of_style();
  RenderError error = {0};
  test_frame_add(s->frame, 2, 1, 2);
  assert_false(render_draw(harness->render, &s->frame->frame, &above, &settings, &error));
  assert_non_null(strstr(error.message, "classes"));
  s->frame->frame.count = 0;
  s->frame->frame.height_field.height = NULL;
  assert_false(render_draw(harness->render, &s->frame->frame, &above, &settings, &error));
  assert_non_null(strstr(error.message, "height field"));
  pool_destroy(s);
}

static int open_group(void **state) {
  return harness_open_group(state, WIDTH, HEIGHT);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_level_water),       cmocka_unit_test(test_maps_against_rays),
      cmocka_unit_test(test_mesh_like_the_box), cmocka_unit_test(test_drops),
      cmocka_unit_test(test_switches),          cmocka_unit_test(test_needs),
  };
  return cmocka_run_group_tests(tests, open_group, harness_close_group);
}
