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
  uint32_t *start;   ///< (count + 1): the list of particle i is index[start[i]] … index[start[i + 1] − 1]
  uint32_t *index;   ///< (pairs)
  float *gradient;   ///< (pairs), 1/m²: V W'(r)/r of each pair, written by pbf_density, read by pbf_correct
} SimNeighbours;

typedef enum SimNeighbourResult { SIM_NEIGHBOURS_OK, SIM_NEIGHBOURS_NO_MEMORY, SIM_NEIGHBOURS_CROWDED } SimNeighbourResult;

/// More neighbours than this on average is no fluid any more (a lattice has 32): SIM_NEIGHBOURS_CROWDED.
#define SIM_MAX_MEAN_NEIGHBOURS 400

/// Build the lists of `count` sorted positions.
SimNeighbourResult sim_neighbours_build(SimNeighbours *neighbours, const SimGrid *grid, float *const position[3],
                                        int32_t count, float radius, int32_t threads);
void sim_neighbours_free(SimNeighbours *neighbours);

/// Write the indices of the particles of `range` nearer than sqrt(radius2) to the point; at most range.end − range.begin.
static inline int32_t sim_range_search(float *const position[3], SimRange range, const float point[3], float radius2,
                                       uint32_t *found) {
  const float *restrict x = position[0], *restrict y = position[1], *restrict z = position[2];
  int32_t count = 0;
  for (int32_t j = range.begin; j < range.end; j++) {
    float dx = x[j] - point[0], dy = y[j] - point[1], dz = z[j] - point[2];
    found[count] = (uint32_t)j; // without a branch: overwritten unless it is counted
    count += dx * dx + dy * dy + dz * dz < radius2;
  }
  return count;
}

#endif
