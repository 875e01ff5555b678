#include "tests/render/walls.h"

#include <math.h>

const SimContainer wall_tank = {{0, 0, 0}, {1.05f, 0.9f, 0.525f}, SIM_CONTAINER_BOX};
const SimContainer wall_glass = {{0, 0, 0}, {0.7f, 0.9f, 0.7f}, SIM_CONTAINER_GLASS};

static void point_of(const Ray *ray, double depth, double p[3]) {
  for (int k = 0; k < 3; ++k) p[k] = ray->origin[k] + depth * ray->direction[k];
}

// How much shorter the distance to an edge along axis e looks to the ray, where the edge runs along axis f.
static double foreshortened(const Ray *ray, const double e[3], const double f[3]) {
  double dd = 0, de = 0, df = 0, ef = 0, ff = 0, ee = 0;
  for (int k = 0; k < 3; ++k) {
    dd += ray->direction[k] * ray->direction[k];
    de += ray->direction[k] * e[k];
    df += ray->direction[k] * f[k];
  }
  for (int k = 0; k < 3; ++k) {
    const double across_e = e[k] - de / dd * ray->direction[k], across_f = f[k] - df / dd * ray->direction[k];
    ee += across_e * across_e;
    ef += across_e * across_f;
    ff += across_f * across_f;
  }
  return sqrt(fmax(ee - ef * ef / ff, 0));
}

// The tank's face through which the ray comes in (side 0) or goes out (1); false: none, or the water's surface.
bool wall_meet_tank(const Ray *ray, int side, WallMeeting *m) {
  double depth = side == 0 ? -INFINITY : INFINITY;
  int face = 0;
  const double top[3] = {(double)wall_tank.max[0], (double)WALL_LEVEL, (double)wall_tank.max[2]};
  for (int k = 0; k < 3; ++k) {
    const double a = -ray->origin[k] / ray->direction[k], b = (top[k] - ray->origin[k]) / ray->direction[k];
    const double t = side == 0 ? fmin(a, b) : fmax(a, b);
    if (side == 0 ? t > depth : t < depth) {
      depth = t;
      face = k;
    }
  }
  double p[3];
  point_of(ray, depth, p);
  const bool low = p[face] < top[face] / 2;
  *m = (WallMeeting){.depth = depth, .from_edge = INFINITY};
  m->normal[face] = low ? -1 : 1;
  for (int k = 0; k < 3; ++k) {
    double e[3] = {0}, f[3] = {0};
    if (k == face) continue;
    e[k] = 1;
    f[3 - face - k] = 1;
    m->from_edge = fmin(m->from_edge, foreshortened(ray, e, f) * fmin(p[k], top[k] - p[k]) / (double)WALL_RADIUS);
  }
  return m->from_edge > 0 && (face != 1 || low);
}

// The same of the round glass's wall.
bool wall_meet_glass(const Ray *ray, int side, WallMeeting *m) {
  const double radius = (double)wall_glass.max[0] / 2, *d = ray->direction;
  const double x = ray->origin[0] - radius, z = ray->origin[2] - radius, a = d[0] * d[0] + d[2] * d[2];
  const double b = (x * d[0] + z * d[2]) / a, h = b * b - (x * x + z * z - radius * radius) / a;
  if (h <= 0) return false;
  double p[3];
  m->depth = -b + (side == 0 ? -sqrt(h) : sqrt(h));
  point_of(ray, m->depth, p);
  m->normal[0] = (p[0] - radius) / radius;
  m->normal[1] = 0;
  m->normal[2] = (p[2] - radius) / radius;
  const double up[3] = {0, 1, 0}, along[3] = {-m->normal[2], 0, m->normal[0]};
  const double silhouette = radius - fabs(x * d[2] - z * d[0]) / sqrt(a);
  m->from_edge =
      fmin(foreshortened(ray, up, along) * fmin((double)WALL_LEVEL - p[1], p[1]), silhouette) / (double)WALL_RADIUS;
  return m->from_edge > 0;
}
