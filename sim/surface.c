// The surface stages that are kernels in wide floats: see surface.h.
#include "sim/surface.h"

#include <string.h>

#include "sim/parallel.h"

void sim_surface_sweep(const SimSurface *surface, const SimSurfaceSums *sums) {
  SimSweepContext context = {surface, *sums, sim_cubic_make(surface->spacing, SIM_SURFACE_REACH)};
  if (sums->exposed) memset(sums->exposed + surface->count, 0, SIM_CHUNK); // the particles infinitely far away
  sim_parallel_for(surface->threads, surface->count, surface->wide->surface_sweep, &context);
}

void sim_surface_density(const SimWide *wide, const SimGrid *grid, const float *position, int32_t count, float spacing,
                         float *density, int32_t threads) {
  SimDensityContext context = {grid, position, sim_cubic_make(spacing, SIM_SURFACE_REACH), density};
  sim_parallel_for(threads, count, wide->surface_density, &context);
}

void sim_surface_ellipsoids(const SimWide *wide, int32_t count, float radius, float *covariance, int32_t threads) {
  sim_parallel_for(threads, count, wide->surface_ellipsoids, &(SimEllipsoidContext){radius, covariance});
}
