// Neighbour lists: see neighbours.h. Two sweeps, count and fill, so that the lists are packed without gaps and without a
// limit per particle; the places come from a prefix sum and are the same for any number of threads.
#include "sim/neighbours.h"

#include <string.h>

#include "sim/memory.h"
#include "sim/parallel.h"

#define CHUNK 256

typedef struct ListContext {
  SimNeighbours *neighbours;
  const SimGrid *grid;
  float *const *position;
} ListContext;

static void count_kernel(int32_t begin, int32_t end, const void *context) {
  const ListContext *c = context;
  const float *restrict x = c->position[0], *restrict y = c->position[1], *restrict z = c->position[2];
  float radius2 = c->neighbours->radius * c->neighbours->radius;
  SimRange ranges[SIM_MAX_RANGES];
  for (int32_t i = begin; i < end; i++) {
    float px = x[i], py = y[i], pz = z[i];
    int32_t count = 0, n = sim_grid_ranges(c->grid, (float[3]){px, py, pz}, c->neighbours->radius, ranges);
    for (int32_t r = 0; r < n; r++)
      for (int32_t j = ranges[r].begin; j < ranges[r].end; j++) {
        float dx = x[j] - px, dy = y[j] - py, dz = z[j] - pz;
        count += dx * dx + dy * dy + dz * dz < radius2;
      }
    c->neighbours->start[i + 1] = (uint32_t)(count - 1); // not itself
  }
}

static void fill_kernel(int32_t begin, int32_t end, const void *context) {
  const ListContext *c = context;
  float radius2 = c->neighbours->radius * c->neighbours->radius;
  SimRange ranges[SIM_MAX_RANGES];
  uint32_t found[CHUNK];
  for (int32_t i = begin; i < end; i++) {
    const float point[3] = {c->position[0][i], c->position[1][i], c->position[2][i]};
    uint32_t *list = c->neighbours->index + c->neighbours->start[i];
    int32_t n = sim_grid_ranges(c->grid, point, c->neighbours->radius, ranges);
    for (int32_t r = 0; r < n; r++)
      for (int32_t at = ranges[r].begin; at < ranges[r].end; at += CHUNK) {
        int32_t stop = ranges[r].end - at < CHUNK ? ranges[r].end : at + CHUNK;
        int32_t count = sim_range_search(c->position, (SimRange){at, stop}, point, radius2, found);
        for (int32_t k = 0; k < count; k++)
          if (found[k] != (uint32_t)i) *list++ = found[k];
      }
  }
}

SimNeighbourResult sim_neighbours_build(SimNeighbours *neighbours, const SimGrid *grid, float *const position[3],
                                        int32_t count, float radius, int32_t threads) {
  if (sim_grid_candidates(grid, radius) > 4e11) return SIM_NEIGHBOURS_CROWDED;
  if (!sim_reserve((void **)&neighbours->start, (size_t)count + 1, sizeof(uint32_t))) return SIM_NEIGHBOURS_NO_MEMORY;
  neighbours->radius = radius;
  ListContext context = {neighbours, grid, position};
  sim_parallel_for(threads, count, count_kernel, &context);
  int64_t pairs = 0;
  neighbours->start[0] = 0;
  for (int32_t i = 0; i < count; i++) {
    pairs += neighbours->start[i + 1];
    neighbours->start[i + 1] = (uint32_t)pairs;
  }
  neighbours->pairs = pairs;
  if (pairs > UINT32_MAX || (count > 4096 && pairs / count > SIM_MAX_MEAN_NEIGHBOURS)) return SIM_NEIGHBOURS_CROWDED;
  // Room for a fluid twice as crowded as the lattice, so that a splash does not allocate.
  size_t room = (size_t)pairs > 64 * (size_t)count ? (size_t)pairs : 64 * (size_t)count;
  if (!sim_reserve((void **)&neighbours->index, room, sizeof(uint32_t)) ||
      !sim_reserve((void **)&neighbours->gradient, room, sizeof(float)))
    return SIM_NEIGHBOURS_NO_MEMORY;
  sim_parallel_for(threads, count, fill_kernel, &context);
  return SIM_NEIGHBOURS_OK;
}

void sim_neighbours_free(SimNeighbours *neighbours) {
  sim_release(neighbours->start);
  sim_release(neighbours->index);
  sim_release(neighbours->gradient);
  memset(neighbours, 0, sizeof *neighbours);
}
