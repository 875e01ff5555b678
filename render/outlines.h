// Outlines of what a picture shows, as an illustrator draws them: lines of constant width in pixels around everything that
// stands before something else (silhouettes) and along sharp edges (creases).
#ifndef LIDO_RENDER_OUTLINES_H
#define LIDO_RENDER_OUTLINES_H

#include "render/picture.h"

/// What the passes work with; made by render_outlines_resize. Begins zeroed.
typedef struct RenderOutlines {
  GpuProgram tile_program;
  GpuBuffer tiles; // (rows, columns) uint32: 1 where lines may be, else 0
  GpuProgram crack_program, seed_program, row_program, ink_program;
  GpuTexture cracks; // between a pixel and its neighbours; then the nearest seed along the row
  GpuTexture seeds;  // places on lines
  GpuTarget crack_target, seed_target;
} RenderOutlines;

/// What is to be outlined.
typedef struct RenderOutlined {
  const GpuTexture *surface; // GPU_RGBA32F, the picture's size: a is the depth along the view axis (m), 0 for the sky
  bool normals;              // rgb of it is the outward unit normal in world axes, or 0 where that is unknown
} RenderOutlined;

bool render_outlines_resize(RenderOutlines *outlines, const RenderPicture *picture, RenderError *error);
void render_outlines_destroy(RenderOutlines *outlines);

/// Ink over `out`, of the picture's size, whose alpha is kept. Width, ink and the angle of creases are the Frame block's. A
/// silhouette's line lies on what is behind, so that things keep their size; a crease's lies on both sides of it.
bool render_outlines_draw(RenderOutlines *outlines, RenderPicture *picture, RenderOutlined outlined,
                          const GpuTarget *out, RenderError *error);

#endif
