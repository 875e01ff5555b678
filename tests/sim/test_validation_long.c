// The validation at a size where its figures are worth quoting.
#include "validation.h"

static void columns_of_several_sizes(void **state) {
  (void)state;
  const double base[3] = {0.05715, 1, 2}; // the experiment's, and larger
  const int across[3] = {24, 40, 32};
  for (int k = 0; k < 3; k++) {
    ColumnCollapse result = validate_column_collapse(SIM_SOLVER_PBF, base[k], across[k], 12);
    print_message("column of %.3f m, %d across: front %.3f rms, %.3f at most, shift %.2f; height %.3f at most; Ritter "
                  "%.3f\n", base[k], across[k], result.front_rms, result.front_largest, result.shift,
                  result.height_largest, result.ritter_excess);
    assert_true(result.front_rms <= 0.10 && result.front_largest <= 0.15);
    assert_true(result.height_largest <= 0.06);
    assert_true(result.ritter_excess <= 0);
  }
}

static void standing_waves(void **state) {
  (void)state;
  const struct { SimSolver solver; int layers; double amplitude, jitter; } cases[5] = {
      {SIM_SOLVER_PBF, 16, 0.05, 0}, {SIM_SOLVER_PBF, 24, 0.05, 0.2}, {SIM_SOLVER_PBF, 24, 0.15, 0},
      {SIM_SOLVER_PBF, 12, 0.1, 0},  {SIM_SOLVER_SPH, 16, 0.1, 0},
  };
  for (int k = 0; k < 5; k++) {
    StandingWave wave =
        validate_standing_wave(cases[k].solver, cases[k].layers, cases[k].amplitude, cases[k].jitter);
    print_message("%s, standing wave in %d layers, amplitude %.2f, jitter %.1f: period %.4f of theory, keeps %.2f in half of it\n",
                  cases[k].solver == SIM_SOLVER_SPH ? "sph" : "pbf", cases[k].layers, cases[k].amplitude, cases[k].jitter,
                  wave.period, wave.kept);
    assert_true(fabs(wave.period - 1) <= 0.03);
  }
}

// Pools of different depth and particle size, from 7 to 40 layers: below 10⁻⁴ g H after five seconds, and from then on for a minute.
static void a_pool_stays_at_rest_for_a_minute(void **state) {
  (void)state;
  const double depth[4] = {0.3, 0.5, 0.8, 1.2}, radius[4] = {0.02, 0.025, 0.02, 0.015};
  for (int k = 0; k < 4; k++) {
    SimBlockDef block = {{0, 0, 0}, {0.6f, (float)depth[k], 0.4f}};
    SimWorldDef def = sim_default_world_def();
    def.particle_radius = (float)radius[k];
    def.container = (SimContainer){{0, 0, 0}, {0.6f, 1.6f, 0.4f}};
    def.threads = 2;
    def.blocks = &block;
    def.block_count = 1;
    SimWorld *world = test_create(&def);
    double mass = sim_world_counts(world).particles * 1000 * pow(2 * radius[k], 3), most = 0;
    test_advance(world, 300);
    for (int second = 5; second < 65; second++) {
      most = fmax(most, sim_world_measures(world).kinetic_energy / (mass * 9.81 * depth[k]));
      test_advance(world, 60);
    }
    print_message("pool of %.1f m, radius %.3f m: at most %.2e g H\n", depth[k], radius[k], most);
    assert_true(most < 1e-4);
    sim_world_destroy(world);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(columns_of_several_sizes), cmocka_unit_test(standing_waves),
                                     cmocka_unit_test(a_pool_stays_at_rest_for_a_minute)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
