// From the covariance of a neighbourhood to the ellipsoid that a particle is drawn as: Yu & Turk, Reconstructing Surfaces
// of Particle-Based Fluids Using Anisotropic Kernels, 2013.
//
// C = R Σ Rᵀ, σ_k ≥ σ_1/4 (Eq. 15). Instead of the published scale factor k_s, which depends on units, the shape is
// normalised to keep its volume: the semi-axes are r σ̃_k / (σ̃_1 σ̃_2 σ̃_3)^⅓, with r the particle radius. They are bounded
// by 1.2 r (Imai et al. 2016, section 4.2). Inside the fluid C is isotropic and the ellipsoid a sphere; at a flat surface
// it is a disc along it. A covariance of zero (a splash, too few neighbours, all in one place) gives a sphere of radius
// r, so that drops keep their size; the paper's ½ r for sparse ones would vanish from thin sheets.
//
// Eigenvectors by cyclic Jacobi rotations with the tangent of the smaller angle (Jacobi 1846; Rutishauser, The Jacobi
// Method for Real Symmetric Matrices, 1966): a fixed number of sweeps without a branch, so that lanes stay together. They
// converge quadratically and need no care where eigenvalues fall together: equal ones give no rotation.
#include <string.h>

#include "sim/surface.h"
#include "sim/wide/kernels.h"

#define SWEEPS 4
#define LARGEST_RATIO 4 // k_r
#define BOUND 1.2f      // largest semi-axis in particle radii

// One rotation in the plane (p, q), r being the third axis; vp and vq are columns of the eigenvectors.
static inline void rotate(SimF *pp, SimF *qq, SimF *pq, SimF *pr, SimF *qr, SimF vp[3], SimF vq[3]) {
  // What is nothing beside a trace of 1 is zero: its square would be a denormal number, which is slow.
  SimF zero = sim_f(0), one = sim_f(1), h = *qq - *pp, size = sim_max(*pq, zero - *pq);
  SimF g = sim_select_less(size, sim_f(1e-12f), zero, *pq + *pq);
  SimF wide = sim_max(h, zero - h) + sim_sqrt(h * h + g * g);
  SimF t = sim_select_less(h, zero, zero - g, g) / sim_max(wide, sim_f(1e-30f));
  SimF c = one / sim_sqrt(one + t * t), s = t * c, x = *pr;
  *pp = *pp - t * *pq;
  *qq = *qq + t * *pq;
  *pq = zero;
  *pr = c * x - s * *qr;
  *qr = s * x + c * *qr;
  for (int k = 0; k < 3; k++) {
    SimF v = vp[k];
    vp[k] = c * v - s * vq[k];
    vq[k] = s * v + c * vq[k];
  }
}

// Cube root of x in [1/16, 1] by Halley's iteration, which triples the digits; the start is right to a quarter.
static inline SimF cube_root(SimF x) {
  SimF y = sim_f(0.46f) + sim_f(0.56f) * x;
  for (int k = 0; k < 3; k++) {
    SimF y3 = y * y * y;
    y = y * (y3 + x + x) / (y3 + y3 + x);
  }
  return y;
}

static inline void shape(const SimF covariance[6], float radius, SimF ellipsoid[6]) {
  SimF zero = sim_f(0), one = sim_f(1), trace = covariance[0] + covariance[1] + covariance[2], m[6];
  // In units of the trace, so that nothing under- or overflows.
  for (int k = 0; k < 6; k++) m[k] = covariance[k] / sim_max(trace, sim_f(1e-36f));
  SimF v[3][3] = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}}; // v[k] belongs to the eigenvalue m[k]
  for (int sweep = 0; sweep < SWEEPS; sweep++) {
    rotate(&m[0], &m[1], &m[3], &m[4], &m[5], v[0], v[1]);
    rotate(&m[0], &m[2], &m[4], &m[3], &m[5], v[0], v[2]);
    rotate(&m[1], &m[2], &m[5], &m[3], &m[4], v[1], v[2]);
  }
  SimF largest = sim_max(sim_max(m[0], m[1]), sim_max(m[2], sim_f(0.1f))), value[3], volume = one;
  for (int k = 0; k < 3; k++) {
    value[k] = sim_max(m[k] / largest, sim_f(1.0f / LARGEST_RATIO));
    volume = volume * value[k];
  }
  SimF scale = sim_f(radius) / cube_root(volume);
  for (int k = 0; k < 3; k++) value[k] = sim_min(value[k] * scale, sim_f(BOUND * radius));
  const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
  for (int e = 0; e < 6; e++) {
    SimF sum = zero;
    for (int k = 0; k < 3; k++) sum = sum + value[k] * v[k][row[e]] * v[k][column[e]];
    ellipsoid[e] = sim_select_less(zero, trace, sum, sim_f(e < 3 ? radius : 0));
  }
}

void WIDE(sim_surface_ellipsoids)(int32_t begin, int32_t end, const void *context) {
  const SimEllipsoidContext *c = context;
  for (int32_t first = begin; first < end; first += SIM_CHUNK) {
    float from[6][SIM_CHUNK], *to = c->ellipsoid + 6 * (size_t)first;
    memcpy(from, to, sizeof from);
    for (int lane = 0; lane < SIM_CHUNK; lane += SIM_LANES) {
      SimF covariance[6], ellipsoid[6];
      float element[6][SIM_LANES];
      for (int k = 0; k < 6; k++) covariance[k] = sim_load(from[k] + lane);
      shape(covariance, c->radius, ellipsoid);
      for (int k = 0; k < 6; k++) sim_store(element[k], ellipsoid[k]);
      for (int k = 0; k < SIM_LANES; k++)
        for (int e = 0; e < 6; e++) *to++ = element[e][k];
    }
  }
}
