// Neighbour lists: see neighbours.h.
//
// One sweep. Each block of SIM_BLOCK particles fills its own slab of the index array, one chunk after the other. A slab
// has room for what the fullest block needed last time and a little more; where a block needs more, the sweep is repeated
// with larger slabs. Which slab a list lies in depends on the particle only, not on threads.
#include "sim/neighbours.h"

#include <string.h>

#include "sim/memory.h"

#define CHUNKS (SIM_BLOCK / SIM_CHUNK)
#define ROOM 40 // slots a chunk to begin with: the lattice has 32 neighbours inside two spacings

SimNeighbourResult sim_neighbours_build(SimNeighbours *lists, const SimWide *wide, const SimGrid *grid,
                                        float *const position[3], int32_t count, float radius, int32_t threads) {
  if (sim_grid_candidates(grid, radius) > SIM_MAX_CANDIDATES) return SIM_NEIGHBOURS_CROWDED;
  int64_t blocks = (count + SIM_BLOCK - 1) / SIM_BLOCK, most = ROOM * CHUNKS;
  if (!sim_reserve((void **)&lists->start, (size_t)(blocks * CHUNKS), sizeof(uint32_t)) ||
      !sim_reserve((void **)&lists->length, (size_t)(blocks * CHUNKS), sizeof(uint32_t)) ||
      !sim_reserve((void **)&lists->needed, (size_t)(2 * blocks), sizeof(int64_t)))
    return SIM_NEIGHBOURS_NO_MEMORY;
  lists->radius = radius;
  for (;;) {
    int64_t slab = lists->slab > most ? lists->slab : most;
    if (blocks * slab * SIM_CHUNK > UINT32_MAX) return SIM_NEIGHBOURS_CROWDED;
    // Exactly what is needed, not half as much again: the lists are the largest array of all.
    if (lists->capacity < blocks * slab) {
      sim_release(lists->index);
      lists->capacity = 0;
      lists->index = sim_allocate((size_t)(blocks * slab) * SIM_CHUNK * sizeof(uint32_t));
      if (!lists->index) return SIM_NEIGHBOURS_NO_MEMORY;
      lists->capacity = blocks * slab;
    }
    SimListContext context = {lists, grid, {position[0], position[1], position[2]}, count, (uint32_t)slab};
    sim_parallel_for(threads, count, wide->list_block, &context);
    lists->pairs = most = 0;
    for (int64_t b = 0; b < blocks; b++) {
      if (lists->needed[2 * b] > most) most = lists->needed[2 * b];
      lists->pairs += lists->needed[2 * b + 1];
    }
    if (most <= slab) return SIM_NEIGHBOURS_OK;
    lists->slab = most += most / 16;
  }
}

void sim_neighbours_free(SimNeighbours *lists) {
  sim_release(lists->start);
  sim_release(lists->length);
  sim_release(lists->needed);
  sim_release(lists->index);
  memset(lists, 0, sizeof *lists);
}
