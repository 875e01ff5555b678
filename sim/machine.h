// What the kernel that measures multiply-adds reads and writes.
#ifndef LIDO_SIM_MACHINE_H
#define LIDO_SIM_MACHINE_H

#include <stdint.h>

/// Each item of the kernel does SIM_FMA_ROUNDS multiply-adds in each of SIM_FMA_CHAINS × *width lanes.
#define SIM_FMA_ROUNDS 65536
#define SIM_FMA_CHAINS 12

typedef struct SimFmaContext {
  float *result;  ///< (items), so that the work cannot be left out
  int32_t *width; ///< (items): lanes of the instruction set
} SimFmaContext;

#endif
