// The two sweeps of surface tension: see tension.h. Positions are read from step->place.
#include "sim/solver.h"
#include "sim/wide/kernels.h"
#include "sim/wide/spline.h"
#include "sim/wide/walls.h"

// Into `work`: n_i = h Σ V/ρ_j ∇W, with ρ_i for ρ_j (walls count like water), and the density ρ_i as a share of ρ0.
void WIDE(sim_tension_normal)(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  const SimNeighbours *lists = step->neighbours;
  SimParticles *p = step->particles;
  const SimCubic *cubic = &step->cubic;
  const Spline s = spline_make(cubic);
  SimF value = sim_f(2 * cubic->value_scale), slope = sim_f(6 * cubic->gradient_scale), h = sim_f(cubic->h);
  for (int32_t i = begin; i < end; i += SIM_LANES) {
    const uint32_t *index = lists->index + (size_t)lists->start[i / SIM_CHUNK] * SIM_CHUNK + i % SIM_CHUNK;
    SimF own[4], solid[4], density = s.zero, sum[3] = {s.zero, s.zero, s.zero};
    sim_load4(step->place + 4 * (size_t)i, own);
    WIDE(sim_wall_solid)(step, i, own, solid);
    for (uint32_t k = 0; k < lists->length[i / SIM_CHUNK]; k++, index += SIM_CHUNK) {
      SimF other[4], w, over_r;
      sim_gather4(step->place, index, other);
      SimF dx = own[0] - other[0], dy = own[1] - other[1], dz = own[2] - other[2];
      spline(&s, dx * dx + dy * dy + dz * dz, &w, &over_r);
      density = density + w;
      sum[0] = sum[0] + over_r * dx;
      sum[1] = sum[1] + over_r * dy;
      sum[2] = sum[2] + over_r * dz;
    }
    density = sim_f(cubic->value_scale) + solid[3] + value * density;
    for (int k = 0; k < 3; k++) sum[k] = h * (slope * sum[k] + solid[k]) / density;
    sim_store4(p->work + 4 * (size_t)i, sum[0], sum[1], sum[2], density);
  }
}

// dv_i/dt = −Σ_j K_ij (γ m C(r) r̂ + γ' V W (n_i − n_j)), K_ij = 2/(ρ_i + ρ_j).
void WIDE(sim_tension_force)(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  const SimNeighbours *lists = step->neighbours;
  SimParticles *p = step->particles;
  const SimCubic *cubic = &step->cubic;
  const Spline s = spline_make(cubic);
  SimF pull = sim_f(step->cohesion), bend = sim_f(step->curvature * 2 * cubic->value_scale), two = sim_f(2);
  for (int32_t i = begin; i < end; i += SIM_LANES) {
    const uint32_t *index = lists->index + (size_t)lists->start[i / SIM_CHUNK] * SIM_CHUNK + i % SIM_CHUNK;
    SimF own[4], normal[4], sum[3] = {s.zero, s.zero, s.zero};
    sim_load4(step->place + 4 * (size_t)i, own);
    sim_load4(p->work + 4 * (size_t)i, normal);
    for (uint32_t k = 0; k < lists->length[i / SIM_CHUNK]; k++, index += SIM_CHUNK) {
      SimF other[4], n[4], w, over_r, d[3];
      sim_gather4(step->place, index, other);
      sim_gather4(p->work, index, n);
      for (int a = 0; a < 3; a++) d[a] = own[a] - other[a];
      SimF r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], r = sim_sqrt(r2), q = r * s.inverse_h;
      spline(&s, r2, &w, &over_r);
      SimF t = sim_max(s.one - q, s.zero) * q, t3 = t * t * t;
      SimF cohesion = sim_select_less(s.half, q, t3, two * t3 - sim_f(1.0f / 64)) / sim_max(r, s.tiny);
      SimF both = two / (normal[3] + n[3]);
      for (int a = 0; a < 3; a++) sum[a] = sum[a] + both * (pull * cohesion * d[a] + bend * w * (normal[a] - n[a]));
    }
    for (int k = 0; k < 3; k++) {
      float *v = p->now.next_velocity[k] + i;
      sum[k] = sim_f(-step->dt) * sum[k];
      sim_store(v, sim_load(v) + sum[k]);
      own[k] = sum[k] * sim_f(step->dt);
    }
    if (step->place == p->first) continue;
    SimF to[4];
    sim_load4(p->first + 4 * (size_t)i, to);
    sim_store4(p->first + 4 * (size_t)i, to[0] + own[0], to[1] + own[1], to[2] + own[2], to[3]);
  }
}
