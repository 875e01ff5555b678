// Slow twins of the pressure sweeps (sim/wide/shear.h, sim_wall_answer), over all pairs in double precision.
#ifndef LIDO_TEST_SIM_STRESS_H
#define LIDO_TEST_SIM_STRESS_H

#include "sim/world.h"

/// Gradient and share of what is solid at place i of `four`, (count, 4).
void reference_solid(const SimWorld *world, const float *four, int32_t i, float solid[4]);

/// M of particle i: Σ_j (x_i − x_j) ⊗ V ∇W and −f 1 − N n ⊗ n of what is solid.
void reference_moment(const SimWorld *world, const float *four, int32_t i, double m[3][3]);

/// E = e + e², e = −dev(M)/m, less of it at walls.
void reference_shear(const SimWorld *world, const float *four, int32_t i, double shear[3][3]);

/// The tensor that sim_pbf_inherit and sim_sph_density have left for a particle, out of its four words.
void reference_unpack(const float four[4], double tensor[3][3]);

/// Σ_j T_ij ∇W and what walls with the answer κ add to it; T_ij = λ_i + λ_j and, where given, the tensors.
void reference_move(const SimWorld *world, const float *four, const double *lambda, double (*shear)[3][3], double answer,
                    int32_t i, double move[3]);

#endif
