// Neighbour lists: for each particle the indices of all others nearer than a radius, in sorted order.
//
// The lists of a chunk of SIM_CHUNK particles are interleaved: slot k of the chunk holds the k-th neighbour of each of
// its particles side by side, so that a kernel works on all of them at once and sums over slots without ever adding
// across lanes (the layout is SELL-C of Kreutzer et al., A Unified Sparse Matrix Data Format for Efficient General
// Sparse Matrix-Vector Multiplication, 2014). A list that is shorter than its chunk's longest one is filled up with the
// index `count`: a particle infinitely far away, see SIM_FAR in particles.h.
#ifndef LIDO_SIM_NEIGHBOURS_H
#define LIDO_SIM_NEIGHBOURS_H

#include "sim/grid.h"
#include "sim/wide/wide.h"

typedef struct SimNeighbours {
  float radius;      ///< m, of the search
  int64_t pairs;     ///< neighbours in all lists
  int64_t *needed;   ///< (blocks, 2): slots and neighbours of each block of SIM_BLOCK particles
  uint32_t *start;   ///< (chunks): the chunk's first slot
  uint32_t *length;  ///< (chunks): its slots
  uint32_t *index;   ///< (slots, SIM_CHUNK)
  int64_t capacity;  ///< slots
  int64_t slab;      ///< slots of a block that were enough last time
} SimNeighbours;

/// What the search kernel reads; it writes its block's part of every array of `lists`.
typedef struct SimListContext {
  SimNeighbours *lists;
  const SimGrid *grid;
  const float *position[3]; ///< m, sorted; readable up to SIM_CHUNK values beyond the last particle
  int32_t count;
  uint32_t slab;            ///< slots of a block
} SimListContext;

typedef enum SimNeighbourResult { SIM_NEIGHBOURS_OK, SIM_NEIGHBOURS_NO_MEMORY, SIM_NEIGHBOURS_CROWDED } SimNeighbourResult;

/// More distances to test than this (sim_grid_candidates) is no fluid any more but a heap: SIM_NEIGHBOURS_CROWDED.
#define SIM_MAX_CANDIDATES 4e11

/// Build the lists of `count` sorted positions; each array is readable up to SIM_CHUNK values beyond the last one.
SimNeighbourResult sim_neighbours_build(SimNeighbours *neighbours, const SimWide *wide, const SimGrid *grid,
                                        float *const position[3], int32_t count, float radius, int32_t threads);
void sim_neighbours_free(SimNeighbours *neighbours);

#endif
