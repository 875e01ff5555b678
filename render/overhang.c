#include "render/overhang.h"

#include "render/scene_rays.h"
#include "render/water_objects.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- Sheets ----------------------------------------------------------------------------------------------------------

static size_t nodes_of(const SimHeightField *field) {
  return (size_t)field->size[0] * (size_t)field->size[1];
}

static float floor_of(const SimFrame *frame) {
  return frame->container.min[1];
}

static bool hangs(const SimHeightField *field, size_t node, float floor) {
  return field->underside[node] > floor && field->height[node] > field->underside[node] &&
         field->height[node] < RENDER_FARTHEST;
}

static bool reserve(RenderOverhang *overhang, size_t nodes, RenderError *error) {
  if (nodes <= overhang->capacity) return true;
  float *heights = realloc(overhang->nodes, 3 * nodes * sizeof *heights);
  if (heights != NULL) overhang->nodes = heights;
  uint8_t *rings = realloc(overhang->rings, nodes);
  if (rings != NULL) overhang->rings = rings;
  if (heights == NULL || rings == NULL) return gpu_fail(error, "out of memory for a second layer of %zu nodes", nodes);
  overhang->capacity = nodes;
  return true;
}

static void include_node(RenderOverhang *overhang, const SimHeightField *field, size_t node) {
  const int32_t at[2] = {(int32_t)(node % (size_t)field->size[0]), (int32_t)(node / (size_t)field->size[0])};
  for (int k = 0; k < 2; ++k) {
    if (at[k] < overhang->low[k]) overhang->low[k] = at[k];
    if (at[k] > overhang->high[k]) overhang->high[k] = at[k];
  }
}

// Does a node without air continue a sheet? It does where its water reaches up to the underside of the sheet's nodes beside it
// that are of an earlier ring. Its underside is theirs.
static bool continues(const RenderOverhang *overhang, const SimHeightField *field, size_t node, uint8_t ring,
                      float *underside) {
  const float *undersides = overhang->nodes + 2 * nodes_of(field);
  const int32_t i = (int32_t)(node % (size_t)field->size[0]), k = (int32_t)(node / (size_t)field->size[0]);
  float sum = 0, count = 0;
  for (int32_t z = k > 0 ? k - 1 : 0; z <= k + 1 && z < field->size[1]; ++z) {
    for (int32_t x = i > 0 ? i - 1 : 0; x <= i + 1 && x < field->size[0]; ++x) {
      const size_t beside = (size_t)z * (size_t)field->size[0] + (size_t)x;
      if (overhang->rings[beside] == 0 || overhang->rings[beside] >= ring) continue;
      sum += undersides[beside];
      ++count;
    }
  }
  if (!(count > 0)) return false;
  *underside = sum / count;
  return field->height[node] > *underside && field->height[node] < RENDER_FARTHEST;
}

// Rings of nodes around the sheets, in the water that they grow from: as many as the filter of the heights reaches.
static void grow(RenderOverhang *overhang, const SimHeightField *field, float smoothing) {
  const size_t count = nodes_of(field);
  const int rings = 2 + (int)ceilf(2 * smoothing);
  for (int ring = 2; ring < 2 + rings; ++ring) {
    for (size_t node = 0; node < count; ++node) {
      float underside;
      if (overhang->rings[node] != 0 || !continues(overhang, field, node, (uint8_t)ring, &underside)) continue;
      overhang->rings[node] = (uint8_t)ring;
      overhang->nodes[count + node] = field->height[node];
      overhang->nodes[2 * count + node] = underside - field->spacing; // so that its end is hidden, however thin
      include_node(overhang, field, node);
    }
  }
}

bool render_overhang_find(RenderOverhang *overhang, const SimFrame *frame, float smoothing, RenderError *error) {
  const SimHeightField *field = &frame->height_field;
  const size_t count = nodes_of(field);
  const float floor = floor_of(frame);
  for (int k = 0; k < 2; ++k) overhang->low[k] = INT32_MAX, overhang->high[k] = -1;
  if (!render_field_is_sensible(field)) return true;
  if (!reserve(overhang, count, error)) return false;
  float *below = overhang->nodes, *top = below + count, *underside = top + count;
  for (size_t node = 0; node < count; ++node) {
    const bool sheet = hangs(field, node, floor);
    below[node] = sheet ? field->second[node] : field->height[node];
    top[node] = sheet ? field->height[node] : NAN;
    underside[node] = sheet ? field->underside[node] : NAN;
    overhang->rings[node] = sheet;
    if (sheet) include_node(overhang, field, node);
  }
  if (overhang->high[0] >= 0) grow(overhang, field, smoothing);
  return true;
}

bool render_in_overhang(const SimHeightField *field, const float point[3], float close) {
  if (field->underside == NULL || field->size[0] <= 0 || !(field->spacing > 0)) return false;
  int32_t at[2];
  for (int k = 0; k < 2; ++k) {
    const float u = (point[2 * k] - field->origin[k]) / field->spacing;
    if (!(u >= 0 && u <= (float)(field->size[k] - 1))) return false;
    at[k] = (int32_t)u;
  }
  for (int corner = 0; corner < 4; ++corner) {
    const int32_t i = at[0] + (corner & 1), k = at[1] + (corner >> 1);
    if (i >= field->size[0] || k >= field->size[1]) continue;
    const size_t node = (size_t)k * (size_t)field->size[0] + (size_t)i;
    if (field->second[node] < field->underside[node] && point[1] > field->underside[node] - close &&
        point[1] < field->height[node] + close) {
      return true;
    }
  }
  return false;
}

// ---- Drawing ---------------------------------------------------------------------------------------------------------

#define MOST_QUADS 30000 // of a face, or its vertices would cost more than its pixels

// std140 block of overhang.glsl
typedef struct Params {
  RenderBodyEnds ends;
  int32_t first[2], count[2]; // texels: where the quads begin; quads along x and z
  int32_t step[4];            // texels from one to the next; –
} Params;

// The texels around the sheet's nodes, with one node more on each side.
static void find_quads(const RenderOverhang *overhang, const SimHeightField *field, Params *params) {
  const RenderHeightMap *map = &overhang->top;
  const float texels = field->spacing / map->spacing;
  for (int k = 0; k < 2; ++k) {
    const float first = floorf(texels * (float)(overhang->low[k] - 1)),
                last = ceilf(texels * (float)(overhang->high[k] + 1));
    params->first[k] = (int32_t)fmaxf(first, 0);
    params->count[k] = (int32_t)fminf(last, (float)(map->size[k] - 1)) - params->first[k];
  }
  int32_t step = 1;
  while ((int64_t)(params->count[0] / step) * (params->count[1] / step) > MOST_QUADS) ++step;
  for (int k = 0; k < 2; ++k) params->count[k] = (params->count[k] + step - 1) / step;
  params->step[0] = step;
}

bool render_overhang_draw(RenderOverhang *overhang, RenderPicture *picture, const SimHeightField *field,
                          float smoothing, GpuInputs in, const char *defines, RenderError *error) {
  if (overhang->high[0] < 0) return true;
  const size_t nodes = nodes_of(field);
  const GpuTextureDesc behind = {"overhang: behind", picture->width, picture->height, GPU_RGBA32F, false};
  const GpuProgramDesc desc = {.label = "overhang", .file = "overhang.glsl", .defines = defines};
  if (!render_height_map_draw(&overhang->top, picture, field, overhang->nodes + nodes, smoothing, error) ||
      !render_height_map_draw(&overhang->underside, picture, field, overhang->nodes + 2 * nodes, smoothing, error) ||
      !gpu_program_prepare(&overhang->program, &desc, error) ||
      (overhang->behind.id == 0 && !gpu_texture_create(&overhang->behind, &behind, error))) {
    return false;
  }
  gpu_texture_copy(&picture->colour, &overhang->behind);
  Params params = {.ends = render_body_ends(picture)};
  find_quads(overhang, field, &params);
  if (params.count[0] <= 0 || params.count[1] <= 0) return true;
  in.textures[0] = &overhang->behind;
  in.textures[1] = &overhang->top.surface;
  in.textures[2] = &overhang->underside.surface;
  in.params = &params;
  in.params_size = sizeof params;
  const int32_t faces = 2 * params.count[0] * params.count[1], sides = 2 * (params.count[0] + params.count[1]);
  gpu_draw(picture->gpu, &(GpuDraw){.program = &overhang->program,
                                    .target = &picture->target,
                                    .vertices = 6 * (faces + sides),
                                    .depth = GPU_DEPTH_WRITE,
                                    .in = in});
  return true;
}

void render_overhang_destroy(RenderOverhang *overhang) {
  gpu_program_destroy(&overhang->program);
  render_height_map_destroy(&overhang->top);
  render_height_map_destroy(&overhang->underside);
  gpu_texture_destroy(&overhang->behind);
  free(overhang->nodes);
  free(overhang->rings);
  *overhang = (RenderOverhang){0};
}
