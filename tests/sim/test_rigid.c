// Floating bodies: mass, fall, contacts, and what water and bodies give each other. Longer ones: test_rigid_long.c.
#include <pthread.h>

#include "sim/rigid.h"
#include "sim/world.h"
#include "sim_test.h"

#define PI 3.14159265358979323846

static SimBlockDef block;

static SimObstacleDef floating(SimShape shape, float size, float density, float x, float y, float z) {
  SimObstacleDef def = sim_default_obstacle_def();
  def.motion = SIM_FLOATING;
  def.density = density;
  def.body.shape = shape;
  for (int k = 0; k < 3; k++) def.body.size[k] = size;
  def.body.position[0] = x, def.body.position[1] = y, def.body.position[2] = z;
  return def;
}

static SimWorldDef empty_def(const float size[3], const SimObstacleDef *obstacles, int32_t count) {
  SimWorldDef def = test_def(size, &block, (const float[3]){1, 1, 1});
  def.block_count = 0;
  def.obstacles = obstacles;
  def.obstacle_count = count;
  return def;
}

static double coordinate(SimWorld *world, int32_t body, int axis) {
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  double x = (double)test_frame(world, 0, buffer)->obstacles[body].position[axis];
  sim_frame_buffer_destroy(buffer);
  return x;
}

// ---- Mass ------------------------------------------------------------------------------------------------------------

static void assert_near(double value, double expected, double tolerance) {
  if (!(fabs(value - expected) <= tolerance)) fail_msg("%.10g, expected %.10g", value, expected);
}

static void assert_in(double value, double low, double high) {
  if (!(value >= low && value <= high)) fail_msg("%.10g, not in [%.10g, %.10g]", value, low, high);
}

// Textbook formulas, density 3.
static void masses_of_shapes(void **state) {
  (void)state;
  SimMass m = sim_mass_make(&(SimObstacle){.shape = SIM_BOX, .size = {1, 2, 3}}, 3);
  assert_near(m.mass, 18, 1e-12);
  assert_near(m.inertia[0], 18 * (4 + 9) / 12.0, 1e-12);
  assert_near(m.inertia[1], 18 * (1 + 9) / 12.0, 1e-12);
  assert_near(m.inertia[2], 18 * (1 + 4) / 12.0, 1e-12);
  m = sim_mass_make(&(SimObstacle){.shape = SIM_SPHERE, .size = {2}}, 3);
  assert_near(m.mass, 4 * PI, 1e-12);
  for (int k = 0; k < 3; k++) assert_near(m.inertia[k], 0.4 * 4 * PI, 1e-12);
  m = sim_mass_make(&(SimObstacle){.shape = SIM_CYLINDER, .size = {2, 4}}, 3);
  assert_near(m.mass, 12 * PI, 1e-12);
  assert_near(m.inertia[1], 6 * PI, 1e-12);
  assert_near(m.inertia[0], 12 * PI * (3 + 16) / 12, 1e-12);
  m = sim_mass_make(&(SimObstacle){.shape = SIM_CAPSULE, .size = {2, 2}}, 3); // without a middle part: a ball
  for (int k = 0; k < 3; k++) assert_near(m.inertia[k], 0.4 * 4 * PI, 1e-12);
  m = sim_mass_make(&(SimObstacle){.shape = SIM_CAPSULE, .size = {2, 5}}, 3); // a cylinder of 3 m between half balls
  assert_near(m.mass, 13 * PI, 1e-12);
  assert_near(m.inertia[1], 9 * PI / 2 + 0.4 * 4 * PI, 1e-12);
  assert_near(m.inertia[0], 9 * PI * (3 + 9) / 12 + 4 * PI * (0.4 + 9 / 4.0 + 3 * 3 / 8.0), 1e-12);
}

// The slow twin: the same by adding up small cubes.
static void capsule_and_stairs_by_counting(void **state) {
  (void)state;
  const SimObstacle shapes[2] = {{.shape = SIM_CAPSULE, .size = {0.8f, 2}},
                                 {.shape = SIM_STAIRS, .size = {2, 1, 0.5f}, .steps = 4}};
  for (int s = 0; s < 2; s++) {
    double mass = 0, first[3] = {0}, second[6] = {0}, step = 0.005;
    for (int a = -200; a < 200; a++)
      for (int b = -200; b < 200; b++)
        for (int c = -80; c < 80; c++) {
          double x = (a + 0.5) * step, y = (b + 0.5) * step, z = (c + 0.5) * step, top = fmax(0, fabs(y) - 0.6);
          bool inside = s == 0 ? x * x + z * z + top * top < 0.16 && fabs(y) < 1
                               : fabs(y) < 0.5 && fabs(z) < 0.25 && y + 0.5 < 0.25 * (floor((x + 1) / 0.5) + 1);
          if (!inside) continue;
          const double p[3] = {x, y, z}, v = step * step * step;
          mass += v;
          for (int k = 0; k < 3; k++) first[k] += v * p[k], second[k] += v * p[k] * p[k];
          second[3] += v * x * y, second[4] += v * x * z, second[5] += v * y * z;
        }
    SimMass m = sim_mass_make(&shapes[s], 1);
    assert_near(m.mass, mass, 0.002 * mass); // what the cubes at the curved surface leave
    double c[3], trace = 0;
    for (int k = 0; k < 3; k++) assert_near(m.centre[k], c[k] = first[k] / mass, 1e-3);
    for (int k = 0; k < 3; k++) trace += second[k] -= mass * c[k] * c[k];
    for (int k = 0; k < 3; k++) assert_near(m.inertia[k], trace - second[k], 0.002 * trace);
    assert_near(m.inertia[3], -(second[3] - mass * c[0] * c[1]), 0.002 * trace);
  }
}

static const int32_t cube_triangles[36] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                           2, 3, 7, 2, 7, 6, 1, 2, 6, 1, 6, 5, 0, 4, 7, 0, 7, 3};

// A box as a mesh, away from its origin; inside out it holds less than nothing.
static void mass_of_a_mesh(void **state) {
  (void)state;
  float vertex[24];
  for (int v = 0; v < 8; v++) {
    const int corner[3] = {(v + 1) / 2 % 2, v / 2 % 2, v / 4};
    const float low[3] = {1, -2, 0.5f}, size[3] = {1, 2, 3};
    for (int k = 0; k < 3; k++) vertex[3 * v + k] = low[k] + size[k] * (float)corner[k];
  }
  SimMesh mesh = {8, 12, vertex, cube_triangles};
  SimObstacle body = {.shape = SIM_MESH, .mesh = &mesh};
  SimMass m = sim_mass_make(&body, 3), box = sim_mass_make(&(SimObstacle){.shape = SIM_BOX, .size = {1, 2, 3}}, 3);
  const double centre[3] = {1.5, -1, 2};
  assert_near(m.mass, box.mass, 1e-10);
  for (int k = 0; k < 3; k++) assert_near(m.centre[k], centre[k], 1e-12);
  for (int k = 0; k < 6; k++) assert_near(m.inertia[k], box.inertia[k], 1e-10);
  int32_t turned[36];
  for (int k = 0; k < 36; k++) turned[k] = cube_triangles[35 - k];
  mesh.triangle = turned;
  assert_true(sim_mass_make(&body, 3).mass < 0);
}

// ---- Bodies alone ----------------------------------------------------------------------------------------------------

// From 1 m: g t²/2 on the way, then at rest on the floor, upright, half a body high.
static void falls_and_rests(void **state) {
  (void)state;
  const SimShape shapes[3] = {SIM_BOX, SIM_SPHERE, SIM_CYLINDER};
  for (int s = 0; s < 3; s++) {
    SimObstacleDef body = floating(shapes[s], 0.2f, 700, 0.5f, 1.1f, 0.5f);
    SimWorldDef def = empty_def((const float[3]){1, 2, 1}, &body, 1);
    SimWorld *world = test_create(&def);
    for (int f = 1; f <= 24; f++) {
      test_advance(world, 1);
      // The step is symplectic: it is ahead by g/2 Σ dt², at most t times the longest dt, sqrt(0.01 spacing/g), see
      // solver_pbf.c.
      double t = f / 60.0, fallen = 1.1 - coordinate(world, 0, 1), most = t * t + t * sqrt(0.01 * 0.05 / 9.81);
      assert_in(fallen, 0.5 * 9.81 * t * t - 2e-6, 0.5 * 9.81 * most + 2e-6);
    }
    test_advance(world, 100);
    assert_near(coordinate(world, 0, 1), 0.1, 0.002);
    assert_near(coordinate(world, 0, 0), 0.5, 0.002);
    SimMeasures m = sim_world_measures(world);
    for (int k = 0; k < 3; k++) assert_near(m.body_momentum[k] / (700 * 0.008), 0, 1e-3);
    sim_world_destroy(world);
  }
}

// One box falls upon another: no rebound, they end as a tower.
static void lands_on_another(void **state) {
  (void)state;
  const SimObstacleDef bodies[2] = {floating(SIM_BOX, 0.2f, 500, 0.5f, 0.1f, 0.5f),
                                    floating(SIM_BOX, 0.2f, 500, 0.52f, 0.8f, 0.5f)};
  SimWorldDef def = empty_def((const float[3]){1, 2, 1}, bodies, 2);
  SimWorld *world = test_create(&def);
  double highest = 0;
  for (int f = 0; f < 120; f++) {
    test_advance(world, 1);
    if (f > 25) highest = fmax(highest, coordinate(world, 1, 1));
  }
  if (highest > 0.3 + 0.01) fail_msg("it jumped to %g m", highest);
  assert_near(coordinate(world, 1, 1), 0.3, 0.004);
  assert_near(coordinate(world, 0, 1), 0.1, 0.002);
  sim_world_destroy(world);
}

// A hand at 1 m/s pushes a box that is free: it goes along at 1 m/s, touching, and no faster.
static void is_pushed_by_a_hand(void **state) {
  (void)state;
  SimObstacleDef bodies[2] = {floating(SIM_BOX, 0.2f, 500, 0.8f, 0.5f, 0.5f),
                              floating(SIM_BOX, 0.2f, 500, 0.4f, 0.5f, 0.5f)};
  bodies[1].motion = SIM_DRAGGABLE;
  bodies[1].max_speed = 1;
  SimWorldDef def = empty_def((const float[3]){3, 1, 1}, bodies, 2);
  memset(def.gravity, 0, sizeof def.gravity);
  SimWorld *world = test_create(&def);
  assert_true(sim_world_drag(world, 1, (const float[3]){2.5f, 0.5f, 0.5f}, NULL));
  test_advance(world, 90);
  double speed = sim_world_measures(world).body_momentum[0] / (500 * 0.008);
  assert_near(speed, 1, 0.03);
  assert_near(coordinate(world, 0, 0) - coordinate(world, 1, 0), 0.2, 0.01);
  sim_world_destroy(world);
}

// A body whose origin is not its centre of mass falls without turning, and its centre of mass falls as it should. Stairs
// also rest on the floor, on an edge of which they were dropped, like a box.
static void odd_bodies_fall_straight(void **state) {
  (void)state;
  float vertex[24];
  for (int v = 0; v < 8; v++) {
    const int corner[3] = {(v + 1) / 2 % 2, v / 2 % 2, v / 4};
    for (int k = 0; k < 3; k++) vertex[3 * v + k] = 0.2f * (float)corner[k];
  }
  const SimMesh mesh = {8, 12, vertex, cube_triangles};
  SimObstacleDef bodies[2] = {floating(SIM_STAIRS, 0.3f, 500, 0.7f, 1, 0.5f),
                              floating(SIM_MESH, 1, 500, 0.1f, 0.9f, 0.4f)};
  bodies[0].body.steps = 3;
  bodies[1].body.mesh = &mesh;
  const SimContainer box = {{0, 0, 0}, {1, 2, 1}, SIM_CONTAINER_BOX};
  const float gravity[3] = {0, -9.81f, 0};
  const float lowest[2] = {0.15f, 0}; // m, of the origin when they lie on the floor
  SimBody unmoved[2] = {{.moves = true, .floats = true}, {.moves = true, .floats = true}};
  SimRigid *rigid = sim_rigid_create(&box, bodies, 2, 0.05);
  assert_true(sim_rigid_reset(rigid));
  for (int step = 1; step <= 400; step++) {
    SimGiven none[2] = {{{0}}};
    assert_true(sim_rigid_step(rigid, 0.005, gravity, none, unmoved));
    for (int b = 0; b < 2; b++) {
      double position[3], rotation[4], t = 0.005 * step;
      sim_rigid_predict(rigid, b, 0, position, rotation);
      assert_near(rotation[3], 1, step <= 60 ? 1e-12 : 1e-3);
      assert_near(position[0], (double)bodies[b].body.position[0], step <= 60 ? 1e-12 : 0.01);
      double fallen = (double)bodies[b].body.position[1] - position[1];
      if (step <= 60) assert_in(fallen, 0.5 * 9.81 * t * t - 1e-5, 0.5 * 9.81 * t * (t + 0.005) + 1e-5);
      if (step == 400) assert_near(position[1], (double)lowest[b], 0.002);
    }
  }
  sim_rigid_destroy(rigid);
}

// In a glass that is tilted a ball rolls to the side and stays inside the cylinder.
static void a_glass_holds_its_bodies(void **state) {
  (void)state;
  SimObstacleDef ball = floating(SIM_SPHERE, 0.2f, 500, 0.5f, 0.5f, 0.5f);
  const SimContainer glass = {{0, 0, 0}, {1, 2, 1.4f}, SIM_CONTAINER_GLASS}; // radius 0.5 around (0.5, 0.7)
  SimBody unmoved = {.moves = true, .floats = true};
  SimRigid *rigid = sim_rigid_create(&glass, &ball, 1, 0.05);
  assert_true(sim_rigid_reset(rigid));
  for (int step = 0; step < 800; step++) {
    SimGiven none = {{0}};
    double angle = step < 400 ? 0.7 : 2.9, position[3], rotation[4];
    const float gravity[3] = {(float)(5 * cos(angle)), -9, (float)(5 * sin(angle))};
    assert_true(sim_rigid_step(rigid, 0.005, gravity, &none, &unmoved));
    sim_rigid_predict(rigid, 0, 0, position, rotation);
    double away = hypot(position[0] - 0.5, position[2] - 0.7);
    if (away > 0.4 + 0.005) fail_msg("step %d: %g from the axis", step, away);
    if (step == 399 || step == 799) assert_near(away, 0.4, 0.005);
  }
  sim_rigid_destroy(rigid);
}

// ---- Water and bodies ------------------------------------------------------------------------------------------------

// Without gravity, no walls in reach: what the water loses the bodies have.
static void assert_momentum_is_kept(SimSolver solver, const SimObstacleDef bodies[2], double pushed[2]) {
  SimWorldDef def = test_def((const float[3]){4, 2, 2}, &block, (const float[3]){1, 1, 1});
  block = (SimBlockDef){{0.9f, 0.8f, 0.85f}, {1.3f, 1.2f, 1.25f}, {2, 0.1f, 0}, {0, 0, 0}};
  def.obstacles = bodies;
  def.obstacle_count = 2;
  def.solver = solver;
  memset(def.gravity, 0, sizeof def.gravity);
  SimWorld *world = test_create(&def);
  SimMeasures start = sim_world_measures(world);
  double scale = start.momentum[0], worst = 0;
  for (int f = 0; f < 24; f++) {
    test_advance(world, 1);
    SimMeasures m = sim_world_measures(world);
    for (int k = 0; k < 3; k++)
      worst = fmax(worst, fabs(m.momentum[k] + m.body_momentum[k] - start.momentum[k]) / scale);
    assert_true(m.kinetic_energy + m.body_energy < 1.001 * start.kinetic_energy);
  }
  print_message("momentum drifts by %.2g of what it is\n", worst);
  if (worst > 2e-6) fail_msg("momentum drifts by %g of what it is", worst);
  assert_true(sim_world_measures(world).body_momentum[0] > 0.1 * scale);
  for (int b = 0; b < 2; b++) pushed[b] = coordinate(world, b, b == 0 ? 0 : 2);
  sim_world_destroy(world);
}

// A drop hits a light cube, which hits a ball.
static void momentum_is_kept(void **state) {
  (void)state;
  const SimObstacleDef bodies[2] = {floating(SIM_BOX, 0.3f, 300, 1.5f, 1, 1),
                                    floating(SIM_SPHERE, 0.3f, 200, 1.85f, 1.05f, 1)};
  double pushed[2];
  assert_momentum_is_kept(SIM_SOLVER_PBF, bodies, pushed);
  assert_true(pushed[0] > 1.51);
  assert_momentum_is_kept(SIM_SOLVER_SPH, bodies, pushed);
  assert_true(pushed[0] > 1.51);
}

// What friction takes from the water the bodies get.
static void momentum_is_kept_with_friction(void **state) {
  (void)state;
  SimObstacleDef bodies[2] = {floating(SIM_BOX, 0.3f, 300, 1.5f, 1, 1), floating(SIM_SPHERE, 0.3f, 200, 1.85f, 1.05f, 1)};
  bodies[0].friction = 0.8f;
  bodies[1].friction = 1;
  for (int solver = 0; solver < 2; solver++) {
    double pushed[2];
    assert_momentum_is_kept((SimSolver)solver, bodies, pushed);
    assert_true(pushed[0] > 1.51);
  }
}

// A drop hits the gap between two cubes, a spacing wide: particles there are in reach of both, and press both apart.
static void momentum_is_kept_between_two(void **state) {
  (void)state;
  const SimObstacleDef bodies[2] = {floating(SIM_BOX, 0.3f, 300, 1.5f, 1, 0.875f),
                                    floating(SIM_BOX, 0.3f, 300, 1.5f, 1, 1.225f)};
  double pushed[2];
  for (int solver = 0; solver < 2; solver++) {
    assert_momentum_is_kept((SimSolver)solver, bodies, pushed);
    assert_true(pushed[0] > 1.51 && pushed[1] > 1.23);
  }
}

static SimWorldDef pool_with(const SimObstacleDef *obstacles, int32_t count) {
  SimWorldDef def = test_def((const float[3]){0.8f, 1, 0.6f}, &block, (const float[3]){0.8f, 0.3f, 0.6f});
  def.obstacles = obstacles;
  def.obstacle_count = count;
  return def;
}

static uint64_t hash_of(SimWorld *world) {
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  const SimFrame *frame = test_frame(world, 0, buffer);
  uint64_t hash = test_hash(frame);
  for (int32_t b = 0; b < frame->obstacle_count; b++)
    for (int k = 0; k < 7; k++) {
      uint32_t bits;
      memcpy(&bits, k < 3 ? &frame->obstacles[b].position[k] : &frame->obstacles[b].rotation[k - 3], sizeof bits);
      hash = (hash ^ bits) * 1099511628211u;
    }
  sim_frame_buffer_destroy(buffer);
  return hash;
}

static const float turned_cube[4] = {0.2f, 0.1f, 0.3f, 0.9f};

static void crowd(SimObstacleDef bodies[4]) {
  bodies[0] = floating(SIM_BOX, 0.2f, 300, 0.2f, 0.45f, 0.2f);
  memcpy(bodies[0].body.rotation, turned_cube, sizeof turned_cube);
  bodies[1] = floating(SIM_SPHERE, 0.2f, 1500, 0.5f, 0.5f, 0.3f);
  bodies[2] = floating(SIM_CYLINDER, 0.16f, 600, 0.28f, 0.75f, 0.25f);
  bodies[3] = floating(SIM_BOX, 0.1f, 500, 0.05f, 0.15f, 0.3f);
  bodies[3].motion = SIM_SCRIPTED;
  bodies[3].body.size[1] = 0.4f;
  bodies[3].stroke[0] = 0.1f;
  bodies[3].period = 0.5f;
}

static void same_bytes_for_any_threads(void **state) {
  (void)state;
  SimObstacleDef bodies[4];
  crowd(bodies);
  SimWorldDef def = pool_with(bodies, 4);
  uint64_t expected = 0;
  const int32_t threads[4] = {1, 2, 3, 8};
  for (int t = 0; t < 4; t++) {
    def.threads = threads[t];
    SimWorld *world = test_create(&def);
    test_advance(world, 15);
    uint64_t hash = hash_of(world);
    if (t == 0) expected = hash;
    if (hash != expected) fail_msg("%d threads give other bytes than one", threads[t]);
    sim_world_destroy(world);
  }
}

static void same_bytes_on_every_instruction_set(void **state) {
  (void)state;
  SimObstacleDef bodies[4];
  crowd(bodies);
  SimWorldDef def = pool_with(bodies, 4);
  uint64_t expected = 0;
  static const char *const names[4] = {"scalar", "sse2", "avx2", "avx512"};
  for (int k = 0; k < 4; k++) {
    const SimWide *found = sim_wide_named(names[k]);
    if (!found) continue;
    SimWorld *world = test_create(&def);
    world->wide = found;
    test_advance(world, 15);
    uint64_t hash = hash_of(world);
    if (k == 0) expected = hash;
    if (hash != expected) fail_msg("%s gives other bytes than one lane", names[k]);
    sim_world_destroy(world);
  }
}

static void reset_gives_the_same_bytes(void **state) {
  (void)state;
  SimObstacleDef bodies[4];
  crowd(bodies);
  SimWorldDef def = pool_with(bodies, 4);
  SimWorld *world = test_create(&def);
  test_advance(world, 20);
  uint64_t first = hash_of(world);
  test_advance(world, 7);
  sim_world_reset(world);
  test_advance(world, 20);
  assert_true(hash_of(world) == first);
  size_t before = sim_allocation_count();
  test_advance(world, 5); // warm
  assert_int_equal(sim_allocation_count(), before);
  sim_world_destroy(world);
}

static void *run_world(void *argument) {
  SimObstacleDef bodies[4];
  SimBlockDef own = {{0, 0, 0}, {0.8f, 0.3f, 0.6f}, {0, 0, 0}, {0, 0, 0}};
  SimError error;
  crowd(bodies);
  SimWorldDef def = sim_default_world_def();
  def.particle_radius = 0.025f;
  def.threads = 1;
  def.container = (SimContainer){{0, 0, 0}, {0.8f, 1, 0.6f}, SIM_CONTAINER_BOX};
  def.block_count = 1;
  def.blocks = &own;
  def.obstacle_count = 4;
  def.obstacles = bodies;
  SimWorld *world = sim_world_create(&def, &error);
  if (!world) return NULL;
  for (int f = 0; f < 10; f++)
    if (!sim_world_advance(world, 1.0 / 60, &error)) return NULL;
  *(uint64_t *)argument = hash_of(world);
  sim_world_destroy(world);
  return argument;
}

// Worlds on several threads at once do not disturb each other.
static void worlds_are_independent(void **state) {
  (void)state;
  uint64_t alone = 0, hash[4] = {0};
  pthread_t thread[4];
  assert_non_null(run_world(&alone));
  for (int t = 0; t < 4; t++) assert_int_equal(pthread_create(&thread[t], NULL, run_world, &hash[t]), 0);
  for (int t = 0; t < 4; t++) {
    assert_int_equal(pthread_join(thread[t], NULL), 0);
    assert_true(hash[t] == alone);
  }
}

// Much water, thrown about by turning gravity, with bodies from a tenth to three times its density: nothing fails, and all
// bodies stay inside.
static void heavy_seas(void **state) {
  (void)state;
  SimObstacleDef bodies[4];
  crowd(bodies);
  bodies[0].density = 100;
  bodies[1].density = 3000;
  bodies[2].density = 150;
  SimWorldDef def = pool_with(bodies, 4);
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  for (int f = 0; f < 60; f++) {
    double angle = f * 0.35;
    const float gravity[3] = {(float)(25 * sin(angle)), (float)(-15 * cos(0.7 * angle)),
                              (float)(15 * sin(1.3 * angle))};
    assert_true(sim_world_set_gravity(world, gravity));
    test_advance(world, 1);
    const SimFrame *frame = test_frame(world, 0, buffer);
    test_inside_container(frame);
    test_outside_obstacles(frame);
    for (int b = 0; b < 3; b++)
      for (int k = 0; k < 3; k++) {
        float x = frame->obstacles[b].position[k];
        if (!(x >= 0.02f && x <= def.container.max[k] - 0.02f)) fail_msg("frame %d: body %d at %g", f, b, (double)x);
      }
  }
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(masses_of_shapes),
                                     cmocka_unit_test(capsule_and_stairs_by_counting),
                                     cmocka_unit_test(mass_of_a_mesh),
                                     cmocka_unit_test(falls_and_rests),
                                     cmocka_unit_test(lands_on_another),
                                     cmocka_unit_test(is_pushed_by_a_hand),
                                     cmocka_unit_test(odd_bodies_fall_straight),
                                     cmocka_unit_test(a_glass_holds_its_bodies),
                                     cmocka_unit_test(momentum_is_kept),
                                     cmocka_unit_test(momentum_is_kept_with_friction),
                                     cmocka_unit_test(momentum_is_kept_between_two),
                                     cmocka_unit_test(same_bytes_for_any_threads),
                                     cmocka_unit_test(same_bytes_on_every_instruction_set),
                                     cmocka_unit_test(reset_gives_the_same_bytes),
                                     cmocka_unit_test(worlds_are_independent),
                                     cmocka_unit_test(heavy_seas)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
