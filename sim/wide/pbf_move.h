// The end of every sweep of position based fluids that moves particles: what the walls add, the clamp, the velocity.
#ifndef LIDO_SIM_WIDE_PBF_MOVE_H
#define LIDO_SIM_WIDE_PBF_MOVE_H

#include "sim/solver.h"
#include "sim/wide/simd.h"
#include "sim/wide/walls.h"

/// Of the particles so far: the longest move, squared, and a sum that keeps a NaN, which a maximum may drop.
typedef struct PbfMoved {
  SimF most, all;
} PbfMoved;

static inline PbfMoved pbf_moved_none(void) {
  return (PbfMoved){sim_f(0), sim_f(0)};
}

static inline void pbf_moved_longest(const PbfMoved *moved, double *longest) {
  float lane[SIM_LANES], sum[SIM_LANES];
  sim_store(lane, moved->most);
  sim_store(sum, moved->all);
  for (int k = 0; k < SIM_LANES; k++) {
    if ((double)lane[k] > longest[0]) longest[0] = lane[k];
    if (isnan(sum[k])) longest[0] = INFINITY;
  }
}

/// Move the SIM_LANES particles from i on by `move`, what their neighbours give, and by what the walls do, from `own` (position
/// and λ) to `target`. `solid` matters only where their chunk is near something.
//
// A correction changes the velocity by Δp/dt, and where the clamp had a say, by what was really moved. Taking Δp itself
// instead of the difference of rounded positions keeps the sum over all particles, the momentum, to the last digits.
static inline void pbf_move(const SimStep *step, int32_t i, const SimF own[4], const SimF solid[4], SimF move[3], float *target,
                            PbfMoved *moved) {
  SimParticles *p = step->particles;
  SimF to[3], gain[3], d2 = sim_f(0);
  bool near = p->near[i / SIM_CHUNK] != 0;
  SimWallAnswer answer;
  if (near) {
    WIDE(sim_wall_answer)(step, sim_f(step->wall_answer) * own[3], solid, move, &answer);
    for (int k = 0; k < 3; k++) move[k] = move[k] + answer.aside[k] + answer.pressure * solid[k];
  }
  for (int k = 0; k < 3; k++) {
    to[k] = own[k] + move[k];
    gain[k] = move[k];
  }
  if (near) WIDE(sim_wall_clamp)(step, i, &answer, own, move, to, gain);
  for (int k = 0; k < 3; k++) {
    float *v = p->now.next_velocity[k] + i;
    if (!step->stabilise) sim_store(v, sim_load(v) + gain[k] * sim_f(step->inverse_dt));
    d2 = d2 + move[k] * move[k];
  }
  sim_store4(target + 4 * (size_t)i, to[0], to[1], to[2], sim_f(0));
  if (i + SIM_LANES > p->count) d2 = WIDE(sim_only_particles)(p->count - i, d2);
  moved->most = sim_max(moved->most, d2);
  moved->all = moved->all + d2;
}

#endif
