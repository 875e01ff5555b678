#ifndef LIDO_SIM_SOLVER_SPH_H
#define LIDO_SIM_SOLVER_SPH_H

#include "sim/solver.h"

extern const SimMethod sim_method_sph;

#endif
