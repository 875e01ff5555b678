// Textures, the framebuffers that draw into them, and reading back.
#include "render/gpu.h"

#include <epoxy/gl.h>

// clang-format off
static const struct { GLenum internal, layout, type; int32_t channels; } formats[GPU_FORMAT_COUNT] = {
  [GPU_RGBA8]    = { GL_RGBA8,              GL_RGBA,            GL_UNSIGNED_BYTE, 4 },
  [GPU_RGBA16F]  = { GL_RGBA16F,            GL_RGBA,            GL_FLOAT,         4 },
  [GPU_RGBA32F]  = { GL_RGBA32F,            GL_RGBA,            GL_FLOAT,         4 },
  [GPU_RG32F]    = { GL_RG32F,              GL_RG,              GL_FLOAT,         2 },
  [GPU_R32F]     = { GL_R32F,               GL_RED,             GL_FLOAT,         1 },
  [GPU_RGBA32UI] = { GL_RGBA32UI,           GL_RGBA_INTEGER,    GL_UNSIGNED_INT,  4 },
  [GPU_R32I]     = { GL_R32I,               GL_RED_INTEGER,     GL_INT,           1 },
  [GPU_DEPTH32F] = { GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT,         1 },
};
// clang-format on

bool gpu_texture_create(GpuTexture *texture, const GpuTextureDesc *desc, RenderError *error) {
  gpu_texture_destroy(texture);
  glCreateTextures(GL_TEXTURE_2D, 1, &texture->id);
  glTextureStorage2D(texture->id, 1, formats[desc->format].internal, desc->width, desc->height);
  if (glGetError() == GL_OUT_OF_MEMORY) {
    gpu_texture_destroy(texture);
    return gpu_fail(error, "out of graphics memory for \"%s\" (%d x %d)", desc->label, desc->width, desc->height);
  }
  glObjectLabel(GL_TEXTURE, texture->id, -1, desc->label);
  const GLint filter = desc->linear ? GL_LINEAR : GL_NEAREST;
  glTextureParameteri(texture->id, GL_TEXTURE_MIN_FILTER, filter);
  glTextureParameteri(texture->id, GL_TEXTURE_MAG_FILTER, filter);
  glTextureParameteri(texture->id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(texture->id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  texture->width = desc->width;
  texture->height = desc->height;
  texture->format = desc->format;
  return true;
}

void gpu_texture_destroy(GpuTexture *texture) {
  if (texture->id != 0) glDeleteTextures(1, &texture->id);
  *texture = (GpuTexture){0};
}

int32_t gpu_texture_channels(const GpuTexture *texture) {
  return formats[texture->format].channels;
}

void gpu_texture_copy(const GpuTexture *from, const GpuTexture *to) {
  glCopyImageSubData(from->id, GL_TEXTURE_2D, 0, 0, 0, 0, to->id, GL_TEXTURE_2D, 0, 0, 0, 0, from->width, from->height,
                     1);
}

void gpu_texture_read(const GpuTexture *texture, float *values) {
  const size_t count = (size_t)texture->width * (size_t)texture->height * (size_t)gpu_texture_channels(texture);
  const GLsizei size = count * sizeof(float) > INT32_MAX ? INT32_MAX : (GLsizei)(count * sizeof(float));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(texture->id, 0, formats[texture->format].layout, GL_FLOAT, size, values);
}

bool gpu_target_create(GpuTarget *target, const GpuTargetDesc *desc, RenderError *error) {
  gpu_target_destroy(target);
  const GpuTexture *sized = desc->colour[0] != NULL ? desc->colour[0] : desc->depth;
  glCreateFramebuffers(1, &target->id);
  glObjectLabel(GL_FRAMEBUFFER, target->id, -1, desc->label);
  GLenum buffers[GPU_MAX_COLOURS];
  while (target->colour_count < GPU_MAX_COLOURS && desc->colour[target->colour_count] != NULL) {
    const GLenum attachment = GL_COLOR_ATTACHMENT0 + (GLenum)target->colour_count;
    glNamedFramebufferTexture(target->id, attachment, desc->colour[target->colour_count]->id, 0);
    buffers[target->colour_count++] = attachment;
  }
  glNamedFramebufferDrawBuffers(target->id, target->colour_count, buffers);
  if (desc->depth != NULL) glNamedFramebufferTexture(target->id, GL_DEPTH_ATTACHMENT, desc->depth->id, 0);
  target->width = sized->width;
  target->height = sized->height;
  const GLenum status = glCheckNamedFramebufferStatus(target->id, GL_DRAW_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE) {
    gpu_target_destroy(target);
    return gpu_fail(error, "this driver cannot draw into \"%s\" (status 0x%04x)", desc->label, status);
  }
  return true;
}

void gpu_target_destroy(GpuTarget *target) {
  if (target->id != 0) glDeleteFramebuffers(1, &target->id);
  *target = (GpuTarget){0};
}

void gpu_read_rgb8(const GpuTarget *target, uint8_t *rgb) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target->id);
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, target->width, target->height, GL_RGB, GL_UNSIGNED_BYTE, rgb);
}
