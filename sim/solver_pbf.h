// Position based fluids: Macklin & Müller, Position Based Fluids, 2013.
//
// A particle's constraint is C = ρ/ρ0 − 1 ≤ 0 (Eq. 1, as an inequality: water resists compression, a free surface is not
// pulled together, so particles there do not clump). One Jacobi iteration is two sweeps: pbf_density (λ, Eq. 11) and
// pbf_correct (Δp, Eq. 14, then the hard clamp to the walls, and the velocity that follows from both).
//
// Projected. What the iterations of a substep add up to, Σλ, is a pressure (times −dt²), and pressure cannot pull. It is
// that sum which is kept from becoming positive, not each iteration's λ: an iteration may take back what an earlier one
// did too much. (Clamping C ≥ 0 in each iteration instead can only ever push; what it overshoots stays in the water as
// heat, and a pool never comes to rest.) This is the projected Jacobi method for the complementarity of density and
// pressure.
//
// Warm start. In the next substep the pressure is nearly the same. So λ starts from Σλ of the last substep, scaled by dt²,
// and the iterations only have to find the difference: the weight of a deep pool need not be built up from nothing, layer
// by layer, in every substep. Limits: a new particle starts from 0; a particle that leaves the water has its pressure
// taken back by the first iteration.
//
// Motion and position apart. A pressure that is carried on and also integrates what is left of the density error would be a
// controller with nothing but an integral term on a double integrator: every smooth mode that the iterations do not
// resolve grows. So the iterations work against new compression only: C_i at the end may be as large as it was at the
// start of the substep (pbf_inherit), which makes Σλ the pressure that keeps the flow free of divergence. What compression is
// left is removed by the last iteration of a substep, which moves particles but leaves their velocities alone, so that
// no error of density ever turns into motion (the idea of Macklin et al., Unified Particle Physics for Real-Time
// Applications, 2014, section 4.4; Bender & Koschier, Divergence-Free Smoothed Particle Hydrodynamics, 2015, likewise solve
// for density and divergence apart). A pool at rest is then 10 to 100 times calmer than with one kind of iteration.
//
// Damped Jacobi. All particles are corrected at once, and each counts in the constraints of its ~32 neighbours, so the
// corrections add up: with the full λ of Eq. 11 a ripple of 3.4 spacings (kernel of two spacings) is overcorrected 2.9-fold,
// grows, and keeps the water boiling. λ is therefore scaled by ω, chosen so that the worst ripple is corrected 1.85-fold
// (see sim_cubic_make for the estimate): 0.64 for a support of two spacings.
//
// Scales. ε of Eq. 11 has the unit of |∇C|², 1/m²; the artificial pressure k of Eq. 13 that of λ, m². Both are given here
// as shares of what the lattice at rest has, S = Σ|∇C|²: ε = ε_rel S and k = k_rel/S. So one pair of numbers serves every
// particle size.
//
// Walls. A wall has no λ of its own; its term is κ λ_i ∇f with f what the wall adds to C_i. κ = 1 is the gradient of the
// constraints, but leaves the layer at a wall short of half the wall's pressure: its neighbours press it on with 2 λ, the wall
// answers with λ. It sticks: in a falling column (Martin & Moyce, n² = 2, τ = 2.7) the layer at the wall sinks with
// 0.16 m/s where the water 8 spacings away sinks with 0.70. κ = 2, the particle's own pressure mirrored, balances that, but
// along the wall the layer misses the support of the water that is not there, and runs ahead, 1.13 against 0.53 m/s; a pool
// then creeps round and round. At κ = 1.4 both errors nearly cancel (0.39 against 0.60 m/s), and a pool stays at rest. A
// wider support sees less of the layer's own: κ − 1 falls with its third power, which keeps a pool as calm.
#ifndef LIDO_SIM_SOLVER_PBF_H
#define LIDO_SIM_SOLVER_PBF_H

#include "sim/solver.h"

extern const SimMethod sim_method_pbf;

#endif
