// A few lines of text over the picture: one quad a character, each row of its glyph a few bits.
#include "render/text.h"

#include <stdlib.h>
#include <string.h>

#define ADVANCE 6 // pixels from one character to the next, and from one line to the next, at scale 1
#define LINE_HEIGHT 11
#define MAX_LENGTH 8192

// One character as text.glsl reads it, std430.
typedef struct Glyph {
  float x, y;     // place of the top left corner, pixels from the picture's top left
  uint32_t index; // in the font
  uint32_t unused;
} Glyph;

bool render_text_create(RenderText *text, RenderError *error) {
  uint32_t rows[RENDER_FONT_COUNT * RENDER_FONT_ROWS];
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i)
    rows[i] = render_font[i / RENDER_FONT_ROWS][i % RENDER_FONT_ROWS];
  const GpuProgramDesc desc = {.label = "text", .file = "text.glsl"};
  return gpu_program_prepare(&text->program, &desc, error) &&
         gpu_buffer_write(&text->font, "font", rows, sizeof rows, error);
}

void render_text_destroy(RenderText *text) {
  gpu_program_destroy(&text->program);
  gpu_buffer_destroy(&text->font);
  gpu_buffer_destroy(&text->glyphs);
}

// Place every visible character; returns how many there are. Others than ASCII become '?'.
static int32_t place_glyphs(Glyph *glyphs, int32_t x, int32_t y, int32_t scale, const char *string) {
  int32_t count = 0, column = 0, line = 0;
  for (const char *c = string; *c != '\0' && c - string < MAX_LENGTH; ++c) {
    if (*c == '\n') {
      column = 0;
      ++line;
      continue;
    }
    const int code = (unsigned char)*c;
    const bool known = code >= RENDER_FONT_FIRST && code < RENDER_FONT_FIRST + RENDER_FONT_COUNT;
    const float px = (float)x + (float)(column++ * ADVANCE * scale),
                py = (float)y + (float)(line * LINE_HEIGHT * scale);
    glyphs[count++] = (Glyph){px, py, (uint32_t)((known ? code : '?') - RENDER_FONT_FIRST), 0};
  }
  return count;
}

void render_text_draw(RenderText *text, Gpu *gpu, const GpuTarget *out, int32_t x, int32_t y, int32_t scale,
                      const char *string) {
  const size_t length = strnlen(string, MAX_LENGTH);
  if (length == 0 || scale < 1 || scale > 64) return;
  Glyph *glyphs = malloc(length * sizeof *glyphs);
  if (glyphs == NULL) return;
  const int32_t count = place_glyphs(glyphs, x, y, scale, string);
  const float params[4] = {(float)out->width, (float)out->height, (float)scale};
  if (count > 0 && gpu_buffer_write(&text->glyphs, "glyphs", glyphs, (size_t)count * sizeof *glyphs, NULL)) {
    gpu_draw(gpu, &(GpuDraw){
                      .program = &text->program,
                      .target = out,
                      .vertices = 6 * count,
                      .blend = GPU_BLEND_OVER,
                      .in = {.storage = {&text->glyphs, &text->font}, .params = params, .params_size = sizeof params},
                  });
  }
  free(glyphs);
}
