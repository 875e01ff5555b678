// The uniform grid and the neighbour lists against the search over all pairs.
#include "sim_test.h"

#include "sim/memory.h"
#include "sim/neighbours.h"

typedef struct Set {
  int32_t count;
  float *position[3];
} Set;

static Set make_set(int32_t count) {
  Set set = {count, {NULL, NULL, NULL}};
  for (int k = 0; k < 3; k++) set.position[k] = calloc((size_t)count + SIM_CHUNK, sizeof(float));
  return set;
}

static void free_set(Set *set) {
  for (int k = 0; k < 3; k++) free(set->position[k]);
}

static Set random_set(int32_t count, double size, uint64_t seed) {
  Set set = make_set(count);
  for (int32_t i = 0; i < count; i++)
    for (int k = 0; k < 3; k++) set.position[k][i] = (float)(size * (test_random(&seed) - 0.3));
  return set;
}

// Sort, check that the sort is a permutation into the right cells, return the sorted set.
static Set sorted_set(const Set *set, SimCellSort *sort, float cell, int32_t threads) {
  Set sorted = make_set(set->count);
  assert_true(sim_grid_sort(sort, sim_positions(set->position), set->count, sim_cells(cell), threads));
  const void *source[3] = {set->position[0], set->position[1], set->position[2]};
  void *target[3] = {sorted.position[0], sorted.position[1], sorted.position[2]};
  sim_grid_gather(sort, set->count, threads, 3, source, target);
  int32_t *seen = calloc((size_t)set->count + 1, sizeof *seen);
  for (int32_t i = 0; i < set->count; i++) seen[sort->order[i]]++;
  for (int32_t i = 0; i < set->count; i++) assert_int_equal(seen[i], 1);
  free(seen);
  const SimGrid *grid = &sort->grid;
  int32_t cells = grid->size[0] * grid->size[1] * grid->size[2];
  assert_int_equal(grid->cell_start[0], 0);
  assert_int_equal(grid->cell_start[cells], set->count);
  for (int32_t c = 0; c < cells; c++)
    for (int32_t i = grid->cell_start[c]; i < grid->cell_start[c + 1]; i++) {
      int32_t x = sim_grid_index(grid, 0, sorted.position[0][i]), y = sim_grid_index(grid, 1, sorted.position[1][i]),
              z = sim_grid_index(grid, 2, sorted.position[2][i]);
      assert_int_equal((z * grid->size[1] + y) * grid->size[0] + x, c);
    }
  return sorted;
}

static bool near(const Set *set, int32_t i, int32_t j, float radius) {
  float dx = set->position[0][j] - set->position[0][i], dy = set->position[1][j] - set->position[1][i],
        dz = set->position[2][j] - set->position[2][i];
  return dx * dx + dy * dy + dz * dz < radius * radius;
}

static void check_lists(const Set *sorted, const SimNeighbours *lists, float radius) {
  int64_t pairs = 0;
  for (int32_t i = 0; i < sorted->count; i++) {
    const uint32_t *lane = lists->index + (size_t)lists->start[i / SIM_CHUNK] * SIM_CHUNK + i % SIM_CHUNK;
    uint32_t at = 0, length = lists->length[i / SIM_CHUNK];
    for (int32_t j = 0; j < sorted->count; j++) {
      if (j == i || !near(sorted, i, j, radius)) continue;
      assert_true(at < length);
      assert_int_equal(lane[SIM_CHUNK * at++], j);
      pairs++;
    }
    for (; at < length; at++) assert_int_equal(lane[SIM_CHUNK * at], sorted->count); // filled up
  }
  assert_int_equal(pairs, lists->pairs);
}

static void check_set(const Set *set, float radius, int32_t threads) {
  const char *const names[4] = {"avx512", "avx2", "sse2", "scalar"};
  SimCellSort sort = {0};
  Set sorted = sorted_set(set, &sort, radius, threads);
  for (int k = 0; k < 4; k++) {
    const SimWide *wide = sim_wide_named(names[k]);
    if (!wide) continue;
    SimNeighbours lists = {0};
    assert_int_equal(sim_neighbours_build(&lists, wide, &sort.grid, sorted.position, set->count, radius, threads),
                     SIM_NEIGHBOURS_OK);
    check_lists(&sorted, &lists, radius);
    sim_neighbours_free(&lists);
  }
  free_set(&sorted);
  sim_grid_free(&sort);
}

static void random_sets_match_all_pairs(void **state) {
  (void)state;
  for (int threads = 1; threads <= 3; threads++) {
    Set set = random_set(2500, 1, (uint64_t)threads);
    check_set(&set, 0.12f, threads);
    check_set(&set, 0.5f, threads); // few cells, hundreds of neighbours: the slabs have to grow
    check_set(&set, 5, threads);    // one cell
    free_set(&set);
  }
}

static void no_particle_and_one_particle(void **state) {
  (void)state;
  for (int32_t count = 0; count <= 1; count++) {
    Set set = random_set(count, 1, 7);
    check_set(&set, 0.1f, 2);
    free_set(&set);
  }
}

// Every particle is everyone's neighbour: 600 · 599 pairs.
static void all_particles_in_one_place(void **state) {
  (void)state;
  Set set = make_set(600);
  for (int k = 0; k < 3; k++)
    for (int32_t i = 0; i < 600; i++) set.position[k][i] = 0.25f;
  check_set(&set, 0.1f, 2);
  free_set(&set);
}

// Particles on the cell borders, exactly one radius apart: rounding must not lose or add one.
static void lattice_on_cell_borders(void **state) {
  (void)state;
  Set set = make_set(12 * 12 * 12);
  for (int32_t i = 0; i < set.count; i++) {
    set.position[0][i] = 0.1f * (float)(i % 12);
    set.position[1][i] = 0.1f * (float)(i / 12 % 12);
    set.position[2][i] = 0.1f * (float)(i / 144);
  }
  check_set(&set, 0.1f, 2);
  check_set(&set, 0.2f, 2);
  free_set(&set);
}

// A few particles very far away must not make the grid huge, and still find their neighbours there.
static void outliers_far_away(void **state) {
  (void)state;
  Set set = random_set(2000, 1, 3);
  for (int k = 0; k < 3; k++) {
    set.position[k][5] = 1e9f, set.position[k][6] = 1e9f;
    set.position[k][1500] = -3e14f;
  }
  set.position[1][7] = 4e4f, set.position[1][8] = 4e4f + 0.05f;
  check_set(&set, 0.1f, 2);
  SimCellSort sort = {0};
  assert_true(sim_grid_sort(&sort, sim_positions(set.position), set.count, sim_cells(0.1f), 1));
  assert_true((double)sort.grid.size[0] * sort.grid.size[1] * sort.grid.size[2] <= 65536 + 4.0 * set.count);
  sim_grid_free(&sort);
  free_set(&set);
}

// A long line: many cells along one axis.
static void a_line(void **state) {
  (void)state;
  for (int axis = 0; axis < 3; axis++) {
    Set set = make_set(1500);
    for (int32_t i = 0; i < set.count; i++) set.position[axis][i] = 0.03f * (float)((i * 7) % 1500);
    check_set(&set, 0.1f, 2);
    free_set(&set);
  }
}

static void order_is_the_same_for_any_threads(void **state) {
  (void)state;
  Set set = random_set(30000, 1, 11);
  SimCellSort one = {0}, many = {0};
  assert_true(sim_grid_sort(&one, sim_positions(set.position), set.count, sim_cells(0.05f), 1));
  for (int threads = 2; threads <= 8; threads += 3) {
    assert_true(sim_grid_sort(&many, sim_positions(set.position), set.count, sim_cells(0.05f), threads));
    assert_memory_equal(one.order, many.order, sizeof(uint32_t) * (size_t)set.count);
  }
  sim_grid_free(&one);
  sim_grid_free(&many);
  free_set(&set);
}

// Searches wider than a cell (the surface stages use up to two) against all pairs.
static void wide_ranges_hold_every_neighbour(void **state) {
  (void)state;
  Set set = random_set(1500, 1, 5);
  SimCellSort sort = {0};
  Set sorted = sorted_set(&set, &sort, 0.07f, 2);
  for (int32_t i = 0; i < set.count; i++) {
    SimRange ranges[SIM_MAX_RANGES];
    const float point[3] = {sorted.position[0][i], sorted.position[1][i], sorted.position[2][i]};
    int32_t n = sim_grid_ranges(&sort.grid, point, 0.14f, ranges), found = 0, expected = 0;
    assert_true(n <= SIM_MAX_RANGES);
    for (int32_t r = 0; r < n; r++)
      for (int32_t j = ranges[r].begin; j < ranges[r].end; j++) found += near(&sorted, i, j, 0.14f);
    for (int32_t j = 0; j < set.count; j++) expected += near(&sorted, i, j, 0.14f);
    assert_int_equal(found, expected);
  }
  sim_grid_free(&sort);
  free_set(&sorted);
  free_set(&set);
}

static void a_heap_is_refused(void **state) {
  (void)state;
  SimGrid grid = {{0, 0, 0}, 1, {1, 1, 1}, (const int32_t[]){0, 2000000}};
  Set empty = make_set(0);
  SimNeighbours lists = {0};
  assert_int_equal(sim_neighbours_build(&lists, sim_wide(), &grid, empty.position, 2000000, 1, 1), SIM_NEIGHBOURS_CROWDED);
  free_set(&empty);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(random_sets_match_all_pairs),
      cmocka_unit_test(no_particle_and_one_particle),
      cmocka_unit_test(all_particles_in_one_place),
      cmocka_unit_test(lattice_on_cell_borders),
      cmocka_unit_test(outliers_far_away),
      cmocka_unit_test(a_line),
      cmocka_unit_test(order_is_the_same_for_any_threads),
      cmocka_unit_test(wide_ranges_hold_every_neighbour),
      cmocka_unit_test(a_heap_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
