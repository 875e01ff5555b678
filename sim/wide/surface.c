// The sweep that the surface stages share. q = r/R, R two spacings.
//
// Class: splash or aggregated, by the local density (cubic spline): Imai, Kanamori, Mitani, Real-Time Screen-Space Liquid
// Rendering with Complex Refractions, 2016, section 4.1. The density counts particles only: a drop on the floor is still
// a drop. A particle alone has 0.32, a pair 0.40, a flat sheet one particle thick 0.70, a line 0.48, the corner of a
// lattice 0.61, its inside 1. A splash is what is less than a sheet or a corner.
//
// Moments: Yu & Turk, Reconstructing Surfaces of Particle-Based Fluids Using Anisotropic Kernels, 2013. Centres, Eq. 6:
// x̄ = (1 − λ) x + λ Σ w x / Σ w, w = 1 − q³ (Eq. 11); the covariance around the weighted mean is Eq. 9 and 10. A splash, or
// a particle with fewer than N_ε neighbours, stays in its place and gets no covariance: it is drawn as a sphere. The
// paper's N_ε = 25 belongs to its own R; here it is 13, the same share of a ball of R. With R = 2.5 spacings and 25 a
// pool at rest comes out a little smoother (deviation of its level from the mean of a spacing around 0.14 instead of
// 0.17 spacings, spheres: 0.50) for twice the neighbours.
//
// Exposed: the gradient of a smoothed colour field, which is 1 at particles and 0 elsewhere, is long at a free surface
// (Müller, Charypar, Gross, Particle-Based Fluid Simulation for Interactive Applications, 2003, section 3.3). With the
// kernel (1 − q²)⁴ it is Σ (1 − q²)³ d up to a factor: zero inside a lattice, 0.98 spacings at its face. It also vanishes
// in a thin sheet, on a line and in a heap of particles in one place; they are exposed because the second moment
// Σ (1 − q²)³ q² is small (a lattice 1.48, its face 1.07, a sheet 0.67, a heap 0). Walls count for nothing: tanks are made of
// glass. The limits are from experiments with rays, see surface_flags.c.
#include "sim/surface.h"
#include "sim/wide/kernels.h"

#define SMOOTHING 0.5f  // λ
#define SPARSE 13       // N_ε
#define ASYMMETRY 0.18f // spacings, the longest gradient inside
#define FILLING 0.875f  // the least second moment inside

/// Weighted sums over the neighbours of some particles, relative to them.
typedef struct Sums {
  SimF density, count, weight, mean[3], second[6], gradient[3], filling;
} Sums;

static inline void add_moments(Sums *sums, SimF q2, SimF q, const SimF d[3]) {
  SimF zero = sim_f(0), one = sim_f(1), w = sim_max(one - q2 * q, zero), wd[3];
  sums->count = sums->count + sim_select_less(q2, one, one, zero);
  sums->weight = sums->weight + w;
  for (int k = 0; k < 3; k++) {
    wd[k] = w * d[k];
    sums->mean[k] = sums->mean[k] + wd[k];
    sums->second[k] = sums->second[k] + wd[k] * d[k];
  }
  sums->second[3] = sums->second[3] + wd[0] * d[1];
  sums->second[4] = sums->second[4] + wd[0] * d[2];
  sums->second[5] = sums->second[5] + wd[1] * d[2];
}

static inline void add_colour(Sums *sums, SimF q2, const SimF d[3]) {
  SimF t = sim_max(sim_f(1) - q2, sim_f(0)), weight = t * t * t;
  for (int k = 0; k < 3; k++) sums->gradient[k] = sums->gradient[k] + weight * d[k];
  // Infinitely far away the weight is 0 and q² infinite.
  sums->filling = sums->filling + weight * sim_min(q2, sim_f(1));
}

static inline Sums sum_neighbours(const SimSweepContext *c, bool moments, bool colour, const SimF own[4],
                                  const uint32_t *index, uint32_t slots) {
  SimF zero = sim_f(0), half = sim_f(0.5f), one = sim_f(1), four = sim_f(4), inverse = sim_f(c->cubic.inverse_h);
  Sums sums = {zero, zero, one, {zero, zero, zero}, {zero, zero, zero, zero, zero, zero}, {zero, zero, zero}, zero};
  for (uint32_t k = 0; k < slots; k++, index += SIM_CHUNK) {
    SimF other[4], d[3];
    sim_gather4(c->surface->four, index, other);
    for (int a = 0; a < 3; a++) d[a] = other[a] - own[a];
    SimF q = sim_sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) * inverse, q2 = q * q;
    SimF a = sim_max(one - q, zero), b = sim_max(half - q, zero);
    sums.density = sums.density + (a * a * a - four * (b * b * b));
    if (moments) add_moments(&sums, q2, q, d);
    if (colour) add_colour(&sums, q2, d);
  }
  return sums;
}

// Class of each lane; aggregated[k] = 1 or 0 accordingly.
static void write_class(const SimSweepContext *c, int32_t i, SimF density, float aggregated[SIM_LANES]) {
  uint8_t *to = c->sums.particle_class + i;
  float lane[SIM_LANES];
  sim_store(lane, density);
  for (int k = 0; k < SIM_LANES; k++) {
    if (!c->sums.class_given) to[k] = lane[k] < SIM_SPLASH_DENSITY ? SIM_SPLASH : SIM_AGGREGATED;
    aggregated[k] = to[k] == SIM_AGGREGATED ? 1 : 0;
  }
}

static void write_moments(const SimSweepContext *c, int32_t i, const SimF own[4], const Sums *sums, SimF aggregated) {
  SimF zero = sim_f(0), shaped = sim_select_less(sums->count, sim_f(SPARSE - 0.5f), zero, aggregated);
  SimF inverse = sim_f(1) / sums->weight, mean[3], second[6];
  float centre[3][SIM_LANES],
      *covariance = c->sums.covariance + 6 * (size_t)(i / SIM_CHUNK * SIM_CHUNK) + i % SIM_CHUNK;
  for (int k = 0; k < 3; k++) {
    mean[k] = sums->mean[k] * inverse;
    sim_store(centre[k], own[k] + shaped * sim_f(SMOOTHING) * mean[k]);
  }
  for (int k = 0; k < 3; k++) second[k] = sums->second[k] * inverse - mean[k] * mean[k];
  second[3] = sums->second[3] * inverse - mean[0] * mean[1];
  second[4] = sums->second[4] * inverse - mean[0] * mean[2];
  second[5] = sums->second[5] * inverse - mean[1] * mean[2];
  for (int k = 0; k < 6; k++) sim_store(covariance + k * SIM_CHUNK, shaped * second[k]);
  float *to = c->sums.smoothed + 3 * (size_t)i;
  for (int k = 0; k < SIM_LANES; k++)
    for (int a = 0; a < 3; a++) *to++ = centre[a][k];
}

static void write_exposed(const SimSweepContext *c, int32_t i, const Sums *sums) {
  SimF length2 = sim_f(0), one = sim_f(1);
  for (int k = 0; k < 3; k++) {
    SimF g = sums->gradient[k] * sim_f(1 / c->surface->spacing);
    length2 = length2 + g * g;
  }
  SimF thin = sim_select_less(sums->filling, sim_f(FILLING), one, sim_f(0));
  float exposed[SIM_LANES];
  sim_store(exposed, sim_select_less(sim_f(ASYMMETRY * ASYMMETRY), length2, one, thin));
  for (int k = 0; k < SIM_LANES; k++) c->sums.exposed[i + k] = i + k < c->surface->count && exposed[k] > 0;
}

static inline void sweep(const SimSweepContext *c, bool moments, bool colour, int32_t begin, int32_t end) {
  const SimNeighbours *lists = c->surface->lists;
  for (int32_t i = begin; i < end; i += SIM_LANES) {
    const int32_t chunk = i / SIM_CHUNK;
    const uint32_t *index = lists->index + (size_t)lists->start[chunk] * SIM_CHUNK + i % SIM_CHUNK;
    float aggregated[SIM_LANES] = {0};
    SimF own[4];
    sim_load4(c->surface->four + 4 * (size_t)i, own);
    Sums sums = sum_neighbours(c, moments, colour, own, index, lists->length[chunk]);
    SimF density = sim_f(c->cubic.value_scale) + sim_f(2 * c->cubic.value_scale) * sums.density;
    if (c->sums.density) sim_store(c->sums.density + i, density);
    if (c->sums.particle_class) write_class(c, i, density, aggregated);
    if (moments) write_moments(c, i, own, &sums, sim_load(aggregated));
    if (colour) write_exposed(c, i, &sums);
  }
}

void WIDE(sim_surface_sweep)(int32_t begin, int32_t end, const void *context) {
  const SimSweepContext *c = context;
  bool moments = c->sums.covariance, colour = c->sums.exposed;
  if (moments && colour)
    sweep(c, true, true, begin, end);
  else if (moments)
    sweep(c, true, false, begin, end);
  else if (colour)
    sweep(c, false, true, begin, end);
  else
    sweep(c, false, false, begin, end);
}
