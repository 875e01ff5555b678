// Frames from a world and from particle sets: what is in them, and what is refused.
#include "sim_test.h"

#include "sim/surface.h"

static void refused_with(unsigned needs, const SimParticleSet *set, const char *named) {
  SimError error = {""};
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  if (sim_frame_from_particles(set, needs, 1, buffer, &error)) fail_msg("accepted although %s is wrong", named);
  if (!strstr(error.message, named)) fail_msg("the message \"%s\" does not name %s", error.message, named);
  sim_frame_buffer_destroy(buffer);
}

static void refused(const SimParticleSet *set, const char *named) {
  refused_with(SIM_NEED_ALL, set, named);
}

static void bad_sets_are_refused(void **state) {
  (void)state;
  float position[9] = {0, 0, 0, 1, NAN, 1, 2, 2, 2};
  SimParticleSet set = {.count = 3, .position = position};
  refused(&set, "particle 1");
  position[4] = -INFINITY;
  refused(&set, "particle 1");
  position[4] = 1;
  set.count = -1;
  refused(&set, "count");
  set.count = SIM_MAX_SET_PARTICLES + 1;
  refused(&set, "count");
  set.count = 3, set.particle_radius = NAN;
  refused(&set, "particle_radius");
  set.particle_radius = -0.1f;
  refused(&set, "particle_radius");
  set.particle_radius = 0, set.position = NULL;
  refused(&set, "positions");
}

// A million particles within one radius would take hours, here or where the frame is drawn: it is an error, at once.
static void a_heap_is_refused(void **state) {
  (void)state;
  int32_t count = 1000000;
  float *position = calloc((size_t)count * 3, sizeof(float));
  SimParticleSet set = {.count = count, .position = position, .particle_radius = 0.1f};
  refused(&set, "crowded");
  refused_with(SIM_NEED_DENSITY, &set, "crowded");
  refused_with(SIM_NEED_NOTHING, &set, "crowded");
  free(position);
}

static void empty_and_single_sets(void **state) {
  (void)state;
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  SimError error;
  const float position[3] = {1, 2, 3};
  for (int32_t count = 0; count <= 1; count++) {
    SimParticleSet set = {.index = 4, .time = 0.5, .count = count, .position = position};
    const SimFrame *frame = sim_frame_from_particles(&set, SIM_NEED_ALL, 1, buffer, &error);
    assert_non_null(frame);
    assert_int_equal(frame->count, count);
    assert_true(frame->index == 4 && frame->time == 0.5 && frame->particle_radius == 0.01f);
    assert_false(frame->has_container);
    assert_non_null(frame->ellipsoid);
    if (count) {
      assert_true(frame->bounds_min[1] == 2 && frame->container.max[2] == 3);
      assert_int_equal(frame->particle_class[0], SIM_SPLASH);
      assert_int_equal(frame->near_surface[0], 1);
    }
  }
  sim_frame_buffer_destroy(buffer);
  assert_int_equal(sim_bytes_in_use(), 0);
}

// Every array follows its particle through the sort; what is not given stays out.
static void attributes_follow_their_particles(void **state) {
  (void)state;
  enum { COUNT = 600 };
  float *position = test_lattice(10, 6, 10, 0.1, 0.4, 2), velocity[3 * COUNT], colour[3 * COUNT], radius[COUNT];
  uint8_t class[COUNT];
  uint32_t id[COUNT];
  for (int i = 0; i < COUNT; i++) {
    id[i] = (uint32_t)(7 * i + 3);
    radius[i] = 0.01f * (float)(i % 5 + 1);
    class[i] = i % 3 == 0;
    for (int k = 0; k < 3; k++) velocity[3 * i + k] = (float)(i + k), colour[3 * i + k] = (float)i / COUNT;
  }
  SimContainer container = {{-1, -1, -1}, {3, 3, 3}};
  SimParticleSet set = {.count = COUNT,
                        .position = position,
                        .velocity = velocity,
                        .colour = colour,
                        .radius = radius,
                        .particle_class = class,
                        .id = id,
                        .particle_radius = 0.05f,
                        .container = &container};
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  SimError error;
  const SimFrame *frame = sim_frame_from_particles(&set, SIM_NEED_ALL, 2, buffer, &error);
  assert_non_null(frame);
  assert_true(frame->has_container && frame->container.max[0] == 3 && frame->bounds_max[0] < 2);
  for (int i = 0; i < COUNT; i++) {
    int from = (int)(frame->id[i] - 3) / 7;
    assert_memory_equal(frame->position + 3 * i, position + 3 * from, 3 * sizeof(float));
    assert_memory_equal(frame->velocity + 3 * i, velocity + 3 * from, 3 * sizeof(float));
    assert_memory_equal(frame->colour + 3 * i, colour + 3 * from, 3 * sizeof(float));
    assert_true(frame->radius[i] == radius[from]);
    assert_int_equal(frame->particle_class[i], class[from]);
  }
  set = (SimParticleSet){.count = COUNT, .position = position};
  frame = sim_frame_from_particles(&set, SIM_NEED_NOTHING, 2, buffer, &error);
  assert_non_null(frame);
  assert_null(frame->colour);
  assert_null(frame->radius);
  assert_null(frame->particle_class);
  assert_null(frame->smoothed);
  assert_null(frame->ellipsoid);
  assert_null(frame->near_surface);
  assert_int_equal(frame->height_field.size[0], 0);
  assert_null(frame->velocity);
  assert_null(frame->density);
  for (int i = 0; i < COUNT; i++) // the place in the set, where it brings no ids
    assert_memory_equal(frame->position + 3 * i, position + 3 * frame->id[i], 3 * sizeof(float));
  sim_frame_buffer_destroy(buffer);
  free(position);
}

// Particles of a world handed back as a set give the same surface: what `lido render` shows of files is what was
// simulated. Also where the support is shorter or longer than the reach of the surface stages.
static void check_set_of_world(SimSolver solver, float support) {
  SimBlockDef block;
  SimWorldDef def = test_def((const float[3]){1.2f, 1, 0.4f}, &block, (const float[3]){0.5f, 0.6f, 0.4f});
  def.solver = solver;
  def.support = support;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *one = sim_frame_buffer_create(), *two = sim_frame_buffer_create();
  SimError error;
  test_advance(world, 25);
  const SimFrame *frame = test_frame(world, SIM_NEED_ALL, one);
  assert_int_equal(frame->index, 25);
  assert_true(fabs(frame->time - 25.0 / 60) < 1e-9 && frame->has_container);
  SimParticleSet set = {.count = frame->count,
                        .position = frame->position,
                        .id = frame->id,
                        .particle_radius = 0.025f,
                        .container = &frame->container};
  const SimFrame *again = sim_frame_from_particles(&set, SIM_NEED_ALL, 1, two, &error);
  assert_non_null(again);
  int32_t *at = malloc(sizeof *at * (size_t)frame->count), shaped = 0;
  for (int32_t i = 0; i < frame->count; i++) at[again->id[i]] = i;
  for (int32_t i = 0; i < frame->count; i++) {
    int32_t j = at[frame->id[i]];
    assert_memory_equal(frame->position + 3 * i, again->position + 3 * j, 3 * sizeof(float));
    assert_int_equal(frame->particle_class[i], again->particle_class[j]);
    assert_int_equal(frame->near_surface[i], again->near_surface[j]);
    for (int k = 0; k < 3; k++) assert_true(fabsf(frame->smoothed[3 * i + k] - again->smoothed[3 * j + k]) < 1e-6f);
    for (int k = 0; k < 6; k++) assert_true(fabsf(frame->ellipsoid[6 * i + k] - again->ellipsoid[6 * j + k]) < 1e-5f);
    shaped += frame->ellipsoid[6 * i + 3] != 0;
  }
  assert_true(shaped > frame->count / 2);
  const SimHeightField *field = &frame->height_field;
  assert_int_equal(field->size[0], again->height_field.size[0]);
  for (int k = 0; k < field->size[0] * field->size[1]; k++)
    assert_true(fabsf(field->height[k] - again->height_field.height[k]) < 1e-4f);
  free(at);
  sim_frame_buffer_destroy(one);
  sim_frame_buffer_destroy(two);
  sim_world_destroy(world);
}

static void a_set_gives_the_same_surface_as_its_world(void **state) {
  (void)state;
  const float supports[4] = {1.5f, 1.9f, 2, 2.6f};
  for (int k = 0; k < 4; k++) check_set_of_world(SIM_SOLVER_PBF, supports[k]);
  check_set_of_world(SIM_SOLVER_SPH, 2);
}

// A frame that nobody needs a surface of holds id, position, velocity, density and the cells; a warm one makes no block.
static void frames_hold_what_is_needed(void **state) {
  (void)state;
  SimBlockDef block;
  SimWorldDef def = test_def((const float[3]){1.2f, 1, 0.8f}, &block, (const float[3]){0.8f, 0.8f, 0.8f});
  SimWorld *world = test_create(&def);
  size_t before = sim_bytes_in_use();
  SimFrameBuffer *buffer = sim_frame_buffer_create(), *two = sim_frame_buffer_create();
  int32_t count = test_frame(world, SIM_NEED_NOTHING, buffer)->count;
  double each = (double)(sim_bytes_in_use() - before) / count;
  if (each > 50) fail_msg("%.1f bytes a particle", each);
  const SimFrame *frame = test_frame(world, SIM_NEED_ALL, buffer);
  SimParticleSet set = {.count = count, .position = frame->position, .particle_radius = 0.025f};
  SimError error;
  assert_non_null(sim_frame_from_particles(&set, SIM_NEED_ALL, 1, two, &error));
  size_t blocks = sim_allocation_count();
  for (unsigned needs = 0; needs <= SIM_NEED_ALL; needs++) {
    test_frame(world, needs, buffer);
    assert_non_null(sim_frame_from_particles(&set, needs, 1, two, &error));
  }
  assert_int_equal(sim_allocation_count(), blocks);
  sim_frame_buffer_destroy(two);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

// A frame outlives the step that follows it: the window draws frame n while frame n + 1 is made.
static void a_frame_stays_while_the_world_moves_on(void **state) {
  (void)state;
  SimBlockDef block;
  SimWorldDef def = test_def((const float[3]){0.8f, 0.8f, 0.4f}, &block, (const float[3]){0.4f, 0.5f, 0.4f});
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  const SimFrame *frame = test_frame(world, SIM_NEED_ALL, buffer);
  uint64_t hash = test_hash(frame);
  int32_t cells = frame->grid.size[0] * frame->grid.size[1] * frame->grid.size[2];
  test_advance(world, 5);
  assert_true(test_hash(frame) == hash);
  assert_int_equal(frame->grid.cell_start[cells], frame->count);
  sim_world_destroy(world);
  assert_true(test_hash(frame) == hash);
  sim_frame_buffer_destroy(buffer);
}

static void the_grid_of_a_frame_holds_its_particles(void **state) {
  (void)state;
  SimBlockDef block;
  SimWorldDef def = test_def((const float[3]){0.8f, 0.8f, 0.4f}, &block, (const float[3]){0.4f, 0.5f, 0.4f});
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  test_advance(world, 10);
  const SimFrame *frame = test_frame(world, 0, buffer);
  const SimGrid *grid = &frame->grid;
  assert_true(grid->cell_size >= 2 * 2 * frame->particle_radius);
  for (int z = 0, c = 0; z < grid->size[2]; z++)
    for (int y = 0; y < grid->size[1]; y++)
      for (int x = 0; x < grid->size[0]; x++, c++)
        for (int32_t i = grid->cell_start[c]; i < grid->cell_start[c + 1]; i++) {
          const int cell[3] = {x, y, z};
          for (int k = 0; k < 3; k++) {
            float inside = (frame->position[3 * i + k] - grid->origin[k]) / grid->cell_size - (float)cell[k];
            assert_true(inside > -1e-4f && inside < 1.0001f);
          }
        }
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

// Water, drops, a dense heap and a few particles far away: what a grid makes easy and hard.
static float *hard_set(int32_t *count) {
  enum { WATER = 20 * 14 * 18, DROPS = 900, HEAP = 700, FAR = 5 };
  float *position = realloc(test_lattice(20, 14, 18, 0.05, 0.3, 7), 3 * sizeof(float) * (WATER + DROPS + HEAP + FAR));
  srand(5);
  for (int i = WATER; i < WATER + DROPS + HEAP + FAR; i++)
    for (int k = 0; k < 3; k++) {
      float share = (float)rand() / (float)RAND_MAX;
      float size = i < WATER + DROPS ? 2 : i < WATER + DROPS + HEAP ? 0.07f : 300;
      position[3 * i + k] = size * share;
    }
  *count = WATER + DROPS + HEAP + FAR;
  return position;
}

// The density that nobody needs lists for is made without any, of the same bytes, on every instruction set.
static void density_without_lists_is_the_same(void **state) {
  (void)state;
  SimFrameBuffer *one = sim_frame_buffer_create(), *two = sim_frame_buffer_create();
  int32_t count;
  float *position = hard_set(&count), *other = malloc((size_t)count * sizeof *other);
  SimParticleSet set = {.count = count, .position = position, .particle_radius = 0.025f};
  SimError error;
  const SimFrame *frame = sim_frame_from_particles(&set, SIM_NEED_DENSITY | SIM_NEED_CLASS, 1, one, &error);
  const SimFrame *alone = sim_frame_from_particles(&set, SIM_NEED_DENSITY, 2, two, &error);
  assert_true(frame && alone);
  assert_null(alone->particle_class);
  assert_memory_equal(frame->id, alone->id, (size_t)count * sizeof *frame->id);
  assert_memory_equal(frame->density, alone->density, (size_t)count * sizeof *frame->density);
  float least = 1e9f, most = 0;
  for (int32_t i = 0; i < count; i++) {
    least = fminf(least, frame->density[i]);
    most = fmaxf(most, frame->density[i]);
  }
  assert_true(least < 330 && most > 2000); // a drop alone, the heap
  const char *const names[4] = {"avx512", "avx2", "sse2", "scalar"};
  for (int k = 0; k < 4; k++) {
    const SimWide *wide = sim_wide_named(names[k]);
    if (!wide) continue;
    sim_surface_density(wide, &frame->grid, frame->position, count, 0.05f, other, 2);
    for (int32_t i = 0; i < count; i++) assert_true(other[i] * 1000 == frame->density[i]);
  }
  free(other);
  free(position);
  sim_frame_buffer_destroy(one);
  sim_frame_buffer_destroy(two);
}

// Water of which only positions are needed: the frame's own, the grid, and what was sorted with.
static void a_set_takes_little_memory(void **state) {
  (void)state;
  size_t before = sim_bytes_in_use();
  float *position = test_lattice(60, 40, 50, 0.05, 0.3, 7);
  SimParticleSet set = {.count = 60 * 40 * 50, .position = position, .velocity = position, .particle_radius = 0.025f};
  SimError error;
  for (unsigned needs = 0; needs <= SIM_NEED_DENSITY; needs += SIM_NEED_DENSITY) {
    SimFrameBuffer *buffer = sim_frame_buffer_create();
    assert_non_null(sim_frame_from_particles(&set, needs, 1, buffer, &error));
    double each = (double)(sim_bytes_in_use() - before) / set.count;
    // 12 each for position and velocity, 4 each for cell, order and perhaps density; a sixth of a cell
    double most = needs ? 37.2 : 33.2;
    if (each > most) fail_msg("%.1f bytes a particle", each);
    sim_frame_buffer_destroy(buffer);
  }
  free(position);
}

// Drops far apart in a box of millions of cells: the cells grow, because there may be no more of them than one for two particles.
static void a_scattered_set_takes_little_memory(void **state) {
  (void)state;
  enum { COUNT = 400000 };
  float *position = malloc(3 * sizeof(float) * COUNT);
  uint64_t seed = 9;
  for (int i = 0; i < 3 * COUNT; i++) position[i] = (float)(40 * test_random(&seed));
  SimParticleSet set = {.count = COUNT, .position = position, .particle_radius = 0.01f};
  SimError error;
  for (int32_t threads = 1; threads <= 4; threads += 3) {
    SimFrameBuffer *buffer = sim_frame_buffer_create();
    size_t before = sim_bytes_in_use();
    const SimFrame *frame = sim_frame_from_particles(&set, SIM_NEED_NOTHING, threads, buffer, &error);
    assert_non_null(frame);
    double cells = (double)frame->grid.size[0] * frame->grid.size[1] * frame->grid.size[2];
    assert_true(cells <= 65536 + COUNT / 2 && frame->grid.cell_start[(int64_t)cells] == COUNT);
    double each = (double)(sim_bytes_in_use() - before) / COUNT;
    // 12 for position, 4 each for cell and order, 2 for where the cells start; 65,536 cells more
    if (each > 22 + 65536 * 4.0 / COUNT + 0.1) fail_msg("%.1f bytes a particle", each);
    sim_frame_buffer_destroy(buffer);
  }
  free(position);
}

static void radius_is_estimated_from_the_spacing(void **state) {
  (void)state;
  float *lattice = test_lattice(12, 12, 12, 0.07, 0, 1);
  assert_true(fabsf(sim_estimate_radius(lattice, 1728) - 0.035f) < 1e-5f);
  assert_true(sim_estimate_radius(lattice, 1) == 0.01f && sim_estimate_radius(NULL, 0) == 0.01f);
  for (int k = 0; k < 30; k++) lattice[k] = lattice[k % 3]; // ten in one place do not make it zero
  assert_true(fabsf(sim_estimate_radius(lattice, 1728) - 0.035f) < 1e-5f);
  assert_true(sim_estimate_radius(lattice, 10) == 0.01f);
  free(lattice);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bad_sets_are_refused),
      cmocka_unit_test(a_heap_is_refused),
      cmocka_unit_test(empty_and_single_sets),
      cmocka_unit_test(attributes_follow_their_particles),
      cmocka_unit_test(a_set_gives_the_same_surface_as_its_world),
      cmocka_unit_test(frames_hold_what_is_needed),
      cmocka_unit_test(a_frame_stays_while_the_world_moves_on),
      cmocka_unit_test(the_grid_of_a_frame_holds_its_particles),
      cmocka_unit_test(density_without_lists_is_the_same),
      cmocka_unit_test(a_set_takes_little_memory),
      cmocka_unit_test(a_scattered_set_takes_little_memory),
      cmocka_unit_test(radius_is_estimated_from_the_spacing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
