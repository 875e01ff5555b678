// Normals of a smoothed depth map.
//
// The inverse depth w = 1/z of a plane n·p = d is affine in the ray's coordinates: with p = z (x, y, −1) it is
// d w = n_x x + n_y y − n_z. So n is along (w_x, w_y, x w_x + y w_y − w), without error on a plane. Where the three
// pixels of a line bend by more than a particle radius they are not of one surface, and the flatter side is taken.
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "tests/render/reference/smooth.h"

static double inverse_at(const Lens *lens, const float *depth, int32_t x, int32_t y) {
  if (x < 0 || y < 0 || x >= lens->width || y >= lens->height) return 0;
  const float z = depth[(size_t)y * (size_t)lens->width + (size_t)x];
  return z > 0 ? 1 / (double)z : 0;
}

// Change of w from pixel to pixel, from its values before, here and behind (0: nothing there). `bend` in units of w.
static double difference(double before, double here, double after, double bend) {
  const double backward = here - before, forward = after - here;
  if (before <= 0) return after <= 0 ? 0 : forward;
  if (after <= 0) return backward;
  if (fabs(forward - backward) <= bend) return (forward + backward) / 2;
  return fabs(forward) < fabs(backward) ? forward : backward;
}

void smooth_normals(const Lens *lens, double radius, const float *depth, float *normal) {
  memset(normal, 0, 3 * (size_t)lens->width * (size_t)lens->height * sizeof *normal);
  for (int32_t row = 0; row < lens->height; ++row) {
    for (int32_t column = 0; column < lens->width; ++column) {
      const double w = inverse_at(lens, depth, column, row), x = lens_x(lens, column), y = lens_y(lens, row);
      if (w <= 0) continue;
      const double bend = radius * w * w; // a depth that differs by δ has an inverse that differs by about δ/z²
      const double across =
          difference(inverse_at(lens, depth, column - 1, row), w, inverse_at(lens, depth, column + 1, row), bend);
      const double down =
          difference(inverse_at(lens, depth, column, row - 1), w, inverse_at(lens, depth, column, row + 1), bend);
      const double wx = across / (2 * lens->tan_x / lens->width), wy = -down / (2 * lens->tan_y / lens->height);
      const double n[3] = {-wx, -wy, w - x * wx - y * wy}; // towards the viewer
      const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      float *to = normal + 3 * ((size_t)row * (size_t)lens->width + (size_t)column);
      for (int k = 0; k < 3; ++k) to[k] = (float)(n[k] / length);
    }
  }
}
