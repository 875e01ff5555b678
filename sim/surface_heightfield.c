// The free surface as a height over the floor: Cords & Staadt, Instant Liquids / Real-Time Open Water Environments with
// Interacting Objects, 2007, Eq. 5 and 6: φ(x) = Σ sqrt(1 − r²/h²) over the particles with r < h (nothing beyond).
//
// h is 2⅝ spacings: of the radii up to three, the one where the level of a lattice depends least on where over its particles it
// is asked for, by 0.04 spacings (at two: 0.15). The iso-value is that of a level lattice, half a spacing above its highest
// layer (averaged over places between the particles), so a pool at rest shows its true level. A drop alone stays below it and is
// not part of the height field.
//
// Walls. φ would fall where there is nothing behind a wall, so the container's walls and its floor are mirrors. Obstacles
// displace water: near them the iso-value is lower by the share of φ that they take up, as if the half lattice below the surface
// reached into them (the idea of boundary.h, with φ's own kernel), and what is then still missing is filled from the water
// around (surface_height_fill.c).
//
// In each column φ is sampled from above at multiples of a quarter spacing over the floor; the first sample at or above
// the iso-value and the one before it bracket the surface, which bisection then finds (wide/height.c).
#include <math.h>

#include "sim/parallel.h"
#include "sim/surface.h"

#define ISO_RADIUS 2.625  // in spacings
#define STEPS_A_SPACING 4 // samples of a column
#define MAX_NODES (1 << 20)
#define PI 3.14159265358979323846

// φ of one layer of a lattice at the distance d (spacings), averaged over places between its particles: the integral of
// sqrt(1 − (d² + ρ²)/h²) over the layer.
static double layer_value(double d) {
  const double h2 = ISO_RADIUS * ISO_RADIUS;
  return d * d < h2 ? 2 * PI / 3 * h2 * pow(1 - d * d / h2, 1.5) : 0;
}

// φ of a half lattice whose first layer lies half a spacing behind its surface, at the distance d in front of it.
static double half_lattice_value(double d) {
  double sum = 0;
  for (int k = 0; k < 8; k++) sum += layer_value(d + k + 0.5);
  return sum;
}

// The wall that φ sees: the share of a half-space, see wall.h. On a lattice with the wall between two layers, the rest of φ is
// what lies on this side.
static void make_wall(SimWall *wall, double spacing) {
  const double reach = ISO_RADIUS - 0.5, step = reach / SIM_WALL_STEPS;
  *wall = (SimWall){.reach = (float)(reach * spacing),
                    .inverse_step = (float)(1 / (step * spacing)),
                    .spacing = (float)spacing,
                    .spread = (float)(ISO_RADIUS * ISO_RADIUS / 6.0 * spacing * spacing)}; // ∫ φ x² = h²/6 ∫ φ
  double share[SIM_WALL_STEPS + 3];
  for (int k = 0; k < SIM_WALL_STEPS + 3; k++) {
    double behind = half_lattice_value(k * step);
    share[k] = behind / (behind + half_lattice_value(-k * step));
  }
  for (int k = 0; k < SIM_WALL_STEPS + 2; k++) {
    double before = k > 0 ? share[k - 1] : 1 - share[1];
    wall->share[k] = (float)share[k];
    wall->slope[k] = (float)((share[k + 1] - before) / (2 * step * spacing));
  }
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

// Nodes of a side of the given length in steps of `spacing`, the last of them at its end or beyond.
static double nodes_of(double length, double spacing) {
  return ceil(length / spacing - 1e-3) + 1;
}

// A spacing, smaller by a quarter at most, that divides both sides of the container, so that the outer nodes stand on its
// walls: whole parts of the longer side are tried, and of those that leave the least over at the shorter one the longest is
// taken.
static double fitting_spacing(double spacing, double width, double depth) {
  double longer = fmax(width, depth), shorter = fmin(width, depth), best = spacing, least = INFINITY;
  double first = nodes_of(longer, spacing) - 1;
  for (double parts = fmax(first, 1); parts <= 4.0 / 3 * first; parts++) {
    double step = longer / parts, over = (nodes_of(shorter, step) - 1) - shorter / step;
    if (over < least - 0.01) best = step, least = over;
  }
  return best;
}

float sim_height_glass(const SimContainer *container, float axis[2]) {
  axis[0] = axis[1] = 0;
  if (!container || container->shape != SIM_CONTAINER_GLASS) return 0;
  axis[0] = 0.5f * (container->min[0] + container->max[0]);
  axis[1] = 0.5f * (container->min[2] + container->max[2]);
  return 0.5f * fminf(container->max[0] - container->min[0], container->max[2] - container->min[2]);
}

// m, what the nodes span, in x and z.
static void span_of(const SimSurface *surface, double low[2], double high[2]) {
  const SimContainer *container = surface->container;
  float axis[2], radius = sim_height_glass(container, axis), reach = ISO_RADIUS * surface->spacing;
  for (int k = 0; k < 2; k++) {
    low[k] = (double)(container ? container->min[2 * k] : surface->bounds_min[2 * k] - reach);
    high[k] = (double)(container ? container->max[2 * k] : surface->bounds_max[2 * k] + reach);
    if (radius > 0) low[k] = (double)axis[k] - (double)radius, high[k] = (double)axis[k] + (double)radius;
  }
}

int64_t sim_surface_height_nodes(const SimSurface *surface, SimHeightField *field) {
  double low[2], high[2], spacing = surface->node_spacing;
  span_of(surface, low, high);
  double width = high[0] - low[0], depth = high[1] - low[1];
  while ((floor(width / spacing) + 2) * (floor(depth / spacing) + 2) > MAX_NODES * (9.0 / 16)) spacing *= 1.5;
  if (surface->container) spacing = fitting_spacing(spacing, width, depth);
  field->size[0] = (int32_t)nodes_of(width, spacing);
  field->size[1] = (int32_t)nodes_of(depth, spacing);
  field->origin[0] = (float)low[0];
  field->origin[1] = (float)low[1];
  field->spacing = (float)spacing;
  return (int64_t)field->size[0] * field->size[1];
}

void sim_surface_heightfield(const SimSurface *surface, float floor_height, const SimHeightField *field,
                             const SimHeightArrays *arrays) {
  SimBoundary solids;
  SimHeightContext context = {.surface = surface,
                              .field = field,
                              .radius = ISO_RADIUS * surface->spacing,
                              .step = surface->spacing / STEPS_A_SPACING,
                              .iso = (float)half_lattice_value(0),
                              .floor = floor_height,
                              .walls = surface->container,
                              .height = arrays->height,
                              .normal = arrays->normal,
                              .underside = arrays->underside,
                              .second = arrays->second};
  context.glass = sim_height_glass(surface->container, context.axis);
  if (surface->body_count > 0) {
    solids =
        (SimBoundary){.container = *surface->container, .body_count = surface->body_count, .bodies = surface->bodies};
    make_wall(&solids.wall, surface->spacing);
    context.solids = &solids;
  }
  sim_parallel_for(surface->threads, field->size[0] * field->size[1], surface->wide->surface_heights, &context);
  if (context.solids) sim_surface_height_fill(&context, arrays);
  sim_parallel_for(surface->threads, field->size[0] * field->size[1], normal_kernel, &context);
}
