#include "tests/render/cloud.h"

#include <stdlib.h>
#include <string.h>

Cloud *cloud_create(float particle_radius) {
  Cloud *cloud = calloc(1, sizeof *cloud);
  assert_non_null(cloud);
  cloud->particle_radius = particle_radius;
  return cloud;
}

void cloud_add(Cloud *cloud, float x, float y, float z) {
  const int32_t i = cloud->count++;
  const float p[3] = {x, y, z};
  assert_true(i < CLOUD_MOST);
  memcpy(cloud->position + 3 * i, p, sizeof p);
  cloud->radius[i] = cloud->particle_radius;
}

float cloud_noise(uint32_t *seed) {
  *seed = *seed * 1664525u + 1013904223u;
  return (float)(*seed >> 8) / 8388608.0f - 1;
}

void cloud_add_block(Cloud *cloud, int nx, int ny, int nz, float disorder) {
  const float spacing = 2 * cloud->particle_radius;
  uint32_t seed = 7;
  for (int i = 0; i < nx * ny * nz; ++i) {
    const float at[3] = {(float)(i % nx) - 0.5f * (float)(nx - 1), (float)(i / nx % ny) - 0.5f * (float)(ny - 1),
                         (float)(i / nx / ny) - 0.5f * (float)(nz - 1)};
    const float x = at[0] + disorder * cloud_noise(&seed), y = at[1] + disorder * cloud_noise(&seed);
    cloud_add(cloud, spacing * x, spacing * y, spacing * (at[2] + disorder * cloud_noise(&seed)));
  }
}

void cloud_add_ball(Cloud *cloud, float middle_x, float radius) {
  const float spacing = 2 * cloud->particle_radius;
  const int half = (int)radius + 1;
  for (int i = -half; i <= half; ++i)
    for (int j = -half; j <= half; ++j)
      for (int k = -half; k <= half; ++k) {
        if ((float)(i * i + j * j + k * k) > radius * radius) continue;
        cloud_add(cloud, spacing * ((float)i + middle_x), spacing * (float)j, spacing * (float)k);
      }
}

TestWater cloud_water(const Cloud *cloud, unsigned own, const SimContainer *container) {
  const SimParticleSet set = {.count = cloud->count,
                              .position = cloud->position,
                              .colour = own & CLOUD_COLOURS ? cloud->colour : NULL,
                              .radius = own & CLOUD_RADII ? cloud->radius : NULL,
                              .particle_radius = cloud->particle_radius};
  TestWater water = {.buffer = sim_frame_buffer_create()};
  SimError error = {0};
  const SimFrame *frame = sim_frame_from_particles(&set, SIM_NEED_NOTHING, 1, water.buffer, &error);
  if (frame == NULL) fail_msg("%s", error.message);
  water.frame = *frame;
  water.frame.has_container = container != NULL;
  if (container != NULL) water.frame.container = *container;
  return water;
}
