// Which kernels this processor runs: see wide/wide.h.
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

#include "sim/wide/wide.h"

#if defined(SIM_HAVE_X86)
extern const SimWide sim_wide_avx512, sim_wide_avx2, sim_wide_sse2;
#endif
extern const SimWide sim_wide_scalar;

const SimWide *sim_wide_named(const char *name) {
#if defined(SIM_HAVE_X86)
  bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2") && __builtin_cpu_supports("fma");
  bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
  if (avx512 && !strcmp(name, "avx512")) return &sim_wide_avx512;
  if (avx2 && !strcmp(name, "avx2")) return &sim_wide_avx2;
  if (!strcmp(name, "sse2")) return &sim_wide_sse2;
#endif
  return !strcmp(name, "scalar") ? &sim_wide_scalar : NULL;
}

const SimWide *sim_wide(void) {
  static const char *const names[] = {"avx512", "avx2", "sse2"};
  const SimWide *wide = NULL;
  for (size_t k = 0; k < sizeof names / sizeof *names && !wide; k++) wide = sim_wide_named(names[k]);
  return wide ? wide : &sim_wide_scalar;
}
