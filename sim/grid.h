// Uniform grid by counting sort.
//
// Green, Particle Simulation using CUDA, 2010, section "Sorting"; the stable counting sort is Knuth, The Art of Computer
// Programming 3, 5.2. Cells run fastest along x, so the cells i − 1, i, i + 1 of a row are one contiguous range of the
// sorted particles: a search over 27 cells reads 9 ranges.
//
// The sort is stable and a stable sort has one result only: the order is the same for any number of threads.
#ifndef LIDO_SIM_GRID_H
#define LIDO_SIM_GRID_H

#include <stdbool.h>
#include <stdint.h>

#include "sim/frame.h"

typedef struct SimCellSort {
  SimGrid grid;         ///< grid.cell_start is the array below
  int32_t *cell_start;  ///< (cells + 1)
  int32_t *cell;        ///< (count): the cell of each particle, in the order before sorting
  uint32_t *order;      ///< (count): order[new] = old
  int32_t *histogram;   ///< (chunks, cells) where there are several chunks
} SimCellSort;

/// Where `count` positions lie: coordinate k of particle i is axis[k][stride·i], m.
typedef struct SimPositions {
  const float *axis[3];
  int32_t stride;
} SimPositions;

/// Three arrays of one float a particle.
static inline SimPositions sim_positions(float *const axis[3]) {
  return (SimPositions){{axis[0], axis[1], axis[2]}, 1};
}

/// The cells that are wanted.
typedef struct SimCells {
  float size; ///< m: the smallest they may be
  float each; ///< at most so many a particle, and 65,536 more. Water has about 1/8 of the smallest; a cell takes 4 bytes
} SimCells;

/// Cells of a world, which has few particles, but spray all over its container.
static inline SimCells sim_cells(float size) {
  return (SimCells){size, 4};
}

/// Sort `count` finite positions into cells. The grid covers the box around the positions; where that would take too many
/// cells (a few particles far away) it covers the bulk of them, the others count to the nearest cell at its border, and as
/// a last resort the cells grow. Whatever it chooses, two particles nearer than cells.size lie in the same cell or in cells
/// that touch. false when memory runs out.
bool sim_grid_sort(SimCellSort *sort, SimPositions places, int32_t count, SimCells cells, int32_t threads);
void sim_grid_free(SimCellSort *sort);

/// new_array[k] = old_array[order[k]] for floats and for 32-bit words.
void sim_grid_gather(const SimCellSort *sort, int32_t count, int32_t threads, int32_t arrays, const void *const *source,
                     void *const *target);

/// A range of sorted particles.
typedef struct SimRange {
  int32_t begin, end;
} SimRange;

/// The most ranges that sim_grid_ranges returns: 5 × 5 rows, for a radius of up to two cells.
#define SIM_MAX_RANGES 25

/// Index of the cell along one axis, clamped to the grid. Double precision, so that 10⁷ cells in a row still work.
static inline int32_t sim_grid_index(const SimGrid *grid, int axis, double coordinate) {
  double t = (coordinate - (double)grid->origin[axis]) * (1 / (double)grid->cell_size);
  return t > 0 ? t < grid->size[axis] - 1 ? (int32_t)t : grid->size[axis] - 1 : 0;
}

/// The cell of sorted particle i.
static inline int32_t sim_grid_cell_of(const SimGrid *grid, int32_t i) {
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

/// Ranges that hold every particle nearer than `radius` (at most two cells) to the point, empty ones left out.
int32_t sim_grid_ranges(const SimGrid *grid, const float point[3], float radius, SimRange ranges[SIM_MAX_RANGES]);

/// A bound on the distances that a search of that radius around every particle has to test: what a clustered set costs.
double sim_grid_candidates(const SimGrid *grid, float radius);

#endif
