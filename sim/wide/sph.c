// The two sweeps of a substep of smoothed particle hydrodynamics: see solver_sph.h for the method.
#include "sim/wide/kernels.h"
#include "sim/wide/shear.h"
#include "sim/wide/spline.h"
#include "sim/wide/walls.h"

/// Sums over the neighbours of the particles of one chunk.
typedef struct Sums {
  SimF density, rate;
  Tensor moment;
} Sums;

// Σ W, Σ (v_i − v_j)·∇W and Σ (x_i − x_j) ⊗ ∇W; positions in `first`, velocities in `work`.
static inline Sums sum_density(const SimStep *step, const SimF own[4], const SimF v[4], const uint32_t *index,
                               uint32_t slots) {
  const Spline s = spline_make(&step->cubic);
  Sums sums = {s.zero, s.zero, tensor_zero()};
  for (uint32_t k = 0; k < slots; k++, index += SIM_CHUNK) {
    SimF other[4], u[4], w, over_r;
    sim_gather4(step->particles->first, index, other);
    sim_gather4(step->particles->work, index, u);
    SimF dx = own[0] - other[0], dy = own[1] - other[1], dz = own[2] - other[2];
    spline(&s, dx * dx + dy * dy + dz * dz, &w, &over_r);
    sums.density = sums.density + w;
    sums.rate = sums.rate + over_r * ((v[0] - u[0]) * dx + (v[1] - u[1]) * dy + (v[2] - u[2]) * dz);
    tensor_add(&sums.moment, over_r, dx, dy, dz);
  }
  return sums;
}

// p/(ρ0 ρ²), m²/s², of a density as a share of ρ0 and its rate: what the force sums up.
static inline SimF pressure(const SimStep *step, SimF density, SimF rate) {
  SimF zero = sim_f(0), one = sim_f(1), excess = density - one;
  // Full from the rest density on, nothing at 1 % below.
  SimF near = sim_max(sim_min(one + sim_f(100) * excess, one), zero);
  SimF p = sim_f(step->stiffness) * sim_max(excess, zero) + sim_f(step->bulk) * rate * near;
  return sim_max(p, zero) / (density * density);
}

void WIDE(sim_sph_density)(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  const SimNeighbours *lists = step->neighbours;
  SimParticles *p = step->particles;
  const SimCubic *cubic = &step->cubic;
  SimF value = sim_f(2 * cubic->value_scale), slope = sim_f(6 * cubic->gradient_scale);
  for (int32_t i = begin; i < end; i += SIM_LANES) {
    const int32_t chunk = i / SIM_CHUNK;
    SimF own[4], v[4], solid[4];
    sim_load4(p->first + 4 * (size_t)i, own);
    sim_load4(p->work + 4 * (size_t)i, v);
    WIDE(sim_wall_solid_here)(step, i, own, solid);
    Sums sums = sum_density(step, own, v, lists->index + (size_t)lists->start[chunk] * SIM_CHUNK + i % SIM_CHUNK,
                            lists->length[chunk]);
    SimF density = sim_f(cubic->value_scale) + solid[3] + value * sums.density, rate = slope * sums.rate;
    // A wall of the box stands still. What an obstacle's own motion adds to the rate is left out: it only damps.
    for (int k = 0; k < 3 && p->near[chunk] == SIM_NEAR_WALL; k++) rate = rate + solid[k] * v[k];
    sim_store(p->density + i, density);
    SimF press = pressure(step, density, rate);
    sim_store4(p->second + 4 * (size_t)i, own[0], own[1], own[2], press);
    shear_store(step, i, &sums.moment, solid, press);
  }
}

// dv_i/dt = −Σ_j V (P_i (1 + E_i) + P_j (1 + E_j)) ∇W and what the walls add; positions and P = p/(ρ0 ρ²) in `second`.
void WIDE(sim_sph_force)(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  SimParticles *p = step->particles;
  SimF scale = sim_f(-6 * step->cubic.gradient_scale * step->dt * step->dt),
       wall = sim_f(-step->wall_answer * step->dt * step->dt);
  for (int32_t i = begin; i < end; i += SIM_LANES) {
    SimF own[4], solid[4], move[3]; // move: the change of velocity, times dt
    sim_load4(p->second + 4 * (size_t)i, own);
    shear_sum(step, p->second, i, own, move);
    for (int k = 0; k < 3; k++) move[k] = scale * move[k];
    if (p->near[i / SIM_CHUNK]) {
      SimWallAnswer answer;
      WIDE(sim_wall_solid_here)(step, i, own, solid);
      WIDE(sim_wall_answer)(step, wall * own[3], solid, move, &answer);
      for (int k = 0; k < 3; k++) move[k] = move[k] + answer.aside[k] + answer.pressure * solid[k];
      if (step->reaction && p->near[i / SIM_CHUNK] & SIM_NEAR_BODY) WIDE(sim_wall_note)(step, i, &answer);
    }
    for (int k = 0; k < 3; k++) {
      float *v = p->now.next_velocity[k] + i;
      sim_store(v, sim_load(v) + sim_f(step->inverse_dt) * move[k]);
    }
    sim_store(p->now.pressure + i, sim_f(0) - own[3]);
  }
}
