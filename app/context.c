// The table of context backends and the choice among them.
#include "app/context.h"

#include <stdio.h>
#include <stdlib.h>

extern const ContextBackend context_backend_egl;
extern const ContextBackend context_backend_osmesa;
extern const ContextBackend context_backend_glfw;

// In the order in which CONTEXT_AUTO tries them; it leaves out GLFW, which needs a display.
static const ContextBackend *const backends[] = {
    &context_backend_egl,
    &context_backend_osmesa,
    &context_backend_glfw,
};

struct Context {
  const ContextBackend *backend;
  void *data;
};

int context_backend_count(void) {
  return (int)(sizeof backends / sizeof backends[0]);
}

const ContextBackend *context_backend(int index) {
  return index >= 0 && index < context_backend_count() ? backends[index] : NULL;
}

const ContextBackend *context_backend_of_kind(ContextKind kind) {
  for (int i = 0; i < context_backend_count(); ++i) {
    if (backends[i]->kind == kind) return backends[i];
  }
  return NULL;
}

static Context *context_create_with(const ContextBackend *backend, AppError *error) {
  Context *context = malloc(sizeof *context);
  if (context == NULL) {
    app_fail(error, APP_FAILED, "out of memory for an OpenGL context");
    return NULL;
  }
  *context = (Context){backend, backend->create(error)};
  if (context->data == NULL) {
    free(context);
    return NULL;
  }
  return context;
}

static Context *context_create_auto(AppError *error) {
  // Every backend's complaint is kept, so that the message tells what was tried.
  char tried[768] = "";
  size_t length = 0;
  for (int i = 0; i < context_backend_count(); ++i) {
    if (backends[i]->kind == CONTEXT_GLFW) continue;
    AppError why;
    Context *context = context_create_with(backends[i], &why);
    if (context != NULL) return context;
    const int written = snprintf(tried + length, sizeof tried - length, "%s%s", length > 0 ? "; " : "", why.message);
    if (written > 0 && length + (size_t)written < sizeof tried) length += (size_t)written;
  }
  app_fail(error, APP_FAILED, "no OpenGL without a window: %s", tried);
  return NULL;
}

Context *context_create_headless(ContextKind kind, AppError *error) {
  if (kind == CONTEXT_AUTO) return context_create_auto(error);
  const ContextBackend *backend = context_backend_of_kind(kind);
  if (backend == NULL) {
    app_fail(error, APP_FAILED, "this program was built without that OpenGL context");
    return NULL;
  }
  return context_create_with(backend, error);
}

void context_destroy(Context *context) {
  if (context == NULL) return;
  context->backend->destroy(context->data);
  free(context);
}
