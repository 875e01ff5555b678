// The full-length physics: the pool at rest for five seconds, and the default dam break until it has come to rest.
#include "sim_test.h"

// Lattice at rest, after 3 s: mean density error ≤ 1 %, largest ≤ 5 % away from the surface, level within one spacing;
// after 5 s: kinetic energy per mass below 10⁻⁴ g H.
static void still_pool(SimSolver solver) {
  SimBlockDef block = {{0, 0, 0}, {1.4f, 0.42f, 0.7f}, {0, 0, 0}, {0, 0, 0}};
  SimWorldDef def = sim_default_world_def();
  def.container = (SimContainer){{0, 0, 0}, {1.4f, 0.8f, 0.7f}};
  def.block_count = 1;
  def.solver = solver;
  def.blocks = &block;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  SimMeasures start = sim_world_measures(world);
  test_advance(world, 180);
  SimMeasures measures = sim_world_measures(world);
  print_message("still pool, 3 s: density error mean %.4f, largest %.4f\n", measures.mean_density_error,
                measures.max_density_error);
  assert_true(measures.mean_density_error <= 0.01 && measures.max_density_error <= 0.05);
  const SimFrame *frame = test_frame(world, SIM_NEED_HEIGHT_FIELD, buffer);
  double level = 0;
  int nodes = frame->height_field.size[0] * frame->height_field.size[1];
  for (int k = 0; k < nodes; k++) level += (double)frame->height_field.height[k] / nodes;
  print_message("still pool, 3 s: level %.4f of 0.42 m\n", level);
  assert_true(fabs(level - 0.42) < 0.035);
  test_advance(world, 120);
  measures = sim_world_measures(world);
  double mass = start.potential_energy / (9.81 * 0.21), per_mass = measures.kinetic_energy / mass;
  print_message("still pool, 5 s: kinetic energy per mass %.2e of %.2e\n", per_mass, 1e-4 * 9.81 * 0.42);
  assert_true(per_mass < 1e-4 * 9.81 * 0.42);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

static void still_pool_of_pbf(void **state) {
  (void)state;
  still_pool(SIM_SOLVER_PBF);
}

static void still_pool_of_sph(void **state) {
  (void)state;
  still_pool(SIM_SOLVER_SPH);
}

// About 20,000 particles, container 3 × 1.6 × 1 m. Inside in every frame, energy bound, Ritter's bound, and the
// sloshing dies away.
static void default_dam_break(void **state) {
  (void)state;
  SimBlockDef block = {{0, 0, 0}, {0.75f, 1.2f, 1}, {0, 0, 0}, {0, 0, 0}};
  SimWorldDef def = sim_default_world_def();
  def.block_count = 1;
  def.blocks = &block;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  SimMeasures measures = sim_world_measures(world);
  double start = measures.potential_energy, mass = start / (9.81 * 0.6);
  for (int f = 1; f <= 720; f++) {
    test_advance(world, 1);
    const SimFrame *frame = test_frame(world, 0, buffer);
    test_inside_container(frame);
    measures = sim_world_measures(world);
    assert_true(measures.kinetic_energy + measures.potential_energy <= 1.01 * start);
    for (int32_t i = 0; i < frame->count; i++)
      assert_true((double)frame->position[3 * i] <= 0.75 + 2 * sqrt(9.81 * 1.2) * frame->time + 0.0175);
  }
  SimCounts counts = sim_world_counts(world);
  print_message("dam break: %d particles, %.1f substeps a frame, after 12 s kinetic energy per mass %.2e m²/s²\n",
                counts.particles, (double)counts.substeps / 720, measures.kinetic_energy / mass);
  assert_true(measures.kinetic_energy / mass < 0.05);
  assert_true(measures.mean_density_error <= 0.01);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(still_pool_of_pbf), cmocka_unit_test(still_pool_of_sph), cmocka_unit_test(default_dam_break)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
