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
  float *colour[3];        ///< linear light, written by particles_add; only where `coloured` is set
  uint32_t *id;            ///< unique, written by particles_add
} SimSorted;

typedef struct SimParticles {
  int32_t count, capacity;
  bool coloured;           ///< colours are held and follow the particles
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
void sim_particles_add(SimParticles *particles, uint32_t id, const float position[3], const float velocity[3],
                       const float colour[3]);

/// Hold colours from now on; the particles that are there get the given one. false when memory runs out.
bool sim_particles_colour(SimParticles *particles, const float colour[3]);

/// Every array that follows a particle, all of them of 32-bit words: the one list that sorting and removal go by.
#define SIM_SORTED_ARRAYS 16
int32_t sim_particles_list(SimSorted *sorted, bool coloured, void **list[SIM_SORTED_ARRAYS]);

/// Take away the particles whose flag is set, (count); the others keep their order (particles_remove.c).
void sim_particles_remove(SimParticles *particles, const uint8_t *gone);

/// Sort everything in `now` by the cells of the given positions (one of its own arrays).
bool sim_particles_sort(SimParticles *particles, SimCellSort *sort, float *const by[3], float cell_size, int32_t threads);

#endif
