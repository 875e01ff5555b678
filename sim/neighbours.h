// Neighbour lists: for each particle the indices of all others inside a radius, in sorted order.
//
// The lists are built with a margin beyond the support, so that they stay complete while the solver's iterations move
// particles; the world measures how far they moved and builds the lists anew when the margin is used up.
#ifndef LIDO_SIM_NEIGHBOURS_H
#define LIDO_SIM_NEIGHBOURS_H

#include "sim/grid.h"

typedef struct SimNeighbours {
  float radius;      ///< m, of the search
  int64_t pairs;     ///< entries in all lists
  int64_t *needed;   ///< (blocks): entries of each block of SIM_BLOCK particles
  uint32_t *start, *end; ///< (count): the list of particle i is index[start[i]] … index[end[i] − 1]
  uint32_t *index;   ///< (at least pairs)
  float *gradient;   ///< (likewise), 1/m²: V W'(r)/r of each pair, written by pbf_density, read by pbf_correct
} SimNeighbours;

typedef enum SimNeighbourResult { SIM_NEIGHBOURS_OK, SIM_NEIGHBOURS_NO_MEMORY, SIM_NEIGHBOURS_CROWDED } SimNeighbourResult;

/// More distances to test than this (sim_grid_candidates) is no fluid any more but a heap: SIM_NEIGHBOURS_CROWDED.
#define SIM_MAX_CANDIDATES 4e11

/// Build the lists of `count` sorted positions.
SimNeighbourResult sim_neighbours_build(SimNeighbours *neighbours, const SimGrid *grid, float *const position[3],
                                        int32_t count, float radius, int32_t threads);
void sim_neighbours_free(SimNeighbours *neighbours);

#endif
