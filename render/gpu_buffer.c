// Buffers that shaders read: storage blocks and uniform blocks.
#include "render/gpu.h"

#include <epoxy/gl.h>

bool gpu_buffer_write(GpuBuffer *buffer, const char *label, const void *data, size_t size, RenderError *error) {
  if (buffer->id == 0) {
    glCreateBuffers(1, &buffer->id);
    glObjectLabel(GL_BUFFER, buffer->id, -1, label);
  }
  // A third more than needed, so that a growing number of particles does not reallocate every frame. Giving the buffer
  // new storage each time lets the driver go on reading the last frame's.
  if (size > buffer->capacity || buffer->capacity == 0) buffer->capacity = size + size / 3 + 16;
  glNamedBufferData(buffer->id, (GLsizeiptr)buffer->capacity, NULL, GL_STREAM_DRAW);
  if (glGetError() == GL_OUT_OF_MEMORY) {
    gpu_buffer_destroy(buffer);
    return gpu_fail(error, "out of graphics memory for \"%s\" (%zu bytes)", label, size);
  }
  if (size > 0) glNamedBufferSubData(buffer->id, 0, (GLsizeiptr)size, data);
  return true;
}

void gpu_buffer_destroy(GpuBuffer *buffer) {
  if (buffer->id != 0) glDeleteBuffers(1, &buffer->id);
  *buffer = (GpuBuffer){0};
}
