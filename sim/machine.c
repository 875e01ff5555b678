// What this machine can do at best: the rate of multiply-adds and of copying, to hold the simulator's figures against.
//
// Both are the best of several tries, on as many threads as the simulator would use: what disturbs a try makes it
// slower, never faster. The copy is one of 192 MiB in parts of 1 MiB, read and written once each; the processor may read
// a line from memory before it is written, which is not counted.
#include "sim/machine.h"

#include <math.h>
#include <string.h>

#include "sim/memory.h"
#include "sim/parallel.h"
#include "sim/world.h"

#define TRIES 6
#define ITEMS_A_THREAD 32
#define PART ((size_t)1 << 20) // bytes
#define PARTS 192

typedef struct CopyContext {
  char *from, *to;
} CopyContext;

static void copy_kernel(int32_t begin, int32_t end, const void *context) {
  const CopyContext *c = context;
  memcpy(c->to + (size_t)begin * PART, c->from + (size_t)begin * PART, (size_t)(end - begin) * PART);
}

/// s, of the fastest of several tries.
static double fastest(int32_t threads, int32_t items, SimKernel *kernel, const void *context) {
  double best = INFINITY;
  for (int n = 0; n < TRIES; n++) {
    double start = sim_milliseconds();
    sim_parallel_tasks(threads, items, kernel, context);
    best = fmin(best, (sim_milliseconds() - start) * 1e-3);
  }
  return fmax(best, 1e-9);
}

bool sim_measure_machine(int32_t threads, SimMachine *machine, SimError *error) {
  static const size_t bytes = PART * PARTS;
  threads = sim_parallel_threads(threads);
  int32_t items = ITEMS_A_THREAD * threads;
  SimFmaContext fma = {sim_allocate(sizeof(float) * (size_t)items), sim_allocate(sizeof(int32_t) * (size_t)items)};
  CopyContext copy = {sim_allocate(bytes), sim_allocate(bytes)};
  bool ok = fma.result && fma.width && copy.from && copy.to;
  if (ok) {
    double seconds = fastest(threads, items, sim_wide()->machine_fma, &fma);
    machine->instruction_set = sim_wide()->name;
    machine->fma_per_second = (double)items * SIM_FMA_ROUNDS * SIM_FMA_CHAINS * fma.width[0] / seconds;
    machine->copy_per_second = 2 * (double)bytes / fastest(threads, PARTS, copy_kernel, &copy);
  } else {
    sim_fail(error, "out of memory");
  }
  sim_release(fma.result);
  sim_release(fma.width);
  sim_release(copy.from);
  sim_release(copy.to);
  return ok;
}
