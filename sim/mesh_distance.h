// A closed triangle mesh as an obstacle: its own copy, its distance and its share of the density sum on a grid.
#ifndef LIDO_SIM_MESH_DISTANCE_H
#define LIDO_SIM_MESH_DISTANCE_H

#include "sim/mesh_tree.h"
#include "sim/wall.h"

typedef struct SimMeshDistance {
  SimMesh mesh;        ///< the copy; belongs to this
  SimMeshTree tree;
  float low[3], high[3]; ///< m, the box around the triangles
  float bound;         ///< m, the farthest vertex from the origin
  float origin[3];     ///< m, of node (0, 0, 0)
  float cell, inverse_cell; ///< m, 1/m
  float band;          ///< m: nearer to the surface, `distance` is exact, farther away a bound with the right sign
  int32_t size[3];     ///< nodes along x, y, z, x running fastest
  float *distance;     ///< m, signed, (size[2], size[1], size[0])
  float *share;        ///< of the density sum, the same shape
} SimMeshDistance;

/// The mesh has passed sim_mesh_check. NULL when memory runs out.
SimMeshDistance *sim_mesh_distance_create(const SimMesh *mesh, const SimWall *wall, int32_t threads);
void sim_mesh_distance_destroy(SimMeshDistance *field); ///< NULL is allowed

/// Signed distance in the mesh's own axes, m, and the unit normal. Exact nearer to the surface than SIM_MESH_EXACT
/// cells and deep inside; interpolated where the density sum sees the mesh; farther outside it is never too large, and
/// the normal is only roughly right.
#define SIM_MESH_EXACT 1.75f
float sim_mesh_distance(const SimMeshDistance *field, const float point[3], float normal[3]);

/// The share of the density sum at a point, and its gradient (1/m).
float sim_mesh_solid(const SimMeshDistance *field, const float point[3], float gradient[3]);

#endif
