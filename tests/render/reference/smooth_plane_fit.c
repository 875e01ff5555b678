// Smoothing by local planes, as published. Imai, Kanamori & Mitani, Real-Time Screen-Space Liquid Rendering with Complex
// Refractions, 2016, section 4.3, Eqs. 1–5.
//
// The plane through the weighted mean of the neighbours' points (Eq. 4) with the weighted mean of the particles' normals
// (Eq. 3) is met by the pixel's ray (Eq. 5). Depths change from iteration to iteration, normals do not.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/render/reference/smooth.h"

// Distance of neighbouring taps in pixels around a point of this depth.
static double stride_at(const SmoothInput *input, const SmoothPlaneFit *p, double depth) {
  if (p->reach <= 0) return 1;
  return fmax(1, p->reach * input->radius / (lens_pixel(&input->lens) * depth) / (p->window / 2));
}

static double weight(const SmoothPlaneFit *p, double sigma, const double a[3], const double b[3]) {
  double d2 = (a[2] - b[2]) * (a[2] - b[2]);
  if (p->view_independent) d2 += (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]);
  return exp(-d2 / (sigma * sigma));
}

static double fit(const SmoothInput *input, const SmoothPlaneFit *p, const float *depth, int32_t column, int32_t row) {
  const Lens *lens = &input->lens;
  const double z = (double)depth[(size_t)row * (size_t)lens->width + (size_t)column];
  const double ray[3] = {lens_x(lens, column), lens_y(lens, row), -1};
  const double own[3] = {z * ray[0], z * ray[1], -z}, stride = stride_at(input, p, z);
  double sum = 0, mean[3] = {0}, normal[3] = {0};
  for (int32_t b = -p->window / 2; b <= p->window / 2; ++b) {
    for (int32_t a = -p->window / 2; a <= p->window / 2; ++a) {
      const int32_t x = column + (int32_t)lround(a * stride), y = row + (int32_t)lround(b * stride);
      if (x < 0 || y < 0 || x >= lens->width || y >= lens->height) continue;
      const size_t j = (size_t)y * (size_t)lens->width + (size_t)x;
      const double zj = (double)depth[j], point[3] = {zj * lens_x(lens, x), zj * lens_y(lens, y), -zj};
      if (zj <= 0) continue;
      const double w = weight(p, p->sigma * input->radius, own, point);
      sum += w;
      for (size_t k = 0; k < 3; ++k) {
        mean[k] += w * point[k];
        normal[k] += w * (double)input->normal[3 * j + k];
      }
    }
  }
  double d = 0, along = 0;
  for (int k = 0; k < 3; ++k) {
    d += normal[k] * mean[k] / sum;
    along += normal[k] * ray[k];
  }
  const double fitted = d / along;
  // A plane along the ray, or one met behind the eye, says nothing.
  return fitted > 0 && isfinite(fitted) ? fitted : z;
}

void smooth_plane_fit(const SmoothInput *input, const SmoothPlaneFit *p, float *smoothed) {
  const Lens *lens = &input->lens;
  const size_t pixels = (size_t)lens->width * (size_t)lens->height;
  float *from = malloc(pixels * sizeof *from);
  memcpy(smoothed, input->depth, pixels * sizeof *from);
  for (int32_t iteration = 0; iteration < p->iterations; ++iteration) {
    memcpy(from, smoothed, pixels * sizeof *from);
    for (int32_t row = 0; row < lens->height; ++row)
      for (int32_t column = 0; column < lens->width; ++column) {
        const size_t i = (size_t)row * (size_t)lens->width + (size_t)column;
        if (from[i] > 0) smoothed[i] = (float)fit(input, p, from, column, row);
      }
  }
  free(from);
}
