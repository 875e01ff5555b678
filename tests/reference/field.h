// A smooth scalar field whose iso-surface is the surface of the aggregated particles.
//
// Based on: Yu & Turk, Reconstructing Surfaces of Particle-Based Fluids Using Anisotropic Kernels, 2013, Eq. 1–5:
// f(x) = Σ_j V_j |det G_j| P(|G_j (x − x_j)|). G is the inverse of four times the frame's matrix T, so that the kernel
// reaches as far as two spacings where the ellipsoid is a ball, P the cubic spline and V the volume of a cube of the
// spacing: then f is 1 in a lattice.
//
// Unlike in the paper the kernels sit at the particles, not at their smoothed centres, which sink below a free surface,
// but not where a particle has too few neighbours to have one. With smoothed centres the iso value would have to be 0.083,
// the level would stand 0.58 radii too high beside a solid instead of 0.20, and a ball cut from a lattice would be 0.36
// radii too large instead of 0.24; over particles displaced by a tenth of a spacing the level's deviation is the same,
// 0.07 radii.
#ifndef LIDO_TESTS_REFERENCE_FIELD_H
#define LIDO_TESTS_REFERENCE_FIELD_H

#include <stdbool.h>
#include <stdint.h>

#include "tests/reference/environment.h"

/// The value on the water's surface. See FIELD_ISO in field.c for how it was found.
extern const double field_iso;

typedef struct FieldParticle {
  Vec centre;        ///< m
  double inverse[6]; ///< 1/m, G: xx, yy, zz, xy, xz, yz
  double reach;      ///< m, beyond it the kernel is zero
  double weight;     ///< 1, or another where a particle is alone
} FieldParticle;

typedef struct Field {
  int32_t count;
  FieldParticle *particle; ///< (count), sorted by cell
  double radius;           ///< m, of a particle
  double reach;            ///< m, the longest of all
  Vec min, max;            ///< m, around all centres
  // Cells of half a reach.
  double cell;
  int32_t size[3];
  int32_t *start; ///< (cells + 1)
  const Environment *environment;
} Field;

/// From the aggregated particles of a frame that carries ellipsoids. false: no memory, or they are spread so far that it
/// would take too much. `environment` must outlive the field.
bool field_create(Field *field, const SimFrame *frame, const Environment *environment);
void field_destroy(Field *field);

/// The field at a point. Near solids and the floor it is continued, so that the water wets them: see field.c.
double field_value(const Field *field, Vec p);
/// The unit vector in which it falls fastest; (0, 1, 0) deep in solids.
Vec field_normal(const Field *field, Vec p);

#endif
