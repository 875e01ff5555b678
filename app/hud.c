#include "app/hud.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

// Append to a text of `size` bytes; what does not fit is cut.
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
static void
add(char *text, size_t size, const char *format, ...) {
  size_t used = strlen(text);
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text + used, size - used, format, arguments);
  va_end(arguments);
}

char *hud_help(char *text, size_t size) {
  static const char *const lines[][2] = {
#define HUD_GESTURE(name, does) {name, does},
#define HUD_KEY(key, name, action, does) {name, does},
      WINDOW_GESTURES(HUD_GESTURE) WINDOW_KEYS(HUD_KEY)
#undef HUD_GESTURE
#undef HUD_KEY
  };
  text[0] = '\0';
  for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++)
    if (lines[i][0]) add(text, size, "%s%-14s %s", text[0] ? "\n" : "", lines[i][0], lines[i][1]);
  return text;
}

char *hud_figures(const HudFigures *figures, char *text, size_t size) {
  text[0] = '\0';
  add(text, size, "style      %s", figures->style);
  if (figures->layer) add(text, size, " / %s", figures->layer);
  add(text, size, "\nparticles  %d", figures->particles);
  add(text, size, "\nframe      %lld, %.2f s", (long long)figures->frame, figures->time);
  if (figures->paused) add(text, size, ", paused");
  add(text, size, "\nsimulate   %.1f ms", figures->simulate_ms);
  if (figures->speed > 0) add(text, size, ", %.2f x real time", figures->speed);
  add(text, size, "\ndraw       %.1f ms", figures->draw_ms);
  if (figures->frames_per_second > 0) add(text, size, ", %.1f pictures/s", figures->frames_per_second);
  return text;
}

char *hud_title(const char *scene, int64_t frame, bool paused, char *text, size_t size) {
  snprintf(text, size, "%s - frame %lld%s - Lido", scene, (long long)frame, paused ? " - paused" : "");
  return text;
}

char *hud_wrap(const char *message, int columns, char *text, size_t size) {
  size_t limit = columns < 8 ? 8 : (size_t)columns, used = 0, line = 0;
  while (*message && used + 1 < size) {
    size_t word = strcspn(message, " ");
    if (line > 0 && line + 1 + word > limit) {
      text[used++] = '\n';
      line = 0;
    } else if (line > 0) {
      text[used++] = ' ';
      line++;
    }
    // A word longer than a line is broken where the line ends.
    size_t part = word < limit ? word : limit;
    for (size_t i = 0; i < part && used + 1 < size; i++, line++) text[used++] = message[i];
    message += part;
    while (*message == ' ') message++;
  }
  text[used] = '\0';
  return text;
}

void hud_measure(const char *text, int *lines, int *columns) {
  int column = 0;
  *lines = text[0] ? 1 : 0;
  *columns = 0;
  for (; *text; text++) {
    column = *text == '\n' ? 0 : column + 1;
    if (*text == '\n') ++*lines;
    if (column > *columns) *columns = column;
  }
}

static void append(char *text, size_t size, size_t *used, char character, int count) {
  for (; count > 0 && *used + 1 < size; count--) text[(*used)++] = character;
  text[*used] = '\0';
}

char *hud_block(const char *text, char *block, size_t size) {
  int lines = 0, columns = 0;
  size_t used = 0;
  hud_measure(text, &lines, &columns);
  block[0] = '\0';
  for (int i = 0; i < lines; i++) {
    int length = (int)strcspn(text, "\n");
    if (i > 0) append(block, size, &used, '\n', 1);
    append(block, size, &used, ' ', 1);
    for (int k = 0; k < length; k++) append(block, size, &used, text[k], 1);
    append(block, size, &used, ' ', columns - length + 1);
    text += length + 1;
  }
  return block;
}

int hud_scale(float monitor_scale, int width, int height) {
  int scale = (int)fminf(fmaxf(roundf(2 * monitor_scale), 1), 16);
  int fits_x = width / (HUD_COLUMNS * HUD_GLYPH_WIDTH), fits_y = height / (HUD_LINES * HUD_LINE_HEIGHT);
  int fits = fits_x < fits_y ? fits_x : fits_y;
  if (scale > fits) scale = fits > 1 ? fits : 1;
  return scale;
}
