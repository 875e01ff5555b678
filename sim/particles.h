// The particle store: structure of arrays, 64-byte aligned, sorted by grid cell.
#ifndef LIDO_SIM_PARTICLES_H
#define LIDO_SIM_PARTICLES_H

#include "sim/grid.h"

/// What follows a particle through the sort. Each array is (count).
typedef struct SimSorted {
  float *position[3];      ///< m, the state at the start of the substep
  float *velocity[3];      ///< m/s, likewise; both change only when a substep has succeeded
  float *predicted[3];     ///< m, written by predict, corrected by the solver
  float *next_velocity[3]; ///< m/s, written by predict, correct and viscosity
  uint32_t *id;
} SimSorted;

typedef struct SimParticles {
  int32_t count, capacity;
  SimSorted now, spare;    ///< the sort gathers from one into the other and swaps them
  // Work arrays, (count), in the present order.
  float *scratch[3];       ///< new positions or velocities of a Jacobi sweep
  float *density;          ///< share of the rest density, written by pbf_density
  float *lambda;           ///< m², written by pbf_density
  float *repulsion[3];     ///< m, Σ s_corr ∇W, likewise
  float *asymmetry;        ///< |∇C| · spacing: 0 inside, about ½ at a flat free surface; written by pbf_density
  float *solid;            ///< the walls' share of the density, written by boundary
  float *solid_gradient[3]; ///< 1/m, likewise
} SimParticles;

/// Make room, keeping the particles. false when memory runs out; nothing is lost then.
bool sim_particles_reserve(SimParticles *particles, int32_t capacity);
void sim_particles_free(SimParticles *particles);

/// Append a particle at rest in the solver's eyes (predicted = position). There must be room.
void sim_particles_add(SimParticles *particles, uint32_t id, const float position[3], const float velocity[3]);

/// Sort everything in `now` by the cells of the given positions (one of its own arrays).
bool sim_particles_sort(SimParticles *particles, SimCellSort *sort, float *const by[3], float cell_size, int32_t threads);

#endif
