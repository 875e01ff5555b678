// Smoothing of depth maps, the slow twins: what bumpy particles leave becomes a smooth surface. Every filter reads a map
// of depths along the view axis (m, 0 where there is nothing) and writes another; pixels without a depth stay without.
#ifndef LIDO_TESTS_RENDER_REFERENCE_SMOOTH_H
#define LIDO_TESTS_RENDER_REFERENCE_SMOOTH_H

#include <stdbool.h>

#include "tests/render/reference/pinhole.h"

typedef struct SmoothInput {
  Lens lens;
  double radius;       ///< m, of a particle
  const float *depth;  ///< m, (height, width)
  const float *normal; ///< unit, (height, width, 3), of the particles, view space; only smooth_plane_fit reads it
} SmoothInput;

/// Iterated local plane fitting (Imai et al. 2016, section 4.3).
typedef struct SmoothPlaneFit {
  int32_t window; ///< taps along each side, odd
  double reach;   ///< half of the window in particle radii on the spot; 0: `window` pixels next to each other
  int32_t iterations;
  double sigma;          ///< of the weights, in particle radii (the paper: 5.3)
  bool view_independent; ///< weights by the distance of points instead of depths
} SmoothPlaneFit;
void smooth_plane_fit(const SmoothInput *input, const SmoothPlaneFit *parameters, float *smoothed);

/// Iterated bilateral filter (Green 2010; Imai et al. 2014), the baseline.
typedef struct SmoothBilateral {
  int32_t window; ///< pixels along each side, odd
  int32_t iterations;
  double range; ///< standard deviation of the depths, in particle radii
} SmoothBilateral;
void smooth_bilateral(const SmoothInput *input, const SmoothBilateral *parameters, float *smoothed);

/// Narrow-range filter (Truong & Yuksel 2018).
typedef struct SmoothNarrowRange {
  int32_t taps;       ///< on either side of the middle
  double reach;       ///< half of the window in particle radii on the spot
  int32_t iterations; ///< of a pass along rows and one along columns
  int32_t cleanup;    ///< half of the last, two-dimensional window in pixels
  double threshold;   ///< δ in particle radii
  double clamp;       ///< μ in particle radii
} SmoothNarrowRange;
void smooth_narrow_range(const SmoothInput *input, const SmoothNarrowRange *parameters, float *smoothed);
/// The front and, if count is 2, the back of the same pixels: the taps of both are spaced by the front's windows.
void smooth_narrow_range_sides(const SmoothInput side[], int32_t count, const SmoothNarrowRange *parameters,
                               float *const smoothed[]);

/// Regression of the inverse depth along rows, then columns (smooth_regression.c).
typedef struct SmoothStep {
  int32_t taps;     ///< on either side of the middle
  double reach;     ///< half of the window in particle radii on the spot
  double too_small; ///< half of a window in pixels below which the step leaves a pixel as it is; 0: never
} SmoothStep;
enum { SMOOTH_REGRESSION_STEPS = 9 };
typedef struct SmoothRegression {
  int32_t step_count;
  SmoothStep steps[SMOOTH_REGRESSION_STEPS];
  double range; ///< depths that differ by this many particle radii do not count
} SmoothRegression;
extern const SmoothRegression smooth_regression_default; ///< 62 taps a pixel
/// The default where a particle's radius covers at most `largest` pixels: with more taps and finer steps near the eye.
SmoothRegression smooth_regression_near(double largest);
void smooth_regression(const SmoothInput *input, const SmoothRegression *parameters, float *smoothed);

/// Unit normals of a depth map in view space, towards the viewer; (height, width, 3), 0 where there is nothing.
void smooth_normals(const Lens *lens, double radius, const float *depth, float *normal);

#endif
