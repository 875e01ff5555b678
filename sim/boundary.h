// What holds the water: the container's walls and the obstacles, in two ways.
//
// 1. They count in the density sum (wall.h), so that a particle at a wall is neither short of neighbours (it would stack
//    there, and walls would suck) nor crowded.
// 2. A hard clamp at the end of every move (boundary_clamp.c): no particle's centre comes nearer than `clearance` to a
//    wall, whatever the pressure says. Moves are followed along their path, relative to bodies that move themselves, so
//    thin obstacles are not jumped over and thin paddles do not pass through the water.
//
// Most particles are near no wall, and each of the others near few bodies. So for a block of particles that lie close
// together, ask once:
//
//   SimNear near;
//   if (sim_boundary_select(boundary, low, high, margin, &near))       // low, high: the box around the block's particles
//     for each of them { sim_boundary_solid(boundary, &near, …); sim_boundary_clamp(boundary, &near, …); }
//
// Where it is false, the share of every point in the box is 0, and no move that begins and ends at most `margin` outside
// it is changed. Where it is true, SimNear holds for such points and moves what there is to look at, and the results are
// the same as with NULL instead, which looks at everything.
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

/// Floating bodies that are told apart at one point.
#define SIM_FLOATERS 2

/// What walls and obstacles are to a particle at one point.
typedef struct SimSolid {
  float share;            ///< of the density sum, [0, 1]
  float gradient[3];      ///< 1/m, of the share
  float velocity[3];      ///< m/s, of the walls there, weighted by their shares; 0 where there are none
  float friction;         ///< of the walls there, weighted likewise
  int32_t body[SIM_FLOATERS]; ///< the floating bodies in reach there, −1: fewer
  float body_gradient[SIM_FLOATERS][3]; ///< 1/m, what each of them adds to the gradient; a third one counts as the second
} SimSolid;

/// Bodies that SimNear can list. Where there are more, it says to look at all of them.
#define SIM_MAX_NEAR 256

/// What is in reach of a block of particles.
typedef struct SimNear {
  bool container;
  int32_t count;               ///< of bodies, −1: look at all
  int32_t body[SIM_MAX_NEAR];  ///< (count), indices, growing
} SimNear;

/// Whether any wall or body may be in reach of a point of the box, by its share or by a move that stays within `margin`
/// (m, at least 0) of the box, while the bodies move from their old poses to their new ones; and which.
bool sim_boundary_select(const SimBoundary *boundary, const float low[3], const float high[3], float margin,
                         SimNear *near);

/// Share of the density sum and what goes with it, of the bodies in their new poses. `near` may be NULL.
void sim_boundary_solid(const SimBoundary *boundary, const SimNear *near, const float point[3], SimSolid *solid);

/// Correct a move from a valid place `from` (of the start of the substep, bodies in their old poses) to `to` (at its
/// end): stop at obstacles, slide along them, keep clear of all walls. Where a body moved onto the particle, it is
/// pushed ahead. Returns the floating body that had a say, −1: none. `near` may be NULL. A NaN stays a NaN.
int32_t sim_boundary_clamp(const SimBoundary *boundary, const SimNear *near, const float from[3], float to[3]);

/// Whether a body stands wholly outside of the container's walls, as far as the box around it tells.
bool sim_boundary_beyond(const SimContainer *container, const SimBody *body, float tolerance);

/// Whether a particle may start here: inside the container, touching no wall or obstacle by more than a tenth of the
/// clearance.
bool sim_boundary_free(const SimBoundary *boundary, const float point[3]);

/// Move a point into the container until it is `clearance` (m) away from the walls; a NaN stays a NaN.
void sim_boundary_into_container(const SimBoundary *boundary, float clearance, float point[3]);

#endif
