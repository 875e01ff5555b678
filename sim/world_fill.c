// Filling a block with a cubic lattice of particles, at the start and while the world runs.
#include <math.h>
#include <string.h>

#include "sim/memory.h"
#include "sim/world.h"

// A lattice point nearer than this to a particle, in spacings, stays empty.
#define TOO_NEAR 0.9f

typedef struct Lattice {
  int32_t size[3];
  float origin[3]; ///< m, the first point
} Lattice;

// As many points as whole spacings fit (a hundredth is forgiven for rounding), at least one in the middle.
static double lattice_make(const SimBlockDef *block, float spacing, Lattice *lattice) {
  double points = 1;
  for (int k = 0; k < 3; k++) {
    double length = (double)block->max[k] - (double)block->min[k], fit = floor(length / (double)spacing + 0.01);
    points *= fit < 1 ? 1 : fit;
    lattice->size[k] = fit < 1 ? 1 : fit > 1e9 ? 1000000000 : (int32_t)fit;
    lattice->origin[k] = fit < 1 ? (float)(block->min[k] + length / 2) : block->min[k] + spacing / 2;
  }
  return points;
}

// Counter-based random numbers (splitmix64: Steele, Lea, Flood, 2014): the value depends on seed, particle and axis only.
static float random_share(uint64_t seed, uint64_t particle, uint64_t axis) {
  uint64_t x = seed * 0x9e3779b97f4a7c15u + particle * 4 + axis + 1;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  x ^= x >> 31;
  return (float)(x >> 40) / 16777216.0f * 2 - 1;
}

// A sorted copy of the particles that are there already, to measure distances to.
static bool sort_present(SimWorld *world, SimError *error) {
  int32_t count = world->particles.count;
  void *target[3];
  const void *source[3];
  if (!sim_grid_sort(&world->fill_sort, world->particles.now.position, count, world->cubic.spacing, world->threads))
    return sim_fail(error, "out of memory");
  for (int k = 0; k < 3; k++) {
    if (!sim_reserve((void **)&world->fill_position[k], (size_t)count, sizeof(float)))
      return sim_fail(error, "out of memory");
    target[k] = world->fill_position[k];
    source[k] = world->particles.now.position[k];
  }
  sim_grid_gather(&world->fill_sort, count, world->threads, 3, source, target);
  return true;
}

static bool occupied(const SimWorld *world, const float point[3]) {
  float radius = TOO_NEAR * world->cubic.spacing;
  SimRange ranges[SIM_MAX_RANGES];
  int32_t n = sim_grid_ranges(&world->fill_sort.grid, point, radius, ranges);
  float *const *x = world->fill_position;
  for (int32_t r = 0; r < n; r++)
    for (int32_t j = ranges[r].begin; j < ranges[r].end; j++) {
      float dx = x[0][j] - point[0], dy = x[1][j] - point[1], dz = x[2][j] - point[2];
      if (dx * dx + dy * dy + dz * dz < radius * radius) return true;
    }
  return false;
}

static bool make_room(SimWorld *world, double points, SimError *error) {
  double wanted = points + world->particles.count;
  if (wanted > SIM_MAX_PARTICLES)
    return sim_fail(error, "too many particles: %.0f, at most %d", wanted, SIM_MAX_PARTICLES);
  int32_t capacity = (int32_t)wanted;
  // Pouring adds a little many times: grow by half.
  if (capacity > world->particles.capacity && world->particles.count > 0 && capacity < world->particles.capacity * 1.5)
    capacity = (int32_t)fmin(world->particles.capacity * 1.5, SIM_MAX_PARTICLES);
  if (!sim_particles_reserve(&world->particles, capacity) ||
      !sim_reserve_keep((void **)&world->colour, 3 * (size_t)world->particles.capacity, sizeof(float)))
    return sim_fail(error, "out of memory");
  return true;
}

static void add(SimWorld *world, const SimBlockDef *block, const float point[3]) {
  uint32_t id = (uint32_t)world->particles.count;
  memcpy(world->colour + 3 * (size_t)id, block->colour, sizeof block->colour);
  sim_particles_add(&world->particles, id, point, block->velocity);
}

int32_t sim_fill_block(SimWorld *world, const SimBlockDef *block, bool start, SimError *error) {
  Lattice lattice;
  float spacing = world->cubic.spacing, jitter = start ? world->def.jitter * spacing : 0;
  double points = lattice_make(block, spacing, &lattice);
  int32_t before = world->particles.count, left_out = 0;
  if (!make_room(world, points, error) || !sort_present(world, error)) return -1;
  for (int32_t z = 0; z < lattice.size[2]; z++)
    for (int32_t y = 0; y < lattice.size[1]; y++)
      for (int32_t x = 0; x < lattice.size[0]; x++) {
        const int32_t at[3] = {x, y, z};
        float point[3];
        for (int k = 0; k < 3; k++) point[k] = lattice.origin[k] + spacing * (float)at[k];
        if (!sim_boundary_free(&world->boundary, point) || (before > 0 && occupied(world, point))) {
          left_out++;
          continue;
        }
        float from[3] = {point[0], point[1], point[2]};
        for (int k = 0; k < 3 && jitter > 0; k++)
          point[k] += jitter * random_share(world->def.seed, (uint64_t)world->particles.count, (uint64_t)k);
        sim_boundary_clamp(&world->boundary, NULL, from, point);
        add(world, block, point);
      }
  if (block->colour[0] != 0 || block->colour[1] != 0 || block->colour[2] != 0) world->coloured = true;
  float speed = sqrtf(block->velocity[0] * block->velocity[0] + block->velocity[1] * block->velocity[1] +
                      block->velocity[2] * block->velocity[2]);
  if (10 * speed > world->speed_limit) world->speed_limit = 10 * speed;
  if (start) world->counts.left_out += left_out;
  if (world->particles.count > before) world->settled = false;
  return world->particles.count - before;
}

int32_t sim_world_pour(SimWorld *world, const SimBlockDef *block, SimError *error) {
  if (world->failed) {
    if (error) *error = world->failure;
    return -1;
  }
  if (!sim_block_check(block, "block", error)) return -1;
  int32_t added = sim_fill_block(world, block, false, error);
  return added > 0 && !sim_world_settle(world, error) ? -1 : added;
}
