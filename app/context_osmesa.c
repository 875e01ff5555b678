// OpenGL without a window or a driver through OSMesa, Mesa's software rasteriser as a library (up to Mesa 25.0).
//
// libepoxy looks functions up through GLX or EGL only and aborts under OSMesa. Its entry points are exported, writable
// pointers, so each one that this program uses is set from OSMesaGetProcAddress right after OSMesaMakeCurrent, before
// the first GL call; the list (osmesa_functions.h) is generated from the sources by the build, so none is forgotten.
// When the context goes, the pointers get their old values back, and another backend can follow.
#include "app/context.h"

#include <stdio.h>

#ifdef LIDO_OSMESA

#include <epoxy/gl.h>
// After libepoxy's header, which stands in for <GL/gl.h>.
#include <GL/osmesa.h>
#include <stdlib.h>
#include <string.h>

typedef void (*GlFunction)(void);

typedef struct EpoxySlot {
  const char *name;
  void *pointer; // to libepoxy's function pointer
} EpoxySlot;

static const EpoxySlot slots[] = {
#define GL_FUNCTION(name) {#name, &epoxy_##name},
#include "osmesa_functions.h"
#undef GL_FUNCTION
};
#define SLOT_COUNT (sizeof slots / sizeof slots[0])

typedef struct OsmesaContext {
  OSMesaContext context;
  unsigned char pixel[4]; // OSMesa wants a window-like buffer; we draw into framebuffers of our own
  GlFunction old[SLOT_COUNT];
} OsmesaContext;

static bool set_pointers(OsmesaContext *osmesa, const char **missing) {
  for (size_t i = 0; i < SLOT_COUNT; ++i) memcpy(&osmesa->old[i], slots[i].pointer, sizeof osmesa->old[i]);
  for (size_t i = 0; i < SLOT_COUNT; ++i) {
    const GlFunction function = OSMesaGetProcAddress(slots[i].name);
    if (function == NULL) {
      *missing = slots[i].name;
      return false;
    }
    memcpy(slots[i].pointer, &function, sizeof function);
  }
  return true;
}

static void restore_pointers(const OsmesaContext *osmesa) {
  for (size_t i = 0; i < SLOT_COUNT; ++i) memcpy(slots[i].pointer, &osmesa->old[i], sizeof osmesa->old[i]);
}

static void release(OsmesaContext *osmesa) {
  OSMesaMakeCurrent(NULL, NULL, 0, 0, 0);
  OSMesaDestroyContext(osmesa->context);
}

static bool make_current(OsmesaContext *osmesa, char *why, size_t size) {
  static const int wanted[] = {OSMESA_FORMAT,
                               OSMESA_RGBA,
                               OSMESA_PROFILE,
                               OSMESA_CORE_PROFILE,
                               OSMESA_CONTEXT_MAJOR_VERSION,
                               4,
                               OSMESA_CONTEXT_MINOR_VERSION,
                               5,
                               0};
  osmesa->context = OSMesaCreateContextAttribs(wanted, NULL);
  if (osmesa->context == NULL) {
    snprintf(why, size, "OpenGL 4.5 core is not offered");
    return false;
  }
  const char *missing = NULL;
  if (!OSMesaMakeCurrent(osmesa->context, osmesa->pixel, GL_UNSIGNED_BYTE, 1, 1)) {
    snprintf(why, size, "OSMesaMakeCurrent failed");
  } else if (!set_pointers(osmesa, &missing)) {
    restore_pointers(osmesa);
    snprintf(why, size, "%s is missing", missing);
  } else {
    return true;
  }
  release(osmesa);
  return false;
}

static bool osmesa_available(char *why, size_t size) {
  OsmesaContext osmesa;
  if (!make_current(&osmesa, why, size)) return false;
  restore_pointers(&osmesa);
  release(&osmesa);
  return true;
}

static void *osmesa_create(AppError *error) {
  OsmesaContext *osmesa = calloc(1, sizeof *osmesa);
  char why[128] = "out of memory";
  if (osmesa == NULL || !make_current(osmesa, why, sizeof why)) {
    free(osmesa);
    app_fail(error, APP_FAILED, "no OpenGL 4.5 through OSMesa: %s", why);
    return NULL;
  }
  return osmesa;
}

static void osmesa_destroy(void *data) {
  restore_pointers(data);
  release(data);
  free(data);
}

#else // built without OSMesa

static bool osmesa_available(char *why, size_t size) {
  snprintf(why, size, "this program was built without OSMesa");
  return false;
}

static void *osmesa_create(AppError *error) {
  app_fail(error, APP_FAILED, "no OpenGL 4.5 through OSMesa: this program was built without OSMesa");
  return NULL;
}

static void osmesa_destroy(void *data) {
  (void)data;
}

#endif

const ContextBackend context_backend_osmesa = {
    .name = "osmesa",
    .kind = CONTEXT_OSMESA,
    .summary = "without a window or a driver, through Mesa's software rasteriser",
    .available = osmesa_available,
    .create = osmesa_create,
    .destroy = osmesa_destroy,
};
