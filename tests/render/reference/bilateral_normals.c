#include "tests/render/reference/bilateral_normals.h"

#include <math.h>
#include <stdlib.h>

// The point that a pixel shows, in view space.
static void point_of(const BilateralNormals *f, const float *depth, int32_t x, int32_t y, double p[3]) {
  const double z = fabs((double)depth[y * f->width + x]), tan_x = f->tan_y * f->width / f->height;
  p[0] = z * tan_x * (2 * (x + 0.5) / f->width - 1);
  p[1] = z * f->tan_y * (1 - 2 * (y + 0.5) / f->height);
  p[2] = -z;
}

static double squared_distance(const double a[3], const double b[3]) {
  return pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2);
}

static void filter_pixel(const BilateralNormals *f, const float *depth, const float *normal, int32_t x, int32_t y,
                         float out[3]) {
  const float *n = normal + 3 * (y * f->width + x);
  const double here[3] = {(double)n[0], (double)n[1], (double)n[2]};
  double p[3], sum[3] = {0};
  point_of(f, depth, x, y, p);
  const int32_t half = (int32_t)lround(f->reach / (-p[2] * 2 * f->tan_y / f->height));
  for (int32_t v = y - half; v <= y + half; ++v) {
    for (int32_t u = x - half; u <= x + half; ++u) {
      if (u < 0 || v < 0 || u >= f->width || v >= f->height || depth[v * f->width + u] == 0) continue;
      const float *m = normal + 3 * (v * f->width + u);
      const double there[3] = {(double)m[0], (double)m[1], (double)m[2]};
      double q[3];
      point_of(f, depth, u, v, q);
      const double sigma = f->reach / 2;
      const double w = exp(-squared_distance(p, q) / (2 * sigma * sigma) -
                           squared_distance(here, there) / (2 * f->angle * f->angle));
      for (int k = 0; k < 3; ++k) sum[k] += w * there[k];
    }
  }
  const double length = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
  for (int k = 0; k < 3; ++k) out[k] = (float)(sum[k] / length);
}

void bilateral_normals(const BilateralNormals *filter, const float *depth, const float *normal, float *filtered) {
  for (int32_t y = 0; y < filter->height; ++y) {
    for (int32_t x = 0; x < filter->width; ++x) {
      float *out = filtered + 3 * (y * filter->width + x);
      out[0] = out[1] = out[2] = 0;
      if (depth[y * filter->width + x] != 0) filter_pixel(filter, depth, normal, x, y, out);
    }
  }
}
