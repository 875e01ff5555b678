// The free surface as a height over the floor: Cords & Staadt, Instant Liquids / Real-Time Open Water Environments with
// Interacting Objects, 2007, Eq. 5 and 6: φ(x) = Σ sqrt(1 − r²/h²) over the particles with r < h (nothing beyond).
//
// h is two spacings. The iso-value is that of a level lattice, half a spacing above its highest layer (averaged over
// places between the particles), so a pool at rest shows its true level. A drop alone stays below it and is not part of
// the height field.
//
// In each column φ is sampled from above at multiples of a quarter spacing over the floor; the first sample at or above
// the iso-value and the one before it bracket the surface, which bisection then finds (wide/height.c).
#include <math.h>

#include "sim/parallel.h"
#include "sim/surface.h"

#define ISO_RADIUS 2      // in spacings
#define STEPS_A_SPACING 4 // samples of a column
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

// Slope along one axis from the neighbours that have water; the node itself stands in for one that has not.
static float slope(const SimHeightContext *c, int32_t node, int32_t index, int32_t size, int32_t stride) {
  int32_t before = index > 0 && c->height[node - stride] > c->floor ? node - stride : node;
  int32_t after = index < size - 1 && c->height[node + stride] > c->floor ? node + stride : node;
  float distance = c->field->spacing * (float)((after - before) / stride);
  return distance > 0 ? (c->height[after] - c->height[before]) / distance : 0;
}

static void normal_kernel(int32_t begin, int32_t end, const void *context) {
  const SimHeightContext *c = context;
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
  SimHeightContext context = {.surface = surface,
                              .field = field,
                              .radius = ISO_RADIUS * surface->spacing,
                              .step = surface->spacing / STEPS_A_SPACING,
                              .iso = (float)level_lattice_value(),
                              .floor = floor_height,
                              .height = height,
                              .normal = normal};
  sim_parallel_for(surface->threads, field->size[0] * field->size[1], surface->wide->surface_heights, &context);
  sim_parallel_for(surface->threads, field->size[0] * field->size[1], normal_kernel, &context);
}
