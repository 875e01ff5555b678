// Normals by slopes of the inverse depth, the slow twin: of two neighbours on the plane and the pixel itself, as points.
#include "tests/render/reference/cartoon.h"

#include <math.h>
#include <string.h>

// The point of inverse depth w on the ray through a place in pixels, view space.
static void point_at(const Lens *lens, double x, double y, double w, double p[3]) {
  p[0] = lens->tan_x * (2 * (x + 0.5) / lens->width - 1) / w;
  p[1] = lens->tan_y * (1 - 2 * (y + 0.5) / lens->height) / w;
  p[2] = -1 / w;
}

void cartoon_normals(const Lens *lens, const double *map, const double *slope, float *normal) {
  const double step = 1e-3; // pixels: on the plane any will do, but the inverse depth must stay positive
  memset(normal, 0, 3 * (size_t)lens->width * (size_t)lens->height * sizeof *normal);
  for (int32_t y = 0; y < lens->height; ++y) {
    for (int32_t x = 0; x < lens->width; ++x) {
      const size_t i = (size_t)y * (size_t)lens->width + (size_t)x;
      if (map[i] <= 0) continue;
      double here[3], right[3], down[3], n[3], length = 0;
      point_at(lens, x, y, map[i], here);
      point_at(lens, x + step, y, map[i] + step * slope[2 * i], right);
      point_at(lens, x, y + step, map[i] + step * slope[2 * i + 1], down);
      for (int k = 0; k < 3; ++k) right[k] -= here[k], down[k] -= here[k];
      for (int k = 0; k < 3; ++k)
        n[k] = down[(k + 1) % 3] * right[(k + 2) % 3] - down[(k + 2) % 3] * right[(k + 1) % 3];
      for (int k = 0; k < 3; ++k) length += n[k] * n[k];
      for (int k = 0; k < 3; ++k) normal[3 * i + (size_t)k] = (float)(n[k] / sqrt(length));
    }
  }
}
