// Splash or aggregated, by the local density: Imai, Kanamori, Mitani, Real-Time Screen-Space Liquid Rendering with Complex
// Refractions, 2016, section 4.1. The density counts particles only: a drop on the floor is still a drop.
//
// Limits: a particle alone has 0.32, a pair 0.40, a flat sheet one particle thick 0.70, a line 0.48, the corner of a
// lattice 0.61, its inside 1. A splash is what is less than a sheet or a corner.
#include <math.h>
#include <stddef.h>

#include "sim/kernels.h"
#include "sim/parallel.h"
#include "sim/surface.h"

typedef struct DensityContext {
  const SimSurface *surface;
  SimCubic cubic;
  float *density;
  uint8_t *particle_class;
} DensityContext;

static float density_at(const SimSurface *surface, const SimCubic *cubic, int32_t i) {
  const float *restrict x = surface->position[0], *restrict y = surface->position[1],
                        *restrict z = surface->position[2];
  float px = x[i], py = y[i], pz = z[i], sum = 0, h2 = cubic->h * cubic->h;
  SimRange ranges[SIM_MAX_RANGES];
  int32_t n = sim_grid_ranges(surface->grid, (float[3]){px, py, pz}, cubic->h, ranges);
  for (int32_t r = 0; r < n; r++)
    for (int32_t j = ranges[r].begin; j < ranges[r].end; j++) {
      float dx = x[j] - px, dy = y[j] - py, dz = z[j] - pz, r2 = dx * dx + dy * dy + dz * dz;
      if (r2 < h2) sum += sim_cubic_value(cubic, sqrtf(r2));
    }
  return sum;
}

static void density_kernel(int32_t begin, int32_t end, const void *context) {
  const DensityContext *c = context;
  for (int32_t i = begin; i < end; i++) {
    float density = density_at(c->surface, &c->cubic, i);
    if (c->density) c->density[i] = density;
    if (c->particle_class) c->particle_class[i] = density < SIM_SPLASH_DENSITY ? SIM_SPLASH : SIM_AGGREGATED;
  }
}

static void run(const SimSurface *surface, float *density, uint8_t *particle_class) {
  DensityContext context = {surface, sim_cubic_make(surface->spacing, 2), density, particle_class};
  sim_parallel_for(surface->threads, surface->count, density_kernel, &context);
}

void sim_surface_density(const SimSurface *surface, float *density) {
  run(surface, density, NULL);
}

void sim_surface_classify(const SimSurface *surface, uint8_t *particle_class) {
  run(surface, NULL, particle_class);
}
