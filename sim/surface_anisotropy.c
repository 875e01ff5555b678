// Smoothed centres and ellipsoids: Yu & Turk, Reconstructing Surfaces of Particle-Based Fluids Using Anisotropic Kernels,
// 2013.
//
// Centres, Eq. 6: x̄ = (1 − λ) x + λ Σ w x / Σ w, w = 1 − (r/R)³ (Eq. 11). Their covariance around the weighted mean
// (Eq. 9, 10) is C = R Σ Rᵀ; σ_k ≥ σ_1/4 (Eq. 15). Instead of the published scale factor k_s, which depends on units, the
// shape is normalised to keep its volume: the semi-axes are r σ̃_k / (σ̃_1 σ̃_2 σ̃_3)^⅓, with r the particle radius. They
// are bounded by 1.2 r (Imai et al. 2016, section 4.2).
//
// Limits: a splash, or a particle with fewer than 25 neighbours, becomes a sphere (k_n of Eq. 15): a splash of radius r,
// so that drops keep their size, another sparse one of k_n = ½ r by the paper would vanish from thin sheets; it keeps r
// too. Inside the fluid C is isotropic and the ellipsoid a sphere; at a flat surface it is a disc along it.
#include <math.h>

#include "sim/parallel.h"
#include "sim/surface.h"

#define RADIUS 2.5f     // R in spacings
#define SMOOTHING 0.5f  // λ
#define SPARSE 25       // N_ε
#define LARGEST_RATIO 4 // k_r
#define BOUND 1.2f      // largest semi-axis in particle radii

typedef struct AnisotropyContext {
  const SimSurface *surface;
  const uint8_t *particle_class;
  float *smoothed, *ellipsoid;
} AnisotropyContext;

/// Weighted sums over the neighbourhood of one particle, relative to it.
typedef struct Moments {
  int32_t count; ///< without the particle itself
  float weight, mean[3], second[6];
} Moments;

static void add_range(const SimSurface *surface, SimRange range, int32_t i, float radius, Moments *m) {
  const float *restrict x = surface->position[0], *restrict y = surface->position[1],
                        *restrict z = surface->position[2];
  float inverse = 1 / radius, r2max = radius * radius;
  for (int32_t j = range.begin; j < range.end; j++) {
    float dx = x[j] - x[i], dy = y[j] - y[i], dz = z[j] - z[i], r2 = dx * dx + dy * dy + dz * dz;
    if (r2 >= r2max || j == i) continue;
    float q = sqrtf(r2) * inverse, w = 1 - q * q * q;
    m->count++;
    m->weight += w;
    m->mean[0] += w * dx;
    m->mean[1] += w * dy;
    m->mean[2] += w * dz;
    m->second[0] += w * dx * dx;
    m->second[1] += w * dy * dy;
    m->second[2] += w * dz * dz;
    m->second[3] += w * dx * dy;
    m->second[4] += w * dx * dz;
    m->second[5] += w * dy * dz;
  }
}

static Moments moments_of(const SimSurface *surface, int32_t i) {
  Moments m = {.weight = 1}; // its own
  float radius = RADIUS * surface->spacing;
  float point[3] = {surface->position[0][i], surface->position[1][i], surface->position[2][i]};
  SimRange ranges[SIM_MAX_RANGES];
  int32_t n = sim_grid_ranges(surface->grid, point, radius, ranges);
  for (int32_t r = 0; r < n; r++) add_range(surface, ranges[r], i, radius, &m);
  for (int k = 0; k < 3; k++) m.mean[k] /= m.weight;
  for (int k = 0; k < 6; k++) m.second[k] /= m.weight;
  return m;
}

static void sphere(float radius, float ellipsoid[6]) {
  for (int k = 0; k < 6; k++) ellipsoid[k] = k < 3 ? radius : 0;
}

static void shape(const Moments *m, float radius, float ellipsoid[6]) {
  const float *a = m->mean;
  float covariance[6] = {m->second[0] - a[0] * a[0], m->second[1] - a[1] * a[1], m->second[2] - a[2] * a[2],
                         m->second[3] - a[0] * a[1], m->second[4] - a[0] * a[2], m->second[5] - a[1] * a[2]};
  float value[3], v[3][3];
  sim_eigen_symmetric(covariance, value, v);
  if (!(value[0] > 0)) { // all in one place
    sphere(radius, ellipsoid);
    return;
  }
  float volume = 1, largest = value[0];
  for (int k = 0; k < 3; k++) {
    value[k] = fmaxf(value[k] / largest, 1.0f / LARGEST_RATIO);
    volume *= value[k];
  }
  float scale = radius / cbrtf(volume);
  for (int k = 0; k < 3; k++) value[k] = fminf(value[k] * scale, BOUND * radius);
  const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
  for (int e = 0; e < 6; e++) {
    ellipsoid[e] = 0;
    for (int k = 0; k < 3; k++) ellipsoid[e] += value[k] * v[k][row[e]] * v[k][column[e]];
  }
}

static void anisotropy_kernel(int32_t begin, int32_t end, const void *context) {
  const AnisotropyContext *c = context;
  float radius = c->surface->spacing / 2;
  for (int64_t i = begin; i < end; i++) {
    float smoothing = 0, *centre = c->smoothed + 3 * i, *ellipsoid = c->ellipsoid + 6 * i;
    Moments m = {0};
    if (c->particle_class[i] == SIM_AGGREGATED) m = moments_of(c->surface, (int32_t)i);
    if (m.count >= SPARSE) {
      smoothing = SMOOTHING;
      shape(&m, radius, ellipsoid);
    } else {
      sphere(radius, ellipsoid);
    }
    for (int k = 0; k < 3; k++) centre[k] = c->surface->position[k][i] + smoothing * m.mean[k];
  }
}

void sim_surface_anisotropy(const SimSurface *surface, const uint8_t *particle_class, float *smoothed,
                            float *ellipsoid) {
  AnisotropyContext context = {surface, particle_class, smoothed, ellipsoid};
  sim_parallel_for(surface->threads, surface->count, anisotropy_kernel, &context);
}
