// Solid bodies as signed distances, and the share of a particle's neighbourhood that they fill.
#ifndef LIDO_SIM_OBSTACLES_H
#define LIDO_SIM_OBSTACLES_H

#include <stdbool.h>

#include "sim/frame.h"
#include "sim/wall.h"

/// An obstacle with its rotation as a matrix.
typedef struct SimBody {
  SimShape shape;
  float half[3];      ///< m: box, half edges; sphere, radius; cylinder, radius and half height
  float position[3];
  float rotation[9];  ///< row-major, from the body's axes to the world's
  float bound;        ///< m, radius of a ball around the body
  bool moves, floats; ///< the rest is only read where `moves` is set
  float friction;     ///< [0, 1]
  float velocity[3];  ///< m/s, of the centre, during the present substep
  float spin[3];      ///< rad/s, about the centre, in the world's axes
  float old_position[3], old_rotation[9]; ///< the pose at the start of the substep; position and rotation are its end
} SimBody;

/// The body of an obstacle; its quaternion is normalised.
SimBody sim_body_make(const SimObstacle *obstacle);

/// Signed distance of a point to the body's surface (negative inside), m, and the unit normal: the direction away from
/// the body in which the distance grows.
float sim_body_distance(const SimBody *body, const float point[3], float normal[3]);

/// The share of the density sum that a lattice filling the body would give at a point, in [0, 1], and its gradient (1/m).
float sim_body_solid(const SimBody *body, const SimWall *wall, const float point[3], float gradient[3]);

#endif
