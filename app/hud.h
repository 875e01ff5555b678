// The text over the picture: help, figures, notices. Pure functions that write into the caller's memory: ASCII, lines
// separated by \n, ready for render_text.
#ifndef LIDO_APP_HUD_H
#define LIDO_APP_HUD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// clang-format off
/// What the keys of the window do: X(key, its name, action, what it does). `key` is GLFW's name without GLFW_KEY_,
/// `action` a function window_do_… of the window; keys without a name are second keys for the line above.
/// The help is made from this table and the one below, so it cannot tell anything else than what happens.
#define WINDOW_KEYS(X) \
  X(SPACE,      "Space",       pause,      "pause, go on") \
  X(PERIOD,     ".",           step,       "one frame further") \
  X(KP_DECIMAL, NULL,          step,       NULL) \
  X(R,          "R",           reset,      "start again") \
  X(S,          "S, 1 to 9",   next_style, "next style, style by number") \
  X(L,          "L",           next_layer, "next layer: depth, normal ...") \
  X(C,          "C",           recentre,   "camera back to the start") \
  X(F,          "F",           figures,    "figures") \
  X(P,          "P",           picture,    "save the picture into out/") \
  X(H,          "H, F1",       help,       "this help") \
  X(F1,         NULL,          help,       NULL) \
  X(Q,          "Q, Esc",      quit,       "quit") \
  X(ESCAPE,     NULL,          quit,       NULL)

/// What is not a key press: X(name, what it does).
#define WINDOW_GESTURES(X) \
  X("Left drag",    "look around; on a draggable body: move it") \
  X("... on a glass", "lean it; with Alt: look around") \
  X("Alt + left",   "lean the tank, also with Ctrl + right") \
  X("Middle drag",  "move the view, also with Shift + left") \
  X("Wheel",        "nearer, further") \
  X("Right drag",   "push the water, also with Ctrl + left") \
  X("Shift + right", "pull the water, also with Ctrl + Shift + left") \
  X("Arrow keys",   "lean the tank while they are held")
// clang-format on

/// Write the help. Returns `text`.
char *hud_help(char *text, size_t size);

typedef struct HudFigures {
  const char *style, *layer; ///< layer NULL: the picture
  int32_t particles;
  int64_t frame;
  double time;              ///< s, simulated
  double frames_per_second; ///< drawn; 0: not known yet
  double speed;             ///< simulated seconds a second; 0: paused
  double simulate_ms, draw_ms;
  bool paused;
} HudFigures;
char *hud_figures(const HudFigures *figures, char *text, size_t size);

/// The window's title: scene, frame, and whether it stands still, e.g. "still_pool - frame 12 - paused - Lido".
char *hud_title(const char *scene, int64_t frame, bool paused, char *text, size_t size);

/// Break `message` between words into lines of at most `columns` characters (at least 8); what is longer is cut.
char *hud_wrap(const char *message, int columns, char *text, size_t size);

/// Lines of a text, and characters of its longest line.
void hud_measure(const char *text, int *lines, int *columns);

/// Fill every line with spaces to the length of the longest, with one more on either side, so that the veil behind the
/// text is one block with a margin.
char *hud_block(const char *text, char *block, size_t size);

/// A character of render_text at scale 1, pixels.
enum { HUD_GLYPH_WIDTH = 6, HUD_LINE_HEIGHT = 11 };

/// What a window should have room for: the longest line of the help with its margins; figures, help and a notice.
enum { HUD_COLUMNS = 62, HUD_LINES = 26 };

/// The scale of all text in a window of width × height pixels: twice the monitor's, less where the above would not fit,
/// at least 1.
int hud_scale(float monitor_scale, int width, int height);

#endif
