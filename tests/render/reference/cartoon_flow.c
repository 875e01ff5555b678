// A step of curvature flow, the slow twin.
//
// Based on: van der Laan, Green & Sainz, Screen Space Fluid Rendering with Curvature Flow, 2009: ∂z/∂t = H, twice whose mean
// curvature is the divergence of the unit normal of the surface p(x, y) = z · ray. Differences across a border, and across
// the water's end, count as none.
#include "tests/render/reference/cartoon.h"

#include <math.h>

// Depth at a neighbour, less the depth in the middle; 0 over a border.
static double difference(const Lens *lens, const CartoonFlow *p, const double *map, int32_t x, int32_t y, int32_t dx,
                         int32_t dy) {
  const double z = 1 / cartoon_at(lens, map, x, y), w = cartoon_at(lens, map, x + dx, y + dy);
  const double gap = p->gap + CARTOON_STEEPEST * lens_pixel(lens) * z;
  return w > 0 && fabs(1 / w - z) < gap ? 1 / w - z : 0;
}

// H of the paper's Eqs. 3 to 7. Cx, Cy: of a ray, from pixel to pixel.
static double curvature(const Lens *lens, const CartoonFlow *p, const double *map, int32_t x, int32_t y) {
#define AT(dx, dy) difference(lens, p, map, x, y, dx, dy)
  const double z = 1 / cartoon_at(lens, map, x, y), cx = 2 * lens->tan_x / lens->width, cy = lens_pixel(lens);
  const double zx = (AT(1, 0) - AT(-1, 0)) / 2, zy = (AT(0, 1) - AT(0, -1)) / 2;
  const double zxx = AT(1, 0) + AT(-1, 0), zyy = AT(0, 1) + AT(0, -1);
  const double zxy = (AT(1, 1) + AT(-1, -1) - AT(1, -1) - AT(-1, 1)) / 4;
#undef AT
  const double D = cy * cy * zx * zx + cx * cx * zy * zy + cx * cx * cy * cy * z * z;
  const double Dx = 2 * (cy * cy * zx * zxx + cx * cx * zy * zxy + cx * cx * cy * cy * z * zx);
  const double Dy = 2 * (cy * cy * zx * zxy + cx * cx * zy * zyy + cx * cx * cy * cy * z * zy);
  const double Ex = zx * Dx / 2 - zxx * D, Ey = zy * Dy / 2 - zyy * D;
  return (cy * Ex + cx * Ey) / (2 * pow(D, 1.5));
}

void cartoon_flow(const Lens *lens, const CartoonFlow *p, const double *map, double *moved) {
  const double pixel = fmin(2 * lens->tan_x / lens->width, lens_pixel(lens));
  for (int32_t y = 0; y < lens->height; ++y) {
    for (int32_t x = 0; x < lens->width; ++x) {
      const size_t i = (size_t)y * (size_t)lens->width + (size_t)x;
      moved[i] = 0;
      if (map[i] <= 0) continue;
      const double z = 1 / map[i], time = p->step * 2 * pixel * z;
      moved[i] = 1 / fmax(z - time * curvature(lens, p, map, x, y), z / 2);
    }
  }
}
