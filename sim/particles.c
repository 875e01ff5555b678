#include "sim/particles.h"

#include <assert.h>
#include <string.h>

#include "sim/memory.h"

#define WORK_ARRAYS 13

int32_t sim_particles_list(SimSorted *sorted, bool coloured, void **list[SIM_SORTED_ARRAYS]) {
  for (int k = 0; k < 3; k++) {
    list[k] = (void **)&sorted->position[k];
    list[3 + k] = (void **)&sorted->velocity[k];
    list[6 + k] = (void **)&sorted->predicted[k];
    list[9 + k] = (void **)&sorted->next_velocity[k];
  }
  list[12] = (void **)&sorted->id;
  for (int k = 0; coloured && k < 3; k++) list[13 + k] = (void **)&sorted->colour[k];
  return coloured ? SIM_SORTED_ARRAYS : SIM_SORTED_ARRAYS - 3;
}

static void list_work(SimParticles *particles, void ***list) {
  for (int k = 0; k < 3; k++) {
    list[k] = (void **)&particles->scratch[k];
    list[3 + k] = (void **)&particles->solid_gradient[k];
  }
  list[6] = (void **)&particles->density;
  list[7] = (void **)&particles->lambda;
  list[8] = (void **)&particles->asymmetry;
  list[9] = (void **)&particles->solid;
  for (int k = 0; k < 3; k++) list[10 + k] = (void **)&particles->repulsion[k];
}

// All arrays, with the colours or without.
#define ALL_ARRAYS (2 * SIM_SORTED_ARRAYS + WORK_ARRAYS)

static int32_t list_all(SimParticles *particles, bool coloured, void **list[ALL_ARRAYS]) {
  int32_t count = sim_particles_list(&particles->now, coloured, list);
  count += sim_particles_list(&particles->spare, coloured, list + count);
  list_work(particles, list + count);
  return count + WORK_ARRAYS;
}

bool sim_particles_reserve(SimParticles *particles, int32_t capacity) {
  if (capacity <= particles->capacity) return true;
  void **list[ALL_ARRAYS];
  int32_t count = list_all(particles, particles->coloured, list);
  for (int32_t k = 0; k < count; k++)
    if (!sim_reserve_keep(list[k], (size_t)capacity, sizeof(float))) return false;
  particles->capacity = capacity;
  return true;
}

void sim_particles_free(SimParticles *particles) {
  void **list[ALL_ARRAYS];
  int32_t count = list_all(particles, true, list);
  for (int32_t k = 0; k < count; k++) sim_release(*list[k]);
  memset(particles, 0, sizeof *particles);
}

bool sim_particles_colour(SimParticles *particles, const float colour[3]) {
  if (particles->coloured) return true;
  for (int k = 0; k < 3; k++) {
    if (!sim_reserve((void **)&particles->now.colour[k], (size_t)particles->capacity, sizeof(float)) ||
        !sim_reserve((void **)&particles->spare.colour[k], (size_t)particles->capacity, sizeof(float)))
      return false;
    for (int32_t i = 0; i < particles->count; i++) particles->now.colour[k][i] = colour[k];
  }
  particles->coloured = true;
  return true;
}

void sim_particles_add(SimParticles *particles, uint32_t id, const float position[3], const float velocity[3],
                       const float colour[3]) {
  assert(particles->count < particles->capacity);
  int32_t i = particles->count++;
  for (int k = 0; k < 3; k++) {
    particles->now.position[k][i] = particles->now.predicted[k][i] = position[k];
    particles->now.velocity[k][i] = particles->now.next_velocity[k][i] = velocity[k];
  }
  for (int k = 0; particles->coloured && k < 3; k++) particles->now.colour[k][i] = colour[k];
  particles->now.id[i] = id;
}

bool sim_particles_sort(SimParticles *particles, SimCellSort *sort, float *const by[3], float cell_size,
                        int32_t threads) {
  if (!sim_grid_sort(sort, by, particles->count, cell_size, threads)) return false;
  void **from[SIM_SORTED_ARRAYS], **to[SIM_SORTED_ARRAYS];
  const void *source[SIM_SORTED_ARRAYS];
  void *target[SIM_SORTED_ARRAYS];
  int32_t arrays = sim_particles_list(&particles->now, particles->coloured, from);
  sim_particles_list(&particles->spare, particles->coloured, to);
  for (int32_t k = 0; k < arrays; k++) source[k] = *from[k], target[k] = *to[k];
  sim_grid_gather(sort, particles->count, threads, arrays, source, target);
  SimSorted swap = particles->now;
  particles->now = particles->spare;
  particles->spare = swap;
  return true;
}
