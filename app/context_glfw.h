// OpenGL in a window of GLFW: what the visible window and `--context glfw` share.
#ifndef LIDO_APP_CONTEXT_GLFW_H
#define LIDO_APP_CONTEXT_GLFW_H

#include "app/app.h"

struct GLFWwindow;

typedef struct GlfwWindowDef {
  const char *title;
  int width, height; ///< screen units; the framebuffer may have more pixels
  bool visible;
} GlfwWindowDef;

/// Is there a display to open a window on? GLFW is not touched. Otherwise `why` says what is missing, in one line.
bool context_glfw_has_display(char *why, size_t size);

/// Open a window with an OpenGL 4.5 core context, current on return; with debug output in builds with assertions.
/// NULL and *error (APP_FAILED) without a display or without OpenGL 4.5. One at a time.
struct GLFWwindow *context_glfw_open(const GlfwWindowDef *def, AppError *error);
void context_glfw_close(struct GLFWwindow *window); ///< NULL is allowed

#endif
