// Neighbour lists: see neighbours.h.
//
// One sweep. Each block of SIM_BLOCK particles fills its own slab of the index array, one list after the other; a slab
// has room for ROOM neighbours a particle on average, twice as many as the lattice has. Where a block needs more, the
// sweep is repeated with larger slabs. Which slab a list lies in depends on the particle only, not on threads.
#include "sim/neighbours.h"

#include <string.h>

#include "sim/memory.h"
#include "sim/parallel.h"

#define ROOM 64
#define PIECE 256

typedef struct ListContext {
  SimNeighbours *neighbours;
  const SimGrid *grid;
  float *const *position;
  uint32_t slab; ///< entries of a block
} ListContext;

// Write the indices of the particles of `range` nearer than sqrt(radius2) to the point; at most end − begin of them.
static int32_t search_range(float *const position[3], SimRange range, const float point[3], float radius2,
                            uint32_t *found) {
  const float *restrict x = position[0], *restrict y = position[1], *restrict z = position[2];
  float d2[PIECE];
  int32_t count = 0, length = range.end - range.begin;
  for (int32_t k = 0; k < length; k++) {
    float dx = x[range.begin + k] - point[0], dy = y[range.begin + k] - point[1], dz = z[range.begin + k] - point[2];
    d2[k] = dx * dx + dy * dy + dz * dz;
  }
  for (int32_t k = 0; k < length; k++) {
    found[count] = (uint32_t)(range.begin + k); // without a branch: overwritten unless it is counted
    count += d2[k] < radius2;
  }
  return count;
}

// The list of one particle at `list`; its length, also when it is longer than `room` and was cut there.
static uint32_t fill_list(const ListContext *c, int32_t i, uint32_t *list, uint32_t room) {
  const float point[3] = {c->position[0][i], c->position[1][i], c->position[2][i]};
  float radius = c->neighbours->radius;
  SimRange ranges[SIM_MAX_RANGES];
  uint32_t found[PIECE], length = 0;
  int32_t n = sim_grid_ranges(c->grid, point, radius, ranges);
  for (int32_t r = 0; r < n; r++)
    for (int32_t at = ranges[r].begin; at < ranges[r].end; at += PIECE) {
      int32_t stop = ranges[r].end - at < PIECE ? ranges[r].end : at + PIECE;
      int32_t count = search_range(c->position, (SimRange){at, stop}, point, radius * radius, found);
      for (int32_t k = 0; k < count; k++) {
        if (found[k] == (uint32_t)i) continue;
        if (length < room) list[length] = found[k];
        length++;
      }
    }
  return length;
}

// One block: sim_parallel_for calls with begin at a multiple of SIM_BLOCK.
static void block_kernel(int32_t begin, int32_t end, const void *context) {
  const ListContext *c = context;
  SimNeighbours *lists = c->neighbours;
  int64_t needed = 0;
  uint32_t used = 0, slab_start = (uint32_t)(begin / SIM_BLOCK) * c->slab;
  for (int32_t i = begin; i < end; i++) {
    uint32_t room = c->slab - used, length = fill_list(c, i, lists->index + slab_start + used, room);
    needed += length;
    lists->start[i] = slab_start + used;
    used += length < room ? length : room;
    lists->end[i] = slab_start + used;
  }
  lists->needed[begin / SIM_BLOCK] = needed;
}

SimNeighbourResult sim_neighbours_build(SimNeighbours *lists, const SimGrid *grid, float *const position[3],
                                        int32_t count, float radius, int32_t threads) {
  if (sim_grid_candidates(grid, radius) > SIM_MAX_CANDIDATES) return SIM_NEIGHBOURS_CROWDED;
  int64_t blocks = (count + SIM_BLOCK - 1) / SIM_BLOCK, slab = ROOM * SIM_BLOCK;
  if (!sim_reserve((void **)&lists->start, (size_t)count, sizeof(uint32_t)) ||
      !sim_reserve((void **)&lists->end, (size_t)count, sizeof(uint32_t)) ||
      !sim_reserve((void **)&lists->needed, (size_t)blocks, sizeof(int64_t)))
    return SIM_NEIGHBOURS_NO_MEMORY;
  lists->radius = radius;
  for (;;) {
    if (blocks * slab > UINT32_MAX) return SIM_NEIGHBOURS_CROWDED;
    if (!sim_reserve((void **)&lists->index, (size_t)(blocks * slab), sizeof(uint32_t)) ||
        !sim_reserve((void **)&lists->gradient, (size_t)(blocks * slab), sizeof(float)))
      return SIM_NEIGHBOURS_NO_MEMORY;
    sim_parallel_for(threads, count, block_kernel, &(ListContext){lists, grid, position, (uint32_t)slab});
    int64_t most = 0;
    lists->pairs = 0;
    for (int64_t b = 0; b < blocks; b++) {
      lists->pairs += lists->needed[b];
      if (lists->needed[b] > most) most = lists->needed[b];
    }
    if (most <= slab) return SIM_NEIGHBOURS_OK;
    slab = most + most / 4;
  }
}

void sim_neighbours_free(SimNeighbours *lists) {
  sim_release(lists->start);
  sim_release(lists->end);
  sim_release(lists->needed);
  sim_release(lists->index);
  sim_release(lists->gradient);
  memset(lists, 0, sizeof *lists);
}
