#include "tests/render/reference/pinhole.h"

#include <math.h>

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(double out[3], const double a[3], const double b[3]) {
  for (int k = 0; k < 3; ++k) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static void normalize(double v[3]) {
  const double length = sqrt(dot(v, v));
  for (int k = 0; k < 3; ++k) v[k] /= length;
}

Pinhole pinhole_make(const float eye[3], const float target[3], float vertical_fov, int32_t width, int32_t height) {
  Pinhole p = {.lens = {.width = width, .height = height}};
  const double y_axis[3] = {0, 1, 0};
  for (int k = 0; k < 3; ++k) {
    p.eye[k] = (double)eye[k];
    p.gaze[k] = (double)target[k] - (double)eye[k];
  }
  normalize(p.gaze);
  cross(p.right, p.gaze, y_axis);
  normalize(p.right);
  cross(p.up, p.right, p.gaze);
  p.lens.tan_y = tan((double)vertical_fov * 3.14159265358979323846 / 360);
  p.lens.tan_x = p.lens.tan_y * width / height;
  return p;
}

void pinhole_ray(const Pinhole *p, int32_t column, int32_t row, double direction[3]) {
  const double x = lens_x(&p->lens, column), y = lens_y(&p->lens, row);
  for (int k = 0; k < 3; ++k) direction[k] = p->gaze[k] + x * p->right[k] + y * p->up[k];
}

void pinhole_to_view(const Pinhole *p, const double world[3], double view[3]) {
  const double v[3] = {dot(world, p->right), dot(world, p->up), -dot(world, p->gaze)};
  for (int k = 0; k < 3; ++k) view[k] = v[k];
}
