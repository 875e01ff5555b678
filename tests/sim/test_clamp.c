// What the clamp keeps out of every shape and both containers, what is near, what may start where, and water among bodies.
#include "zoo.h"

// ---- The clamp -------------------------------------------------------------------------------------------------------

static void must_be_outside(const SimBoundary *boundary, const float point[3], int which, const char *what) {
  const float slack = 1e-5f;
  for (int k = 0; k < 3; k++) assert_true(point[k] >= -slack && point[k] <= 1 + slack);
  if (boundary->container.shape == SIM_CONTAINER_GLASS)
    assert_true(hypotf(point[0] - 0.5f, point[2] - 0.5f) <= 0.5f + slack);
  for (int32_t b = 0; b < boundary->body_count; b++) {
    float normal[3], gap = sim_body_distance(&boundary->bodies[b], point, normal);
    if (gap < -0.02f * SPACING) fail_msg("%s: shape %d: %.4f spacings inside", what, which, (double)(-gap / SPACING));
  }
}

static bool random_free(const SimBoundary *boundary, uint64_t *seed, float point[3]) {
  for (int n = 0; n < 1000; n++) {
    zoo_random_point(seed, point);
    if (sim_boundary_free(boundary, point)) return true;
  }
  return false;
}

// Moves up to ten spacings long, also far out of the container, past every shape in every pose.
static void moves_end_outside_of_resting_bodies(void **state) {
  (void)state;
  Zoo zoo = zoo_make();
  uint64_t seed = 9;
  for (int which = 0; which < ZOO; which++) {
    SimBody bodies[2] = {zoo_body(&zoo, which), zoo_body(&zoo, (which + 1) % ZOO)};
    bodies[0].position[0] = 0.3f, bodies[1].position[0] = 0.7f;
    for (int pose = 0; pose < 12; pose++) {
      for (int b = 0; b < 2; b++) zoo_turn(&bodies[b], &seed, 2);
      SimBoundary boundary = zoo_tank(&zoo, pose % 2 ? SIM_CONTAINER_GLASS : SIM_CONTAINER_BOX, bodies, 2);
      for (int n = 0; n < 150; n++) {
        float from[3], to[3], reach = n % 3 == 0 ? 2 : n % 3 == 1 ? 10 * SPACING : 2 * SPACING;
        if (!random_free(&boundary, &seed, from)) continue;
        for (int k = 0; k < 3; k++) to[k] = from[k] + reach * (float)(2 * test_random(&seed) - 1);
        assert_int_equal(sim_boundary_clamp(&boundary, NULL, from, to), -1);
        must_be_outside(&boundary, to, which, "at rest");
      }
    }
  }
  zoo_free(&zoo);
}

// The sides of a thin wall, told by a particle's place in the wall's own axes.
static float above(const SimBody *body, const float position[3], const float rotation[9], const float point[3]) {
  const float d[3] = {point[0] - position[0], point[1] - position[1], point[2] - position[2]};
  float local[3];
  (void)body;
  sim_to_local(rotation, d, local);
  return local[1];
}

// Sheets much thinner than a particle, as a box and as a mesh, spun and thrown through the water by several spacings a
// substep, while particles shoot at them: nothing gets to the other side except around the rim.
static void thin_sheets_do_not_leak_when_they_move(void **state) {
  (void)state;
  Zoo zoo = zoo_make();
  uint64_t seed = 10;
  const int kinds[2] = {SHEET, PLATE_MESH};
  for (int n = 0; n < 20000; n++) {
    SimBody sheet = zoo_body(&zoo, kinds[n % 2]);
    for (int k = 0; k < 3; k++) sheet.position[k] = 0.5f;
    SimBoundary boundary = zoo_tank(&zoo, SIM_CONTAINER_BOX, &sheet, 1);
    boundary.container = (SimContainer){{-5, -5, -5}, {5, 5, 5}, SIM_CONTAINER_BOX};
    sheet.moves = sheet.floats = true;
    zoo_turn(&sheet, &seed, 2);
    memcpy(sheet.old_rotation, sheet.rotation, sizeof sheet.rotation);
    memcpy(sheet.old_position, sheet.position, sizeof sheet.position);
    if (n % 3 == 0) zoo_turn(&sheet, &seed, 0.3f);
    for (int k = 0; k < 3; k++) sheet.position[k] += 3 * SPACING * (float)(2 * test_random(&seed) - 1);
    // Near the middle of the sheet, in its old axes, on a known side.
    float local[3], from[3], to[3];
    for (int k = 0; k < 3; k++) local[k] = 0.08f * (float)(2 * test_random(&seed) - 1);
    local[1] = copysignf(0.0225f + fabsf(local[1]), local[1]);
    sim_to_world(sheet.old_rotation, local, from);
    for (int k = 0; k < 3; k++) from[k] += sheet.old_position[k];
    for (int k = 0; k < 3; k++) to[k] = from[k] + 4 * SPACING * (float)(2 * test_random(&seed) - 1);
    sim_boundary_clamp(&boundary, NULL, from, to);
    must_be_outside(&boundary, to, kinds[n % 2], "moving sheet");
    float side = above(&sheet, sheet.position, sheet.rotation, to), end[3], d[3];
    for (int k = 0; k < 3; k++) d[k] = to[k] - sheet.position[k];
    sim_to_local(sheet.rotation, d, end);
    bool beside = fabsf(end[0]) > 0.19f || fabsf(end[2]) > 0.14f;
    if (!beside && side * local[1] <= 0)
      fail_msg("%d: went through the sheet from %g to %g", n, (double)local[1], (double)side);
  }
  zoo_free(&zoo);
}

// Every shape jumps and turns by up to three spacings onto resting and moving particles.
static void moving_bodies_push_particles_ahead(void **state) {
  (void)state;
  Zoo zoo = zoo_make();
  uint64_t seed = 11;
  for (int which = 0; which < ZOO; which++)
    for (int n = 0; n < 3000; n++) {
      SimBody body = zoo_body(&zoo, which);
      for (int k = 0; k < 3; k++) body.position[k] = 0.5f;
      zoo_turn(&body, &seed, 2);
      SimBoundary boundary = zoo_tank(&zoo, n % 2 ? SIM_CONTAINER_GLASS : SIM_CONTAINER_BOX, &body, 1);
      float from[3], to[3];
      if (!random_free(&boundary, &seed, from)) continue;
      body.moves = body.floats = true;
      memcpy(body.old_rotation, body.rotation, sizeof body.rotation);
      memcpy(body.old_position, body.position, sizeof body.position);
      for (int k = 0; k < 3; k++) body.position[k] += 0.15f * (float)(2 * test_random(&seed) - 1);
      for (int k = 0; k < 3; k++) to[k] = from[k] + (n % 4 ? SPACING * (float)(2 * test_random(&seed) - 1) : 0);
      const float wanted[3] = {to[0], to[1], to[2]};
      int32_t say = sim_boundary_clamp(&boundary, NULL, from, to);
      must_be_outside(&boundary, to, which, "moving body");
      float normal[3];
      if (sim_body_distance(&body, wanted, normal) < 0) assert_int_equal(say, 0);
    }
  zoo_free(&zoo);
}

// A paddle comes up to the wall and stops 0.3 spacings before it: the particle between is in neither.
static void a_paddle_leaves_no_particle_in_itself_or_the_wall(void **state) {
  (void)state;
  Zoo zoo = zoo_make();
  SimObstacle obstacle = {
      .shape = SIM_BOX, .size = {0.02f, 0.8f, 0.8f}, .position = {0.5f, 0.5f, 0.5f}, .rotation = {0, 0, 0, 1}};
  SimBody paddle = sim_body_make(&obstacle, NULL);
  SimBoundary boundary = zoo_tank(&zoo, SIM_CONTAINER_BOX, &paddle, 1);
  paddle.moves = true;
  float point[3] = {0.7f, 0.5f, 0.5f}, step = 0.005f;
  for (float x = 0.5f + step; x < 1 - 0.01f - 0.3f * SPACING; x += step) {
    memcpy(paddle.old_position, paddle.position, sizeof paddle.position);
    paddle.position[0] = x;
    float from[3] = {point[0], point[1], point[2]};
    sim_boundary_clamp(&boundary, NULL, from, point);
    must_be_outside(&boundary, point, SIM_BOX, "paddle");
    assert_true(point[0] > x);
  }
  // It closes the gap: there is no place, and the particle stays in the container.
  memcpy(paddle.old_position, paddle.position, sizeof paddle.position);
  paddle.position[0] = 0.991f;
  float from[3] = {point[0], point[1], point[2]};
  sim_boundary_clamp(&boundary, NULL, from, point);
  for (int k = 0; k < 3; k++) assert_true(point[k] >= 0 && point[k] <= 1);
  zoo_free(&zoo);
}

// Friction is the solver's: sliding along a body, nothing of the way along it is lost.
static void moves_slide_along_bodies(void **state) {
  (void)state;
  Zoo zoo = zoo_make();
  SimObstacle obstacle = {
      .shape = SIM_BOX, .size = {0.8f, 0.2f, 0.8f}, .position = {0.5f, 0.3f, 0.5f}, .rotation = {0, 0, 0, 1}};
  SimBody block = sim_body_make(&obstacle, NULL);
  SimBoundary boundary = zoo_tank(&zoo, SIM_CONTAINER_BOX, &block, 1);
  float from[3] = {0.3f, 0.425f, 0.5f}, to[3] = {0.45f, 0.33f, 0.55f}; // into the top of the block
  sim_boundary_clamp(&boundary, NULL, from, to);
  assert_true(fabsf(to[0] - 0.45f) < 1e-4f && fabsf(to[2] - 0.55f) < 1e-4f && fabsf(to[1] - 0.425f) < 1e-4f);
  zoo_free(&zoo);
}

static void nan_and_the_infinite_pass_or_end_inside(void **state) {
  (void)state;
  Zoo zoo = zoo_make();
  for (int which = 0; which < ZOO; which++) {
    SimBody body = zoo_body(&zoo, which);
    SimBoundary boundary = zoo_tank(&zoo, which % 2 ? SIM_CONTAINER_GLASS : SIM_CONTAINER_BOX, &body, 1);
    float from[3] = {0.5f, 0.9f, 0.5f}, to[3] = {0.5f, NAN, 0.5f};
    assert_int_equal(sim_boundary_clamp(&boundary, NULL, from, to), -1);
    assert_true(isnan(to[1]));
    float far[3] = {0.5f, -INFINITY, 0.5f};
    sim_boundary_clamp(&boundary, NULL, from, far);
    must_be_outside(&boundary, far, which, "infinite");
    SimSolid solid;
    sim_boundary_solid(&boundary, NULL, (const float[3]){NAN, NAN, NAN}, &solid); // must come back
    float lost[3] = {NAN, 0.5f, 0.5f}, next[3] = {0.5f, 0.5f, 0.5f};
    sim_boundary_clamp(&boundary, NULL, lost, next);
  }
  zoo_free(&zoo);
}

// ---- What is near ----------------------------------------------------------------------------------------------------

// For random boxes among many moving bodies: where nothing is said to be near, nothing is; else the result is the same
// as that of a look at everything, to the bit.
static void what_is_selected_is_all_there_is(void **state) {
  (void)state;
  Zoo zoo = zoo_make();
  uint64_t seed = 12;
  static SimBody bodies[400], before[400];
  static SimNear near;
  for (int b = 0; b < 400; b++) {
    bodies[b] = zoo_body(&zoo, b % ZOO);
    zoo_turn(&bodies[b], &seed, 2);
    bodies[b].moves = b % 3 == 0;
    memcpy(bodies[b].old_rotation, bodies[b].rotation, sizeof bodies[b].rotation);
    for (int k = 0; k < 3; k++) {
      bodies[b].old_position[k] = bodies[b].position[k] = 10 * (float)test_random(&seed);
      if (bodies[b].moves) bodies[b].position[k] += 0.1f * (float)(2 * test_random(&seed) - 1);
    }
    if (bodies[b].moves) zoo_turn(&bodies[b], &seed, 2);
    before[b] = bodies[b];
    memcpy(before[b].position, bodies[b].old_position, sizeof bodies[b].position);
    memcpy(before[b].rotation, bodies[b].old_rotation, sizeof bodies[b].rotation);
  }
  SimBoundary boundary = zoo_tank(&zoo, SIM_CONTAINER_BOX, bodies, 400), start = boundary;
  start.bodies = before;
  int nothing = 0, something = 0;
  for (int n = 0; n < 4000; n++) {
    boundary.container = (SimContainer){{0, 0, 0}, {10, 10, 10}, n % 2 ? SIM_CONTAINER_GLASS : SIM_CONTAINER_BOX};
    start.container = boundary.container;
    float low[3], high[3], margin = 0.1f;
    for (int k = 0; k < 3; k++)
      low[k] = 10 * (float)test_random(&seed), high[k] = low[k] + 0.3f * (float)test_random(&seed);
    bool found = sim_boundary_select(&boundary, low, high, margin, &near);
    *(found ? &something : &nothing) += 1;
    for (int tries = 0; tries < 8; tries++) {
      float point[3], to[3], other[3];
      SimSolid a, b;
      for (int k = 0; k < 3; k++) {
        point[k] = low[k] + (high[k] - low[k]) * (float)test_random(&seed);
        to[k] = other[k] = point[k] + margin * (float)(2 * test_random(&seed) - 1);
        to[k] = other[k] = fminf(fmaxf(to[k], low[k] - margin), high[k] + margin);
      }
      const float wanted[3] = {to[0], to[1], to[2]};
      sim_boundary_solid(&boundary, NULL, point, &a);
      if (!sim_boundary_free(&start, point)) {
        assert_true(found);
        continue;
      }
      int32_t say = sim_boundary_clamp(&boundary, NULL, point, to);
      if (!found) {
        assert_true(a.share == 0 && say == -1 && memcmp(to, wanted, sizeof to) == 0);
        continue;
      }
      sim_boundary_solid(&boundary, &near, point, &b);
      assert_memory_equal(&a, &b, sizeof a);
      assert_int_equal(sim_boundary_clamp(&boundary, &near, point, other), say);
      assert_memory_equal(to, other, sizeof to);
    }
  }
  assert_true(nothing > 100 && something > 100);
  // More than a list holds: then all are looked at.
  for (int b = 0; b < 400; b++) memcpy(bodies[b].position, bodies[0].position, sizeof bodies[b].position);
  assert_true(sim_boundary_select(&boundary, bodies[0].position, bodies[0].position, 0, &near));
  assert_int_equal(near.count, -1);
  zoo_free(&zoo);
}

// ---- Starting --------------------------------------------------------------------------------------------------------

static void nothing_starts_in_a_body_or_a_wall(void **state) {
  (void)state;
  Zoo zoo = zoo_make();
  const TestMesh *meshes[2] = {&zoo.ring, &zoo.plate};
  for (int which = 0; which < 2 * ZOO; which++) {
    SimBlockDef block;
    SimWorldDef def = test_def((const float[3]){1, 1, 1}, &block, (const float[3]){1, 1, 1});
    SimBody body = zoo_body(&zoo, which % ZOO);
    SimObstacleDef solid = sim_default_obstacle_def();
    solid.body = (SimObstacle){.shape = body.shape,
                               .position = {0.5f, 0.45f, 0.55f},
                               .rotation = {0.3f, -0.2f, 0.1f, 0.9f},
                               .steps = body.steps,
                               .mesh = body.mesh ? &meshes[which % ZOO == PLATE_MESH]->view : NULL};
    for (int k = 0; k < 3; k++) solid.body.size[k] = 2 * body.half[k];
    def.obstacle_count = 1, def.obstacles = &solid;
    def.container.shape = which < ZOO ? SIM_CONTAINER_BOX : SIM_CONTAINER_GLASS;
    SimWorld *world = test_create(&def);
    SimFrameBuffer *buffer = sim_frame_buffer_create();
    const SimFrame *frame = test_frame(world, 0, buffer);
    SimBoundary boundary = zoo_tank(&zoo, def.container.shape, &body, 1);
    for (int32_t i = 0; i < frame->count; i++) assert_true(sim_boundary_free(&boundary, frame->position + 3 * i));
    assert_int_equal(frame->count + sim_world_counts(world).left_out, 8000);
    assert_true(frame->count > (which < ZOO ? 7000 : 5000) && frame->count <= 8000);
    sim_frame_buffer_destroy(buffer);
    sim_world_destroy(world);
  }
  zoo_free(&zoo);
}

// ---- Water -----------------------------------------------------------------------------------------------------------

// Water falls into a glass with a flight of stairs, a capsule and a mesh in it and comes to rest: no particle is in a
// body or out of the glass, and the density beside the walls is that of the water.
static void water_rests_in_a_glass_of_obstacles(void **state) {
  (void)state;
  Zoo zoo = zoo_make();
  SimBlockDef block;
  SimWorldDef def = test_def((const float[3]){1, 1, 1}, &block, (const float[3]){1, 0.5f, 1});
  SimObstacleDef solids[3] = {sim_default_obstacle_def(), sim_default_obstacle_def(), sim_default_obstacle_def()};
  const SimObstacle shapes[3] = {
      {.shape = SIM_STAIRS,
       .size = {0.3f, 0.3f, 0.3f},
       .position = {0.7f, 0.15f, 0.5f},
       .rotation = {0, 0, 0, 1},
       .steps = 3},
      {.shape = SIM_CAPSULE, .size = {0.15f, 0.35f}, .position = {0.3f, 0.25f, 0.6f}, .rotation = {0.2f, 0, 0, 1}},
      {.shape = SIM_MESH, .position = {0.4f, 0.3f, 0.35f}, .rotation = {0, 0, 0.4f, 1}, .mesh = &zoo.ring.view}};
  SimBody bodies[3];
  for (int b = 0; b < 3; b++) {
    solids[b].body = shapes[b];
    bodies[b] = sim_body_make(&shapes[b], b == 2 ? zoo.fields[0] : NULL);
  }
  def.obstacle_count = 3, def.obstacles = solids;
  def.container.shape = SIM_CONTAINER_GLASS;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  SimBoundary boundary = zoo_tank(&zoo, SIM_CONTAINER_GLASS, bodies, 3);
  for (int second = 0; second < 2; second++) {
    test_advance(world, 60);
    const SimFrame *frame = test_frame(world, 0, buffer);
    for (int32_t i = 0; i < frame->count; i++) must_be_outside(&boundary, frame->position + 3 * i, 0, "at rest");
  }
  SimMeasures measures = sim_world_measures(world);
  print_message("density off by %.4f on the average, %.4f at most; speed %.3f m/s at most\n",
                measures.mean_density_error, measures.max_density_error, measures.max_speed);
  assert_true(measures.mean_density_error < 0.01 && measures.max_density_error < 0.05);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
  zoo_free(&zoo);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(moves_end_outside_of_resting_bodies),
      cmocka_unit_test(thin_sheets_do_not_leak_when_they_move),
      cmocka_unit_test(moving_bodies_push_particles_ahead),
      cmocka_unit_test(a_paddle_leaves_no_particle_in_itself_or_the_wall),
      cmocka_unit_test(moves_slide_along_bodies),
      cmocka_unit_test(nan_and_the_infinite_pass_or_end_inside),
      cmocka_unit_test(what_is_selected_is_all_there_is),
      cmocka_unit_test(nothing_starts_in_a_body_or_a_wall),
      cmocka_unit_test(water_rests_in_a_glass_of_obstacles),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
