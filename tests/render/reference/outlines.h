// Outlines of a map of depths, the slow twin: every pixel is asked for every place on a line, in double precision.
//
// What is decided is what render/shaders/outline_cracks.glsl and outline_seeds.glsl say. Rows are counted from the bottom.
#ifndef LIDO_TESTS_RENDER_REFERENCE_OUTLINES_H
#define LIDO_TESTS_RENDER_REFERENCE_OUTLINES_H

#include "tests/render/reference/pinhole.h"

typedef struct OutlineShape {
  double width;         ///< pixels
  double crease_cosine; ///< between the normals on both sides of a crease
} OutlineShape;

/// How much of every pixel is inked, (height, width), to be freed. `depth`: along the view axis, m, 0: the sky.
double *outlines_drawn(const Lens *lens, const float *depth, OutlineShape shape);

#endif
