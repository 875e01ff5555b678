// Which particles can be seen from outside the water.
//
// A particle is exposed if it has an open direction: none of its neighbours lies within COVER spacings of the ray from
// its centre in that direction. Walls cover nothing: tanks are made of glass. A fixed set of directions is tested. What
// lies within LAYER spacings of an exposed particle is flagged too, because it shows through the gaps between the
// exposed ones; that makes two to three layers.
//
// The flags err on the side of too many: a cavity inside the water is flagged although nothing sees it, and water that
// is torn apart is flagged almost whole. COVER and LAYER were chosen so that no ray of test_flags sees an unflagged
// sphere of 1.25 r (thicker cover or a thinner layer: about one ray in a thousand does, down a crack) while water at rest
// stays below three layers. That is measured, not proved.
#include <math.h>
#include <string.h>

#include "sim/parallel.h"
#include "sim/surface.h"

#define DIRECTIONS 64
#define REACH 2.0f
#define COVER 0.7f
#define LAYER 2.0f

typedef struct FlagContext {
  const SimSurface *surface;
  float direction[3][DIRECTIONS];
  uint8_t *exposed, *near_surface;
} FlagContext;

// Points spread evenly over the sphere along a golden spiral.
static void spread_directions(FlagContext *c) {
  for (int k = 0; k < DIRECTIONS; k++) {
    double y = 1 - (2 * k + 1) / (double)DIRECTIONS, r = sqrt(1 - y * y), angle = k * 2.399963229728653;
    c->direction[0][k] = (float)(r * cos(angle));
    c->direction[1][k] = (float)y;
    c->direction[2][k] = (float)(r * sin(angle));
  }
}

// A neighbour at d covers direction u where d·u > 0 and |d|² − (d·u)² < cover²; one nearer than `cover` covers every
// direction on its side.
static void cover(const FlagContext *c, const float d[3], float d2, float cover2, int32_t covered[DIRECTIONS]) {
  float least = d2 > cover2 ? sqrtf(d2 - cover2) : 0;
  for (int k = 0; k < DIRECTIONS; k++)
    covered[k] |= d[0] * c->direction[0][k] + d[1] * c->direction[1][k] + d[2] * c->direction[2][k] > least;
}

static bool all_covered(const int32_t covered[DIRECTIONS]) {
  int32_t all = 1;
  for (int k = 0; k < DIRECTIONS; k++) all &= covered[k];
  return all;
}

static bool is_exposed(const FlagContext *c, int32_t i) {
  const SimSurface *surface = c->surface;
  const float *restrict x = surface->position[0], *restrict y = surface->position[1],
                        *restrict z = surface->position[2];
  const float point[3] = {x[i], y[i], z[i]};
  float reach2 = REACH * REACH * surface->spacing * surface->spacing,
        cover2 = COVER * COVER * surface->spacing * surface->spacing;
  int32_t covered[DIRECTIONS] = {0};
  SimRange ranges[SIM_MAX_RANGES];
  int32_t n = sim_grid_ranges(surface->grid, point, REACH * surface->spacing, ranges);
  for (int32_t r = 0; r < n; r++) {
    for (int32_t j = ranges[r].begin; j < ranges[r].end; j++) {
      float d[3] = {x[j] - point[0], y[j] - point[1], z[j] - point[2]};
      float d2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
      if (d2 < reach2 && j != i) cover(c, d, d2, cover2, covered);
    }
    if (all_covered(covered)) return false;
  }
  return true;
}

static void expose_kernel(int32_t begin, int32_t end, const void *context) {
  const FlagContext *c = context;
  for (int32_t i = begin; i < end; i++) c->exposed[i] = is_exposed(c, i);
}

static bool near_exposed(const FlagContext *c, int32_t i) {
  const SimSurface *surface = c->surface;
  const float *restrict x = surface->position[0], *restrict y = surface->position[1],
                        *restrict z = surface->position[2];
  const float point[3] = {x[i], y[i], z[i]};
  float reach = LAYER * surface->spacing;
  SimRange ranges[SIM_MAX_RANGES];
  int32_t n = sim_grid_ranges(surface->grid, point, reach, ranges);
  for (int32_t r = 0; r < n; r++)
    for (int32_t j = ranges[r].begin; j < ranges[r].end; j++) {
      float dx = x[j] - point[0], dy = y[j] - point[1], dz = z[j] - point[2];
      if (c->exposed[j] && dx * dx + dy * dy + dz * dz < reach * reach) return true;
    }
  return false;
}

static void flag_kernel(int32_t begin, int32_t end, const void *context) {
  const FlagContext *c = context;
  for (int32_t i = begin; i < end; i++) c->near_surface[i] = c->exposed[i] || near_exposed(c, i);
}

void sim_surface_flags(const SimSurface *surface, uint8_t *work, uint8_t *near_surface) {
  FlagContext context = {.surface = surface, .exposed = work, .near_surface = near_surface};
  spread_directions(&context);
  sim_parallel_for(surface->threads, surface->count, expose_kernel, &context);
  sim_parallel_for(surface->threads, surface->count, flag_kernel, &context);
}
