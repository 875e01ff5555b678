// Friction of walls: what it takes, exactly; zero is free slip; water on a slope.
#include "sim_test.h"

#include "sim/world.h"

static SimBlockDef block;

// A sheet of water, three spacings deep, in a long shallow box that is tilted: gravity has a part along x.
static SimWorldDef sheet_def(float friction, float d) {
  SimWorldDef def = test_def((const float[3]){200 * d, 20 * d, 8 * d}, &block, (const float[3]){20 * d, 3 * d, 8 * d});
  def.particle_radius = d / 2;
  def.container_friction = friction;
  def.viscosity = 0;
  def.kinematic_viscosity = 0;
  return def;
}

static double mean_speed(const SimWorld *world, bool lowest) {
  double sum = 0;
  int count = 0;
  for (int32_t i = 0; i < world->particles.count; i++) {
    if (lowest && world->particles.now.position[1][i] > world->cubic.spacing) continue;
    sum += (double)world->particles.now.velocity[0][i];
    count++;
  }
  return sum / count;
}

// One substep on water at rest with 2 m/s along the floor: u/(1 − ln(1 − f) u dt/d) beside the floor, untouched elsewhere.
static void it_takes_what_it_says(void **state) {
  (void)state;
  const float frictions[3] = {0, 0.3f, 1};
  for (int f = 0; f < 3; f++) {
    SimWorldDef def = sheet_def(frictions[f], 0.02f);
    block.min[0] += 0.2f, block.max[0] += 0.2f, block.min[2] += 0.04f, block.max[2] -= 0.04f;
    SimWorld *world = test_create(&def);
    SimParticles *p = &world->particles;
    for (int32_t i = 0; i < p->count; i++) {
      p->now.next_velocity[0][i] = 2;
      p->now.next_velocity[1][i] = -0.5f;
      p->now.next_velocity[2][i] = 0;
    }
    SimStep step = sim_step_make(world, 0.001f);
    sim_step_friction(&step);
    double left = f == 2 ? 0 : 2 / (1 - log(1 - (double)frictions[f]) * 2 * 0.001 / 0.02);
    for (int32_t i = 0; i < p->count; i++) {
      double expected = p->now.position[1][i] < 0.02f ? left : 2;
      if (fabs((double)p->now.next_velocity[0][i] - expected) > 1e-4)
        fail_msg("friction %g: %g, expected %g", (double)frictions[f], (double)p->now.next_velocity[0][i], expected);
      assert_true(fabsf(p->now.next_velocity[1][i] + 0.5f) <
                  1e-6f); // towards the wall and away from it nothing changes
    }
    sim_world_destroy(world);
  }
}

// Down a slope of one in five: without friction all of it gains g sin t, as on ice; the more friction, the slower; with 1 the
// lowest layer stays where it is. The same for half the particle size in scaled time.
static void water_on_a_slope(void **state) {
  (void)state;
  for (int solver = 0; solver < 2; solver++) {
    const float frictions[4] = {0, 0.1f, 0.5f, 1};
    double speed[4], lowest[4], time = 0.2;
    for (int f = 0; f < 4; f++) {
      SimWorldDef def = sheet_def(frictions[f], 0.02f);
      def.solver = (SimSolver)solver;
      block.min[0] += 0.2f, block.max[0] += 0.2f;
      def.gravity[0] = 9.81f * 0.2f;
      SimWorld *world = test_create(&def);
      SimError error = {""};
      for (int k = 0; k < 10; k++)
        if (!sim_world_advance(world, time / 10, &error)) fail_msg("%s", error.message);
      speed[f] = mean_speed(world, false), lowest[f] = mean_speed(world, true);
      sim_world_destroy(world);
    }
    print_message("solver %d, speed down a slope: free %.3f, 0.1 %.3f, 0.5 %.3f, 1 %.3f (lowest layer %.3f)\n", solver,
                  speed[0], speed[1], speed[2], speed[3], lowest[3]);
    assert_true(fabs(speed[0] / (9.81 * 0.2 * time) - 1) < 0.001);
    assert_true(speed[1] < 0.98 * speed[0] && speed[2] < speed[1] && speed[3] < speed[2]);
    assert_true(fabs(lowest[3]) < 0.15 * speed[0]);
  }
}

// Half the substep or half the size changes little: the way along the wall counts.
static void substeps_and_size_do_not_matter(void **state) {
  (void)state;
  double speed[3];
  for (int k = 0; k < 3; k++) {
    float d = k == 2 ? 0.01f : 0.02f;
    SimWorldDef def = sheet_def(0.2f, d);
    block.velocity[0] = 5 * sqrtf(9.81f * d);
    block.min[0] += 10 * d, block.max[0] += 10 * d;
    def.time_step = (k == 1 ? 0.02f : 0.04f) * sqrtf(d / 9.81f);
    SimWorld *world = test_create(&def);
    SimError error = {""};
    for (int f = 0; f < 2; f++)
      if (!sim_world_advance(world, (double)sqrtf(d / 9.81f), &error)) fail_msg("%s", error.message);
    speed[k] = mean_speed(world, false) / (double)sqrtf(9.81f * d);
    sim_world_destroy(world);
  }
  print_message("speed after ten spacings: %.3f, half the substep %.3f, half the size %.3f of 5\n", speed[0], speed[1],
                speed[2]);
  assert_true(speed[0] < 4.8 && fabs(speed[1] / speed[0] - 1) < 0.03 && fabs(speed[2] / speed[0] - 1) < 0.03);
}

// An obstacle's own friction, and a wall that moves takes the water along.
static void a_moving_obstacle_takes_water_along(void **state) {
  (void)state;
  SimWorldDef def = sheet_def(0, 0.02f);
  SimObstacleDef plate = sim_default_obstacle_def();
  plate.body = (SimObstacle){
      .shape = SIM_BOX, .size = {3, 0.1f, 0.1f}, .position = {1.5f, 0.11f, 0.08f}, .rotation = {0, 0, 0, 1}};
  plate.friction = 0.5f;
  def.obstacle_count = 1;
  def.obstacles = &plate;
  SimWorld *world = test_create(&def);
  world->bodies[0].velocity[0] = 1;
  world->bodies[0].moves = true;
  SimParticles *p = &world->particles;
  for (int32_t i = 0; i < p->count; i++)
    for (int k = 0; k < 3; k++) p->now.next_velocity[k][i] = 0;
  SimStep step = sim_step_make(world, 0.01f);
  sim_step_friction(&step);
  double sum = 0;
  for (int32_t i = 0; i < p->count; i++) {
    float v = p->now.next_velocity[0][i];
    assert_true(v >= 0 && v < 1);
    if (p->now.position[1][i] < 0.045f) assert_true(v == 0);
    sum += (double)v;
  }
  assert_true(sum > 1);
  sim_world_destroy(world);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(it_takes_what_it_says),
      cmocka_unit_test(water_on_a_slope),
      cmocka_unit_test(substeps_and_size_do_not_matter),
      cmocka_unit_test(a_moving_obstacle_takes_water_along),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
