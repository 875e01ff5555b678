#include "stress.h"

#include <math.h>
#include <string.h>

#include "sim/wide/wide.h"

// The difference of two places; V W'/r there, or 0 where they are out of reach.
static double pair(const SimWorld *world, const float *four, int32_t i, int32_t j, double d[3]) {
  double r2 = 0, h = (double)world->cubic.h;
  for (int k = 0; k < 3; k++) {
    d[k] = (double)four[4 * i + k] - (double)four[4 * j + k];
    r2 += d[k] * d[k];
  }
  double r = sqrt(r2);
  return i == j || r >= h ? 0 : (double)world->cubic.volume * sim_kernel_cubic_derivative(r, h) / r;
}

void reference_solid(const SimWorld *world, const float *four, int32_t i, float solid[4]) {
  SimSolid found;
  sim_boundary_solid(&world->boundary, NULL, four + 4 * i, &found);
  memcpy(solid, found.gradient, sizeof found.gradient);
  solid[3] = found.share;
}

void reference_moment(const SimWorld *world, const float *four, int32_t i, double m[3][3]) {
  memset(m, 0, 9 * sizeof(double));
  for (int32_t j = 0; j < world->particles.count; j++) {
    double d[3], g = pair(world, four, i, j, d);
    for (int k = 0; k < 3; k++)
      for (int l = 0; l < 3; l++) m[k][l] += g * d[k] * d[l];
  }
  float solid[4];
  reference_solid(world, four, i, solid);
  double square = 0, t = fmin(1, (double)solid[3]) * SIM_WALL_MOMENTS;
  const float *moment = world->boundary.wall.moment + (int)t;
  for (int k = 0; k < 3; k++) square += (double)solid[k] * (double)solid[k];
  double across = t < SIM_WALL_MOMENTS ? (double)moment[0] + (t - (int)t) * (double)(moment[1] - moment[0]) : 0;
  for (int k = 0; k < 3; k++)
    for (int l = 0; l < 3 && square > 0; l++)
      m[k][l] -= (double)(solid[k] * solid[l]) * across / square + (k == l) * (double)solid[3];
}

void reference_shear(const SimWorld *world, const float *four, int32_t i, double shear[3][3]) {
  double m[3][3], e[3][3];
  float solid[4];
  reference_moment(world, four, i, m);
  reference_solid(world, four, i, solid);
  double mean = (m[0][0] + m[1][1] + m[2][2]) / 3, whole = fmin(1, fmax(0, -4 * mean - 2));
  whole *= fmax(0, 1 - 2.5 * (double)solid[3]);
  for (int k = 0; k < 3; k++)
    for (int l = 0; l < 3; l++) e[k][l] = -whole / fmin(mean, -0.25) * (m[k][l] - (k == l) * mean);
  for (int k = 0; k < 3; k++)
    for (int l = 0; l < 3; l++) {
      double square = 0;
      for (int q = 0; q < 3; q++) square += e[k][q] * e[q][l];
      shear[k][l] = fmax(-0.15, fmin(0.15, e[k][l] + square));
    }
}

void reference_unpack(const float four[4], double tensor[3][3]) {
  static const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
  uint32_t word[3];
  memcpy(word, four, sizeof word);
  for (int k = 0; k < 6; k++) {
    uint32_t bits = k % 2 == 0 ? word[k / 2] & 0xffff0000u : word[k / 2] << 16;
    float value;
    memcpy(&value, &bits, sizeof value);
    tensor[row[k]][column[k]] = tensor[column[k]][row[k]] = (double)value;
  }
}

void reference_move(const SimWorld *world, const float *four, const double *lambda, double (*shear)[3][3], double answer,
                    int32_t i, double move[3]) {
  for (int k = 0; k < 3; k++) move[k] = 0;
  for (int32_t j = 0; j < world->particles.count; j++) {
    double d[3], g = pair(world, four, i, j, d);
    for (int k = 0; k < 3; k++) {
      move[k] += (lambda[i] + lambda[j]) * g * d[k];
      for (int l = 0; l < 3 && shear; l++) move[k] += (shear[i][k][l] + shear[j][k][l]) * g * d[l];
    }
  }
  float solid[4];
  reference_solid(world, four, i, solid);
  double square = 0, across = 0, share = fmin((double)solid[3], 0.45), missing = share / (1 - share);
  for (int k = 0; k < 3; k++) {
    square += (double)solid[k] * (double)solid[k];
    across += (double)solid[k] * move[k];
  }
  missing *= fmax(0, fmin(1, sqrt(square) * (double)world->cubic.spacing / fmax(share, 1e-6) - 0.5));
  for (int k = 0; k < 3; k++) {
    double along = square > 0 ? move[k] - across / square * (double)solid[k] : move[k];
    move[k] += missing * along + answer * lambda[i] * (double)solid[k];
  }
}
