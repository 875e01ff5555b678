// What the water gives to floating bodies: the opposite of everything that these bodies do to particles.
//
// Whatever moves a particle on behalf of a floating body, the pressure term λ_i ∇f of its share f of the particle's
// density, the hard clamp, or friction, is noted per particle as a displacement, the change of the particle's velocity times
// dt. After each sweep over the particles sim_reaction_collect turns the notes into impulses −m Δx/dt at the particles'
// places and adds them up per body: one note is one equal and opposite push, so fluid and bodies together keep their
// momentum to rounding. (The pressure between two particles is theirs alone and needs no note.)
//
// Determinism: kernels write only the notes of their own particles; the sums are taken by one thread in the order of the
// particles, skipping blocks without any note.
#ifndef LIDO_SIM_REACTION_H
#define LIDO_SIM_REACTION_H

#include <stdint.h>

#include "sim/boundary.h"
#include "sim/rigid.h"

typedef struct SimReaction {
  const SimBoundary *boundary;
  const SimRigid *rigid;
  float most;             ///< m, that a wedged particle moves a body's layer in this substep
  float inverse_slope;    ///< m: one over the steepness of a flat wall's share where the first layer of particles lies
  double particle_mass;   ///< kg
  int32_t *body;          ///< (capacity): obstacle that the note is for, −1: no note; by the kernels
  float *gradient[3];     ///< 1/m, (capacity): that body's part of the share's gradient, by sim_reaction_solid
  float *shift[3];        ///< m, (capacity): what that body moved the particle in this sweep
  uint8_t *noted;         ///< (blocks): whether a block of particles has notes
  SimGiven *given;        ///< (floating bodies): what was given since sim_reaction_clear
} SimReaction;

/// `boundary` and `rigid` must stay; they need not be complete yet but for the wall. false: no memory.
bool sim_reaction_create(SimReaction *reaction, const SimBoundary *boundary, const SimRigid *rigid, double particle_mass);
void sim_reaction_destroy(SimReaction *reaction);
/// Make room for the notes of `count` particles. false: no memory.
bool sim_reaction_reserve(SimReaction *reaction, int32_t count);

/// m/s: how fast things that overlap part, what a fall of half a spacing would give.
float sim_reaction_recovery(float spacing);

/// Nothing given so far in this substep of dt (s).
void sim_reaction_clear(SimReaction *reaction, float dt);

// Called by the kernels, for particle i:

/// The prediction wanted the particle at `free`, the clamp put it to `to` and returned `clamped`; the share `kept` of that
/// changed its velocity.
void sim_reaction_predicted(SimReaction *reaction, int32_t i, int32_t clamped, float kept, const float free[3],
                            const float to[3]);
/// What sim_boundary_solid said at the particle's place.
void sim_reaction_solid(SimReaction *reaction, int32_t i, const SimSolid *solid);
/// An iteration moved the particle by λ times the share's gradient (among others) to `free`, and the clamp to `to`, returning `clamped`,
/// of which the share `kept` changed its velocity.
void sim_reaction_corrected(SimReaction *reaction, int32_t i, float lambda, int32_t clamped, float kept,
                            const float free[3], const float to[3]);
/// A body changed the particle's velocity by shift/dt (friction). Adds to the note; sim_reaction_collect follows.
void sim_reaction_rubbed(SimReaction *reaction, int32_t i, const float shift[3]);

/// Add up the notes of particles 0 … count − 1; particle i is at (x[i stride], y[i stride], z[i stride]). `last` in the
/// substep's last sweep of corrections: the layer of water at each body is weighed too.
void sim_reaction_collect(SimReaction *reaction, int32_t threads, int32_t count, const float *x, const float *y,
                          const float *z, int32_t stride, float inverse_dt, bool last);

/// The layers of water take part in the bodies' change of velocity, once sim_rigid_step has found it. Places as for
/// sim_reaction_collect, which was called for them with `last`; velocity[k][i] of particle i.
void sim_reaction_follow(const SimReaction *reaction, int32_t threads, int32_t count, const float *x, const float *y,
                         const float *z, int32_t stride, float *const velocity[3]);

#endif
