// The style "points": every particle a small sphere of water. The shortest complete style, and the one to copy.
//
// A style is one file like this one, one shader file and one row in style_table.c. Its state lists programs and targets
// in the order of the passes; draw runs them in that order; every pass names what it reads and what it writes.
#include "render/splat.h"
#include "render/style.h"

#include <stddef.h>

typedef struct Points {
  // splat: the nearest sphere of every pixel
  GpuProgram splat_program;
  GpuTexture surface; // outward normal, depth along the view axis (m); 0 where there is no water
  GpuTexture tint;    // colour of the particle, spray
  GpuTarget surface_target;
  // thickness: metres of water along every pixel's ray, at half resolution
  GpuProgram thickness_program;
  GpuTexture thickness;
  GpuTarget thickness_target;
  // shade: all of it in one picture
  GpuProgram shade_program;
} Points;

static const RenderLayer layers[] = {
    {"depth", "metres along the view axis to the water, 0 where there is none", RENDER_MAP_DEPTH,
     offsetof(Points, surface), 3, 1, 0},
    {"normal", "outward unit normal of the water in world axes, 0 where there is none", RENDER_MAP_NORMAL,
     offsetof(Points, surface), 0, 3, 0},
    {"thickness", "metres of water along the ray", RENDER_MAP_SCALAR, offsetof(Points, thickness), 0, 1, 2},
    {"spray", "0 water to 1 froth", RENDER_MAP_SCALAR, offsetof(Points, tint), 3, 1, 1},
};

static bool points_resize(void *state, const RenderPicture *picture, RenderError *error) {
  Points *points = state;
  const int32_t width = picture->width, height = picture->height;
  const GpuTextureDesc surface = {"points: surface", width, height, GPU_RGBA32F, false};
  const GpuTextureDesc tint = {"points: tint", width, height, GPU_RGBA8, false};
  const GpuTextureDesc thickness = {"points: thickness", (width + 1) / 2, (height + 1) / 2, GPU_R32F, true};
  if (!gpu_texture_create(&points->surface, &surface, error) || !gpu_texture_create(&points->tint, &tint, error) ||
      !gpu_texture_create(&points->thickness, &thickness, error)) {
    return false;
  }
  const GpuTargetDesc surface_target = {"points: surface", {&points->surface, &points->tint}, &picture->depth};
  const GpuTargetDesc thickness_target = {"points: thickness", {&points->thickness}, NULL};
  return gpu_target_create(&points->surface_target, &surface_target, error) &&
         gpu_target_create(&points->thickness_target, &thickness_target, error);
}

static void points_destroy(void *state) {
  Points *points = state;
  gpu_program_destroy(&points->splat_program);
  gpu_texture_destroy(&points->surface);
  gpu_texture_destroy(&points->tint);
  gpu_target_destroy(&points->surface_target);
  gpu_program_destroy(&points->thickness_program);
  gpu_texture_destroy(&points->thickness);
  gpu_target_destroy(&points->thickness_target);
  gpu_program_destroy(&points->shade_program);
}

static bool shade(Points *points, RenderPicture *picture, RenderError *error) {
  const GpuProgramDesc desc = {.label = "points: shade", .file = "points.glsl", .defines = picture->defines};
  const RenderTiles *tiles = &picture->tiles;
  if (!gpu_program_prepare(&points->shade_program, &desc, error)) return false;
  gpu_draw(picture->gpu, &(GpuDraw){
                             .program = &points->shade_program,
                             .target = &picture->target,
                             .vertices = 6 * tiles->columns * tiles->rows,
                             .in = {.textures = {&points->surface, &points->tint, &points->thickness,
                                                 &picture->background.colour, [5] = &picture->sun_map.normal,
                                                 [6] = &picture->sun_map.water, [7] = &picture->sun_map.solid},
                                    .storage = {[7] = &tiles->mask},
                                    .frame = &picture->uniforms},
                         });
  return true;
}

static bool points_draw(void *state, RenderPicture *picture, RenderError *error) {
  Points *points = state;
  const float scale = picture->settings->points.scale;

  gpu_pass_begin(picture->gpu, "splat");
  const RenderTileMarks marks = {&picture->particles.spheres, picture->particles.count, 1, scale};
  bool ok = render_tiles_clear(picture, error) && render_tiles_mark(picture, &marks, error) &&
            render_splat_surface(picture, &points->splat_program, scale, &points->surface_target, error);
  gpu_pass_end(picture->gpu);

  gpu_pass_begin(picture->gpu, "thickness");
  ok = ok && render_splat_thickness(picture, &points->thickness_program, scale, &points->thickness_target, error);
  gpu_pass_end(picture->gpu);

  gpu_pass_begin(picture->gpu, "shade");
  ok = ok && shade(points, picture, error);
  gpu_pass_end(picture->gpu);
  return ok;
}

const RenderStyle style_points = {
    .name = "points",
    .summary = "every particle a ray-cast sphere of water",
    .needs = SIM_NEED_DENSITY, // of the spray
    .state_size = sizeof(Points),
    .layers = layers,
    .layer_count = sizeof layers / sizeof layers[0],
    .resize = points_resize,
    .draw = points_draw,
    .destroy = points_destroy,
};
