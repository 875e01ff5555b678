// The particle radius of a set that does not bring one: half the median distance of nearest neighbours, over a sample.
#include <math.h>
#include <stdlib.h>

#include "sim/sim.h"

#define SAMPLES 256

// Smallest distance to a particle elsewhere; particles in the very same place say nothing about the spacing.
static double nearest(const float *position, int32_t count, int32_t i) {
  const float *p = position + 3 * (int64_t)i;
  double best = INFINITY;
  for (int64_t j = 0; j < count; j++) {
    const float *q = position + 3 * j;
    double dx = (double)q[0] - (double)p[0], dy = (double)q[1] - (double)p[1], dz = (double)q[2] - (double)p[2];
    double d2 = dx * dx + dy * dy + dz * dz;
    if (d2 > 0 && d2 < best) best = d2;
  }
  return sqrt(best);
}

static int compare(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

float sim_estimate_radius(const float *position, int32_t count) {
  double distance[SAMPLES];
  // Fewer samples of a large set, so that the work stays bounded: about 5·10⁸ distances.
  int32_t samples = count < SAMPLES ? count : SAMPLES, found = 0;
  while (samples > 31 && (double)samples * count > 5e8) samples /= 2;
  for (int32_t k = 0; k < samples; k++) {
    double d = nearest(position, count, (int32_t)((int64_t)k * count / samples));
    if (isfinite(d)) distance[found++] = d;
  }
  if (found == 0) return 0.01f;
  qsort(distance, (size_t)found, sizeof *distance, compare);
  double radius = distance[found / 2] / 2;
  return radius > 1e-12 ? (float)radius : 1e-12f;
}
