// The iso-surface of a field as a closed triangle mesh.
//
// Marching tetrahedra: each cube of a regular grid is cut into six tetrahedra around its diagonal (Freudenthal's
// subdivision, in which neighbouring cubes agree), and the surface crosses each tetrahedron in one or two triangles. Unlike
// marching cubes there is no ambiguous case, so the mesh is closed and oriented by construction.
#ifndef LIDO_TESTS_REFERENCE_SURFACE_H
#define LIDO_TESTS_REFERENCE_SURFACE_H

#include "tests/reference/field.h"

typedef struct Surface {
  int32_t vertex_count, triangle_count;
  Vec *vertex;       ///< m, on the iso-surface
  Vec *normal;       ///< unit, outwards, from the field
  int32_t *triangle; ///< (triangle_count, 3), outwards by the right-hand rule
} Surface;

/// `step`: edge of the grid's cubes, m. false: no memory, or the grid would be too large.
bool surface_create(Surface *surface, const Field *field, double step);
void surface_destroy(Surface *surface);

/// m³ inside
double surface_volume(const Surface *surface);

#endif
