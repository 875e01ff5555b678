// Whether a triangle mesh is the surface of a solid, and which of its triangles meet in an edge.
#ifndef LIDO_SIM_MESH_TOPOLOGY_H
#define LIDO_SIM_MESH_TOPOLOGY_H

#include "sim/sim.h"

#define SIM_MESH_MAX_TRIANGLES 4000000
#define SIM_MESH_MAX_VERTICES 12000000

/// Whether the mesh is closed, consistently oriented, finite and turned outwards; otherwise *error says where it is not,
/// with `name` in front.
bool sim_mesh_check(const SimMesh *mesh, const char *name, SimError *error);

/// What is wrong with an edge of a mesh.
typedef enum SimMeshFault {
  SIM_MESH_CLOSED,
  SIM_MESH_OPEN,     ///< an edge of one triangle only
  SIM_MESH_BRANCHES, ///< an edge of more than two
  SIM_MESH_TWISTED,  ///< two triangles pass through an edge in the same direction
  SIM_MESH_NO_MEMORY
} SimMeshFault;

/// neighbour[3 t + j] = the triangle on the other side of the edge from corner j of triangle t to the next corner. All
/// indices must be in range. At a fault, edge[] has the two vertices of the first edge where it was found.
SimMeshFault sim_mesh_neighbours(const SimMesh *mesh, int32_t *neighbour, int32_t edge[2]);

/// m³, negative for a mesh that is turned inside out.
double sim_mesh_volume(const SimMesh *mesh);

#endif
