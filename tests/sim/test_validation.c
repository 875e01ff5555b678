// Position based fluids against experiments and theory, at a small size; test_validation_long.c has the large one.
#include "validation.h"

static void a_column_collapses_as_measured(void **state) {
  (void)state;
  ColumnCollapse result = validate_column_collapse(SIM_SOLVER_PBF, 1, 16, 8);
  print_message("column: front %.3f rms, %.3f at most, shift %.2f; height %.3f at most; Ritter %.3f\n", result.front_rms,
                result.front_largest, result.shift, result.height_largest, result.ritter_excess);
  assert_true(result.front_rms <= 0.10 && result.front_largest <= 0.15);
  assert_true(result.height_largest <= 0.06);
  assert_true(result.ritter_excess <= 0);
}

static void check_wave(SimSolver solver, int layers, double amplitude, double jitter) {
  StandingWave wave = validate_standing_wave(solver, layers, amplitude, jitter);
  print_message("standing wave in %d layers, amplitude %.2f, jitter %.1f: period %.4f of theory, keeps %.2f in half of it\n",
                layers, amplitude, jitter, wave.period, wave.kept);
  assert_true(fabs(wave.period - 1) <= 0.03);
  assert_true(wave.kept >= 0.75 && wave.kept < 1);
}

// Of little more than a spacing and of two, in a perfect lattice and in an uneven one: it must not matter.
static void a_standing_wave_keeps_time(void **state) {
  (void)state;
  check_wave(SIM_SOLVER_PBF, 16, 0.07, 0);
  check_wave(SIM_SOLVER_PBF, 16, 0.15, 0);
  check_wave(SIM_SOLVER_PBF, 16, 0.1, 0.2);
}

// A dam break from 2 mm to 5 cm: in units of sqrt(size/g) the front is in the same place.
static void the_motion_does_not_depend_on_scale(void **state) {
  (void)state;
  const float radii[3] = {0.002f, 0.0175f, 0.05f};
  double front[3];
  for (int k = 0; k < 3; k++) {
    float d = 2 * radii[k];
    SimBlockDef block = {{0, 0, 0}, {12 * d, 16 * d, 8 * d}};
    SimWorldDef def = sim_default_world_def();
    def.particle_radius = radii[k];
    def.container = (SimContainer){{0, 0, 0}, {60 * d, 30 * d, 8 * d}};
    def.blocks = &block;
    def.block_count = 1;
    SimWorld *world = test_create(&def);
    SimFrameBuffer *buffer = sim_frame_buffer_create();
    SimError error = {""};
    for (int f = 0; f < 60; f++)
      if (!sim_world_advance(world, 0.15 * sqrt((double)d / 9.81), &error)) fail_msg("%s", error.message);
    const SimFrame *frame = test_frame(world, 0, buffer);
    front[k] = 0;
    for (int32_t i = 0; i < frame->count; i++) front[k] = fmax(front[k], (double)(frame->position[3 * i] / d));
    sim_frame_buffer_destroy(buffer);
    sim_world_destroy(world);
  }
  print_message("front after the same scaled time: %.2f, %.2f, %.2f spacings\n", front[0], front[1], front[2]);
  for (int k = 0; k < 3; k += 2) assert_true(fabs(front[k] / front[1] - 1) < 0.05);
}

// A time step far too large: the method takes the substeps that it needs.
static void a_time_step_too_large_is_cut(void **state) {
  (void)state;
  SimBlockDef block;
  SimWorldDef def = test_def((const float[3]){1.5f, 1, 0.4f}, &block, (const float[3]){0.5f, 0.8f, 0.4f});
  def.time_step = 0.05f;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  SimError error = {""};
  for (int f = 0; f < 20; f++) {
    if (!sim_world_advance(world, 0.05, &error)) fail_msg("%s", error.message);
    test_inside_container(test_frame(world, 0, buffer));
    assert_true(sim_world_measures(world).max_speed < 10);
  }
  assert_true(sim_world_counts(world).substeps > 60);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

// After it has come to rest a pool stands as high as it was filled, within 1 %, also where the spacing divides nothing.
static void check_level(float radius) {
  SimBlockDef block;
  SimWorldDef def = test_def((const float[3]){0.8f, 2, 0.4f}, &block, (const float[3]){0.4f, 1.6f, 0.4f});
  def.particle_radius = radius;
  def.viscosity = 0.1f; // calmer sooner
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  test_advance(world, 300);
  const SimFrame *frame = test_frame(world, SIM_NEED_HEIGHT_FIELD, buffer);
  const SimHeightField *field = &frame->height_field;
  double level = 0;
  int nodes = 0;
  for (int k = 2; k < field->size[1] - 2; k++)
    for (int i = 2; i < field->size[0] - 2; i++, nodes++) level += (double)field->height[k * field->size[0] + i];
  level /= nodes;
  print_message("radius %.4f m: level %.4f m of 0.8\n", (double)radius, level);
  assert_true(fabs(level / 0.8 - 1) <= 0.01);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

static void volume_is_kept(void **state) {
  (void)state;
  check_level(0.025f);
  check_level(0.0175f);
}

// A block dropped from 3 m: nothing leaves the tank, nothing explodes, no energy is gained.
static void a_block_dropped_from_high_up(void **state) {
  (void)state;
  SimBlockDef blocks[2] = {{{0, 0, 0}, {0.7f, 0.2f, 0.7f}}, {{0.2f, 3, 0.2f}, {0.5f, 3.3f, 0.5f}}};
  SimBlockDef unused;
  SimWorldDef def = test_def((const float[3]){0.7f, 4, 0.7f}, &unused, (const float[3]){1, 1, 1});
  def.blocks = blocks;
  def.block_count = 2;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  double start = sim_world_measures(world).potential_energy;
  for (int f = 0; f < 100; f++) {
    test_advance(world, 1);
    test_inside_container(test_frame(world, 0, buffer));
    SimMeasures measures = sim_world_measures(world);
    assert_true(measures.kinetic_energy + measures.potential_energy <= 1.01 * start);
  }
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_column_collapses_as_measured), cmocka_unit_test(a_standing_wave_keeps_time),
      cmocka_unit_test(the_motion_does_not_depend_on_scale), cmocka_unit_test(a_time_step_too_large_is_cut),
      cmocka_unit_test(volume_is_kept), cmocka_unit_test(a_block_dropped_from_high_up),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
