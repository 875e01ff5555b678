// Which particles can be seen from outside the water: the exposed ones (wide/surface.c says which) and all within
// SIM_SURFACE_REACH of one, which show through the gaps between them. That makes two to three layers.
//
// The flags err on the side of too many: a cavity inside the water is flagged although nothing sees it, and water that
// is torn apart is flagged almost whole. The limits of `exposed` were chosen so that no ray of test_flags sees an
// unflagged sphere of 1.25 r while water at rest stays below three layers. That is measured, not proved.
#include <stddef.h>

#include "sim/parallel.h"
#include "sim/surface.h"

typedef struct FlagContext {
  const SimSurface *surface;
  const uint8_t *exposed;
  uint8_t *near_surface;
} FlagContext;

static void flag_kernel(int32_t begin, int32_t end, const void *context) {
  const FlagContext *c = context;
  const SimNeighbours *lists = c->surface->lists;
  const uint8_t *restrict exposed = c->exposed;
  for (int32_t first = begin; first < end; first += SIM_CHUNK) {
    const uint32_t *restrict index = lists->index + (size_t)lists->start[first / SIM_CHUNK] * SIM_CHUNK;
    uint32_t seen[SIM_CHUNK];
    for (int lane = 0; lane < SIM_CHUNK; lane++) seen[lane] = exposed[first + lane];
    for (uint32_t k = 0; k < lists->length[first / SIM_CHUNK]; k++, index += SIM_CHUNK)
      for (int lane = 0; lane < SIM_CHUNK; lane++) seen[lane] |= exposed[index[lane]];
    for (int lane = 0; lane < SIM_CHUNK && first + lane < end; lane++)
      c->near_surface[first + lane] = (uint8_t)seen[lane];
  }
}

void sim_surface_flags(const SimSurface *surface, const uint8_t *exposed, uint8_t *near_surface) {
  sim_parallel_for(surface->threads, surface->count, flag_kernel, &(FlagContext){surface, exposed, near_surface});
}
