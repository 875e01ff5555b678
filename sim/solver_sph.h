// Smoothed particle hydrodynamics: Müller, Charypar, Gross, Particle-Based Fluid Simulation for Interactive Applications, 2003,
// with an equation of state after Monaghan, Simulating Free Surface Flows with SPH, 1994. Here ρ is a share of ρ0.
//
//   ρ_i = Σ_j V W + f(x_i)                                       density, f the walls' share (boundary.h)
//   P_i = max(0, c² (ρ_i − 1) + β c d dρ_i/dt)/ρ_i²              pressure p/(ρ0 ρ²), where ρ_i > 1
//   dv_i/dt = g − Σ_j V (P_i (1 + E_i) + P_j (1 + E_j)) ∇W       equal and opposite between particles: momentum is kept
//                                                                E: what keeps water from bearing shear (wide/shear.h)
//
// Without the middle term of P and without E, the forces are the gradient of an energy of the positions, so only rounding,
// viscosity and the bounds can change it. The cubic spline serves density and gradient alike for that reason. E does no work
// to speak of: it is bounded, and small in water that moves calmly.
//
// A substep: v* = v + dt g, x = x + dt v* (predict, clamped), then lists, density and forces at the new x. This is the symplectic
// Euler method with the drift first: it needs no prediction, and lists and pressures are those of where particles are.
//
// Pressure does not pull: water that is stretched falls apart instead of clumping (tensile instability).
//
// Walls answer as solver_pbf.h says. A pool of 2000 particles at rest for 5 s keeps a kinetic energy of 2e-5 gH.
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
