// The GLFW backend: a window, or a hidden one for `--context glfw`. GLFW 3.3 cannot start without a display, so nothing
// here calls it before the environment names one.
#include "app/context_glfw.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/context.h"

// ---- Errors: GLFW tells them by callback, the last one is the cause of a failed call ------------------------------

static char last_error[256];

static void remember_error(int code, const char *description) {
  (void)code;
  snprintf(last_error, sizeof last_error, "%s", description);
}

// Some messages span lines or end in a full stop, and a message may quote what the driver said: keep the first line.
static const char *cause(void) {
  for (char *c = last_error; *c; c++)
    if (*c == '\n') *c = '\0';
  return last_error[0] ? last_error : "GLFW gives no reason";
}

// ---- Display --------------------------------------------------------------------------------------------------------

static bool is_set(const char *name) {
  const char *value = getenv(name);
  return value && value[0];
}

bool context_glfw_has_display(char *why, size_t size) {
  if (is_set("DISPLAY") || is_set("WAYLAND_DISPLAY")) return true;
  snprintf(why, size, "there is no display (neither DISPLAY nor WAYLAND_DISPLAY is set)");
  return false;
}

// glfwInit, once a display is named. Ends GLFW again on failure.
static bool start_glfw(char *why, size_t size) {
  if (!context_glfw_has_display(why, size)) return false;
  last_error[0] = '\0';
  glfwSetErrorCallback(remember_error);
  if (glfwInit()) return true;
  snprintf(why, size, "the display cannot be used: %s", cause());
  return false;
}

// ---- Window -----------------------------------------------------------------------------------------------------------

static GLFWwindow *try_window(const GlfwWindowDef *def, int creation_api) {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CONTEXT_CREATION_API, creation_api);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
#ifndef NDEBUG
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, GLFW_TRUE);
#endif
  // The renderer draws into framebuffers of its own: the window's needs colour only.
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  glfwWindowHint(GLFW_VISIBLE, def->visible ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  return glfwCreateWindow(def->width, def->height, def->title, NULL, NULL);
}

GLFWwindow *context_glfw_open(const GlfwWindowDef *def, AppError *error) {
  char why[384];
  if (!start_glfw(why, sizeof why)) {
    app_fail(error, APP_FAILED, "no window: %s", why);
    return NULL;
  }
  GLFWwindow *window = try_window(def, GLFW_NATIVE_CONTEXT_API);
  // X servers without GLX still have EGL.
  if (!window) window = try_window(def, GLFW_EGL_CONTEXT_API);
  if (window) {
    glfwMakeContextCurrent(window);
    if (glfwGetCurrentContext() == window) return window;
    glfwDestroyWindow(window);
  }
  app_fail(error, APP_FAILED, "no window with OpenGL 4.5: %s", cause());
  glfwTerminate();
  return NULL;
}

void context_glfw_close(GLFWwindow *window) {
  if (!window) return;
  glfwMakeContextCurrent(NULL);
  glfwDestroyWindow(window);
  glfwTerminate();
}

// ---- The backend ------------------------------------------------------------------------------------------------------

static const GlfwWindowDef hidden = {.title = "Lido", .width = 64, .height = 64};

static bool glfw_available(char *why, size_t size) {
  if (!context_glfw_has_display(why, size)) return false;
  AppError error;
  GLFWwindow *window = context_glfw_open(&hidden, &error);
  if (!window) snprintf(why, size, "%s", error.message);
  context_glfw_close(window);
  return window != NULL;
}

static void *glfw_create(AppError *error) {
  return context_glfw_open(&hidden, error);
}

static void glfw_destroy(void *data) {
  context_glfw_close(data);
}

const ContextBackend context_backend_glfw = {
    .name = "glfw",
    .kind = CONTEXT_GLFW,
    .summary = "a window, or a hidden one; needs a display",
    .available = glfw_available,
    .create = glfw_create,
    .destroy = glfw_destroy,
};
