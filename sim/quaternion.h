// Rotations as unit quaternions (x, y, z, w), in double precision.
#ifndef LIDO_SIM_QUATERNION_H
#define LIDO_SIM_QUATERNION_H

#include <math.h>

static inline void sim_quaternion_normalise(double q[4]) {
  double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (int k = 0; k < 4; k++) q[k] /= length;
}

static inline void sim_quaternion_from(const float from[4], double q[4]) {
  for (int k = 0; k < 4; k++) q[k] = (double)from[k];
  sim_quaternion_normalise(q);
}

/// First b, then a.
static inline void sim_quaternion_multiply(const double a[4], const double b[4], double product[4]) {
  double x = a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1];
  double y = a[3] * b[1] + a[1] * b[3] + a[2] * b[0] - a[0] * b[2];
  double z = a[3] * b[2] + a[2] * b[3] + a[0] * b[1] - a[1] * b[0];
  double w = a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2];
  product[0] = x, product[1] = y, product[2] = z, product[3] = w;
}

/// Row-major, from the body's axes to the world's.
static inline void sim_quaternion_matrix(const double q[4], double m[9]) {
  double x = q[0], y = q[1], z = q[2], w = q[3];
  m[0] = 1 - 2 * (y * y + z * z), m[1] = 2 * (x * y - w * z), m[2] = 2 * (x * z + w * y);
  m[3] = 2 * (x * y + w * z), m[4] = 1 - 2 * (x * x + z * z), m[5] = 2 * (y * z - w * x);
  m[6] = 2 * (x * z - w * y), m[7] = 2 * (y * z + w * x), m[8] = 1 - 2 * (x * x + y * y);
}

/// The rotation vector (axis times angle, at most π) that leads from a to b in the world's axes; returns the angle.
static inline double sim_quaternion_way(const double a[4], const double b[4], double way[3]) {
  const double back[4] = {-a[0], -a[1], -a[2], a[3]};
  double d[4];
  sim_quaternion_multiply(b, back, d);
  double sine = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), sign = d[3] < 0 ? -1 : 1;
  double angle = 2 * atan2(sine, sign * d[3]);
  for (int k = 0; k < 3; k++) way[k] = sine > 0 ? sign * d[k] / sine * angle : 0;
  return angle;
}

/// The rotation that is `share` of the way from a to b (Shoemake, Animating Rotation with Quaternion Curves, 1985). `to`
/// may be a or b.
static inline void sim_quaternion_between(const double a[4], const double b[4], double share, double to[4]) {
  double way[3], angle = sim_quaternion_way(a, b, way);
  if (angle == 0) {
    for (int k = 0; k < 4; k++) to[k] = a[k];
    return;
  }
  double sine = sin(0.5 * share * angle) / angle;
  const double turn[4] = {way[0] * sine, way[1] * sine, way[2] * sine, cos(0.5 * share * angle)};
  sim_quaternion_multiply(turn, a, to);
  sim_quaternion_normalise(to);
}

#endif
