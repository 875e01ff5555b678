// Slow twins: each says in the plainest way what a fast kernel of the simulator must compute.
#ifndef LIDO_TEST_SIM_REFERENCE_H
#define LIDO_TEST_SIM_REFERENCE_H

#include <stdbool.h>
#include <stdint.h>

/// Eigenvalues (largest first) and eigenvectors of (xx, yy, zz, xy, xz, yz) by Jacobi rotations.
void reference_eigen(const float matrix[6], double value[3], double vector[3][3]);

/// Share of the rest density at particle i from all others: cubic spline with support 2 spacings, calibrated.
double reference_density(const float *position, int32_t count, int32_t i, double spacing);

/// Yu & Turk 2013, Eq. 6, 9–11, 15 in the volume-preserving form, over all pairs; the number of neighbours.
int reference_anisotropy(const float *position, int32_t count, int32_t i, double spacing, double centre[3],
                         double ellipsoid[6]);

/// Cords & Staadt 2007, Eq. 5 and 6, over all particles.
double reference_potential(const float *position, int32_t count, const double point[3], double radius);

/// Index of the first sphere (of one radius) that the ray hits, −1 for none; direction is unit.
int32_t reference_first_hit(const float *position, int32_t count, const double origin[3], const double direction[3],
                            double radius);

#endif
