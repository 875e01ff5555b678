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
// Shear. A liquid at rest has the same pressure in all directions. Particles have not: where the neighbours lie unevenly, what
// λ_i ∇W adds up to has a deviatoric part, the water answers a slow shear like a weak solid, and where the shear grows it yields
// like one. Waves of a spacing or two then swing too fast (a standing wave in 16 layers by 7 %) and lose a quarter of their
// height in half a period. So the pressure that a substep starts from, nearly all of it in water that moves slowly, is
// given with a tensor λ (1 + E) that takes that part away (wide/shear.h); the iterations after it, which only find the
// difference, do without. That wave then keeps time within 3 %, and loses 15 to 20 %;
// larger ones keep time within 1 %.
//
// Damped Jacobi. All particles are corrected at once, and each counts in the constraints of its ~32 neighbours, so the
// corrections add up: with the full λ of Eq. 11 a ripple of 3.4 spacings (kernel of two spacings) is overcorrected 2.9-fold,
// grows, and keeps the water boiling. λ is therefore scaled by ω, chosen so that the worst ripple is corrected 1.85-fold
// (see sim_cubic_make for the estimate): 0.64 for a support of two spacings.
//
// Chebyshev. From the second iteration on, a change of Σλ is ω_k times what Jacobi would make it and ω_k − 1 times the change
// before it (Golub & Varga, Chebyshev semi-iterative methods, 1961; Wang, A Chebyshev Semi-Iterative Approach for
// Accelerating Projective and Position-based Dynamics, 2015), with ω_k for a spectrum of radius 0.7. It costs nothing and
// leaves 0.6 of the density error in a dam break; a radius of 0.9 leaves half, but a pool no longer comes to rest. It
// starts anew where the lists have been renewed.
//
// Scales. ε of Eq. 11 has the unit of |∇C|², 1/m²; the artificial pressure k of Eq. 13 that of λ, m². Both are given here
// as shares of what the lattice at rest has, S = Σ|∇C|²: ε = ε_rel S and k = k_rel/S. So one pair of numbers serves every
// particle size.
//
// Walls. A wall has no λ of its own. Mirrored, the water would go on behind it with the particle's own pressure, and what the
// particle's neighbours leave undone there has two parts.
// - Across the wall: κ λ_i ∇f, with f what the wall adds to C_i. κ = 1 is the gradient of the constraints, but leaves the layer
//   at a wall short of half the wall's pressure: its neighbours press it on with 2 λ, the wall answers with λ. It sticks.
//   κ = 2 is the mirror image, and keeps a narrow pool stirring, because the mirrored particles do not move. Of 1.4 to
//   2, 1.7 loses least of a wave and keeps a pool as calm as any. A wider support sees less of the layer's own: κ − 1 falls with its third power.
// - Along the wall: neighbours give a particle only 1 − f of the pressure's gradient, so the layer runs ahead of the water beside
//   it. What they give along the wall is divided by 1 − f. (It is as if the particle's mass were less by f in these
//   directions; the momentum that is missing is the wall's.) Walls that face each other are left out: see sim_wall_answer.
#ifndef LIDO_SIM_SOLVER_PBF_H
#define LIDO_SIM_SOLVER_PBF_H

#include "sim/solver.h"

extern const SimMethod sim_method_pbf;

#endif
