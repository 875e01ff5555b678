// A few lines of text over the picture, in a small bitmap font. Internal to the renderer.
#ifndef LIDO_RENDER_TEXT_H
#define LIDO_RENDER_TEXT_H

#include "render/gpu.h"

typedef struct RenderText {
  GpuProgram program;
  GpuBuffer font, glyphs;
} RenderText;

bool render_text_create(RenderText *text, RenderError *error);
void render_text_destroy(RenderText *text);
void render_text_draw(RenderText *text, Gpu *gpu, const GpuTarget *out, int32_t x, int32_t y, int32_t scale,
                      const char *string);

/// Rows of the glyphs from ' ' (32) to '~' (126), top row first, five pixels a row with the leftmost in bit 4.
#define RENDER_FONT_FIRST 32
#define RENDER_FONT_COUNT 95
#define RENDER_FONT_ROWS 9
extern const uint8_t render_font[RENDER_FONT_COUNT][RENDER_FONT_ROWS];

#endif
