// The slow and right picture of a frame of water, which the style `refraction` is measured against: a ray tracer on exact
// spheres (splashes) and on a smooth mesh (aggregated particles), in double precision.
//
//   Reference *reference = reference_create(frame, &settings);    // frame with SIM_NEED_ANISOTROPY
//   reference_trace(reference, &view, 640, 480, 0, rgb);
//   reference_destroy(reference);
//
// Of the settings it takes the pinned environment (gradient sky, checker floor or none, no sun, hidden container; see
// render/render.h), absorption and refractive index; other skies and floors are drawn as if they were these. Obstacles
// are matt; triangle meshes are left out. All water has the settings' absorption, whatever colour its particles have.
//
// Water touches solids and the floor without a film of air between (field.c); to the container it shows a face.
// Pixels are independent of each other and of the number of threads.
#ifndef LIDO_TESTS_REFERENCE_REFERENCE_H
#define LIDO_TESTS_REFERENCE_REFERENCE_H

#include <stdbool.h>
#include <stdint.h>

#include "render/render.h"

typedef struct Reference Reference;

/// Particles that are not finite are left out. NULL: no memory, the frame lacks the ellipsoids of its aggregated
/// particles, or these are spread over more than 2^28 cubes of 0.75 radii.
/// Nothing of frame or settings is kept.
Reference *reference_create(const SimFrame *frame, const RenderSettings *settings);
void reference_destroy(Reference *reference); ///< NULL is allowed

enum { REFERENCE_DEPTH = 16 }; ///< surfaces on one path, where max_depth is 0

/// Linear light, rows from top to bottom, (height, width, 3), along rays through the middles of the pixels. The eye may be
/// in the water, not in a solid.
void reference_trace(const Reference *reference, const RenderView *view, int32_t width, int32_t height, int max_depth,
                     float *rgb);
/// The same by the paper's chain of max_refractions (1, 2, 4 …) refractions, see optics.h: what tells the error of that
/// model from the error of finding surfaces in screen space.
void reference_trace_chain(const Reference *reference, const RenderView *view, int32_t width, int32_t height,
                           int max_refractions, float *rgb);
/// 1 where the eye sees the water's surface first, (height, width).
void reference_cover(const Reference *reference, const RenderView *view, int32_t width, int32_t height,
                     uint8_t *covered);

/// One ray; `direction` of any length.
void reference_ray(const Reference *reference, const double origin[3], const double direction[3], int max_depth,
                   double rgb[3]);
void reference_ray_chain(const Reference *reference, const double origin[3], const double direction[3],
                         int max_refractions, double rgb[3]);

/// The first surface between water and air on a ray, solid or not behind it: its distance in m and unit normal out of the
/// water. false: none.
bool reference_meet(const Reference *reference, const double origin[3], const double direction[3], double *distance,
                    double normal[3]);
/// Whether a point is in water.
bool reference_inside(const Reference *reference, const double point[3]);

typedef struct ReferenceMesh {
  int32_t vertex_count, triangle_count;
  int32_t open_edges; ///< sides of triangles that no neighbour shares in the opposite sense; 0 in a closed mesh
  double volume;      ///< m³
} ReferenceMesh;
/// The mesh of the aggregated particles.
ReferenceMesh reference_mesh(const Reference *reference);

#endif
