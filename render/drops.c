#include "render/drops.h"

#include "render/overhang.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SPLASH_ABOVE 0.5f // radii
#define ANY_ABOVE 2.0f
#define FLOATS 8 // of a drop
#define EACH (FLOATS * sizeof(float))

// Height of the water over a place, between the nodes that have water; −INFINITY where the nearest one has none.
static float water_at(const SimHeightField *field, float x, float z) {
  const float u = (x - field->origin[0]) / field->spacing, v = (z - field->origin[1]) / field->spacing;
  if (!(u > -1 && v > -1 && u < (float)field->size[0] && v < (float)field->size[1])) return -INFINITY;
  const float at[2] = {fminf(fmaxf(u, 0), (float)field->size[0] - 1), fminf(fmaxf(v, 0), (float)field->size[1] - 1)};
  const int32_t i = (int32_t)at[0], k = (int32_t)at[1];
  float sum = 0, weights = 0;
  for (int corner = 0; corner < 4; ++corner) {
    const int32_t a = i + (corner & 1), b = k + (corner >> 1);
    if (a >= field->size[0] || b >= field->size[1]) continue;
    const float height = field->height[(size_t)b * (size_t)field->size[0] + (size_t)a];
    const float w = (1 - fabsf(at[0] - (float)a)) * (1 - fabsf(at[1] - (float)b));
    if (isnan(height) || !(w > 0)) continue;
    sum += w * height;
    weights += w;
  }
  return weights >= 0.5f ? sum / weights : -INFINITY;
}

bool render_is_drop(const SimFrame *frame, const SimHeightField *field, int32_t particle) {
  const float *p = frame->position + 3 * (size_t)particle;
  const float above = frame->particle_class[particle] == SIM_SPLASH ? SPLASH_ABOVE : ANY_ABOVE;
  for (int k = 0; k < 3; ++k) {
    if (!(fabsf(p[k]) < RENDER_FARTHEST)) return false;
  }
  if (field->size[0] <= 0) return true;
  return p[1] > water_at(field, p[0], p[2]) + above * frame->particle_radius &&
         !render_in_overhang(&frame->height_field, p, above * frame->particle_radius);
}

bool render_drops_find(RenderDrops *drops, const SimFrame *frame, const SimHeightField *field, RenderError *error) {
  drops->count = 0;
  for (int32_t i = 0; i < frame->count; ++i) {
    const float radius = frame->radius != NULL ? frame->radius[i] : frame->particle_radius;
    if (!render_is_drop(frame, field, i) || !(radius > 0 && radius < RENDER_FARTHEST)) continue;
    if (drops->count == drops->capacity) {
      const int32_t capacity = drops->capacity > 0 ? 2 * drops->capacity : 256;
      float *staging = realloc(drops->staging, FLOATS * sizeof *staging * (size_t)capacity);
      if (staging == NULL) return gpu_fail(error, "out of memory for %d drops", capacity);
      drops->staging = staging;
      drops->capacity = capacity;
    }
    float *out = drops->staging + FLOATS * (size_t)drops->count++;
    memcpy(out, frame->position + 3 * (size_t)i, 3 * sizeof *out);
    out[3] = radius;
    for (int k = 0; k < 3; ++k)
      out[4 + k] = frame->colour != NULL ? render_clamp01(frame->colour[3 * (size_t)i + (size_t)k]) : 1;
    out[7] = 0;
  }
  return gpu_buffer_write(&drops->spheres, "drops", drops->staging, EACH * (size_t)drops->count, error);
}

bool render_drops_draw(RenderDrops *drops, RenderPicture *picture, GpuInputs in, const char *defines,
                       RenderError *error) {
  if (drops->count == 0) return true;
  const GpuTextureDesc behind = {"drops: behind", picture->width, picture->height, GPU_RGBA32F, false};
  if (drops->behind.id == 0 && !gpu_texture_create(&drops->behind, &behind, error)) return false;
  const GpuProgramDesc desc = {.label = "drops", .file = "drops.glsl", .defines = defines};
  if (!gpu_program_prepare(&drops->program, &desc, error)) return false;
  gpu_texture_copy(&picture->colour, &drops->behind);
  const int32_t most = gpu_block_elements(picture->gpu, EACH, error);
  if (most == 0) return false;
  in.textures[0] = &drops->behind;
  in.storage[1] = &drops->spheres;
  for (int64_t first = 0; first < drops->count; first += most) {
    const int64_t left = drops->count - first;
    const int32_t drawn = left < most ? (int32_t)left : most;
    in.parts[1] = (GpuPart){EACH * (size_t)first, EACH * (size_t)drawn};
    gpu_draw(picture->gpu, &(GpuDraw){.program = &drops->program,
                                      .target = &picture->target,
                                      .vertices = 6 * drawn,
                                      .depth = GPU_DEPTH_WRITE,
                                      .in = in});
  }
  return true;
}

void render_drops_destroy(RenderDrops *drops) {
  gpu_program_destroy(&drops->program);
  gpu_buffer_destroy(&drops->spheres);
  gpu_texture_destroy(&drops->behind);
  free(drops->staging);
  *drops = (RenderDrops){0};
}
