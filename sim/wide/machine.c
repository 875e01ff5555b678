// The rate of multiply-adds, with enough independent chains to hide the latency of each. This is the only kernel that fuses
// products and sums: its result is of no interest, only its time. An instruction set without a fused instruction
// multiplies and adds.
#include "sim/machine.h"

#include "sim/wide/kernels.h"

#if defined(SIM_ISA_AVX2)
#define FUSED __attribute__((target("avx2,bmi2,fma"))) // no other function of this instruction set may use it
#else
#define FUSED
#endif

FUSED static inline SimF multiply_add(SimF a, SimF b, SimF c) {
#if defined(SIM_ISA_AVX512)
  return _mm512_fmadd_ps(a, b, c);
#elif defined(SIM_ISA_AVX2)
  return _mm256_fmadd_ps(a, b, c);
#else
  return a * b + c;
#endif
}

FUSED void WIDE(sim_machine_fma)(int32_t begin, int32_t end, const void *context) {
  const SimFmaContext *c = context;
  for (int32_t item = begin; item < end; item++) {
    SimF chain[SIM_FMA_CHAINS], factor = sim_f(0.999f), term = sim_f(0.001f + 1e-6f * (float)item);
    for (int k = 0; k < SIM_FMA_CHAINS; k++) chain[k] = sim_f((float)k);
    for (int32_t n = 0; n < SIM_FMA_ROUNDS; n++)
      for (int k = 0; k < SIM_FMA_CHAINS; k++) chain[k] = multiply_add(chain[k], factor, term);
    SimF sum = sim_f(0);
    for (int k = 0; k < SIM_FMA_CHAINS; k++) sum = sum + chain[k];
    float lane[SIM_LANES];
    sim_store(lane, sum);
    c->result[item] = lane[0];
    c->width[item] = SIM_LANES;
  }
}
