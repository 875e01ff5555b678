// Frames made by hand for the renderer's tests: no simulator needed.
#ifndef LIDO_TESTS_RENDER_FRAMES_H
#define LIDO_TESTS_RENDER_FRAMES_H

#include "sim/frame.h"

/// A frame that owns its arrays.
typedef struct TestFrame {
  SimFrame frame;
  float *position, *velocity, *density;
  uint32_t *id;
  SimObstacle obstacles[8];
  SimMesh *mesh; // one that obstacles may show, freed with the frame; or NULL
} TestFrame;

/// `capacity` particles of room, none there yet, in a tank of 3 × 1.6 × 1 m.
TestFrame *test_frame_create(int32_t capacity, float particle_radius);
void test_frame_destroy(TestFrame *frame);
void test_frame_add(TestFrame *frame, float x, float y, float z);

/// A pool with waves and some drops above it, about 20,000 particles of radius 0.0175 m.
TestFrame *test_frame_pool(void);
/// The pool with stairs, a capsule and a ring of triangles in it.
TestFrame *test_frame_shapes(void);
/// A glass of water, 8 cm wide and 13 cm high.
TestFrame *test_frame_glass(void);

/// Arrays of zeros; the caller fills them.
SimMesh *test_mesh_create(int32_t vertex_count, int32_t triangle_count);
void test_mesh_destroy(SimMesh *mesh);
/// A ring around y; `radius` is its middle's.
SimMesh *test_mesh_torus(float radius, float thickness, int32_t around, int32_t across);

#endif
