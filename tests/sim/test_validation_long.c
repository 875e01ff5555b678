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
  const int layers[2] = {16, 24};
  for (int k = 0; k < 2; k++) {
    double ratio = validate_standing_wave(SIM_SOLVER_PBF, layers[k]);
    print_message("standing wave, %d layers: period %.4f of theory\n", layers[k], ratio);
    assert_true(fabs(ratio - 1) <= 0.03);
  }
}

// Three pools of different depth and particle size: below 10⁻⁴ g H after five seconds, and from then on for a minute.
static void a_pool_stays_at_rest_for_a_minute(void **state) {
  (void)state;
  const double depth[3] = {0.3, 0.5, 0.8}, radius[3] = {0.02, 0.025, 0.02};
  for (int k = 0; k < 3; k++) {
    SimBlockDef block = {{0, 0, 0}, {0.6f, (float)depth[k], 0.4f}};
    SimWorldDef def = sim_default_world_def();
    def.particle_radius = (float)radius[k];
    def.container = (SimContainer){{0, 0, 0}, {0.6f, 1.2f, 0.4f}};
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
