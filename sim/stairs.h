// A solid flight of equal steps that climbs towards +x, in its own axes around its centre.
#ifndef LIDO_SIM_STAIRS_H
#define LIDO_SIM_STAIRS_H

#include "sim/wall.h"

typedef struct SimStairs {
  float half[3]; ///< m, half the edge lengths of the box around the flight
  int32_t steps; ///< at least 1
} SimStairs;

/// Signed distance (negative inside), m, and the unit normal.
float sim_stairs_distance(const SimStairs *stairs, const float point[3], float normal[3]);

/// The share of the density sum at a point, and its gradient (1/m).
float sim_stairs_solid(const SimStairs *stairs, const SimWall *wall, const float point[3], float gradient[3]);

#endif
