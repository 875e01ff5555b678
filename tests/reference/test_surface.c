// The mesh of the aggregated particles in the reference ray tracer: level, volume, solids that it wets.
#include "tests/reference/reference.h"

#include <math.h>
#include <stdlib.h>

#include "sim/sim.h"
#include "tests/render/harness.h"

#define PI 3.14159265358979323846
#define RADIUS 0.0175
#define SPACING (2 * RADIUS)

// ---- Particles -------------------------------------------------------------------------------------------------------

typedef struct Scene {
  TestFrame *particles;
  SimFrameBuffer *buffer;
  const SimFrame *frame;
  RenderSettings settings;
  Reference *reference;
} Scene;

/// Whether there is a particle at a point of the lattice.
typedef bool Inside(double x, double y, double z);

// A lattice over [0, size) with every particle displaced by up to `disorder` spacings along each axis.
static void add_lattice(TestFrame *t, const int size[3], double disorder, Inside *inside) {
  uint32_t random = 1;
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        double p[3] = {(i + 0.5) * SPACING, (j + 0.5) * SPACING, (k + 0.5) * SPACING};
        if (inside != NULL && !inside(p[0], p[1], p[2])) continue;
        for (int a = 0; a < 3; ++a) {
          random = random * 1664525u + 1013904223u;
          p[a] += disorder * SPACING * ((double)random / 2147483648.0 - 1);
        }
        test_frame_add(t, (float)p[0], (float)p[1], (float)p[2]);
      }
    }
  }
}

static Scene scene_of(TestFrame *particles, const uint8_t *classes) {
  Scene scene = {.particles = particles, .buffer = sim_frame_buffer_create(), .settings = harness_pinned_settings()};
  const SimParticleSet set = {.count = particles->frame.count,
                              .position = particles->position,
                              .particle_radius = (float)RADIUS,
                              .particle_class = classes};
  SimError error;
  const SimFrame *frame = sim_frame_from_particles(&set, SIM_NEED_ANISOTROPY, 1, scene.buffer, &error);
  assert_non_null(frame);
  particles->frame.count = frame->count;
  scene.frame = frame;
  return scene;
}

static void scene_trace(Scene *scene) {
  SimFrame frame = *scene->frame;
  frame.obstacles = scene->particles->obstacles;
  frame.obstacle_count = scene->particles->frame.obstacle_count;
  scene->reference = reference_create(&frame, &scene->settings);
  assert_non_null(scene->reference);
}

static void scene_destroy(Scene *scene) {
  reference_destroy(scene->reference);
  sim_frame_buffer_destroy(scene->buffer);
  test_frame_destroy(scene->particles);
}

// ---- A level pool ----------------------------------------------------------------------------------------------------

enum { POOL_X = 30, POOL_Y = 10, POOL_Z = 26 };
#define LEVEL (POOL_Y * SPACING)

static Scene pool_create(double disorder, Inside *inside) {
  TestFrame *t = test_frame_create(POOL_X * POOL_Y * POOL_Z, (float)RADIUS);
  add_lattice(t, (int[]){POOL_X, POOL_Y, POOL_Z}, disorder, inside);
  return scene_of(t, NULL);
}

/// How the surface lies over the middle of the pool, in radii and degrees.
typedef struct Level {
  double mean, deviation, tilt;
} Level;

static Level level_of(const Scene *scene) {
  Level level = {0};
  const double down[3] = {0, -1, 0};
  int count = 0;
  for (double x = 8 * SPACING; x < 22 * SPACING; x += 0.31 * SPACING) {
    for (double z = 8 * SPACING; z < 18 * SPACING; z += 0.31 * SPACING, ++count) {
      const double origin[3] = {x, 1, z};
      double distance, normal[3];
      assert_true(reference_meet(scene->reference, origin, down, &distance, normal));
      const double height = (1 - distance - LEVEL) / RADIUS;
      level.mean += height;
      level.deviation += height * height;
      level.tilt += acos(fmin(1, normal[1])) * 180 / PI;
    }
  }
  level.mean /= count;
  level.deviation = sqrt(level.deviation / count - level.mean * level.mean);
  level.tilt /= count;
  return level;
}

static void test_level_of_a_lattice(void **state) {
  (void)state;
  Scene scene = pool_create(0, NULL);
  scene_trace(&scene);
  const Level level = level_of(&scene);
  print_message("lattice: level %+.4f r, deviation %.4f r, normals off by %.3f degrees\n", level.mean, level.deviation,
                level.tilt);
  assert_true(fabs(level.mean) < 0.01);
  assert_true(level.deviation < 0.01);
  assert_true(level.tilt < 0.2);
  scene_destroy(&scene);
}

static void test_level_with_disorder(void **state) {
  (void)state;
  Scene scene = pool_create(0.1, NULL);
  scene_trace(&scene);
  const Level level = level_of(&scene);
  print_message("displaced by a tenth: level %+.4f r, deviation %.4f r, normals off by %.2f degrees\n", level.mean,
                level.deviation, level.tilt);
  assert_true(fabs(level.mean) < 0.05);
  assert_true(level.deviation < 0.15);
  scene_destroy(&scene);
}

// The water shows a face to each wall of the tank, where the wall is.
static void test_faces_at_walls(void **state) {
  (void)state;
  Scene scene = pool_create(0, NULL);
  scene_trace(&scene);
  const double inside[3] = {15.2 * SPACING, 5.3 * SPACING, 13.1 * SPACING};
  const struct {
    double way[3], distance;
  } walls[] = {{{-1, 0, 0}, 15.2}, {{1, 0, 0}, POOL_X - 15.2}, {{0, 0, -1}, 13.1}, {{0, 0, 1}, POOL_Z - 13.1}};
  assert_true(reference_inside(scene.reference, inside));
  for (int i = 0; i < 4; ++i) {
    double distance, normal[3];
    assert_true(reference_meet(scene.reference, inside, walls[i].way, &distance, normal));
    assert_float_equal(distance / RADIUS, 2 * walls[i].distance, 0.02);
    for (int k = 0; k < 3; ++k) assert_float_equal(normal[k], walls[i].way[k], 0.01);
  }
  scene_destroy(&scene);
}

// ---- Volumes ---------------------------------------------------------------------------------------------------------

static bool in_ball(double x, double y, double z) {
  const double c = 9 * SPACING, r = 7.8 * SPACING;
  return (x - c) * (x - c) + (y - c) * (y - c) + (z - c) * (z - c) < r * r;
}

// A lattice cut to a ball has a surface of steps; the iso-surface, which is fitted to a level layer, lies on their outer
// edges: 0.23 to 0.25 radii outside, by where the lattice is cut.
static void test_volume_of_a_ball(void **state) {
  (void)state;
  TestFrame *t = test_frame_create(18 * 18 * 18, (float)RADIUS);
  add_lattice(t, (int[]){18, 18, 18}, 0.1, in_ball);
  Scene scene = scene_of(t, NULL);
  scene.settings.floor = RENDER_FLOOR_NONE;
  scene_trace(&scene);
  const ReferenceMesh mesh = reference_mesh(scene.reference);
  const double volume = scene.frame->count * pow(SPACING, 3), share = mesh.volume / volume;
  const double outside = (cbrt(share) - 1) * cbrt(volume * 0.75 / PI) / RADIUS;
  print_message("ball of %d particles: %.4f of its volume (%+.3f r), %d triangles\n", (int)scene.frame->count, share,
                outside, mesh.triangle_count);
  assert_in_range(scene.frame->count, 1900, 2100);
  assert_int_equal(mesh.open_edges, 0);
  assert_true(fabs(outside) < 0.3);
  scene_destroy(&scene);
}

static void test_particle_alone(void **state) {
  (void)state;
  TestFrame *t = test_frame_create(1, (float)RADIUS);
  test_frame_add(t, 0.3f, 0.5f, 0.7f);
  Scene scene = scene_of(t, (uint8_t[]){SIM_AGGREGATED});
  scene_trace(&scene);
  const ReferenceMesh mesh = reference_mesh(scene.reference);
  const double ball = 4 * PI / 3 * pow(RADIUS, 3);
  print_message("a particle alone: %.4f of a ball's volume, %d triangles\n", mesh.volume / ball, mesh.triangle_count);
  assert_int_equal(mesh.open_edges, 0);
  // Triangles of this size lie in the ball and lose a tenth to a quarter of it.
  assert_true(mesh.volume / ball > 0.75 && mesh.volume / ball < 1);
  for (int i = 0; i < 20; ++i) {
    const double way[3] = {sin(i), cos(2.1 * i), sin(3.3 * i + 1)}, centre[3] = {(double)0.3f, 0.5, (double)0.7f};
    double distance, normal[3];
    assert_true(reference_meet(scene.reference, centre, way, &distance, normal));
    assert_true(distance / RADIUS > 0.8 && distance / RADIUS < 1.01);
  }
  scene_destroy(&scene);
}

// ---- Solids ----------------------------------------------------------------------------------------------------------

static const double block_min[3] = {10 * SPACING, 0, 9 * SPACING},
                    block_max[3] = {20 * SPACING, 6 * SPACING, 17 * SPACING};

static bool outside_block(double x, double y, double z) {
  return x < block_min[0] || x > block_max[0] || y > block_max[1] || z < block_min[2] || z > block_max[2];
}

static bool outside_stairs(double x, double y, double z) {
  const double along = (x - 10 * SPACING) / (4 * SPACING);
  (void)z;
  return along < 0 || y > 2 * SPACING * (floor(along) + 1);
}

// From points in the water, no ray towards a solid or the floor meets air before it.
static void check_wet(const Scene *scene, Inside *open) {
  int looked_at = 0;
  for (double x = 2.3; x < POOL_X - 2; x += 0.83) {
    for (double y = 0.4; y < POOL_Y - 1; y += 0.77) {
      for (int i = 0; i < 12; ++i) {
        const double from[3] = {x * SPACING, y * SPACING, 13.4 * SPACING};
        const double way[3] = {cos(0.5 * i), -0.55, 0.1 * sin(0.7 * i)};
        if (!open(from[0], from[1], from[2])) continue;
        // Walk on to the first point in a solid or in the floor.
        double t = 0, p[3] = {from[0], from[1], from[2]};
        while (p[1] > 0 && open(p[0], p[1], p[2])) {
          t += 0.01 * SPACING;
          for (int k = 0; k < 3; ++k) p[k] = from[k] + t * way[k];
        }
        if (p[0] < SPACING || p[0] > (POOL_X - 1) * SPACING) continue; // out through a wall of the tank
        double distance, normal[3];
        assert_true(reference_inside(scene->reference, from));
        const double length = sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
        if (reference_meet(scene->reference, from, way, &distance, normal)) assert_true(distance > t * length);
        ++looked_at;
      }
    }
  }
  assert_true(looked_at > 1000);
}

static void test_wets_a_block(void **state) {
  (void)state;
  Scene scene = pool_create(0.1, outside_block);
  SimObstacle *block = &scene.particles->obstacles[scene.particles->frame.obstacle_count++];
  *block = (SimObstacle){.shape = SIM_BOX, .rotation = {0, 0, 0, 1}, .colour = {0.5f, 0.5f, 0.5f}};
  for (int k = 0; k < 3; ++k) {
    block->size[k] = (float)(block_max[k] - block_min[k]);
    block->position[k] = (float)(block_min[k] + block_max[k]) / 2;
  }
  scene_trace(&scene);
  check_wet(&scene, outside_block);
  scene_destroy(&scene);
}

static void test_wets_stairs(void **state) {
  (void)state;
  Scene scene = pool_create(0.1, outside_stairs);
  scene.particles->obstacles[scene.particles->frame.obstacle_count++] =
      (SimObstacle){.shape = SIM_STAIRS,
                    .size = {(float)(20 * SPACING), (float)(10 * SPACING), (float)(POOL_Z * SPACING)},
                    .position = {(float)(20 * SPACING), (float)(5 * SPACING), (float)(POOL_Z * SPACING / 2)},
                    .rotation = {0, 0, 0, 1},
                    .colour = {0.5f, 0.5f, 0.5f},
                    .steps = 5};
  scene_trace(&scene);
  check_wet(&scene, outside_stairs);
  scene_destroy(&scene);
}

static bool outside_tower(double x, double y, double z) {
  (void)y;
  return x < block_min[0] || x > block_max[0] || z < block_min[2] || z > block_max[2];
}

// A block that stands out of level water: the surface meets its side where it is level.
static void test_water_line(void **state) {
  (void)state;
  Scene scene = pool_create(0, outside_tower);
  SimObstacle *tower = &scene.particles->obstacles[scene.particles->frame.obstacle_count++];
  *tower = (SimObstacle){.shape = SIM_BOX, .rotation = {0, 0, 0, 1}, .colour = {0.5f, 0.5f, 0.5f}};
  for (int k = 0; k < 3; ++k) {
    tower->size[k] = k == 1 ? 1 : (float)(block_max[k] - block_min[k]);
    tower->position[k] = k == 1 ? 0.5f : (float)(block_min[k] + block_max[k]) / 2;
  }
  scene_trace(&scene);
  double worst = 0;
  for (double away = 0.05; away < 6; away += 0.35) {
    const double origin[3] = {block_max[0] + away * RADIUS, 0.9, 12.7 * SPACING}, down[3] = {0, -1, 0};
    double distance, normal[3];
    assert_true(reference_meet(scene.reference, origin, down, &distance, normal));
    const double height = (0.9 - distance - LEVEL) / RADIUS;
    worst = fmax(worst, fabs(height));
    assert_true(normal[1] > 0.95);
  }
  print_message("beside a solid: level off by up to %.3f r\n", worst);
  assert_true(worst < 0.25);
  scene_destroy(&scene);
}

// A drop half sunk in the pool: from above, one surface, then water down to the floor.
static void test_drop_in_pool(void **state) {
  (void)state;
  Scene scene = pool_create(0, NULL);
  SimFrame frame = *scene.frame;
  const int32_t n = frame.count;
  float *position = malloc(3 * sizeof(float) * ((size_t)n + 1)),
        *smoothed = malloc(3 * sizeof(float) * ((size_t)n + 1));
  float *ellipsoid = calloc(6 * ((size_t)n + 1), sizeof(float)), *radius = malloc(sizeof(float) * ((size_t)n + 1));
  uint8_t *classes = malloc((size_t)n + 1);
  for (int32_t i = 0; i < 3 * n; ++i) {
    position[i] = frame.position[i];
    smoothed[i] = frame.smoothed[i];
  }
  for (int32_t i = 0; i < 6 * n; ++i) ellipsoid[i] = frame.ellipsoid[i];
  for (int32_t i = 0; i < n; ++i) {
    classes[i] = frame.particle_class[i];
    radius[i] = frame.particle_radius;
  }
  const float drop[3] = {(float)(15 * SPACING), (float)LEVEL, (float)(13 * SPACING)};
  for (int k = 0; k < 3; ++k) position[3 * n + k] = smoothed[3 * n + k] = drop[k];
  classes[n] = SIM_SPLASH;
  radius[n] = 0.06f;
  frame.position = position;
  frame.smoothed = smoothed;
  frame.ellipsoid = ellipsoid;
  frame.particle_class = classes;
  frame.radius = radius;
  frame.count = n + 1;
  scene.reference = reference_create(&frame, &scene.settings);
  assert_non_null(scene.reference);

  const double eye[3] = {(double)drop[0], 2, (double)drop[2]}, down[3] = {0, -1, 0};
  double rgb[3];
  reference_ray(scene.reference, eye, down, 0, rgb);
  const double f = pow(0.333 / 2.333, 2), length = (double)drop[1] + (double)radius[n];
  for (int k = 0; k < 3; ++k) {
    const RenderSettings *s = &scene.settings;
    const long squares = lround(floor(eye[0] / (double)s->tile_size) + floor(eye[2] / (double)s->tile_size));
    const double square = (double)s->floor_colour[squares % 2][k];
    const double water = exp(-(double)s->absorption[k] * length) * square;
    assert_float_equal(rgb[k], f * (double)s->sky_zenith[k] + (1 - f) * water, 1e-6);
  }
  free(position);
  free(smoothed);
  free(ellipsoid);
  free(classes);
  free(radius);
  scene_destroy(&scene);
}

// ---- What cannot be ----------------------------------------------------------------------------------------------------

static void test_refuses_missing_ellipsoids(void **state) {
  (void)state;
  Scene scene = pool_create(0, NULL);
  SimFrame frame = *scene.frame;
  frame.ellipsoid = NULL;
  assert_null(reference_create(&frame, &scene.settings));
  scene_destroy(&scene);
}

static void test_leaves_out_broken_ellipsoids(void **state) {
  (void)state;
  Scene scene = pool_create(0, NULL);
  SimFrame frame = *scene.frame;
  float *ellipsoid = malloc(6 * sizeof(float) * (size_t)frame.count);
  for (int32_t i = 0; i < 6 * frame.count; ++i) ellipsoid[i] = frame.ellipsoid[i];
  for (int i = 0; i < 6; ++i) ellipsoid[i] = NAN;
  for (int i = 6; i < 12; ++i) ellipsoid[i] = 0;
  frame.ellipsoid = ellipsoid;
  scene.reference = reference_create(&frame, &scene.settings);
  assert_non_null(scene.reference);
  assert_int_equal(reference_mesh(scene.reference).open_edges, 0);
  assert_true(fabs(level_of(&scene).mean) < 0.01);
  free(ellipsoid);
  scene_destroy(&scene);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_level_of_a_lattice),
      cmocka_unit_test(test_level_with_disorder),
      cmocka_unit_test(test_faces_at_walls),
      cmocka_unit_test(test_volume_of_a_ball),
      cmocka_unit_test(test_particle_alone),
      cmocka_unit_test(test_wets_a_block),
      cmocka_unit_test(test_wets_stairs),
      cmocka_unit_test(test_water_line),
      cmocka_unit_test(test_drop_in_pool),
      cmocka_unit_test(test_refuses_missing_ellipsoids),
      cmocka_unit_test(test_leaves_out_broken_ellipsoids),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
