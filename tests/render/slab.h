// What the eye sees of a box of water that stands on the checker, or hangs over nothing, computed: all rays that leave a
// surface are followed.
//
// Snell's law, Schlick's reflectance with the cosine on the air's side, Beer–Lambert (REFERENCE.md, section 6). A box is
// convex, so that a ray outside of it never comes back to the water; the floor sends back its colour and ends a ray.
#ifndef LIDO_TESTS_RENDER_SLAB_H
#define LIDO_TESTS_RENDER_SLAB_H

#include "render/render.h"
#include "tests/render/harness.h"

/// Surfaces on a path: the floor, and the faces as 2 · axis + (1 for the upper one).
enum { SLAB_TOP = 3, SLAB_FLOOR = 6 };

/// min[1] is the level of the floor.
typedef struct Slab {
  double min[3], max[3];          // m
  const RenderSettings *settings; // pinned
} Slab;

typedef struct SlabPixel {
  double light[3];
  int way; // which surfaces the brightest path met, surface + 1 as a digit to base 8 for each, the first one last; 0: none
  double margin; // m, how near that path came to the upright sides, other than by going through one
} SlabPixel;

/// `ray` starts in the water or in the air, above the floor.
SlabPixel slab_look(const Slab *slab, const Ray *ray);

#endif
