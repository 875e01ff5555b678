// The water of a frame as one body that rays enter and leave: exact spheres for splashes, a mesh for the aggregated
// particles, held by Embree. Where bodies overlap they are one, and a crossing from water into water is no surface.
#ifndef LIDO_TESTS_REFERENCE_WATER_H
#define LIDO_TESTS_REFERENCE_WATER_H

#include "tests/reference/surface.h"

enum { WATER_MAX_OVERLAP = 32 }; ///< spheres around one point; more are forgotten

/// What a point is inside of.
typedef struct Medium {
  bool mesh;
  int count;
  uint32_t sphere[WATER_MAX_OVERLAP];
} Medium;

/// A ray with a unit direction, what its origin is inside of, and the surface that it starts on: it does not meet that
/// one again where it starts.
typedef struct WaterRay {
  Vec origin, direction;
  Medium medium;
  uint32_t geometry, primitive; ///< WATER_NOWHERE when it starts in the open
} WaterRay;
#define WATER_NOWHERE UINT32_MAX

typedef struct WaterHit {
  double t; ///< m
  Vec point;
  Vec normal, flat; ///< unit, outwards: smooth, and that of the geometry
  Medium behind;    ///< what the ray is inside of behind the surface
  uint32_t geometry, primitive;
} WaterHit;

typedef struct Water Water;

/// NULL: no memory, or the frame lacks the ellipsoids of its aggregated particles.
Water *water_create(const SimFrame *frame, const Environment *environment);
void water_destroy(Water *water);

bool water_wet(const Medium *medium);
/// What a point is inside of.
Medium water_medium_at(const Water *water, Vec point);
/// The first surface between water and air at t < limit. ray->medium becomes that just before the surface; false: none.
bool water_meet(const Water *water, WaterRay *ray, double limit, WaterHit *hit);

const Surface *water_surface(const Water *water);

#endif
