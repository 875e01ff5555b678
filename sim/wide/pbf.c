// The two sweeps of a position based density iteration over neighbour lists: see solver_pbf.h for the method.
#include "sim/wide/kernels.h"
#include "sim/wide/pbf_move.h"
#include "sim/wide/spline.h"

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
  SimF change = strength * (excess - inherited);
  if (step->over > 1) {
    SimF last[4]; // with what the last iteration changed
    sim_load4(step->particles->second + 4 * (size_t)i, last);
    change = sim_f(step->over) * change + sim_f(step->over - 1) * last[3];
  }
  SimF after = sim_min(before + change, sim_f(0));
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

void WIDE(sim_pbf_correct)(int32_t begin, int32_t end, const void *context, double *longest) {
  const SimStep *step = context;
  const SimNeighbours *lists = step->neighbours;
  SimParticles *p = step->particles;
  PbfMoved moved = pbf_moved_none();
  for (int32_t i = begin; i < end; i += SIM_LANES) {
    const int32_t chunk = i / SIM_CHUNK;
    const uint32_t *index = lists->index + (size_t)lists->start[chunk] * SIM_CHUNK + i % SIM_CHUNK;
    SimF own[4], move[3], solid[4];
    sim_load4(p->second + 4 * (size_t)i, own);
    if (step->tensile > 0)
      sum_moves(step, true, own, index, lists->length[chunk], move);
    else
      sum_moves(step, false, own, index, lists->length[chunk], move);
    if (p->near[chunk]) sim_load4(p->solid + 4 * (size_t)i, solid);
    pbf_move(step, i, own, solid, move, p->first, &moved);
  }
  pbf_moved_longest(&moved, longest);
}
