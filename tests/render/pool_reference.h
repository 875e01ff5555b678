// What an eye over level water sees of obstacles in it, computed in double precision ray by ray: the truth of Snell's law,
// or what is left of it when all rays start from one virtual eye (Cords 2007, section 2.1).
#ifndef LIDO_TESTS_RENDER_POOL_REFERENCE_H
#define LIDO_TESTS_RENDER_POOL_REFERENCE_H

#include "render/water_objects.h"
#include "tests/render/harness.h"

/// A frame's obstacles in its container, full of water up to `level`.
typedef struct Pool {
  const SimFrame *frame;
  double level; // m
  double index; // of the water
} Pool;

typedef enum PoolEyes {
  POOL_TRACED = 0, ///< every ray bent where it meets the water
  POOL_SCALED,     ///< from the object's refracted eye, scaled around a so that b is where it is seen (Figure 3)
  POOL_ONE         ///< from the object's refracted eye
} PoolEyes;

/// What is in a pixel.
enum { POOL_OTHER = 0, POOL_THROUGH_WATER, POOL_DIRECT };

/// (height, width). `object`: whose eye it is; NULL when traced.
void pool_look(const Pool *pool, const RenderView *view, int32_t width, int32_t height, PoolEyes eyes,
               const RenderWaterObject *object, uint8_t *seen);

/// A side of a pixel between something and nothing.
typedef struct PoolSide {
  float x, y;   // pixels, its middle
  bool upright; // between two pixels in a row
  bool through; // of what is seen through the water
} PoolSide;

/// The border of bodies against all else, but for that of the picture. The waterline on a body is none.
typedef struct PoolOutline {
  PoolSide *side; // (count)
  int32_t count;
} PoolOutline;
PoolOutline pool_outline(const uint8_t *seen, int32_t width, int32_t height);
void pool_outline_destroy(PoolOutline *outline);

/// How far two outlines are from each other, pixels: over the sides of what is seen through the water in both, the distance to
/// the nearest side of the other. (To any, so that a strip beside the waterline that is thinner than a pixel and only in one of
/// them counts with its width, not with its length.)
typedef struct PoolError {
  double largest, most; // most: that of 95 % of the sides
} PoolError;
PoolError pool_compare(const PoolOutline *a, const PoolOutline *b);

#endif
