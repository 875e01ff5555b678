// What solvers share: the context of a substep, the stages that every method is made of, and the table of methods.
//
// A method is one file (solver_NAME.c) with one const SimMethod, and one row in solver_table.c.
#ifndef LIDO_SIM_SOLVER_H
#define LIDO_SIM_SOLVER_H

#include "sim/boundary.h"
#include "sim/neighbours.h"
#include "sim/particles.h"
#include "sim/reaction.h"
#include "sim/sim.h"
#include "sim/wall_table.h"

/// One stage of a diffusion (diffusion.c): of the values in `second`, y → keep y + before · (what stands in `value`) +
/// gain Σ_j (share V W + spread V |dW/dr| r/(r² + soft h²)/moment) (y_j − y), into `value`.
typedef struct SimDiffusion {
  float share, spread; ///< –, m²
  float keep, before, gain;
  float *value[3];
} SimDiffusion;

/// What travels through one substep.
typedef struct SimStep {
  const SimWide *wide;
  int32_t threads;
  float dt, inverse_dt; ///< s, 1/s
  SimCubic cubic;
  float gravity[3]; ///< m/s²
  int32_t push_count;
  const SimPush *pushes;
  const SimBoundary *boundary;
  const SimBoundary *start; ///< the same with the bodies in the poses that they had at the start of the substep
  const SimWallTable *wall;
  SimParticles *particles;
  SimNeighbours *neighbours;
  float clamp_speed;          ///< m/s, to which the clamp may bring a particle that was slower
  SimReaction *reaction;      ///< what floating bodies get is noted here; NULL where none floats, or nothing is to be noted
  float viscosity_share;      ///< XSPH's c of this substep
  float viscosity;            ///< m²/s, ν
  float colour_diffusion;     ///< m²/s
  float confinement;          ///< ε of vorticity confinement
  const float *place;         ///< (count, 4), the positions that surface tension reads
  float cohesion, curvature;  ///< m/s², of surface tension
  SimDiffusion diffusion;
  float wall_answer;          ///< κ, how much of a particle's pressure a wall answers with (solver_pbf.h)
  // Position based fluids
  float omega;                ///< ω, damping of the Jacobi iteration
  float over;                 ///< ω_k of the Chebyshev iteration, 1 in its first step
  float relaxation;           ///< 1/m², ε
  float tensile;              ///< m², k
  float warm;                 ///< s², turns `pressure` into the first λ
  bool stabilise;             ///< the corrections of this iteration move particles without changing their velocity
  // Smoothed particle hydrodynamics
  float stiffness;            ///< m²/s², c²
  float bulk;                 ///< m²/s, bulk viscosity
  bool measure;               ///< only measure the present state: nothing is corrected
} SimStep;

typedef struct SimWorld SimWorld;

/// A method: how a world gets from one state to the next. Wide kernels and stages are its words.
typedef struct SimMethod {
  const char *name;
  /// One substep of dt > 0; on success the new state stands in `now` and *error is untouched. The bodies stand in their
  /// poses at its end (motion.h); each sweep that changes velocities on a body's behalf is followed by sim_step_collect,
  /// and `pressure` ends negative where a particle is pressed.
  bool (*substep)(SimWorld *world, float dt, SimError *error);
  /// The longest substep that the method follows, s, apart from the CFL condition on the fastest particle.
  double (*longest)(const SimWorld *world);
} SimMethod;

/// The method of a solver, NULL when there is none.
const SimMethod *sim_method(SimSolver solver);

// ---- Stages that methods share (step.c) -----------------------------------------------------------------------------

/// The context of a substep of this length; what only one method reads is left 0.
SimStep sim_step_make(SimWorld *world, float dt);

/// How much of a move by the clamp, from `free` to `to`, becomes velocity, v + share (to − free)/dt.
float sim_step_clamp_share(const SimStep *step, const float v[3], const float free[3], const float to[3]);
/// v* = v + dt a, x* = x + dt v*, clamped; a is gravity and the pushes. x* stands in `second` as axes. Collects by itself.
void sim_step_predict(const SimStep *step);
/// Sort by `second` as axes, build the lists, note which chunks are near what. Timed as the two stages.
bool sim_step_neighbours(SimWorld *world, SimStage sort_stage, SimStage list_stage, double *since, SimError *error);
/// Give the floating bodies what the sweep that has just ended noted; the particles are in `first`.
void sim_step_collect(const SimStep *step);
/// Vorticity confinement (vorticity.c), XSPH and the viscosity of the liquid (diffusion.c), friction at walls
/// (friction.c): positions in `first`, next_velocity changes. Each does nothing where the Def asks for none.
void sim_step_vorticity(const SimStep *step);
void sim_step_viscosity(const SimStep *step);
void sim_step_friction(const SimStep *step);
/// Colours of neighbours mix (diffusion.c).
void sim_step_mix(const SimStep *step);
/// Vorticity, viscosity, friction and mixing with the time they take.
void sim_step_finish(SimWorld *world, const SimStep *step, double *since);
/// Whether next_velocity can be followed; otherwise *error names stage and particle.
bool sim_step_check(SimWorld *world, SimStage stage, SimError *error);
/// The positions in `first` and next_velocity become the state.
void sim_step_commit(SimWorld *world);
/// Add the time since *since to a stage.
void sim_step_lap(SimWorld *world, SimStage stage, double *since);

/// m/s, of the particle that limits the time step.
float sim_cfl_speed(const SimWorld *world);
float sim_largest_speed(const SimWorld *world, float *const velocity[3]);

#endif
