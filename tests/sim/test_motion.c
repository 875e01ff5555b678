// Obstacles that a script or a hand moves: where they are, how fast, and what cannot be asked for.
#include "sim_test.h"

#define PI 3.14159265358979323846

static const float wide[3] = {4, 2, 2};

// A world without water and without gravity: substeps of 1/60 s unless a body asks for shorter ones.
static SimWorld *world_of(const SimObstacleDef *obstacle) {
  SimBlockDef block;
  SimWorldDef def = test_def(wide, &block, (const float[3]){1, 1, 1});
  def.block_count = 0;
  memset(def.gravity, 0, sizeof def.gravity);
  def.obstacle_count = 1;
  def.obstacles = obstacle;
  return test_create(&def);
}

static void advance(SimWorld *world, double duration) {
  SimError error;
  if (!sim_world_advance(world, duration, &error)) fail_msg("%s", error.message);
}

static SimObstacle obstacle_now(SimWorld *world) {
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  SimObstacle obstacle = test_frame(world, 0, buffer)->obstacles[0];
  sim_frame_buffer_destroy(buffer);
  return obstacle;
}

static void assert_position(SimWorld *world, double x, double y, double z) {
  SimObstacle now = obstacle_now(world);
  const double expected[3] = {x, y, z};
  for (int k = 0; k < 3; k++)
    if (fabs((double)now.position[k] - expected[k]) > 1e-6)
      fail_msg("axis %d: at %.8g, expected %.8g", k, (double)now.position[k], expected[k]);
}

static void assert_angle_about_y(SimWorld *world, double angle) {
  const float *q = obstacle_now(world).rotation;
  const double expected[4] = {0, sin(angle / 2), 0, cos(angle / 2)};
  for (int k = 0; k < 4; k++)
    if (fabs((double)q[k] - expected[k]) > 1e-6) fail_msg("rotation %d: %.8g, not %.8g", k, (double)q[k], expected[k]);
}

static const float half_root = 0.70710678f;
static const SimPoseKey quarter_turn[3] = {{0.25, {1, 1, 1}, {0, 0, 0, 1}},
                                           {0.75, {2, 1, 1}, {0, 0.70710678f, 0, 0.70710678f}},
                                           {1.25, {1, 1, 1}, {0, 0, 0, 2}}}; // need not be normalised

static SimObstacleDef scripted(bool repeat) {
  SimObstacleDef def = sim_default_obstacle_def();
  for (int k = 0; k < 3; k++) def.body.size[k] = 0.1f;
  def.motion = SIM_SCRIPTED;
  def.key_count = 3;
  def.keys = quarter_turn;
  def.repeat = repeat;
  return def;
}

// Before the first key the pose is the first one's, between keys the way is even, half-way through a quarter turn it is 45°.
static void keys_are_followed(void **state) {
  (void)state;
  SimObstacleDef def = scripted(false);
  SimWorld *world = world_of(&def);
  assert_position(world, 1, 1, 1);
  advance(world, 0.125);
  assert_position(world, 1, 1, 1);
  advance(world, 0.25); // 0.375: a quarter of the way
  assert_position(world, 1.25, 1, 1);
  assert_angle_about_y(world, PI / 8);
  advance(world, 0.125);
  assert_position(world, 1.5, 1, 1);
  assert_angle_about_y(world, PI / 4);
  advance(world, 0.25);
  assert_angle_about_y(world, PI / 2);
  advance(world, 2); // long after the last key
  assert_position(world, 1, 1, 1);
  assert_angle_about_y(world, 0);
  sim_world_destroy(world);
}

// With repeat the keys' second, 0.25 … 1.25, comes again and again.
static void keys_repeat(void **state) {
  (void)state;
  SimObstacleDef def = scripted(true);
  SimWorld *world = world_of(&def);
  advance(world, 1.5); // 1.5 = 0.5 of the first round
  assert_position(world, 1.5, 1, 1);
  advance(world, 3.25); // 4.75 = 0.75
  assert_position(world, 2, 1, 1);
  assert_angle_about_y(world, PI / 2);
  sim_world_destroy(world);
}

// The paddle of 0.4 m and 2 s, from t = 0.5: at rest before, half-way after a quarter, turning after a half.
static void stroke_is_a_cosine(void **state) {
  (void)state;
  SimObstacleDef def = sim_default_obstacle_def();
  def.motion = SIM_SCRIPTED;
  def.body.size[0] = def.body.size[1] = def.body.size[2] = 0.1f;
  def.body.position[0] = def.body.position[1] = def.body.position[2] = 1;
  def.stroke[0] = 0.4f;
  def.stroke[2] = -0.2f;
  def.period = 2;
  def.start = 0.5;
  SimWorld *world = world_of(&def);
  const double ends[5] = {0.5, 1, 1.5, 1.75, 2.5}, share[5] = {0, 0.5, 1, 0.5 * (1 + sqrt(0.5)), 0};
  double time = 0;
  for (int k = 0; k < 5; k++) {
    advance(world, ends[k] - time);
    time = ends[k];
    assert_position(world, 1 + 0.4 * share[k], 1, 1 - 0.2 * share[k]);
  }
  sim_world_destroy(world);
}

// Poses belong to a time, not to a number of steps: 1 × 1/4 s, 16 × 1/64 s and any substeps give the same bytes.
static void steps_do_not_matter(void **state) {
  (void)state;
  SimObstacleDef def = scripted(true);
  def.stroke[1] = 0.3f;
  def.period = 0.7f;
  SimWorld *coarse = world_of(&def), *fine = world_of(&def);
  for (int round = 0; round < 5; round++) {
    advance(coarse, 0.25);
    for (int k = 0; k < 16; k++) advance(fine, 1.0 / 64);
    SimObstacle a = obstacle_now(coarse), b = obstacle_now(fine);
    assert_memory_equal(a.position, b.position, sizeof a.position);
    assert_memory_equal(a.rotation, b.rotation, sizeof a.rotation);
  }
  assert_true(sim_world_counts(fine).substeps > sim_world_counts(coarse).substeps);
  sim_world_destroy(coarse);
  sim_world_destroy(fine);
}

// Substeps from 0.1 to 0.2 s; those before start short.
static int64_t substeps_in_a_tenth(const SimWorldDef *def) {
  SimWorld *world = test_create(def);
  advance(world, 0.1);
  int64_t before = sim_world_counts(world).substeps;
  advance(world, 0.1);
  int64_t count = sim_world_counts(world).substeps - before;
  sim_world_destroy(world);
  return count;
}

// 4 m/s, spacing 0.05, cfl 0.4: at most 0.02 m a substep, 20 substeps for 0.1 s (6 without the body). A larger cfl stops at
// half a spacing: 16. The spin counts with its farthest corner.
static void substeps_follow_the_body(void **state) {
  (void)state;
  const SimPoseKey keys[2] = {{0, {1, 1, 1}, {0, 0, 0, 1}}, {0.5, {3, 1, 1}, {0, 0, 0, 1}}};
  const SimPoseKey turn[2] = {{0, {1, 1, 1}, {0, 0, 0, 1}}, {0.5, {1, 1, 1}, {0, 0, 1, 0}}};
  SimBlockDef block;
  SimObstacleDef solid = scripted(false);
  solid.key_count = 2;
  solid.keys = keys;
  SimWorldDef def = test_def(wide, &block, (const float[3]){1, 1, 1});
  def.block_count = 0;
  memset(def.gravity, 0, sizeof def.gravity);
  def.obstacle_count = 1;
  def.obstacles = &solid;
  const float cfl[3] = {0.4f, 2, 0.4f};
  // Half a turn in 0.5 s at a corner √3 · 0.05 from the centre: 0.544 m/s, 0.0544 m in 0.1 s. More than 6 substeps need
  // would be wrong too.
  const int64_t expected[3] = {20, 16, 6};
  for (int k = 0; k < 3; k++) {
    def.cfl = cfl[k];
    if (k == 2) solid.keys = turn;
    assert_int_equal(substeps_in_a_tenth(&def), expected[k]);
  }
  solid.body.size[0] = 4; // corner at 2 m: 12.57 m/s, 63 substeps
  assert_int_equal(substeps_in_a_tenth(&def), 63);
}

static SimObstacleDef draggable(float max_speed) {
  SimObstacleDef def = sim_default_obstacle_def();
  def.motion = SIM_DRAGGABLE;
  def.max_speed = max_speed;
  for (int k = 0; k < 3; k++) def.body.size[k] = 0.2f, def.body.position[k] = 1;
  return def;
}

// Straight to the target at max_speed, then still, exactly there.
static void dragging_keeps_its_speed(void **state) {
  (void)state;
  SimObstacleDef def = draggable(2);
  SimWorld *world = world_of(&def);
  const float target[3] = {2, 1.5f, 1};
  assert_true(sim_world_drag(world, 0, target, NULL));
  double length = sqrt(1.25), way = 0;
  for (int f = 0; f < 40; f++) {
    advance(world, 1.0 / 64);
    way = fmin(length, way + 2.0 / 64);
    assert_position(world, 1 + way / length, 1 + 0.5 * way / length, 1);
  }
  assert_memory_equal(obstacle_now(world).position, target, sizeof target);
  assert_angle_about_y(world, 0);
  sim_world_destroy(world);
}

static int64_t substeps_of(SimWorld *world, double duration) {
  int64_t before = sim_world_counts(world).substeps;
  advance(world, duration);
  return sim_world_counts(world).substeps - before;
}

// At 12.8 m/s it asks for eight substeps of half a spacing in 1/64 s; with its target reached, for none (those left grow by a half).
static void dragging_asks_for_substeps(void **state) {
  (void)state;
  SimObstacleDef def = draggable(12.8f);
  SimWorld *world = world_of(&def);
  advance(world, 1.0 / 8);
  const float target[3] = {2, 1, 1};
  assert_true(sim_world_drag(world, 0, target, NULL));
  for (int f = 0; f < 4; f++) assert_int_equal(substeps_of(world, 1.0 / 64), 8);
  advance(world, 1.0 / 8);
  assert_memory_equal(obstacle_now(world).position, target, sizeof target);
  assert_true(substeps_of(world, 1.0 / 64) <= 2);
  sim_world_destroy(world);
}

static void corner_of(const SimObstacle *o, const float local[3], double corner[3]) {
  const float *q = o->rotation;
  double t[3];
  for (int k = 0; k < 3; k++) {
    int a = (k + 1) % 3, b = (k + 2) % 3;
    t[k] = 2 * ((double)q[a] * (double)local[b] - (double)q[b] * (double)local[a]);
  }
  for (int k = 0; k < 3; k++) {
    int a = (k + 1) % 3, b = (k + 2) % 3;
    corner[k] =
        (double)o->position[k] + (double)local[k] + (double)q[3] * t[k] + (double)q[a] * t[b] - (double)q[b] * t[a];
  }
}

// While it turns and moves, no corner is faster than max_speed, and some corner is nearly that fast.
static void dragging_bounds_the_corners(void **state) {
  (void)state;
  SimObstacleDef def = draggable(1);
  def.body.size[0] = 1.5f;
  SimWorld *world = world_of(&def);
  const float target[3] = {1.3f, 0.9f, 1.2f}, turned[4] = {0, half_root, half_root, 0};
  assert_true(sim_world_drag(world, 0, target, turned));
  double fastest = 0;
  for (int f = 0; f < 300; f++) {
    SimObstacle a = obstacle_now(world);
    advance(world, 1.0 / 64);
    SimObstacle b = obstacle_now(world);
    for (int c = 0; c < 8; c++) {
      const float local[3] = {c & 1 ? 0.75f : -0.75f, c & 2 ? 0.1f : -0.1f, c & 4 ? 0.1f : -0.1f};
      double from[3], to[3], d2 = 0;
      corner_of(&a, local, from);
      corner_of(&b, local, to);
      for (int k = 0; k < 3; k++) d2 += (to[k] - from[k]) * (to[k] - from[k]);
      fastest = fmax(fastest, sqrt(d2) * 64);
    }
  }
  if (fastest > 1.0001 || fastest < 0.7) fail_msg("fastest corner %g m/s", fastest);
  const float *q = obstacle_now(world).rotation;
  for (int k = 0; k < 4; k++) assert_true(fabsf(q[k] - turned[k]) < 1e-6f);
  sim_world_destroy(world);
}

// A target outside is moved to the container's nearest point; wrong ones are refused and change nothing.
static void targets_are_checked(void **state) {
  (void)state;
  SimObstacleDef def = draggable(100);
  SimWorld *world = world_of(&def);
  const float outside[3] = {-3, 9, 1.5f}, bad[3] = {1, NAN, 1}, good[3] = {1, 1, 1}, zero[4] = {0, 0, 0, 0},
              infinite[4] = {0, 0, 0, INFINITY};
  assert_true(sim_world_drag(world, 0, outside, NULL));
  assert_false(sim_world_drag(world, 1, good, NULL));
  assert_false(sim_world_drag(world, -1, good, NULL));
  assert_false(sim_world_drag(world, 0, bad, NULL));
  assert_false(sim_world_drag(world, 0, good, zero));
  assert_false(sim_world_drag(world, 0, good, infinite));
  advance(world, 0.5);
  assert_position(world, 0, 2, 1.5);
  sim_world_reset(world);
  assert_position(world, 1, 1, 1);
  advance(world, 0.1);
  assert_position(world, 1, 1, 1);
  sim_world_destroy(world);
  def.motion = SIM_STATIC;
  world = world_of(&def);
  assert_false(sim_world_drag(world, 0, good, NULL));
  sim_world_destroy(world);
}

// A gate as wide and high as the channel sweeps the water before it: nothing passes through or around.
static void paddle_sweeps_all_water(void **state) {
  (void)state;
  SimBlockDef block;
  const SimPoseKey keys[2] = {{0, {0.15f, 0.5f, 0.15f}, {0, 0, 0, 1}}, {0.4, {0.75f, 0.5f, 0.15f}, {0, 0, 0, 1}}};
  SimObstacleDef gate = scripted(false);
  gate.key_count = 2;
  gate.keys = keys;
  gate.body.size[0] = 0.1f;
  gate.body.size[1] = gate.body.size[2] = 2;
  SimWorldDef def = test_def((const float[3]){1.6f, 1, 0.3f}, &block, (const float[3]){1.6f, 0.3f, 0.3f});
  block.min[0] = 0.2f;
  def.obstacle_count = 1;
  def.obstacles = &gate;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  for (int f = 0; f < 45; f++) {
    test_advance(world, 1);
    const SimFrame *frame = test_frame(world, 0, buffer);
    float face = frame->obstacles[0].position[0] + 0.05f;
    for (int32_t i = 0; i < frame->count; i++)
      if (frame->position[3 * i] < face - 0.005f)
        fail_msg("frame %d: particle %u at %g behind the gate's face at %g", f, frame->id[i],
                 (double)frame->position[3 * i], (double)face);
  }
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

static void refused(SimObstacleDef def, const char *expected) {
  SimWorldDef world = sim_default_world_def();
  SimError error = {""};
  SimObstacleDef two[2] = {sim_default_obstacle_def(), def};
  world.obstacle_count = 2;
  world.obstacles = two;
  assert_null(sim_world_create(&world, &error));
  if (!strstr(error.message, expected)) fail_msg("'%s' does not name '%s'", error.message, expected);
}

// A plate closes in on a wall until it touches it. The water in front of it goes over its top; what is left has less room than a
// spacing, and must not be driven out with a speed without bound.
static void water_is_squeezed_out_gently(void **state) {
  (void)state;
  SimBlockDef block;
  SimObstacleDef plate = sim_default_obstacle_def();
  const SimPoseKey keys[2] = {{0.2, {0.35f, 0.25f, 0.12f}, {0, 0, 0, 1}}, {1.2, {0.04f, 0.25f, 0.12f}, {0, 0, 0, 1}}};
  plate.body = (SimObstacle){
      .shape = SIM_BOX, .size = {0.08f, 0.5f, 0.3f}, .position = {0.35f, 0.25f, 0.12f}, .rotation = {0, 0, 0, 1}};
  plate.motion = SIM_SCRIPTED;
  plate.key_count = 2;
  plate.keys = keys;
  SimWorldDef def = test_def((const float[3]){1, 1.2f, 0.24f}, &block, (const float[3]){0.3f, 0.4f, 0.24f});
  def.particle_radius = 0.02f;
  def.obstacles = &plate;
  def.obstacle_count = 1;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  double fastest = 0;
  for (int f = 0; f < 90; f++) {
    advance(world, 1.0 / 60);
    const SimFrame *frame = test_frame(world, 0, buffer);
    test_inside_container(frame);
    // Until no particle has room any more. Then it is either in the wall or in the plate.
    if (obstacle_now(world).position[0] - 0.04f > 0.04f) test_outside_obstacles(frame);
    fastest = fmax(fastest, sim_world_measures(world).max_speed);
  }
  print_message("squeezed out with %.1f m/s at most\n", fastest);
  if (fastest > 60) fail_msg("squeezed out with %g m/s", fastest);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

static void impossible_motions_are_named(void **state) {
  (void)state;
  SimObstacleDef def = sim_default_obstacle_def();
  def.friction = 1.5f;
  refused(def, "obstacles[1].friction must be in [0, 1], got 1.5");
  def.friction = NAN;
  refused(def, "obstacles[1].friction");
  def = sim_default_obstacle_def();
  def.motion = (SimMotion)7;
  refused(def, "obstacles[1].motion: unknown motion 7");
  def.motion = SIM_DRAGGABLE;
  def.max_speed = 0;
  refused(def, "obstacles[1].max_speed must be in (0, 1000], got 0");
  def.motion = SIM_FLOATING;
  def.density = -1;
  refused(def, "obstacles[1].density must be in (0, 1e+06], got -1");
  def = scripted(true);
  def.key_count = -1;
  refused(def, "obstacles[1].key_count");
  def.key_count = 2;
  refused(def, "obstacles[1].repeat: the last key must have the pose of the first");
  def.key_count = 1;
  refused(def, "obstacles[1].repeat needs two keys");
  def.keys = NULL;
  refused(def, "obstacles[1].keys are missing");
  def = scripted(false);
  SimPoseKey keys[2] = {quarter_turn[0], quarter_turn[0]};
  def.keys = keys;
  def.key_count = 2;
  refused(def, "obstacles[1].keys[1].time must be later than 0.25 s, got 0.25");
  keys[1].time = 0.2501;
  keys[1].position[0] = 1.5f;
  refused(def, "obstacles[1].keys[1]: its speed");
  keys[1].position[0] = INFINITY;
  refused(def, "obstacles[1].keys[1].position");
  def = scripted(false);
  def.stroke[1] = 1;
  def.period = 0;
  refused(def, "obstacles[1].period must be in (0, 1e+06], got 0");
  def.start = NAN;
  refused(def, "obstacles[1].start");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(keys_are_followed),           cmocka_unit_test(keys_repeat),
      cmocka_unit_test(stroke_is_a_cosine),          cmocka_unit_test(steps_do_not_matter),
      cmocka_unit_test(substeps_follow_the_body),    cmocka_unit_test(dragging_keeps_its_speed),
      cmocka_unit_test(dragging_asks_for_substeps),  cmocka_unit_test(dragging_bounds_the_corners),
      cmocka_unit_test(targets_are_checked),         cmocka_unit_test(paddle_sweeps_all_water),
      cmocka_unit_test(water_is_squeezed_out_gently), cmocka_unit_test(impossible_motions_are_named)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
