// The baseline: an iterated bilateral filter on depths. Green, Screen Space Fluid Rendering for Games, GDC 2010; iterated:
// Imai et al., Real-Time Screen-Space Liquid Rendering with Two-Sided Refractions, 2014.
//
// The full two-dimensional window; the spatial standard deviation is a third of its half.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/render/reference/smooth.h"

static double average(const SmoothInput *input, const SmoothBilateral *p, const float *depth, int32_t column,
                      int32_t row) {
  const Lens *lens = &input->lens;
  const int32_t half = p->window / 2;
  const double z = (double)depth[(size_t)row * (size_t)lens->width + (size_t)column];
  const double spatial = half / 3.0, range = p->range * input->radius;
  double sum = 0, weights = 0;
  for (int32_t y = row - half; y <= row + half; ++y) {
    for (int32_t x = column - half; x <= column + half; ++x) {
      if (x < 0 || y < 0 || x >= lens->width || y >= lens->height) continue;
      const double zj = (double)depth[(size_t)y * (size_t)lens->width + (size_t)x];
      if (zj <= 0) continue;
      const double d2 = (x - column) * (x - column) + (y - row) * (y - row), dz = zj - z;
      const double w = exp(-d2 / (2 * spatial * spatial) - dz * dz / (2 * range * range));
      sum += w * zj;
      weights += w;
    }
  }
  return sum / weights;
}

void smooth_bilateral(const SmoothInput *input, const SmoothBilateral *p, float *smoothed) {
  const Lens *lens = &input->lens;
  const size_t pixels = (size_t)lens->width * (size_t)lens->height;
  float *from = malloc(pixels * sizeof *from);
  memcpy(smoothed, input->depth, pixels * sizeof *from);
  for (int32_t iteration = 0; iteration < p->iterations; ++iteration) {
    memcpy(from, smoothed, pixels * sizeof *from);
    for (int32_t row = 0; row < lens->height; ++row)
      for (int32_t column = 0; column < lens->width; ++column) {
        const size_t i = (size_t)row * (size_t)lens->width + (size_t)column;
        if (from[i] > 0) smoothed[i] = (float)average(input, p, from, column, row);
      }
  }
  free(from);
}
