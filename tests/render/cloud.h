// Bodies of water of a few thousand particles, made by hand for the tests of the style "raycast".
#ifndef LIDO_TESTS_RENDER_CLOUD_H
#define LIDO_TESTS_RENDER_CLOUD_H

#include "tests/render/water.h"

enum { CLOUD_MOST = 16000 };

typedef struct Cloud {
  float particle_radius; ///< m
  int32_t count;
  float position[3 * CLOUD_MOST], colour[3 * CLOUD_MOST], radius[CLOUD_MOST];
} Cloud;

Cloud *cloud_create(float particle_radius); ///< to be freed
void cloud_add(Cloud *cloud, float x, float y, float z);

/// The same disorder every time: uniform in [−1, 1].
float cloud_noise(uint32_t *seed);

/// A lattice of nx × ny × nz particles around the origin, each moved by up to `disorder` spacings along each axis.
void cloud_add_block(Cloud *cloud, int nx, int ny, int nz, float disorder);
/// What of a lattice is in a ball around (middle_x, 0, 0); in spacings.
void cloud_add_ball(Cloud *cloud, float middle_x, float radius);

/// Which arrays of its own the frame has.
enum { CLOUD_PLAIN = 0, CLOUD_COLOURS = 1, CLOUD_RADII = 2 };
/// Without the surface stages, which the style has no need of. `container` NULL: none.
TestWater cloud_water(const Cloud *cloud, unsigned own, const SimContainer *container);

#endif
