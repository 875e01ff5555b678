// The table of kernels that are compiled once for every instruction set, and the choice among them at run time.
//
// Particles are worked on in chunks of SIM_CHUNK neighbours in memory. A kernel gets (begin, end, context) like every
// other (sim/parallel.h); begin is a multiple of SIM_BLOCK, and arrays are padded so that whole chunks can be read and
// written.
#ifndef LIDO_SIM_WIDE_WIDE_H
#define LIDO_SIM_WIDE_WIDE_H

#include "sim/parallel.h"

/// Particles of a chunk: as many as the widest instruction set has lanes, on every one of them.
#define SIM_CHUNK 16

typedef struct SimWide {
  const char *name;                ///< "avx512", "avx2", "sse2", "scalar"
  SimKernel *list_block;           ///< neighbour lists of one block (SimListContext)
  // The kernels of the solvers: SimStep, see solver.h.
  SimKernel *pbf_inherit, *pbf_density;
  SimReduceKernel *pbf_start, *pbf_correct;
  SimKernel *sph_density, *sph_force;
  SimKernel *diffuse, *tension_normal, *tension_force, *vorticity_curl, *vorticity_confine;
  // The kernels of the surface stages, see surface.h: SimSweepContext, SimDensityContext, SimEllipsoidContext,
  // SimHeightContext.
  SimKernel *surface_sweep, *surface_density, *surface_ellipsoids, *surface_heights;
  SimKernel *machine_fma;          ///< multiply-adds to measure the machine by (SimFmaContext, machine.h)
} SimWide;

/// The widest one that this processor has; always the same. `sim_wide_named` finds another one that works here (NULL:
/// none), for tests and benchmarks.
const SimWide *sim_wide(void);
const SimWide *sim_wide_named(const char *name);

#endif
