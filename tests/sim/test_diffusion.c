// Viscosity and mixing: the sweep against all pairs, and fields whose decay is known on paper.
#include "sim_test.h"

#include "sim/world.h"

#define PI 3.14159265358979323846

static SimBlockDef block;

// A block that hangs in a weightless box, far from its walls.
static SimWorldDef hanging_def(float x, float y, float z, float d) {
  float size[3] = {x + 8 * d, y + 8 * d, z + 8 * d};
  SimWorldDef def = test_def(size, &block, (const float[3]){0, 0, 0});
  block = (SimBlockDef){{4 * d, 4 * d, 4 * d}, {4 * d + x, 4 * d + y, 4 * d + z}, {0, 0, 0}, {0, 0, 0}};
  def.particle_radius = d / 2;
  memset(def.gravity, 0, sizeof def.gravity);
  def.viscosity = 0;
  def.kinematic_viscosity = 0;
  return def;
}

static void the_sweep_matches_all_pairs(void **state) {
  (void)state;
  SimWorldDef def = hanging_def(0.4f, 0.3f, 0.3f, 0.05f);
  def.jitter = 0.2f;
  SimWorld *world = test_create(&def);
  SimParticles *p = &world->particles;
  SimStep step = sim_step_make(world, 0.01f);
  step.diffusion = (SimDiffusion){.share = 0.1f, .spread = 2e-4f, .keep = 1.5f, .before = -0.5f, .gain = 0.7f};
  uint64_t seed = 7;
  for (int32_t i = 0; i < p->count; i++)
    for (int k = 0; k < 3; k++) {
      p->second[4 * i + k] = (float)test_random(&seed);
      p->now.next_velocity[k][i] = (float)test_random(&seed);
    }
  sim_particles_pad(p, p->second);
  double h = (double)world->cubic.h, volume = (double)world->cubic.volume,
         *expected = calloc((size_t)p->count, sizeof(double));
  for (int32_t i = 0; i < p->count; i++) {
    double own = (double)p->second[4 * i + 1], sum = 0;
    for (int32_t j = 0; j < p->count; j++) {
      double r2 = 0;
      for (int k = 0; k < 3; k++) r2 += pow((double)p->first[4 * i + k] - (double)p->first[4 * j + k], 2);
      double r = sqrt(r2);
      if (i == j || r >= h) continue;
      double weight = 0.1 * volume * sim_kernel_cubic(r, h) - 2e-4 / (double)world->cubic.diffuse_moment * volume *
                                                                  sim_kernel_cubic_derivative(r, h) * r /
                                                                  (r2 + 0.01 * h * h);
      sum += weight * ((double)p->second[4 * j + 1] - own);
    }
    expected[i] = 1.5 * own - 0.5 * (double)p->now.next_velocity[1][i] + 0.7 * sum;
  }
  for (int k = 0; k < 3; k++) step.diffusion.value[k] = p->now.next_velocity[k];
  sim_parallel_for(1, p->count, step.wide->diffuse, &step);
  for (int32_t i = 0; i < p->count; i++)
    if (fabs(expected[i] - (double)p->now.next_velocity[1][i]) > 1e-5)
      fail_msg("%d: %g, %g", i, expected[i], (double)p->now.next_velocity[1][i]);
  free(expected);
  sim_world_destroy(world);
}

// The part of u_x that goes with cos(k y), over the whole block: surfaces are free of stress, and cos has no slope there.
static double amplitude(const SimWorld *world, float *const velocity[3], double wave, double origin) {
  double sum = 0, squares = 0;
  for (int32_t i = 0; i < world->particles.count; i++) {
    double c = cos(wave * ((double)world->particles.now.position[1][i] - origin));
    sum += (double)velocity[0][i] * c;
    squares += c * c;
  }
  return sum / squares;
}

// A shear wave u_x = U cos(ky) between free surfaces half a wave apart decays with ν k². The flow goes round only slowly
// (U is small), so particles stay near their places.
static void a_shear_wave_decays(void **state) {
  (void)state;
  const float viscosities[] = {1e-4f, 1e-2f, 1, 10};
  const float d = 0.02f;
  for (int v = 0; v < 4; v++)
    for (int solver = 0; solver < 2; solver++) {
      SimWorldDef def = hanging_def(12 * d, 16 * d, 8 * d, d);
      def.kinematic_viscosity = viscosities[v];
      def.solver = (SimSolver)solver;
      SimWorld *world = test_create(&def);
      double wave = PI / (16 * (double)d), rate = (double)viscosities[v] * wave * wave;
      // Substeps of a hundredth of the decay time, but never longer than those that water at rest takes.
      float dt = (float)fmin(0.01 / rate, 1.0 / 60);
      int32_t n = world->particles.count;
      for (int32_t i = 0; i < n; i++)
        world->particles.now.next_velocity[0][i] =
            (float)cos(wave * ((double)world->particles.now.position[1][i] - 4 * (double)d));
      SimStep step = sim_step_make(world, dt);
      double first = amplitude(world, world->particles.now.next_velocity, wave, 4 * (double)d);
      for (int k = 0; k < 50; k++) sim_step_viscosity(&step);
      double last = amplitude(world, world->particles.now.next_velocity, wave, 4 * (double)d);
      double measured = log(first / last) / (50 * (double)dt);
      if (fabs(measured / rate - 1) > 0.1)
        fail_msg("nu %g: rate %g, expected %g", (double)viscosities[v], measured, rate);
      sim_world_destroy(world);
    }
}

// The same wave in moving water, with everything that a substep does.
static void a_shear_wave_decays_in_flow(void **state) {
  (void)state;
  const float d = 0.02f, nu = 0.005f;
  for (int solver = 0; solver < 2; solver++) {
    SimWorldDef def = hanging_def(16 * d, 16 * d, 12 * d, d);
    def.kinematic_viscosity = nu;
    def.solver = (SimSolver)solver;
    SimWorld *world = test_create(&def);
    double wave = PI / (16 * (double)d), origin = 4 * (double)d, rate = (double)nu * wave * wave, time = 0.5 / rate;
    for (int32_t i = 0; i < world->particles.count; i++)
      world->particles.now.velocity[0][i] =
          0.02f * (float)cos(wave * ((double)world->particles.now.position[1][i] - origin));
    double first = amplitude(world, world->particles.now.velocity, wave, origin);
    SimError error = {""};
    for (int k = 0; k < 10; k++)
      if (!sim_world_advance(world, time / 10, &error)) fail_msg("%s", error.message);
    double measured = log(first / amplitude(world, world->particles.now.velocity, wave, origin)) / time;
    print_message("solver %d: shear wave decays %.3f times as fast as on paper\n", solver, measured / rate);
    assert_true(fabs(measured / rate - 1) < 0.1);
    sim_world_destroy(world);
  }
}

// Thick as 10 m²/s, in a dam break with normal substeps: slow, not wild; momentum sideways stays zero.
static void the_thickest_liquid_is_calm(void **state) {
  (void)state;
  for (int solver = 0; solver < 2; solver++) {
    SimWorldDef def = test_def((const float[3]){1, 1, 0.3f}, &block, (const float[3]){0.4f, 0.6f, 0.3f});
    def.solver = (SimSolver)solver;
    def.kinematic_viscosity = 10;
    SimWorld *world = test_create(&def);
    test_advance(world, 6);
    SimMeasures measures = sim_world_measures(world);
    assert_true(measures.max_speed < 1);
    assert_true(sim_world_counts(world).substeps < 400);
    sim_world_destroy(world);
  }
}

// XSPH in 8 short substeps does what it does in one long one, where there is gravity to tell how long is long.
static void the_share_does_not_depend_on_substeps(void **state) {
  (void)state;
  double left[2];
  for (int k = 0; k < 2; k++) {
    SimWorldDef def = hanging_def(0.2f, 0.32f, 0.2f, 0.02f);
    def.gravity[1] = -9.81f;
    def.viscosity = 0.5f;
    SimWorld *world = test_create(&def);
    double wave = PI / 0.32;
    for (int32_t i = 0; i < world->particles.count; i++)
      world->particles.now.next_velocity[0][i] =
          (float)cos(wave * ((double)world->particles.now.position[1][i] - 0.08));
    SimStep step = sim_step_make(world, k ? 0.0004f : 0.0032f);
    for (int s = 0; s < (k ? 160 : 20); s++) sim_step_viscosity(&step);
    left[k] = amplitude(world, world->particles.now.next_velocity, wave, 0.08);
    sim_world_destroy(world);
  }
  assert_true(left[0] < 0.99 && fabs(log(left[0]) / log(left[1]) - 1) < 0.02);
}

// ---- Colours ---------------------------------------------------------------------------------------------------------

// A step between two colours spreads: the profile is (1 + erf(y/√(4Dt)))/2. Total kept, nothing outside [0, 1].
static void a_step_of_colour_spreads(void **state) {
  (void)state;
  const float d = 0.02f, diffusivities[2] = {1e-3f, 10};
  for (int which = 0; which < 2; which++) {
    SimWorldDef def = hanging_def(8 * d, 40 * d, 8 * d, d);
    block.colour[0] = 1;
    def.colour_diffusion = diffusivities[which];
    SimWorld *world = test_create(&def);
    SimParticles *p = &world->particles;
    double middle = 24 * (double)d,
           time = 25 * (double)d * (double)d / 4 / (double)diffusivities[which]; // √(4Dt) = 5 spacings
    for (int32_t i = 0; i < p->count; i++) {
      p->now.colour[0][i] = (double)p->now.position[1][i] < middle ? 0 : 1;
      p->now.colour[1][i] = 1 - p->now.colour[0][i];
      p->now.colour[2][i] = 0.25f;
    }
    int32_t steps = which ? 1 : 20; // at once: many stages
    SimStep step = sim_step_make(world, (float)(time / steps));
    for (int k = 0; k < steps; k++) sim_step_mix(&step);
    double total = 0, first = 0, spread = 0;
    for (int32_t i = 0; i < p->count; i++) {
      double c = (double)p->now.colour[0][i], y = (double)p->now.position[1][i] - middle;
      total += c;
      assert_true(c >= 0 && c <= 1 && fabs(c + (double)p->now.colour[1][i] - 1) < 1e-5 && p->now.colour[2][i] == 0.25f);
      first += y < 0 ? 0 : 1;
      spread += fabs(c - (y < 0 ? 0 : 1)) * (double)(d * d * d) / (double)(64 * d * d); // ∫ |c − step| dy = √(4Dt)/√π
    }
    assert_true(fabs(total / first - 1) < 1e-5);
    double width = spread * sqrt(PI);
    print_message("step of colour: width %.3f of sqrt(4 D t)\n", width / (5 * (double)d));
    assert_true(fabs(width / (5 * (double)d) - 1) < 0.1);
    sim_world_destroy(world);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_sweep_matches_all_pairs),           cmocka_unit_test(a_shear_wave_decays),
      cmocka_unit_test(a_shear_wave_decays_in_flow),           cmocka_unit_test(the_thickest_liquid_is_calm),
      cmocka_unit_test(the_share_does_not_depend_on_substeps), cmocka_unit_test(a_step_of_colour_spreads),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
