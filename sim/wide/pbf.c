// The two sweeps of a position based density iteration over neighbour lists: see solver_pbf.h for the method.
#include "sim/solver.h"
#include "sim/wide/kernels.h"
#include "sim/wide/spline.h"
#include "sim/wide/walls.h"

/// Sums over the neighbours of the particles of one chunk.
typedef struct DensitySums {
  SimF density, squares, gradient[3];
} DensitySums;

static inline DensitySums sum_density(const SimStep *step, const SimF own[4], const uint32_t *index, uint32_t slots) {
  const Spline s = spline_make(&step->cubic);
  const float *first = step->particles->first;
  DensitySums sums = {s.zero, s.zero, {s.zero, s.zero, s.zero}};
  for (uint32_t k = 0; k < slots; k++, index += SIM_CHUNK) {
    SimF other[4], w, over_r;
    sim_gather4(first, index, other);
    SimF dx = own[0] - other[0], dy = own[1] - other[1], dz = own[2] - other[2];
    SimF g = spline(&s, dx * dx + dy * dy + dz * dz, &w, &over_r);
    sums.density = sums.density + w;
    sums.squares = sums.squares + g * g;
    sums.gradient[0] = sums.gradient[0] + over_r * dx;
    sums.gradient[1] = sums.gradient[1] + over_r * dy;
    sums.gradient[2] = sums.gradient[2] + over_r * dz;
  }
  return sums;
}

// What an iteration makes of a density: λ (Eq. 11, damped). Either projected, so that the pressure it adds up to never
// pulls, and only against compression that the substep itself has brought; or, to stabilise, against all of it.
static inline SimF lambda(const SimStep *step, int32_t i, SimF density, SimF squares) {
  SimF strength = sim_f(-step->omega) / (squares + sim_f(step->relaxation)), excess = density - sim_f(1);
  if (step->stabilise) return strength * sim_max(excess, sim_f(0));
  float *pressure = step->particles->now.pressure + i;
  SimF before = sim_load(pressure), inherited = sim_load(step->particles->density + i);
  SimF after = sim_min(before + strength * (excess - inherited), sim_f(0));
  sim_store(pressure, after);
  return after - before;
}

void WIDE(sim_pbf_density)(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  const SimNeighbours *lists = step->neighbours;
  SimParticles *p = step->particles;
  const SimCubic *cubic = &step->cubic;
  SimF value = sim_f(2 * cubic->value_scale), slope = sim_f(6 * cubic->gradient_scale);
  for (int32_t i = begin; i < end; i += SIM_LANES) {
    const int32_t chunk = i / SIM_CHUNK;
    SimF own[4], solid[4];
    sim_load4(p->first + 4 * (size_t)i, own);
    WIDE(sim_wall_solid)(step, i, own, solid);
    DensitySums sums = sum_density(step, own, lists->index + (size_t)lists->start[chunk] * SIM_CHUNK + i % SIM_CHUNK,
                                   lists->length[chunk]);
    SimF density = sim_f(cubic->value_scale) + solid[3] + value * sums.density, own_square = sim_f(0);
    for (int k = 0; k < 3; k++) {
      SimF gradient = solid[k] + slope * sums.gradient[k];
      own_square = own_square + gradient * gradient;
    }
    SimF w;
    if (step->measure) {
      sim_store(p->density + i, density);
      w = sim_sqrt(own_square) * sim_f(cubic->spacing);
    } else
      w = lambda(step, i, density, slope * slope * sums.squares + own_square);
    sim_store4(p->second + 4 * (size_t)i, own[0], own[1], own[2], w);
  }
}

// ---- Correction ------------------------------------------------------------------------------------------------------

// Δp_i = Σ_j (λ_i + λ_j + s_corr) ∇W, Eq. 14, s_corr = −k (W(r)/W(Δq))⁴, Δq = 0.2 h, Eq. 13.
static inline void sum_moves(const SimStep *step, bool tensile, const SimF own[4], const uint32_t *index, uint32_t slots,
                             SimF move[3]) {
  const Spline s = spline_make(&step->cubic);
  const float *second = step->particles->second;
  SimF strength = sim_f(-step->tensile), reference = sim_f(1 / 0.404f); // a³ − 4b³ at q = 0.2
  for (int k = 0; k < 3; k++) move[k] = s.zero;
  for (uint32_t k = 0; k < slots; k++, index += SIM_CHUNK) {
    SimF other[4], w, over_r;
    sim_gather4(second, index, other);
    SimF dx = own[0] - other[0], dy = own[1] - other[1], dz = own[2] - other[2];
    spline(&s, dx * dx + dy * dy + dz * dz, &w, &over_r);
    SimF factor = own[3] + other[3];
    if (tensile) {
      SimF ratio = w * reference, ratio2 = ratio * ratio;
      factor = factor + strength * (ratio2 * ratio2);
    }
    factor = factor * over_r;
    move[0] = move[0] + factor * dx;
    move[1] = move[1] + factor * dy;
    move[2] = move[2] + factor * dz;
  }
  for (int k = 0; k < 3; k++) move[k] = move[k] * sim_f(6 * step->cubic.gradient_scale);
}

// A correction changes the velocity by Δp/dt, and where the clamp had a say, by what was really moved. Taking Δp itself
// instead of the difference of rounded positions keeps the sum over all particles, the momentum, to the last digits.
void WIDE(sim_pbf_correct)(int32_t begin, int32_t end, const void *context, double *longest) {
  const SimStep *step = context;
  const SimNeighbours *lists = step->neighbours;
  SimParticles *p = step->particles;
  SimF zero = sim_f(0), most = zero, all = zero, wall = sim_f(step->wall_answer);
  for (int32_t i = begin; i < end; i += SIM_LANES) {
    const int32_t chunk = i / SIM_CHUNK;
    const uint32_t *index = lists->index + (size_t)lists->start[chunk] * SIM_CHUNK + i % SIM_CHUNK;
    SimF own[4], move[3], to[3];
    sim_load4(p->second + 4 * (size_t)i, own);
    if (step->tensile > 0)
      sum_moves(step, true, own, index, lists->length[chunk], move);
    else
      sum_moves(step, false, own, index, lists->length[chunk], move);
    SimF answer = wall * own[3];
    if (p->near[chunk]) {
      SimF solid[4];
      sim_load4(p->solid + 4 * (size_t)i, solid);
      for (int k = 0; k < 3; k++) move[k] = move[k] + answer * solid[k];
    }
    for (int k = 0; k < 3; k++) to[k] = own[k] + move[k];
    SimF gain[3] = {move[0], move[1], move[2]};
    if (p->near[chunk]) WIDE(sim_wall_clamp)(step, i, answer, own, move, to, gain);
    SimF d2 = zero;
    for (int k = 0; k < 3; k++) {
      float *v = p->now.next_velocity[k] + i;
      if (!step->stabilise) sim_store(v, sim_load(v) + gain[k] * sim_f(step->inverse_dt));
      d2 = d2 + move[k] * move[k];
    }
    sim_store4(p->first + 4 * (size_t)i, to[0], to[1], to[2], zero);
    if (i + SIM_LANES > p->count) d2 = WIDE(sim_only_particles)(p->count - i, d2);
    most = sim_max(most, d2);
    all = all + d2; // keeps a NaN, which the maximum may drop
  }
  float lane[SIM_LANES], sum[SIM_LANES];
  sim_store(lane, most);
  sim_store(sum, all);
  for (int k = 0; k < SIM_LANES; k++) {
    if ((double)lane[k] > longest[0]) longest[0] = lane[k];
    if (isnan(sum[k])) longest[0] = INFINITY;
  }
}

// ---- Before the first iteration ----------------------------------------------------------------------------------------

// The compression that the state at the start of the substep (in `second`) brings along, into `density`. The lists are those
// of the predicted positions; what they miss lies at the rim of the support, where W is next to nothing.
void WIDE(sim_pbf_inherit)(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  const SimNeighbours *lists = step->neighbours;
  SimParticles *p = step->particles;
  const Spline s = spline_make(&step->cubic);
  SimF value = sim_f(2 * step->cubic.value_scale);
  for (int32_t i = begin; i < end; i += SIM_LANES) {
    const uint32_t *index = lists->index + (size_t)lists->start[i / SIM_CHUNK] * SIM_CHUNK + i % SIM_CHUNK;
    SimF own[4], solid[4], sum = s.zero;
    sim_load4(p->second + 4 * (size_t)i, own);
    WIDE(sim_wall_solid)(step, i, own, solid);
    for (uint32_t k = 0; k < lists->length[i / SIM_CHUNK]; k++, index += SIM_CHUNK) {
      SimF other[4], w, over_r;
      sim_gather4(p->second, index, other);
      SimF dx = own[0] - other[0], dy = own[1] - other[1], dz = own[2] - other[2];
      spline(&s, dx * dx + dy * dy + dz * dz, &w, &over_r);
      sum = sum + w;
    }
    SimF density = sim_f(step->cubic.value_scale) + solid[3] + value * sum;
    sim_store(p->density + i, sim_max(density - s.one, s.zero));
  }
}

// `second` gets the predicted positions with the λ that the last substep's pressure stands for.
void WIDE(sim_pbf_prepare)(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  SimParticles *p = step->particles;
  for (int32_t i = begin; i < end; i += SIM_LANES) {
    SimF own[4], solid[4], lambda_first = sim_load(p->now.pressure + i) * sim_f(step->warm);
    sim_load4(p->first + 4 * (size_t)i, own);
    WIDE(sim_wall_solid)(step, i, own, solid);
    sim_store(p->now.pressure + i, lambda_first);
    sim_store4(p->second + 4 * (size_t)i, own[0], own[1], own[2], lambda_first);
  }
}
