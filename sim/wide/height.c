// Heights of the free surface: see surface_heightfield.c for the method.
//
// A column keeps the particles within reach of its axis, collected from the highest layer of cells downwards as far as a
// sample needs them, so that φ is one short sum. Particles of a heap that do not fit are summed straight from the grid.
//
// Sums run over SIM_CHUNK partial sums that are added in one fixed order, on every instruction set.
//
// The crossing is found by the Illinois method (Dowell & Jarratt, A Modified Regula Falsi Method for Computing the Root
// of an Equation, 1971), which keeps a bracket and converges faster than any bisection.
#include "sim/surface.h"
#include "sim/wide/kernels.h"

#define REFINEMENTS 6
#define ROOM 512 // particles of a column

typedef struct Column {
  const SimHeightContext *context;
  float x, z;
  int32_t low[2], high[2]; ///< cells in reach along x and z
  int32_t layer;           ///< cells from here on upwards have been collected
  int32_t count;
  bool full;                                           ///< there was no room: the lists are of no use
  float y[ROOM + SIM_CHUNK], reach2[ROOM + SIM_CHUNK]; ///< m; m², what is left of the radius at the axis
} Column;

static void open_column(Column *column, const SimHeightContext *c, float x, float z) {
  const SimGrid *grid = c->surface->grid;
  const double centre[2] = {(double)x, (double)z}, reach = (double)c->radius * 1.00001;
  column->context = c;
  column->x = x, column->z = z;
  for (int k = 0; k < 2; k++) {
    column->low[k] = sim_grid_index(grid, 2 * k, centre[k] - reach);
    column->high[k] = sim_grid_index(grid, 2 * k, centre[k] + reach);
  }
  column->layer = grid->size[1];
  column->count = 0;
  column->full = false;
}

// The particles of a layer's row z are those from begin to end.
static SimRange row_of(const Column *column, int32_t layer, int32_t z) {
  const SimGrid *grid = column->context->surface->grid;
  const int32_t *row = grid->cell_start + ((int64_t)z * grid->size[1] + layer) * grid->size[0];
  return (SimRange){row[column->low[0]], row[column->high[0] + 1]};
}

static void collect_row(Column *column, SimRange range) {
  const SimHeightContext *c = column->context;
  const float *x = c->surface->position[0], *y = c->surface->position[1], *z = c->surface->position[2];
  SimF px = sim_f(column->x), pz = sim_f(column->z), r2 = sim_f(c->radius * c->radius);
  for (int32_t j = range.begin; j < range.end; j += SIM_LANES) {
    SimF dx = sim_load(x + j) - px, dz = sim_load(z + j) - pz;
    float left[SIM_LANES];
    sim_store(left, r2 - dx * dx - dz * dz);
    column->full = column->full || column->count > ROOM - SIM_LANES;
    if (column->full) return;
    for (int k = 0; k < SIM_LANES && j + k < range.end; k++) {
      column->y[column->count] = y[j + k]; // overwritten unless it is counted
      column->reach2[column->count] = left[k];
      column->count += left[k] > 0;
    }
  }
}

// Forget what lies so high above `top` that no sample will reach it again.
static void forget_above(Column *column, float top) {
  int32_t kept = 0;
  for (int32_t j = 0; j < column->count; j++) {
    if (column->y[j] - column->context->radius > top) continue;
    column->y[kept] = column->y[j];
    column->reach2[kept++] = column->reach2[j];
  }
  column->count = kept;
}

static void collect_layer(Column *column, float top) {
  column->layer--;
  if (column->count > ROOM / 2) forget_above(column, top);
  for (int32_t k = column->low[1]; k <= column->high[1] && !column->full; k++)
    collect_row(column, row_of(column, column->layer, k));
  for (int32_t k = column->count; k < column->count + SIM_CHUNK && !column->full; k++)
    column->y[k] = column->reach2[k] = 0; // add nothing
}

/// m: whatever has not been collected lies below this.
static double collected_down_to(const Column *column) {
  const SimGrid *grid = column->context->surface->grid;
  return column->layer == 0 ? -INFINITY
                            : (double)grid->origin[1] + ((double)column->layer + 1e-3) * (double)grid->cell_size;
}

// φ from the grid, for heaps.
static float potential_of_heap(const Column *column, float height) {
  const SimHeightContext *c = column->context;
  const SimGrid *grid = c->surface->grid;
  const float *const *p = (const float *const *)c->surface->position;
  float sum = 0, r2 = c->radius * c->radius;
  int32_t low = sim_grid_index(grid, 1, (double)height - 1.00001 * (double)c->radius),
          high = sim_grid_index(grid, 1, (double)height + 1.00001 * (double)c->radius);
  for (int32_t layer = low; layer <= high; layer++)
    for (int32_t k = column->low[1]; k <= column->high[1]; k++) {
      SimRange range = row_of(column, layer, k);
      for (int32_t j = range.begin; j < range.end; j++) {
        float dx = p[0][j] - column->x, dy = p[1][j] - height, dz = p[2][j] - column->z;
        float left = r2 - dx * dx - dz * dz - dy * dy;
        if (left > 0) sum += sqrtf(left);
      }
    }
  return sum / c->radius;
}

static float potential(Column *column, float height, float top) {
  const SimHeightContext *c = column->context;
  while (!column->full && collected_down_to(column) > (double)height - (double)c->radius) collect_layer(column, top);
  if (column->full) return potential_of_heap(column, height);
  SimF sums[SIM_CHUNK / SIM_LANES], at = sim_f(height), zero = sim_f(0);
  for (int p = 0; p < SIM_CHUNK / SIM_LANES; p++) sums[p] = zero;
  for (int32_t j = 0; j < column->count; j += SIM_CHUNK)
    for (int p = 0; p < SIM_CHUNK / SIM_LANES; p++) {
      SimF dy = sim_load(column->y + j + p * SIM_LANES) - at;
      SimF left = sim_load(column->reach2 + j + p * SIM_LANES) - dy * dy;
      sums[p] = sums[p] + sim_sqrt(sim_max(left, zero));
    }
  float lane[SIM_CHUNK];
  for (int p = 0; p < SIM_CHUNK / SIM_LANES; p++) sim_store(lane + p * SIM_LANES, sums[p]);
  for (int half = SIM_CHUNK / 2; half > 0; half /= 2)
    for (int k = 0; k < half; k++) lane[k] += lane[k + half];
  return lane[0] / c->radius;
}

// The highest place at or below `below` that a particle of height y reaches, `reach2` being left of its radius.
static double reached(double y, double reach2, double below) {
  double half = sqrt(reach2);
  return y - half < below ? fmin(y + half, below) : -INFINITY;
}

static double heap_reaches(const Column *column, double below) {
  const SimHeightContext *c = column->context;
  const float *const *p = (const float *const *)c->surface->position;
  double best = -INFINITY, r2 = (double)c->radius * (double)c->radius;
  for (int32_t layer = 0; layer < c->surface->grid->size[1]; layer++)
    for (int32_t k = column->low[1]; k <= column->high[1]; k++) {
      SimRange range = row_of(column, layer, k);
      for (int32_t j = range.begin; j < range.end; j++) {
        double dx = (double)p[0][j] - (double)column->x, dz = (double)p[2][j] - (double)column->z;
        double left = r2 - dx * dx - dz * dz;
        if (left > 0) best = fmax(best, reached((double)p[1][j], left, below));
      }
    }
  return best;
}

// The highest place at or below `below` in the column where φ is not zero; −INFINITY when there is none.
static double highest_below(Column *column, double below) {
  double best = -INFINITY, radius = (double)column->context->radius;
  for (;;) {
    for (int32_t j = 0; j < column->count; j++)
      best = fmax(best, reached((double)column->y[j], (double)column->reach2[j], below));
    // What has not been collected yet reaches no higher than this.
    if (column->full || best >= collected_down_to(column) + radius || column->layer == 0) break;
    collect_layer(column, (float)below);
  }
  return column->full ? heap_reaches(column, below) : best;
}

// Where φ is the iso-value; `at_low` (not negative) and `at_high` (negative) are what φ is above it at both ends.
static float crossing(Column *column, float low, float high, float at_low, float at_high) {
  float top = high;
  int side = 0; // of the end that was moved last
  for (int n = 0; n < REFINEMENTS; n++) {
    float middle = low + (high - low) * (at_low / (at_low - at_high));
    float at = potential(column, middle, top) - column->context->iso;
    if (at >= 0) {
      if (side > 0) at_high *= 0.5f;
      low = middle, at_low = at, side = 1;
    } else {
      if (side < 0) at_low *= 0.5f;
      high = middle, at_high = at, side = -1;
    }
  }
  return low + (high - low) * (at_low / (at_low - at_high));
}

// Samples lie at multiples of the step; stretches without water are skipped, however tall.
static float column_height(Column *column) {
  const SimHeightContext *c = column->context;
  double base = (double)c->floor, step = (double)c->step, top = (double)c->surface->bounds_max[1] + (double)c->radius;
  float above = 0; // φ of the sample above
  for (double k = ceil((top - base) / step); k >= 0; k--) {
    float low = (float)(base + step * k), high = (float)(base + step * (k + 1)), value = potential(column, low, high);
    if (value >= c->iso) return crossing(column, low, high, value - c->iso, above - c->iso);
    if (value == 0) k = fmin(k, floor((highest_below(column, base + step * k) - base) / step) + 1);
    above = value;
  }
  return c->floor;
}

void WIDE(sim_surface_heights)(int32_t begin, int32_t end, const void *context) {
  const SimHeightContext *c = context;
  const SimHeightField *f = c->field;
  Column column;
  for (int32_t node = begin; node < end; node++) {
    int32_t i = node % f->size[0], k = node / f->size[0];
    open_column(&column, c, f->origin[0] + f->spacing * (float)i, f->origin[1] + f->spacing * (float)k);
    c->height[node] = column_height(&column);
  }
}
