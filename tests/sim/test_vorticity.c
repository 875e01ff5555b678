// Vorticity confinement: the curl and the push against all pairs and on paper, and what it does to water.
#include "sim_test.h"

#include "sim/world.h"

static SimBlockDef block;

// A weightless block of 12 × 16 × 12 spacings of 2 cm far from all walls.
static SimWorldDef hanging_def(void) {
  SimWorldDef def = test_def((const float[3]){0.8f, 0.8f, 0.8f}, &block, (const float[3]){0, 0, 0});
  block = (SimBlockDef){{0.28f, 0.24f, 0.28f}, {0.52f, 0.56f, 0.52f}, {0, 0, 0}, {0, 0, 0}};
  def.particle_radius = 0.01f;
  memset(def.gravity, 0, sizeof def.gravity);
  def.vorticity = 0.5f;
  return def;
}

static void to_second(SimParticles *p) {
  for (int32_t i = 0; i < p->count; i++)
    for (int k = 0; k < 3; k++) p->second[4 * i + k] = p->now.next_velocity[k][i];
  sim_particles_pad_zero(p, p->second);
}

// u = Ω × x has the curl 2Ω: inside to single precision, at a flat surface, whose neighbours lie unevenly, within a third.
static void a_rigid_rotation_has_twice_its_rate(void **state) {
  (void)state;
  const float omega[3] = {1, -2, 3};
  SimWorldDef def = hanging_def();
  SimWorld *world = test_create(&def);
  SimParticles *p = &world->particles;
  for (int32_t i = 0; i < p->count; i++)
    for (int k = 0; k < 3; k++) {
      int a = (k + 1) % 3, b = (k + 2) % 3;
      p->now.next_velocity[k][i] = omega[a] * p->first[4 * i + b] - omega[b] * p->first[4 * i + a];
    }
  to_second(p);
  SimStep step = sim_step_make(world, 0.01f);
  sim_parallel_for(1, p->count, step.wide->vorticity_curl, &step);
  int inside = 0;
  for (int32_t i = 0; i < p->count; i++) {
    double error = 0;
    bool deep = true;
    for (int k = 0; k < 3; k++) {
      error += pow((double)p->work[4 * i + k] - 2 * (double)omega[k], 2);
      deep = deep && p->first[4 * i + k] > block.min[k] + 0.04f && p->first[4 * i + k] < block.max[k] - 0.04f;
    }
    if (deep && sqrt(error) > 1e-3) fail_msg("curl of %d is off by %g", i, sqrt(error));
    inside += deep;
    if (sqrt(error) > 7.5 / 3) fail_msg("curl of %d at the surface is off by %g", i, sqrt(error));
  }
  assert_true(inside == 8 * 12 * 8);
  // And such a rotation is left alone where its curl is even.
  sim_particles_pad_zero(p, p->work);
  for (int k = 0; k < 3; k++) memset(p->now.next_velocity[k], 0, sizeof(float) * (size_t)p->count);
  sim_parallel_for(1, p->count, step.wide->vorticity_confine, &step);
  int even = 0;
  for (int32_t i = 0; i < p->count; i++) {
    bool deep = true;
    for (int k = 0; k < 3; k++)
      deep = deep && p->first[4 * i + k] > block.min[k] + 0.08f && p->first[4 * i + k] < block.max[k] - 0.08f;
    even += deep;
    // What ε d |ω|² dt would be with a direction: 0.005 m/s.
    for (int k = 0; k < 3 && deep; k++) assert_true(fabsf(p->now.next_velocity[k][i]) < 1e-4f);
  }
  assert_true(even == 4 * 8 * 4);
  sim_world_destroy(world);
}

static void sweeps_match_all_pairs(void **state) {
  (void)state;
  SimWorldDef def = hanging_def();
  def.jitter = 0.2f;
  SimWorld *world = test_create(&def);
  SimParticles *p = &world->particles;
  SimStep step = sim_step_make(world, 0.01f);
  int32_t n = p->count;
  double h = (double)world->cubic.h, volume = (double)world->cubic.volume, d = 0.02,
         (*curl)[4] = calloc((size_t)n, sizeof *curl), (*v)[3] = calloc((size_t)n, sizeof *v);
  for (int32_t i = 0; i < n; i++)
    for (int k = 0; k < 3; k++)
      v[i][k] =
          (double)(p->now.next_velocity[k][i] = sinf(9 * p->first[4 * i + (k + 1) % 3]) + (k == 1) * p->first[4 * i]);
  sim_step_vorticity(&step);
  for (int pass = 0; pass < 2; pass++)
    for (int32_t i = 0; i < n; i++) {
      double sum[3] = {0}, moment = 0;
      for (int32_t j = 0; j < n; j++) {
        double e[3], r = 0, u[3];
        for (int k = 0; k < 3; k++) e[k] = (double)p->first[4 * i + k] - (double)p->first[4 * j + k], r += e[k] * e[k];
        r = sqrt(r);
        if (i == j || r >= h) continue;
        double g = volume * sim_kernel_cubic_derivative(r, h) / r;
        moment -= g * r * r / 3;
        for (int k = 0; k < 3; k++) u[k] = v[j][k] - v[i][k];
        for (int k = 0; k < 3; k++)
          sum[k] += pass ? (curl[j][3] - curl[i][3]) * g * e[k]
                         : -g * (u[(k + 1) % 3] * e[(k + 2) % 3] - u[(k + 2) % 3] * e[(k + 1) % 3]);
      }
      double size = 0;
      if (!pass) {
        for (int k = 0; k < 3; k++) {
          curl[i][k] = sum[k] / fmax(moment, 0.1), size += curl[i][k] * curl[i][k];
          if (fabs(curl[i][k] - (double)p->work[4 * i + k]) > 1e-3)
            fail_msg("curl of %d: %g, %g", i, curl[i][k], (double)p->work[4 * i + k]);
        }
        curl[i][3] = sqrt(size);
        continue;
      }
      for (int k = 0; k < 3; k++) size += sum[k] * sum[k] * d * d;
      size = sqrt(size) + 1e-3 * curl[i][3];
      for (int k = 0; k < 3; k++) {
        int a = (k + 1) % 3, b = (k + 2) % 3;
        double push = 0.5 * d * 0.01 * fmin(curl[i][3], 100) * d * (sum[a] * curl[i][b] - sum[b] * curl[i][a]) / size;
        double changed = (double)p->now.next_velocity[k][i] - v[i][k];
        if (fabs(changed - push) > 3e-5 * d * curl[i][3] + 1e-6) fail_msg("push on %d: %g, %g", i, push, changed);
      }
    }
  free(curl);
  free(v);
  sim_world_destroy(world);
}

// A whirl in a weightless block, strong in the middle and at rest outside: with confinement more of it is left after
// some turns, momentum stays near zero, and nothing explodes. The same in water of a tenth of the size.
static double energy_left(SimSolver solver, float confinement, float scale, double *momentum) {
  SimWorldDef def = hanging_def();
  for (int k = 0; k < 3; k++) {
    block.min[k] *= scale, block.max[k] *= scale;
    def.container.max[k] *= scale;
  }
  def.particle_radius *= scale;
  def.kinematic_viscosity = 0;
  def.solver = solver;
  def.vorticity = confinement;
  SimWorld *world = test_create(&def);
  SimParticles *p = &world->particles;
  double mass = 1000 * 0.24 * 0.24 * 0.32 * pow((double)scale, 3);
  for (int32_t i = 0; i < p->count; i++) {
    double x = (double)p->now.position[0][i] / (double)scale - 0.4,
           z = (double)p->now.position[2][i] / (double)scale - 0.4;
    double turn = 4 * exp(-(x * x + z * z) / (2 * 0.04 * 0.04));
    p->now.velocity[0][i] = (float)(-turn * z) * scale;
    p->now.velocity[2][i] = (float)(turn * x) * scale;
  }
  double start = sim_world_measures(world).kinetic_energy;
  SimError error = {""};
  for (int f = 0; f < 20; f++)
    if (!sim_world_advance(world, 0.05, &error)) fail_msg("%s", error.message);
  SimMeasures end = sim_world_measures(world);
  *momentum =
      sqrt(pow(end.momentum[0], 2) + pow(end.momentum[1], 2) + pow(end.momentum[2], 2)) / sqrt(2 * mass * start);
  sim_world_destroy(world);
  return end.kinetic_energy / start;
}

static void a_whirl_keeps_more_of_its_energy(void **state) {
  (void)state;
  for (int solver = 0; solver < 2; solver++) {
    double momentum[3], without = energy_left((SimSolver)solver, 0, 1, &momentum[0]),
                        with = energy_left((SimSolver)solver, 0.2f, 1, &momentum[1]),
                        most = energy_left((SimSolver)solver, 1, 1, &momentum[2]);
    print_message(
        "solver %d: of a whirl's energy %.3f are left, %.3f with confinement 0.2, %.3f with 1; momentum %.1e, %.1e\n",
        solver, without, with, most, momentum[1], momentum[2]);
    assert_true(with > 1.02 * without && most > with && most < 3);
    assert_true(momentum[0] < 1e-5 && momentum[1] < 0.01 && momentum[2] < 0.05);
  }
}

static void scale_does_not_matter(void **state) {
  (void)state;
  double momentum, large = energy_left(SIM_SOLVER_PBF, 0.5f, 1, &momentum),
                   small = energy_left(SIM_SOLVER_PBF, 0.5f, 0.1f, &momentum);
  print_message("confinement in water of a tenth of the size: %.3f, %.3f\n", large, small);
  assert_true(fabs(large / small - 1) < 0.02);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_rigid_rotation_has_twice_its_rate),
      cmocka_unit_test(sweeps_match_all_pairs),
      cmocka_unit_test(a_whirl_keeps_more_of_its_energy),
      cmocka_unit_test(scale_does_not_matter),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
