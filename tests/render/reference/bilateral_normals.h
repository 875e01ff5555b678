// A bilateral filter of normals over a picture, the slow twin: every pixel of the window has its share.
//
// Based on: Aurich & Weule, Non-linear Gaussian filters performing edge preserving diffusion, 1995, as Xiao, Zhang & Yang
// 2017 want it at the end of section 3.3.
#ifndef LIDO_TESTS_RENDER_REFERENCE_BILATERAL_NORMALS_H
#define LIDO_TESTS_RENDER_REFERENCE_BILATERAL_NORMALS_H

#include <stdint.h>

typedef struct BilateralNormals {
  int32_t width, height;
  double tan_y; ///< tangent of half the vertical angle of view
  double reach; ///< m, half of the window; the standard deviation in space is half of it
  double angle; ///< standard deviation of normals, as the length of their difference
} BilateralNormals;

/// depth: m along the view axis, (height, width), 0 where there is no surface, the sign does not matter; normal: unit, in any
/// axes, (height, width, 3).
void bilateral_normals(const BilateralNormals *filter, const float *depth, const float *normal, float *filtered);

#endif
