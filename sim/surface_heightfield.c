// The free surface as a height over the floor: Cords & Staadt, Instant Liquids / Real-Time Open Water Environments with
// Interacting Objects, 2007, Eq. 5 and 6: φ(x) = Σ sqrt(1 − r²/h²) over the particles with r < h (nothing beyond).
//
// h is two spacings. The iso-value is that of a level lattice, half a spacing above its highest layer (averaged over
// places between the particles), so a pool at rest shows its true level. A drop alone stays below it and is not part of
// the height field.
//
// In each column φ is sampled from above at multiples of a quarter spacing over the floor; the first sample at or above
// the iso-value and the one before it bracket the surface, which bisection then finds.
#include <math.h>

#include "sim/parallel.h"
#include "sim/surface.h"

#define ISO_RADIUS 2      // in spacings
#define STEPS_A_SPACING 4 // samples of a column
#define BISECTIONS 10
#define MAX_NODES (1 << 20)

static double level_lattice_value(void) {
  double sum = 0;
  const int places = 8, reach = ISO_RADIUS + 1;
  for (int a = 0; a < places; a++)
    for (int b = 0; b < places; b++)
      for (int k = 0; k <= ISO_RADIUS; k++)
        for (int j = -reach; j <= reach; j++)
          for (int i = -reach; i <= reach; i++) {
            double x = i + (a + 0.5) / places, y = k + 0.5, z = j + (b + 0.5) / places;
            double q2 = (x * x + y * y + z * z) / (ISO_RADIUS * ISO_RADIUS);
            if (q2 < 1) sum += sqrt(1 - q2) / (places * places);
          }
  return sum;
}

typedef struct FieldContext {
  const SimSurface *surface;
  const SimHeightField *field;
  float radius, step, iso, floor;
  float *height, *normal;
} FieldContext;

static float potential(const FieldContext *c, const float point[3]) {
  const float *restrict x = c->surface->position[0], *restrict y = c->surface->position[1],
                        *restrict z = c->surface->position[2];
  float sum = 0, inverse = 1 / (c->radius * c->radius);
  SimRange ranges[SIM_MAX_RANGES];
  int32_t n = sim_grid_ranges(c->surface->grid, point, c->radius, ranges);
  for (int32_t r = 0; r < n; r++)
    for (int32_t j = ranges[r].begin; j < ranges[r].end; j++) {
      float dx = x[j] - point[0], dy = y[j] - point[1], dz = z[j] - point[2];
      float left = 1 - (dx * dx + dy * dy + dz * dz) * inverse;
      if (left > 0) sum += sqrtf(left);
    }
  return sum;
}

// The highest place at or below `below` in the column where φ is not zero; −INFINITY when there is none.
static double highest_below(const FieldContext *c, float x, float z, double below) {
  const SimGrid *grid = c->surface->grid;
  float *const *p = c->surface->position;
  double r = (double)c->radius, best = -INFINITY;
  int32_t low[3], high[3];
  const double centre[3] = {(double)x, below, (double)z};
  for (int axis = 0; axis < 3; axis++) {
    low[axis] = axis == 1 ? 0 : sim_grid_index(grid, axis, centre[axis] - r);
    high[axis] = sim_grid_index(grid, axis, centre[axis] + r);
  }
  // From the highest layer of cells down, until what was found lies above all that a lower layer can give.
  for (int32_t y = high[1]; y >= 0; y--) {
    if (best > (double)grid->origin[1] + (y + 1.0) * (double)grid->cell_size + r) break;
    for (int32_t k = low[2]; k <= high[2]; k++) {
      const int32_t *row = grid->cell_start + ((int64_t)k * grid->size[1] + y) * grid->size[0];
      for (int32_t j = row[low[0]]; j < row[high[0] + 1]; j++) {
        double dx = (double)p[0][j] - (double)x, dz = (double)p[2][j] - (double)z, left = r * r - dx * dx - dz * dz;
        if (left <= 0) continue;
        double half = sqrt(left), top = (double)p[1][j] + half;
        if ((double)p[1][j] - half < below) best = fmax(best, fmin(top, below));
      }
    }
  }
  return best;
}

// Samples lie at multiples of the step; stretches without water are skipped, however tall.
static float column_height(const FieldContext *c, float x, float z) {
  double base = (double)c->floor, step = (double)c->step, top = (double)c->surface->bounds_max[1] + (double)c->radius;
  for (double k = ceil((top - base) / step); k >= 0; k--) {
    float low = (float)(base + step * k), high = (float)(base + step * (k + 1)),
          value = potential(c, (float[3]){x, low, z});
    if (value == 0) k = fmin(k, floor((highest_below(c, x, z, base + step * k) - base) / step) + 1);
    if (value < c->iso) continue;
    for (int b = 0; b < BISECTIONS; b++) {
      float middle = 0.5f * (low + high);
      if (potential(c, (float[3]){x, middle, z}) >= c->iso)
        low = middle;
      else
        high = middle;
    }
    return 0.5f * (low + high);
  }
  return c->floor;
}

static void height_kernel(int32_t begin, int32_t end, const void *context) {
  const FieldContext *c = context;
  const SimHeightField *f = c->field;
  for (int32_t node = begin; node < end; node++) {
    int32_t i = node % f->size[0], k = node / f->size[0];
    c->height[node] = column_height(c, f->origin[0] + f->spacing * (float)i, f->origin[1] + f->spacing * (float)k);
  }
}

// Slope along one axis from the neighbours that have water; the node itself stands in for one that has not.
static float slope(const FieldContext *c, int32_t node, int32_t index, int32_t size, int32_t stride) {
  int32_t before = index > 0 && c->height[node - stride] > c->floor ? node - stride : node;
  int32_t after = index < size - 1 && c->height[node + stride] > c->floor ? node + stride : node;
  float distance = c->field->spacing * (float)((after - before) / stride);
  return distance > 0 ? (c->height[after] - c->height[before]) / distance : 0;
}

static void normal_kernel(int32_t begin, int32_t end, const void *context) {
  const FieldContext *c = context;
  const SimHeightField *f = c->field;
  for (int32_t node = begin; node < end; node++) {
    float dx = 0, dz = 0;
    if (c->height[node] > c->floor) {
      dx = slope(c, node, node % f->size[0], f->size[0], 1);
      dz = slope(c, node, node / f->size[0], f->size[1], f->size[0]);
    }
    float length = sqrtf(dx * dx + dz * dz + 1);
    c->normal[3 * (int64_t)node] = -dx / length;
    c->normal[3 * (int64_t)node + 1] = 1 / length;
    c->normal[3 * (int64_t)node + 2] = -dz / length;
  }
}

int64_t sim_surface_height_nodes(const SimSurface *surface, const float low[3], const float high[3],
                                 SimHeightField *field) {
  double spacing = surface->spacing, width = (double)high[0] - (double)low[0], depth = (double)high[2] - (double)low[2];
  while ((floor(width / spacing) + 2) * (floor(depth / spacing) + 2) > MAX_NODES) spacing *= 1.5;
  field->size[0] = (int32_t)ceil(width / spacing - 1e-3) + 1;
  field->size[1] = (int32_t)ceil(depth / spacing - 1e-3) + 1;
  field->origin[0] = low[0];
  field->origin[1] = low[2];
  field->spacing = (float)spacing;
  return (int64_t)field->size[0] * field->size[1];
}

void sim_surface_heightfield(const SimSurface *surface, float floor_height, const SimHeightField *field, float *height,
                             float *normal) {
  FieldContext context = {surface,
                          field,
                          ISO_RADIUS * surface->spacing,
                          surface->spacing / STEPS_A_SPACING,
                          (float)level_lattice_value(),
                          floor_height,
                          height,
                          normal};
  sim_parallel_for(surface->threads, field->size[0] * field->size[1], height_kernel, &context);
  sim_parallel_for(surface->threads, field->size[0] * field->size[1], normal_kernel, &context);
}
