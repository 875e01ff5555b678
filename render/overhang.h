// The second layer of a height field: water that hangs over air, in a wave that breaks, under a jet, as a sheet with two faces of
// its own above the water below. Beyond Cords 2007, whose surface has one layer.
//
// The sheet's faces are height maps. Where it ends in the air its edge is round; where it is a part of the water behind it (the
// crest that a lip grows from), it goes on a little into that.
#ifndef LIDO_RENDER_OVERHANG_H
#define LIDO_RENDER_OVERHANG_H

#include "render/height_map.h"

typedef struct RenderOverhang {
  GpuProgram program;
  RenderHeightMap top, underside;
  GpuTexture behind; // the picture before it
  float *nodes;      // (3, nodes) m: heights of the water below, of the sheet's top and of its underside; NaN: none there
  uint8_t *rings;    // (nodes)
  size_t capacity;
  int32_t low[2], high[2]; // the nodes around the sheets; low > high when there are none
} RenderOverhang;

/// Find the sheets of a frame whose second layer is known. false: out of memory. Afterwards overhang->nodes begins with the water
/// below them: as in field.height, in the first (field.size[1], field.size[0]).
bool render_overhang_find(RenderOverhang *overhang, const SimFrame *frame, float smoothing, RenderError *error);

/// Over the picture at hand. `in`: what light in and around the water reads; `defines`: those of the scene.
bool render_overhang_draw(RenderOverhang *overhang, RenderPicture *picture, const SimHeightField *field, float smoothing,
                          GpuInputs in, const char *defines, RenderError *error);
void render_overhang_destroy(RenderOverhang *overhang);

/// Is a point in water that hangs over air, or so close to it, at one of the four nodes around? Without the smoothing; false where no
/// second layer is known.
bool render_in_overhang(const SimHeightField *field, const float point[3], float close);

#endif
