// Where plane water shows a point to an eye above it. In the upright plane through both, with the eye e over the water's
// surface, the point d below it and r between them along it, light leaves the water at the distance x from the eye where
// Snell's law holds: sin(air) = x/√(x² + e²) equals index · sin(water) = index · (r − x)/√((r − x)² + d²). The first grows
// with x and the second falls, so that there is one such place between 0 and r: Newton's method, kept between the bounds
// that are known.
#include "render/water_objects.h"

#include <math.h>

typedef struct Crossing {
  double eye, depth, distance; // m: e, d and r
  double index;
} Crossing;

// Sine of the angle that a way so far along the plane and so far across it has with the normal.
static double sine(double along, double across) {
  return along > 0 ? along / hypot(along, across) : 0;
}

static double excess(const Crossing *c, double x) {
  return sine(x, c->eye) - c->index * sine(c->distance - x, c->depth);
}

static double sine_slope(double along, double across) {
  const double length = hypot(along, across);
  return across * across / (length * length * length);
}

static double find_crossing(const Crossing *c) {
  double low = 0, high = c->distance, x = c->distance * c->eye / (c->eye + c->depth);
  for (int i = 0; i < 200 && high - low > 1e-15 * c->distance; ++i) {
    const double e = excess(c, x);
    if (e == 0) return x;
    *(e < 0 ? &low : &high) = x;
    const double next = x - e / (sine_slope(x, c->eye) + c->index * sine_slope(c->distance - x, c->depth));
    if (fabs(next - x) <= 1e-15 * c->distance) return x;
    // Every fourth step halves, lest Newton's creep.
    x = next > low && next < high && i % 4 != 3 ? next : (low + high) / 2;
  }
  return x;
}

static double height_over(const float plane[4], const float p[3]) {
  return (double)plane[0] * (double)p[0] + (double)plane[1] * (double)p[1] + (double)plane[2] * (double)p[2] +
         (double)plane[3];
}

// Its foot on the plane.
static void drop(const float plane[4], const float p[3], double height, double foot[3]) {
  for (int k = 0; k < 3; ++k) foot[k] = (double)p[k] - height * (double)plane[k];
}

void render_refraction_point(const float plane[4], const float eye[3], const float below[3], float index,
                             float point[3]) {
  const double e = height_over(plane, eye), d = -height_over(plane, below);
  double from[3], to[3];
  drop(plane, eye, e, from);
  drop(plane, below, -d, to);
  const double r = sqrt((to[0] - from[0]) * (to[0] - from[0]) + (to[1] - from[1]) * (to[1] - from[1]) +
                        (to[2] - from[2]) * (to[2] - from[2]));
  // The share of the way from the eye's foot to the point's.
  double share = 1;
  if (r > 0 && d > 0 && e >= 0) {
    const Crossing crossing = {e, d, r, fmax((double)index, 1)};
    share = find_crossing(&crossing) / r;
  } else if (e < 0 && d < 0) {
    share = e / (e + d);
  }
  for (int k = 0; k < 3; ++k) point[k] = (float)(from[k] + share * (to[k] - from[k]));
}
