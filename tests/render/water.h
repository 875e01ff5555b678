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
/// The same of particles with colours or radii of their own.
TestWater test_water_from_set(const SimParticleSet *set, const SimContainer *container);
/// A pool at rest in a container that begins at the origin, filled up to a level (m): columns with some disorder, in rows,
/// or in rings in a round container; the outermost lie a radius inside the walls.
TestWater test_water_pool(const SimContainer *container, float radius, float level);
/// The same as Lido's simulation leaves it: 2 s after a disordered lattice was let go. The level is that of the lattice, which
/// fills the container's box or, in a round one, the square in it.
TestWater test_water_settled(const SimContainer *container, float radius, float level);
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
/// One of its sides.
SplatMap water_map_draw(Harness *harness, SplatSide side, const SimFrame *frame, const RenderView *view,
                        const RenderSettings *settings);

/// How two maps differ: depths in radii, normals as lengths, each up to which 99.9 % of the pixels with a depth in both lie.
typedef struct WaterDifference {
  double depth, normal, largest_depth, largest_normal;
  size_t both, one; ///< pixels with a depth in both, in one of them
} WaterDifference;
/// Fails the test where hardly a pixel has a depth in both.
WaterDifference water_maps_compare(const SplatMap *a, const SplatMap *b, size_t pixels, double radius);
void water_difference_print(const char *what, SplatSide side, const WaterDifference *difference);
/// Fails the test where two maps of the particles as they are differ by more than rounding. Where a ray grazes an
/// ellipsoid, its depth is the root of a small difference: the few such pixels may be off by more.
void water_expect_raw(const char *what, SplatSide side, const SplatMap *got, const SplatMap *want, size_t pixels,
                      double radius);

#endif
