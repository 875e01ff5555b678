#include "render/water_surface.h"

#include "render/scene_rays.h"

#include <stdio.h>

bool render_water_surface_resize(RenderWaterSurface *surface, int32_t width, int32_t height, RenderError *error) {
  const struct {
    GpuTexture *texture;
    GpuTextureDesc desc;
  } textures[] = {{&surface->raw, {"water: raw depths", width, height, GPU_RG32F, false}},
                  {&surface->inverse[0], {"water: inverse depths", width, height, GPU_RG32F, false}},
                  {&surface->inverse[1], {"water: inverse depths, other", width, height, GPU_RG32F, false}},
                  {&surface->front, {"water: front", width, height, GPU_RGBA32F, true}},
                  {&surface->back, {"water: back", width, height, GPU_RGBA32F, true}}};
  for (size_t i = 0; i < sizeof textures / sizeof textures[0]; ++i) {
    if (!gpu_texture_create(textures[i].texture, &textures[i].desc, error)) return false;
  }
  const GpuTargetDesc raw = {"water: raw depths", {&surface->raw}, NULL};
  const GpuTargetDesc one = {"water: inverse depths", {&surface->inverse[0]}, NULL};
  const GpuTargetDesc other = {"water: inverse depths, other", {&surface->inverse[1]}, NULL};
  const GpuTargetDesc both = {"water: surface", {&surface->front, &surface->back}, NULL};
  return gpu_target_create(&surface->raw_target, &raw, error) &&
         gpu_target_create(&surface->inverse_target[0], &one, error) &&
         gpu_target_create(&surface->inverse_target[1], &other, error) &&
         gpu_target_create(&surface->surface_target, &both, error);
}

void render_water_surface_destroy(RenderWaterSurface *surface) {
  GpuProgram *const programs[] = {&surface->air_program,          &surface->depth_program,
                                  &surface->gather_program,       &surface->clip_program,
                                  &surface->smoothing_program[0], &surface->smoothing_program[1],
                                  &surface->normal_program[0],    &surface->normal_program[1],
                                  &surface->quadric_program[0],   &surface->quadric_program[1]};
  GpuTexture *const textures[] = {&surface->air,           &surface->raw,           &surface->inverse[0],
                                  &surface->inverse[1],    &surface->front,         &surface->back,
                                  &surface->raw_normal[0], &surface->raw_normal[1], &surface->raw_depth};
  for (size_t i = 0; i < sizeof programs / sizeof programs[0]; ++i) gpu_program_destroy(programs[i]);
  for (size_t i = 0; i < sizeof textures / sizeof textures[0]; ++i) gpu_texture_destroy(textures[i]);
  gpu_target_destroy(&surface->air_target);
  gpu_target_destroy(&surface->raw_target);
  gpu_target_destroy(&surface->inverse_target[0]);
  gpu_target_destroy(&surface->inverse_target[1]);
  gpu_target_destroy(&surface->surface_target);
  gpu_target_destroy(&surface->raw_normal_target[0]);
  gpu_target_destroy(&surface->raw_normal_target[1]);
}

// Of a frame whose radius makes no sense, any will do that divides.
static float radius_of(const RenderPicture *picture) {
  const float r = picture->frame->particle_radius;
  return r > 1e-6f && r < RENDER_FARTHEST ? r : 1e-6f;
}

// ---- Depths ----------------------------------------------------------------------------------------------------------

static bool create_air(RenderWaterSurface *surface, const RenderPicture *picture, RenderError *error) {
  if (surface->air_target.id != 0) return true;
  const GpuTextureDesc desc = {"water: air", picture->width, picture->height, GPU_R32F, false};
  const GpuTargetDesc target = {"water: air", {&surface->air}, NULL};
  return gpu_texture_create(&surface->air, &desc, error) && gpu_target_create(&surface->air_target, &target, error);
}

// Output: where the air begins for an eye in the water.
static bool find_air(RenderWaterSurface *surface, RenderPicture *picture, const RenderOccupancy *around,
                     RenderError *error) {
  if (!create_air(surface, picture, error)) return false;
  const RenderOccupancyBlock block = render_occupancy_block(around);
  return render_tile_pass(
      picture,
      &(RenderTilePass){.program = &surface->air_program,
                        .desc = {"where the air begins", "water_air.glsl"},
                        .target = &surface->air_target,
                        .out = {&surface->air},
                        .in = {.storage = {[1] = &around->bits}, .params = &block, .params_size = sizeof block}},
      error);
}

bool render_water_surface_depths(RenderWaterSurface *surface, RenderPicture *picture, const RenderQuadrics *quadrics,
                                 const RenderOccupancy *around, RenderError *error) {
  // Passes leave tiles without water alone.
  const float nothing[4] = {0};
  gpu_clear_colour(&surface->inverse_target[0], 0, nothing);
  gpu_clear_colour(&surface->inverse_target[1], 0, nothing);
  gpu_clear_colour(&surface->surface_target, 0, nothing);
  gpu_clear_colour(&surface->surface_target, 1, nothing);
  surface->submerged = around != NULL;
  surface->smoothed = surface->uncut = 0;
  render_quadrics_clear(RENDER_DEPTHS, &surface->raw_target);
  if (surface->submerged && !find_air(surface, picture, around, error)) return false;
  const RenderQuadricPass pass = {.kind = RENDER_ELLIPSOIDS,
                                  .surface = RENDER_DEPTHS,
                                  .air = surface->submerged ? &surface->air : NULL,
                                  .program = &surface->depth_program,
                                  .out = &surface->raw_target};
  return render_quadrics_draw(picture, quadrics, &pass, error) &&
         render_tile_pass(picture,
                          &(RenderTilePass){.program = &surface->gather_program,
                                            .desc = {"gather depths", "water_gather.glsl"},
                                            .target = &surface->inverse_target[0],
                                            .out = {&surface->inverse[0]},
                                            .in.textures = {&surface->raw}},
                          error);
}

// ---- Analytic normals ------------------------------------------------------------------------------------------------

static bool create_raw_normals(RenderWaterSurface *surface, const RenderPicture *picture, RenderError *error) {
  if (surface->raw_normal_target[RENDER_BACK].id != 0) return true;
  const GpuTextureDesc depth = {"water: depth of analytic normals", picture->width, picture->height, GPU_DEPTH32F,
                                false};
  if (!gpu_texture_create(&surface->raw_depth, &depth, error)) return false;
  for (int side = RENDER_FRONT; side <= RENDER_BACK; ++side) {
    GpuTexture *texture = &surface->raw_normal[side];
    const GpuTextureDesc desc = {"water: analytic normals", picture->width, picture->height, GPU_RGBA32F, false};
    const GpuTargetDesc target = {"water: analytic normals", {texture}, &surface->raw_depth};
    if (!gpu_texture_create(texture, &desc, error) ||
        !gpu_target_create(&surface->raw_normal_target[side], &target, error))
      return false;
  }
  return true;
}

static bool draw_raw_normals(RenderWaterSurface *surface, RenderPicture *picture, const RenderQuadrics *quadrics,
                             RenderError *error) {
  for (int side = RENDER_FRONT; side <= RENDER_BACK; ++side) {
    render_quadrics_clear((RenderQuadricSurface)side, &surface->raw_normal_target[side]);
    const RenderQuadricPass pass = {.kind = RENDER_ELLIPSOIDS,
                                    .surface = (RenderQuadricSurface)side,
                                    .air = surface->submerged ? &surface->air : NULL,
                                    .program = &surface->quadric_program[side],
                                    .out = &surface->raw_normal_target[side]};
    if (!render_quadrics_draw(picture, quadrics, &pass, error)) return false;
  }
  return true;
}

// Output: front and back, with the particles' own normals if `analytic`.
static bool write_normals(RenderWaterSurface *surface, RenderPicture *picture, bool analytic, RenderError *error) {
  const float bend[4] = {radius_of(picture)};
  char defines[64];
  snprintf(defines, sizeof defines, "%s%s", render_container_define(picture->frame),
           analytic ? "#define ANALYTIC 1\n" : "");
  RenderTilePass pass = {
      .program = &surface->normal_program[analytic],
      .desc = {"water normals", "water_normals.glsl", defines},
      .target = &surface->surface_target,
      .out = {&surface->front, &surface->back},
      .in = {.textures = {[0] = &surface->inverse[surface->smoothed], [3] = &surface->inverse[surface->uncut]},
             .params = bend,
             .params_size = sizeof bend}};
  if (analytic) {
    pass.in.textures[1] = &surface->raw_normal[RENDER_FRONT];
    pass.in.textures[2] = &surface->raw_normal[RENDER_BACK];
  }
  return render_tile_pass(picture, &pass, error);
}

// ---- Smoothing -------------------------------------------------------------------------------------------------------

// One pass of a filter, from one map of inverse depths into the other. params: see smoothing.glsl.
static bool filter(RenderWaterSurface *surface, RenderPicture *picture, int program_index, const char *file,
                   const char *defines, const float params[4], RenderError *error) {
  const int from = surface->smoothed, to = 1 - from;
  surface->smoothed = to;
  return render_tile_pass(
      picture,
      &(RenderTilePass){.program = &surface->smoothing_program[program_index],
                        .desc = {file, file, defines},
                        .target = &surface->inverse_target[to],
                        .out = {&surface->inverse[to]},
                        .in = {.textures = {&surface->inverse[from], &surface->front, &surface->back},
                               .params = params,
                               .params_size = 4 * sizeof(float)}},
      error);
}

static bool rows_and_columns(RenderWaterSurface *surface, RenderPicture *picture, const char *file,
                             const float params[4], RenderError *error) {
  return filter(surface, picture, 0, file, "#define STEP ivec2(1, 0)\n", params, error) &&
         filter(surface, picture, 1, file, "#define STEP ivec2(0, 1)\n", params, error);
}

// Pixels that a radius covers where the water is nearest to the eye.
static float largest_radius(const RenderPicture *picture, const RenderQuadrics *quadrics) {
  const float per_metre = (float)picture->height / (2 * picture->block.lens[1]); // at a depth of 1 m
  return radius_of(picture) / render_quadrics_nearest(quadrics, picture) * per_metre;
}

// Wide windows first: their taps lie apart, and what aliasing that leaves the narrow ones remove. 62 taps; chosen by
// tests/render/smoothing_quality.
//
// Near the eye even the last step's taps lie so far apart that one sees it: there are twice as many taps, and finer steps
// follow until none lie apart.
static bool smooth_regression(RenderWaterSurface *surface, RenderPicture *picture, const RenderQuadrics *quadrics,
                              RenderError *error) {
  static const struct {
    float taps, reach; // on either side; half of the window, radii
  } steps[] = {{5, 4.5f}, {5, 2}, {4, 0.8f}};
  enum { STEPS = sizeof steps / sizeof steps[0], MOST_FINE_STEPS = 6 };
  static const char file[] = "smooth_regression.glsl";
  const float r = radius_of(picture), range = 7 * r, pixels = largest_radius(picture, quadrics);
  const float taps = steps[STEPS - 1].taps, apart = 1.5f * (taps + 0.5f); // half of a window whose taps do
  float reach = steps[STEPS - 1].reach;
  const bool near = reach * pixels > apart;
  for (int i = 0; i < STEPS; ++i) {
    const float params[4] = {near ? 2 * steps[i].taps : steps[i].taps, steps[i].reach * r, range, 0};
    if (!rows_and_columns(surface, picture, file, params, error)) return false;
  }
  for (int i = 0; i < MOST_FINE_STEPS && reach * pixels > apart; ++i) {
    reach *= 2 / (taps + 0.5f);
    const float params[4] = {taps, reach * r, range, 1.5f};
    if (!rows_and_columns(surface, picture, file, params, error)) return false;
  }
  return true;
}

static bool smooth_narrow_range(RenderWaterSurface *surface, RenderPicture *picture, RenderError *error) {
  // Truong & Yuksel's own values are in metres of their scenes; these are what their figures show, in radii.
  const float r = radius_of(picture);
  const float along[4] = {9, 7 * r, 4 * r, 1 * r}, around[4] = {2, 0, 4 * r, 1 * r};
  for (int32_t i = 0; i < picture->settings->refraction.iterations; ++i) {
    if (!rows_and_columns(surface, picture, "smooth_narrow_range.glsl", along, error)) return false;
  }
  return filter(surface, picture, 0, "smooth_narrow_range.glsl", "", around, error);
}

// The filters with a window of two dimensions, iterated.
static bool smooth_square(RenderWaterSurface *surface, RenderPicture *picture, const char *file, const char *defines,
                          RenderError *error) {
  const float r = radius_of(picture);
  const int32_t half = picture->settings->refraction.window / 2;
  const float params[4] = {(float)half, picture->settings->refraction.reach * r,
                           picture->settings->refraction.sigma * r, 0};
  for (int32_t i = 0; i < picture->settings->refraction.iterations; ++i) {
    if (!filter(surface, picture, 0, file, defines, params, error)) return false;
  }
  return true;
}

static bool smooth(RenderWaterSurface *surface, RenderPicture *picture, const RenderQuadrics *quadrics,
                   RenderError *error) {
  switch (picture->settings->refraction.smoothing) {
  case RENDER_SMOOTHING_REGRESSION:
    return smooth_regression(surface, picture, quadrics, error);
  case RENDER_SMOOTHING_NARROW_RANGE:
    return smooth_narrow_range(surface, picture, error);
  case RENDER_SMOOTHING_BILATERAL:
    return smooth_square(surface, picture, "smooth_bilateral.glsl", "", error);
  case RENDER_SMOOTHING_PLANE_FIT:
    return smooth_square(surface, picture, "smooth_plane_fit.glsl",
                         picture->settings->refraction.view_dependent ? "" : "#define VIEW_INDEPENDENT 1\n", error);
  case RENDER_SMOOTHING_NONE:
    break;
  }
  return true;
}

// ---- Walls -----------------------------------------------------------------------------------------------------------

static bool clip(RenderWaterSurface *surface, RenderPicture *picture, RenderError *error) {
  char defines[64];
  snprintf(defines, sizeof defines, "%s%s", render_container_define(picture->frame),
           surface->submerged ? "#define SUBMERGED 1\n" : "");
  surface->uncut = surface->smoothed;
  if (defines[0] == '\0') return true;
  const int from = surface->smoothed, to = 1 - from;
  surface->smoothed = to;
  return render_tile_pass(picture,
                          &(RenderTilePass){.program = &surface->clip_program,
                                            .desc = {"clip water", "water_clip.glsl", defines},
                                            .target = &surface->inverse_target[to],
                                            .out = {&surface->inverse[to]},
                                            .in.textures = {&surface->inverse[from]}},
                          error);
}

// ---- Everything ------------------------------------------------------------------------------------------------------

bool render_water_surface_smooth(RenderWaterSurface *surface, RenderPicture *picture, const RenderQuadrics *quadrics,
                                 RenderError *error) {
  const RenderSmoothing smoothing = picture->settings->refraction.smoothing;
  const bool own_normals = smoothing == RENDER_SMOOTHING_PLANE_FIT || smoothing == RENDER_SMOOTHING_NONE;
  return (!own_normals ||
          (create_raw_normals(surface, picture, error) && draw_raw_normals(surface, picture, quadrics, error))) &&
         (smoothing != RENDER_SMOOTHING_PLANE_FIT || write_normals(surface, picture, true, error)) &&
         smooth(surface, picture, quadrics, error) && clip(surface, picture, error);
}

bool render_water_surface_normals(RenderWaterSurface *surface, RenderPicture *picture, RenderError *error) {
  return write_normals(surface, picture, picture->settings->refraction.smoothing == RENDER_SMOOTHING_NONE, error);
}
