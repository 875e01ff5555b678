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
  float friction;       ///< of the container, [0, 1]
  float clearance;      ///< m, half a spacing: particles touch the walls
  int32_t body_count;
  const SimBody *bodies;
  SimWall wall;
} SimBoundary;

/// What walls and obstacles are to a particle at one point.
typedef struct SimSolid {
  float share;            ///< of the density sum, [0, 1]
  float gradient[3];      ///< 1/m, of the share
  float velocity[3];      ///< m/s, of the walls there, weighted by their shares; 0 where there are none
  float friction;         ///< of the walls there, weighted likewise
  int32_t body;           ///< the floating body with the largest share there, −1: none in reach
  float body_gradient[3]; ///< 1/m, what that body adds to the gradient
} SimSolid;

void sim_boundary_solid(const SimBoundary *boundary, const float point[3], SimSolid *solid);

/// Whether any wall or body may be in reach (of the density sum or of a move of `margin`) of a point of the box.
bool sim_boundary_near_box(const SimBoundary *boundary, const float low[3], const float high[3], float margin);

/// Correct a move from a valid place `from` to `to`: stop at obstacles, then keep clear of all walls.
void sim_boundary_clamp(const SimBoundary *boundary, const float from[3], float to[3]);

/// Whether a particle may start here: inside the container, touching no wall or obstacle by more than a tenth of the
/// clearance.
bool sim_boundary_free(const SimBoundary *boundary, const float point[3]);

#endif
