// What hands do to a window, gathered between two frames: GLFW's callbacks write into a plain struct, the window's loop
// reads it when it may act. Nothing here draws or simulates.
#ifndef LIDO_APP_WINDOW_INPUT_H
#define LIDO_APP_WINDOW_INPUT_H

#include "app/camera.h"
#include "app/grab.h"
#include "app/hud.h"
#include "app/interact.h"

struct GLFWwindow;

typedef enum WindowDrag {
  WINDOW_DRAG_NONE,
  WINDOW_DRAG_ORBIT,
  WINDOW_DRAG_PAN,
  WINDOW_DRAG_WATER,
  WINDOW_DRAG_BODY,
  WINDOW_DRAG_LEAN
} WindowDrag;

typedef struct WindowInput {
  Camera camera;          ///< moved by drags and the wheel
  Interact hand;          ///< in the water
  GrabBodies bodies;      ///< of the frame that is shown: what a hand can grasp. The caller's to set
  Grab grab;              ///< the body in the hand
  SimContainer container; ///< the caller's to set: a glass is leaned by a drag that begins on it
  float lean_keys[2];     ///< −1, 0 or 1: arrow keys held, to the right and away
  float lean_drag[2];     ///< pixels, to the right and upwards: how far the hand has dragged the tank; 0: let go
  int width, height;      ///< pixels of the framebuffer; 0 while minimised
  float scale;            ///< of the monitor's content, 1: a pixel is a dot

  WindowDrag drag;
  int drag_button; ///< which began it, and will end it
  float cursor[2]; ///< pixels

  bool paused, help, figures;          ///< switches
  int steps;                           ///< single steps asked for and not yet taken
  int style;                           ///< asked for by number, −1: none
  int next_style, next_layer;          ///< how often these were pressed
  bool reset, recentre, picture, quit; ///< asked for; the loop clears them
  bool changed;                        ///< the picture is out of date; the loop clears it
} WindowInput;

/// Let the window's callbacks write into `input`, which must outlive it; camera, paused, help … are the caller's to set.
void window_input_connect(struct GLFWwindow *window, WindowInput *input);

/// Read what has no callback: the arrow keys and the framebuffer's size.
void window_input_poll(struct GLFWwindow *window, WindowInput *input);

// The callbacks without GLFW's window, for tests. `key`, `button`, `mods` and `down` as in GLFW.
void window_input_key(WindowInput *input, int key, int mods, bool repeated);
void window_input_button(WindowInput *input, int button, int mods, bool down);
void window_input_cursor(WindowInput *input, float x, float y); ///< pixels
void window_input_wheel(WindowInput *input, float steps);

#endif
