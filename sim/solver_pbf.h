// Position based fluids: Macklin & Müller, Position Based Fluids, 2013.
//
// A particle's constraint is C = ρ/ρ0 − 1 ≤ 0 (Eq. 1, as an inequality: water resists compression, a free surface is not
// pulled together, so particles there do not clump). One Jacobi iteration is pbf_boundary, pbf_density (λ, Eq. 11) and
// pbf_correct (Δp, Eq. 14, then the hard clamp to the walls, and the velocity that follows from both). Then pbf_viscosity
// (XSPH, Eq. 17).
//
// Damped Jacobi. All particles are corrected at once, and each counts in the constraints of its ~32 neighbours, so the
// corrections add up: with the full λ of Eq. 11 a ripple of 3.4 spacings (kernel of two spacings) is overcorrected 2.9-fold,
// grows, and keeps the water boiling. λ is therefore scaled by ω, chosen so that the worst ripple is corrected 1.44-fold
// (see sim_cubic_make for the estimate): 0.5 for a support of two spacings.
//
// Scales. ε of Eq. 11 has the unit of |∇C|², 1/m²; the artificial pressure k of Eq. 13 that of λ, m². Both are given here
// as shares of what the lattice at rest has, S = Σ|∇C|²: ε = ε_rel S and k = k_rel/S. So one pair of numbers serves every
// particle size.
#ifndef LIDO_SIM_SOLVER_PBF_H
#define LIDO_SIM_SOLVER_PBF_H

#include "sim/boundary.h"
#include "sim/neighbours.h"
#include "sim/particles.h"
#include "sim/reaction.h"
#include "sim/sim.h"

/// What travels through one substep.
typedef struct SimStep {
  int32_t threads;
  float dt, inverse_dt;       ///< s, 1/s
  SimCubic cubic;
  float omega;                ///< ω, damping of the Jacobi iteration
  float relaxation;           ///< 1/m², ε
  float tensile;              ///< m², k
  float viscosity;            ///< XSPH's c
  float gravity[3];           ///< m/s²
  int32_t push_count;
  const SimPush *pushes;
  const SimBoundary *boundary;
  SimParticles *particles;
  SimNeighbours *neighbours;
  float clamp_speed;          ///< m/s, to which the clamp may bring a particle that was slower
  SimReaction *reaction;      ///< NULL where no body floats
} SimStep;

/// v* = v + dt a, x* = x + dt v*, clamped; a is gravity and the pushes.
void sim_pbf_predict(const SimStep *step);
/// The walls' share of the density at the predicted positions.
void sim_pbf_boundary(const SimStep *step);
/// Density, λ and the pair gradients at the predicted positions.
void sim_pbf_density(const SimStep *step);
/// Move the predicted positions by Δp and clamp them; v* += (what was moved)/dt. Returns the longest move, m; NaN if a position is not finite.
double sim_pbf_correct(const SimStep *step);
/// XSPH with pair weights that are the same from both sides, so that momentum is kept.
void sim_pbf_viscosity(const SimStep *step);

#endif
