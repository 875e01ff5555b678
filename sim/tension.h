#ifndef LIDO_SIM_TENSION_H
#define LIDO_SIM_TENSION_H

#include "sim/solver.h"

/// The longest substep that capillary waves allow, s; infinite without surface tension.
double sim_tension_longest(const SimWorld *world);

/// Change next_velocity by a substep of surface tension at the positions in `place`, `first` or `second` (x, y, z and anything);
/// if it is `second`, also move `first` along.
void sim_step_tension(const SimStep *step, const SimWorldDef *def, const float *place);

#endif
