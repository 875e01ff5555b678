// The walls in wide floats: the box's own here, everything else particle by particle through boundary.h.
#ifndef LIDO_SIM_WIDE_WALLS_H
#define LIDO_SIM_WIDE_WALLS_H

#include "sim/solver.h"
#include "sim/wide/simd.h"

/// Gradient (1/m) and share of what is solid around the SIM_LANES particles from i on, also stored in `solid`; zero, and not
/// stored, where their chunk is near nothing. What of it is of floating bodies is noted (step->reaction).
void WIDE(sim_wall_solid)(const SimStep *step, int32_t i, const SimF own[4], SimF solid[4]);

/// Keep the particles' way from `own` to `to` clear of all walls; where it was changed, `move` is what is left of it. `gain` is
/// how much next_velocity is about to change, times dt, before and with the clamp; of the former, `answer` (m²) times what
/// sim_wall_solid said is the bodies'.
void WIDE(sim_wall_clamp)(const SimStep *step, int32_t i, SimF answer, const SimF own[3], SimF move[3], SimF to[3],
                          SimF gain[3]);

/// `value` in the first `count` lanes, zero in the others.
static inline SimF WIDE(sim_only_particles)(int32_t count, SimF value) {
  float lane[SIM_LANES];
  sim_store(lane, value);
  for (int k = 0; k < SIM_LANES; k++)
    if (k >= count) lane[k] = 0;
  return sim_load(lane);
}

#endif
