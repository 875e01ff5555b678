// Where OpenGL comes from. The renderer never makes a context; the program does, through one of these backends.
//
// A backend is one const struct and one row of the table in context.c:
//   egl      without a window: the surfaceless platform, then each device until one works
//   osmesa   without a window or a driver: Mesa's software rasteriser as a library
//   glfw     a window, or a hidden one
#ifndef LIDO_APP_CONTEXT_H
#define LIDO_APP_CONTEXT_H

#include "app/app.h"

typedef enum ContextKind { CONTEXT_AUTO, CONTEXT_GLFW, CONTEXT_EGL, CONTEXT_OSMESA } ContextKind;

typedef struct ContextBackend {
  const char *name; ///< as in --context
  ContextKind kind;
  const char *summary; ///< one line for `lido list`
  /// Does it work on this machine? Otherwise `why` says what is missing, in one line. Leaves no context behind.
  bool (*available)(char *why, size_t size);
  /// Make an OpenGL 4.5 core context without a visible window, current on this thread. NULL and *error on failure.
  void *(*create)(AppError *error);
  void (*destroy)(void *data);
} ContextBackend;

int context_backend_count(void);
const ContextBackend *context_backend(int index);                ///< in the order of preference for headless work
const ContextBackend *context_backend_of_kind(ContextKind kind); ///< NULL: not built in

typedef struct Context Context;

/// A context without a visible window, current on return. CONTEXT_AUTO: EGL, then OSMesa, never a window.
/// One at a time: destroy it before the next one is made. NULL and *error on failure.
Context *context_create_headless(ContextKind kind, AppError *error);
void context_destroy(Context *context); ///< NULL is allowed

#endif
