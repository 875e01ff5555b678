// Neighbour search over the cell-sorted particles: for each particle, the nine rows of three cells around its own are
// nine contiguous ranges; their distances are compared many at a time and the indices of near ones packed together.
#include "sim/neighbours.h"
#include "sim/wide/kernels.h"

#define ROW 448 // neighbours of a particle that are collected beside each other; more take a slower way

typedef struct Rows {
  SimRange range[9];
  int32_t count;
} Rows;

/// The lists of one chunk before they are interleaved.
typedef struct Chunk {
  uint32_t length[SIM_CHUNK];
  int32_t cell[SIM_CHUNK]; ///< of each particle
  uint32_t index[SIM_CHUNK][ROW + 2 * SIM_CHUNK];
} Chunk;

static void rows_of_cell(const SimGrid *grid, int32_t cell, Rows *rows) {
  int32_t x = cell % grid->size[0], y = cell / grid->size[0] % grid->size[1], z = cell / grid->size[0] / grid->size[1];
  int32_t left = x > 0 ? x - 1 : 0, right = x < grid->size[0] - 1 ? x + 1 : x;
  rows->count = 0;
  for (int32_t k = z > 0 ? z - 1 : 0; k <= z + 1 && k < grid->size[2]; k++)
    for (int32_t j = y > 0 ? y - 1 : 0; j <= y + 1 && j < grid->size[1]; j++) {
      const int32_t *row = grid->cell_start + ((int64_t)k * grid->size[1] + j) * grid->size[0];
      SimRange range = {row[left], row[right + 1]};
      if (range.begin < range.end) rows->range[rows->count++] = range;
    }
}

static int32_t cell_of(const SimGrid *grid, int32_t i) {
  int32_t low = 0, high = grid->size[0] * grid->size[1] * grid->size[2]; // cell_start[low] <= i < cell_start[high]
  while (high - low > 1) {
    int32_t middle = low + (high - low) / 2;
    if (grid->cell_start[middle] <= i)
      low = middle;
    else
      high = middle;
  }
  return low;
}

// Neighbours of i into `found`, which has room for ROW and two chunks; their number, which may be larger than ROW: then
// only the first ones are there.
static uint32_t search(const SimListContext *c, const Rows *rows, int32_t i, uint32_t *found) {
  const float *x = c->position[0], *y = c->position[1], *z = c->position[2];
  SimF px = sim_f(x[i]), py = sim_f(y[i]), pz = sim_f(z[i]), r2 = sim_f(c->lists->radius * c->lists->radius);
  uint32_t length = 0;
  for (int32_t r = 0; r < rows->count; r++) {
    SimRange range = rows->range[r];
    for (int32_t j = range.begin; j < range.end; j += SIM_LANES) {
      SimF dx = sim_load(x + j) - px, dy = sim_load(y + j) - py, dz = sim_load(z + j) - pz;
      uint32_t mask = sim_less(dx * dx + dy * dy + dz * dz, r2);
      if (range.end - j < SIM_LANES) mask &= (1u << (range.end - j)) - 1;
      if ((uint32_t)(i - j) < SIM_LANES) mask &= ~(1u << (i - j)); // not itself
      length += sim_compress(found + (length < ROW ? length : ROW), (uint32_t)j, mask);
    }
  }
  return length;
}

// The slow way: lists of any length, straight into the lane's slots, of which there are `room`.
static void search_long(const SimListContext *c, const Rows *rows, int32_t i, uint32_t *lane, uint32_t room) {
  const float *x = c->position[0], *y = c->position[1], *z = c->position[2];
  float r2 = c->lists->radius * c->lists->radius;
  uint32_t length = 0;
  for (int32_t r = 0; r < rows->count; r++)
    for (int32_t j = rows->range[r].begin; j < rows->range[r].end; j++) {
      float dx = x[j] - x[i], dy = y[j] - y[i], dz = z[j] - z[i];
      if (j != i && dx * dx + dy * dy + dz * dz < r2 && length < room) lane[SIM_CHUNK * length++] = (uint32_t)j;
    }
  while (length < room) lane[SIM_CHUNK * length++] = (uint32_t)c->count;
}

static void interleave(const SimListContext *c, Chunk *chunk, uint32_t slots, uint32_t *to) {
  for (int lane = 0; lane < SIM_CHUNK; lane++)
    for (uint32_t k = chunk->length[lane]; k < slots; k++) chunk->index[lane][k] = (uint32_t)c->count;
  for (uint32_t k = 0; k < slots; k++, to += SIM_CHUNK)
    for (int lane = 0; lane < SIM_CHUNK; lane++) to[lane] = chunk->index[lane][k];
}

// Lists longer than a row of Chunk: found again, one after the other.
static void long_lists(const SimListContext *c, const int32_t cell[SIM_CHUNK], int32_t first, int32_t end,
                       uint32_t slots, uint32_t *to) {
  for (int lane = 0; lane < SIM_CHUNK; lane++) {
    Rows rows = {.count = 0};
    if (first + lane < end) rows_of_cell(c->grid, cell[lane], &rows);
    search_long(c, &rows, first + lane, to + lane, slots);
  }
}

// Finds the lists of one chunk; the length of the longest. *cell is the cell of the last particle looked at, *rows its.
static uint32_t search_chunk(const SimListContext *c, int32_t first, int32_t end, int32_t *cell, Rows *rows,
                             Chunk *chunk) {
  uint32_t longest = 0;
  for (int lane = 0; lane < SIM_CHUNK; lane++) {
    int32_t i = first + lane;
    chunk->length[lane] = 0;
    if (i >= end) continue;
    if (c->grid->cell_start[*cell + 1] <= i) {
      while (c->grid->cell_start[*cell + 1] <= i) ++*cell;
      rows_of_cell(c->grid, *cell, rows);
    }
    chunk->cell[lane] = *cell;
    chunk->length[lane] = search(c, rows, i, chunk->index[lane]);
    if (chunk->length[lane] > longest) longest = chunk->length[lane];
  }
  return longest;
}

void WIDE(sim_list_block)(int32_t begin, int32_t end, const void *context) {
  const SimListContext *c = context;
  SimNeighbours *lists = c->lists;
  uint32_t used = 0, slab = (uint32_t)(begin / SIM_BLOCK) * c->slab;
  int32_t cell = cell_of(c->grid, begin);
  int64_t pairs = 0;
  Rows rows;
  Chunk chunk;
  rows_of_cell(c->grid, cell, &rows);
  for (int32_t first = begin; first < end; first += SIM_CHUNK) {
    uint32_t slots = search_chunk(c, first, end, &cell, &rows, &chunk);
    for (int lane = 0; lane < SIM_CHUNK; lane++) pairs += chunk.length[lane];
    bool fits = slots <= c->slab - (used < c->slab ? used : c->slab); // if not, all is done again with larger slabs
    uint32_t *to = lists->index + (size_t)(slab + used) * SIM_CHUNK;
    if (fits && slots <= ROW) interleave(c, &chunk, slots, to);
    if (fits && slots > ROW) long_lists(c, chunk.cell, first, end, slots, to);
    lists->start[first / SIM_CHUNK] = slab + used;
    lists->length[first / SIM_CHUNK] = fits ? slots : 0;
    used += slots;
  }
  lists->needed[2 * (begin / SIM_BLOCK)] = used;
  lists->needed[2 * (begin / SIM_BLOCK) + 1] = pairs;
}
