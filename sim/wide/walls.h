// The walls in wide floats: the box's own here, everything else particle by particle through boundary.h.
#ifndef LIDO_SIM_WIDE_WALLS_H
#define LIDO_SIM_WIDE_WALLS_H

#include "sim/solver.h"
#include "sim/wide/simd.h"

/// Gradient (1/m) and share of what is solid around the SIM_LANES particles from i on; zero where their chunk is near nothing.
/// What of it is of floating bodies is noted (step->reaction).
void WIDE(sim_wall_solid_here)(const SimStep *step, int32_t i, const SimF own[4], SimF solid[4]);
/// The same, also stored in `solid` where their chunk is near something.
void WIDE(sim_wall_solid)(const SimStep *step, int32_t i, const SimF own[4], SimF solid[4]);

/// What walls do to particles in one sweep: they move them by pressure · solid + aside.
typedef struct SimWallAnswer {
  SimF pressure;        ///< m²
  SimF aside[3];        ///< m
  const SimF *solid;    ///< what sim_wall_solid said
} SimWallAnswer;

/// With `pressure` given (m²), find the answer to `move`, what neighbours give: see "Walls" in solver_pbf.h.
void WIDE(sim_wall_answer)(const SimStep *step, SimF pressure, const SimF solid[4], const SimF move[3], SimWallAnswer *answer);

/// Keep the particles' way from `own` to `to` clear of all walls; where it was changed, `move` is what is left of it. `gain` is
/// how much next_velocity is about to change, times dt, before and with the clamp.
void WIDE(sim_wall_clamp)(const SimStep *step, int32_t i, const SimWallAnswer *answer, const SimF own[3], SimF move[3],
                          SimF to[3], SimF gain[3]);

/// Note what floating bodies have of an answer, where nothing is clamped (step->reaction must be there).
void WIDE(sim_wall_note)(const SimStep *step, int32_t i, const SimWallAnswer *answer);

/// `value` in the first `count` lanes, zero in the others.
static inline SimF WIDE(sim_only_particles)(int32_t count, SimF value) {
  float lane[SIM_LANES];
  sim_store(lane, value);
  for (int k = 0; k < SIM_LANES; k++)
    if (k >= count) lane[k] = 0;
  return sim_load(lane);
}

#endif
