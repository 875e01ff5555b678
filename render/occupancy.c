#include "render/occupancy.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Edge of a cell (unless there would be too many) and how far a particle's water reaches along an axis, in radii. In a lattice
// of spacing two radii, even a disordered one, no point is farther than 1.6 from a particle along an axis, and cells of more
// than twice that have no holes. Small cells need a longer reach.
static const struct {
  float cell, reach;
} grains[] = {[RENDER_OCCUPANCY_COARSE] = {4, 1.6f}, [RENDER_OCCUPANCY_FINE] = {1, 2.2f}};

#define MAX_CELLS (1 << 24)

static bool valid(const float p[3]) {
  // Comparisons are false for NaN.
  return fabsf(p[0]) < RENDER_FARTHEST && fabsf(p[1]) < RENDER_FARTHEST && fabsf(p[2]) < RENDER_FARTHEST;
}

// The box around all particles and their reach; false: there is none.
static bool bounds(const SimFrame *frame, float reach, float low[3], float high[3]) {
  for (int k = 0; k < 3; ++k) {
    low[k] = FLT_MAX;
    high[k] = -FLT_MAX;
  }
  for (int32_t i = 0; i < frame->count; ++i) {
    const float *p = frame->position + 3 * (size_t)i;
    for (int k = 0; k < 3 && valid(p); ++k) {
      low[k] = fminf(low[k], p[k] - reach);
      high[k] = fmaxf(high[k], p[k] + reach);
    }
  }
  return low[0] <= high[0];
}

static void size_grid(RenderOccupancy *o, const float low[3], const float high[3], float cell) {
  for (double cells = 2.0 * MAX_CELLS; cells > MAX_CELLS; cell *= 1.5f) {
    cells = 1;
    o->cell = cell;
    for (int k = 0; k < 3; ++k) cells *= floor((double)(high[k] - low[k]) / (double)cell) + 1;
  }
  for (int k = 0; k < 3; ++k) {
    o->origin[k] = low[k];
    o->size[k] = (int32_t)floorf((high[k] - low[k]) / o->cell) + 1;
  }
}

static int32_t cell_along(const RenderOccupancy *o, float x, int axis) {
  const int32_t c = (int32_t)((x - o->origin[axis]) / o->cell);
  return c < 0 ? 0 : c >= o->size[axis] ? o->size[axis] - 1 : c;
}

static void mark(RenderOccupancy *o, const float p[3], float reach) {
  int32_t from[3], to[3];
  for (int k = 0; k < 3; ++k) {
    from[k] = cell_along(o, p[k] - reach, k);
    to[k] = cell_along(o, p[k] + reach, k);
  }
  for (int32_t z = from[2]; z <= to[2]; ++z) {
    for (int32_t y = from[1]; y <= to[1]; ++y) {
      for (int32_t x = from[0]; x <= to[0]; ++x) {
        const int32_t c = (z * o->size[1] + y) * o->size[0] + x;
        o->staging[c / 32] |= 1u << (c % 32);
      }
    }
  }
}

bool render_occupancy_upload(RenderOccupancy *o, const SimFrame *frame, RenderOccupancyGrain grain,
                             RenderError *error) {
  const float radius = frame->particle_radius, r = radius > 1e-6f && radius < RENDER_FARTHEST ? radius : 1e-6f;
  const float reach = grains[grain].reach * r;
  float low[3], high[3];
  for (int k = 0; k < 3; ++k) o->size[k] = 0;
  if (!bounds(frame, reach, low, high)) return true;
  size_grid(o, low, high, grains[grain].cell * r);
  const size_t words = ((size_t)o->size[0] * (size_t)o->size[1] * (size_t)o->size[2] + 31) / 32;
  if (words > o->capacity) {
    uint32_t *grown = realloc(o->staging, words * sizeof *grown);
    if (grown == NULL) return gpu_fail(error, "out of memory for %zu cells", 32 * words);
    o->staging = grown;
    o->capacity = words;
  }
  memset(o->staging, 0, words * sizeof *o->staging);
  for (int32_t i = 0; i < frame->count; ++i) {
    const float *p = frame->position + 3 * (size_t)i;
    if (valid(p)) mark(o, p, reach);
  }
  return gpu_buffer_write(&o->bits, "occupancy", o->staging, words * sizeof *o->staging, error);
}

RenderOccupancyBlock render_occupancy_block(const RenderOccupancy *o) {
  return (RenderOccupancyBlock){{o->origin[0], o->origin[1], o->origin[2], o->cell},
                                {o->size[0], o->size[1], o->size[2], 0}};
}

void render_occupancy_destroy(RenderOccupancy *o) {
  gpu_buffer_destroy(&o->bits);
  free(o->staging);
  *o = (RenderOccupancy){0};
}
