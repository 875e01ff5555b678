// Uniform grid by counting sort: see grid.h.
#include "sim/grid.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sim/memory.h"
#include "sim/parallel.h"

#define MAX_CHUNKS 8
#define SAMPLES 1024
#define FEW_CELLS 65536 // are never too many

// ---- Where the grid lies ---------------------------------------------------------------------------------------------

static float coordinate(const SimPositions *places, int axis, int64_t particle) {
  return places->axis[axis][particle * places->stride];
}

static void bounds_kernel(int32_t begin, int32_t end, const void *context, double *partial) {
  for (int axis = 0; axis < 3; axis++) {
    float low = INFINITY, high = -INFINITY;
    for (int32_t i = begin; i < end; i++) {
      float x = coordinate(context, axis, i);
      low = x < low ? x : low;
      high = x > high ? x : high;
    }
    if (-(double)low > partial[axis]) partial[axis] = -(double)low;
    if ((double)high > partial[axis + 3]) partial[axis + 3] = high;
  }
}

static int compare_floats(const void *a, const void *b) {
  float x = *(const float *)a, y = *(const float *)b;
  return (x > y) - (x < y);
}

// The box between the 2nd and the 98th percentile of a fixed sample, widened by its own size.
static void bulk_box(const SimPositions *places, int32_t count, double low[3], double high[3]) {
  float sample[SAMPLES];
  int32_t samples = count < SAMPLES ? count : SAMPLES;
  for (int axis = 0; axis < 3; axis++) {
    for (int32_t k = 0; k < samples; k++) sample[k] = coordinate(places, axis, (int64_t)k * count / samples);
    qsort(sample, (size_t)samples, sizeof(float), compare_floats);
    double a = sample[samples / 50], b = sample[samples - 1 - samples / 50];
    low[axis] = fmax(low[axis], a - (b - a));
    high[axis] = fmin(high[axis], b + (b - a));
  }
}

static double cells_in(const double low[3], const double high[3], double cell, double size[3]) {
  for (int axis = 0; axis < 3; axis++) size[axis] = floor((high[axis] - low[axis]) / cell) + 1;
  return size[0] * size[1] * size[2];
}

static int32_t place_grid(SimGrid *grid, const SimPositions *places, int32_t count, SimCells wanted, int32_t threads) {
  double reach[6] = {-INFINITY, -INFINITY, -INFINITY, -INFINITY, -INFINITY, -INFINITY};
  double low[3] = {0}, high[3] = {0}, size[3];
  if (count > 0) {
    sim_parallel_max(threads, count, 6, bounds_kernel, places, reach);
    for (int axis = 0; axis < 3; axis++) low[axis] = -reach[axis], high[axis] = reach[axis + 3];
  }
  // A hair more than asked for, so that rounding never puts near neighbours two cells apart.
  double cell = (double)wanted.size * 1.0001, most = FEW_CELLS + (double)wanted.each * count;
  if (cells_in(low, high, cell, size) > most) bulk_box(places, count, low, high);
  while (cells_in(low, high, cell, size) > most) cell *= 1.26;
  for (int axis = 0; axis < 3; axis++) {
    grid->origin[axis] = (float)low[axis];
    grid->size[axis] = (int32_t)size[axis];
  }
  grid->cell_size = (float)cell;
  return grid->size[0] * grid->size[1] * grid->size[2];
}

// ---- Counting sort ---------------------------------------------------------------------------------------------------

typedef struct SortContext {
  SimCellSort *sort;
  SimPositions places;
  int32_t count, cells, chunks;
} SortContext;

static void cell_kernel(int32_t begin, int32_t end, const void *context) {
  const SortContext *c = context;
  const SimGrid *grid = &c->sort->grid;
  for (int32_t i = begin; i < end; i++) {
    int32_t at[3];
    for (int axis = 0; axis < 3; axis++) at[axis] = sim_grid_index(grid, axis, (double)coordinate(&c->places, axis, i));
    c->sort->cell[i] = (at[2] * grid->size[1] + at[1]) * grid->size[0] + at[0];
  }
}

static SimRange chunk_range(const SortContext *c, int32_t chunk) {
  return (SimRange){(int32_t)((int64_t)c->count * chunk / c->chunks),
                    (int32_t)((int64_t)c->count * (chunk + 1) / c->chunks)};
}

// Of the particles in each cell; of a single chunk, in place of where the cells start, which saves a large array.
static int32_t *histogram_of(const SortContext *c, int32_t chunk) {
  return c->chunks > 1 ? c->sort->histogram + (int64_t)chunk * c->cells : c->sort->cell_start;
}

static void count_kernel(int32_t begin, int32_t end, const void *context) {
  const SortContext *c = context;
  for (int32_t chunk = begin; chunk < end; chunk++) {
    int32_t *histogram = histogram_of(c, chunk);
    SimRange range = chunk_range(c, chunk);
    memset(histogram, 0, sizeof(int32_t) * (size_t)c->cells);
    for (int32_t i = range.begin; i < range.end; i++) histogram[c->sort->cell[i]]++;
  }
}

// Turn the counts of each chunk into the place of its first particle in each cell.
static void prefix_sum(const SortContext *c) {
  int32_t sum = 0;
  for (int32_t cell = 0; cell < c->cells; cell++) {
    int32_t start = sum;
    for (int32_t chunk = 0; chunk < c->chunks; chunk++) {
      int32_t *slot = &histogram_of(c, chunk)[cell];
      int32_t n = *slot;
      *slot = sum;
      sum += n;
    }
    c->sort->cell_start[cell] = start;
  }
  c->sort->cell_start[c->cells] = sum;
}

static void scatter_kernel(int32_t begin, int32_t end, const void *context) {
  const SortContext *c = context;
  for (int32_t chunk = begin; chunk < end; chunk++) {
    int32_t *next = histogram_of(c, chunk);
    SimRange range = chunk_range(c, chunk);
    for (int32_t i = range.begin; i < range.end; i++) c->sort->order[next[c->sort->cell[i]]++] = (uint32_t)i;
  }
}

// Any number of chunks gives the same order; more than there are threads only lengthen the prefix sum. Where there are
// many cells, few chunks keep the histogram small.
static int32_t chunks_for(SimCells wanted, int32_t count, int32_t cells, int32_t threads) {
  int32_t chunks = count / 2048 + 1;
  if (chunks > threads) chunks = threads;
  if (chunks > MAX_CHUNKS) chunks = MAX_CHUNKS;
  while (chunks > 1 && (double)chunks * cells > FEW_CELLS + 0.5 * (double)wanted.each * count) chunks--;
  return chunks;
}

bool sim_grid_sort(SimCellSort *sort, SimPositions places, int32_t count, SimCells wanted, int32_t threads) {
  int32_t cells = place_grid(&sort->grid, &places, count, wanted, threads);
  int32_t chunks = chunks_for(wanted, count, cells, threads);
  if (!sim_reserve((void **)&sort->cell_start, (size_t)cells + 1, sizeof(int32_t)) ||
      (chunks > 1 && !sim_reserve((void **)&sort->histogram, (size_t)cells * (size_t)chunks, sizeof(int32_t))) ||
      !sim_reserve((void **)&sort->cell, (size_t)count, sizeof(int32_t)) ||
      !sim_reserve((void **)&sort->order, (size_t)count, sizeof(uint32_t)))
    return false;
  SortContext context = {sort, places, count, cells, chunks};
  sim_parallel_for(threads, count, cell_kernel, &context);
  sim_parallel_tasks(threads, chunks, count_kernel, &context);
  prefix_sum(&context);
  sim_parallel_tasks(threads, chunks, scatter_kernel, &context);
  if (chunks == 1) { // every cell's place has moved on to the next one's
    memmove(sort->cell_start + 1, sort->cell_start, (size_t)cells * sizeof(int32_t));
    sort->cell_start[0] = 0;
  }
  sort->grid.cell_start = sort->cell_start;
  assert(sort->cell_start[cells] == count);
  return true;
}

void sim_grid_free(SimCellSort *sort) {
  sim_release(sort->cell_start);
  sim_release(sort->cell);
  sim_release(sort->order);
  sim_release(sort->histogram);
  memset(sort, 0, sizeof *sort);
}

// ---- Gather ----------------------------------------------------------------------------------------------------------

typedef struct GatherContext {
  const uint32_t *order;
  int32_t arrays;
  const void *const *source;
  void *const *target;
} GatherContext;

static void gather_kernel(int32_t begin, int32_t end, const void *context) {
  const GatherContext *c = context;
  for (int32_t a = 0; a < c->arrays; a++) {
    const uint32_t *source = c->source[a];
    uint32_t *target = c->target[a];
    for (int32_t k = begin; k < end; k++) memcpy(&target[k], &source[c->order[k]], sizeof(uint32_t));
  }
}

void sim_grid_gather(const SimCellSort *sort, int32_t count, int32_t threads, int32_t arrays, const void *const *source,
                     void *const *target) {
  sim_parallel_for(threads, count, gather_kernel, &(GatherContext){sort->order, arrays, source, target});
}

// ---- Search ----------------------------------------------------------------------------------------------------------

int32_t sim_grid_ranges(const SimGrid *grid, const float point[3], float radius, SimRange ranges[SIM_MAX_RANGES]) {
  int32_t low[3], high[3];
  double reach = (double)radius * 1.00001; // distances are compared in single precision
  assert(reach <= 2 * (double)grid->cell_size);
  for (int axis = 0; axis < 3; axis++) {
    low[axis] = sim_grid_index(grid, axis, (double)point[axis] - reach);
    high[axis] = sim_grid_index(grid, axis, (double)point[axis] + reach);
  }
  int32_t count = 0;
  for (int32_t z = low[2]; z <= high[2]; z++)
    for (int32_t y = low[1]; y <= high[1]; y++) {
      const int32_t *row = grid->cell_start + ((int64_t)z * grid->size[1] + y) * grid->size[0];
      SimRange range = {row[low[0]], row[high[0] + 1]};
      if (range.begin < range.end) ranges[count++] = range;
    }
  return count;
}

double sim_grid_candidates(const SimGrid *grid, float radius) {
  int32_t reach = (int32_t)ceilf(radius / grid->cell_size);
  int32_t cells = grid->size[0] * grid->size[1] * grid->size[2];
  int64_t sum = 0;
  for (int32_t c = 0; c < cells; c++) {
    int64_t n = grid->cell_start[c + 1] - grid->cell_start[c];
    sum += n * n;
  }
  double width = 2 * reach + 1;
  return (double)sum * width * width * width;
}
