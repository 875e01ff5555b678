#include "sim_test.h"

#include "sim/obstacles.h"

double test_random(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (double)(*state >> 11) / 9007199254740992.0;
}

SimWorldDef test_def(const float container[3], SimBlockDef *block, const float block_size[3]) {
  SimWorldDef def = sim_default_world_def();
  def.particle_radius = 0.025f;
  def.threads = 1; // tests of threads set more
  *block = (SimBlockDef){{0, 0, 0}, {block_size[0], block_size[1], block_size[2]}, {0, 0, 0}, {0, 0, 0}};
  memcpy(def.container.max, container, sizeof def.container.max);
  def.block_count = 1;
  def.blocks = block;
  return def;
}

SimWorld *test_create(const SimWorldDef *def) {
  SimError error = {""};
  SimWorld *world = sim_world_create(def, &error);
  if (!world) fail_msg("%s", error.message);
  return world;
}

void test_advance(SimWorld *world, int frames) {
  SimError error = {""};
  for (int f = 0; f < frames; f++)
    if (!sim_world_advance(world, 1.0 / 60, &error)) fail_msg("%s", error.message);
}

const SimFrame *test_frame(SimWorld *world, unsigned needs, SimFrameBuffer *buffer) {
  SimError error = {""};
  const SimFrame *frame = sim_world_frame(world, needs, buffer, &error);
  if (!frame) fail_msg("%s", error.message);
  return frame;
}

static uint64_t hash_bytes(uint64_t hash, const void *data, size_t bytes) {
  const unsigned char *byte = data;
  for (size_t k = 0; k < bytes; k++) hash = (hash ^ byte[k]) * 1099511628211u;
  return hash;
}

uint64_t test_hash(const SimFrame *frame) {
  size_t n = (size_t)frame->count;
  uint64_t hash = hash_bytes(14695981039346656037u, frame->id, n * sizeof(uint32_t));
  hash = hash_bytes(hash, frame->position, 3 * n * sizeof(float));
  hash = hash_bytes(hash, frame->velocity, 3 * n * sizeof(float));
  return hash_bytes(hash, frame->density, n * sizeof(float));
}

uint64_t test_hash_surface(const SimFrame *frame, uint64_t hash) {
  size_t n = (size_t)frame->count, nodes = (size_t)(frame->height_field.size[0] * frame->height_field.size[1]);
  hash = hash_bytes(hash, frame->particle_class, n);
  hash = hash_bytes(hash, frame->near_surface, n);
  hash = hash_bytes(hash, frame->smoothed, 3 * n * sizeof(float));
  hash = hash_bytes(hash, frame->ellipsoid, 6 * n * sizeof(float));
  hash = hash_bytes(hash, frame->height_field.height, nodes * sizeof(float));
  hash = hash_bytes(hash, frame->height_field.underside, nodes * sizeof(float));
  hash = hash_bytes(hash, frame->height_field.second, nodes * sizeof(float));
  return hash_bytes(hash, frame->height_field.normal, 3 * nodes * sizeof(float));
}

float *test_lattice(int nx, int ny, int nz, double spacing, double jitter, uint64_t seed) {
  float *position = malloc(3 * sizeof(float) * (size_t)(nx * ny * nz));
  size_t at = 0;
  for (int z = 0; z < nz; z++)
    for (int y = 0; y < ny; y++)
      for (int x = 0; x < nx; x++) {
        const int index[3] = {x, y, z};
        for (int k = 0; k < 3; k++)
          position[at++] = (float)(spacing * (index[k] + 0.5 + jitter * (2 * test_random(&seed) - 1)));
      }
  return position;
}

void test_inside_container(const SimFrame *frame) {
  for (int32_t i = 0; i < frame->count; i++)
    for (int k = 0; k < 3; k++) {
      float x = frame->position[3 * i + k];
      if (!(x >= frame->container.min[k] && x <= frame->container.max[k]))
        fail_msg("frame %lld: particle %u is at %g along axis %d", (long long)frame->index, frame->id[i], (double)x, k);
    }
}

void test_outside_obstacles(const SimFrame *frame) {
  for (int32_t b = 0; b < frame->obstacle_count; b++) {
    SimBody body = sim_body_make(&frame->obstacles[b], NULL);
    for (int32_t i = 0; i < frame->count; i++) {
      float normal[3], gap = sim_body_distance(&body, &frame->position[3 * i], normal);
      if (!(gap >= -0.2f * frame->particle_radius))
        fail_msg("frame %lld: particle %u is %g m inside obstacle %d", (long long)frame->index, frame->id[i], (double)-gap, b);
    }
  }
}
