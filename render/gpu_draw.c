// The one place that touches the state of a draw. Everything is set for every draw, so no draw depends on the last one.
#include "render/gpu.h"

#include <assert.h>
#include <epoxy/gl.h>

static void set_switch(GLenum capability, bool on) {
  if (on) {
    glEnable(capability);
  } else {
    glDisable(capability);
  }
}

// The renderer may share its context with a window, so the state that it relies on is set here as well.
static void set_target(const GpuTarget *target) {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target->id);
  glViewport(0, 0, target->width, target->height);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glDisable(GL_RASTERIZER_DISCARD);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

static void set_depth(GpuDepth depth) {
  // Reversed depth in [0, 1]; no clipping at the near plane, whose place shaders take by discarding.
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDepthRange(0, 1);
  glEnable(GL_DEPTH_CLAMP);
  set_switch(GL_DEPTH_TEST, depth != GPU_DEPTH_OFF);
  glDepthFunc(depth == GPU_DEPTH_WRITE_FARTHEST ? GL_LEQUAL : GL_GEQUAL);
  glDepthMask(depth == GPU_DEPTH_WRITE || depth == GPU_DEPTH_WRITE_FARTHEST);
}

static void set_blend(GpuBlend blend) {
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  set_switch(GL_COLOR_LOGIC_OP, blend == GPU_BLEND_OR);
  glLogicOp(GL_OR);
  set_switch(GL_BLEND, blend != GPU_BLEND_OFF && blend != GPU_BLEND_OR);
  const bool max_colour = blend == GPU_BLEND_MAX, max_alpha = max_colour || blend == GPU_BLEND_ADD_MAX;
  glBlendEquationSeparate(max_colour ? GL_MAX : GL_FUNC_ADD, max_alpha ? GL_MAX : GL_FUNC_ADD);
  if (blend == GPU_BLEND_OVER) {
    glBlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  } else {
    glBlendFunc(GL_ONE, GL_ONE);
  }
}

static void set_cull(GpuCull cull) {
  set_switch(GL_CULL_FACE, cull != GPU_CULL_NONE);
  glFrontFace(GL_CCW);
  glCullFace(cull == GPU_CULL_FRONT ? GL_FRONT : GL_BACK);
}

static void set_storage(GLuint binding, const GpuBuffer *buffer, GpuPart part) {
  if (part.size > 0) {
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, binding, buffer->id, (GLintptr)part.offset, (GLsizeiptr)part.size);
  } else {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer != NULL ? buffer->id : 0);
  }
}

static void set_inputs(const Gpu *gpu, const GpuInputs *in) {
  for (GLuint i = 0; i < GPU_MAX_TEXTURES; ++i) {
    glBindTextureUnit(i, in->textures[i] != NULL ? in->textures[i]->id : 0);
    glBindSampler(i, 0);
  }
  for (GLuint i = 0; i < GPU_MAX_VIEWS; ++i) {
    glBindTextureUnit(GPU_MAX_TEXTURES + i, in->views[i] != NULL ? in->views[i]->view : 0);
    glBindSampler(GPU_MAX_TEXTURES + i, 0);
  }
  for (GLuint i = 0; i < GPU_MAX_STORAGE; ++i) set_storage(i, in->storage[i], in->parts[i]);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, in->frame != NULL ? in->frame->id : 0);
  if (in->params_size > 0) {
    glNamedBufferData(gpu->params, (GLsizeiptr)in->params_size, in->params, GL_STREAM_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, 1, gpu->params);
  }
}

void gpu_draw(Gpu *gpu, const GpuDraw *draw) {
  assert(draw->program->id != 0 && draw->target->id != 0);
  set_target(draw->target);
  set_depth(draw->depth);
  set_blend(draw->blend);
  set_cull(draw->cull);
  set_inputs(gpu, &draw->in);
  glUseProgram(draw->program->id);
  glBindVertexArray(gpu->vertex_array);
  glDrawArrays(GL_TRIANGLES, draw->first_vertex, draw->vertices > 0 ? draw->vertices : 3);
}

void gpu_dispatch(Gpu *gpu, const GpuDispatch *dispatch) {
  assert(dispatch->program->id != 0);
  static const GLenum image_formats[GPU_FORMAT_COUNT] = {[GPU_RGBA8] = GL_RGBA8,
                                                         [GPU_RGBA16F] = GL_RGBA16F,
                                                         [GPU_RGBA32F] = GL_RGBA32F,
                                                         [GPU_RG32F] = GL_RG32F,
                                                         [GPU_R32F] = GL_R32F};
  set_inputs(gpu, &dispatch->in);
  glUseProgram(dispatch->program->id);
  for (GLuint i = 0; i < GPU_MAX_COLOURS && dispatch->output[i] != NULL; ++i) {
    const GpuTexture *output = dispatch->output[i];
    glBindImageTexture(i, output->id, 0, GL_FALSE, 0, GL_WRITE_ONLY, image_formats[output->format]);
  }
  glDispatchCompute((GLuint)(dispatch->width + 7) / 8, (GLuint)(dispatch->height + 7) / 8, 1);
  // What was stored becomes visible to texture fetches, to shaders that read buffers, to drawing and to reading back.
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT |
                  GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
}

void gpu_clear_colour(const GpuTarget *target, int32_t index, const float rgba[4]) {
  glDisable(GL_SCISSOR_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glClearNamedFramebufferfv(target->id, GL_COLOR, index, rgba);
}

void gpu_clear_bits(const GpuTarget *target, int32_t index) {
  const GLuint none[4] = {0};
  glDisable(GL_SCISSOR_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glClearNamedFramebufferuiv(target->id, GL_COLOR, index, none);
}

void gpu_clear_depth(const GpuTarget *target, GpuDepthClear to) {
  const float depth = to == GPU_NEAREST ? 1 : 0;
  glDisable(GL_SCISSOR_TEST);
  glDepthMask(GL_TRUE);
  glClearNamedFramebufferfv(target->id, GL_DEPTH, 0, &depth);
}

void gpu_present(const GpuTarget *target, int32_t window_width, int32_t window_height) {
  const bool same_size = window_width == target->width && window_height == target->height;
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glBlitNamedFramebuffer(target->id, 0, 0, 0, target->width, target->height, 0, 0, window_width, window_height,
                         GL_COLOR_BUFFER_BIT, same_size ? GL_NEAREST : GL_LINEAR);
}
