// How much a solid half-space adds to a particle's density sum.
//
// Behind a flat wall imagine the fluid's own cubic lattice to go on, its first layer half a spacing behind the surface.
// f(s) = V Σ W over that half lattice, for a particle at distance s. At s = spacing/2, where the first layer of water
// lies at rest, it is exactly what is missing there, so water neither stacks on a wall nor shuns it. Akinci et al. 2012
// get the same from particles on the wall; the sum in closed form needs none and leaves no bumps.
//
// For s < 0 (a point behind the surface) f(s) = 1 − f(−s): the lattice on both sides of the surface is whole. The cubic
// spline is close to a Gaussian, so the parts along x, y and z nearly factor: what is free of two walls that meet in an
// edge is (1 − f₁)(1 − f₂). In the lattice's edge this is right to 0.4 %, in its corner to 1 % (test_boundary). For the
// same reason solids that share no volume add up: a box is a product of slabs, stairs are a sum of such boxes.
//
// A curved surface is f again, at a distance shifted by κ σ²/2, where κ is the sum of its principal curvatures
// (positive where the solid is a ball) and σ² the kernel's second moment along one axis: to first order in κ the
// surface sinks away by κ ρ²/4 at the distance ρ beside the point, and the mean ρ² is 2σ². Against a lattice cut to a
// glass this is right to 0.006 for a radius of 2.5 spacings and to 0.002 for 10; for one spacing it is off by up to
// 0.05 (test_shapes).
#ifndef LIDO_SIM_WALL_H
#define LIDO_SIM_WALL_H

#include "sim/kernels.h"

#define SIM_WALL_STEPS 512
#define SIM_WALL_MOMENTS 128

// Like fminf and fmaxf, but the compiler makes single instructions of them. A NaN as `a` gives `b`.
static inline float sim_smaller(float a, float b) {
  return a < b ? a : b;
}

static inline float sim_larger(float a, float b) {
  return a > b ? a : b;
}

typedef struct SimWall {
  float reach;        ///< m: f = 0 beyond
  float inverse_step; ///< 1/m
  float spacing;      ///< m, of the lattice
  float spread;       ///< m², σ²
  float share[SIM_WALL_STEPS + 2]; ///< f at the distances 0, step, 2 step …
  float slope[SIM_WALL_STEPS + 2]; ///< df/ds, 1/m, never positive
  /// Where f is 0, 1/SIM_WALL_MOMENTS … 1: how much larger −V Σ x_n ∂W/∂x_n over the half lattice is, n across the wall, than f,
  /// which is what −V Σ x_t ∂W/∂x_t along the wall comes to. 0 behind the surface.
  float moment[SIM_WALL_MOMENTS + 1];
} SimWall;

void sim_wall_make(SimWall *wall, const SimCubic *cubic);

/// f(s) and its derivative.
static inline float sim_wall_share(const SimWall *wall, float s, float *slope) {
  float t = (s < 0 ? -s : s) * wall->inverse_step;
  if (!(t < SIM_WALL_STEPS)) { // also where it is a NaN, which the world names
    *slope = 0;
    return s < 0 ? 1 : 0;
  }
  int32_t k = (int32_t)t;
  float u = t - (float)k;
  *slope = wall->slope[k] + u * (wall->slope[k + 1] - wall->slope[k]);
  float share = wall->share[k] + u * (wall->share[k + 1] - wall->share[k]);
  return s < 0 ? 1 - share : share;
}

/// The share of the slab between −half and +half, seen from p, and its derivative.
static inline float sim_wall_slab(const SimWall *wall, float p, float half, float *slope) {
  float upper, lower;
  float share = sim_wall_share(wall, p - half, &upper) - sim_wall_share(wall, p + half, &lower);
  *slope = upper - lower;
  return share > 0 ? share : 0;
}

#endif
