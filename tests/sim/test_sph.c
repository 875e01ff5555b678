// Smoothed particle hydrodynamics: its sweeps against sums over all pairs, and water that behaves like water.
#include "sim_test.h"

#include "reference/stress.h"
#include "validation.h"

static SimBlockDef block;

static SimWorldDef sph_def(const float container[3], const float block_size[3]) {
  SimWorldDef def = test_def(container, &block, block_size);
  def.solver = SIM_SOLVER_SPH;
  return def;
}

static double total_energy(SimWorld *world) {
  SimMeasures measures = sim_world_measures(world);
  return measures.kinetic_energy + measures.potential_energy;
}

// ---- The sweeps ------------------------------------------------------------------------------------------------------

typedef struct Pair {
  double w, over_r, d[3];
} Pair;

// V W, V W'/r and the difference of two particles; false where they are out of reach.
static bool pair(const SimWorld *world, int32_t i, int32_t j, Pair *pair) {
  double r2 = 0, h = (double)world->cubic.h, volume = (double)world->cubic.volume;
  for (int k = 0; k < 3; k++) {
    pair->d[k] = (double)world->particles.first[4 * i + k] - (double)world->particles.first[4 * j + k];
    r2 += pair->d[k] * pair->d[k];
  }
  double r = sqrt(r2);
  if (i == j || r >= h) return false;
  pair->w = volume * sim_kernel_cubic(r, h);
  pair->over_r = volume * sim_kernel_cubic_derivative(r, h) / r;
  return true;
}

static double slow_pressure(const SimWorld *world, const SimStep *step, int32_t i, double *density) {
  const SimParticles *p = &world->particles;
  double rate = 0;
  *density = (double)world->cubic.volume * sim_kernel_cubic(0, (double)world->cubic.h);
  for (int32_t j = 0; j < p->count; j++) {
    Pair near;
    if (!pair(world, i, j, &near)) continue;
    *density += near.w;
    for (int k = 0; k < 3; k++)
      rate += near.over_r * near.d[k] * ((double)p->work[4 * i + k] - (double)p->work[4 * j + k]);
  }
  float solid[4];
  reference_solid(world, p->first, i, solid);
  *density += (double)solid[3];
  for (int k = 0; k < 3; k++) rate += (double)solid[k] * (double)p->work[4 * i + k];
  double share = fmin(1, fmax(0, 1 + 100 * (*density - 1)));
  double pressure = (double)step->stiffness * fmax(0, *density - 1) + (double)step->bulk * rate * share;
  return fmax(0, pressure) / (*density * *density);
}

// A jittered block in a corner, with velocities that compress it here and stretch it there.
static void sweeps_match_all_pairs(void **state) {
  (void)state;
  SimWorldDef def = sph_def((const float[3]){1, 1, 1}, (const float[3]){0.4f, 0.5f, 0.35f});
  def.jitter = 0.2f;
  SimWorld *world = test_create(&def);
  SimParticles *p = &world->particles;
  SimStep step = sim_step_make(world, 0.001f);
  step.stiffness = 400, step.bulk = 0.5f;
  int32_t n = p->count;
  double *pressure = calloc((size_t)n, sizeof *pressure), (*shear)[3][3] = calloc((size_t)n, sizeof *shear), most = 0;
  for (int32_t i = 0; i < n; i++)
    for (int k = 0; k < 3; k++) {
      p->work[4 * i + k] = sinf(20 * p->first[4 * i + (k + 1) % 3]) - 2 * p->first[4 * i + k];
      p->now.next_velocity[k][i] = 0;
    }
  sim_particles_pad_zero(p, p->work);
  sim_parallel_for(1, n, step.wide->sph_density, &step);
  for (int32_t i = 0; i < n; i++) {
    double density;
    pressure[i] = slow_pressure(world, &step, i, &density);
    most = fmax(most, pressure[i]);
    if (fabs(density - (double)p->density[i]) > 2e-6)
      fail_msg("density of %d: %.8f, %.8f", i, density, (double)p->density[i]);
    if (fabs(pressure[i] - (double)p->second[4 * i + 3]) > 2e-3)
      fail_msg("pressure of %d: %.8f, %.8f", i, pressure[i], (double)p->second[4 * i + 3]);
    double expected[3][3];
    reference_shear(world, p->first, i, expected);
    reference_unpack(p->solid + 4 * i, shear[i]);
    for (int k = 0; k < 9; k++)
      if (fabs(shear[i][k / 3][k % 3] - pressure[i] * expected[k / 3][k % 3]) > 0.01 * pressure[i])
        fail_msg("shear of %d: %g, %g", i, shear[i][k / 3][k % 3], pressure[i] * expected[k / 3][k % 3]);
  }
  assert_true(most > 5);
  sim_particles_pad(p, p->second);
  sim_particles_pad_zero(p, p->solid);
  sim_parallel_for(1, n, step.wide->sph_force, &step);
  for (int32_t i = 0; i < n; i++) {
    double move[3];
    reference_move(world, p->first, pressure, shear, (double)step.wall_answer, i, move);
    for (int k = 0; k < 3; k++)
      if (fabs(-move[k] * 0.001 - (double)p->now.next_velocity[k][i]) > 2e-4 * most * 0.001 / 0.05)
        fail_msg("force on %d: %g, %g", i, -move[k], (double)p->now.next_velocity[k][i] * 1000);
  }
  free(shear);
  free(pressure);
  sim_world_destroy(world);
}

// ---- Water -----------------------------------------------------------------------------------------------------------

static void free_fall_keeps_momentum(void **state) {
  (void)state;
  SimWorldDef def = sph_def((const float[3]){2, 4, 2}, (const float[3]){0, 0, 0});
  block = (SimBlockDef){{0.8f, 3, 0.8f}, {1.2f, 3.4f, 1.2f}, {0.5f, 0, -0.25f}, {0, 0, 0}};
  def.jitter = 0.2f;
  SimWorld *world = test_create(&def);
  SimMeasures start = sim_world_measures(world);
  double mass = start.momentum[0] / 0.5, expected = -mass * 9.81 * 0.5;
  test_advance(world, 30);
  SimMeasures end = sim_world_measures(world);
  assert_true(fabs(end.momentum[1] - expected) < 1e-5 * fabs(expected));
  assert_true(fabs(end.momentum[0] - start.momentum[0]) < 1e-5 * fabs(expected));
  assert_true(fabs(end.momentum[2] - start.momentum[2]) < 1e-5 * fabs(expected));
  double fallen = (start.potential_energy - end.potential_energy) / (mass * 9.81);
  assert_true(fabs(fallen - 0.5 * 9.81 * 0.25) < 0.01 * 1.23 + 9.81 * 0.5 * 0.002);
  sim_world_destroy(world);
}

// Inside container, energy never above 1.01 of the start, front never faster than Ritter's.
static void dam_break(void **state) {
  (void)state;
  SimWorldDef def = sph_def((const float[3]){1.6f, 1, 0.3f}, (const float[3]){0.4f, 0.6f, 0.3f});
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  double start = total_energy(world);
  for (int f = 1; f <= 60; f++) {
    test_advance(world, 1);
    const SimFrame *frame = test_frame(world, 0, buffer);
    test_inside_container(frame);
    double energy = total_energy(world);
    if (energy > 1.01 * start) fail_msg("energy %g of %g", energy, start);
    for (int32_t i = 0; i < frame->count; i++)
      assert_true((double)frame->position[3 * i] <= 0.4 + 2 * sqrt(9.81 * 0.6) * frame->time + 0.025);
  }
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

static void still_pool_stays_still(void **state) {
  (void)state;
  SimWorldDef def = sph_def((const float[3]){0.8f, 0.8f, 0.5f}, (const float[3]){0.8f, 0.4f, 0.5f});
  SimWorld *world = test_create(&def);
  double start = total_energy(world);
  test_advance(world, 90);
  SimMeasures measures = sim_world_measures(world);
  double per_mass = measures.kinetic_energy / (1000 * 0.8 * 0.4 * 0.5);
  print_message("pool after 1.5 s: density error mean %.4f, largest %.4f; kinetic energy %.1e gH\n",
                measures.mean_density_error, measures.max_density_error, per_mass / (9.81 * 0.4));
  assert_true(measures.mean_density_error <= 0.01 && measures.max_density_error <= 0.05);
  assert_true(per_mass <= 5e-4 * 9.81 * 0.4);
  assert_true(total_energy(world) <= 1.01 * start);
  sim_world_destroy(world);
}

static void a_column_collapses_as_measured(void **state) {
  (void)state;
  ColumnCollapse result = validate_column_collapse(SIM_SOLVER_SPH, 1, 12, 8);
  print_message("column: front %.3f rms, %.3f at most, shift %.2f; height %.3f at most; Ritter %.3f\n",
                result.front_rms, result.front_largest, result.shift, result.height_largest, result.ritter_excess);
  assert_true(result.front_rms <= 0.10 && result.front_largest <= 0.15);
  assert_true(result.ritter_excess <= 0);
}

// A block dropped from 3 m, with a time step that is far too large: nothing leaves the tank, no energy is gained.
static void a_block_dropped_from_high_up(void **state) {
  (void)state;
  SimBlockDef blocks[2] = {{{0, 0, 0}, {0.7f, 0.2f, 0.7f}}, {{0.2f, 3, 0.2f}, {0.5f, 3.3f, 0.5f}}};
  SimWorldDef def = sph_def((const float[3]){0.7f, 4, 0.7f}, (const float[3]){1, 1, 1});
  def.blocks = blocks;
  def.block_count = 2;
  def.time_step = 0.05f;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  double start = total_energy(world);
  for (int f = 0; f < 60; f++) {
    test_advance(world, 1);
    test_inside_container(test_frame(world, 0, buffer));
    assert_true(total_energy(world) <= 1.01 * start);
  }
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

// The same pool with particles of 2 mm and 5 cm: the same error, the same calm, in scaled time the same substeps.
static void radius_does_not_matter(void **state) {
  (void)state;
  const float radii[2] = {0.002f, 0.05f};
  SimMeasures measures[2];
  int64_t substeps[2];
  for (int k = 0; k < 2; k++) {
    float d = 2 * radii[k];
    SimWorldDef def = sph_def((const float[3]){12 * d, 16 * d, 8 * d}, (const float[3]){12 * d, 8 * d, 8 * d});
    def.particle_radius = radii[k];
    def.kinematic_viscosity = 0;
    SimWorld *world = test_create(&def);
    SimError error = {""};
    for (int f = 0; f < 20; f++)
      if (!sim_world_advance(world, sqrt((double)d / 9.81), &error)) fail_msg("%s", error.message);
    measures[k] = sim_world_measures(world);
    measures[k].kinetic_energy /= 768 * 1000 * pow((double)d, 3) * 9.81 * 8 * (double)d;
    substeps[k] = sim_world_counts(world).substeps;
    if (measures[k].mean_density_error > 0.01 || measures[k].kinetic_energy > 2e-3)
      fail_msg("radius %g: density error %g, kinetic energy %g gH", (double)radii[k], measures[k].mean_density_error,
               measures[k].kinetic_energy);
    sim_world_destroy(world);
  }
  assert_true(fabs((double)(substeps[0] - substeps[1])) <= 0.05 * (double)substeps[0]);
  assert_true(fabs(measures[0].mean_density_error - measures[1].mean_density_error) < 0.002);
}

static uint64_t run(int32_t threads) {
  SimWorldDef def = sph_def((const float[3]){1.5f, 1, 0.5f}, (const float[3]){0.5f, 0.7f, 0.5f});
  SimObstacleDef pillar = sim_default_obstacle_def();
  pillar.body = (SimObstacle){
      .shape = SIM_CYLINDER, .size = {0.2f, 0.6f, 0}, .position = {0.9f, 0.3f, 0.25f}, .rotation = {0, 0, 0, 1}};
  def.obstacle_count = 1;
  def.obstacles = &pillar;
  def.threads = threads;
  def.jitter = 0.05f;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  uint64_t hash = 0;
  for (int f = 0; f < 6; f++) {
    SimPush push = {{0.2f, 0.3f, -1}, {0, 0, 1}, 0.3f, {10, 15, 0}};
    SimBlockDef drop = {{1.2f, 0.8f, 0.1f}, {1.4f, 0.95f, 0.3f}, {0, -1, 0}, {0.2f, 0.4f, 0.8f}};
    if (f % 4 == 1) assert_true(sim_world_push(world, &push));
    if (f == 2) assert_true(sim_world_pour(world, &drop, NULL) > 0);
    test_advance(world, 1);
    const SimFrame *frame = test_frame(world, SIM_NEED_ALL, buffer);
    test_inside_container(frame);
    hash = hash * 31 + test_hash(frame);
  }
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
  return hash;
}

static void any_number_of_threads_gives_the_same_bytes(void **state) {
  (void)state;
  const int32_t threads[] = {2, 3, 8};
  uint64_t one = run(1);
  for (int k = 0; k < 3; k++)
    if (run(threads[k]) != one) fail_msg("%d threads differ", threads[k]);
}

// Nothing, one particle, weightless rest, gravity that sets in at once: no sound to speak of, no division by zero.
static void degenerate_worlds(void **state) {
  (void)state;
  SimWorldDef def = sph_def((const float[3]){1, 1, 1}, (const float[3]){0.3f, 0.3f, 0.3f});
  memset(def.gravity, 0, sizeof def.gravity);
  SimWorld *world = test_create(&def);
  test_advance(world, 5);
  assert_true(sim_world_measures(world).max_speed < 1e-3);
  assert_true(sim_world_set_gravity(world, (const float[3]){0, -20, 0}));
  test_advance(world, 20);
  assert_true(sim_world_measures(world).max_density_error < 0.2);
  sim_world_destroy(world);
  def.block_count = 0;
  world = test_create(&def);
  test_advance(world, 2);
  SimBlockDef one = {{0.4f, 0.4f, 0.4f}, {0.45f, 0.45f, 0.45f}, {0, 0, 0}, {0, 0, 0}};
  assert_int_equal(sim_world_pour(world, &one, NULL), 1);
  assert_true(sim_world_set_gravity(world, (const float[3]){0, -9.81f, 0}));
  test_advance(world, 60);
  SimMeasures measures = sim_world_measures(world);
  assert_true(measures.max_speed < 0.1);
  sim_world_destroy(world);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sweeps_match_all_pairs),
      cmocka_unit_test(free_fall_keeps_momentum),
      cmocka_unit_test(dam_break),
      cmocka_unit_test(still_pool_stays_still),
      cmocka_unit_test(a_column_collapses_as_measured),
      cmocka_unit_test(a_block_dropped_from_high_up),
      cmocka_unit_test(radius_does_not_matter),
      cmocka_unit_test(any_number_of_threads_gives_the_same_bytes),
      cmocka_unit_test(degenerate_worlds),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
