// OpenGL without a window through EGL: Mesa's surfaceless platform first, then every device of the device platform
// until one works; hardware before software. Devices that cannot be used (no permission, no driver) are skipped.
#include "app/context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_DEVICES 32

typedef struct EglContext {
  EGLDisplay display;
  EGLContext context;
} EglContext;

// ---- One display -----------------------------------------------------------------------------------------------------

// Make a 4.5 core context current on `display`. On failure the display is terminated and `why` names the step.
static bool make_current(EglContext *egl, EGLDisplay display, char *why, size_t size) {
  static const EGLint config_wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  static const EGLint context_wanted[] = {
      EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, NULL, NULL)) {
    snprintf(why, size, "eglInitialize failed");
    return false;
  }
  EGLConfig config = NULL; // stays NULL (any) where the driver lists none
  EGLint count = 0;
  EGLContext context = EGL_NO_CONTEXT;
  if (!eglBindAPI(EGL_OPENGL_API)) {
    snprintf(why, size, "desktop OpenGL is not offered");
  } else if (!eglChooseConfig(display, config_wanted, &config, 1, &count)) {
    snprintf(why, size, "eglChooseConfig failed");
  } else if ((context = eglCreateContext(display, count > 0 ? config : NULL, EGL_NO_CONTEXT, context_wanted)) ==
             EGL_NO_CONTEXT) {
    snprintf(why, size, "OpenGL 4.5 core is not offered");
  } else if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
    snprintf(why, size, "a context without a surface is not offered");
    eglDestroyContext(display, context);
  } else {
    *egl = (EglContext){display, context};
    return true;
  }
  eglTerminate(display);
  return false;
}

static void release(EglContext *egl) {
  eglMakeCurrent(egl->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(egl->display, egl->context);
  eglTerminate(egl->display);
}

// ---- The search ------------------------------------------------------------------------------------------------------

static bool client_has(const char *extensions, const char *name) {
  const size_t length = strlen(name);
  for (const char *at = strstr(extensions, name); at != NULL; at = strstr(at + length, name)) {
    const bool starts = at == extensions || at[-1] == ' ';
    if (starts && (at[length] == ' ' || at[length] == '\0')) return true;
  }
  return false;
}

static bool is_software(void) {
  const char *renderer = (const char *)glGetString(GL_RENDERER);
  return renderer == NULL || strstr(renderer, "llvmpipe") != NULL || strstr(renderer, "softpipe") != NULL;
}

// The first device that works and, when asked for, is not a software rasteriser.
static bool try_devices(EglContext *egl, bool hardware_only, char *why, size_t size) {
  EGLDeviceEXT devices[MAX_DEVICES];
  EGLint count = 0;
  if (!eglQueryDevicesEXT(MAX_DEVICES, devices, &count)) count = 0;
  for (EGLint i = 0; i < count; ++i) {
    const char *extensions = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
    if (hardware_only && extensions != NULL && client_has(extensions, "EGL_MESA_device_software")) continue;
    const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], NULL);
    if (!make_current(egl, display, why, size)) continue;
    if (!hardware_only || !is_software()) return true;
    release(egl);
  }
  return false;
}

// Mesa's surfaceless platform asks for no device files and finds Mesa's own drivers. Where only its software
// rasteriser is behind it, another vendor's device (NVIDIA's, say) is better; the software context waits meanwhile.
static bool find_display(EglContext *egl, char *why, size_t size) {
  snprintf(why, size, "libEGL offers neither the surfaceless nor the device platform");
  const char *extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (extensions == NULL || !client_has(extensions, "EGL_EXT_platform_base")) return false;
  const bool has_devices =
      client_has(extensions, "EGL_EXT_platform_device") &&
      (client_has(extensions, "EGL_EXT_device_enumeration") || client_has(extensions, "EGL_EXT_device_base"));
  EglContext software = {EGL_NO_DISPLAY, EGL_NO_CONTEXT};
  if (client_has(extensions, "EGL_MESA_platform_surfaceless")) {
    const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (make_current(egl, display, why, size)) {
      if (!is_software()) return true;
      software = *egl;
    }
  }
  if (software.context == EGL_NO_CONTEXT) return has_devices && try_devices(egl, false, why, size);
  if (has_devices && try_devices(egl, true, why, size)) {
    eglDestroyContext(software.display, software.context);
    eglTerminate(software.display);
    return true;
  }
  *egl = software;
  return eglMakeCurrent(egl->display, EGL_NO_SURFACE, EGL_NO_SURFACE, egl->context);
}

// ---- The backend -----------------------------------------------------------------------------------------------------

static bool egl_available(char *why, size_t size) {
  EglContext egl;
  if (!find_display(&egl, why, size)) return false;
  release(&egl);
  return true;
}

static void *egl_create(AppError *error) {
  EglContext *egl = malloc(sizeof *egl);
  char why[128] = "out of memory";
  if (egl == NULL || !find_display(egl, why, sizeof why)) {
    free(egl);
    app_fail(error, APP_FAILED, "no OpenGL 4.5 through EGL: %s", why);
    return NULL;
  }
  return egl;
}

static void egl_destroy(void *data) {
  release(data);
  free(data);
}

const ContextBackend context_backend_egl = {
    .name = "egl",
    .kind = CONTEXT_EGL,
    .summary = "without a window, through EGL (surfaceless or device platform)",
    .available = egl_available,
    .create = egl_create,
    .destroy = egl_destroy,
};
