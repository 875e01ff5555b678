// Neighbour search over the cell-sorted particles. All particles of a cell have the same candidates: the nine rows of
// three cells around it. They are copied side by side once for the cell, so that each of its particles then runs over
// one array without gaps, compares many distances at a time and packs the indices of the near ones together.
#include "sim/neighbours.h"
#include "sim/particles.h"
#include "sim/wide/kernels.h"

#define CANDIDATES 960 // of a cell; more take a slower way. A lattice has 250

typedef struct Rows {
  SimRange range[9];
  int32_t count, candidates;
} Rows;

/// The candidates of one cell side by side.
typedef struct Cell {
  float axis[3][CANDIDATES + SIM_CHUNK];
  uint32_t index[CANDIDATES + SIM_CHUNK];
} Cell;

/// The lists of one chunk before they are interleaved.
typedef struct Chunk {
  uint32_t length[SIM_CHUNK];
  int32_t cell[SIM_CHUNK]; ///< of each particle
  bool crowded;            ///< some cell has too many candidates: the slow way has to be taken
  uint32_t index[SIM_CHUNK][CANDIDATES + SIM_CHUNK];
} Chunk;

static void rows_of_cell(const SimGrid *grid, int32_t cell, Rows *rows) {
  int32_t x = cell % grid->size[0], y = cell / grid->size[0] % grid->size[1], z = cell / grid->size[0] / grid->size[1];
  int32_t left = x > 0 ? x - 1 : 0, right = x < grid->size[0] - 1 ? x + 1 : x;
  rows->count = rows->candidates = 0;
  for (int32_t k = z > 0 ? z - 1 : 0; k <= z + 1 && k < grid->size[2]; k++)
    for (int32_t j = y > 0 ? y - 1 : 0; j <= y + 1 && j < grid->size[1]; j++) {
      const int32_t *row = grid->cell_start + ((int64_t)k * grid->size[1] + j) * grid->size[0];
      SimRange range = {row[left], row[right + 1]};
      if (range.begin < range.end) rows->range[rows->count++] = range;
      rows->candidates += range.end - range.begin;
    }
}

// Copies in whole steps: what is written too much is written over by the next row, or never looked at.
static void copy_candidates(const SimListContext *c, const Rows *rows, Cell *cell) {
  int32_t at = 0;
  for (int32_t r = 0; r < rows->count; r++) {
    SimRange range = rows->range[r];
    for (int32_t j = range.begin; j < range.end; j += SIM_LANES) {
      for (int k = 0; k < 3; k++) sim_store(cell->axis[k] + at + (j - range.begin), sim_load(c->position[k] + j));
      sim_count_up(cell->index + at + (j - range.begin), (uint32_t)j);
    }
    at += range.end - range.begin;
  }
  for (int k = 0; k < 3; k++) // up to a whole step: far from everything
    for (int32_t j = at; j < at + SIM_LANES; j++) cell->axis[k][j] = SIM_FAR;
}

// Neighbours of i among the candidates of its cell into `found`; their number.
static uint32_t search(const SimListContext *c, const Cell *cell, int32_t candidates, int32_t i, uint32_t *found) {
  SimF px = sim_f(c->position[0][i]), py = sim_f(c->position[1][i]), pz = sim_f(c->position[2][i]);
  SimF r2 = sim_f(c->lists->radius * c->lists->radius);
  uint32_t length = 0;
  for (int32_t j = 0; j < candidates; j += SIM_LANES) {
    SimF dx = sim_load(cell->axis[0] + j) - px, dy = sim_load(cell->axis[1] + j) - py,
         dz = sim_load(cell->axis[2] + j) - pz;
    length += sim_pack_less(found + length, cell->index + j, dx * dx + dy * dy + dz * dz, r2, (uint32_t)i);
  }
  return length;
}

// The slow way, for lists and candidates of any number: straight into the lane's slots, of which there are `room`; the
// length of the list, which may be larger.
static uint32_t search_long(const SimListContext *c, const Rows *rows, int32_t i, uint32_t *lane, uint32_t room) {
  const float *x = c->position[0], *y = c->position[1], *z = c->position[2];
  float r2 = c->lists->radius * c->lists->radius;
  uint32_t length = 0;
  for (int32_t r = 0; r < rows->count; r++)
    for (int32_t j = rows->range[r].begin; j < rows->range[r].end; j++) {
      float dx = x[j] - x[i], dy = y[j] - y[i], dz = z[j] - z[i];
      if (j == i || !(dx * dx + dy * dy + dz * dz < r2)) continue;
      if (length < room) lane[SIM_CHUNK * (size_t)length] = (uint32_t)j;
      length++;
    }
  return length;
}

static void interleave(const SimListContext *c, Chunk *chunk, uint32_t slots, uint32_t *to) {
  for (int lane = 0; lane < SIM_CHUNK; lane++)
    for (uint32_t k = chunk->length[lane]; k < slots; k++) chunk->index[lane][k] = (uint32_t)c->count;
  for (uint32_t k = 0; k < slots; k++, to += SIM_CHUNK)
    for (int lane = 0; lane < SIM_CHUNK; lane++) to[lane] = chunk->index[lane][k];
}

// Lists of crowded cells: found again, one after the other.
static void long_lists(const SimListContext *c, const Chunk *chunk, int32_t first, int32_t end, uint32_t slots,
                       uint32_t *to) {
  for (int lane = 0; lane < SIM_CHUNK; lane++) {
    Rows rows = {.count = 0};
    if (first + lane < end) rows_of_cell(c->grid, chunk->cell[lane], &rows);
    uint32_t length = search_long(c, &rows, first + lane, to + lane, slots);
    for (; length < slots; length++) to[SIM_CHUNK * (size_t)length + (size_t)lane] = (uint32_t)c->count;
  }
}

/// The cell of the particle that was looked at last.
typedef struct Place {
  int32_t number;
  Rows rows;
  Cell cell; ///< if there are not too many candidates
} Place;

static void enter_cell(const SimListContext *c, int32_t number, Place *place) {
  place->number = number;
  rows_of_cell(c->grid, number, &place->rows);
  if (place->rows.candidates <= CANDIDATES) copy_candidates(c, &place->rows, &place->cell);
}

// Finds the lists of one chunk; the length of the longest.
static uint32_t search_chunk(const SimListContext *c, int32_t first, int32_t end, Place *place, Chunk *chunk) {
  uint32_t longest = 0;
  chunk->crowded = false;
  for (int lane = 0; lane < SIM_CHUNK; lane++) {
    int32_t i = first + lane;
    chunk->length[lane] = 0;
    if (i >= end) continue;
    int32_t number = place->number;
    while (c->grid->cell_start[number + 1] <= i) number++;
    if (number != place->number) enter_cell(c, number, place);
    chunk->cell[lane] = number;
    chunk->crowded = chunk->crowded || place->rows.candidates > CANDIDATES;
    chunk->length[lane] = place->rows.candidates <= CANDIDATES
                              ? search(c, &place->cell, place->rows.candidates, i, chunk->index[lane])
                              : search_long(c, &place->rows, i, NULL, 0);
    if (chunk->length[lane] > longest) longest = chunk->length[lane];
  }
  return longest;
}

void WIDE(sim_list_block)(int32_t begin, int32_t end, const void *context) {
  const SimListContext *c = context;
  SimNeighbours *lists = c->lists;
  uint32_t used = 0, slab = (uint32_t)(begin / SIM_BLOCK) * c->slab;
  int64_t pairs = 0;
  Place place;
  Chunk chunk;
  enter_cell(c, sim_grid_cell_of(c->grid, begin), &place);
  for (int32_t first = begin; first < end; first += SIM_CHUNK) {
    uint32_t slots = search_chunk(c, first, end, &place, &chunk);
    for (int lane = 0; lane < SIM_CHUNK; lane++) pairs += chunk.length[lane];
    bool fits = slots <= c->slab - (used < c->slab ? used : c->slab); // if not, all is done again with larger slabs
    uint32_t *to = lists->index + (size_t)(slab + used) * SIM_CHUNK;
    if (fits && !chunk.crowded) interleave(c, &chunk, slots, to);
    if (fits && chunk.crowded) long_lists(c, &chunk, first, end, slots, to);
    lists->start[first / SIM_CHUNK] = slab + used;
    lists->length[first / SIM_CHUNK] = fits ? slots : 0;
    used += slots;
  }
  lists->needed[2 * (begin / SIM_BLOCK)] = used;
  lists->needed[2 * (begin / SIM_BLOCK) + 1] = pairs;
}
