// What the water gives to floating bodies: the opposite of everything that these bodies do to particles.
//
// Whatever changes a particle's velocity on behalf of a floating body, the pressure term κ λ_i ∇f of its share f of the
// particle's density, what it adds along its surface, or the hard clamp, is noted per particle as a displacement, the change
// of velocity times dt. After each
// sweep over the particles sim_reaction_collect turns the notes into impulses −m Δx/dt at the particles' places and adds them
// up per body: one note is one equal and opposite push, so fluid and bodies together keep their momentum to rounding. (The
// pressure between two particles is theirs alone and needs no note.)
//
// Determinism: kernels write only the notes of their own particles; the sums are taken by one thread in the order of the
// particles, skipping chunks without any note.
#ifndef LIDO_SIM_REACTION_H
#define LIDO_SIM_REACTION_H

#include <stdint.h>

#include "sim/boundary.h"
#include "sim/particles.h"
#include "sim/rigid.h"

/// What bodies did to one particle in one sweep.
typedef struct SimNote {
  int32_t body[SIM_FLOATERS];      ///< obstacles, −1: none
  float gradient[SIM_FLOATERS][3]; ///< 1/m, each body's part of the share's gradient
  float shift[SIM_FLOATERS][3];    ///< m, what each body moved the particle
} SimNote;

typedef struct SimReaction {
  const SimBoundary *boundary;
  const SimRigid *rigid;
  float most;           ///< m, that a wedged particle moves a body's layer in this substep
  float inverse_slope;  ///< m: one over the steepness of a flat wall's share where the first layer of particles lies
  double particle_mass; ///< kg
  SimNote *notes;       ///< (capacity), by the kernels; of chunks near no body they are not valid
  uint8_t *noted;       ///< (chunks): whether a chunk of particles has notes; by sim_reaction_collect and _layer
  SimGiven *given;      ///< (floating bodies): what was given since sim_reaction_clear
} SimReaction;

/// What walls and bodies together did to a particle: it was moved by pressure · gradient + aside.
typedef struct SimAnswer {
  float pressure;              ///< m²
  float aside[3];              ///< m; a body's part is that of its gradient in the whole one
  float gradient[3];           ///< 1/m, of the solid share
} SimAnswer;

/// Where particle i is: (x[0][i stride], x[1][i stride], x[2][i stride]).
typedef struct SimPlaces {
  const float *x[3];
  int32_t stride;
} SimPlaces;

/// `boundary` and `rigid` must stay; they need not be complete yet but for the wall. false: no memory.
bool sim_reaction_create(SimReaction *reaction, const SimBoundary *boundary, const SimRigid *rigid,
                         double particle_mass);
void sim_reaction_destroy(SimReaction *reaction);
/// Make room for the notes of `count` particles. false: no memory.
bool sim_reaction_reserve(SimReaction *reaction, int32_t count);

/// m/s: how fast things that overlap part, what a fall of half a spacing would give.
float sim_reaction_recovery(float spacing);

/// Nothing given so far in this substep of dt (s).
void sim_reaction_clear(SimReaction *reaction, float dt);

// Called by the kernels:

/// No body did anything to the particles begin … end − 1.
void sim_reaction_none(SimReaction *reaction, int32_t begin, int32_t end);
/// The prediction wanted particle i at `free`, the clamp put it to `to` and returned `clamped`; the share `kept` of that
/// changed its velocity.
void sim_reaction_predicted(SimReaction *reaction, int32_t i, int32_t clamped, float kept, const float free[3],
                            const float to[3]);
/// What sim_boundary_solid said at the particle's place.
void sim_reaction_solid(SimReaction *reaction, int32_t i, const SimSolid *solid);
/// The particle was moved by `answer` (among others) to `free`, and by the clamp to `to`, which returned `clamped` and of
/// which the share `kept` changed its velocity. Uses what sim_reaction_solid noted.
void sim_reaction_corrected(SimReaction *reaction, int32_t i, const SimAnswer *answer, int32_t clamped, float kept,
                            const float free[3], const float to[3]);

/// Add up the notes of particles 0 … count − 1 in chunks near a body (SIM_NEAR_BODY; `near` NULL: in all).
void sim_reaction_collect(SimReaction *reaction, int32_t threads, int32_t count, const uint8_t *near,
                          const SimPlaces *places, float inverse_dt);

// At the end of a substep, with the particles in their new state:

/// Weigh the layer of water at each body: particles in its reach under pressure (now.pressure < 0).
void sim_reaction_layer(SimReaction *reaction, int32_t threads, const SimParticles *particles);
/// The layers take part in the bodies' change of velocity, once sim_rigid_step has found it.
void sim_reaction_follow(const SimReaction *reaction, int32_t threads, const SimParticles *particles);

#endif
