// Eigenvalues and eigenvectors of a symmetric 3 × 3 matrix without iteration.
//
// Eigenvalues: Smith, Eigenvalues of a Symmetric 3 × 3 Matrix, 1961. Eigenvectors: Eberly, A Robust Eigensolver for 3 × 3
// Symmetric Matrices, 2014: first the one whose eigenvalue stands apart most, then the second inside the plane across it.
// Double precision inside, so that single-precision input comes out right to its last digits even where two
// eigenvalues fall together. A multiple of the identity gives the coordinate axes.
#include <math.h>
#include <stdbool.h>

#include "sim/surface.h"

typedef struct Vector {
  double x, y, z;
} Vector;

static Vector cross(Vector a, Vector b) {
  return (Vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double dot(Vector a, Vector b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

static Vector scale(double s, Vector a) {
  return (Vector){s * a.x, s * a.y, s * a.z};
}

// The vector across two rows of (A − λ) whose cross product is longest.
static Vector apart_vector(const double m[6], double value) {
  Vector row[3] = {{m[0] - value, m[3], m[4]}, {m[3], m[1] - value, m[5]}, {m[4], m[5], m[2] - value}};
  Vector best = {1, 0, 0};
  double longest = 0;
  for (int k = 0; k < 3; k++) {
    Vector v = cross(row[k], row[(k + 1) % 3]);
    double length = dot(v, v);
    if (length > longest) longest = length, best = scale(1 / sqrt(length), v);
  }
  return best;
}

static Vector multiply(const double m[6], Vector v) {
  return (Vector){m[0] * v.x + m[3] * v.y + m[4] * v.z, m[3] * v.x + m[1] * v.y + m[5] * v.z,
                  m[4] * v.x + m[5] * v.y + m[2] * v.z};
}

// A unit eigenvector of `value` in the plane across the unit vector w.
static Vector plane_vector(const double m[6], Vector w, double value) {
  Vector u = fabs(w.x) > fabs(w.y) ? (Vector){-w.z, 0, w.x} : (Vector){0, w.z, -w.y};
  u = scale(1 / sqrt(dot(u, u)), u);
  Vector v = cross(w, u), mu = multiply(m, u), mv = multiply(m, v);
  double a = dot(u, mu) - value, b = dot(u, mv), c = dot(v, mv) - value;
  // The null space of ((a, b), (b, c)), from its longer row; any direction where both vanish.
  double p = fabs(a) >= fabs(c) ? -b : -c, q = fabs(a) >= fabs(c) ? a : b, length = sqrt(p * p + q * q);
  if (length == 0) return u;
  return (Vector){(p * u.x + q * v.x) / length, (p * u.y + q * v.y) / length, (p * u.z + q * v.z) / length};
}

static void store(float vector[3], Vector v) {
  vector[0] = (float)v.x;
  vector[1] = (float)v.y;
  vector[2] = (float)v.z;
}

static void identity(float value, float values[3], float vector[3][3]) {
  for (int k = 0; k < 3; k++) {
    values[k] = value;
    for (int a = 0; a < 3; a++) vector[k][a] = a == k;
  }
}

void sim_eigen_symmetric(const float matrix[6], float value[3], float vector[3][3]) {
  double m[6], largest = 0;
  bool finite = true;
  for (int k = 0; k < 6; k++) {
    largest = fmax(largest, fabs((double)matrix[k]));
    finite = finite && isfinite(matrix[k]);
  }
  if (!(largest > 0) || !finite) {
    identity(0, value, vector);
    return;
  }
  for (int k = 0; k < 6; k++) m[k] = (double)matrix[k] / largest;
  double mean = (m[0] + m[1] + m[2]) / 3, off = m[3] * m[3] + m[4] * m[4] + m[5] * m[5];
  double a = m[0] - mean, b = m[1] - mean, c = m[2] - mean;
  double p = sqrt((a * a + b * b + c * c + 2 * off) / 6);
  if (p < 1e-12) {
    identity((float)(mean * largest), value, vector);
    return;
  }
  double half =
      (a * (b * c - m[5] * m[5]) - m[3] * (m[3] * c - m[5] * m[4]) + m[4] * (m[3] * m[5] - b * m[4])) / (2 * p * p * p);
  double angle = acos(half < -1 ? -1 : half > 1 ? 1 : half) / 3;
  double e[3];
  e[0] = mean + 2 * p * cos(angle);
  e[2] = mean + 2 * p * cos(angle + 2.0943951023931954923);
  e[1] = 3 * mean - e[0] - e[2];
  int first = e[0] - e[1] >= e[1] - e[2] ? 0 : 2;
  Vector v[3];
  v[first] = apart_vector(m, e[first]);
  v[1] = plane_vector(m, v[first], e[1]);
  if (first == 0)
    v[2] = cross(v[0], v[1]);
  else
    v[0] = cross(v[1], v[2]);
  for (int k = 0; k < 3; k++) {
    value[k] = (float)(e[k] * largest);
    store(vector[k], v[k]);
  }
}
