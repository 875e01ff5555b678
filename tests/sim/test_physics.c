// Water must behave like water: short copies of what test_physics_long.c runs at full length.
#include "sim_test.h"

static SimBlockDef block;

static double total_energy(SimWorld *world) {
  SimMeasures measures = sim_world_measures(world);
  return measures.kinetic_energy + measures.potential_energy;
}

// Without walls in reach a block falls as a whole: momentum m g t to 10⁻⁵, no sideways drift, and its shape is kept.
static void free_fall_keeps_momentum(void **state) {
  (void)state;
  SimWorldDef def = test_def((const float[3]){2, 4, 2}, &block, (const float[3]){0, 0, 0});
  block = (SimBlockDef){{0.8f, 3, 0.8f}, {1.2f, 3.4f, 1.2f}, {0.5f, 0, -0.25f}, {0, 0, 0}};
  def.tensile = 0.003f;
  SimWorld *world = test_create(&def);
  SimMeasures start = sim_world_measures(world);
  double mass = start.momentum[0] / 0.5;
  test_advance(world, 30);
  SimMeasures end = sim_world_measures(world);
  double expected = -mass * 9.81 * 0.5;
  assert_true(fabs(end.momentum[1] - expected) < 1e-5 * fabs(expected));
  assert_true(fabs(end.momentum[0] - start.momentum[0]) < 1e-5 * fabs(expected));
  assert_true(fabs(end.momentum[2] - start.momentum[2]) < 1e-5 * fabs(expected));
  double fallen = (start.potential_energy - end.potential_energy) / (mass * 9.81), expected_fall = 0.5 * 9.81 * 0.25;
  if (fabs(fallen - expected_fall) > 1e-4 * expected_fall) fail_msg("fallen by %.6f of %.6f m", fallen, expected_fall);
  sim_world_destroy(world);
}

// Two jittered blocks meet in free space: forces between particles are equal and opposite, so momentum stays zero.
static void inner_forces_keep_momentum(void **state) {
  (void)state;
  SimWorldDef def = test_def((const float[3]){2, 2, 2}, &block, (const float[3]){0, 0, 0});
  SimBlockDef blocks[2] = {{{0.5f, 0.8f, 0.8f}, {0.9f, 1.2f, 1.2f}, {1, 0.2f, 0}, {0, 0, 0}},
                           {{1.1f, 0.8f, 0.8f}, {1.5f, 1.2f, 1.2f}, {-1, -0.2f, 0}, {0, 0, 0}}};
  memset(def.gravity, 0, sizeof def.gravity);
  def.blocks = blocks;
  def.block_count = 2;
  def.jitter = 0.3f;
  SimWorld *world = test_create(&def);
  double start = sim_world_measures(world).kinetic_energy;
  test_advance(world, 20);
  SimMeasures measures = sim_world_measures(world);
  double mass = 2 * 512 * 0.125, scale = sqrt(2 * start * mass);
  if (!(measures.kinetic_energy > 0 && measures.kinetic_energy < 0.9 * start)) fail_msg("they did not meet: %g of %g J", measures.kinetic_energy, start);
  for (int k = 0; k < 3; k++) assert_true(fabs(measures.momentum[k]) < 2e-5 * scale + 1e-7);
  sim_world_destroy(world);
}

static void still_pool_stays_still(void **state) {
  (void)state;
  SimWorldDef def = test_def((const float[3]){0.8f, 0.8f, 0.5f}, &block, (const float[3]){0.8f, 0.4f, 0.5f});
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  test_advance(world, 90);
  SimMeasures measures = sim_world_measures(world);
  if (measures.mean_density_error > 0.01) fail_msg("mean density error %g", measures.mean_density_error);
  if (measures.max_density_error > 0.05) fail_msg("largest density error %g", measures.max_density_error);
  double mass = 1000 * 0.8 * 0.4 * 0.5, per_mass = measures.kinetic_energy / mass;
  if (per_mass > 5e-4 * 9.81 * 0.4) fail_msg("kinetic energy per mass %g", per_mass);
  const SimFrame *frame = test_frame(world, SIM_NEED_HEIGHT_FIELD, buffer);
  const SimHeightField *field = &frame->height_field;
  double level = 0;
  for (int k = 0; k < field->size[0] * field->size[1]; k++) level += (double)field->height[k];
  level /= field->size[0] * field->size[1];
  if (fabs(level - 0.4) > 0.05) fail_msg("level %g", level);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

// At walls: the lowest layer is neither denser than a layer of the lattice (stacking) nor thinner (sticking apart).
static void water_does_not_stack_on_the_floor(void **state) {
  (void)state;
  SimWorldDef def = test_def((const float[3]){0.8f, 0.8f, 0.5f}, &block, (const float[3]){0.5f, 0.64f, 0.5f});
  def.jitter = 0.1f;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  test_advance(world, 150);
  const SimFrame *frame = test_frame(world, 0, buffer);
  double lowest = 0, lower = 0;
  for (int32_t i = 0; i < frame->count; i++) {
    const float *x = frame->position + 3 * i;
    if (x[0] < 0.1f || x[0] > 0.7f || x[2] < 0.1f || x[2] > 0.4f) continue;
    lowest += x[1] < 0.05f;
    lower += x[1] < 0.2f;
  }
  double layer = 0.6 * 0.3 / 0.0025;
  if (lowest < 0.85 * layer || lowest > 1.15 * layer) fail_msg("lowest layer %g of %g", lowest, layer);
  if (lower < 3.7 * layer || lower > 4.3 * layer) fail_msg("four layers %g of %g", lower, 4 * layer);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

// Dam break: nothing outside, no energy gained, never faster than Ritter's front 2 sqrt(g H).
static void dam_break(void **state) {
  (void)state;
  SimWorldDef def = test_def((const float[3]){1.6f, 1, 0.4f}, &block, (const float[3]){0.4f, 0.6f, 0.4f});
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  double start = total_energy(world), front = 0;
  for (int f = 1; f <= 60; f++) {
    test_advance(world, 1);
    const SimFrame *frame = test_frame(world, 0, buffer);
    test_inside_container(frame);
    if (total_energy(world) > 1.01 * start) fail_msg("energy %g of %g", total_energy(world), start);
    front = 0;
    for (int32_t i = 0; i < frame->count; i++) front = fmax(front, (double)frame->position[3 * i]);
    assert_true(front <= 0.4 + 2 * sqrt(9.81 * 0.6) * frame->time + 0.025);
  }
  assert_true(front > 1.5); // it did reach the other wall
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

// Fast blocks against each other, into walls and corners, with pushes: nothing escapes, nothing explodes.
static void nothing_escapes_at_speed(void **state) {
  (void)state;
  SimBlockDef blocks[3] = {{{0, 0, 0}, {0.3f, 0.3f, 0.3f}, {30, 20, 25}, {0, 0, 0}},
                           {{0.7f, 0.6f, 0.1f}, {1, 0.9f, 0.4f}, {-50, -50, -50}, {0, 0, 0}},
                           {{0.4f, 0, 0.4f}, {0.6f, 0.2f, 0.6f}, {0, 0, 10}, {0, 0, 0}}};
  SimWorldDef def = test_def((const float[3]){1, 1, 0.6f}, &block, (const float[3]){1, 1, 1});
  def.block_count = 3;
  def.blocks = blocks;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  for (int f = 0; f < 12; f++) {
    SimPush push = {{0.5f, 0.5f, 0}, {0, 0, 1}, 0.5f, {f % 2 ? 400.0f : -400.0f, 300, 100}};
    assert_true(sim_world_push(world, &push));
    test_advance(world, 1);
    test_inside_container(test_frame(world, 0, buffer));
  }
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

static double distance_to(const SimObstacle *o, const float p[3]) {
  double d[3];
  for (int k = 0; k < 3; k++) d[k] = (double)p[k] - (double)o->position[k];
  if (o->shape == SIM_SPHERE) return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) - (double)o->size[0] / 2;
  if (o->shape == SIM_CYLINDER)
    return fmax(sqrt(d[0] * d[0] + d[2] * d[2]) - (double)o->size[0] / 2, fabs(d[1]) - (double)o->size[1] / 2);
  return fmax(fmax(fabs(d[0]) - (double)o->size[0] / 2, fabs(d[1]) - (double)o->size[1] / 2),
              fabs(d[2]) - (double)o->size[2] / 2);
}

// Start-up overlap is left out; no particle lies deeper than a tenth of a spacing; a thin full-height gate holds the
// water back.
static void obstacles_keep_water_out(void **state) {
  (void)state;
  const SimObstacle obstacles[4] = {{SIM_SPHERE, {0.3f, 0, 0}, {0.55f, 0.15f, 0.25f}, {0, 0, 0, 1}, {0, 0, 0}},
                                    {SIM_BOX, {0.15f, 0.1f, 0.2f}, {0.8f, 0.05f, 0.1f}, {0, 0, 0, 1}, {0, 0, 0}},
                                    {SIM_CYLINDER, {0.16f, 0.5f, 0}, {0.2f, 0.25f, 0.25f}, {0, 0, 0, 1}, {0, 0, 0}},
                                    {SIM_BOX, {0.004f, 2, 2}, {1.2f, 0.5f, 0.25f}, {0, 0, 0, 1}, {0, 0, 0}}};
  SimWorldDef def = test_def((const float[3]){1.5f, 0.9f, 0.5f}, &block, (const float[3]){0.45f, 0.7f, 0.5f});
  def.obstacle_count = 4;
  SimObstacleDef solids[4];
  for (int b = 0; b < 4; b++) {
    solids[b] = sim_default_obstacle_def();
    solids[b].body = obstacles[b];
  }
  def.obstacles = solids;
  SimWorld *world = test_create(&def);
  assert_true(sim_world_counts(world).left_out > 50);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  for (int f = 0; f < 60; f++) {
    test_advance(world, 1);
    const SimFrame *frame = test_frame(world, 0, buffer);
    test_inside_container(frame);
    for (int32_t i = 0; i < frame->count; i++) {
      for (int b = 0; b < 4; b++)
        if (distance_to(&obstacles[b], frame->position + 3 * i) < -0.1 * 0.05)
          fail_msg("particle %u is inside obstacle %d in frame %d", frame->id[i], b, f);
      assert_true(frame->position[3 * i] < 1.2f);
    }
  }
  assert_int_equal(test_frame(world, 0, buffer)->obstacle_count, 4);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

// The longest allowed substep is respected, and a fixed small step gives the same fall.
static void substeps_follow_the_limits(void **state) {
  (void)state;
  SimWorldDef def = test_def((const float[3]){0.5f, 1, 0.5f}, &block, (const float[3]){0.5f, 0.2f, 0.5f});
  def.time_step = 0.001f;
  SimWorld *world = test_create(&def);
  test_advance(world, 6);
  assert_true(sim_world_counts(world).substeps >= 100 && sim_world_counts(world).substeps <= 103);
  sim_world_destroy(world);
  def.time_step = 0;
  block.velocity[1] = -7;
  block.min[1] = 0.7f, block.max[1] = 0.9f;
  def.cfl = 0.2f; // at 7 m/s a spacing of 0.05 m takes 7.1 ms, a fifth of it 1.4 ms, half as much again in free flight
  world = test_create(&def);
  test_advance(world, 1);
  assert_true(sim_world_counts(world).substeps >= 8 && sim_world_counts(world).substeps <= 11);
  sim_world_destroy(world);
}

// Other particle sizes and supports stay calm with the same numbers: ε and k carry no hidden length.
static void the_parameters_do_not_depend_on_scale(void **state) {
  (void)state;
  const float radii[2] = {0.0005f, 0.5f}, supports[3] = {1.7f, 2, 2.5f};
  for (int k = 0; k < 6; k++) {
    SimWorldDef def = sim_default_world_def();
    float d = 2 * radii[k % 2];
    def.particle_radius = radii[k % 2];
    def.support = supports[k / 2];
    def.threads = 2;
    def.container = (SimContainer){{0, 0, 0}, {12 * d, 16 * d, 8 * d}};
    block = (SimBlockDef){{0, 0, 0}, {12 * d, 8 * d, 8 * d}, {0, 0, 0}, {0, 0, 0}};
    def.block_count = 1;
    def.blocks = &block;
    SimWorld *world = test_create(&def);
    SimError error = {""};
    double unit = sqrt((double)d / 9.81);
    for (int f = 0; f < 20; f++)
      if (!sim_world_advance(world, unit, &error)) fail_msg("%s", error.message);
    SimMeasures measures = sim_world_measures(world);
    double mass = 768 * 1000 * pow((double)d, 3);
    if (measures.mean_density_error > 0.02 || measures.kinetic_energy / mass > 4e-3 * 9.81 * 8 * (double)d)
      fail_msg("radius %g, support %g: density error %g, kinetic energy %g gH", (double)radii[k % 2],
               (double)supports[k / 2], measures.mean_density_error,
               measures.kinetic_energy / mass / (9.81 * 8 * (double)d));
    sim_world_destroy(world);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(free_fall_keeps_momentum),
      cmocka_unit_test(inner_forces_keep_momentum),
      cmocka_unit_test(still_pool_stays_still),
      cmocka_unit_test(water_does_not_stack_on_the_floor),
      cmocka_unit_test(dam_break),
      cmocka_unit_test(nothing_escapes_at_speed),
      cmocka_unit_test(obstacles_keep_water_out),
      cmocka_unit_test(substeps_follow_the_limits),
      cmocka_unit_test(the_parameters_do_not_depend_on_scale),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
