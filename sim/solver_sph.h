// Smoothed particle hydrodynamics: Müller, Charypar, Gross, Particle-Based Fluid Simulation for Interactive Applications, 2003,
// with an equation of state after Monaghan, Simulating Free Surface Flows with SPH, 1994. Here ρ is a share of ρ0.
//
//   ρ_i = Σ_j V W + f(x_i)                                       density, f the walls' share (boundary.h)
//   P_i = max(0, c² (ρ_i − 1) + β c d dρ_i/dt)/ρ_i²              pressure p/(ρ0 ρ²), where ρ_i > 1
//   dv_i/dt = g − Σ_j V (P_i + P_j) ∇W − κ P_i ∇f                equal and opposite between particles: momentum is kept
//
// Without the middle term of P, the forces are the gradient of an energy of the positions, so only rounding, viscosity and
// the bounds can change it. The cubic spline serves density and gradient alike for that reason.
//
// A substep: v* = v + dt g, x = x + dt v* (predict, clamped), then lists, density and forces at the new x. This is the symplectic
// Euler method with the drift first: it needs no prediction, and lists and pressures are those of where particles are.
//
// Pressure does not pull: water that is stretched falls apart instead of clumping (tensile instability).
//
// Walls. A wall answers with κ = 1.4 times the particle's pressure, for the reasons that solver_pbf.h gives. A pool of 2400
// particles at rest for 60 √(d/g) keeps a kinetic energy of 3.0e-5 gH with κ = 1, the gradient of the walls' share, and 1.6e-5
// with 1.4; κ = 2, the particle's pressure mirrored, keeps it stirring with 3e-3 gH and raises its energy to 1.010 E0.
//
// Speed of sound. c² = 100 times the total head, the largest ½v² + gz of all particles above the lowest one, plus what pushes and
// surface tension add: by Bernoulli no steady pressure is larger than ρ0 times that head, so the density is at most 1 %
// off. It follows from the motion alone, not from particle size. It may rise by 1 % and fall by 0.2 % a substep, slower than
// sound crosses the water, so that its change does little work on what is compressed; only where less than half of it is wanted it
// jumps there, which adds at most a share of 1/200 of the new head.
//
// β c d dρ/dt is a bulk viscosity: it damps sound, which real water loses in no time, and leaves flow without compression alone.
// β = ½ lets a column's sound die in about its own period. Shear is damped by an artificial viscosity ν = α c d/10 (Monaghan,
// Smoothed Particle Hydrodynamics, 1992) with α = 0.02, in the sweep that the liquid's own viscosity takes.
//
// Substep: sound goes 0.4 spacings. Twice that is still stable; a pool at rest then keeps ten times the energy.
#ifndef LIDO_SIM_SOLVER_SPH_H
#define LIDO_SIM_SOLVER_SPH_H

#include "sim/solver.h"

extern const SimMethod sim_method_sph;

#endif
