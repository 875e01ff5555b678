// Every method by its number in SimSolver.
#include <stddef.h>

#include "sim/solver_pbf.h"
#include "sim/solver_sph.h"

const SimMethod *sim_method(SimSolver solver) {
  static const SimMethod *const methods[] = {[SIM_SOLVER_PBF] = &sim_method_pbf, [SIM_SOLVER_SPH] = &sim_method_sph};
  return (int)solver >= 0 && (size_t)solver < sizeof methods / sizeof *methods ? methods[solver] : NULL;
}
