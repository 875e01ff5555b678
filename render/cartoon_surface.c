#include "render/cartoon_surface.h"

#include <math.h>
#include <stdio.h>

// ---- Making and unmaking ---------------------------------------------------------------------------------------------

static bool resize_layer(RenderCartoonLayer *layer, int32_t width, int32_t height, RenderError *error) {
  const struct {
    GpuTexture *texture;
    GpuTextureDesc desc;
  } textures[] = {{&layer->raw, {"cartoon: raw depths", width, height, GPU_RG32F, false}},
                  {&layer->map[0], {"cartoon: map", width, height, GPU_RGBA32F, true}},
                  {&layer->map[1], {"cartoon: map, other", width, height, GPU_RGBA32F, true}},
                  {&layer->surface, {"cartoon: surface", width, height, GPU_RGBA32F, false}}};
  for (size_t i = 0; i < sizeof textures / sizeof textures[0]; ++i) {
    if (!gpu_texture_create(textures[i].texture, &textures[i].desc, error)) return false;
  }
  const struct {
    GpuTarget *target;
    GpuTargetDesc desc;
  } targets[] = {{&layer->raw_target, {"cartoon: raw depths", {&layer->raw}, NULL}},
                 {&layer->map_target[0], {"cartoon: map", {&layer->map[0]}, NULL}},
                 {&layer->map_target[1], {"cartoon: map, other", {&layer->map[1]}, NULL}},
                 {&layer->surface_target, {"cartoon: surface", {&layer->surface}, NULL}}};
  for (size_t i = 0; i < sizeof targets / sizeof targets[0]; ++i) {
    if (!gpu_target_create(targets[i].target, &targets[i].desc, error)) return false;
  }
  return true;
}

bool render_cartoon_surface_resize(RenderCartoonSurface *surface, const RenderPicture *picture, int32_t scale,
                                   RenderError *error) {
  const int32_t width = (picture->width + scale - 1) / scale, height = (picture->height + scale - 1) / scale;
  surface->scale = scale;
  for (int k = 0; k < RENDER_CARTOON_LAYERS; ++k) {
    if (!resize_layer(&surface->layer[k], width, height, error)) return false;
    render_cartoon_surface_clear(surface, k);
  }
  return true;
}

static void destroy_layer(RenderCartoonLayer *layer) {
  GpuTexture *const textures[] = {&layer->raw, &layer->map[0], &layer->map[1], &layer->surface};
  GpuTarget *const targets[] = {&layer->raw_target, &layer->map_target[0], &layer->map_target[1],
                                &layer->surface_target};
  for (size_t i = 0; i < sizeof textures / sizeof textures[0]; ++i) gpu_texture_destroy(textures[i]);
  for (size_t i = 0; i < sizeof targets / sizeof targets[0]; ++i) gpu_target_destroy(targets[i]);
}

void render_cartoon_surface_destroy(RenderCartoonSurface *surface) {
  GpuProgram *const programs[] = {&surface->depth_program[0], &surface->depth_program[1], &surface->tidy_program[0],
                                  &surface->tidy_program[1],  &surface->row_program,      &surface->column_program,
                                  &surface->full_program,     &surface->flow_program,     &surface->normal_program};
  for (size_t i = 0; i < sizeof programs / sizeof programs[0]; ++i) gpu_program_destroy(programs[i]);
  for (int k = 0; k < RENDER_CARTOON_LAYERS; ++k) destroy_layer(&surface->layer[k]);
}

void render_cartoon_surface_clear(RenderCartoonSurface *surface, int index) {
  RenderCartoonLayer *layer = &surface->layer[index];
  const float nothing[4] = {0};
  gpu_clear_colour(&layer->raw_target, 0, nothing);
  gpu_clear_colour(&layer->map_target[0], 0, nothing);
  gpu_clear_colour(&layer->map_target[1], 0, nothing);
  gpu_clear_colour(&layer->surface_target, 0, nothing);
  layer->smoothed = 0;
}

// ---- Passes ----------------------------------------------------------------------------------------------------------

// Of a frame whose radius makes no sense, any will do that divides.
static float radius_of(const RenderPicture *picture) {
  const float r = picture->frame->particle_radius;
  return r > 1e-6f && r < RENDER_FARTHEST ? r : 1e-6f;
}

// One pass over the maps of a layer; `pass` lacks their scale.
static bool map_pass(const RenderCartoonSurface *surface, RenderPicture *picture, RenderTilePass pass,
                     const char *more_defines, RenderError *error) {
  char defines[96];
  snprintf(defines, sizeof defines, "#define SCALE %d\n%s", (int)surface->scale, more_defines);
  pass.desc.label = pass.desc.file;
  pass.desc.defines = defines;
  pass.scale = surface->scale;
  return render_tile_pass(picture, &pass, error);
}

bool render_cartoon_surface_depths(RenderCartoonSurface *surface, RenderPicture *picture,
                                   const RenderQuadrics *quadrics, int index, RenderError *error) {
  RenderCartoonLayer *layer = &surface->layer[index];
  const RenderQuadricPass draw = {.kind = index == RENDER_BODY ? RENDER_ELLIPSOIDS : RENDER_BALLS,
                                  .surface = RENDER_DEPTHS,
                                  .program = &surface->depth_program[index],
                                  .out = &layer->raw_target};
  // The Gaussian is as wide as makes scallops of a spacing, two radii, vanish.
  const bool drops = index == RENDER_DROPS;
  const float r = radius_of(picture), params[4] = {0.9f * r, (drops ? 30 : 3) * r, 4 * r};
  char defines[64];
  snprintf(defines, sizeof defines, "%s%s", drops ? "#define DROPS 1\n" : "",
           picture->obstacles.count > 0 && !drops ? "#define BODIES 1\n" : "");
  render_cartoon_surface_clear(surface, index);
  return render_quadrics_draw(picture, quadrics, &draw, error) &&
         map_pass(surface, picture,
                  (RenderTilePass){.program = &surface->tidy_program[index],
                                   .desc.file = "cartoon_tidy.glsl",
                                   .target = &layer->map_target[0],
                                   .out = {&layer->map[0]},
                                   .in = {.textures = {&layer->raw, &picture->background.colour},
                                          .params = params,
                                          .params_size = sizeof params}},
                  defines, error);
}

// std140 block of cartoon_bilateral.glsl and, of its first half, cartoon_flow.glsl
typedef struct FilterParams {
  float window[4], slope[4];
} FilterParams;

// One pass of a filter, from one map into the other.
static bool filter(RenderCartoonSurface *surface, RenderPicture *picture, int index, GpuProgram *program,
                   const char *file, const char *defines, const FilterParams *params, RenderError *error) {
  RenderCartoonLayer *layer = &surface->layer[index];
  const int from = layer->smoothed, to = 1 - from;
  layer->smoothed = to;
  return map_pass(
      surface, picture,
      (RenderTilePass){.program = program,
                       .desc.file = file,
                       .target = &layer->map_target[to],
                       .out = {&layer->map[to]},
                       .in = {.textures = {&layer->map[from]}, .params = params, .params_size = sizeof *params}},
      defines, error);
}

// Drops are too small and too round for planes.
static bool fits_planes(const RenderCartoon *settings, int index) {
  return settings->smoothing == RENDER_CARTOON_BILATERAL && settings->fitted && index == RENDER_BODY;
}

// Over the full kernel, or along rows and then along columns.
static bool bilateral(RenderCartoonSurface *surface, RenderPicture *picture, int index, const FilterParams *params,
                      RenderError *error) {
  static const char file[] = "cartoon_bilateral.glsl";
  const RenderCartoon *settings = &picture->settings->cartoon;
  const char *fitted = fits_planes(settings, index) ? "#define FITTED 1\n" : "";
  char along[2][64];
  for (int k = 0; k < 2; ++k) snprintf(along[k], sizeof along[k], "%s#define STEP ivec2(%d, %d)\n", fitted, !k, k);
  if (!settings->separated) {
    return filter(surface, picture, index, &surface->full_program, file, fitted, params, error);
  }
  return filter(surface, picture, index, &surface->row_program, file, along[0], params, error) &&
         filter(surface, picture, index, &surface->column_program, file, along[1], params, error);
}

// Pixels of the maps that a metre covers where the water is nearest to the eye.
static float largest_metre(const RenderCartoonSurface *surface, const RenderPicture *picture,
                           const RenderQuadrics *quadrics) {
  const float per_metre = (float)picture->height / (2 * picture->block.lens[1] * (float)surface->scale);
  return per_metre / render_quadrics_nearest(quadrics, picture);
}

#define SLOPE 2.5f // by which taps may differ while no plane is known yet

static bool fixed_bilateral(RenderCartoonSurface *surface, RenderPicture *picture, int index, RenderError *error) {
  const RenderCartoon *settings = &picture->settings->cartoon;
  const FilterParams params = {{(float)settings->kernel / 2, 0, 32, settings->range * radius_of(picture)}, {SLOPE}};
  return bilateral(surface, picture, index, &params, error);
}

// The adaptive kernel. The particles' bumps go first, so that the taps of the wide kernel, which lie apart, do not miss any.
// Then ever narrower kernels remove what the gaps between those taps leave, until none lie apart even where the water is
// nearest.
static bool adaptive_bilateral(RenderCartoonSurface *surface, RenderPicture *picture, const RenderQuadrics *quadrics,
                               int index, float reach, RenderError *error) {
  enum { TAPS = 5, MOST_FINE_PASSES = 6 };
  const float r = radius_of(picture), narrower = 0.3f;
  // Drops are one piece, however they lie.
  const float range = (index == RENDER_DROPS ? 5 : 1) * picture->settings->cartoon.range * r;
  const float apart = 1.5f * TAPS / largest_metre(surface, picture, quadrics); // half of a kernel whose taps do
  float half = reach * r;
  FilterParams params = {{0, narrower * half, TAPS, range}, {SLOPE}};
  if (!bilateral(surface, picture, index, &params, error)) return false;
  params.slope[0] = 0;
  for (int i = 0; i < 2 + MOST_FINE_PASSES; ++i) {
    params.window[1] = half;
    params.slope[1] = i > 0;
    if (!bilateral(surface, picture, index, &params, error)) return false;
    if (half <= apart) break;
    half *= narrower;
  }
  return true;
}

static bool curvature_flow(RenderCartoonSurface *surface, RenderPicture *picture, const RenderQuadrics *quadrics,
                           int index, float reach, RenderError *error) {
  enum { MOST_STEPS = 200 };
  const float r = radius_of(picture), step = 0.2f;
  const FilterParams params = {{step, 3 * r}, {0}};
  const float sigma = reach * r * largest_metre(surface, picture, quadrics) / 3;
  const float wanted = sigma * sigma / (2 * step);
  const int steps = wanted < MOST_STEPS ? (int)ceilf(wanted) : MOST_STEPS;
  for (int i = 0; i < steps; ++i) {
    if (!filter(surface, picture, index, &surface->flow_program, "cartoon_flow.glsl", "", &params, error)) return false;
  }
  return true;
}

bool render_cartoon_surface_smooth(RenderCartoonSurface *surface, RenderPicture *picture,
                                   const RenderQuadrics *quadrics, int index, RenderError *error) {
  const RenderCartoon *settings = &picture->settings->cartoon;
  // Drops are small: of what smooths a body of water, little is left of them.
  const float reach = index == RENDER_BODY ? settings->reach : 0.3f * settings->reach;
  switch (settings->smoothing) {
  case RENDER_CARTOON_BILATERAL:
    return settings->kernel > 0 ? fixed_bilateral(surface, picture, index, error)
                                : adaptive_bilateral(surface, picture, quadrics, index, reach, error);
  case RENDER_CARTOON_CURVATURE:
    return curvature_flow(surface, picture, quadrics, index, reach, error);
  case RENDER_CARTOON_NONE:
    break;
  }
  return true;
}

bool render_cartoon_surface_normals(RenderCartoonSurface *surface, RenderPicture *picture, int index,
                                    RenderError *error) {
  RenderCartoonLayer *layer = &surface->layer[index];
  const bool fitted = fits_planes(&picture->settings->cartoon, index);
  const float bend[4] = {radius_of(picture)};
  return map_pass(
      surface, picture,
      (RenderTilePass){.program = &surface->normal_program,
                       .desc.file = "cartoon_normals.glsl",
                       .target = &layer->surface_target,
                       .out = {&layer->surface},
                       .in = {.textures = {&layer->map[layer->smoothed]}, .params = bend, .params_size = sizeof bend}},
      fitted ? "#define FITTED 1\n" : "", error);
}
