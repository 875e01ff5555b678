#include "tests/render/frames.h"

#include <math.h>
#include <stdlib.h>

TestFrame *test_frame_create(int32_t capacity, float particle_radius) {
  TestFrame *t = calloc(1, sizeof *t);
  const size_t n = (size_t)capacity + 1;
  t->position = calloc(3 * n, sizeof(float));
  t->velocity = calloc(3 * n, sizeof(float));
  t->density = calloc(n, sizeof(float));
  t->id = calloc(n, sizeof(uint32_t));
  t->frame = (SimFrame){
      .particle_radius = particle_radius,
      .position = t->position,
      .velocity = t->velocity,
      .density = t->density,
      .id = t->id,
      .bounds_max = {3, 1.6f, 1},
      .container = {{0, 0, 0}, {3, 1.6f, 1}},
      .has_container = true,
      .obstacles = t->obstacles,
  };
  return t;
}

void test_frame_destroy(TestFrame *t) {
  if (t == NULL) return;
  free(t->position);
  free(t->velocity);
  free(t->density);
  free(t->id);
  test_mesh_destroy(t->mesh);
  free(t);
}

void test_frame_add(TestFrame *t, float x, float y, float z) {
  const size_t i = (size_t)t->frame.count++;
  t->position[3 * i] = x;
  t->position[3 * i + 1] = y;
  t->position[3 * i + 2] = z;
  t->density[i] = 1000;
  t->id[i] = (uint32_t)i;
}

static float wave_height(float x, float z) {
  return 0.24f + 0.05f * sinf(4.2f * x + 0.6f) * cosf(2.1f * z) + 0.02f * sinf(9 * x + 5 * z) +
         0.55f * expf(-4 * x * x);
}

TestFrame *test_frame_pool(void) {
  const float spacing = 0.035f;
  TestFrame *t = test_frame_create(40000, spacing / 2);
  for (int k = 0; k < 28; ++k) {
    for (int i = 0; i < 85; ++i) {
      const float x = spacing * ((float)i + 0.5f), z = spacing * ((float)k + 0.5f);
      for (float y = spacing / 2; y < wave_height(x, z); y += spacing) {
        // A little disorder, the same every time.
        const float wobble = 0.2f * spacing;
        test_frame_add(t, x + wobble * sinf(91 * y + 37 * z), y + wobble * sinf(57 * x + 83 * z),
                       z + wobble * sinf(71 * x + 47 * y));
      }
    }
  }
  // A fan of drops, fast and far apart.
  for (int i = 0; i < 160; ++i) {
    const float a = 0.04f * (float)i, r = 0.25f + 0.004f * (float)i;
    const int32_t n = t->frame.count;
    test_frame_add(t, 1.9f + r * cosf(a * 7), 0.45f + 0.5f * fabsf(sinf(3.7f * a)), 0.5f + 0.45f * sinf(a * 5));
    t->density[n] = 350;
    t->velocity[3 * n] = 3.5f;
  }
  return t;
}

// ---- Every shape of body ---------------------------------------------------------------------------------------------

SimMesh *test_mesh_create(int32_t vertex_count, int32_t triangle_count) {
  SimMesh *mesh = calloc(1, sizeof *mesh);
  mesh->vertex_count = vertex_count;
  mesh->triangle_count = triangle_count;
  mesh->vertex = calloc(3 * (size_t)vertex_count, sizeof(float));
  mesh->triangle = calloc(3 * (size_t)triangle_count, sizeof(int32_t));
  return mesh;
}

void test_mesh_destroy(SimMesh *mesh) {
  if (mesh == NULL) return;
  free((void *)(uintptr_t)mesh->vertex);
  free((void *)(uintptr_t)mesh->triangle);
  free(mesh);
}

SimMesh *test_mesh_torus(float radius, float thickness, int32_t around, int32_t across) {
  SimMesh *mesh = test_mesh_create(around * across, 2 * around * across);
  float *vertex = (float *)(uintptr_t)mesh->vertex;
  int32_t *triangle = (int32_t *)(uintptr_t)mesh->triangle;
  for (int32_t i = 0; i < around; ++i) {
    for (int32_t k = 0; k < across; ++k) {
      const float a = 6.2831853f * (float)i / (float)around, b = 6.2831853f * (float)k / (float)across;
      const float r = radius + thickness * cosf(b);
      *vertex++ = r * cosf(a);
      *vertex++ = thickness * sinf(b);
      *vertex++ = r * sinf(a);
      const int32_t next_i = (i + 1) % around, next_k = (k + 1) % across;
      const int32_t quad[4] = {i * across + k, i * across + next_k, next_i * across + next_k, next_i * across + k};
      const int32_t corners[6] = {quad[0], quad[1], quad[2], quad[0], quad[2], quad[3]};
      for (int c = 0; c < 6; ++c) *triangle++ = corners[c];
    }
  }
  return mesh;
}

TestFrame *test_frame_shapes(void) {
  TestFrame *t = test_frame_pool();
  t->mesh = test_mesh_torus(0.2f, 0.07f, 48, 24);
  const SimObstacle bodies[] = {
      {SIM_STAIRS, {0.8f, 0.6f, 0.5f}, {2.5f, 0.3f, 0.65f}, {0, 0, 0, 1}, {0.78f, 0.72f, 0.62f}, .steps = 6},
      {SIM_CAPSULE, {0.22f, 0.9f, 0}, {0.75f, 0.55f, 0.4f}, {0, 0, 0.2588190f, 0.9659258f}, {0.8f, 0.35f, 0.2f}},
      {SIM_MESH, {0}, {1.45f, 0.5f, 0.6f}, {0.5f, 0, 0.1f, 0.8602325f}, {0.85f, 0.7f, 0.25f}, .mesh = t->mesh}};
  for (int i = 0; i < 3; ++i) t->obstacles[i] = bodies[i];
  t->frame.obstacle_count = 3;
  return t;
}

TestFrame *test_frame_glass(void) {
  const float spacing = 0.005f, radius = 0.04f;
  TestFrame *t = test_frame_create(40000, spacing / 2);
  t->frame.container = (SimContainer){{0, 0, 0}, {0.08f, 0.13f, 0.08f}, SIM_CONTAINER_GLASS};
  for (int k = 0; k < 3; ++k) t->frame.bounds_max[k] = t->frame.container.max[k];
  for (float z = spacing / 2; z < 2 * radius; z += spacing) {
    for (float x = spacing / 2; x < 2 * radius; x += spacing) {
      if (hypotf(x - radius, z - radius) > radius - spacing / 2) continue;
      const float top = 0.08f + 0.006f * sinf(70 * x) * cosf(50 * z);
      for (float y = spacing / 2; y < top; y += spacing) {
        const float wobble = 0.15f * spacing;
        test_frame_add(t, x + wobble * sinf(910 * y + 370 * z), y + wobble * sinf(570 * x + 830 * z),
                       z + wobble * sinf(710 * x + 470 * y));
      }
    }
  }
  return t;
}
