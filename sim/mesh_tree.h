// A tree of boxes over the triangles of a closed mesh: the nearest surface point, and the first triangle on a path.
#ifndef LIDO_SIM_MESH_TREE_H
#define LIDO_SIM_MESH_TREE_H

#include "sim/frame.h"

typedef struct SimMeshTree {
  int32_t triangle_count;
  int32_t leaves;          ///< a power of two; leaf l has the triangles l·n/leaves … (l + 1)·n/leaves − 1 of `order`
  int32_t *order;          ///< (n), indices of triangles along a space-filling curve
  float (*corner)[9];      ///< m, (n, 3, 3), in the order of `order`
  float (*normal)[3];      ///< unit, of the triangles, (n), by triangle; 0 where a triangle has no area
  float (*vertex_normal)[3]; ///< (vertices): normals of the triangles around, weighted by their angles
  int32_t *triangle;       ///< (n, 3), a copy of the mesh's
  int32_t *neighbour;      ///< (n, 3), see sim_mesh_neighbours
  float (*box)[6];         ///< m, (2 leaves − 1): min and max; node k has the children 2k + 1 and 2k + 2
} SimMeshTree;

/// false when there is no memory; then, too, the tree must be freed. The mesh has passed sim_mesh_check.
bool sim_mesh_tree_make(SimMeshTree *tree, const SimMesh *mesh);
void sim_mesh_tree_free(SimMeshTree *tree);

/// The exact signed distance to the mesh, m, and the unit normal: the direction in which it grows. *hint is a place in
/// `order` to begin with (any; a near one is faster) and becomes that of the nearest triangle.
float sim_mesh_tree_distance(const SimMeshTree *tree, const float point[3], int32_t *hint, float normal[3]);

/// Whether the segment passes a triangle from outside to inside. The first one that it meets is at from + *t (to −
/// from), with the unit normal given.
bool sim_mesh_tree_hit(const SimMeshTree *tree, const float from[3], const float to[3], float *t, float normal[3]);

#endif
