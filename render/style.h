// The plug for styles: one const struct in the style's file and one row in style_table.c.
//
// A style's state is a plain struct that begins zeroed. It lists programs, textures and targets in the order of the
// passes, and draw runs the passes in that order. style_points.c is the one to copy.
#ifndef LIDO_RENDER_STYLE_H
#define LIDO_RENDER_STYLE_H

#include "render/picture.h"

typedef struct RenderStyle {
  const char *name;
  const char *summary;       // one line: what it is, after whom
  unsigned needs;            // SimNeed bits: what draw reads from the frame beyond what is always there
  unsigned (*needs_more)(const RenderSettings *settings); // SimNeed bits that only some settings need; may be NULL
  bool drawn;                // sky, floor and obstacles are drawn in flat colours as well (drawn.glsl)
  size_t state_size;         // bytes
  const RenderLayer *layers; // intermediates that can be shown and read
  int32_t layer_count;
  bool (*resize)(void *state, const RenderPicture *picture, RenderError *error); // make what depends on the size
  bool (*draw)(void *state, RenderPicture *picture, RenderError *error);         // into picture->target
  int32_t (*figures)(const void *state, RenderFigure *figures, int32_t capacity); // of the last picture; may be NULL
  void (*destroy)(void *state);
} RenderStyle;

extern const RenderStyle *const render_styles[];        // ends with NULL
const RenderStyle *render_style_find(const char *name); // NULL when there is none

#endif
