// Physical measures of a world's present state.
#include <math.h>
#include <string.h>

#include "sim/parallel.h"
#include "sim/world.h"

// A particle whose density gradient is longer than this, times the spacing, lies at the free surface: inside it is near
// 0, at a flat surface about one half. So does one with so few neighbours that their sum says nothing: a drop, a thread.
#define SURFACE_ASYMMETRY 0.2f
#define SURFACE_DENSITY 0.8f

// A settled world has |∇C| · spacing beside the positions in `second`.
static bool at_surface(const SimParticles *p, uint32_t i) {
  return p->second[4 * (size_t)i + 3] > SURFACE_ASYMMETRY || p->density[i] < SURFACE_DENSITY;
}

static bool away_from_surface(const SimWorld *world, int32_t i) {
  const SimParticles *p = &world->particles;
  const SimNeighbours *lists = &world->neighbours;
  if (at_surface(p, (uint32_t)i)) return false;
  const uint32_t *index = lists->index + (size_t)lists->start[i / SIM_CHUNK] * SIM_CHUNK + i % SIM_CHUNK;
  for (uint32_t k = 0; k < lists->length[i / SIM_CHUNK]; k++, index += SIM_CHUNK)
    if (*index < (uint32_t)p->count && at_surface(p, *index)) return false;
  return true;
}

enum { KINETIC, POTENTIAL, MOMENTUM, ERROR_SUM = MOMENTUM + 3, ERROR_COUNT, SUMS };
enum { MAX_ERROR, MAX_SPEED2, MAXIMA };

static void sum_kernel(int32_t begin, int32_t end, const void *context, double *sum) {
  const SimWorld *world = context;
  const SimSorted *now = &world->particles.now;
  for (int32_t i = begin; i < end; i++) {
    for (int k = 0; k < 3; k++) {
      double v = now->velocity[k][i];
      sum[KINETIC] += 0.5 * v * v;
      sum[POTENTIAL] -= (double)world->gravity[k] * ((double)now->position[k][i] - (double)world->def.container.min[k]);
      sum[MOMENTUM + k] += v;
    }
    if (!away_from_surface(world, i)) continue;
    sum[ERROR_SUM] += fabs((double)world->particles.density[i] - 1);
    sum[ERROR_COUNT] += 1;
  }
}

static void max_kernel(int32_t begin, int32_t end, const void *context, double *most) {
  const SimWorld *world = context;
  const SimSorted *now = &world->particles.now;
  for (int32_t i = begin; i < end; i++) {
    double v2 = 0, error = fabs((double)world->particles.density[i] - 1);
    for (int k = 0; k < 3; k++) v2 += (double)now->velocity[k][i] * (double)now->velocity[k][i];
    if (v2 > most[MAX_SPEED2]) most[MAX_SPEED2] = v2;
    if (error > most[MAX_ERROR] && away_from_surface(world, i)) most[MAX_ERROR] = error;
  }
}

SimMeasures sim_world_measures(SimWorld *world) {
  SimMeasures measures = {0};
  double sum[SUMS], most[MAXIMA] = {0};
  if (!sim_world_settle(world, NULL)) return measures;
  double mass = (double)world->def.rest_density * (double)world->cubic.volume;
  sim_parallel_sum(world->threads, world->particles.count, SUMS, sum_kernel, world, sum);
  sim_parallel_max(world->threads, world->particles.count, MAXIMA, max_kernel, world, most);
  measures.kinetic_energy = mass * sum[KINETIC];
  measures.potential_energy = mass * sum[POTENTIAL];
  for (int k = 0; k < 3; k++) measures.momentum[k] = mass * sum[MOMENTUM + k];
  measures.mean_density_error = sum[ERROR_COUNT] > 0 ? sum[ERROR_SUM] / sum[ERROR_COUNT] : 0;
  measures.max_density_error = most[MAX_ERROR];
  measures.max_speed = sqrt(most[MAX_SPEED2]);
  if (world->motion.rigid)
    sim_rigid_measures(world->motion.rigid, world->gravity, world->def.container.min, measures.body_momentum,
                       &measures.body_energy);
  return measures;
}
