// Three doubles and what one does with them.
#ifndef LIDO_TESTS_REFERENCE_VEC_H
#define LIDO_TESTS_REFERENCE_VEC_H

#include <math.h>

typedef struct Vec {
  double x, y, z;
} Vec;

static inline Vec vec_of(const float v[3]) {
  return (Vec){(double)v[0], (double)v[1], (double)v[2]};
}

static inline Vec vec_add(Vec a, Vec b) {
  return (Vec){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline Vec vec_sub(Vec a, Vec b) {
  return (Vec){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline Vec vec_scale(double s, Vec a) {
  return (Vec){s * a.x, s * a.y, s * a.z};
}

/// a + s·b
static inline Vec vec_along(Vec a, double s, Vec b) {
  return (Vec){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline double vec_dot(Vec a, Vec b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline Vec vec_cross(Vec a, Vec b) {
  return (Vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Component by component.
static inline Vec vec_times(Vec a, Vec b) {
  return (Vec){a.x * b.x, a.y * b.y, a.z * b.z};
}

static inline Vec vec_mix(Vec a, Vec b, double t) {
  return vec_along(vec_scale(1 - t, a), t, b);
}

static inline double vec_length(Vec a) {
  return sqrt(vec_dot(a, a));
}

static inline Vec vec_unit(Vec a) {
  return vec_scale(1 / vec_length(a), a);
}

static inline double vec_largest(Vec a) {
  return fmax(a.x, fmax(a.y, a.z));
}

#endif
