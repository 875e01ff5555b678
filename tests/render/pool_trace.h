// The light that an eye sees of a pool with bodies in it, computed in double precision: rays split by Snell's and Fresnel's laws
// wherever they meet the water, from above, through the tank's sides or from within, and are absorbed and scattered in it.
//
// The surroundings are the pinned ones of tests/reference/environment.h.
#ifndef LIDO_TESTS_RENDER_POOL_TRACE_H
#define LIDO_TESTS_RENDER_POOL_TRACE_H

#include "tests/reference/environment.h"
#include "tests/render/harness.h"

/// y = level + height · sin(turn · (x, z)), m and 1/m.
typedef struct PoolWave {
  double level, height, turn[2];
} PoolWave;
double pool_wave_at(double x, double z, const void *wave);

/// Water from the floor up to its surface, between the walls of a box.
typedef struct PoolTrace {
  Environment environment;
  SimContainer container;
  PoolWave wave;
  double index;
  Vec absorption, scattering, glow; ///< 1/m; what scatters in deep water
  double slant;                     ///< m of refracted sunlight for each metre of depth; 1 without a sun
} PoolTrace;
PoolTrace pool_trace_create(const SimFrame *frame, const RenderSettings *settings, PoolWave wave);
void pool_trace_destroy(PoolTrace *pool);

/// (height, width, 3), linear light; to be freed. `water`: (height, width), 1 where the eye sees water first, or lies in it;
/// NULL allowed.
float *pool_trace_picture(const PoolTrace *pool, const RenderView *view, int32_t width, int32_t height, uint8_t *water);

/// How far a picture is from the truth in each pixel: the largest of its three channels, 1/255.
typedef struct PoolDifference {
  double mean, median, most; // most: that of 95 %
  int32_t pixels;
} PoolDifference;
/// Where `mask` is not 0.
PoolDifference pool_difference(const uint8_t *drawn, const float *truth, const uint8_t *mask, size_t pixels);
PoolDifference pool_difference_drawn(const uint8_t *a, const uint8_t *b, const uint8_t *mask, size_t pixels);

#endif
