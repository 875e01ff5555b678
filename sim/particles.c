#include "sim/particles.h"

#include <assert.h>
#include <string.h>

#include "sim/memory.h"

#define SORTED_ARRAYS 13
#define WORK_ARRAYS 13

static void list_sorted(SimSorted *sorted, void ***list) {
  for (int k = 0; k < 3; k++) {
    list[k] = (void **)&sorted->position[k];
    list[3 + k] = (void **)&sorted->velocity[k];
    list[6 + k] = (void **)&sorted->predicted[k];
    list[9 + k] = (void **)&sorted->next_velocity[k];
  }
  list[12] = (void **)&sorted->id;
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

bool sim_particles_reserve(SimParticles *particles, int32_t capacity) {
  if (capacity <= particles->capacity) return true;
  void **list[2 * SORTED_ARRAYS + WORK_ARRAYS];
  list_sorted(&particles->now, list);
  list_sorted(&particles->spare, list + SORTED_ARRAYS);
  list_work(particles, list + 2 * SORTED_ARRAYS);
  for (int k = 0; k < 2 * SORTED_ARRAYS + WORK_ARRAYS; k++)
    if (!sim_reserve_keep(list[k], (size_t)capacity, sizeof(float))) return false;
  particles->capacity = capacity;
  return true;
}

void sim_particles_free(SimParticles *particles) {
  void **list[2 * SORTED_ARRAYS + WORK_ARRAYS];
  list_sorted(&particles->now, list);
  list_sorted(&particles->spare, list + SORTED_ARRAYS);
  list_work(particles, list + 2 * SORTED_ARRAYS);
  for (int k = 0; k < 2 * SORTED_ARRAYS + WORK_ARRAYS; k++) sim_release(*list[k]);
  memset(particles, 0, sizeof *particles);
}

void sim_particles_add(SimParticles *particles, uint32_t id, const float position[3], const float velocity[3]) {
  assert(particles->count < particles->capacity);
  int32_t i = particles->count++;
  for (int k = 0; k < 3; k++) {
    particles->now.position[k][i] = particles->now.predicted[k][i] = position[k];
    particles->now.velocity[k][i] = particles->now.next_velocity[k][i] = velocity[k];
  }
  particles->now.id[i] = id;
}

bool sim_particles_sort(SimParticles *particles, SimCellSort *sort, float *const by[3], float cell_size,
                        int32_t threads) {
  if (!sim_grid_sort(sort, by, particles->count, cell_size, threads)) return false;
  void **from[SORTED_ARRAYS], **to[SORTED_ARRAYS];
  const void *source[SORTED_ARRAYS];
  void *target[SORTED_ARRAYS];
  list_sorted(&particles->now, from);
  list_sorted(&particles->spare, to);
  for (int k = 0; k < SORTED_ARRAYS; k++) source[k] = *from[k], target[k] = *to[k];
  sim_grid_gather(sort, particles->count, threads, SORTED_ARRAYS, source, target);
  SimSorted swap = particles->now;
  particles->now = particles->spare;
  particles->spare = swap;
  return true;
}
