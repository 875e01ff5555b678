#include "sim/particles.h"

#include <assert.h>
#include <string.h>

#include "sim/memory.h"
#include "sim/parallel.h"
#include "sim/wide/wide.h"

int32_t sim_particles_list(SimSorted *sorted, bool coloured, void **list[SIM_SORTED_ARRAYS]) {
  for (int k = 0; k < 3; k++) {
    list[k] = (void **)&sorted->position[k];
    list[3 + k] = (void **)&sorted->velocity[k];
    list[6 + k] = (void **)&sorted->next_velocity[k];
    if (coloured) list[11 + k] = (void **)&sorted->colour[k];
  }
  list[9] = (void **)&sorted->pressure;
  list[10] = (void **)&sorted->id;
  return coloured ? SIM_SORTED_ARRAYS : SIM_SORTED_ARRAYS - 3;
}

// Whole chunks, and one more for the particles infinitely far away.
static size_t padded(int32_t count) {
  return ((size_t)count + 2 * SIM_CHUNK - 1) / SIM_CHUNK * SIM_CHUNK;
}

bool sim_particles_reserve(SimParticles *particles, int32_t capacity) {
  if (particles->first && capacity <= particles->capacity) return true;
  void **list[SIM_SORTED_ARRAYS];
  int32_t arrays = sim_particles_list(&particles->now, particles->coloured, list);
  size_t n = padded(capacity);
  for (int32_t k = 0; k < arrays; k++)
    if (!sim_reserve_keep(list[k], n, sizeof(float))) return false;
  for (int k = 0; k < SIM_SPARES; k++)
    if (!sim_reserve(&particles->spare[k], n, sizeof(float))) return false;
  if (!sim_reserve((void **)&particles->first, 4 * n, sizeof(float)) ||
      !sim_reserve((void **)&particles->second, 4 * n, sizeof(float)) ||
      (particles->with_work && !sim_reserve((void **)&particles->work, 4 * n, sizeof(float))) ||
      !sim_reserve_keep((void **)&particles->density, n, sizeof(float)) ||
      !sim_reserve((void **)&particles->solid, 4 * n, sizeof(float)) ||
      !sim_reserve((void **)&particles->near, n / SIM_CHUNK, 1))
    return false;
  particles->capacity = capacity;
  return true;
}

void sim_particles_free(SimParticles *particles) {
  void **list[SIM_SORTED_ARRAYS];
  int32_t arrays = sim_particles_list(&particles->now, true, list);
  for (int32_t k = 0; k < arrays; k++) sim_release(*list[k]);
  for (int k = 0; k < SIM_SPARES; k++) sim_release(particles->spare[k]);
  sim_release(particles->first);
  sim_release(particles->second);
  sim_release(particles->work);
  sim_release(particles->density);
  sim_release(particles->solid);
  sim_release(particles->near);
  memset(particles, 0, sizeof *particles);
}

bool sim_particles_colour(SimParticles *particles, const float colour[3]) {
  if (particles->coloured) return true;
  for (int k = 0; k < 3; k++) {
    if (!sim_reserve((void **)&particles->now.colour[k], padded(particles->capacity), sizeof(float))) return false;
    for (int32_t i = 0; i < particles->count; i++) particles->now.colour[k][i] = colour[k];
  }
  particles->coloured = true;
  return true;
}

void sim_particles_add(SimParticles *particles, uint32_t id, const float position[3], const float velocity[3],
                       const float colour[3]) {
  assert(particles->count < particles->capacity);
  int32_t i = particles->count++;
  particles->shuffled = true;
  for (int k = 0; k < 3; k++) {
    particles->now.position[k][i] = position[k];
    particles->now.velocity[k][i] = particles->now.next_velocity[k][i] = velocity[k];
  }
  for (int k = 0; particles->coloured && k < 3; k++) particles->now.colour[k][i] = colour[k];
  particles->now.pressure[i] = 0;
  particles->now.id[i] = id;
}

void sim_particles_second_as_axes(const SimParticles *particles, float *axes[3]) {
  for (size_t k = 0; k < 3; k++) axes[k] = particles->second + k * padded(particles->count);
}

void sim_particles_pad(const SimParticles *particles, float *four) {
  size_t end = padded(particles->count);
  for (size_t i = (size_t)particles->count; i < end; i++)
    for (int k = 0; k < 4; k++) four[4 * i + k] = k < 3 ? SIM_FAR : 0;
}

void sim_particles_pad_zero(const SimParticles *particles, float *four) {
  size_t n = (size_t)particles->count;
  memset(four + 4 * n, 0, 4 * (padded(particles->count) - n) * sizeof(float));
}

// ---- Sort ------------------------------------------------------------------------------------------------------------

typedef struct MoveContext {
  const SimParticles *particles;
  const uint32_t *order;
  float *axes[3];
} MoveContext;

static void to_first_kernel(int32_t begin, int32_t end, const void *context) {
  const MoveContext *c = context;
  for (int32_t i = begin; i < end; i++) {
    float *four = c->particles->first + 4 * (size_t)i;
    for (int k = 0; k < 3; k++) four[k] = c->axes[k][c->order[i]];
    four[3] = 0;
  }
}

static void to_axes_kernel(int32_t begin, int32_t end, const void *context) {
  const MoveContext *c = context;
  for (int32_t i = begin; i < end; i++)
    for (int k = 0; k < 3; k++) c->axes[k][i] = c->particles->first[4 * (size_t)i + k];
}

bool sim_particles_sort(SimParticles *particles, SimCellSort *sort, float cell_size, int32_t threads) {
  MoveContext context = {.particles = particles};
  sim_particles_second_as_axes(particles, context.axes);
  if (!sim_grid_sort(sort, sim_positions(context.axes), particles->count, sim_cells(cell_size), threads)) return false;
  context.order = sort->order;
  particles->shuffled = false;
  sim_parallel_for(threads, particles->count, to_first_kernel, &context);
  sim_particles_pad(particles, particles->first);
  sim_parallel_for(threads, particles->count, to_axes_kernel, &context);

  void **list[SIM_SORTED_ARRAYS];
  int32_t arrays = sim_particles_list(&particles->now, particles->coloured, list);
  for (int32_t k = 0; k < arrays; k += SIM_SPARES) {
    int32_t moved = arrays - k < SIM_SPARES ? arrays - k : SIM_SPARES;
    const void *source[SIM_SPARES];
    for (int32_t a = 0; a < moved; a++) source[a] = *list[k + a];
    sim_grid_gather(sort, particles->count, threads, moved, source, particles->spare);
    for (int32_t a = 0; a < moved; a++) {
      void *sorted = particles->spare[a];
      particles->spare[a] = *list[k + a];
      *list[k + a] = sorted;
    }
  }
  return true;
}
