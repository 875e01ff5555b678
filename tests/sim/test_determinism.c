// The same bytes for any number of threads: after Box2D's test_determinism.c.
#include "sim_test.h"

static uint64_t hash_all(uint64_t hash, const SimFrame *frame) {
  uint64_t parts[6] = {hash, test_hash(frame), 0, 0, 0, 0};
  for (int32_t i = 0; i < frame->count; i++) {
    uint32_t bits[2];
    memcpy(bits, &frame->smoothed[3 * i], sizeof bits);
    parts[2] = parts[2] * 31 + bits[0];
    memcpy(bits, &frame->ellipsoid[6 * i], sizeof bits);
    parts[3] = parts[3] * 31 + bits[0] + bits[1];
    parts[4] = parts[4] * 31 + frame->near_surface[i] * 2u + frame->particle_class[i];
  }
  for (int32_t k = 0; k < frame->height_field.size[0] * frame->height_field.size[1]; k++) {
    uint32_t bits;
    memcpy(&bits, &frame->height_field.height[k], sizeof bits);
    parts[5] = parts[5] * 31 + bits;
  }
  uint64_t all = 14695981039346656037u;
  for (int k = 0; k < 6; k++) all = (all ^ parts[k]) * 1099511628211u;
  return all;
}

// A dam break over an obstacle with a push and poured water: everything that runs in parallel.
static uint64_t run_with(int32_t threads, int frames, SimSolver solver, bool everything) {
  SimBlockDef block;
  SimWorldDef def = test_def((const float[3]){1.5f, 1, 0.5f}, &block, (const float[3]){0.5f, 0.7f, 0.5f});
  SimObstacleDef pillar = sim_default_obstacle_def();
  pillar.body = (SimObstacle){SIM_CYLINDER, {0.2f, 0.6f, 0}, {0.9f, 0.3f, 0.25f}, {0, 0, 0, 1}};
  def.obstacle_count = 1;
  def.obstacles = &pillar;
  def.threads = threads;
  def.solver = solver;
  if (everything) {
    def.surface_tension = 0.07f;
    def.vorticity = 0.2f;
    def.kinematic_viscosity = 0.01f;
    def.colour_diffusion = 1e-4f;
    def.container_friction = 0.3f;
    pillar.friction = 0.8f;
  }
  def.jitter = 0.05f;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  uint64_t hash = 0;
  for (int f = 0; f < frames; f++) {
    SimPush push = {{0.2f, 0.3f, -1}, {0, 0, 1}, 0.3f, {10, 15, 0}};
    SimBlockDef drop = {{1.2f, 0.8f, 0.1f}, {1.4f, 0.95f, 0.3f}, {0, -1, 0}, {0.2f, 0.4f, 0.8f}};
    if (f % 4 == 1) assert_true(sim_world_push(world, &push));
    if (f % 5 == 2) assert_true(sim_world_pour(world, &drop, NULL) >= 0);
    test_advance(world, 1);
    hash = hash_all(hash, test_frame(world, SIM_NEED_ALL, buffer));
    SimMeasures measures = sim_world_measures(world);
    uint64_t bits;
    memcpy(&bits, &measures.kinetic_energy, sizeof bits);
    hash = hash * 31 + bits;
  }
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
  return hash;
}

static uint64_t run(int32_t threads, int frames) {
  return run_with(threads, frames, SIM_SOLVER_PBF, false);
}

static void any_number_of_threads_gives_the_same_bytes(void **state) {
  (void)state;
  const int32_t threads[] = {2, 3, 5, 8};
  uint64_t one = run(1, 12);
  for (int k = 0; k < 4; k++) {
    uint64_t many = run(threads[k], 12);
    if (many != one)
      fail_msg("%d threads: %016llx, one: %016llx", threads[k], (unsigned long long)many, (unsigned long long)one);
  }
  assert_true(run(1, 11) != one);
  for (int solver = 0; solver < 2; solver++) {
    one = run_with(1, 6, (SimSolver)solver, true);
    for (int k = 0; k < 4; k++) assert_true(run_with(threads[k], 6, (SimSolver)solver, true) == one);
  }
}

// Frames that nobody asks for, or with other needs, must not change what follows.
static void looking_does_not_change_the_water(void **state) {
  (void)state;
  SimBlockDef block;
  SimWorldDef def = test_def((const float[3]){1, 1, 0.4f}, &block, (const float[3]){0.4f, 0.6f, 0.4f});
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  uint64_t hash[2];
  for (int look = 0; look < 2; look++) {
    SimWorld *world = test_create(&def);
    for (int f = 0; f < 15; f++) {
      test_advance(world, 1);
      SimBlockDef drop = {{0.7f, 0.5f + 0.01f * (float)f, 0.1f}, {0.9f, 0.95f, 0.3f}, {0, 0, 0}, {0, 0, 0}};
      if (look) test_frame(world, SIM_NEED_ALL, buffer);
      if (f % 7 == 3) assert_true(sim_world_pour(world, &drop, NULL) >= 0);
      if (look) test_frame(world, 0, buffer);
      if (look && f % 2) sim_world_measures(world);
    }
    hash[look] = test_hash(test_frame(world, 0, buffer));
    sim_world_destroy(world);
  }
  assert_true(hash[0] == hash[1]);
  sim_frame_buffer_destroy(buffer);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(any_number_of_threads_gives_the_same_bytes),
      cmocka_unit_test(looking_does_not_change_the_water),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
