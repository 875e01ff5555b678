// Bodies in water for long: they float as deep as their density says, or sink, fall from high up, and paddles make waves.
#include "sim_test.h"

static SimBlockDef block;

typedef struct Rest {
  double draught; ///< of a body of equal horizontal cross-sections, in heights
  double speed;   ///< m/s, largest of the body in the last second
  double height;  ///< m, mean of its centre
  double water;   ///< m³
} Rest;

// A body of `size` is put into a pool of 1.2 × 1.2 m, 0.5 m deep. Its draught in the mean of the last second follows from the
// volumes of water and body, since the pool is a box: with A_b the body's cross-section and d its draught,
// level = (V + A_b d)/A and d = level − (y − h/2).
static Rest float_body_in(SimSolver solver, SimShape shape, float size, float density, float y, const float rotation[4], int frames) {
  SimObstacleDef body = sim_default_obstacle_def();
  body.motion = SIM_FLOATING;
  body.density = density;
  body.body.shape = shape;
  for (int k = 0; k < 3; k++) body.body.size[k] = size;
  body.body.position[0] = body.body.position[2] = 0.6f;
  body.body.position[1] = y;
  memcpy(body.body.rotation, rotation, sizeof body.body.rotation);
  SimWorldDef def = test_def((const float[3]){1.2f, 1.5f, 1.2f}, &block, (const float[3]){1.2f, 0.5f, 1.2f});
  def.obstacles = &body;
  def.obstacle_count = 1;
  def.solver = solver;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  double volume = sim_world_counts(world).particles * pow(0.05, 3), mean = 0, speed = 0;
  double mass = (double)density * pow((double)size, 3);
  for (int f = 0; f < frames; f++) {
    test_advance(world, 1);
    const SimFrame *frame = test_frame(world, 0, buffer);
    test_inside_container(frame);
    test_outside_obstacles(frame);
    if (f < frames - 60) continue;
    mean += (double)frame->obstacles[0].position[1] / 60;
    speed = fmax(speed, fabs(sim_world_measures(world).body_momentum[1]) / mass);
  }
  double h = (double)size, base = h * h, area = 1.44, bottom = mean - h / 2;
  double level = (volume - base * bottom) / (area - base);
  print_message("density %g: centre %.4f, draught %.3f, speed %.3f m/s\n", (double)density, mean, (level - bottom) / h,
                speed);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
  return (Rest){(level - bottom) / h, speed, mean, volume};
}

static Rest float_body(SimShape shape, float size, float density, float y, const float rotation[4], int frames) {
  return float_body_in(SIM_SOLVER_PBF, shape, size, density, y, rotation, frames);
}

static const float upright[4] = {0, 0, 0, 1};

static void half_density_floats_half_deep_in_sph(void **state) {
  (void)state;
  Rest rest = float_body_in(SIM_SOLVER_SPH, SIM_BOX, 0.4f, 500, 0.45f, upright, 240);
  if (fabs(rest.draught - 0.5) > 0.05) fail_msg("draught %g", rest.draught);
}

static void half_density_floats_half_deep(void **state) {
  (void)state;
  Rest rest = float_body(SIM_BOX, 0.4f, 500, 0.45f, upright, 240);
  if (fabs(rest.draught - 0.5) > 0.05) fail_msg("draught %g", rest.draught);
}

// A cube is the same from below and from above: however it is turned, half of it is below the level of its centre.
static void half_density_floats_tilted(void **state) {
  (void)state;
  const float tilted[4] = {0.25f, 0.1f, 0.3f, 0.9f};
  Rest rest = float_body(SIM_BOX, 0.4f, 500, 0.55f, tilted, 240);
  double level = (rest.water + 0.5 * 0.064) / 1.44;
  if (fabs(rest.height - level) > 0.04) fail_msg("centre at %g, level %g", rest.height, level);
}

static void light_body_is_stable(void **state) {
  (void)state;
  Rest rest = float_body(SIM_BOX, 0.4f, 100, 0.75f, upright, 240);
  if (fabs(rest.draught - 0.1) > 0.03) fail_msg("draught %g", rest.draught);
  if (rest.speed > 0.1) fail_msg("it still moves at %g m/s", rest.speed);
}

// Foam, held deep under water and let go: it shoots up and comes to rest.
static void foam_rises_from_the_deep(void **state) {
  (void)state;
  Rest rest = float_body(SIM_BOX, 0.3f, 40, 0.2f, upright, 360);
  if (fabs(rest.draught - 0.04) > 0.05) fail_msg("draught %g", rest.draught);
  if (rest.speed > 0.2) fail_msg("it still moves at %g m/s", rest.speed);
}

static void heavy_body_sinks(void **state) {
  (void)state;
  Rest rest = float_body(SIM_BOX, 0.4f, 2000, 0.45f, upright, 240);
  if (rest.height > 0.2 + 0.03) fail_msg("its centre is %g m above the floor", rest.height);
}

// Turned by nearly half a right angle and let go: it rocks, comes to rest, and is still there after half a minute.
static void pushed_off_balance_it_comes_to_rest(void **state) {
  (void)state;
  const float off[4] = {0, 0, 0.34f, 0.94f}; // 40° about z
  Rest rest = float_body(SIM_BOX, 0.4f, 500, 0.5f, off, 1800);
  double level = (rest.water + 0.5 * 0.064) / 1.44;
  if (fabs(rest.height - level) > 0.04) fail_msg("centre at %g, level %g", rest.height, level);
  if (rest.speed > 0.02) fail_msg("it still moves at %g m/s", rest.speed);
}

static double energy(SimWorld *world) {
  SimMeasures m = sim_world_measures(world);
  return m.kinetic_energy + m.potential_energy + m.body_energy;
}

// A block falls 2.5 m onto water: nothing leaves the tank or enters the block, no energy appears, and in the end it floats.
static void a_block_falls_from_high_up(void **state) {
  (void)state;
  SimObstacleDef body = sim_default_obstacle_def();
  body.motion = SIM_FLOATING;
  body.density = 600;
  for (int k = 0; k < 3; k++) body.body.size[k] = 0.3f, body.body.position[k] = 0.6f;
  body.body.position[1] = 3;
  SimWorldDef def = test_def((const float[3]){1.2f, 4, 1.2f}, &block, (const float[3]){1.2f, 0.5f, 1.2f});
  def.obstacles = &body;
  def.obstacle_count = 1;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  int32_t count = sim_world_counts(world).particles;
  double start = energy(world), most = 0, fastest = 0, highest = 0, height = 0;
  for (int f = 0; f < 480; f++) {
    test_advance(world, 1);
    const SimFrame *frame = test_frame(world, 0, buffer);
    test_inside_container(frame);
    test_outside_obstacles(frame);
    assert_int_equal(frame->count, count);
    for (int32_t i = 0; i < count; i++) highest = fmax(highest, (double)frame->position[3 * i + 1]);
    most = fmax(most, energy(world));
    fastest = fmax(fastest, sim_world_measures(world).max_speed);
    if (f >= 420) height += (double)frame->obstacles[0].position[1] / 60;
  }
  // Its draught is 0.6 of 0.3 m, the level 0.5 m and what it displaces.
  double level = count * pow(0.05, 3) / 1.44 + 0.6 * 0.027 / 1.44, centre = level - 0.18 + 0.15;
  print_message(
      "energy %.1f J at the start, %.1f J at most; fastest %.2f m/s, highest %.2f m; floats at %.3f m, not %.3f m\n",
      start, most, fastest, highest, height, centre);
  if (most > 1.001 * start) fail_msg("energy grows from %g to %g J", start, most);
  if (fabs(height - centre) > 0.1 * 0.18) fail_msg("it floats at %g m instead of %g m", height, centre);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

// A paddle as wide as the pool, 0.3 m deep, 1 s a stroke of 0.06 m. Piston theory (Dean & Dalrymple, Water Wave Mechanics for
// Engineers and Scientists, 1991, Eq. 6.25): wave height over stroke is 2 (cosh 2kh − 1)/(sinh 2kh + 2kh), beyond the local
// disturbance (e^−3 at 0.35 m); farther away the wave has lost height.
// The height of the waves' first harmonic 0.4 m from a paddle against the linear theory of wavemakers, ω² = g k tanh kh.
static void a_paddle_makes_waves(void **state) {
  (void)state;
  SimObstacleDef paddle = sim_default_obstacle_def();
  paddle.motion = SIM_SCRIPTED;
  const float size[3] = {0.12f, 0.9f, 0.2f}, place[3] = {0.06f, 0.45f, 0.08f};
  for (int k = 0; k < 3; k++) paddle.body.size[k] = size[k], paddle.body.position[k] = place[k];
  paddle.stroke[0] = 0.06f;
  paddle.period = 1;
  SimWorldDef def = test_def((const float[3]){5.12f, 0.9f, 0.16f}, &block, (const float[3]){5.12f, 0.3f, 0.16f});
  def.particle_radius = 0.01f;
  def.threads = 2;
  block.min[0] = 0.12f;
  def.obstacles = &paddle;
  def.obstacle_count = 1;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  double in_phase = 0, out_of_phase = 0;
  for (int f = 0; f < 240; f++) { // until waves come back from the far end
    test_advance(world, 1);
    const SimFrame *frame = test_frame(world, 0, buffer);
    test_inside_container(frame);
    test_outside_obstacles(frame);
    if (f < 120) continue;
    double volume = 0;
    for (int32_t i = 0; i < frame->count; i++)
      volume += fabsf(frame->position[3 * i] - 0.5f) < 0.06f ? pow(0.02, 3) : 0;
    in_phase += volume / (0.12 * 0.16) * cos(2 * 3.14159265 * f / 60) / 60;
    out_of_phase += volume / (0.12 * 0.16) * sin(2 * 3.14159265 * f / 60) / 60;
  }
  double k = 4.024, h = 0.3, height = 2 * hypot(in_phase, out_of_phase);
  for (int n = 0; n < 50; n++) k = 0.5 * (k + 4 * 9.8696 / 9.81 / tanh(k * h));
  double theory = 0.06 * 2 * (cosh(2 * k * h) - 1) / (sinh(2 * k * h) + 2 * k * h);
  print_message("wave of %.4f m, theory %.4f m\n", height, theory);
  if (fabs(height - theory) > 0.15 * theory) fail_msg("wave of %g m, theory %g m", height, theory);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(half_density_floats_half_deep_in_sph), cmocka_unit_test(half_density_floats_half_deep),
                                     cmocka_unit_test(half_density_floats_tilted),
                                     cmocka_unit_test(light_body_is_stable),
                                     cmocka_unit_test(foam_rises_from_the_deep),
                                     cmocka_unit_test(heavy_body_sinks),
                                     cmocka_unit_test(pushed_off_balance_it_comes_to_rest),
                                     cmocka_unit_test(a_block_falls_from_high_up),
                                     cmocka_unit_test(a_paddle_makes_waves)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
