// Frames of water with the surface stages done, and what the style "refraction" makes of them.
#ifndef LIDO_TESTS_RENDER_WATER_H
#define LIDO_TESTS_RENDER_WATER_H

#include "sim/sim.h"
#include "tests/render/harness.h"
#include "tests/render/reference/splat.h"

/// Particles with classes, ellipsoids and flags.
typedef struct TestWater {
  SimFrame frame;
  SimFrameBuffer *buffer;
} TestWater;

/// `container` NULL: none.
TestWater test_water_create(const float *position, int32_t count, float particle_radius, const SimContainer *container);
void test_water_destroy(TestWater *water);

/// The camera's truth for a view.
Pinhole water_pinhole(const RenderView *view, int32_t width, int32_t height);

/// Aggregated water as the renderer has it: depths (m) and outward normals in view space, 0 where there is none.
typedef struct WaterMaps {
  SplatMap side[2]; ///< front, back
} WaterMaps;
WaterMaps water_maps_draw(Harness *harness, const SimFrame *frame, const RenderView *view,
                          const RenderSettings *settings);
void water_maps_destroy(WaterMaps *maps);

#endif
