#include "sim/parallel.h"

#include <assert.h>
#include <omp.h>
#include <stddef.h>

int32_t sim_parallel_threads(int32_t requested) {
  int32_t threads = requested > 0 ? requested : omp_get_num_procs();
  return threads < 1 ? 1 : threads > 256 ? 256 : threads;
}

static int32_t blocks_of(int32_t count, int32_t block) {
  return count / block + (count % block != 0);
}

static int32_t block_end(int32_t begin, int32_t block, int32_t count) {
  return count - begin < block ? count : begin + block;
}

static void run_blocks(int32_t threads, int32_t count, int32_t block, SimKernel *kernel, const void *context) {
  int32_t blocks = blocks_of(count, block);
  if (threads > blocks) threads = blocks;
  if (threads <= 1) {
    for (int32_t b = 0; b < blocks; b++) kernel(b * block, block_end(b * block, block, count), context);
    return;
  }
  // A few blocks in a row: what a thread wrote in one sweep is still in its cache for the next, and a thread that is held
  // up leaves the rest to the others.
  int32_t piece = blocks / (16 * threads) + 1;
#pragma omp parallel for schedule(dynamic, piece) num_threads(threads)
  for (int32_t b = 0; b < blocks; b++) kernel(b * block, block_end(b * block, block, count), context);
}

void sim_parallel_for(int32_t threads, int32_t count, SimKernel *kernel, const void *context) {
  run_blocks(threads, count, SIM_BLOCK, kernel, context);
}

void sim_parallel_tasks(int32_t threads, int32_t count, SimKernel *kernel, const void *context) {
  run_blocks(threads, count, 1, kernel, context);
}

// ---- Reductions ------------------------------------------------------------------------------------------------------

typedef struct Reduce {
  SimReduceKernel *kernel;
  const void *context;
  int32_t count, block, width;
  double (*partial)[SIM_REDUCE_WIDTH];
  const double *start; ///< of each partial; NULL: 0
} Reduce;

static void reduce_block(int32_t begin, int32_t end, const void *context) {
  const Reduce *reduce = context;
  for (int32_t b = begin; b < end; b++) {
    double *partial = reduce->partial[b];
    for (int32_t k = 0; k < reduce->width; k++) partial[k] = reduce->start ? reduce->start[k] : 0;
    reduce->kernel(b * reduce->block, block_end(b * reduce->block, reduce->block, reduce->count), reduce->context,
                   partial);
  }
}

// The block grows with the count so that the slots fit on the stack, in multiples of SIM_BLOCK so that kernels which work
// on chunks start at one; it never depends on the threads.
static int32_t reduce_blocks(int32_t threads, Reduce *reduce) {
  reduce->block = SIM_BLOCK * blocks_of(reduce->count, SIM_REDUCE_BLOCKS * SIM_BLOCK);
  if (reduce->block < SIM_BLOCK) reduce->block = SIM_BLOCK;
  int32_t blocks = blocks_of(reduce->count, reduce->block);
  assert(blocks <= SIM_REDUCE_BLOCKS && reduce->width <= SIM_REDUCE_WIDTH);
  sim_parallel_tasks(threads, blocks, reduce_block, reduce);
  return blocks;
}

void sim_parallel_sum(int32_t threads, int32_t count, int32_t width, SimReduceKernel *kernel, const void *context,
                      double *result) {
  double partial[SIM_REDUCE_BLOCKS][SIM_REDUCE_WIDTH];
  Reduce reduce = {kernel, context, count, 0, width, partial, NULL};
  int32_t blocks = reduce_blocks(threads, &reduce);
  for (int32_t k = 0; k < width; k++) {
    result[k] = 0;
    for (int32_t b = 0; b < blocks; b++) result[k] += partial[b][k];
  }
}

void sim_parallel_max(int32_t threads, int32_t count, int32_t width, SimReduceKernel *kernel, const void *context,
                      double *result) {
  double partial[SIM_REDUCE_BLOCKS][SIM_REDUCE_WIDTH];
  Reduce reduce = {kernel, context, count, 0, width, partial, result};
  int32_t blocks = reduce_blocks(threads, &reduce);
  for (int32_t k = 0; k < width; k++)
    for (int32_t b = 0; b < blocks; b++)
      if (partial[b][k] > result[k]) result[k] = partial[b][k];
}
