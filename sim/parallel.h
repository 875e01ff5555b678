// The one door to threads. No other file of the simulator knows OpenMP.
//
// Why this is race-free and why the same bytes come out for any number of threads:
//
// 1. Work is cut into blocks by the number of items alone, never by the number of threads. Which thread runs a block,
//    and when, is left to chance (dynamic schedule), but what a block computes is not.
// 2. A kernel gets (begin, end, const context). It may read everything that its context names, and it writes only
//    elements begin … end − 1 of its output arrays. No array is both an output and an input that other items read: the
//    solver is a Jacobi iteration (read the positions of before, write the corrections), gathers write to a second set of
//    arrays, and the counting sort scatters to places that its prefix sum has made disjoint. So no two threads ever write
//    the same element, and no thread reads what another one writes within the same call: no locks, no atomics.
// 3. Within one item, sums run over neighbours in the order of the cell-sorted arrays, which does not depend on threads.
// 4. Sums over all items go through sim_parallel_sum: each block adds up its own items into its own slot, and the slots
//    are added in block order by one thread. Floating-point addition is not associative, so this fixed order is what
//    makes the result the same. Maxima are associative and could be taken in any order; they go the same way.
// 5. -ffp-contract=off keeps the compiler from fusing products and sums in one place and not in another.
//
// The end of each call is a barrier: what a kernel wrote is seen by the next one.
//
// Threads: a call started from inside another parallel region runs on the calling thread (OpenMP's default), so that the
// machine is not overcommitted.
#ifndef LIDO_SIM_PARALLEL_H
#define LIDO_SIM_PARALLEL_H

#include <stdint.h>

/// Items of a block of sim_parallel_for.
#define SIM_BLOCK 256
/// Largest number of values of one sim_parallel_sum or sim_parallel_max, and of blocks they cut the items into.
#define SIM_REDUCE_WIDTH 10
#define SIM_REDUCE_BLOCKS 256

typedef void SimKernel(int32_t begin, int32_t end, const void *context);
/// Adds to (or raises) partial[0 … width − 1] for its own items.
typedef void SimReduceKernel(int32_t begin, int32_t end, const void *context, double *partial);

/// The number of threads to use: `requested` if it is positive (at most 256), else the number of cores.
int32_t sim_parallel_threads(int32_t requested);

/// Run the kernel over items 0 … count − 1 in blocks of SIM_BLOCK.
void sim_parallel_for(int32_t threads, int32_t count, SimKernel *kernel, const void *context);

/// The same with one item a block: for few, large items.
void sim_parallel_tasks(int32_t threads, int32_t count, SimKernel *kernel, const void *context);

/// Blocks of a reduction are multiples of SIM_BLOCK long.
/// result[k] = the sum over all items of what the kernel added to partial[k]; 0 where there is no item.
void sim_parallel_sum(int32_t threads, int32_t count, int32_t width, SimReduceKernel *kernel, const void *context,
                      double *result);

/// result[k] = the largest over all blocks of partial[k], which starts as result[k] on entry.
void sim_parallel_max(int32_t threads, int32_t count, int32_t width, SimReduceKernel *kernel, const void *context,
                      double *result);

#endif
