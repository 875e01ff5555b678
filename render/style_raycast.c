// The style "raycast": Xiao, Zhang, Yang, "Real-Time High-Quality Surface Rendering for Large Scale Particle-based Fluids",
// 2017.
//
// Rays are cast at the iso-surface of the particles' density field (section 3.2), from where the particles begin (section
// 3.1). Normals come from the particles around it: the field's gradient and the direction in which the particles vary
// least, blended, and filtered over the picture (section 3.3). Cost follows the size of the picture.
//
// Beyond the paper: all stretches of a ray that have particles near them, not only the first; strides as long as the field's
// curvature allows; water that lies on walls; a refracted ray that meets the scene's geometry; an eye in the water.
#include "render/neighbour_grid.h"
#include "render/scene_rays.h"
#include "render/splat.h"
#include "render/style.h"

#include <stddef.h>
#include <stdio.h>

typedef struct Raycast {
  RenderNeighbourGrid grid;
  GpuProgram entry_program;
  GpuTexture entries; // slices of depth in which there are particles, as bits; a quarter of the resolution
  GpuTarget entry_target;
  GpuProgram surface_program;
  GpuTexture surface; // depth (m), negative where the ray comes out of the water, 0: there is none
  GpuTarget surface_target;
  GpuProgram normal_program;
  GpuTexture normal, colour; // outward unit normal in world axes, depth (m); colour, linear, alpha 0 on a wall
  GpuTarget normal_target;
  GpuProgram filter_program;
  GpuTexture filtered; // normal and depth, smoothed
  GpuTarget filter_target;
  GpuProgram behind_program;
  GpuTexture
      behind; // metres of water behind a surface on the bent ray where they are few, negative: mirrored; its depth; half the resolution
  GpuTarget behind_target;
  GpuProgram thickness_program;
  GpuTexture thickness; // metres of water along the ray, half the resolution
  GpuTarget thickness_target;
  GpuProgram light_program;
} Raycast;

static const RenderLayer layers[] = {
    {"depth", "metres along the view axis to the iso-surface, 0 where there is none", RENDER_MAP_DEPTH,
     offsetof(Raycast, surface), 0, 1, 0},
    {"normal", "outward unit normal of the water in world axes, 0 where there is none", RENDER_MAP_NORMAL,
     offsetof(Raycast, filtered), 0, 3, 0},
    {"raw_normal", "the same before the bilateral filter", RENDER_MAP_NORMAL, offsetof(Raycast, normal), 0, 3, 0},
    {"colour", "colour of the water at the surface, linear", RENDER_MAP_COLOUR, offsetof(Raycast, colour), 0, 3, 0},
    {"behind", "metres of water behind the surface where they are few", RENDER_MAP_SCALAR, offsetof(Raycast, behind), 0,
     1, 2},
    {"thickness", "metres of water along the ray, of all bodies", RENDER_MAP_SCALAR, offsetof(Raycast, thickness), 0, 1,
     2},
};

#define ENTRY_SCALE 4 // pixels across a texel of the entries, also in raycast_surface.glsl

// ---- Making and unmaking ---------------------------------------------------------------------------------------------

static bool raycast_resize(void *state, const RenderPicture *picture, RenderError *error) {
  Raycast *s = state;
  const int32_t width = picture->width, height = picture->height;
  const struct {
    GpuTexture *texture;
    GpuTextureDesc desc;
  } textures[] = {{&s->entries,
                   {"raycast: entries", (width + ENTRY_SCALE - 1) / ENTRY_SCALE,
                    (height + ENTRY_SCALE - 1) / ENTRY_SCALE, GPU_RGBA32UI, false}},
                  {&s->surface, {"raycast: surface", width, height, GPU_R32F, false}},
                  {&s->normal, {"raycast: normal", width, height, GPU_RGBA32F, false}},
                  {&s->colour, {"raycast: colour", width, height, GPU_RGBA32F, false}},
                  {&s->filtered, {"raycast: filtered normal", width, height, GPU_RGBA32F, false}},
                  {&s->behind, {"raycast: behind", (width + 1) / 2, (height + 1) / 2, GPU_RG32F, false}},
                  {&s->thickness, {"raycast: thickness", (width + 1) / 2, (height + 1) / 2, GPU_R32F, true}}};
  for (size_t i = 0; i < sizeof textures / sizeof textures[0]; ++i) {
    if (!gpu_texture_create(textures[i].texture, &textures[i].desc, error)) return false;
  }
  const struct {
    GpuTarget *target;
    GpuTargetDesc desc;
  } targets[] = {{&s->entry_target, {"raycast: entries", {&s->entries}, NULL}},
                 {&s->surface_target, {"raycast: surface", {&s->surface}, NULL}},
                 {&s->normal_target, {"raycast: normal", {&s->normal, &s->colour}, NULL}},
                 {&s->filter_target, {"raycast: filtered normal", {&s->filtered}, NULL}},
                 {&s->behind_target, {"raycast: behind", {&s->behind}, NULL}},
                 {&s->thickness_target, {"raycast: thickness", {&s->thickness}, NULL}}};
  for (size_t i = 0; i < sizeof targets / sizeof targets[0]; ++i) {
    if (!gpu_target_create(targets[i].target, &targets[i].desc, error)) return false;
  }
  return true;
}

static void raycast_destroy(void *state) {
  Raycast *s = state;
  GpuProgram *const programs[] = {&s->entry_program,  &s->surface_program,   &s->normal_program, &s->filter_program,
                                  &s->behind_program, &s->thickness_program, &s->light_program};
  GpuTexture *const textures[] = {&s->entries,  &s->surface, &s->normal,   &s->colour,
                                  &s->filtered, &s->behind,  &s->thickness};
  GpuTarget *const targets[] = {&s->entry_target,  &s->surface_target, &s->normal_target,
                                &s->filter_target, &s->behind_target,  &s->thickness_target};
  render_neighbour_grid_destroy(&s->grid);
  for (size_t i = 0; i < sizeof programs / sizeof programs[0]; ++i) gpu_program_destroy(programs[i]);
  for (size_t i = 0; i < sizeof textures / sizeof textures[0]; ++i) gpu_texture_destroy(textures[i]);
  for (size_t i = 0; i < sizeof targets / sizeof targets[0]; ++i) gpu_target_destroy(targets[i]);
}

// ---- Passes ----------------------------------------------------------------------------------------------------------

// std140 block of raycast_field.glsl
typedef struct FieldParams {
  RenderGridBlock grid;
  float field[4], blend[4];
} FieldParams;

static FieldParams field_params(const RenderPicture *picture) {
  const RenderRaycast *settings = &picture->settings->raycast;
  const float r = picture->frame->particle_radius;
  return (FieldParams){
      render_grid_block(picture->frame),
      {settings->support * r, settings->iso, 2 * r, settings->normal_reach * r},
      {settings->blend_d, settings->blend_k, settings->blend_weight, picture->settings->refractive_index}};
}

static bool find_entries(Raycast *s, RenderPicture *picture, RenderError *error) {
  FieldParams params = field_params(picture);
  params.blend[0] = (float)s->entries.width;
  params.blend[1] = (float)s->entries.height;
  const GpuProgramDesc desc = {.label = "raycast: entries", .file = "raycast_entry.glsl"};
  if (!gpu_program_prepare(&s->entry_program, &desc, error)) return false;
  gpu_clear_bits(&s->entry_target, 0);
  const int32_t most = INT32_MAX / 6; // or their vertices could not be counted
  if (picture->particles.count > most) return gpu_fail(error, "more than %d particles cannot be drawn", most);
  gpu_draw(picture->gpu, &(GpuDraw){.program = &s->entry_program,
                                    .target = &s->entry_target,
                                    .vertices = 6 * picture->particles.count,
                                    .blend = GPU_BLEND_OR,
                                    .in = {.views = {&picture->particles.spheres},
                                           .frame = &picture->uniforms,
                                           .params = &params,
                                           .params_size = sizeof params}});
  return true;
}

static bool cast_rays(Raycast *s, RenderPicture *picture, RenderError *error) {
  const FieldParams params = field_params(picture);
  const float nothing[4] = {0};
  gpu_clear_colour(&s->surface_target, 0, nothing);
  return render_tile_pass(
      picture,
      &(RenderTilePass){.program = &s->surface_program,
                        .desc = {"raycast: surface", "raycast_surface.glsl", render_container_define(picture->frame)},
                        .target = &s->surface_target,
                        .out = {&s->surface},
                        .in = {.textures = {&s->entries, &picture->background.colour},
                               .views = {&picture->particles.spheres, &s->grid.cell_start},
                               .params = &params,
                               .params_size = sizeof params}},
      error);
}

static bool find_normals(Raycast *s, RenderPicture *picture, RenderError *error) {
  FieldParams params = field_params(picture);
  const float nothing[4] = {0};
  const RenderNormals normals = picture->settings->raycast.normals;
  char defines[96];
  snprintf(defines, sizeof defines, "%s%s%s", render_container_define(picture->frame),
           normals == RENDER_NORMALS_GRADIENT ? "" : "#define PCA 1\n",
           picture->particles.tinted ? "#define TINTED 1\n" : "");
  if (normals == RENDER_NORMALS_PCA) params.blend[2] = 1;
  gpu_clear_colour(&s->normal_target, 0, nothing);
  gpu_clear_colour(&s->normal_target, 1, nothing);
  return render_tile_pass(
      picture,
      &(RenderTilePass){.program = &s->normal_program,
                        .desc = {"raycast: normals", "raycast_normals.glsl", defines},
                        .target = &s->normal_target,
                        .out = {&s->normal, &s->colour},
                        .in = {.textures = {&s->surface},
                               .views = {&picture->particles.spheres, &s->grid.cell_start, &picture->particles.colours},
                               .params = &params,
                               .params_size = sizeof params}},
      error);
}

static bool filter_normals(Raycast *s, RenderPicture *picture, RenderError *error) {
  const RenderRaycast *settings = &picture->settings->raycast;
  const float nothing[4] = {0};
  const float params[4] = {settings->filter_reach * picture->frame->particle_radius, 4, 0, settings->filter_angle};
  gpu_clear_colour(&s->filter_target, 0, nothing);
  if (settings->filter_reach == 0) {
    gpu_texture_copy(&s->normal, &s->filtered);
    return true;
  }
  return render_tile_pass(
      picture,
      &(RenderTilePass){.program = &s->filter_program,
                        .desc = {"raycast: filter", "raycast_filter.glsl"},
                        .target = &s->filter_target,
                        .out = {&s->filtered},
                        .in = {.textures = {&s->normal, &s->colour}, .params = params, .params_size = sizeof params}},
      error);
}

static bool follow_rays(Raycast *s, RenderPicture *picture, RenderError *error) {
  const FieldParams params = field_params(picture);
  const float nothing[4] = {0};
  gpu_clear_colour(&s->behind_target, 0, nothing);
  return render_tile_pass(
      picture,
      &(RenderTilePass){.program = &s->behind_program,
                        .desc = {"raycast: behind", "raycast_behind.glsl", render_container_define(picture->frame)},
                        .target = &s->behind_target,
                        .out = {&s->behind},
                        .in = {.textures = {&s->surface, &s->filtered},
                               .views = {&picture->particles.spheres, &s->grid.cell_start},
                               .params = &params,
                               .params_size = sizeof params},
                        .scale = 2},
      error);
}

// std140 block of raycast_light.glsl
typedef struct LightParams {
  RenderBodyEnds ends;
  float optics[4];
} LightParams;

// Water is in its container, whose top is open: an eye beside or below that is in the air.
static bool eye_may_be_within(const RenderPicture *picture) {
  const SimContainer *box = &picture->frame->container;
  const float *eye = picture->block.eye;
  if (render_container_define(picture->frame)[0] == '\0') return true;
  return eye[0] >= box->min[0] && eye[0] <= box->max[0] && eye[2] >= box->min[2] && eye[2] <= box->max[2] &&
         eye[1] >= box->min[1];
}

static bool draw_light(Raycast *s, RenderPicture *picture, RenderError *error) {
  char defines[sizeof picture->defines + 256];
  const float *mirrors = picture->settings->reflectance;
  const int used = render_scene_defines(picture, defines, sizeof defines);
  snprintf(defines + used, sizeof defines - (size_t)used, "%s%s%s", render_container_define(picture->frame),
           mirrors[0] > 0 || mirrors[1] > 0 || mirrors[2] > 0 ? "#define METAL 1\n" : "",
           eye_may_be_within(picture) ? "#define WITHIN 1\n" : "");
  const GpuProgramDesc desc = {.label = "raycast: light", .file = "raycast_light.glsl", .defines = defines};
  if (!gpu_program_prepare(&s->light_program, &desc, error)) return false;
  const RenderTiles *tiles = &picture->tiles;
  const LightParams params = {render_body_ends(picture),
                              {picture->settings->refractive_index, 2 * picture->frame->particle_radius}};
  gpu_draw(picture->gpu,
           &(GpuDraw){
               .program = &s->light_program,
               .target = &picture->target,
               .vertices = 6 * tiles->columns * tiles->rows,
               .in = {.textures = {&s->filtered, &s->colour, &s->thickness, &s->behind, [5] = &picture->sun_map.normal,
                                   &picture->sun_map.water, &picture->sun_map.solid, &picture->background.colour},
                      .storage = {&picture->obstacles.bodies, [7] = &tiles->mask},
                      .frame = &picture->uniforms,
                      .params = &params,
                      .params_size = sizeof params},
           });
  return true;
}

static bool clear_layers(Raycast *s) {
  const float nothing[4] = {0};
  const GpuTarget *const targets[] = {&s->surface_target, &s->normal_target, &s->filter_target, &s->behind_target,
                                      &s->thickness_target};
  for (int i = 0; i < 5; ++i) gpu_clear_colour(targets[i], 0, nothing);
  gpu_clear_colour(&s->normal_target, 1, nothing);
  return true;
}

static bool raycast_draw(void *state, RenderPicture *picture, RenderError *error) {
  Raycast *s = state;
  Gpu *gpu = picture->gpu;
  if (picture->particles.count == 0) return clear_layers(s);
  const float support = picture->settings->raycast.support;

  gpu_pass_begin(gpu, "grid");
  const RenderTileMarks marks = {&picture->particles.spheres, picture->particles.count, 1, support};
  bool ok = render_neighbour_grid_upload(&s->grid, picture, error) && render_tiles_clear(picture, error) &&
            render_tiles_mark(picture, &marks, error);
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "entries");
  ok = ok && find_entries(s, picture, error);
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "rays");
  ok = ok && cast_rays(s, picture, error);
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "normals");
  ok = ok && find_normals(s, picture, error);
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "filter");
  ok = ok && filter_normals(s, picture, error);
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "thickness");
  ok = ok && follow_rays(s, picture, error) &&
       render_splat_thickness(picture, &s->thickness_program, picture->settings->points.scale, &s->thickness_target,
                              error);
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "light");
  ok = ok && draw_light(s, picture, error);
  gpu_pass_end(gpu);
  return ok;
}

const RenderStyle style_raycast = {
    .name = "raycast",
    .summary = "a smooth iso-surface for very many particles, after Xiao, Zhang & Yang 2017",
    .needs = SIM_NEED_NOTHING,
    .state_size = sizeof(Raycast),
    .layers = layers,
    .layer_count = sizeof layers / sizeof layers[0],
    .resize = raycast_resize,
    .draw = raycast_draw,
    .destroy = raycast_destroy,
};
