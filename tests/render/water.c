#include "tests/render/water.h"

#include <stdlib.h>

TestWater test_water_create(const float *position, int32_t count, float particle_radius,
                            const SimContainer *container) {
  const SimParticleSet set = {.count = count, .position = position, .particle_radius = particle_radius};
  TestWater water = {.buffer = sim_frame_buffer_create()};
  SimError error = {0};
  const SimFrame *frame =
      sim_frame_from_particles(&set, SIM_NEED_CLASS | SIM_NEED_ANISOTROPY | SIM_NEED_SURFACE, 1, water.buffer, &error);
  if (frame == NULL) fail_msg("%s", error.message);
  water.frame = *frame;
  water.frame.has_container = container != NULL;
  if (container != NULL) water.frame.container = *container;
  return water;
}

void test_water_destroy(TestWater *water) {
  sim_frame_buffer_destroy(water->buffer);
  *water = (TestWater){0};
}

Pinhole water_pinhole(const RenderView *view, int32_t width, int32_t height) {
  return pinhole_make(view->eye, view->target, view->vertical_fov, width, height);
}

WaterMaps water_maps_draw(Harness *harness, const SimFrame *frame, const RenderView *view,
                          const RenderSettings *settings) {
  static const char *const names[2][2] = {{"front_depth", "front_normal"}, {"back_depth", "back_normal"}};
  const Pinhole pinhole = water_pinhole(view, harness->width, harness->height);
  const size_t pixels = (size_t)harness->width * (size_t)harness->height;
  WaterMaps maps;
  for (int side = 0; side < 2; ++side) {
    maps.side[side].depth = harness_layer(harness, names[side][0], 1, frame, view, settings);
    maps.side[side].normal = harness_layer(harness, names[side][1], 3, frame, view, settings);
    for (size_t i = 0; i < pixels; ++i) {
      float *normal = maps.side[side].normal + 3 * i;
      const double world[3] = {(double)normal[0], (double)normal[1], (double)normal[2]};
      double turned[3];
      pinhole_to_view(&pinhole, world, turned);
      for (int k = 0; k < 3; ++k) normal[k] = (float)turned[k];
    }
  }
  return maps;
}

void water_maps_destroy(WaterMaps *maps) {
  for (int side = 0; side < 2; ++side) splat_map_destroy(&maps->side[side]);
}
