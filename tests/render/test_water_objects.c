// Objects in water: their planes, virtual eyes and groups, and the surface pulled to them. On the processor alone.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "render/water_objects.h"

#define SPACING 0.02f
#define INDEX 1.333f
#define PI 3.14159265358979323846

// ---- A pool ----------------------------------------------------------------------------------------------------------

enum { COLUMNS = 201, ROWS = 101, MOST = 600 };

// 4 × 2 m, its corner at the origin.
typedef struct Pool {
  SimFrame frame;
  float height[ROWS * COLUMNS];
  SimObstacle obstacles[MOST];
  RenderHeightfield settings;
  RenderWaterObjects found;
} Pool;

static float level_water(float x, float z) {
  return 0.5f + 0 * (x + z);
}

static float tilted(float x, float z) {
  return 0.4f + 0.1f * x - 0.05f * z;
}

static float waves(float x, float z) {
  return 0.5f + 0.05f * sinf(5 * x) * cosf(4 * z);
}

static float place_of(int32_t node) {
  return SPACING * (float)node;
}

static Pool *pool_create(float (*height)(float x, float z)) {
  Pool *p = calloc(1, sizeof *p);
  assert_non_null(p);
  const SimContainer tank = {.min = {0, 0, 0}, .max = {4, 2, 2}};
  p->settings = render_default_settings().heightfield;
  p->frame = (SimFrame){.particle_radius = SPACING / 2,
                        .bounds_max = {4, 2, 2},
                        .container = tank,
                        .has_container = true,
                        .obstacles = p->obstacles,
                        .height_field = {{COLUMNS, ROWS}, {0, 0}, SPACING, p->height, NULL}};
  for (int32_t k = 0; k < ROWS; ++k) {
    for (int32_t i = 0; i < COLUMNS; ++i) p->height[k * COLUMNS + i] = height(place_of(i), place_of(k));
  }
  return p;
}

static void pool_destroy(Pool *p) {
  render_water_objects_destroy(&p->found);
  free(p);
}

static SimObstacle *pool_add(Pool *p, SimShape shape, float x, float y, float z, float width, float height) {
  SimObstacle *o = &p->obstacles[p->frame.obstacle_count++];
  *o = (SimObstacle){
      .shape = shape, .size = {width, height, width}, .position = {x, y, z}, .rotation = {0, 0, 0, 1}, .steps = 3};
  return o;
}

static const float over_pool[3] = {2, 1.5f, 3};

static void find_from(Pool *p, const float eye[3]) {
  RenderError error = {0};
  assert_true(render_water_objects_find(&p->found, &p->frame, eye, &p->settings, INDEX, &error));
}

static void find(Pool *p) {
  find_from(p, over_pool);
}

static const RenderWaterObject *object_of(const Pool *p, int32_t obstacle) {
  assert_in_range(p->found.of_obstacle[obstacle], 0, p->found.count - 1);
  return &p->found.objects[p->found.of_obstacle[obstacle]];
}

static void turn(SimObstacle *o, int axis, double angle) {
  memset(o->rotation, 0, sizeof o->rotation);
  o->rotation[axis] = (float)sin(angle / 2);
  o->rotation[3] = (float)cos(angle / 2);
}

static void expect_point(const float p[3], double x, double y, double z, double tolerance) {
  assert_float_equal(p[0], x, tolerance);
  assert_float_equal(p[1], y, tolerance);
  assert_float_equal(p[2], z, tolerance);
}

// ---- Planes ----------------------------------------------------------------------------------------------------------

static void test_level_plane(void **state) {
  (void)state;
  Pool *p = pool_create(level_water);
  pool_add(p, SIM_BOX, 2, 0.45f, 1, 0.3f, 0.9f);
  find(p);
  assert_int_equal(p->found.count, 1);
  expect_point(p->found.objects[0].plane, 0, 1, 0, 1e-6);
  assert_float_equal(p->found.objects[0].plane[3], -0.5, 1e-6);
  assert_true(p->found.objects[0].crosses);
  pool_destroy(p);
}

static void expect_tilted(const RenderWaterObject *object) {
  const double length = sqrt(0.1 * 0.1 + 0.05 * 0.05 + 1);
  expect_point(object->plane, -0.1 / length, 1 / length, 0.05 / length, 1e-4);
  assert_float_equal(object->plane[3], -0.4 / length, 1e-4);
}

// In the middle, in a corner, as wide as the pool is deep, and everything that is not a height left out.
static void test_tilted_plane(void **state) {
  (void)state;
  Pool *p = pool_create(tilted);
  pool_add(p, SIM_BOX, 2, 0.45f, 1, 0.3f, 0.9f);
  pool_add(p, SIM_CYLINDER, 0.1f, 0.45f, 0.1f, 0.2f, 0.9f);
  pool_add(p, SIM_SPHERE, 3.5f, 0.7f, 0.9f, 0.4f, 0);
  pool_add(p, SIM_SPHERE, 1, 0.2f, 1, 0.3f, 0); // under water
  pool_add(p, SIM_SPHERE, 3, 1.2f, 1, 0.3f, 0); // over it
  const float bad[] = {NAN, INFINITY, -INFINITY, 0, -5, 1e30f};
  for (int i = 0; i < 400; ++i) p->height[(i * 7919) % (ROWS * COLUMNS)] = bad[i % 6];
  find(p);
  assert_int_equal(p->found.count, 5);
  const bool crosses[] = {true, true, true, false, false};
  for (int i = 0; i < 5; ++i) {
    expect_tilted(object_of(p, i));
    assert_int_equal(object_of(p, i)->crosses, crosses[i]);
  }
  pool_destroy(p);
}

// Distance of a node from an upright box of `half` width around (2, 1).
static float beside_box(int32_t i, int32_t k, float half) {
  const float x = fmaxf(fabsf(place_of(i) - 2) - half, 0), z = fmaxf(fabsf(place_of(k) - 1) - half, 0);
  return hypotf(x, z);
}

// Beside a solid the heights lack the particles that would be in it.
static void test_plane_beside_a_dent(void **state) {
  (void)state;
  Pool *p = pool_create(tilted);
  pool_add(p, SIM_BOX, 2, 0.45f, 1, 0.3f, 0.9f);
  for (int32_t k = 0; k < ROWS; ++k) {
    for (int32_t i = 0; i < COLUMNS; ++i) {
      if (beside_box(i, k, 0.15f) < SPACING * 0.99f) p->height[k * COLUMNS + i] -= 0.05f;
    }
  }
  find(p);
  expect_tilted(object_of(p, 0));
  pool_destroy(p);
}

static float cliff(float x, float z) {
  return 0.2f + 5 * x + 0 * z;
}

static void test_steep_plane(void **state) {
  (void)state;
  Pool *p = pool_create(cliff);
  p->frame.bounds_max[1] = p->frame.container.max[1] = 30;
  pool_add(p, SIM_BOX, 2, 10, 1, 0.2f, 20);
  find(p);
  assert_float_equal(object_of(p, 0)->plane[1], sqrt(0.5), 1e-4); // 45°
  assert_true(object_of(p, 0)->plane[0] < 0);
  pool_destroy(p);
}

// ---- Points and eyes -------------------------------------------------------------------------------------------------

// A box of 0.4 m turned by 30° about the upright, seen along +z: on paper.
static void test_a_on_paper(void **state) {
  (void)state;
  Pool *p = pool_create(level_water);
  const float eye[3] = {2, 1.5f, -2};
  turn(pool_add(p, SIM_BOX, 2, 0.5f, 1, 0.4f, 1), 1, PI / 6);
  find_from(p, eye);
  const RenderWaterObject *o = object_of(p, 0);
  // The line runs through the axis, which is 0.2/cos 30° from the side along it.
  expect_point(o->a, 2, 0.5, 1 - 0.2 / cos(PI / 6), 1e-5);
  expect_point(o->axis[0], 2, 0, 1, 1e-5);
  expect_point(o->axis[1], 2, 1, 1, 1e-5);
  expect_point(o->b, 2, 0, 1, 1e-5);
  expect_point(o->middle, 2, 0.5, 1, 1e-5);
  assert_float_equal(o->half_width, 0.2 * sqrt(2), 1e-5);
  expect_point(o->centre, 2, 0.5, 1, 1e-5);
  assert_true(o->reach >= sqrt(0.5 * 0.5 + 2 * 0.2 * 0.2) - 1e-5);
  pool_destroy(p);
}

// Of a leaning cylinder: its own axis, not that of the box around it.
static void test_leaning_leg(void **state) {
  (void)state;
  Pool *p = pool_create(level_water);
  const float eye[3] = {2, 1.5f, -2};
  turn(pool_add(p, SIM_CYLINDER, 2, 0.6f, 1, 0.1f, 1.6f), 0, PI / 6);
  find_from(p, eye);
  const RenderWaterObject *o = object_of(p, 0);
  const double z = 1 - 0.1 * tan(PI / 6); // where the axis meets the water
  expect_point(o->axis[0], 2, 0.6 - 0.8 * cos(PI / 6), 1 - 0.8 * sin(PI / 6), 1e-5);
  expect_point(o->middle, 2, 0.5, z, 1e-5);
  expect_point(o->a, 2, 0.5, z - 0.05 / cos(PI / 6), 1e-5);
  assert_float_equal(o->half_width, 0.05 / cos(PI / 6), 1e-5);
  pool_destroy(p);
}

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Eqs. 1 to 3 as they stand in the paper, in double precision.
static void expect_eyes(const RenderWaterObject *o, const float eye[3]) {
  double n[3], in[3], E[3], reflected[3], refracted[3], height = (double)o->plane[3], length = 0;
  for (int k = 0; k < 3; ++k) {
    n[k] = (double)o->plane[k];
    E[k] = (double)eye[k];
    in[k] = (double)o->a[k] - E[k];
    height += n[k] * E[k];
    length += in[k] * in[k];
  }
  length = sqrt(length);
  for (int k = 0; k < 3; ++k) in[k] /= length;
  const double eta = 1 / (double)INDEX, c = dot(in, n), root = sqrt(1 - eta * eta * (1 - c * c));
  for (int k = 0; k < 3; ++k) {
    reflected[k] = E[k] - 2 * height * n[k];
    refracted[k] = (double)o->a[k] - length * (eta * in[k] - (eta * c + root) * n[k]);
  }
  expect_point(o->eye_reflected, reflected[0], reflected[1], reflected[2], 2e-5);
  expect_point(o->eye_refracted, refracted[0], refracted[1], refracted[2], 2e-5);
}

// Where b is seen is on the way from it to the eye; where the one eye shows it is on the straight line to that.
static void expect_b(const RenderWaterObject *o, const float eye[3]) {
  float seen[3];
  render_refraction_point(o->plane, eye, o->b, INDEX, seen);
  expect_point(o->seen_b, (double)seen[0], (double)seen[1], (double)seen[2], 1e-6);
  double height = (double)o->plane[3], along[3], across[3];
  for (int k = 0; k < 3; ++k) {
    height += (double)o->plane[k] * (double)o->unscaled_b[k];
    along[k] = (double)o->b[k] - (double)o->eye_refracted[k];
    across[k] = (double)o->unscaled_b[k] - (double)o->eye_refracted[k];
  }
  assert_float_equal(height, 0, 1e-5);
  assert_float_equal(dot(along, across), sqrt(dot(along, along) * dot(across, across)), 1e-5);
}

static void test_eyes(void **state) {
  (void)state;
  const float eyes[][3] = {{2, 1.5f, 4}, {2, 0.8f, 6}, {5, 3, -2}, {2.1f, 2, 1.1f}, {2, 0.75f, 30}};
  for (int i = 0; i < 5; ++i) {
    Pool *p = pool_create(i % 2 == 0 ? tilted : level_water);
    pool_add(p, SIM_BOX, 2, 0.45f, 1, 0.3f, 0.9f);
    pool_add(p, SIM_SPHERE, 3, 0.5f, 1.5f, 0.4f, 0);
    pool_add(p, SIM_SPHERE, 1, 0.2f, 0.5f, 0.2f, 0);
    find_from(p, eyes[i]);
    assert_int_equal(p->found.count, 3);
    for (int k = 0; k < 3; ++k) {
      expect_eyes(&p->found.objects[k], eyes[i]);
      expect_b(&p->found.objects[k], eyes[i]);
    }
    pool_destroy(p);
  }
}

// ---- Groups ----------------------------------------------------------------------------------------------------------

static void add_table(Pool *p, float level) {
  for (int i = 0; i < 4; ++i) {
    pool_add(p, SIM_CYLINDER, i % 2 == 0 ? 1.6f : 2.4f, level / 2, i < 2 ? 0.7f : 1.3f, 0.06f, level);
  }
  SimObstacle *top = pool_add(p, SIM_BOX, 2, level + 0.02f, 1, 1, 0.04f);
  top->size[2] = 0.8f;
}

// Its legs are objects of their own, also when the top is close to the water.
static void test_table(void **state) {
  (void)state;
  const float levels[] = {0.8f, 0.52f, 0.505f};
  for (int i = 0; i < 3; ++i) {
    Pool *p = pool_create(level_water);
    add_table(p, levels[i]);
    find(p);
    assert_int_equal(p->found.count, 5);
    for (int k = 0; k < 4; ++k) assert_true(object_of(p, k)->crosses);
    assert_false(object_of(p, 4)->crosses);
    pool_destroy(p);
  }
}

static void test_groups(void **state) {
  (void)state;
  Pool *p = pool_create(level_water);
  // A chain of three with gaps of half a spacing, and one a spacing and a half away from it.
  for (int i = 0; i < 3; ++i) pool_add(p, SIM_BOX, 1 + 0.11f * (float)i, 0.5f, 1, 0.1f, 1);
  pool_add(p, SIM_BOX, 1.22f + 0.13f, 0.5f, 1, 0.1f, 1);
  find(p);
  const int32_t *of = p->found.of_obstacle;
  assert_int_equal(p->found.count, 2);
  assert_true(of[0] == of[1] && of[1] == of[2] && of[3] != of[0]);
  // A circle around the cross-sections of all three: corners are the farthest.
  expect_point(object_of(p, 0)->middle, 1.11, 0.5, 1, 0.02);
  assert_true(object_of(p, 0)->half_width > 0.11f + 0.05f && object_of(p, 0)->half_width < 0.11f + 0.0708f);
  p->settings.group_distance = 2;
  find(p);
  assert_int_equal(p->found.count, 1);
  p->settings.group_distance = 0;
  find(p);
  assert_int_equal(p->found.count, 4);
  pool_destroy(p);
}

// The walls of the pool and the ground under it, but not what stands in it close to them.
static void test_surroundings(void **state) {
  (void)state;
  Pool *p = pool_create(level_water);
  pool_add(p, SIM_BOX, -0.1f, 0.5f, 1, 0.2f, 1)->size[2] = 4;
  pool_add(p, SIM_BOX, 2, 0.5f, 2.1f, 0.21f, 1)->size[0] = 6;
  pool_add(p, SIM_BOX, 2, -0.1f, 1, 6, 0.2f);
  pool_add(p, SIM_BOX, 0.05f, 0.5f, 1, 0.2f, 1);
  find(p);
  const int32_t *of = p->found.of_obstacle;
  assert_int_equal(p->found.count, 1);
  assert_true(of[0] == -1 && of[1] == -1 && of[2] == -1 && of[3] == 0);
  p->frame.has_container = false;
  find(p);
  assert_true(of[0] >= 0);
  pool_destroy(p);
}

static void expect_finite(const Pool *p) {
  for (int32_t i = 0; i < p->found.count; ++i) {
    const RenderWaterObject *o = &p->found.objects[i];
    const float *const points[] = {o->plane, o->plane + 1,     o->centre,        o->axis[0], o->axis[1],    o->a,
                                   o->b,     o->eye_reflected, o->eye_refracted, o->seen_b,  o->unscaled_b, o->middle};
    for (size_t k = 0; k < sizeof points / sizeof points[0]; ++k) {
      for (int c = 0; c < 3; ++c) assert_true(fabsf(points[k][c]) < 1e7f);
    }
    assert_true(o->plane[1] > 0.7f);
    assert_true(o->reach >= 0 && o->half_width >= 0 && o->half_width < 1e7f);
  }
  for (int32_t i = 0; i < p->frame.obstacle_count; ++i) {
    assert_in_range(p->found.of_obstacle[i] + 1, 0, p->found.count);
  }
}

static void test_hundreds(void **state) {
  (void)state;
  Pool *p = pool_create(waves);
  for (int i = 0; i < MOST; ++i) {
    const float x = 0.1f + 0.12f * (float)(i % 30), z = 0.1f + 0.09f * (float)(i / 30);
    pool_add(p, (SimShape)(i % 5), x, i % 3 == 0 ? 0.1f : 0.5f, z, 0.05f, 0.2f);
  }
  find(p);
  assert_in_range(p->found.count, 1, RENDER_MAX_WATER_OBJECTS);
  expect_finite(p);
  for (int i = 0; i < MOST; ++i) assert_true(p->found.of_obstacle[i] >= 0);
  pool_destroy(p);
}

// ---- Odd frames ------------------------------------------------------------------------------------------------------

static void add_one_of_each(Pool *p) {
  for (int shape = 0; shape < SIM_SHAPE_COUNT; ++shape) {
    pool_add(p, (SimShape)shape, 0.5f + 0.5f * (float)shape, 0.5f, 1, 0.2f, 0.6f);
  }
}

static void test_no_field(void **state) {
  (void)state;
  const SimHeightField odd[] = {{{0, 0}, {0, 0}, 0, NULL, NULL},
                                {{COLUMNS, ROWS}, {0, 0}, SPACING, NULL, NULL},
                                {{-3, 4}, {0, 0}, SPACING, NULL, NULL},
                                {{COLUMNS, ROWS}, {NAN, 0}, NAN, NULL, NULL}};
  for (size_t i = 0; i < sizeof odd / sizeof odd[0]; ++i) {
    Pool *p = pool_create(level_water);
    add_one_of_each(p);
    p->frame.height_field = odd[i];
    if (i >= 2) p->frame.height_field.height = p->height;
    find(p);
    expect_finite(p);
    assert_int_equal(p->found.count, 5); // a mesh without vertices is none
    for (int32_t k = 0; k < p->found.count; ++k) assert_false(p->found.objects[k].crosses);
    pool_destroy(p);
  }
}

static float nothing(float x, float z) {
  return 0 * (x + z);
}

static void test_no_water(void **state) {
  (void)state;
  Pool *p = pool_create(nothing);
  add_one_of_each(p);
  find(p);
  expect_finite(p);
  for (int32_t k = 0; k < p->found.count; ++k) assert_false(p->found.objects[k].crosses);
  for (size_t i = 0; i < ROWS * COLUMNS; ++i) assert_true(isnan(p->found.heights[i]));
  // One wet node gives a level plane.
  p->height[0] = 0.5f;
  find(p);
  assert_float_equal(object_of(p, 0)->plane[1], 1, 0);
  assert_float_equal(object_of(p, 0)->plane[3], -0.5, 1e-6);
  p->frame.obstacle_count = 0;
  find(p);
  assert_int_equal(p->found.count, 0);
  pool_destroy(p);
}

static void test_absurd_obstacles(void **state) {
  (void)state;
  Pool *p = pool_create(level_water);
  pool_add(p, SIM_BOX, NAN, 0.5f, 1, 0.2f, 0.6f);
  pool_add(p, SIM_BOX, 1, INFINITY, 1, 0.2f, 0.6f);
  pool_add(p, SIM_BOX, 1, 0.5f, 1, NAN, 0.6f);
  pool_add(p, SIM_SPHERE, 1, 0.5f, 1, -1, 0.6f);
  pool_add(p, SIM_CYLINDER, 1, 0.5f, 1, 0.2f, 0);
  pool_add(p, SIM_CAPSULE, 1, 0.5f, 1, 0.2f, NAN);
  pool_add(p, SIM_STAIRS, 1, 0.5f, 1, 0.2f, 0.3f)->steps = 0;
  pool_add(p, (SimShape)77, 1, 0.5f, 1, 0.2f, 0.6f);
  memset(pool_add(p, SIM_BOX, 1, 0.5f, 1, 0.2f, 0.6f)->rotation, 0, 4 * sizeof(float));
  const int32_t absurd = p->frame.obstacle_count;
  pool_add(p, SIM_BOX, 1, 0.5f, 1, 0.2f, 0.6f);
  find(p);
  for (int32_t i = 0; i < absurd; ++i) assert_int_equal(p->found.of_obstacle[i], -1);
  assert_int_equal(p->found.count, 1);
  expect_finite(p);
  const float origin[3] = {0, 0, 0};
  assert_true(isinf(render_obstacle_distance(&p->obstacles[0], origin)));
  p->frame.obstacles = NULL;
  find(p);
  assert_int_equal(p->found.count, 0);
  pool_destroy(p);
}

static void test_odd_eyes(void **state) {
  (void)state;
  const float eyes[][3] = {{2, 0.2f, 1}, {2, 0.5f, 1.9f}, {2, 0.45f, 1}, {2, 1.5f, 1}, {2, 0.5001f, 900}, {2, -3, 1}};
  for (size_t i = 0; i < sizeof eyes / sizeof eyes[0]; ++i) {
    Pool *p = pool_create(level_water);
    add_one_of_each(p);
    pool_add(p, SIM_BOX, 2, 0.45f, 1, 0.3f, 0.9f);
    find_from(p, eyes[i]);
    expect_finite(p);
    pool_destroy(p);
  }
}

// All on one spot, and numbers that are too large or too small for sense.
static void test_odd_sizes(void **state) {
  (void)state;
  const float sizes[] = {1e-7f, 0.01f, 900, 9e5f}, radii[] = {NAN, 0, -1, INFINITY, 1e-9f, 50};
  for (int i = 0; i < 24; ++i) {
    Pool *p = pool_create(waves);
    for (int k = 0; k < 40; ++k) pool_add(p, (SimShape)(k % 5), 2, 0.5f, 1, sizes[i % 4], sizes[i % 4]);
    p->frame.particle_radius = radii[i / 4];
    p->frame.has_container = i % 3 == 0;
    find(p);
    expect_finite(p);
    pool_destroy(p);
  }
}

static void test_mesh(void **state) {
  (void)state;
  const float vertex[] = {-0.1f, -0.3f, -0.2f, 0.3f, NAN, 0, 0.3f, 0.5f, 0.2f, 0, 0, 0};
  const int32_t triangle[] = {0, 2, 3};
  const SimMesh mesh = {4, 1, vertex, triangle};
  Pool *p = pool_create(level_water);
  SimObstacle *o = pool_add(p, SIM_MESH, 2, 0.4f, 1, 0, 0);
  o->mesh = &mesh;
  turn(o, 1, PI / 2); // x becomes −z, z becomes x
  find(p);
  assert_int_equal(p->found.count, 1);
  const float above[3] = {2, 1.4f, 1}, beside[3] = {2, 0.5f, 0};
  assert_float_equal(render_obstacle_distance(o, above), 0.5, 1e-5);
  assert_float_equal(render_obstacle_distance(o, beside), 0.7, 1e-5);
  expect_point(object_of(p, 0)->axis[0], 2, 0.1, 0.9, 1e-5);
  pool_destroy(p);
}

// ---- The surface pulled to planes ------------------------------------------------------------------------------------

static double plane_height(const float plane[4], float x, float z) {
  return -((double)plane[0] * (double)x + (double)plane[2] * (double)z + (double)plane[3]) / (double)plane[1];
}

static void test_pull(void **state) {
  (void)state;
  Pool *p = pool_create(waves);
  pool_add(p, SIM_BOX, 2, 0.45f, 1, 0.31f, 0.9f);
  find(p);
  const float *plane = object_of(p, 0)->plane;
  const float full = (2 * p->settings.smoothing + 1.5f) * SPACING, end = full + p->settings.pull_reach * SPACING;
  double moved = 0;
  for (int32_t k = 0; k < ROWS; ++k) {
    for (int32_t i = 0; i < COLUMNS; ++i) {
      const float distance = beside_box(i, k, 0.155f), was = p->height[k * COLUMNS + i];
      const float is = p->found.heights[k * COLUMNS + i];
      const double wanted = plane_height(plane, place_of(i), place_of(k));
      if (distance < full - 1e-4f) assert_float_equal(is, wanted, 1e-6);
      if (distance > end + 1e-4f) assert_float_equal(is, was, 0);
      assert_true(is >= fmin(wanted, (double)was) - 1e-6 && is <= fmax(wanted, (double)was) + 1e-6);
      moved = fmax(moved, fabs((double)(is - was)));
    }
  }
  assert_true(moved > 5e-4); // or the waves are no test
  pool_destroy(p);
}

// Nothing is pulled to what is under or over the water, nor when the reach is none.
static void test_no_pull(void **state) {
  (void)state;
  for (int i = 0; i < 3; ++i) {
    Pool *p = pool_create(waves);
    pool_add(p, SIM_SPHERE, 2, i == 0 ? 0.2f : i == 1 ? 1.2f : 0.5f, 1, 0.3f, 0);
    if (i == 2) p->settings.pull_reach = 0;
    find(p);
    assert_memory_equal(p->found.heights, p->height, sizeof p->height);
    pool_destroy(p);
  }
}

// Between two solids, each has its own plane beside it.
static void test_pull_of_two(void **state) {
  (void)state;
  Pool *p = pool_create(waves);
  p->settings.pull_reach = 30;
  pool_add(p, SIM_BOX, 1.8f, 0.5f, 1, 0.1f, 1);
  pool_add(p, SIM_BOX, 2.2f, 0.5f, 1, 0.1f, 1);
  find(p);
  assert_int_equal(p->found.count, 2);
  for (int i = 0; i < 2; ++i) {
    const int32_t column = i == 0 ? 93 : 107; // half a spacing from the sides that face each other
    const double wanted = plane_height(object_of(p, i)->plane, place_of(column), 1);
    assert_float_equal(p->found.heights[50 * COLUMNS + column], wanted, 1e-3 * fabs(wanted - 0.5) + 2e-5);
  }
  pool_destroy(p);
}

// Where a solid stands there is no water: the plane continues into it and closes the gap around it, but on dry ground.
static void test_dry_nodes(void **state) {
  (void)state;
  Pool *p = pool_create(tilted);
  pool_add(p, SIM_BOX, 2, 0.5f, 1, 0.2f, 1);
  pool_add(p, SIM_BOX, 3.5f, 0.5f, 1, 0.2f, 1.2f);
  for (int32_t k = 0; k < ROWS; ++k) {
    for (int32_t i = 0; i < COLUMNS; ++i) {
      if (beside_box(i, k, 0.1f) < SPACING || place_of(i) > 3) p->height[k * COLUMNS + i] = 0;
    }
  }
  find(p);
  const int32_t middle = 50 * COLUMNS;
  for (int32_t i = 90; i <= 110; ++i) {
    assert_float_equal(p->found.heights[middle + i], (double)tilted(place_of(i), 1), 1e-4);
  }
  for (int32_t i = 151; i < COLUMNS; ++i) assert_true(isnan(p->found.heights[middle + i]));
  pool_destroy(p);
}

// ---- Time ------------------------------------------------------------------------------------------------------------

static double seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// 200 × 100 nodes and 8 objects take 0.8 ms without optimisation; the rest is for sanitizers. The fastest of some, for a busy
// machine.
static void test_time(void **state) {
  (void)state;
  Pool *p = pool_create(waves);
  for (int i = 0; i < 8; ++i) pool_add(p, (SimShape)(i % 5), 0.4f + 0.45f * (float)i, 0.5f, 1, 0.2f, 1);
  double best = INFINITY;
  for (int i = 0; i < 20; ++i) {
    const double start = seconds();
    find(p);
    best = fmin(best, seconds() - start);
  }
  print_message("%.2f ms\n", 1e3 * best);
  assert_true(best < 10e-3);
  pool_destroy(p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_level_plane),
      cmocka_unit_test(test_tilted_plane),
      cmocka_unit_test(test_plane_beside_a_dent),
      cmocka_unit_test(test_steep_plane),
      cmocka_unit_test(test_a_on_paper),
      cmocka_unit_test(test_leaning_leg),
      cmocka_unit_test(test_eyes),
      cmocka_unit_test(test_table),
      cmocka_unit_test(test_groups),
      cmocka_unit_test(test_surroundings),
      cmocka_unit_test(test_hundreds),
      cmocka_unit_test(test_no_field),
      cmocka_unit_test(test_no_water),
      cmocka_unit_test(test_absurd_obstacles),
      cmocka_unit_test(test_odd_eyes),
      cmocka_unit_test(test_odd_sizes),
      cmocka_unit_test(test_mesh),
      cmocka_unit_test(test_pull),
      cmocka_unit_test(test_no_pull),
      cmocka_unit_test(test_pull_of_two),
      cmocka_unit_test(test_dry_nodes),
      cmocka_unit_test(test_time),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
