// Heights smoothed and refined in three passes: sums along rows of nodes, then along columns, where the plane that fits best
// gives the height (locally weighted regression: Cleveland & Devlin, 1988); then slopes by central differences. The two passes
// along rows and columns cost the width of the kernel, not its square.
//
// The kernel is a Gaussian and, 10⁻³ as strong, a wider one. The second says where the surface would go on a little beyond the
// last node with water, so that what is interpolated up to there does not bend down to nothing.
#include "render/height_map.h"

#include <math.h>
#include <stdlib.h>

#define DRY 1e9f         // height of a node without water, FAR in the shaders
#define FINE_TEXELS 1024 // along an axis: beyond it texels are not finer than nodes
#define MOST_NODES 16384 // along an axis: as many texels as every OpenGL 4.5 has
#define NARROWEST 0.2f   // spacings; so narrow a Gaussian interpolates: a node outweighs its neighbours by 10⁵
#define WIDER 0.5f       // spacings by which the faint kernel is wider
#define REACH 3          // standard deviations

// std140 block of the passes.
typedef struct Params {
  int32_t nodes[4]; // columns, rows; texels to a spacing; reach of the kernel, spacings
  float kernel[4];  // −1/2σ² of the kernel and of the wider one; reference (m); 1/spacing of texels (1/m)
} Params;

// ---- Nodes -----------------------------------------------------------------------------------------------------------

// Which nodes are taken: all, or every `stride`th where they are more than a texture or a block holds.
typedef struct Nodes {
  int32_t size[2], stride;
} Nodes;

static Nodes choose_nodes(const SimHeightField *field, int32_t most) {
  Nodes nodes = {.stride = 0};
  do {
    ++nodes.stride;
    for (int k = 0; k < 2; ++k) nodes.size[k] = (field->size[k] - 1) / nodes.stride + 1;
  } while (nodes.size[0] > MOST_NODES || nodes.size[1] > MOST_NODES || nodes.size[0] > most / nodes.size[1]);
  return nodes;
}

static bool is_wet(float height) {
  return fabsf(height) < RENDER_FARTHEST; // not NaN
}

static void find_range(RenderHeightMap *map, const SimHeightField *field, const float *heights) {
  const size_t count = (size_t)field->size[0] * (size_t)field->size[1];
  map->lowest = RENDER_FARTHEST;
  map->highest = -RENDER_FARTHEST;
  double sum = 0, wet = 0;
  for (size_t i = 0; i < count; ++i) {
    if (!is_wet(heights[i])) continue;
    map->lowest = fminf(map->lowest, heights[i]);
    map->highest = fmaxf(map->highest, heights[i]);
    sum += (double)heights[i];
    ++wet;
  }
  map->level = wet > 0 ? (float)(sum / wet) : 0;
}

#define MOST_SLOPE 0.7f // a dam that breaks would have any

// Mean slopes, from neighbours that both have water.
static void find_slope(RenderHeightMap *map, const SimHeightField *field, const float *heights) {
  const int32_t stride[2] = {1, field->size[0]};
  for (int k = 0; k < 2; ++k) {
    double sum = 0, pairs = 0;
    for (int32_t z = 0; z < field->size[1] - k; ++z) {
      for (int32_t x = 0; x < field->size[0] - (1 - k); ++x) {
        const float *at = heights + (size_t)z * (size_t)field->size[0] + (size_t)x;
        if (!is_wet(at[0]) || !is_wet(at[stride[k]])) continue;
        sum += (double)at[stride[k]] - (double)at[0];
        ++pairs;
      }
    }
    const float slope = pairs > 0 ? (float)(sum / pairs / (double)field->spacing) : 0;
    map->slope[k] = fminf(fmaxf(slope, -MOST_SLOPE), MOST_SLOPE);
  }
}

// Heights over the middle of their range: sums of them lose fewer digits.
static float reference(const RenderHeightMap *map) {
  return map->lowest <= map->highest ? 0.5f * (map->lowest + map->highest) : 0;
}

static bool upload(RenderHeightMap *map, const SimHeightField *field, const float *heights, Nodes nodes,
                   RenderError *error) {
  const size_t count = (size_t)nodes.size[0] * (size_t)nodes.size[1];
  float *values = malloc(count * sizeof *values), *out = values;
  if (values == NULL) return gpu_fail(error, "out of memory for %zu heights", count);
  const float middle = reference(map);
  for (int32_t k = 0; k < nodes.size[1]; ++k) {
    const float *row = heights + (size_t)(k * nodes.stride) * (size_t)field->size[0];
    for (int32_t i = 0; i < nodes.size[0]; ++i) {
      const float height = row[i * nodes.stride];
      *out++ = is_wet(height) ? height - middle : DRY;
    }
  }
  const bool ok = gpu_buffer_write(&map->nodes, "heights", values, count * sizeof *values, error);
  free(values);
  return ok;
}

// ---- Textures --------------------------------------------------------------------------------------------------------

static bool fits(const GpuTexture *texture, int32_t width, int32_t height) {
  return texture->id != 0 && texture->width == width && texture->height == height;
}

static bool make_textures(RenderHeightMap *map, int32_t rows, RenderError *error) {
  const int32_t width = map->size[0], height = map->size[1];
  if (fits(&map->surface, width, height) && fits(&map->moments[1], width, rows)) return true;
  const GpuTextureDesc moments = {"height map: moments", width, rows, GPU_RGBA32F, false};
  const GpuTextureDesc smooth = {"height map: smooth", width, height, GPU_RGBA32F, false};
  const GpuTextureDesc surface = {"height map: surface", width, height, GPU_RGBA32F, true};
  const GpuTargetDesc to_moments = {.label = "height map: moments", .colour = {&map->moments[0], &map->moments[1]}};
  const GpuTargetDesc to_smooth = {.label = "height map: smooth", .colour = {&map->smooth}};
  const GpuTargetDesc to_surface = {.label = "height map: surface", .colour = {&map->surface}};
  return gpu_texture_create(&map->moments[0], &moments, error) &&
         gpu_texture_create(&map->moments[1], &moments, error) && gpu_texture_create(&map->smooth, &smooth, error) &&
         gpu_texture_create(&map->surface, &surface, error) &&
         gpu_target_create(&map->moment_target, &to_moments, error) &&
         gpu_target_create(&map->smooth_target, &to_smooth, error) &&
         gpu_target_create(&map->surface_target, &to_surface, error);
}

void render_height_map_destroy(RenderHeightMap *map) {
  gpu_program_destroy(&map->row_program);
  gpu_program_destroy(&map->column_program);
  gpu_program_destroy(&map->slope_program);
  gpu_buffer_destroy(&map->nodes);
  gpu_texture_destroy(&map->moments[0]);
  gpu_texture_destroy(&map->moments[1]);
  gpu_texture_destroy(&map->smooth);
  gpu_texture_destroy(&map->surface);
  gpu_target_destroy(&map->moment_target);
  gpu_target_destroy(&map->smooth_target);
  gpu_target_destroy(&map->surface_target);
  *map = (RenderHeightMap){0};
}

// ---- Passes ----------------------------------------------------------------------------------------------------------

static bool prepare(RenderHeightMap *map, RenderError *error) {
  const GpuProgramDesc rows = {.label = "height map: rows", .file = "height_map_rows.glsl"};
  const GpuProgramDesc columns = {.label = "height map: columns", .file = "height_map_columns.glsl"};
  const GpuProgramDesc slopes = {.label = "height map: slopes", .file = "height_map_slopes.glsl"};
  return gpu_program_prepare(&map->row_program, &rows, error) &&
         gpu_program_prepare(&map->column_program, &columns, error) &&
         gpu_program_prepare(&map->slope_program, &slopes, error);
}

static Params kernel_params(const RenderHeightMap *map, Nodes nodes, int32_t fineness, float smoothing) {
  const float sigma = fmaxf(smoothing, NARROWEST), wide = sigma + WIDER;
  return (Params){{nodes.size[0], nodes.size[1], fineness, (int32_t)ceilf(REACH * wide)},
                  {-0.5f / (sigma * sigma), -0.5f / (wide * wide), reference(map), 1 / map->spacing}};
}

static void run(const RenderHeightMap *map, Gpu *gpu, const Params *params) {
  GpuInputs in = {.storage = {[1] = &map->nodes}, .params = params, .params_size = sizeof *params};
  gpu_draw(gpu, &(GpuDraw){.program = &map->row_program, .target = &map->moment_target, .in = in});
  in.textures[0] = &map->moments[0];
  in.textures[1] = &map->moments[1];
  gpu_draw(gpu, &(GpuDraw){.program = &map->column_program, .target = &map->smooth_target, .in = in});
  in.textures[0] = &map->smooth;
  in.textures[1] = NULL;
  gpu_draw(gpu, &(GpuDraw){.program = &map->slope_program, .target = &map->surface_target, .in = in});
}

bool render_height_map_draw(RenderHeightMap *map, RenderPicture *picture, const SimHeightField *field,
                            const float *heights, float smoothing, RenderError *error) {
  map->size[0] = map->size[1] = 0;
  map->lowest = RENDER_FARTHEST;
  map->highest = -RENDER_FARTHEST;
  const bool any = field->size[0] > 0 && field->size[1] > 0 && heights != NULL && field->spacing > 0;
  if (!any) return true;
  const int32_t most = gpu_block_elements(picture->gpu, sizeof(float), error);
  if (most == 0) return false;
  const Nodes nodes = choose_nodes(field, most);
  const bool fine = 2 * nodes.size[0] - 1 <= FINE_TEXELS && 2 * nodes.size[1] - 1 <= FINE_TEXELS;
  const int32_t fineness = fine ? 2 : 1;
  for (int k = 0; k < 2; ++k) {
    map->size[k] = fineness * (nodes.size[k] - 1) + 1;
    map->origin[k] = field->origin[k];
  }
  map->spacing = field->spacing * (float)nodes.stride / (float)fineness;
  find_range(map, field, heights);
  find_slope(map, field, heights);
  if (!upload(map, field, heights, nodes, error) || !make_textures(map, nodes.size[1], error) || !prepare(map, error)) {
    return false;
  }
  const Params params = kernel_params(map, nodes, fineness, smoothing / (float)nodes.stride);
  run(map, picture->gpu, &params);
  return true;
}

RenderHeightBlock render_height_block(const RenderHeightMap *map) {
  RenderHeightBlock block = {.range = {map->lowest, map->highest, map->spacing, 0},
                             .slope = {map->slope[0], map->slope[1]}};
  for (int k = 0; k < 2 && map->size[0] > 0; ++k) {
    const float scale = 1 / (map->spacing * (float)map->size[k]);
    block.place[k] = scale;
    block.place[2 + k] = 0.5f / (float)map->size[k] - map->origin[k] * scale;
  }
  return block;
}
