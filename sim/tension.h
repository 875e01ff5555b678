// Surface tension: Akinci, Akinci, Teschner, Versatile Surface Tension and Adhesion for SPH Fluids, 2013, for every method.
//
// Two forces between neighbours, equal and opposite, so that momentum is kept:
//
//   cohesion    dv_i/dt = −γ  Σ_j K_ij m C(r) r̂                  (Eq. 1 and 2)
//   curvature   dv_i/dt = −γ' Σ_j K_ij V W(r) (n_i − n_j)        (Eq. 4), n_i = h Σ_j V ∇W/ρ_i   (Eq. 3)
//
// with K_ij = 2ρ0/(ρ_i + ρ_j) (Eq. 5). Cohesion holds single particles and threads together, curvature makes surfaces smooth
// and small. Deviations from the paper: the paper counts all n_j inside the support alike, which lets a force jump whenever a
// neighbour comes into reach, and gives both forces the same γ, though their units differ. Here W weighs the
// neighbours, and each force has a coefficient with its own unit, as a share of the tension σ in N/m:
//
// - Cohesion. The surface energy of a continuum of particles that attract each other with γ m² C(r) is
//   σ = π/8 ρ0² γ ∫ r⁴ C dr = 21/7040 γ ρ0² h² (Kirkwood & Buff, 1949). Water of particles has its nearest neighbours where C is
//   largest, and K_ij is largest at the surface; by how fast drops oscillate, σ comes out about 4.4 times as large.
// - Curvature. For a smooth field n this is −γ' a h² ∇²n, a h² = 3h²/80 being half of W's variance along an axis (n = h∇c, and
//   h|∇c| ≈ 1 in the outermost layer). It is the gradient of γ' a h³ ∇²c, which on a surface of radius R is larger
//   by γ' a h² 2/R than on a flat one: a tension σ = ρ0 γ' a h². Measured about 1.0 times that.
//
// The shares 0.125 and 0.27 make 0.125 · 4.4 + 0.27 ≈ 0.8, and the packing of the particles adds to the stiffness. More
// curvature for less cohesion flings single particles off corners; more cohesion makes the surface stiff like a crystal's: drops
// then no longer oscillate.
//
// Limits, measured: drops that are stretched by a quarter oscillate with 0.89 to 1.05 of Lamb's frequency (radius of 8 and 11
// spacings, both methods). Small waves run faster, because particles at rest resist shear like a crystal: at a tenth of the length
// 1.01 at 8 spacings, 1.1 at 11 and 1.2 at 14. Walls count like water in n and attract no one, so water does not wet them.
#ifndef LIDO_SIM_TENSION_H
#define LIDO_SIM_TENSION_H

#include "sim/solver.h"

/// The longest substep that capillary waves allow, s; infinite without surface tension.
double sim_tension_longest(const SimWorld *world);

/// Change next_velocity by a substep of surface tension at the positions in `place`, `first` or `second` (x, y, z and anything);
/// if it is `second`, also move `first` along.
void sim_step_tension(const SimStep *step, const SimWorldDef *def, const float *place);

#endif
