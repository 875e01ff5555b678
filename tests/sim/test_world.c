// A world's interface: limits of the Def, small worlds, reset, pour, push, gravity, failure.
#include "sim_test.h"

#include "sim/world.h"

static SimBlockDef block;

static SimWorldDef small_def(void) {
  return test_def((const float[3]){0.8f, 0.8f, 0.4f}, &block, (const float[3]){0.4f, 0.4f, 0.4f});
}

static void refused(const SimWorldDef *def, const char *named) {
  SimError error = {""};
  SimWorld *world = sim_world_create(def, &error);
  if (world) fail_msg("accepted although %s is wrong", named);
  if (!strstr(error.message, named)) fail_msg("the message \"%s\" does not name %s", error.message, named);
  assert_null(strchr(error.message, '\n'));
  assert_int_equal(sim_bytes_in_use(), 0);
}

static void a_def_without_cookie_is_refused(void **state) {
  (void)state;
  SimWorldDef def = {0};
  refused(&def, "sim_default_world_def");
}

// Every number just outside its range, and NaN.
static void numbers_out_of_range_are_refused(void **state) {
  (void)state;
  SimWorldDef def;
#define REFUSE(field, value)                                                                                           \
  def = small_def();                                                                                                   \
  def.field = value;                                                                                                   \
  refused(&def, #field)
  REFUSE(particle_radius, 0.9e-4f);
  REFUSE(particle_radius, 1.1f);
  REFUSE(particle_radius, NAN);
  REFUSE(rest_density, 0);
  REFUSE(rest_density, INFINITY);
  REFUSE(support, 1.4f);
  REFUSE(support, 3.1f);
  REFUSE(time_step, -1);
  REFUSE(time_step, NAN);
  REFUSE(cfl, 0);
  REFUSE(cfl, 2.5f);
  REFUSE(iterations, 0);
  REFUSE(iterations, 101);
  REFUSE(viscosity, 0.6f);
  REFUSE(relaxation, 0);
  REFUSE(tensile, 0.2f);
  REFUSE(jitter, -0.1f);
  REFUSE(jitter, NAN);
  REFUSE(threads, -1);
  REFUSE(threads, 1000);
  REFUSE(solver, (SimSolver)7);

#undef REFUSE
  def = small_def();
  def.gravity[1] = NAN;
  refused(&def, "gravity");
  const float maxima[4] = {0.01f, -1, 1e9f, NAN};
  for (int k = 0; k < 4; k++) {
    def = small_def();
    def.container.max[k % 3] = maxima[k];
    refused(&def, "container");
  }
  def = small_def();
  def.block_count = -1;
  refused(&def, "blocks");
  def = small_def();
  def.blocks = NULL;
  refused(&def, "blocks");
  def = small_def();
  def.obstacle_count = 1;
  refused(&def, "obstacles");
}

static void bad_blocks_are_refused(void **state) {
  (void)state;
  SimWorldDef def = small_def();
  block.max[1] = block.min[1];
  refused(&def, "blocks[0]");
  def = small_def();
  block.velocity[0] = NAN;
  refused(&def, "blocks[0].velocity");
  def = small_def();
  block.min[2] = -INFINITY;
  refused(&def, "blocks[0].min");
  def = small_def();
  block.colour[2] = NAN;
  refused(&def, "blocks[0].colour");
}

static void bad_obstacles_are_refused(void **state) {
  (void)state;
  const SimObstacle good = {SIM_BOX, {0.1f, 0.1f, 0.1f}, {0.6f, 0.1f, 0.2f}, {0, 0, 0, 1}, {0, 0, 0}};
  SimObstacleDef solid = sim_default_obstacle_def();
  solid.body = good;
  SimWorldDef def = small_def();
  def.obstacle_count = 1;
  def.obstacles = &solid;
  solid.body.size[1] = 0;
  refused(&def, "obstacles[0]");
  solid.body = good, solid.body.rotation[3] = 0;
  refused(&def, "obstacles[0]");
  solid.body = good, solid.body.rotation[3] = NAN;
  refused(&def, "obstacles[0]");
  solid.body = good, solid.body.position[0] = INFINITY;
  refused(&def, "obstacles[0]");
  solid.body = good, solid.body.shape = (SimShape)9;
  refused(&def, "obstacles[0]");
}

static void bad_shapes_and_frictions_are_refused(void **state) {
  (void)state;
  SimObstacleDef solid = sim_default_obstacle_def();
  SimWorldDef def = small_def();
  def.obstacle_count = 1;
  def.obstacles = &solid;
  const float frictions[3] = {-0.1f, 1.1f, NAN};
  for (int k = 0; k < 3; k++) {
    solid.friction = frictions[k];
    refused(&def, "obstacles[0].friction");
    def.container_friction = frictions[k];
    solid.friction = 0;
    refused(&def, "container_friction");
    def.container_friction = 0;
  }
  solid.body.shape = SIM_STAIRS, solid.body.steps = 0;
  refused(&def, "obstacles[0]: steps");
  solid.body.steps = 1001;
  refused(&def, "obstacles[0]: steps");
  solid.body.shape = SIM_CAPSULE, solid.body.size[0] = 2;
  refused(&def, "obstacles[0]: a capsule");
  solid.body.shape = SIM_MESH;
  refused(&def, "obstacles[0]: a mesh");
  // An open mesh; what is wrong with meshes otherwise, test_mesh knows.
  const float vertex[4][3] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 0, 1}};
  const int32_t triangle[4][3] = {{0, 1, 2}, {0, 2, 3}, {1, 3, 2}, {0, 2, 1}};
  SimMesh mesh = {4, 4, vertex[0], triangle[0]};
  solid.body.mesh = &mesh;
  refused(&def, "obstacles[0]: mesh");
  def.obstacle_count = 0;
  def.container.shape = (SimContainerShape)2;
  refused(&def, "container: unknown shape");
  def.container.shape = SIM_CONTAINER_GLASS;
  def.container.max[2] = 0.04f; // less than a spacing
  refused(&def, "container must be at least one spacing");
}

// Far more particles than are allowed: refused at once, without trying.
static void huge_counts_are_refused(void **state) {
  (void)state;
  SimWorldDef def = small_def();
  def.particle_radius = 1e-4f;
  def.container.max[0] = def.container.max[1] = 9;
  block = (SimBlockDef){{0, 0, 0}, {9, 9, 9}, {0, 0, 0}, {0, 0, 0}};
  refused(&def, "too many particles");
  block = (SimBlockDef){{-1e6f, -1e6f, -1e6f}, {1e6f, 1e6f, 1e6f}, {0, 0, 0}, {0, 0, 0}};
  refused(&def, "too many particles");
}

static void an_empty_world_runs(void **state) {
  (void)state;
  SimWorldDef def = small_def();
  def.block_count = 0;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  test_advance(world, 3);
  const SimFrame *frame = test_frame(world, SIM_NEED_ALL, buffer);
  assert_int_equal(frame->count, 0);
  assert_true(frame->bounds_max[0] == def.container.max[0]);
  assert_true(sim_world_measures(world).mean_density_error == 0);
  assert_int_equal(sim_world_counts(world).particles, 0);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
  assert_int_equal(sim_bytes_in_use(), 0);
}

// A block thinner than a spacing is one particle; it falls like a stone and lies on the floor.
static void one_particle_falls_to_the_floor(void **state) {
  (void)state;
  SimWorldDef def = small_def();
  def.time_step = 0.004f; // symplectic Euler: a fall is ahead by half a substep
  block = (SimBlockDef){{0.4f, 0.5f, 0.2f}, {0.41f, 0.51f, 0.21f}, {0, 0, 0}, {0, 0, 0}};
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  assert_int_equal(sim_world_counts(world).particles, 1);
  test_advance(world, 12);
  double fallen = 0.505 - (double)test_frame(world, 0, buffer)->position[1];
  assert_true(fabs(fallen - 0.5 * 9.81 * 0.04) < 0.005);
  test_advance(world, 60);
  const SimFrame *frame = test_frame(world, SIM_NEED_ALL, buffer);
  assert_true(fabsf(frame->position[1] - 0.025f) < 1e-5f);
  assert_int_equal(frame->particle_class[0], SIM_SPLASH);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

static void blocks_outside_or_overlapping_are_left_out(void **state) {
  (void)state;
  SimBlockDef blocks[2] = {{{0, 0, 0}, {0.4f, 0.4f, 0.4f}, {0, 0, 0}, {0, 0, 0}},
                           {{0.2f, 0, 0}, {1.2f, 0.4f, 0.4f}, {0, 0, 0}, {0, 0, 0}}};
  SimWorldDef def = small_def();
  def.block_count = 2;
  def.blocks = blocks;
  SimWorld *world = test_create(&def);
  SimCounts counts = sim_world_counts(world);
  assert_int_equal(counts.particles, 16 * 8 * 8); // the container is 16 spacings long
  assert_int_equal(counts.left_out, 12 * 8 * 8);  // 4 columns overlap, 8 lie outside
  test_advance(world, 2);
  sim_world_destroy(world);
}

static void a_bad_duration_is_refused_without_harm(void **state) {
  (void)state;
  SimWorldDef def = small_def();
  SimWorld *world = test_create(&def);
  SimError error;
  assert_false(sim_world_advance(world, 0, &error));
  assert_false(sim_world_advance(world, -1, &error));
  assert_false(sim_world_advance(world, NAN, &error));
  assert_false(sim_world_advance(world, INFINITY, NULL));
  test_advance(world, 1);
  sim_world_destroy(world);
}

static void reset_is_as_good_as_new(void **state) {
  (void)state;
  SimWorldDef def = small_def();
  def.jitter = 0.1f;
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  SimWorld *world = test_create(&def);
  uint64_t start = test_hash(test_frame(world, 0, buffer));
  test_advance(world, 5);
  uint64_t later = test_hash(test_frame(world, 0, buffer));
  assert_true(later != start);
  // Everything that could be left behind: gravity, a push, poured water, time.
  SimBlockDef more = {{0.5f, 0.5f, 0}, {0.7f, 0.7f, 0.2f}, {0, 0, 0}, {1, 0, 0}};
  SimPush push = {{0, 0.2f, 0.2f}, {1, 0, 0}, 0.2f, {0, 50, 0}};
  assert_true(sim_world_pour(world, &more, NULL) > 0);
  assert_true(sim_world_set_gravity(world, (const float[3]){5, 0, 0}));
  test_advance(world, 2);
  assert_true(sim_world_push(world, &push));
  sim_world_reset(world);
  const SimFrame *frame = test_frame(world, 0, buffer);
  assert_true(frame->time == 0 && frame->index == 0 && frame->colour == NULL);
  assert_true(test_hash(frame) == start);
  test_advance(world, 5);
  assert_true(test_hash(test_frame(world, 0, buffer)) == later);
  assert_int_equal(sim_world_counts(world).particles, 8 * 8 * 8);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

static void seed_and_jitter(void **state) {
  (void)state;
  SimWorldDef def = small_def();
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  uint64_t hash[3];
  def.jitter = 0.2f;
  for (int k = 0; k < 3; k++) {
    def.seed = k < 2 ? 5 : 6;
    SimWorld *world = test_create(&def);
    const SimFrame *frame = test_frame(world, 0, buffer);
    test_inside_container(frame);
    hash[k] = test_hash(frame);
    sim_world_destroy(world);
  }
  assert_true(hash[0] == hash[1] && hash[0] != hash[2]);
  sim_frame_buffer_destroy(buffer);
}

// Where the spacing does not divide a block, the particles are still as many as its volume asks for, they reach from side to side, and
// none of them is nearer to another or to a wall than a tenth less than in the lattice.
static void blocks_are_filled_by_volume(void **state) {
  (void)state;
  const float sizes[4][3] = {{0.525f, 0.525f, 0.525f}, {1.43f, 0.61f, 1.37f}, {0.98f, 0.33f, 0.51f}, {0.5f, 0.5f, 0.5f}};
  const double tolerance[4] = {0.05, 0.01, 0.02, 1e-6}; // a layer of 10 is a tenth, of 28 a thirtieth
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  for (int k = 0; k < 4; k++) {
    SimBlockDef filled;
    SimWorldDef def = test_def(sizes[k], &filled, sizes[k]);
    SimWorld *world = test_create(&def);
    const SimFrame *frame = test_frame(world, 0, buffer);
    double share = frame->count * pow(0.05, 3) / (double)(sizes[k][0] * sizes[k][1] * sizes[k][2]), nearest = 1;
    if (fabs(share - 1) > tolerance[k]) fail_msg("block %d holds %.3f of its volume", k, share);
    assert_true(frame->count == (int32_t)sim_block_particles(&filled, 0.025f));
    test_inside_container(frame);
    for (int axis = 0; axis < 3; axis++) {
      double low = 2, high = 0;
      for (int32_t i = 0; i < frame->count; i++) {
        low = fmin(low, (double)frame->position[3 * i + axis]);
        high = fmax(high, (double)frame->position[3 * i + axis]);
      }
      if (low > 0.0285 || high < (double)sizes[k][axis] - 0.0285) fail_msg("block %d, axis %d: %g to %g", k, axis, low, high);
    }
    for (int32_t i = 1; i < frame->count; i++) {
      double d = 0;
      for (int axis = 0; axis < 3; axis++)
        d += pow((double)(frame->position[3 * i + axis] - frame->position[axis]), 2);
      nearest = fmin(nearest, sqrt(d));
    }
    assert_true(nearest > 0.9 * 0.05);
    sim_world_destroy(world);
  }
  sim_frame_buffer_destroy(buffer);
}

// A particle moved at random must not take the place of one of the next block.
static void jitter_leaves_nothing_out(void **state) {
  (void)state;
  SimWorldDef def = small_def();
  SimBlockDef blocks[8];
  for (int k = 0; k < 8; k++)
    blocks[k] = (SimBlockDef){{0.05f * (float)k, 0, 0}, {0.05f * (float)(k + 1), 0.3f, 0.3f}, {0, 0, 0}, {0, 0, 0}};
  def.blocks = blocks;
  def.block_count = 8;
  for (int k = 0; k < 2; k++) {
    def.jitter = k == 0 ? 0 : 0.3f;
    SimWorld *world = test_create(&def);
    assert_int_equal(sim_world_counts(world).particles, 8 * 6 * 6);
    assert_int_equal(sim_world_counts(world).left_out, 0);
    sim_world_destroy(world);
  }
}

static void pouring_adds_water_where_there_is_room(void **state) {
  (void)state;
  SimWorldDef def = small_def();
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  SimError error = {""};
  SimBlockDef drop = {{0.5f, 0.5f, 0.1f}, {0.7f, 0.7f, 0.3f}, {0, -1, 0}, {0.9f, 0.1f, 0.1f}};
  assert_int_equal(sim_world_pour(world, &drop, &error), 64);
  assert_int_equal(sim_world_pour(world, &drop, &error), 0); // the place is taken
  SimBlockDef outside = {{5, 5, 5}, {6, 6, 6}, {0, 0, 0}, {0, 0, 0}};
  assert_int_equal(sim_world_pour(world, &outside, &error), 0);
  const SimFrame *frame = test_frame(world, 0, buffer);
  assert_int_equal(frame->count, 512 + 64);
  assert_non_null(frame->colour);
  int red = 0;
  for (int32_t i = 0; i < frame->count; i++) {
    red += frame->colour[3 * i] == 0.9f;
    if (frame->id[i] < 512) assert_true(frame->colour[3 * i] != 0.9f);
  }
  assert_int_equal(red, 64);
  for (int f = 0; f < 20; f++) {
    test_advance(world, 1);
    assert_true(sim_world_pour(world, &drop, &error) >= 0);
  }
  assert_true(sim_world_counts(world).particles > 640);
  test_inside_container(test_frame(world, 0, buffer));
  drop.min[0] = NAN;
  assert_int_equal(sim_world_pour(world, &drop, &error), -1);
  assert_non_null(strstr(error.message, "block.min"));
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

// A push along z, upwards, at x = 0.1: water near the ray gains speed, water beyond the radius only falls; it acts once.
static void a_push_acts_near_its_ray_and_once(void **state) {
  (void)state;
  SimWorldDef def = small_def();
  memset(def.gravity, 0, sizeof def.gravity);
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  SimPush push = {{0.1f, 0.375f, -3}, {0, 0, 2}, 0.1f, {0, 20, 0}};
  assert_true(sim_world_push(world, &push));
  test_advance(world, 1);
  const SimFrame *frame = test_frame(world, 0, buffer);
  float near = 0, far = 0;
  for (int32_t i = 0; i < frame->count; i++) {
    float dx = frame->position[3 * i] - 0.1f, dy = frame->position[3 * i + 1] - 0.375f, v = frame->velocity[3 * i + 1];
    float r = sqrtf(dx * dx + dy * dy);
    if (r < 0.05f) near = fmaxf(near, v);
    if (r > 0.25f) far = fmaxf(far, fabsf(v));
  }
  assert_true(near > 0.15f && near <= 20.0f / 60);
  assert_true(far < 0.05f * near);
  double momentum = sim_world_measures(world).momentum[1];
  test_advance(world, 1);
  assert_true(fabs(sim_world_measures(world).momentum[1] - momentum) < 0.02 * momentum);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

static void bad_pushes_and_gravity_are_refused(void **state) {
  (void)state;
  SimWorldDef def = small_def();
  SimWorld *world = test_create(&def);
  const SimPush good = {{0, 0, 0}, {1, 0, 0}, 0.1f, {0, 1, 0}};
  SimPush push = good;
  push.radius = 0;
  assert_false(sim_world_push(world, &push));
  push = good, push.direction[0] = 0;
  assert_false(sim_world_push(world, &push));
  push = good, push.acceleration[1] = NAN;
  assert_false(sim_world_push(world, &push));
  push = good, push.origin[1] = INFINITY;
  assert_false(sim_world_push(world, &push));
  for (int k = 0; k < SIM_MAX_PUSHES; k++) assert_true(sim_world_push(world, &good));
  assert_false(sim_world_push(world, &good));
  assert_false(sim_world_set_gravity(world, (const float[3]){0, NAN, 0}));
  test_advance(world, 1);
  assert_true(sim_world_push(world, &good));
  sim_world_destroy(world);
}

static void tilting_moves_the_water(void **state) {
  (void)state;
  SimWorldDef def = small_def();
  SimWorld *world = test_create(&def);
  assert_true(sim_world_set_gravity(world, (const float[3]){9.81f, 0, 0}));
  test_advance(world, 60);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  const SimFrame *frame = test_frame(world, 0, buffer);
  double mean = 0;
  for (int32_t i = 0; i < frame->count; i++) mean += (double)frame->position[3 * i] / frame->count;
  assert_true(mean > 0.6);
  test_inside_container(frame);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

// Whatever breaks a state, the step must notice it, name particle and stage, and keep what was there before.
static void check_failure(SimWorld *world, const char *stage, uint32_t id) {
  SimError error = {""}, again = {""};
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  char particle[32];
  snprintf(particle, sizeof particle, "particle %u ", id);
  assert_false(sim_world_advance(world, 0.1, &error));
  if (!strstr(error.message, stage) || !strstr(error.message, particle)) fail_msg("%s", error.message);
  assert_false(sim_world_advance(world, 0.1, &again));
  assert_string_equal(error.message, again.message);
  assert_int_equal(sim_world_pour(world, &block, &again), -1);
  test_inside_container(test_frame(world, SIM_NEED_ALL, buffer));
  sim_world_reset(world);
  test_advance(world, 1);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

static void nan_is_caught_and_named(void **state) {
  (void)state;
  SimWorldDef def = small_def();
  SimWorld *world = test_create(&def);
  test_advance(world, 2);
  world->particles.now.velocity[1][77] = NAN;
  check_failure(world, "predict", world->particles.now.id[77]);
}

static void explosion_is_caught_and_named(void **state) {
  (void)state;
  SimWorldDef def = small_def();
  SimWorld *world = test_create(&def);
  test_advance(world, 2);
  world->particles.now.velocity[0][101] = 1e7f;
  check_failure(world, "predict", world->particles.now.id[101]);
}

// A solver gone wrong: corrections a thousand times too large. It must end with a message within a second of simulated
// time, not with NaN in a frame.
static void a_diverging_solver_is_caught(void **state) {
  (void)state;
  SimWorldDef def = small_def();
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  SimError error = {""};
  test_advance(world, 1);
  world->cubic.omega = 3000;
  bool ok = true;
  for (int f = 0; f < 60 && ok; f++) ok = sim_world_advance(world, 1.0 / 60, &error);
  assert_false(ok);
  assert_non_null(strstr(error.message, "particle "));
  test_inside_container(test_frame(world, 0, buffer));
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

// Half a second of water that falls over, beside four walls and a floor of bodies, moved towards it by `inwards`.
static uint64_t hash_in_walls(SimContainerShape shape, int body_count, float inwards) {
  SimWorldDef def = small_def();
  def.container.shape = shape;
  SimObstacleDef bodies[6];
  for (int b = 0; b < 6; b++) {
    const float *low = def.container.min, *high = def.container.max;
    int axis = b / 2;
    bodies[b] = sim_default_obstacle_def();
    bodies[b].body.shape = SIM_BOX;
    for (int k = 0; k < 3; k++) {
      bodies[b].body.position[k] = 0.5f * (low[k] + high[k]);
      bodies[b].body.size[k] = k == axis ? 0.3f : 2;
    }
    bodies[b].body.position[axis] = b % 2 ? high[axis] + 0.15f - inwards : low[axis] - 0.15f + inwards;
  }
  def.obstacles = bodies;
  def.obstacle_count = body_count;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  test_advance(world, 30);
  uint64_t hash = test_hash(test_frame(world, 0, buffer));
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
  return hash;
}

static void bodies_around_the_container_change_nothing(void **state) {
  (void)state;
  for (int shape = SIM_CONTAINER_BOX; shape <= SIM_CONTAINER_GLASS; shape++) {
    uint64_t alone = hash_in_walls(shape, 0, 0);
    assert_true(hash_in_walls(shape, 6, 0) == alone);
    // Rounded up or down, a wall that touches is still outside; one that comes in is not.
    assert_true(hash_in_walls(shape, 6, 1e-6f) == alone);
    assert_true(hash_in_walls(shape, 6, 0.01f) != alone);
  }
}

static void stages_have_names(void **state) {
  (void)state;
  assert_string_equal(sim_stage_name(SIM_STAGE_predict), "predict");
  assert_string_equal(sim_stage_name(SIM_STAGE_height_field), "height_field");
  assert_null(sim_stage_name(SIM_STAGE_COUNT));
}

static void the_profile_counts(void **state) {
  (void)state;
  SimWorldDef def = small_def();
  SimWorld *world = test_create(&def);
  test_advance(world, 2);
  const SimProfile *profile = sim_world_profile(world);
  assert_int_equal(profile->substeps, sim_world_counts(world).substeps);
  double pairs = (double)profile->neighbour_pairs / (double)profile->substeps / 512;
  assert_true(pairs > 15 && pairs < 40);
  assert_true(profile->milliseconds[SIM_STAGE_density] > 0 && profile->milliseconds[SIM_STAGE_correct] > 0);
  sim_world_clear_profile(world);
  assert_true(profile->substeps == 0 && profile->milliseconds[SIM_STAGE_density] == 0);
  sim_world_destroy(world);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_def_without_cookie_is_refused),
      cmocka_unit_test(numbers_out_of_range_are_refused),
      cmocka_unit_test(bad_blocks_are_refused),
      cmocka_unit_test(bad_obstacles_are_refused),
      cmocka_unit_test(bad_shapes_and_frictions_are_refused),
      cmocka_unit_test(huge_counts_are_refused),
      cmocka_unit_test(an_empty_world_runs),
      cmocka_unit_test(one_particle_falls_to_the_floor),
      cmocka_unit_test(blocks_outside_or_overlapping_are_left_out),
      cmocka_unit_test(a_bad_duration_is_refused_without_harm),
      cmocka_unit_test(reset_is_as_good_as_new),
      cmocka_unit_test(seed_and_jitter),
      cmocka_unit_test(jitter_leaves_nothing_out),
      cmocka_unit_test(blocks_are_filled_by_volume),
      cmocka_unit_test(pouring_adds_water_where_there_is_room),
      cmocka_unit_test(a_push_acts_near_its_ray_and_once),
      cmocka_unit_test(bad_pushes_and_gravity_are_refused),
      cmocka_unit_test(tilting_moves_the_water),
      cmocka_unit_test(nan_is_caught_and_named),
      cmocka_unit_test(explosion_is_caught_and_named),
      cmocka_unit_test(a_diverging_solver_is_caught),
      cmocka_unit_test(bodies_around_the_container_change_nothing),
      cmocka_unit_test(stages_have_names),
      cmocka_unit_test(the_profile_counts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
