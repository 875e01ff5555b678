// What holds the water: the container's walls and the obstacles, in two ways.
//
// 1. They count in the density sum (wall.h), so that a particle at a wall is neither short of neighbours (it would stack
//    there, and walls would suck) nor crowded.
// 2. A hard clamp at the end of every move: no particle's centre comes nearer than `clearance` to a wall, whatever the
//    pressure says. Moves are followed along their path, so thin obstacles are not jumped over.
#ifndef LIDO_SIM_BOUNDARY_H
#define LIDO_SIM_BOUNDARY_H

#include <stdbool.h>

#include "sim/obstacles.h"

typedef struct SimBoundary {
  SimContainer container;
  float clearance;      ///< m, half a spacing: particles touch the walls
  int32_t body_count;
  const SimBody *bodies;
  SimWall wall;
} SimBoundary;

/// The share of the density sum that walls and obstacles give at a point, in [0, 1], and its gradient (1/m).
float sim_boundary_solid(const SimBoundary *boundary, const float point[3], float gradient[3]);

/// Correct a move from a valid place `from` to `to`: stop at obstacles, then keep clear of all walls.
void sim_boundary_clamp(const SimBoundary *boundary, const float from[3], float to[3]);

/// Whether a particle may start here: inside the container, touching no wall or obstacle by more than a tenth of the
/// clearance.
bool sim_boundary_free(const SimBoundary *boundary, const float point[3]);

#endif
