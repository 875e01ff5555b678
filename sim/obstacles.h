// Solid bodies as signed distances, and the share of a particle's neighbourhood that they fill.
#ifndef LIDO_SIM_OBSTACLES_H
#define LIDO_SIM_OBSTACLES_H

#include <stdbool.h>

#include "sim/frame.h"
#include "sim/mesh_distance.h"
#include "sim/wall.h"

/// An obstacle with its rotation as a matrix.
typedef struct SimBody {
  SimShape shape;
  float half[3];      ///< m: box, stairs: half edges; sphere: radius; cylinder, capsule: radius and half the full height
  int32_t steps;      ///< stairs
  const SimMeshDistance *mesh; ///< mesh; whoever makes the body sets it (world.c)
  float position[3];
  float rotation[9];  ///< row-major, from the body's axes to the world's
  float bound;        ///< m, radius of a ball around the body
  bool moves, floats; ///< the rest, but for friction, is only read where `moves` is set
  bool beyond;        ///< it stands outside of the container: no particle meets it
  float friction;     ///< [0, 1]
  float velocity[3];  ///< m/s, of the centre, during the present substep
  float spin[3];      ///< rad/s, about the centre, in the world's axes
  float old_position[3], old_rotation[9]; ///< the pose at the start of the substep; position and rotation are its end
} SimBody;

/// The body of an obstacle; its quaternion is normalised. For a mesh, `mesh` is what was made of obstacle->mesh, else
/// NULL.
SimBody sim_body_make(const SimObstacle *obstacle, const SimMeshDistance *mesh);

/// Signed distance of a point to the body's surface (negative inside), m, and the unit normal: the direction away from
/// the body in which the distance grows. Exact, for a mesh see sim_mesh_distance.
float sim_body_distance(const SimBody *body, const float point[3], float normal[3]);

/// The same in the body's own axes.
float sim_body_local_distance(const SimBody *body, const float point[3], float normal[3]);

/// The share of the density sum that a lattice filling the body would give at a point, in [0, 1], and its gradient
/// (1/m).
float sim_body_solid(const SimBody *body, const SimWall *wall, const float point[3], float gradient[3]);

/// The axis-aligned box around the body, m.
void sim_body_box(const SimBody *body, float low[3], float high[3]);

/// A vector of the world in axes turned by `rotation`, and back.
void sim_to_local(const float rotation[9], const float vector[3], float local[3]);
void sim_to_world(const float rotation[9], const float local[3], float vector[3]);

/// Distance from the excesses over the half sizes along `axes` (2 or 3) directions at right angles, and the normal in
/// them: outside the length of the positive ones, inside the largest.
float sim_rounded_distance(const float excess[3], int axes, float normal[3]);

#endif
