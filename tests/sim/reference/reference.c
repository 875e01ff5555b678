#include "reference.h"

#include <math.h>
#include <string.h>

void reference_eigen(const float matrix[6], double value[3], double vector[3][3]) {
  const float *m = matrix;
  double a[3][3] = {{m[0], m[3], m[4]}, {m[3], m[1], m[5]}, {m[4], m[5], m[2]}};
  double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int sweep = 0; sweep < 60; sweep++)
    for (int p = 0; p < 2; p++)
      for (int q = p + 1; q < 3; q++) {
        if (a[p][q] == 0) continue;
        double angle = 0.5 * atan2(2 * a[p][q], a[q][q] - a[p][p]), c = cos(angle), s = sin(angle);
        for (int k = 0; k < 3; k++) {
          double x = a[k][p], y = a[k][q];
          a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
        }
        for (int k = 0; k < 3; k++) {
          double x = a[p][k], y = a[q][k];
          a[p][k] = c * x - s * y, a[q][k] = s * x + c * y;
          x = v[p][k], y = v[q][k];
          v[p][k] = c * x - s * y, v[q][k] = s * x + c * y;
        }
      }
  int order[3] = {0, 1, 2};
  for (int i = 0; i < 3; i++)
    for (int j = i + 1; j < 3; j++)
      if (a[order[j]][order[j]] > a[order[i]][order[i]]) {
        int t = order[i];
        order[i] = order[j], order[j] = t;
      }
  for (int k = 0; k < 3; k++) {
    value[k] = a[order[k]][order[k]];
    memcpy(vector[k], v[order[k]], sizeof v[0]);
  }
}

static double cubic(double q) {
  return q >= 1 ? 0 : q <= 0.5 ? 6 * q * q * q - 6 * q * q + 1 : 2 * (1 - q) * (1 - q) * (1 - q);
}

static double distance(const float *a, const float *b) {
  double x = (double)a[0] - b[0], y = (double)a[1] - b[1], z = (double)a[2] - b[2];
  return sqrt(x * x + y * y + z * z);
}

double reference_density(const float *position, int32_t count, int32_t i, double spacing) {
  double lattice = 0, sum = 0;
  for (int x = -2; x <= 2; x++)
    for (int y = -2; y <= 2; y++)
      for (int z = -2; z <= 2; z++) lattice += cubic(sqrt(x * x + y * y + z * z) / 2);
  for (int32_t j = 0; j < count; j++) sum += cubic(distance(position + 3 * i, position + 3 * j) / (2 * spacing));
  return sum / lattice;
}

int reference_anisotropy(const float *position, int32_t count, int32_t i, double spacing, double centre[3],
                         double ellipsoid[6]) {
  double radius = 2 * spacing, total = 0, mean[3] = {0, 0, 0}, c[3][3] = {{0}};
  int neighbours = -1;
  for (int32_t j = 0; j < count; j++) {
    double q = distance(position + 3 * i, position + 3 * j) / radius;
    if (q >= 1) continue;
    neighbours++;
    total += 1 - q * q * q;
    for (int k = 0; k < 3; k++) mean[k] += (1 - q * q * q) * (double)position[3 * j + k];
  }
  for (int k = 0; k < 3; k++) mean[k] /= total;
  for (int k = 0; k < 3; k++) centre[k] = 0.5 * (double)position[3 * i + k] + 0.5 * mean[k];
  for (int32_t j = 0; j < count; j++) {
    double q = distance(position + 3 * i, position + 3 * j) / radius;
    for (int a = 0; a < 3 && q < 1; a++)
      for (int b = 0; b < 3; b++)
        c[a][b] +=
            (1 - q * q * q) * ((double)position[3 * j + a] - mean[a]) * ((double)position[3 * j + b] - mean[b]) / total;
  }
  float m[6] = {(float)c[0][0], (float)c[1][1], (float)c[2][2], (float)c[0][1], (float)c[0][2], (float)c[1][2]};
  double value[3], v[3][3], volume = 1, largest;
  reference_eigen(m, value, v);
  largest = value[0];
  for (int k = 0; k < 3; k++) volume *= value[k] = fmax(value[k], largest / 4);
  for (int k = 0; k < 3; k++) value[k] = fmin(spacing / 2 * value[k] / cbrt(volume), 1.2 * spacing / 2);
  const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
  for (int e = 0; e < 6; e++) {
    ellipsoid[e] = 0;
    for (int k = 0; k < 3; k++) ellipsoid[e] += value[k] * v[k][row[e]] * v[k][column[e]];
  }
  return neighbours;
}

double reference_potential(const float *position, int32_t count, const double point[3], double radius) {
  double sum = 0;
  for (int32_t j = 0; j < count; j++) {
    double r2 = 0;
    for (int k = 0; k < 3; k++) {
      double d = point[k] - (double)position[3 * j + k];
      r2 += d * d;
    }
    if (r2 < radius * radius) sum += sqrt(1 - r2 / (radius * radius));
  }
  return sum;
}

int32_t reference_first_hit(const float *position, int32_t count, const double origin[3], const double direction[3],
                            double radius) {
  double nearest = INFINITY;
  int32_t hit = -1;
  for (int32_t j = 0; j < count; j++) {
    double along = 0, d2 = 0;
    for (int k = 0; k < 3; k++) {
      double d = (double)position[3 * j + k] - origin[k];
      along += d * direction[k];
      d2 += d * d;
    }
    double half2 = radius * radius - (d2 - along * along);
    if (half2 <= 0) continue;
    double at = along - sqrt(half2);
    if (at > 0 && at < nearest) nearest = at, hit = j;
  }
  return hit;
}
