// The kernels in wide floats: every instruction set against every other, byte for byte, and the sweeps of the solver
// against sums over all pairs in double precision.
#include "sim_test.h"

#include "reference/stress.h"

static const char *const names[4] = {"avx512", "avx2", "sse2", "scalar"};

static SimBlockDef block;

// Water on its way past a pillar and into a corner: walls, bodies, the free surface and flying drops.
static SimWorld *make_world_with(const SimWide *wide, SimSolver solver, bool everything) {
  static SimObstacleDef pillar;
  SimWorldDef def = test_def((const float[3]){1.2f, 1, 0.4f}, &block, (const float[3]){0.4f, 0.6f, 0.4f});
  pillar = sim_default_obstacle_def();
  pillar.body = (SimObstacle){SIM_CYLINDER, {0.2f, 0.6f, 0}, {0.7f, 0.3f, 0.2f}, {0, 0, 0, 1}};
  def.obstacle_count = 1;
  def.obstacles = &pillar;
  def.jitter = 0.1f;
  def.tensile = 0.002f;
  def.solver = solver;
  if (everything) {
    block.colour[0] = 0.7f;
    def.surface_tension = 0.07f;
    def.vorticity = 0.2f;
    def.kinematic_viscosity = 0.05f; // several stages
    def.colour_diffusion = 1e-4f;
    def.container_friction = 0.3f;
  }
  SimWorld *world = test_create(&def);
  world->wide = wide;
  return world;
}

static SimWorld *make_world(const SimWide *wide) {
  return make_world_with(wide, SIM_SOLVER_PBF, false);
}

static void every_instruction_set_agrees(SimSolver solver, bool everything) {
  uint64_t expected = 0;
  int found = 0;
  for (int k = 0; k < 4; k++) {
    const SimWide *wide = sim_wide_named(names[k]);
    if (!wide) continue;
    assert_string_equal(wide->name, names[k]);
    SimWorld *world = make_world_with(wide, solver, everything);
    SimFrameBuffer *buffer = sim_frame_buffer_create();
    test_advance(world, solver == SIM_SOLVER_SPH ? 5 : 20);
    const SimFrame *frame = test_frame(world, SIM_NEED_ALL, buffer);
    uint64_t hash = test_hash_surface(frame, test_hash(frame));
    if (found++ == 0) expected = hash;
    if (hash != expected) fail_msg("%s differs", names[k]);
    sim_frame_buffer_destroy(buffer);
    sim_world_destroy(world);
  }
  assert_true(found >= 1);
}

static void every_instruction_set_gives_the_same_bytes(void **state) {
  (void)state;
  assert_null(sim_wide_named("mmx"));
  for (int k = 0; k < 4; k++) every_instruction_set_agrees((SimSolver)(k / 2), k % 2 == 1);
}

// A glass of water, with mirror images, a tilted box half out of it, and so many particles in one place.
static uint64_t heights_of_glass(const SimWide *wide, int32_t heap) {
  SimObstacleDef box = sim_default_obstacle_def();
  box.body = (SimObstacle){SIM_BOX, {0.2f, 0.5f, 0.2f}, {0.5f, 0.2f, 0.6f}, {0.1f, 0.2f, 0.1f, 0.9f}};
  SimWorldDef def = test_def((const float[3]){0.8f, 1, 0.8f}, &block, (const float[3]){0.8f, 0.4f, 0.8f});
  def.container.shape = SIM_CONTAINER_GLASS;
  def.obstacle_count = 1, def.obstacles = &box;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  SimError error = {""};
  world->wide = wide;
  for (int32_t i = 0; i < heap; i++)
    for (int k = 0; k < 3; k++) world->particles.now.position[k][i] = 0.3f;
  world->settled = false;
  if (!sim_world_settle(world, &error)) fail_msg("%s", error.message);
  const SimFrame *frame = test_frame(world, SIM_NEED_ALL, buffer);
  uint64_t hash = test_hash_surface(frame, test_hash(frame));
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
  return hash;
}

// From columns that can be listed to those that cannot.
static void every_instruction_set_gives_the_same_heights(void **state) {
  (void)state;
  for (int32_t heap = 0; heap <= 480; heap += 40)
    for (int k = 0; k < 4; k++) {
      const SimWide *wide = sim_wide_named(names[k]);
      if (wide && heights_of_glass(wide, heap) != heights_of_glass(sim_wide_named("scalar"), heap))
        fail_msg("%s differs with a heap of %d", names[k], heap);
    }
}

// ---- Sums over all pairs ---------------------------------------------------------------------------------------------

typedef struct Sums {
  double density, squares, gradient[3];
} Sums;

static Sums sums_at(const SimWorld *world, const float *four, int32_t i) {
  Sums sums = {(double)world->cubic.volume * sim_kernel_cubic(0, (double)world->cubic.h), 0, {0, 0, 0}};
  const float *solid = world->particles.solid + 4 * i;
  if (world->particles.near[i / SIM_CHUNK]) {
    sums.density += (double)solid[3];
    for (int k = 0; k < 3; k++) sums.gradient[k] += (double)solid[k];
  }
  for (int32_t j = 0; j < world->particles.count; j++) {
    double d[3], r = 0;
    for (int k = 0; k < 3; k++) d[k] = (double)four[4 * i + k] - (double)four[4 * j + k], r += d[k] * d[k];
    r = sqrt(r);
    if (j == i || r >= (double)world->cubic.h) continue;
    double g = (double)world->cubic.volume * sim_kernel_cubic_derivative(r, (double)world->cubic.h);
    sums.density += (double)world->cubic.volume * sim_kernel_cubic(r, (double)world->cubic.h);
    sums.squares += g * g;
    for (int k = 0; k < 3; k++) sums.gradient[k] += g * d[k] / r;
  }
  for (int k = 0; k < 3; k++) sums.squares += sums.gradient[k] * sums.gradient[k];
  return sums;
}

// A settled world: density and asymmetry of every particle.
static void density_matches_all_pairs(void **state) {
  (void)state;
  SimWorld *world = make_world(sim_wide());
  test_advance(world, 10);
  const SimParticles *p = &world->particles;
  for (int32_t i = 0; i < p->count; i++) {
    Sums sums = sums_at(world, p->first, i);
    double asymmetry = 0;
    for (int k = 0; k < 3; k++) asymmetry += sums.gradient[k] * sums.gradient[k];
    asymmetry = sqrt(asymmetry) * (double)world->cubic.spacing;
    if (fabs(sums.density - (double)p->density[i]) > 2e-6)
      fail_msg("density of %d: %.8f, %.8f", i, sums.density, (double)p->density[i]);
    if (fabs(asymmetry - (double)p->second[4 * i + 3]) > 2e-5)
      fail_msg("asymmetry of %d: %.8f, %.8f", i, asymmetry, (double)p->second[4 * i + 3]);
  }
  sim_world_destroy(world);
}

static SimStep a_step(SimWorld *world) {
  SimStep step = sim_step_make(world, 0.004f);
  step.omega = 0.6f;
  step.wall_answer = 1.4f;
  step.relaxation = 0.1f * world->cubic.lattice_gradient;
  step.warm = step.dt * step.dt;
  return step;
}

// Where nothing was clamped (test_boundary), the velocity changed by the move.
static void check_move(const SimWorld *world, const SimStep *step, const float *from, int32_t i, const double move[3]) {
  const SimParticles *p = &world->particles;
  for (int k = 0; k < 3 && !(p->near[i / SIM_CHUNK] & SIM_NEAR_BODY); k++) {
    double moved = (double)p->now.next_velocity[k][i] * (double)step->dt, to = (double)from[4 * i + k] + move[k];
    double low = (double)world->def.container.min[k] + 0.025, high = (double)world->def.container.max[k] - 0.025;
    if (to >= low && to <= high && fabs(moved - move[k]) > 2e-8)
      fail_msg("move of %d along %d: %g, %g", i, k, move[k], moved);
  }
}

// One iteration on a settled, jittered block: λ of Eq. 11, projected, with a share of the last one where `over` is above 1, and
// Δp of Eq. 14.
static void iterate(float over) {
  SimWorld *world = make_world(sim_wide());
  SimParticles *p = &world->particles;
  SimStep step = a_step(world);
  int32_t n = p->count;
  double longest = 0, scale = 0, most = 0, *lambda = calloc((size_t)n, sizeof *lambda);
  step.over = over;
  for (int32_t i = 0; i < n; i++) {
    p->now.pressure[i] = -1e-6f * (float)(i % 7);      // some of it has to be taken back
    p->density[i] = 0.001f * (float)(i % 3);           // inherited
    p->second[4 * i + 3] = 1e-6f * (float)(i % 5 - 2); // the last change
    for (int k = 0; k < 3; k++) p->now.next_velocity[k][i] = 0;
    Sums sums = sums_at(world, p->first, i);
    double before = (double)p->now.pressure[i], excess = sums.density - 1 - (double)p->density[i];
    double change = -0.6 * excess / (sums.squares + (double)step.relaxation);
    double after = before + (double)over * change + ((double)over - 1) * (double)p->second[4 * i + 3];
    lambda[i] = (after < 0 ? after : 0) - before;
    scale = fmax(scale, fabs(lambda[i]));
  }
  sim_parallel_for(1, n, step.wide->pbf_density, &step);
  for (int32_t i = 0; i < n; i++)
    if (fabs(lambda[i] - (double)p->second[4 * i + 3]) > 1e-4 * scale)
      fail_msg("lambda of %d: %g, %g", i, lambda[i], (double)p->second[4 * i + 3]);

  sim_particles_pad(p, p->second);
  sim_parallel_max(1, n, 1, step.wide->pbf_correct, &step, &longest);
  for (int32_t i = 0; i < n; i++) {
    double move[3];
    reference_move(world, p->second, lambda, NULL, 1.4, i, move);
    check_move(world, &step, p->second, i, move);
    most = fmax(most, sqrt(move[0] * move[0] + move[1] * move[1] + move[2] * move[2]));
  }
  assert_true(most > 0 && fabs(sqrt(longest) - most) < 0.2 * most);
  free(lambda);
  sim_world_destroy(world);
}

static void an_iteration_matches_all_pairs(void **state) {
  (void)state;
  iterate(1);
  iterate(1.4f);
}

// ---- The start of a substep --------------------------------------------------------------------------------------------

// A state in `second`, predicted places in `first`, as the stages of a substep leave them.
static void lay_out(SimWorld *world) {
  SimParticles *p = &world->particles;
  memcpy(p->second, p->first, 4 * sizeof(float) * (size_t)p->count);
  for (int32_t i = 0; i < p->count; i++) {
    p->now.pressure[i] = -1 - 0.1f * (float)(i % 7);
    for (int k = 0; k < 3; k++) {
      p->first[4 * i + k] += 1e-4f * (float)((i + k) % 5 - 2);
      p->now.next_velocity[k][i] = 0;
    }
  }
  sim_particles_pad(p, p->second);
  sim_particles_pad(p, p->first);
}

static void the_start_matches_all_pairs(void **state) {
  (void)state;
  SimWorld *world = make_world(sim_wide());
  SimParticles *p = &world->particles;
  SimStep step = a_step(world);
  int32_t n = p->count;
  double longest = 0, *lambda = calloc((size_t)n, sizeof *lambda), (*shear)[3][3] = calloc((size_t)n, sizeof *shear);
  lay_out(world);
  float *compression = calloc((size_t)n, sizeof *compression);
  for (int32_t i = 0; i < n; i++) compression[i] = (float)fmax(0, sums_at(world, p->second, i).density - 1);
  sim_parallel_for(1, n, step.wide->pbf_inherit, &step);
  sim_particles_pad_zero(p, p->solid);
  for (int32_t i = 0; i < n; i++) {
    double expected[3][3];
    lambda[i] = (double)p->now.pressure[i];
    if (fabs(lambda[i] + 16e-6 * (1 + 0.1 * (i % 7))) > 1e-9) fail_msg("lambda of %d: %g", i, lambda[i]);
    if (p->first[4 * i + 3] != p->now.pressure[i]) fail_msg("lambda of %d is not beside its place", i);
    if (fabsf(compression[i] - p->density[i]) > 2e-6f) fail_msg("compression of %d", i);
    reference_unpack(p->solid + 4 * i, shear[i]);
    reference_shear(world, p->second, i, expected);
    for (int k = 0; k < 3; k++)
      for (int l = 0; l < 3; l++)
        if (fabs(shear[i][k][l] / lambda[i] - expected[k][l]) > 1e-4 + 0.01 * fabs(expected[k][l]))
          fail_msg("shear of %d: %g, %g", i, shear[i][k][l] / lambda[i], expected[k][l]);
  }
  sim_parallel_max(1, n, 1, step.wide->pbf_start, &step, &longest);
  for (int32_t i = 0; i < n; i++) {
    double move[3];
    reference_move(world, p->first, lambda, shear, 1.4, i, move);
    check_move(world, &step, p->first, i, move);
  }
  free(compression);
  free(shear);
  free(lambda);
  sim_world_destroy(world);
}

// A cube of lattice, stretched about its middle by `factor`, and the particle nearest to the middle.
static SimWorld *stretched_cube(const float factor[3], int32_t *centre) {
  const float middle = 0.3f;
  SimWorldDef def = test_def((const float[3]){1, 1, 1}, &block, (const float[3]){0.6f, 0.6f, 0.6f});
  SimWorld *world = test_create(&def);
  SimParticles *p = &world->particles;
  SimError error;
  double nearest = INFINITY;
  for (int32_t i = 0; i < p->count; i++)
    for (int k = 0; k < 3; k++) p->now.position[k][i] = middle + factor[k] * (p->now.position[k][i] - middle);
  world->settled = false;
  assert_true(sim_world_settle(world, &error));
  for (int32_t i = 0; i < p->count; i++) {
    double d = 0;
    for (int k = 0; k < 3; k++) d += pow((double)(p->first[4 * i + k] - middle), 2);
    if (d < nearest) nearest = d, *centre = i;
  }
  return world;
}

// What it is for, on paper: the stress of a particle in a lattice is the same in all directions, E = 0. In one that is stretched
// by a tenth along x and squeezed along y it is not, and (1 + E) M leaves at most a tenth of the difference.
static void stress_is_the_same_in_all_directions(void **state) {
  (void)state;
  for (int stretched = 0; stretched < 2; stretched++) {
    const float factor[3] = {stretched ? 1.1f : 1, stretched ? 0.92f : 1, 1};
    int32_t centre = 0;
    SimWorld *world = stretched_cube(factor, &centre);
    double m[3][3], e[3][3], stress[3][3] = {{0}};
    SimStep step = a_step(world);
    lay_out(world);
    sim_parallel_for(1, world->particles.count, step.wide->pbf_inherit, &step);
    reference_moment(world, world->particles.second, centre, m);
    reference_unpack(world->particles.solid + 4 * centre, e);
    double lambda = (double)world->particles.now.pressure[centre];
    for (int k = 0; k < 3; k++)
      for (int l = 0; l < 3; l++)
        for (int q = 0; q < 3; q++) stress[k][l] += m[k][q] * ((q == l) + e[q][l] / lambda);
    double before = fabs(m[0][0] - m[1][1]), after = fabs(stress[0][0] - stress[1][1]);
    if (!stretched) assert_true(before < 1e-5 && fabs(e[0][0] / lambda) < 1e-5 && fabs(e[0][1] / lambda) < 1e-5);
    if (stretched && !(before > 0.03 && after < 0.1 * before)) fail_msg("%g of %g are left", after, before);
    sim_world_destroy(world);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_instruction_set_gives_the_same_bytes),
      cmocka_unit_test(every_instruction_set_gives_the_same_heights),
      cmocka_unit_test(density_matches_all_pairs),
      cmocka_unit_test(an_iteration_matches_all_pairs),
      cmocka_unit_test(the_start_matches_all_pairs),
      cmocka_unit_test(stress_is_the_same_in_all_directions),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
