// The measures of the machine: what they count can be counted by hand, and no machine is faster than light.
#include "sim_test.h"

#include "sim/machine.h"
#include "sim/memory.h"
#include "sim/wide/wide.h"

static void rates_are_plausible(void **state) {
  (void)state;
  SimMachine machine = {NULL, 0, 0};
  SimError error = {""};
  assert_true(sim_measure_machine(1, &machine, &error));
  assert_string_equal(machine.instruction_set, sim_wide()->name);
  // A core of 2010 at its slowest; 64 lanes at 6 GHz.
  assert_true(machine.fma_per_second > 1e8 && machine.fma_per_second < 4e11);
  assert_true(machine.copy_per_second > 1e8 && machine.copy_per_second < 1e12);
  print_message("%s: %.3g multiply-adds/s, %.3g bytes/s on one thread\n", machine.instruction_set,
                machine.fma_per_second, machine.copy_per_second);
  assert_int_equal(sim_bytes_in_use(), 0);
}

// The kernel really iterates x ← 0.999 x + (0.001 + 10⁻⁶ item) in every lane: the limit is 1 + 10⁻³ item, in every chain.
static void the_kernel_does_its_work(void **state) {
  (void)state;
  static const char *const names[4] = {"avx512", "avx2", "sse2", "scalar"};
  const int lanes[4] = {16, 8, 4, 1};
  for (int k = 0; k < 4; k++) {
    const SimWide *wide = sim_wide_named(names[k]);
    if (!wide) continue;
    float result[2] = {0, 0};
    int32_t width[2] = {0, 0};
    wide->machine_fma(0, 2, &(SimFmaContext){result, width});
    for (int item = 0; item < 2; item++) {
      assert_true(fabs((double)result[item] - SIM_FMA_CHAINS * (1 + 1e-3 * item)) < 0.02);
      assert_int_equal(width[item], lanes[k]);
    }
  }
}

static void no_memory_is_an_error(void **state) {
  (void)state;
  SimMachine machine;
  SimError error = {""};
  sim_memory_limit(1 << 20);
  bool ok = sim_measure_machine(1, &machine, &error);
  sim_memory_limit(0);
  assert_false(ok);
  assert_string_equal(error.message, "out of memory");
  assert_int_equal(sim_bytes_in_use(), 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rates_are_plausible),
      cmocka_unit_test(the_kernel_does_its_work),
      cmocka_unit_test(no_memory_is_an_error),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
