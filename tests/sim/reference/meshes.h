// Closed meshes for tests, and slow twins of what the simulator asks of a mesh.
#ifndef LIDO_TEST_SIM_MESHES_H
#define LIDO_TEST_SIM_MESHES_H

#include "sim/frame.h"

/// A mesh that owns its arrays; `view` is what the simulator takes.
typedef struct TestMesh {
  float *vertex;
  int32_t *triangle;
  SimMesh view;
} TestMesh;

void test_mesh_free(TestMesh *mesh);

TestMesh test_mesh_tetrahedron(float size);
TestMesh test_mesh_box(const float half[3]);
/// The flight of SIM_STAIRS with these half edges.
TestMesh test_mesh_stairs(const float half[3], int32_t steps);
/// An octahedron whose triangles are quartered `rounds` times, its corners pushed out to the ball.
TestMesh test_mesh_ball(float radius, int rounds);
/// A ring around y: a tube of radius `small` around the circle of radius `large`.
TestMesh test_mesh_ring(float large, float small, int around, int along);

/// Least distance to any triangle, m.
double reference_mesh_distance(const SimMesh *mesh, const double point[3]);
/// Whether the triangles wind around the point, by the sum of their solid angles (van Oosterom, Strackee, 1983).
bool reference_mesh_inside(const SimMesh *mesh, const double point[3]);

#endif
