// The particle store: structures of arrays, 64-byte aligned, sorted by grid cell.
//
// Two kinds of arrays. The state follows a particle through the sort. The work arrays belong to one substep; two of them
// hold four floats a particle side by side, because a neighbour's position is read from a random place and one such
// place costs one load (and one cache line) instead of three.
//
// Every array has room for whole chunks (wide/wide.h) and one chunk more. Behind the last particle stand particles
// infinitely far away (SIM_FAR), so that kernels need no special case for the ends of lists and of the array.
#ifndef LIDO_SIM_PARTICLES_H
#define LIDO_SIM_PARTICLES_H

#include "sim/grid.h"

/// m: so far that no kernel reaches it, and near enough that its square is finite.
#define SIM_FAR 1e18f

/// What follows a particle through the sort. Each array is (count).
typedef struct SimSorted {
  float *position[3];      ///< m, the state at the start of the substep
  float *velocity[3];      ///< m/s, likewise; both change only when a substep has succeeded
  float *next_velocity[3]; ///< m/s, written by predict, correct and viscosity
  float *pressure;         ///< m²/s², what the solver starts the next substep from: of pbf, Σλ/dt²; never positive
  float *colour[3];        ///< linear light, [0, 1]; only where `coloured` is set
  uint32_t *id;            ///< unique
} SimSorted;

/// Arrays that the sort moves at a time.
#define SIM_SPARES 3

typedef struct SimParticles {
  int32_t count, capacity;
  bool shuffled;           ///< particles came or went since the last sort: neighbour lists mean others
  bool coloured;           ///< colours are held and follow the particles
  SimSorted now;
  void *spare[SIM_SPARES]; ///< (count) words each: the sort moves arrays into them and swaps them
  // Work arrays in the present order.
  float *first, *second;   ///< (count, 4): x, y, z of the predicted position, m, and a number that the stages name
  float *work;             ///< (count, 4), where `with_work`: another one that the stages name
  bool with_work;
  float *density;          ///< share of the rest density in a settled state; pbf keeps inherited compression here meanwhile
  float *solid;            ///< (count, 4): gradient of the walls' share of the density, 1/m, where a chunk is near something, and
                           ///< the share itself; for a sweep, tensors stand in the gradient's place (wide/shear.h)
  uint8_t *near;           ///< (chunks): SIM_NEAR_… of each chunk
} SimParticles;

/// What may be in reach of a chunk.
#define SIM_NEAR_WALL 1  ///< a wall of the box: the wide kernels know it
#define SIM_NEAR_BODY 2  ///< an obstacle, a glass, walls close to each other: boundary.h knows it

/// Make room, keeping the state. false when memory runs out; nothing is lost then.
bool sim_particles_reserve(SimParticles *particles, int32_t capacity);
void sim_particles_free(SimParticles *particles);

/// Append a particle at rest in the solver's eyes. There must be room.
void sim_particles_add(SimParticles *particles, uint32_t id, const float position[3], const float velocity[3],
                       const float colour[3]);

/// Hold colours from now on; the particles that are there get the given one. false when memory runs out.
bool sim_particles_colour(SimParticles *particles, const float colour[3]);

/// Every array that follows a particle, all of them of 32-bit words: the one list that sorting and removal go by. The
/// colours come last, and only if asked for. Returns how many.
#define SIM_SORTED_ARRAYS 14
int32_t sim_particles_list(SimSorted *sorted, bool coloured, void **list[SIM_SORTED_ARRAYS]);

/// Take away the particles whose flag is set, (count); the others keep their order (particles_remove.c).
void sim_particles_remove(SimParticles *particles, const uint8_t *gone);

/// The work array `second` as three arrays x, y, z of one float a particle (while nobody needs it otherwise).
void sim_particles_second_as_axes(const SimParticles *particles, float *axes[3]);

/// Sort the state by the cells of the predicted positions, which stand in `second` as axes, and leave them sorted in `first`
/// and, as axes, in `second`.
bool sim_particles_sort(SimParticles *particles, SimCellSort *sort, float cell_size, int32_t threads);

/// Put the particles infinitely far away behind the last one of `first` or `second`.
void sim_particles_pad(const SimParticles *particles, float *four);
/// Put zeros there: velocities, normals.
void sim_particles_pad_zero(const SimParticles *particles, float *four);

#endif
