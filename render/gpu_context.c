// The context as a whole: is it good enough, what does its driver complain about, how long do the passes take.
#include "render/gpu.h"

#include <epoxy/gl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

bool gpu_fail(RenderError *error, const char *format, ...) {
  if (error != NULL) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->message, sizeof error->message, format, arguments);
    va_end(arguments);
    // One line, whatever a driver's log holds.
    for (char *c = error->message; *c != '\0'; ++c) {
      if ((unsigned char)*c < 32) *c = ' ';
    }
  }
  return false;
}

// ---- Errors ----------------------------------------------------------------------------------------------------------

static void gpu_report(Gpu *gpu, const char *message) {
  ++gpu->error_count;
  snprintf(gpu->last_error, sizeof gpu->last_error, "%s", message);
#ifdef RENDER_ABORT_ON_GL_ERROR
  fprintf(stderr, "lido: OpenGL: %s\n", message);
  abort();
#endif
}

// What a driver says about speed is advice, and what its shader compiler says comes back as a RenderError; the rest is
// a mistake of ours.
static void GLAPIENTRY gpu_on_message(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                                      const GLchar *message, const void *user) {
  (void)id;
  (void)length;
  if (severity == GL_DEBUG_SEVERITY_NOTIFICATION || type == GL_DEBUG_TYPE_PERFORMANCE) return;
  if (source == GL_DEBUG_SOURCE_SHADER_COMPILER) return;
  if (type == GL_DEBUG_TYPE_OTHER && severity == GL_DEBUG_SEVERITY_LOW) return;
  gpu_report((Gpu *)(uintptr_t)user, message);
}

void gpu_collect_errors(Gpu *gpu) {
  // A driver without working debug output still has glGetError; one that has both is counted once.
  const int32_t known = gpu->error_count;
  for (int i = 0; i < 16; ++i) {
    const GLenum code = glGetError();
    if (code == GL_NO_ERROR) break;
    char message[64];
    snprintf(message, sizeof message, "glGetError: 0x%04x", code);
    if (known == 0) gpu_report(gpu, message);
  }
}

// ---- Creation --------------------------------------------------------------------------------------------------------

static bool gpu_check_version(Gpu *gpu, RenderError *error) {
  const char *version = (const char *)glGetString(GL_VERSION);
  if (version == NULL) return gpu_fail(error, "no OpenGL context is current");
  snprintf(gpu->description, sizeof gpu->description, "%s / %s / %s", (const char *)glGetString(GL_VENDOR),
           (const char *)glGetString(GL_RENDERER), version);
  GLint major = 0, minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  if (strncmp(version, "OpenGL ES", 9) == 0 || major * 10 + minor < 45) {
    while (glGetError() != GL_NO_ERROR) continue;
    return gpu_fail(error, "OpenGL 4.5 is needed, but this driver offers %s", gpu->description);
  }
  return true;
}

static _Atomic bool like_hardware; // of tests

void gpu_draw_like_hardware(bool on) {
  like_hardware = on;
}

bool gpu_create(Gpu *gpu, RenderError *error) {
  *gpu = (Gpu){0};
  if (!gpu_check_version(gpu, error)) return false;
  gpu->software =
      !like_hardware && (strstr(gpu->description, "llvmpipe") != NULL || strstr(gpu->description, "softpipe") != NULL);
  GLint64 block_limit = 0, block_start = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &block_limit);
  glGetInteger64v(GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT, &block_start);
  gpu->block_limit = (size_t)block_limit;
  gpu->block_start = block_start > 0 ? (size_t)block_start : 1;
  glEnable(GL_DEBUG_OUTPUT);
#ifdef RENDER_ABORT_ON_GL_ERROR
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
#endif
  glDebugMessageCallback(gpu_on_message, gpu);

  glCreateVertexArrays(1, &gpu->vertex_array);
  glObjectLabel(GL_VERTEX_ARRAY, gpu->vertex_array, -1, "no vertices");
  glCreateBuffers(1, &gpu->params);
  glObjectLabel(GL_BUFFER, gpu->params, -1, "draw parameters");
  for (int i = 0; i < GPU_MAX_PASSES; ++i) glCreateQueries(GL_TIMESTAMP, 2, gpu->passes[i].query);
  return true;
}

void gpu_destroy(Gpu *gpu) {
  // What is still in use would outlive its deletion.
  glUseProgram(0);
  glBindVertexArray(0);
  for (int i = 0; i < GPU_MAX_PASSES; ++i) glDeleteQueries(2, gpu->passes[i].query);
  glDeleteBuffers(1, &gpu->params);
  glDeleteVertexArrays(1, &gpu->vertex_array);
  glDebugMessageCallback(NULL, NULL);
  *gpu = (Gpu){0};
}

// ---- Times of passes -------------------------------------------------------------------------------------------------

static double now_milliseconds(clockid_t clock) {
  struct timespec now;
  clock_gettime(clock, &now);
  return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

void gpu_passes_restart(Gpu *gpu) {
  gpu->pass_count = 0;
}

void gpu_pass_begin(Gpu *gpu, const char *name) {
  if (gpu->pass_count == GPU_MAX_PASSES) return;
  GpuPass *pass = &gpu->passes[gpu->pass_count];
  pass->name = name;
  pass->cpu_milliseconds = -now_milliseconds(CLOCK_MONOTONIC);
  pass->processor_milliseconds = -now_milliseconds(CLOCK_PROCESS_CPUTIME_ID);
  glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, -1, name);
  glQueryCounter(pass->query[0], GL_TIMESTAMP);
}

void gpu_pass_end(Gpu *gpu) {
  if (gpu->pass_count == GPU_MAX_PASSES) return;
  GpuPass *pass = &gpu->passes[gpu->pass_count++];
  glQueryCounter(pass->query[1], GL_TIMESTAMP);
  glPopDebugGroup();
  if (gpu->measuring) glFinish();
  pass->cpu_milliseconds += now_milliseconds(CLOCK_MONOTONIC);
  pass->processor_milliseconds += now_milliseconds(CLOCK_PROCESS_CPUTIME_ID);
}

double gpu_pass_milliseconds(const GpuPass *pass) {
  GLuint64 begin = 0, end = 0;
  glGetQueryObjectui64v(pass->query[0], GL_QUERY_RESULT, &begin);
  glGetQueryObjectui64v(pass->query[1], GL_QUERY_RESULT, &end);
  return end > begin ? 1e-6 * (double)(end - begin) : 0;
}
