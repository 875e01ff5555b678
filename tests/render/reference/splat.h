// Depth maps of particles, the slow twin: every ray is intersected with every ellipsoid or sphere near it.
//
// Based on: Imai, Kanamori & Mitani, Real-Time Screen-Space Liquid Rendering with Complex Refractions, 2016, section 4.2:
// splash particles are spheres, aggregated ones ellipsoids around their smoothed centres; the nearest entry makes the
// front map, the farthest exit the back map; normals are analytic.
#ifndef LIDO_TESTS_RENDER_REFERENCE_SPLAT_H
#define LIDO_TESTS_RENDER_REFERENCE_SPLAT_H

#include "sim/frame.h"
#include "tests/render/reference/pinhole.h"

typedef enum SplatSide { SPLAT_FRONT = 0, SPLAT_BACK = 1 } SplatSide;

/// Depths along the view axis and outward normals in view space; both 0 where there is nothing.
typedef struct SplatMap {
  float *depth;       ///< m, (height, width)
  float *normal;      ///< unit, (height, width, 3)
  const float *limit; ///< m, (height, width): depths beyond which no exit counts, the caller's; NULL: all count
} SplatMap;

SplatMap splat_map_create(const Lens *lens); ///< empty
void splat_map_destroy(SplatMap *map);

/// Add what T maps the unit ball to (SimFrame.ellipsoid, its semi-axes times `scale`) around a centre.
void splat_ellipsoid(const Pinhole *pinhole, SplatSide side, const float centre[3], const float t[6], double scale,
                     SplatMap *map);
/// Add a sphere.
void splat_sphere(const Pinhole *pinhole, SplatSide side, const float centre[3], float radius, SplatMap *map);
/// How ellipsoids are drawn. As in the paper: {1, 0}. The default closes the holes between the discs of disordered water,
/// through which deeper layers show, and puts the surface where it belongs.
typedef struct SplatShape {
  double scale; ///< of the semi-axes
  double lift;  ///< outwards, in particle radii, where smoothing has moved the centre by more than 0.1 to 0.3 radii
} SplatShape;
#define SPLAT_DEFAULT_SHAPE ((SplatShape){1.2, 0.8})

/// Add the frame's near-surface particles of one class. It needs classes, ellipsoids and flags.
void splat_frame(const Pinhole *pinhole, SplatSide side, const SimFrame *frame, SimClass class, SplatShape shape,
                 SplatMap *map);

#endif
