// Where water comes from and where it goes: drops, emitters, sinks, the limit, ids and colours.
#include "sim_test.h"

#include "sim/memory.h"
#include "sim/world.h"

static SimBlockDef block;
static SimEmitterDef spout;

// A room without gravity, two metres long, with a spout in the middle of its left wall; spacing 0.05.
static SimWorldDef spout_def(float width, float speed) {
  SimWorldDef def = test_def((const float[3]){2, 1, 1}, &block, (const float[3]){1, 1, 1});
  def.block_count = 0;
  memset(def.gravity, 0, sizeof def.gravity);
  spout = sim_default_emitter_def();
  spout.shape = SIM_EMITTER_RECTANGLE;
  spout.size[0] = spout.size[1] = width;
  spout.position[1] = spout.position[2] = 0.5f;
  spout.speed = speed;
  def.emitter_count = 1;
  def.emitters = &spout;
  return def;
}

static double area(void) {
  double a = (double)spout.size[0], b = (double)spout.size[1];
  return spout.shape == SIM_EMITTER_DISC ? 0.78539816339744831 * a * a : a * b;
}

static void check_balance(const SimWorld *world, int64_t start) {
  SimCounts counts = sim_world_counts(world);
  assert_true(start + counts.emitted - counts.swallowed - counts.reused == counts.particles);
}

static int compare_ids(const void *a, const void *b) {
  uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
  return (x > y) - (x < y);
}

static void check_ids_are_unique(const SimFrame *frame) {
  uint32_t *id = malloc((size_t)frame->count * sizeof *id + 1);
  memcpy(id, frame->id, (size_t)frame->count * sizeof *id);
  qsort(id, (size_t)frame->count, sizeof *id, compare_ids);
  for (int32_t i = 1; i < frame->count; i++) assert_true(id[i - 1] < id[i]);
  free(id);
}

// ---- Drops -----------------------------------------------------------------------------------------------------------

static void check_drop(float radius, const SimFrame *frame) {
  double volume = 4.18879 * pow((double)radius / 0.05, 3), middle[3] = {0, 0, 0};
  for (int32_t i = 0; i < frame->count; i++) {
    double d2 = 0;
    for (int k = 0; k < 3; k++) {
      double d = (double)frame->position[3 * i + k] - 0.5;
      middle[k] += d;
      d2 += d * d;
    }
    assert_true(sqrt(d2) < (double)radius + 0.2001 * 0.05);
    assert_true(frame->velocity[3 * i + 1] == -2);
  }
  for (int k = 0; k < 3; k++) assert_true(fabs(middle[k]) < 1e-5 * frame->count);
  // The nearest of some lattices: within 2 % of the volume, or a few particles off where there are few.
  if (fabs(frame->count - volume) > 0.02 * volume + 3)
    fail_msg("radius %g: %d of %g", (double)radius, frame->count, volume);
}

static void a_drop_is_a_symmetric_ball_of_its_volume(void **state) {
  (void)state;
  SimWorldDef def = test_def((const float[3]){1, 1, 1}, &block, (const float[3]){1, 1, 1});
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  def.block_count = 0;
  def.drop_count = 1;
  const float radii[] = {1e-4f, 0.02f, 0.05f, 0.08f, 0.1f, 0.15f, 0.21f, 0.3f, 0.4f};
  for (size_t k = 0; k < sizeof radii / sizeof *radii; k++) {
    SimDropDef drop = {{0.5f, 0.5f, 0.5f}, radii[k], {0, -2, 0}, {0, 0, 0}};
    def.drops = &drop;
    SimWorld *world = test_create(&def);
    assert_true(sim_world_counts(world).particles >= 1 && sim_world_counts(world).left_out == 0);
    check_drop(radii[k], test_frame(world, 0, buffer));
    sim_world_destroy(world);
  }
  sim_frame_buffer_destroy(buffer);
}

// Half in the wall, half in the water that is there already: only what is free is filled, the rest is counted.
static void a_drop_fills_only_what_is_free(void **state) {
  (void)state;
  SimWorldDef def = test_def((const float[3]){1, 1, 1}, &block, (const float[3]){1, 0.5f, 1});
  SimDropDef drop = {{0, 0.75f, 0.5f}, 0.2f, {0, 0, 0}, {0, 0, 0}};
  def.drop_count = 1;
  def.drops = &drop;
  SimWorld *world = test_create(&def);
  SimCounts counts = sim_world_counts(world);
  int32_t added = counts.particles - 20 * 10 * 20, whole = added + counts.left_out;
  assert_true(whole > 240 && whole < 300 && added > 0.35 * whole && added < 0.65 * whole);
  drop = (SimDropDef){{0.5f, 0.25f, 0.5f}, 0.15f, {0, 0, 0}, {0, 0, 0}};
  assert_int_equal(sim_world_drop(world, &drop, NULL), 0); // in the middle of the water
  drop.centre[1] = 0.8f;
  added = sim_world_drop(world, &drop, NULL);
  assert_true(added > 90 && sim_world_counts(world).emitted == added);
  test_advance(world, 5);
  SimError error;
  drop.radius = 0;
  assert_int_equal(sim_world_drop(world, &drop, &error), -1);
  assert_non_null(strstr(error.message, "drop.radius"));
  sim_world_destroy(world);
}

// ---- Flow ------------------------------------------------------------------------------------------------------------

// Any opening, speed and substep: what came out is area · speed · time, to within the layer that is on its way.
static void the_flow_is_area_times_speed(void **state) {
  (void)state;
  const struct {
    SimEmitterShape shape;
    float size[2], speed, time_step, cfl;
  } cases[] = {{SIM_EMITTER_RECTANGLE, {0.3f, 0.3f}, 1, 0, 0.4f},
               {SIM_EMITTER_RECTANGLE, {0.43f, 0.18f}, 2, 0, 1.7f},
               {SIM_EMITTER_RECTANGLE, {0.07f, 0.4f}, 1.3f, 0.003f, 1},
               {SIM_EMITTER_DISC, {0.4f, 0}, 1, 0.0071f, 2},
               {SIM_EMITTER_DISC, {0.13f, 0}, 3, 0, 0.4f},
               {SIM_EMITTER_DISC, {0.04f, 0}, 2, 0, 0.7f},
               {SIM_EMITTER_DISC, {0.26f, 0}, 1.7f, 0, 0.3f}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    SimWorldDef def = spout_def(0.3f, cases[k].speed);
    def.container.max[0] = 6;
    def.time_step = cases[k].time_step;
    def.cfl = cases[k].cfl;
    spout.shape = cases[k].shape;
    memcpy(spout.size, cases[k].size, sizeof spout.size);
    SimWorld *world = test_create(&def);
    double layer = world->emitters.emitter[0].place_count;
    for (int f = 1; f <= 60; f++) {
      test_advance(world, 1);
      double expected = area() * (double)spout.speed * f / 60 / pow(0.05, 3);
      int64_t emitted = sim_world_counts(world).emitted;
      if (emitted < expected - layer * 1.001 || emitted > expected * 1.001)
        fail_msg("case %zu: frame %d: %lld of %g", k, f, (long long)emitted, expected);
    }
    check_balance(world, 0);
    sim_world_destroy(world);
  }
}

// Behind the first layers, and as far as the support radius away from the stream's own surface, the density is the one
// at rest, and the speed is that of the spout: no gap and no bunch. The same in steps of any length; in short ones
// without the artificial pressure, which tears a stream in the air apart by itself, the more the shorter the steps are.
static void the_stream_has_neither_gaps_nor_bunches(void **state) {
  (void)state;
  const float steps[] = {0, 0.0013f, 0.0097f}, speeds[] = {1, 1, 3};
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  for (int k = 0; k < 3; k++)
    for (int disc = 0; disc < 2; disc++) {
      SimWorldDef def = spout_def(0.47f, speeds[k]);
      if (disc) spout.shape = SIM_EMITTER_DISC;
      def.time_step = steps[k];
      def.cfl = 2;
      if (steps[k] > 0) def.tensile = 0;
      SimWorld *world = test_create(&def);
      test_advance(world, speeds[k] > 2 ? 25 : 60);
      const SimFrame *frame = test_frame(world, 0, buffer);
      int inner = 0;
      for (int32_t i = 0; i < frame->count; i++) {
        const float *x = &frame->position[3 * i];
        if (x[0] < 0.16f || x[0] > 0.5f) continue;
        assert_true(fabsf(frame->velocity[3 * i] / spout.speed - 1) < 0.002f);
        if (hypotf(x[1] - 0.5f, x[2] - 0.5f) > 0.135f) continue;
        if (fabsf(frame->density[i] / 1000 - 1) > 0.005f) fail_msg("%d %d: %g at %g", k, disc, frame->density[i], x[0]);
        inner++;
      }
      assert_true(inner > 80);
      sim_world_destroy(world);
    }
  sim_frame_buffer_destroy(buffer);
}

static void start_stop_switch_and_reset(void **state) {
  (void)state;
  SimWorldDef def = spout_def(0.3f, 1);
  spout.start = 0.2;
  spout.stop = 0.5;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  test_advance(world, 12);
  assert_int_equal(sim_world_counts(world).emitted, 0);
  test_advance(world, 28);
  assert_int_equal(sim_world_counts(world).emitted, 6 * 36); // 0.3 s at 1 m/s: six layers
  uint64_t hash = test_hash(test_frame(world, SIM_NEED_ALL, buffer));
  sim_world_reset(world);
  assert_int_equal(sim_world_counts(world).emitted, 0);
  test_advance(world, 40);
  assert_true(test_hash(test_frame(world, SIM_NEED_ALL, buffer)) == hash);
  sim_world_reset(world);
  assert_false(sim_world_set_emitter(world, 1, true));
  assert_false(sim_world_set_emitter(world, -1, true));
  test_advance(world, 18);
  assert_int_equal(sim_world_counts(world).emitted, 2 * 36);
  assert_true(sim_world_set_emitter(world, 0, false));
  test_advance(world, 6);
  assert_int_equal(sim_world_counts(world).emitted, 2 * 36);
  assert_true(sim_world_set_emitter(world, 0, true)); // a new front: 0.1 s are left
  test_advance(world, 30);
  assert_int_equal(sim_world_counts(world).emitted, 4 * 36);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

static void an_emitter_without_room_emits_nothing(void **state) {
  (void)state;
  SimWorldDef def = spout_def(0.2f, 1);
  SimObstacleDef solid = sim_default_obstacle_def();
  solid.body.size[0] = solid.body.size[1] = solid.body.size[2] = 0.4f;
  solid.body.position[0] = 1, solid.body.position[1] = solid.body.position[2] = 0.5f;
  def.obstacle_count = 1;
  def.obstacles = &solid;
  for (int where = 0; where < 3; where++) {
    spout.position[0] = where == 0 ? 1 : where == 1 ? -0.1f : 2.5f; // in the body, in the wall, outside
    SimWorld *world = test_create(&def);
    test_advance(world, 30);
    assert_int_equal(sim_world_counts(world).emitted, 0);
    sim_world_destroy(world);
  }
  spout.position[0] = 0.6f; // against the body
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  test_advance(world, 60);
  const SimFrame *frame = test_frame(world, 0, buffer);
  assert_true(frame->count > 200);
  for (int32_t i = 0; i < frame->count; i++) {
    float normal[3];
    assert_true(sim_body_distance(&world->bodies[0], &frame->position[3 * i], normal) > 0.02f);
  }
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

// A closed room fills up. Then nothing finds a place any more, and nothing bursts.
static void a_full_room_takes_no_more(void **state) {
  (void)state;
  SimWorldDef def = spout_def(0.3f, 1);
  def.container.max[0] = def.container.max[1] = def.container.max[2] = 0.5f;
  def.gravity[1] = -9.81f;
  spout.position[1] = spout.position[2] = 0.25f;
  SimWorld *world = test_create(&def);
  test_advance(world, 150);
  int64_t emitted = sim_world_counts(world).emitted;
  assert_true(emitted > 400 && emitted < 1150); // 1000 fit
  assert_true(sim_world_measures(world).max_speed < 5);
  sim_world_destroy(world);
}

// ---- On a moving body ------------------------------------------------------------------------------------------------

// What sim/motion.c does to a body in each substep is done here between advances of one substep each: a nozzle moves
// at 2 m/s along z and is turned so that its water leaves upwards.
static void an_emitter_goes_with_its_obstacle(void **state) {
  (void)state;
  SimWorldDef def = spout_def(0.2f, 1);
  SimObstacleDef nozzle = sim_default_obstacle_def();
  nozzle.body.size[0] = nozzle.body.size[1] = nozzle.body.size[2] = 0.1f;
  const float s = 0.70710678f, turned[4] = {0, 0, s, s};
  memcpy(nozzle.body.rotation, turned, sizeof turned);
  nozzle.body.position[0] = 1, nozzle.body.position[1] = 0.1f, nozzle.body.position[2] = 0.2f;
  def.obstacle_count = 1;
  def.obstacles = &nozzle;
  def.cfl = 2;
  spout.obstacle = 0;
  memset(spout.position, 0, sizeof spout.position);
  spout.position[0] = 0.06f;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  world->bodies[0].moves = true;
  world->bodies[0].velocity[2] = 2;
  for (int f = 1; f <= 60; f++) {
    assert_true(sim_world_advance(world, 0.004, NULL));
    world->bodies[0].position[2] = world->obstacles[0].position[2] = 0.2f + 2 * 0.004f * (float)f;
  }
  const SimFrame *frame = test_frame(world, 0, buffer);
  assert_int_equal(frame->count, 4 * 16);
  for (int32_t i = 0; i < frame->count; i++) {
    const float *x = &frame->position[3 * i], *v = &frame->velocity[3 * i];
    assert_true(fabsf(v[1] - 1) < 0.1f && fabsf(v[2] - 2) < 0.1f && fabsf(v[0]) < 0.1f);
    // In the water's own frame the stream is a straight column above the nozzle.
    assert_true(fabsf(x[0] - 1) < 0.1f && fabsf(x[2] - 0.68f) < 0.11f && x[1] > 0.16f && x[1] < 0.45f);
  }
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

// ---- Sinks -----------------------------------------------------------------------------------------------------------

static void a_sink_swallows_what_enters_it_and_nothing_else(void **state) {
  (void)state;
  SimWorldDef def = spout_def(0.3f, 1);
  SimSinkDef sinks[2] = {{{1, 0, 0}, {1.2f, 1, 1}}, {{1.9f, 0, 0}, {2, 1, 1}}};
  def.sink_count = 2;
  def.sinks = sinks;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  for (int f = 0; f < 90; f++) {
    test_advance(world, 1);
    const SimFrame *frame = test_frame(world, 0, buffer);
    check_balance(world, 0);
    for (int32_t i = 0; i < frame->count; i++) assert_true(frame->position[3 * i] < 1);
    if (f < 54) assert_int_equal(sim_world_counts(world).swallowed, 0);
  }
  SimCounts counts = sim_world_counts(world);
  // 1.5 s of flow, less what is on the way: about 1 m.
  assert_true(counts.swallowed > 9 * 36 && counts.swallowed < 11.5 * 36);
  check_ids_are_unique(test_frame(world, 0, buffer));
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

// Against the slow twin: copy what is not gone, one by one.
static void removal_is_a_stable_compaction(void **state) {
  (void)state;
  uint64_t random = 7;
  for (int round = 0; round < 8; round++) {
    SimParticles particles = {0};
    uint8_t gone[1000];
    uint32_t kept[1000];
    const int32_t n = round == 0 ? 1 : 1000;
    int32_t left = 0;
    assert_true(sim_particles_reserve(&particles, n) && sim_particles_colour(&particles, (const float[3]){1, 0, 0}));
    for (int32_t i = 0; i < n; i++) {
      const float f = (float)i;
      sim_particles_add(&particles, (uint32_t)(i * 7), (const float[3]){f, f + 1, f + 2},
                        (const float[3]){-f, 2 * f, f / 2}, (const float[3]){f, 3 * f, 4 * f});
      gone[i] = round == 1 ? 0 : round == 2 ? 1 : round == 3 ? i % 2 == 0 : test_random(&random) < 0.1 * round;
      if (!gone[i]) kept[left++] = (uint32_t)i;
    }
    sim_particles_remove(&particles, gone);
    assert_int_equal(particles.count, left);
    for (int32_t i = 0; i < left; i++) {
      const float f = (float)kept[i];
      const SimSorted *now = &particles.now;
      assert_int_equal(now->id[i], kept[i] * 7);
      assert_true(now->position[0][i] == f && now->position[1][i] == f + 1 && now->position[2][i] == f + 2);
      assert_true(now->velocity[0][i] == -f && now->velocity[1][i] == 2 * f && now->velocity[2][i] == f / 2);
      assert_true(now->colour[0][i] == f && now->colour[1][i] == 3 * f && now->colour[2][i] == 4 * f);
    }
    sim_particles_free(&particles);
  }
  assert_int_equal(sim_bytes_in_use(), 0);
}

// ---- The limit -------------------------------------------------------------------------------------------------------

static void the_limit_holds(void **state) {
  (void)state;
  SimWorldDef def = test_def((const float[3]){1, 1, 1}, &block, (const float[3]){0.5f, 0.5f, 0.5f});
  def.max_particles = 1000;
  SimWorld *world = test_create(&def); // just as many
  SimBlockDef more = {{0.6f, 0.6f, 0.6f}, {0.9f, 0.9f, 0.9f}, {0, 0, 0}, {0, 0, 0}};
  assert_int_equal(sim_world_pour(world, &more, NULL), 0);
  assert_int_equal(sim_world_counts(world).particles, 1000);
  sim_world_destroy(world);
  def.max_particles = 999;
  SimError error = {""};
  assert_null(sim_world_create(&def, &error));
  assert_non_null(strstr(error.message, "too many particles"));
  assert_int_equal(sim_bytes_in_use(), 0);

  def = spout_def(0.3f, 1);
  def.max_particles = 100;
  world = test_create(&def);
  test_advance(world, 30);
  assert_int_equal(sim_world_counts(world).particles, 100);
  assert_int_equal(sim_world_counts(world).emitted, 100);
  sim_world_destroy(world);
}

// At the limit the oldest of what was emitted goes, never what was there at the start: the ids that are left are those of
// the start and the newest.
static void reuse_takes_the_oldest(void **state) {
  (void)state;
  SimWorldDef def = spout_def(0.3f, 1);
  block = (SimBlockDef){{1.5f, 0, 0}, {2, 0.2f, 0.5f}, {0, 0, 0}, {0, 0, 0}};
  def.block_count = 1;
  def.max_particles = 400 + 300;
  def.reuse = true;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  assert_int_equal(sim_world_counts(world).particles, 400);
  for (int f = 0; f < 60; f++) {
    test_advance(world, 1);
    const SimFrame *frame = test_frame(world, 0, buffer);
    SimCounts counts = sim_world_counts(world);
    check_balance(world, 400);
    check_ids_are_unique(frame);
    assert_true(counts.particles <= 700);
    int32_t of_start = 0;
    for (int32_t i = 0; i < frame->count; i++) {
      of_start += frame->id[i] < 400;
      assert_true(frame->id[i] < 400 || frame->id[i] >= 400 + counts.reused);
    }
    assert_int_equal(of_start, 400);
  }
  assert_true(sim_world_counts(world).reused > 200 && sim_world_counts(world).particles == 700);
  SimBlockDef more = {{0.6f, 0, 0}, {1.1f, 0.25f, 1}, {0, 0, 0}, {0, 0, 0}}; // 1000, more than may be taken
  assert_int_equal(sim_world_pour(world, &more, NULL), 300);
  assert_int_equal(sim_world_counts(world).particles, 700);
  check_balance(world, 400);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

// ---- Colours ---------------------------------------------------------------------------------------------------------

// Each source has a colour of its own; every particle keeps it while the water is sorted, swallowed and reused.
static void colours_stay_with_their_particles(void **state) {
  (void)state;
  SimWorldDef def = spout_def(0.2f, 1);
  SimEmitterDef spouts[2];
  for (int k = 0; k < 2; k++) {
    spouts[k] = spout;
    spouts[k].position[2] = k ? 0.7f : 0.3f;
    spouts[k].colour[k] = 0.75f;
  }
  SimSinkDef sink = {{1.5f, 0, 0}, {2, 1, 0.5f}};
  block = (SimBlockDef){{1, 0, 0}, {1.5f, 0.2f, 1}, {0, 0, 0}, {0, 0, 0}};
  def.block_count = 1;
  def.gravity[1] = -9.81f;
  def.emitters = spouts;
  def.emitter_count = 2;
  def.sinks = &sink;
  def.sink_count = 1;
  def.max_particles = 1000;
  def.reuse = true;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  float seen[4000][3] = {{0}};
  int colours[3] = {0, 0, 0};
  for (int f = 0; f < 70; f++) {
    test_advance(world, 1);
    const SimFrame *frame = test_frame(world, 0, buffer);
    assert_non_null(frame->colour);
    for (int32_t i = 0; i < frame->count; i++) {
      uint32_t id = frame->id[i];
      const float *colour = &frame->colour[3 * i];
      assert_true(id < 4000);
      if (seen[id][0] + seen[id][1] + seen[id][2] == 0) {
        memcpy(seen[id], colour, sizeof seen[id]);
        // New water is the colour of the spout on whose side it is.
        int own = id < 800 ? 2 : frame->position[3 * i + 2] > 0.5f;
        assert_true(own == 2 ? memcmp(colour, sim_water_colour, sizeof seen[id]) == 0
                             : colour[own] == 0.75f && colour[2] == 0);
        colours[own]++;
      }
      assert_memory_equal(seen[id], colour, sizeof seen[id]);
    }
  }
  assert_true(colours[0] > 200 && colours[1] > 200 && colours[2] == 800);
  assert_true(sim_world_counts(world).swallowed > 20 && sim_world_counts(world).reused > 20);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

// ---- The rules of the house ------------------------------------------------------------------------------------------

static SimWorldDef busy_def(SimSinkDef *sink, SimDropDef *drop) {
  SimWorldDef def = spout_def(0.3f, 2);
  block = (SimBlockDef){{1, 0, 0}, {1.5f, 0.3f, 1}, {0, 0, 0}, {0.2f, 0, 0}};
  def.block_count = 1;
  def.gravity[1] = -9.81f;
  *sink = (SimSinkDef){{1.8f, 0, 0}, {2, 1, 1}};
  *drop = (SimDropDef){{1.2f, 0.7f, 0.5f}, 0.15f, {0, -1, 0}, {0, 0.5f, 0}};
  def.sinks = sink;
  def.sink_count = 1;
  def.drops = drop;
  def.drop_count = 1;
  def.max_particles = 1500;
  def.reuse = true;
  return def;
}

static void any_number_of_threads_gives_the_same_bytes(void **state) {
  (void)state;
  const int32_t threads[] = {1, 2, 3, 8};
  SimSinkDef sink;
  SimDropDef drop;
  uint64_t hash[4];
  for (int k = 0; k < 4; k++) {
    SimWorldDef def = busy_def(&sink, &drop);
    def.threads = threads[k];
    SimWorld *world = test_create(&def);
    SimFrameBuffer *buffer = sim_frame_buffer_create();
    hash[k] = 0;
    for (int f = 0; f < 40; f++) {
      test_advance(world, 1);
      hash[k] = hash[k] * 31 + test_hash(test_frame(world, 0, buffer));
      if (f == 20) assert_true(sim_world_drop(world, &drop, NULL) >= 0);
    }
    SimCounts counts = sim_world_counts(world);
    assert_true(counts.swallowed > 0 && counts.reused > 0 && counts.emitted > 500);
    sim_frame_buffer_destroy(buffer);
    sim_world_destroy(world);
    if (hash[k] != hash[0]) fail_msg("%d threads: other bytes than with one", threads[k]);
  }
}

static void warm_steps_allocate_nothing(void **state) {
  (void)state;
  SimSinkDef sink;
  SimDropDef drop;
  SimWorldDef def = busy_def(&sink, &drop);
  SimWorld *world = test_create(&def);
  test_advance(world, 90);
  size_t calls = sim_allocation_count();
  int64_t emitted = sim_world_counts(world).emitted;
  test_advance(world, 20);
  assert_int_equal(sim_allocation_count(), calls);
  assert_true(sim_world_counts(world).emitted > emitted + 300);
  sim_world_destroy(world);
  assert_int_equal(sim_bytes_in_use(), 0);
}

// Creation and emission with ever more memory, until they succeed: each failure says so and leaves nothing.
static void running_out_of_memory_is_an_error(void **state) {
  (void)state;
  SimSinkDef sink;
  SimDropDef drop;
  int failures = 0;
  for (size_t limit = 64; limit < (1u << 25); limit += limit / 3) {
    SimWorldDef def = busy_def(&sink, &drop);
    def.max_particles = 0;
    sim_memory_limit(limit);
    SimError error = {""};
    SimWorld *world = sim_world_create(&def, &error);
    bool ok = world && sim_world_advance(world, 0.3, &error);
    if (!ok) failures++, assert_string_equal(error.message, "out of memory");
    sim_world_destroy(world);
    assert_int_equal(sim_bytes_in_use(), 0);
    if (ok) break;
  }
  sim_memory_limit(0);
  assert_true(failures > 20);
}

static void refused(const SimWorldDef *def, const char *named) {
  SimError error = {""};
  if (sim_world_create(def, &error)) fail_msg("accepted although %s is wrong", named);
  if (!strstr(error.message, named)) fail_msg("the message \"%s\" does not name %s", error.message, named);
  assert_int_equal(sim_bytes_in_use(), 0);
}

static void bad_defs_are_refused(void **state) {
  (void)state;
  SimSinkDef sink;
  SimDropDef drop;
  SimWorldDef def;
#define REFUSE(change, named)                                                                                          \
  def = busy_def(&sink, &drop);                                                                                        \
  change;                                                                                                              \
  refused(&def, named)
  REFUSE(spout.shape = (SimEmitterShape)2, "emitters[0].shape");
  REFUSE(spout.size[0] = 0, "emitters[0].size");
  REFUSE(spout.size[1] = NAN, "emitters[0].size");
  REFUSE(spout.size[0] = spout.size[1] = 1e3f, "emitters[0].size");
  REFUSE((spout.shape = SIM_EMITTER_DISC, spout.size[0] = 1e6f), "emitters[0].size");
  REFUSE(spout.position[2] = INFINITY, "emitters[0].position");
  REFUSE(spout.rotation[0] = NAN, "emitters[0].rotation");
  REFUSE(spout.rotation[3] = NAN, "emitters[0].rotation");
  REFUSE(memset(spout.rotation, 0, sizeof spout.rotation), "emitters[0].rotation");
  REFUSE(spout.speed = 0.009f, "emitters[0].speed");
  REFUSE(spout.speed = 101, "emitters[0].speed");
  REFUSE(spout.speed = NAN, "emitters[0].speed");
  REFUSE(spout.start = INFINITY, "emitters[0].start");
  REFUSE(spout.stop = -1, "emitters[0].stop");
  REFUSE(spout.stop = (double)NAN, "emitters[0].stop");
  REFUSE(spout.colour[1] = NAN, "emitters[0].colour");
  REFUSE(spout.obstacle = 0, "emitters[0].obstacle");
  REFUSE(spout.obstacle = -2, "emitters[0].obstacle");
  REFUSE(def.emitter_count = -1, "emitters");
  REFUSE(def.emitters = NULL, "emitters");
  REFUSE(drop.radius = -1, "drops[0].radius");
  REFUSE(drop.radius = NAN, "drops[0].radius");
  REFUSE(drop.radius = 1e5f, "too many particles");
  REFUSE(drop.centre[0] = NAN, "drops[0].centre");
  REFUSE(drop.velocity[0] = NAN, "drops[0].velocity");
  REFUSE(drop.colour[0] = NAN, "drops[0].colour");
  REFUSE(def.drops = NULL, "drops");
  REFUSE(sink.max[1] = sink.min[1], "sinks[0]");
  REFUSE(sink.min[0] = -INFINITY, "sinks[0].min");
  REFUSE(sink.max[0] = NAN, "sinks[0].max");
  REFUSE(def.sinks = NULL, "sinks");
  REFUSE(def.max_particles = -1, "max_particles");
  REFUSE(def.max_particles = SIM_MAX_PARTICLES + 1, "max_particles");
#undef REFUSE
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_drop_is_a_symmetric_ball_of_its_volume),
      cmocka_unit_test(a_drop_fills_only_what_is_free),
      cmocka_unit_test(the_flow_is_area_times_speed),
      cmocka_unit_test(the_stream_has_neither_gaps_nor_bunches),
      cmocka_unit_test(start_stop_switch_and_reset),
      cmocka_unit_test(an_emitter_without_room_emits_nothing),
      cmocka_unit_test(a_full_room_takes_no_more),
      cmocka_unit_test(an_emitter_goes_with_its_obstacle),
      cmocka_unit_test(a_sink_swallows_what_enters_it_and_nothing_else),
      cmocka_unit_test(removal_is_a_stable_compaction),
      cmocka_unit_test(the_limit_holds),
      cmocka_unit_test(reuse_takes_the_oldest),
      cmocka_unit_test(colours_stay_with_their_particles),
      cmocka_unit_test(any_number_of_threads_gives_the_same_bytes),
      cmocka_unit_test(warm_steps_allocate_nothing),
      cmocka_unit_test(running_out_of_memory_is_an_error),
      cmocka_unit_test(bad_defs_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
