// The two sweeps of vorticity confinement: see vorticity.c. Positions in `first`.
#include "sim/solver.h"
#include "sim/wide/kernels.h"
#include "sim/wide/spline.h"

// Into `work`: ω_i, 1/s, and |ω_i|, of the velocities in `second`. Eq. 15, ω = Σ V (v_j − v_i) × ∇_j W, divided by
// −⅓ Σ V r dW/dr, which is near 1 inside water and makes a rotation as a whole exact wherever neighbours lie evenly.
void WIDE(sim_vorticity_curl)(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  const SimNeighbours *lists = step->neighbours;
  SimParticles *p = step->particles;
  const Spline s = spline_make(&step->cubic);
  SimF slope = sim_f(6 * step->cubic.gradient_scale), third = sim_f(1.0f / 3), least = sim_f(0.1f);
  for (int32_t i = begin; i < end; i += SIM_LANES) {
    const uint32_t *index = lists->index + (size_t)lists->start[i / SIM_CHUNK] * SIM_CHUNK + i % SIM_CHUNK;
    SimF own[4], v[4], moment = s.zero, curl[3] = {s.zero, s.zero, s.zero};
    sim_load4(p->first + 4 * (size_t)i, own);
    sim_load4(p->second + 4 * (size_t)i, v);
    for (uint32_t k = 0; k < lists->length[i / SIM_CHUNK]; k++, index += SIM_CHUNK) {
      SimF other[4], u[4], d[3], w, over_r;
      sim_gather4(p->first, index, other);
      sim_gather4(p->second, index, u);
      for (int a = 0; a < 3; a++) {
        d[a] = own[a] - other[a];
        u[a] = u[a] - v[a];
      }
      SimF r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
      spline(&s, r2, &w, &over_r);
      moment = moment - over_r * r2;
      curl[0] = curl[0] - over_r * (u[1] * d[2] - u[2] * d[1]);
      curl[1] = curl[1] - over_r * (u[2] * d[0] - u[0] * d[2]);
      curl[2] = curl[2] - over_r * (u[0] * d[1] - u[1] * d[0]);
    }
    SimF scale = slope / sim_max(third * slope * moment, least);
    for (int a = 0; a < 3; a++) curl[a] = scale * curl[a];
    SimF size = sim_sqrt(curl[0] * curl[0] + curl[1] * curl[1] + curl[2] * curl[2]);
    sim_store4(p->work + 4 * (size_t)i, curl[0], curl[1], curl[2], size);
  }
}

// dv/dt = ε d |ω| (N × ω), N = η/|η|, η = Σ V (|ω_j| − |ω_i|) ∇W: Eq. 16.
void WIDE(sim_vorticity_confine)(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  const SimNeighbours *lists = step->neighbours;
  SimParticles *p = step->particles;
  const Spline s = spline_make(&step->cubic);
  SimF slope = sim_f(6 * step->cubic.gradient_scale * step->cubic.spacing);
  SimF strength = sim_f(step->confinement * step->cubic.spacing * step->dt), most = sim_f(step->inverse_dt);
  for (int32_t i = begin; i < end; i += SIM_LANES) {
    const uint32_t *index = lists->index + (size_t)lists->start[i / SIM_CHUNK] * SIM_CHUNK + i % SIM_CHUNK;
    SimF own[4], turn[4], eta[3] = {s.zero, s.zero, s.zero};
    sim_load4(p->first + 4 * (size_t)i, own);
    sim_load4(p->work + 4 * (size_t)i, turn);
    for (uint32_t k = 0; k < lists->length[i / SIM_CHUNK]; k++, index += SIM_CHUNK) {
      SimF other[4], there[4], d[3], w, over_r;
      sim_gather4(p->first, index, other);
      sim_gather4(p->work, index, there);
      for (int a = 0; a < 3; a++) d[a] = own[a] - other[a];
      spline(&s, d[0] * d[0] + d[1] * d[1] + d[2] * d[2], &w, &over_r);
      for (int a = 0; a < 3; a++) eta[a] = eta[a] + (there[3] - turn[3]) * over_r * d[a];
    }
    for (int a = 0; a < 3; a++) eta[a] = slope * eta[a];
    // η is a difference of |ω| over a spacing here; where it is a thousandth of |ω| or less it is noise and has no direction.
    SimF length =
        sim_sqrt(eta[0] * eta[0] + eta[1] * eta[1] + eta[2] * eta[2]) + sim_f(1e-3f) * turn[3] + sim_f(1e-30f);
    SimF scale = strength * sim_min(turn[3], most) / length;
    const SimF push[3] = {eta[1] * turn[2] - eta[2] * turn[1], eta[2] * turn[0] - eta[0] * turn[2],
                          eta[0] * turn[1] - eta[1] * turn[0]};
    for (int a = 0; a < 3; a++) {
      float *to = p->now.next_velocity[a] + i;
      sim_store(to, sim_load(to) + scale * push[a]);
    }
  }
}
