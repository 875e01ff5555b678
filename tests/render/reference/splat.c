#include "tests/render/reference/splat.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

SplatMap splat_map_create(const Lens *lens) {
  const size_t pixels = (size_t)lens->width * (size_t)lens->height;
  return (SplatMap){calloc(pixels, sizeof(float)), calloc(3 * pixels, sizeof(float)), NULL};
}

void splat_map_destroy(SplatMap *map) {
  free(map->depth);
  free(map->normal);
  *map = (SplatMap){0};
}

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// out = M v of a symmetric matrix (xx, yy, zz, xy, xz, yz)
static void multiply(const double m[6], const double v[3], double out[3]) {
  out[0] = m[0] * v[0] + m[3] * v[1] + m[4] * v[2];
  out[1] = m[3] * v[0] + m[1] * v[1] + m[5] * v[2];
  out[2] = m[4] * v[0] + m[5] * v[1] + m[2] * v[2];
}

static void invert(const double m[6], double out[6]) {
  const double xx = m[1] * m[2] - m[5] * m[5], xy = m[4] * m[5] - m[3] * m[2], xz = m[3] * m[5] - m[4] * m[1];
  const double determinant = m[0] * xx + m[3] * xy + m[4] * xz;
  const double adjugate[6] = {xx, m[0] * m[2] - m[4] * m[4], m[0] * m[1] - m[3] * m[3], xy,
                              xz, m[3] * m[4] - m[0] * m[5]};
  for (int k = 0; k < 6; ++k) out[k] = adjugate[k] / determinant;
}

typedef struct Box {
  int32_t first[2], last[2]; // columns and rows, both ends included
} Box;

// The pixels that the ellipsoid's box along the camera's axes covers; all where it reaches behind the eye.
static Box covered(const Pinhole *p, const double centre[3], const double t[6]) {
  const double *axes[3] = {p->right, p->up, p->gaze};
  double middle[3], half[3], low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  for (int k = 0; k < 3; ++k) {
    double along[3];
    multiply(t, axes[k], along);
    half[k] = sqrt(dot(along, along));
    middle[k] = dot(centre, axes[k]);
  }
  const Lens *lens = &p->lens;
  const Box all = {{0, 0}, {lens->width - 1, lens->height - 1}};
  if (middle[2] - half[2] <= 1e-6) return all;
  for (int corner = 0; corner < 8; ++corner) {
    const double depth = middle[2] + (corner & 4 ? half[2] : -half[2]);
    const double x = (middle[0] + (corner & 1 ? half[0] : -half[0])) / depth / lens->tan_x;
    const double y = (middle[1] + (corner & 2 ? half[1] : -half[1])) / depth / lens->tan_y;
    const double pixel[2] = {(x + 1) / 2 * lens->width, (1 - y) / 2 * lens->height};
    for (int k = 0; k < 2; ++k) {
      low[k] = fmin(low[k], pixel[k]);
      high[k] = fmax(high[k], pixel[k]);
    }
  }
  Box box;
  for (int k = 0; k < 2; ++k) {
    box.first[k] = (int32_t)fmax(floor(low[k]), 0);
    box.last[k] = (int32_t)fmin(floor(high[k]), all.last[k]);
  }
  return box;
}

// Is this entry nearer, or this exit within the limit farther, than what a map holds so far at pixel i?
static bool beats(SplatSide side, double depth, const SplatMap *map, size_t i) {
  const double present = (double)map->depth[i];
  if (depth <= 0) return false;
  if (side == SPLAT_BACK && map->limit != NULL && depth > (double)map->limit[i]) return false;
  return present <= 0 || (side == SPLAT_FRONT ? depth < present : depth > present);
}

void splat_ellipsoid(const Pinhole *pinhole, SplatSide side, const float centre[3], const float t[6], double scale,
                     SplatMap *map) {
  double c[3], shape[6], inverse[6], from[3];
  for (int k = 0; k < 3; ++k) c[k] = (double)centre[k] - pinhole->eye[k];
  for (int k = 0; k < 6; ++k) shape[k] = scale * (double)t[k];
  invert(shape, inverse);
  multiply(inverse, c, from); // the centre, seen from the eye, where the ellipsoid is the unit ball
  const Box box = covered(pinhole, c, shape);
  for (int32_t row = box.first[1]; row <= box.last[1]; ++row) {
    for (int32_t column = box.first[0]; column <= box.last[0]; ++column) {
      double ray[3], d[3];
      pinhole_ray(pinhole, column, row, ray);
      multiply(inverse, ray, d);
      const double dd = dot(d, d), middle = dot(d, from) / dd;
      const double quarter = middle * middle - (dot(from, from) - 1) / dd;
      if (quarter <= 0) continue;
      const double depth = side == SPLAT_FRONT ? middle - sqrt(quarter) : middle + sqrt(quarter);
      const size_t i = (size_t)row * (size_t)pinhole->lens.width + (size_t)column;
      if (!beats(side, depth, map, i)) continue;
      double unit[3], gradient[3], normal[3];
      for (int k = 0; k < 3; ++k) unit[k] = depth * d[k] - from[k];
      multiply(inverse, unit, gradient);
      pinhole_to_view(pinhole, gradient, normal);
      const double length = sqrt(dot(normal, normal));
      map->depth[i] = (float)depth;
      for (int k = 0; k < 3; ++k) map->normal[3 * i + (size_t)k] = (float)(normal[k] / length);
    }
  }
}

void splat_sphere(const Pinhole *pinhole, SplatSide side, const float centre[3], float radius, SplatMap *map) {
  splat_ellipsoid(pinhole, side, centre, (const float[6]){radius, radius, radius}, 1, map);
}

// Smoothed centres have sunk into the water by a part of a radius, and flat ellipsoids reach less far above them than
// spheres. `lift` moves them back: outwards along the ellipsoid's shortest axis, which T⁻² (x − x̄) is nearly along. A particle
// inside the water has hardly moved and stays.
static void lifted(const SimFrame *frame, size_t n, double lift, float centre[3]) {
  double moved[3], t[6], inverse[6], half[3], out[3];
  for (size_t k = 0; k < 3; ++k) moved[k] = (double)frame->position[3 * n + k] - (double)frame->smoothed[3 * n + k];
  for (size_t k = 0; k < 6; ++k) t[k] = (double)frame->ellipsoid[6 * n + k];
  invert(t, inverse);
  multiply(inverse, moved, half);
  multiply(inverse, half, out);
  const double radius = (double)frame->particle_radius, length = sqrt(dot(out, out));
  const double x = fmin(fmax((sqrt(dot(moved, moved)) / radius - 0.1) / 0.2, 0), 1);
  const double by = length > 0 ? lift * radius * x * x * (3 - 2 * x) / length : 0;
  for (size_t k = 0; k < 3; ++k) centre[k] = (float)((double)frame->smoothed[3 * n + k] + by * out[k]);
}

void splat_frame(const Pinhole *pinhole, SplatSide side, const SimFrame *frame, SimClass class, SplatShape shape,
                 SplatMap *map) {
  for (int32_t i = 0; i < frame->count; ++i) {
    if (!frame->near_surface[i] || frame->particle_class[i] != class) continue;
    const size_t n = (size_t)i;
    if (class == SIM_AGGREGATED) {
      float centre[3];
      lifted(frame, n, shape.lift, centre);
      splat_ellipsoid(pinhole, side, centre, frame->ellipsoid + 6 * n, shape.scale, map);
    } else {
      splat_sphere(pinhole, side, frame->position + 3 * n, frame->radius ? frame->radius[i] : frame->particle_radius,
                   map);
    }
  }
}
