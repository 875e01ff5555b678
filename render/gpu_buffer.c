// Buffers that shaders read: storage blocks and uniform blocks.
#include "render/gpu.h"

#include <epoxy/gl.h>

static _Atomic size_t block_limit, view_limit; // of tests
static _Atomic size_t bytes_in_use;

void gpu_limit_blocks(size_t bytes) {
  block_limit = bytes;
}

void gpu_limit_views(size_t texels) {
  view_limit = texels;
}

size_t gpu_buffer_bytes(void) {
  return bytes_in_use;
}

static size_t lower(size_t drivers, size_t of_tests) {
  return of_tests > 0 && of_tests < drivers ? of_tests : drivers;
}

int32_t gpu_block_elements(const Gpu *gpu, size_t element, RenderError *error) {
  const size_t limit = lower(gpu->block_limit, block_limit);
  size_t most = limit / element;
  if (most > 1 << 24) most = 1 << 24;
  most -= most % gpu->block_start; // then a part's size is a multiple of it, whatever an element's is
  if (most == 0) gpu_fail(error, "elements of %zu bytes do not fit the driver's storage blocks of %zu", element, limit);
  return (int32_t)most;
}

bool gpu_buffer_reserve(GpuBuffer *buffer, const char *label, size_t size, RenderError *error) {
  if (buffer->id == 0) {
    glCreateBuffers(1, &buffer->id);
    glObjectLabel(GL_BUFFER, buffer->id, -1, label);
  }
  const size_t before = buffer->capacity;
  // What grows, grows by a third more than needed, so that a growing number of particles does not reallocate every frame.
  // Giving the buffer new storage each time lets the driver go on reading the last frame's.
  if (buffer->capacity == 0) {
    buffer->capacity = size + 16;
  } else if (size > buffer->capacity) {
    buffer->capacity = size + size / 3 + 16;
  }
  glNamedBufferData(buffer->id, (GLsizeiptr)buffer->capacity, NULL, GL_STREAM_DRAW);
  bytes_in_use += buffer->capacity - before;
  if (glGetError() == GL_OUT_OF_MEMORY) {
    gpu_buffer_destroy(buffer);
    return gpu_fail(error, "out of graphics memory for \"%s\" (%zu bytes)", label, size);
  }
  return true;
}

void gpu_buffer_fill(const GpuBuffer *buffer, size_t offset, const void *data, size_t size) {
  if (size > 0) glNamedBufferSubData(buffer->id, (GLintptr)offset, (GLsizeiptr)size, data);
}

bool gpu_buffer_write(GpuBuffer *buffer, const char *label, const void *data, size_t size, RenderError *error) {
  if (!gpu_buffer_reserve(buffer, label, size, error)) return false;
  gpu_buffer_fill(buffer, 0, data, size);
  return true;
}

bool gpu_buffer_view(GpuBuffer *buffer, GpuFormat format, size_t texels, RenderError *error) {
  GLint drivers = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &drivers);
  const size_t most = lower((size_t)drivers, view_limit);
  if (texels > most) {
    return gpu_fail(error, "%zu elements are more than the driver's texture buffers hold: %zu", texels, most);
  }
  if (buffer->view == 0) {
    glCreateTextures(GL_TEXTURE_BUFFER, 1, &buffer->view);
    glTextureBuffer(buffer->view, format == GPU_R32I ? GL_R32I : GL_RGBA32F, buffer->id);
  }
  return true;
}

void gpu_buffer_destroy(GpuBuffer *buffer) {
  if (buffer->view != 0) glDeleteTextures(1, &buffer->view);
  if (buffer->id != 0) glDeleteBuffers(1, &buffer->id);
  bytes_in_use -= buffer->capacity;
  *buffer = (GpuBuffer){0};
}
