// Memory: nothing left, nothing allocated in a warm step, and every failed allocation is an error, not a crash.
#include "sim_test.h"

#include "sim/memory.h"

static SimBlockDef block;

static SimWorldDef pool_def(void) {
  return test_def((const float[3]){0.8f, 0.8f, 0.4f}, &block, (const float[3]){0.4f, 0.4f, 0.4f});
}

static void blocks_are_counted_and_aligned(void **state) {
  (void)state;
  size_t calls = sim_allocation_count();
  char *a = sim_allocate(1), *b = sim_allocate(1000);
  assert_true((uintptr_t)a % SIM_ALIGNMENT == 0 && (uintptr_t)b % SIM_ALIGNMENT == 0);
  assert_int_equal(sim_bytes_in_use(), 64 + 1024);
  assert_int_equal(sim_allocation_count(), calls + 2);
  for (int k = 0; k < 1000; k++) assert_int_equal(b[k], 0);
  sim_release(a);
  sim_release(b);
  sim_release(NULL);
  assert_int_equal(sim_bytes_in_use(), 0);
  assert_null(sim_allocate(SIZE_MAX));
}

static void reserve_grows_and_keeps(void **state) {
  (void)state;
  int *array = NULL;
  assert_true(sim_reserve((void **)&array, 10, sizeof(int)));
  for (int k = 0; k < 10; k++) array[k] = k;
  size_t calls = sim_allocation_count();
  assert_true(sim_reserve((void **)&array, 5, sizeof(int)));
  assert_int_equal(sim_allocation_count(), calls);
  assert_true(sim_reserve_keep((void **)&array, 100000, sizeof(int)));
  for (int k = 0; k < 10; k++) assert_int_equal(array[k], k);
  assert_false(sim_reserve((void **)&array, SIZE_MAX / 2, sizeof(int)));
  assert_int_equal(array[9], 9);
  sim_release(array);
  assert_int_equal(sim_bytes_in_use(), 0);
}

static void warm_step_and_frame(SimSolver solver, bool everything) {
  SimWorldDef def = pool_def();
  def.solver = solver;
  if (everything) {
    def.surface_tension = 0.07f;
    def.vorticity = 0.1f;
    def.kinematic_viscosity = 0.1f;
    def.colour_diffusion = 1e-4f;
    def.container_friction = 0.2f;
  }
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  for (int f = 0; f < 40; f++) {
    test_advance(world, 1);
    test_frame(world, SIM_NEED_ALL, buffer);
  }
  size_t calls = sim_allocation_count();
  for (int f = 0; f < 20; f++) {
    test_advance(world, 1);
    test_frame(world, SIM_NEED_ALL, buffer);
    sim_world_measures(world);
  }
  assert_int_equal(sim_allocation_count(), calls);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
  assert_int_equal(sim_bytes_in_use(), 0);
}

static void a_warm_step_and_frame_allocate_nothing(void **state) {
  (void)state;
  for (int k = 0; k < 4; k++) warm_step_and_frame((SimSolver)(k / 2), k % 2 == 1);
}

// Creation, a frame and pouring with ever more memory, until they succeed: each failure says so and leaves nothing.
static void running_out_of_memory_is_an_error(void **state) {
  (void)state;
  SimWorldDef def = pool_def();
  SimError error = {""};
  int failures = 0;
  for (size_t limit = 64; limit < (1u << 24); limit += limit / 3) {
    sim_memory_limit(limit);
    SimWorld *world = sim_world_create(&def, &error);
    SimFrameBuffer *buffer = world ? sim_frame_buffer_create() : NULL;
    bool ok = world && buffer && sim_world_frame(world, SIM_NEED_ALL, buffer, &error);
    SimBlockDef drop = {{0.5f, 0.4f, 0}, {0.8f, 0.8f, 0.4f}, {0, 0, 0}, {0, 0, 0}};
    ok = ok && sim_world_pour(world, &drop, &error) > 0 && sim_world_advance(world, 0.01, &error);
    if (!ok) {
      failures++;
      if (!world) assert_string_equal(error.message, "out of memory");
    }
    sim_frame_buffer_destroy(buffer);
    sim_world_destroy(world);
    assert_int_equal(sim_bytes_in_use(), 0);
    if (ok) break;
  }
  sim_memory_limit(0);
  assert_true(failures > 20);
}

static void destroying_nothing_is_allowed(void **state) {
  (void)state;
  sim_world_destroy(NULL);
  sim_frame_buffer_destroy(NULL);
  assert_int_equal(sim_bytes_in_use(), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(blocks_are_counted_and_aligned),         cmocka_unit_test(reserve_grows_and_keeps),
      cmocka_unit_test(a_warm_step_and_frame_allocate_nothing), cmocka_unit_test(running_out_of_memory_is_an_error),
      cmocka_unit_test(destroying_nothing_is_allowed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
