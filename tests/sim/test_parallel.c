// Loops and sums over blocks: every item once, sums bit-equal for any number of threads.
#include "sim_test.h"

#include "sim/parallel.h"

#define COUNT 100003

static void touch(int32_t begin, int32_t end, const void *context) {
  uint8_t *touched = *(uint8_t *const *)context;
  for (int32_t i = begin; i < end; i++) touched[i]++;
}

static void every_item_once(void **state) {
  (void)state;
  const int32_t counts[] = {0, 1, SIM_BLOCK - 1, SIM_BLOCK, SIM_BLOCK + 1, COUNT};
  for (int threads = 1; threads <= 8; threads++)
    for (int k = 0; k < 6; k++) {
      uint8_t *touched = calloc((size_t)counts[k] + 1, 1);
      sim_parallel_for(threads, counts[k], touch, &touched);
      for (int32_t i = 0; i < counts[k]; i++) assert_int_equal(touched[i], 1);
      assert_int_equal(touched[counts[k]], 0);
      sim_parallel_tasks(threads, counts[k] > 100 ? 100 : counts[k], touch, &touched);
      for (int32_t i = 0; i < counts[k]; i++) assert_int_equal(touched[i], i < 100 ? 2 : 1);
      free(touched);
    }
}

static void blocks_begin_at_multiples(int32_t begin, int32_t end, const void *context) {
  (void)context;
  assert_int_equal(begin % SIM_BLOCK, 0);
  assert_true(end - begin <= SIM_BLOCK && end > begin);
}

static void blocks_are_whole(void **state) {
  (void)state;
  sim_parallel_for(1, COUNT, blocks_begin_at_multiples, NULL);
}

static void add_shares(int32_t begin, int32_t end, const void *context, double *partial) {
  (void)context;
  for (int32_t i = begin; i < end; i++) {
    partial[0] += 1.0 / (i + 1);
    partial[1] += i;
  }
}

static void raise(int32_t begin, int32_t end, const void *context, double *partial) {
  (void)context;
  for (int32_t i = begin; i < end; i++) {
    double value = fabs(sin(i));
    if (value > partial[0]) partial[0] = value;
    if (-value > partial[1]) partial[1] = -value;
  }
}

static void sums_are_bit_equal(void **state) {
  (void)state;
  double one[2], many[2];
  sim_parallel_sum(1, COUNT, 2, add_shares, NULL, one);
  assert_true(one[1] == (double)COUNT * (COUNT - 1) / 2);
  assert_true(fabs(one[0] - (log(COUNT) + 0.5772156649)) < 1e-5);
  for (int threads = 2; threads <= 8; threads++) {
    sim_parallel_sum(threads, COUNT, 2, add_shares, NULL, many);
    assert_memory_equal(one, many, sizeof one);
  }
  sim_parallel_sum(4, 0, 2, add_shares, NULL, many);
  assert_true(many[0] == 0 && many[1] == 0);
}

static void maxima(void **state) {
  (void)state;
  double expected = 0, low = -1e9;
  for (int i = 0; i < COUNT; i++) {
    expected = fmax(expected, fabs(sin(i)));
    low = fmax(low, -fabs(sin(i)));
  }
  for (int threads = 1; threads <= 5; threads++) {
    double most[2] = {0, -INFINITY};
    sim_parallel_max(threads, COUNT, 2, raise, NULL, most);
    assert_true(most[0] == expected && most[1] == low);
  }
  double none[2] = {-3, 4};
  sim_parallel_max(2, 0, 2, raise, NULL, none);
  assert_true(none[0] == -3 && none[1] == 4);
}

static void thread_counts(void **state) {
  (void)state;
  assert_int_equal(sim_parallel_threads(3), 3);
  assert_true(sim_parallel_threads(0) >= 1);
  assert_int_equal(sim_parallel_threads(100000), 256);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_item_once), cmocka_unit_test(blocks_are_whole), cmocka_unit_test(sums_are_bit_equal),
      cmocka_unit_test(maxima),          cmocka_unit_test(thread_counts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
