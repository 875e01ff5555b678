// The water's iso-surface, the slow twin: every particle is asked for every point, in double precision.
//
// Based on: Xiao, Zhang & Yang, Real-Time High-Quality Surface Rendering for Large Scale Particle-based Fluids, 2017,
// section 3.2 (the field, Eq. 1), section 3.3 (normals, Eqs. 2 to 6) and section 4 (mixed colours).
//
// Lengths are metres, colours linear light. In a box water goes on as its mirror image behind the side walls and the
// floor: here the particles near them are mirrored. That is one image for each wall, edge and corner, so that a box must be
// wider than twice the kernels reach. A round container is not known here.
#ifndef LIDO_TESTS_RENDER_REFERENCE_ISO_H
#define LIDO_TESTS_RENDER_REFERENCE_ISO_H

#include "render/render.h"

typedef struct IsoWater {
  RenderRaycast settings;
  double support, reach; ///< m, of the field's kernel and of the normals' ones
  double spacing;        ///< m, of particles at rest
  int32_t count;         ///< particles and their mirror images
  double *sphere;        ///< m, (count, 4): centre, radius
  double *colour;        ///< (count, 3)
} IsoWater;

IsoWater iso_water_create(const SimFrame *frame, const RenderRaycast *settings);
void iso_water_destroy(IsoWater *water);

/// The field (Eq. 1): the sum of (2 r_j)³ W(|p − p_j|), which is about 1 in water at rest.
double iso_field(const IsoWater *water, const double p[3]);

/// The first crossing of the iso-value on origin + t direction between two t, by steps of a fortieth of a spacing and
/// bisection. Positive: the ray comes into the water there; negative: out of it; 0: there is none.
double iso_crossing(const IsoWater *water, const double origin[3], const double direction[3], double from, double to);

/// Outward unit normals at a point. The gradient of the spiky kernel's sum (Eq. 2); false: it is zero.
bool iso_gradient_normal(const IsoWater *water, const double p[3], double normal[3]);
/// The direction in which the particles vary least (Eqs. 3, 4), on the gradient's side; false: no direction is the least.
bool iso_pca_normal(const IsoWater *water, const double p[3], double normal[3]);
/// What the settings ask for: one of the above or both blended (Eqs. 5, 6). Where no direction is the least, the gradient
/// alone, as the paper wants it.
bool iso_normal(const IsoWater *water, const double p[3], double normal[3]);

/// Colours of the particles mixed in the field's weights; black where there are none.
void iso_colour(const IsoWater *water, const double p[3], double colour[3]);

#endif
