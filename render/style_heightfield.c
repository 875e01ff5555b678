// The style "heightfield": H. Cords, "Refraction of Water Surface Intersecting Objects in Interactive Environments", 2007.
//
// The water is a height field. Around every object in it the surface is taken for a plane, through which the object is drawn as a
// mirror and as plane water show it (sections 2.1, 2.2); the real surface looks those pictures up. Close to an object the
// surface is pulled to the plane, so that what stands in the water has no break at the waterline. Caustics are traced (section
// 2.4), floor and surroundings are met by rays.
//
// Beyond the paper: plane water bends each ray of the pictures as it is, not as seen from one eye (RENDER_EYES_EACH); rays are
// looked up in the point where they pass the object (RENDER_ACCESS_POINT); the water's flat sides behind the walls of a tank,
// through which rays meet the geometry; an eye in the water; a second layer where water hangs over air; drops that fly above the
// surface.
#include "render/drops.h"
#include "render/object_maps.h"
#include "render/overhang.h"
#include "render/scene_rays.h"
#include "render/style.h"
#include "render/water_colours.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

typedef struct Heightfield {
  RenderWaterObjects objects;
  RenderHeightMap map;
  RenderCaustics caustics;
  RenderWaterColours colours;
  RenderPool pool;
  RenderObjectMaps object_maps;
  GpuProgram surface_program, wall_program;
  GpuTexture surface; // outward unit normal in world axes, depth along the view axis (m); 0 where there is no water
  GpuTarget surface_target;
  GpuProgram tile_program;
  GpuBuffer
      tiles[2]; // (rows, columns) uint32: 1 where the height field, or its flat sides, are in a tile of the picture
  GpuProgram light_program, wall_light_program, submerged_program;
  RenderOverhang overhang;
  RenderDrops drops;
} Heightfield;

static const RenderLayer layers[] = {
    {"depth", "metres along the view axis to the water, 0 where there is none", RENDER_MAP_DEPTH,
     offsetof(Heightfield, surface), 3, 1, 0},
    {"normal", "outward unit normal of the water in world axes, 0 where there is none", RENDER_MAP_NORMAL,
     offsetof(Heightfield, surface), 0, 3, 0},
    {"refracted", "objects as plane water around them refracts them", RENDER_MAP_COLOUR,
     offsetof(Heightfield, object_maps.maps[RENDER_REFRACTED].colour), 0, 3, 0},
    {"reflected", "objects as plane water around them mirrors them", RENDER_MAP_COLOUR,
     offsetof(Heightfield, object_maps.maps[RENDER_REFLECTED].colour), 0, 3, 0},
    {"caustics", "sunlight in the water, across it, in that of the sun above", RENDER_MAP_COLOUR,
     offsetof(Heightfield, caustics.light), 0, 3, 0},
    {"height", "metres, of the height field from above", RENDER_MAP_SCALAR, offsetof(Heightfield, map.surface), 0, 1,
     2},
};

// ---- Making and unmaking ---------------------------------------------------------------------------------------------

static bool heightfield_resize(void *state, const RenderPicture *picture, RenderError *error) {
  Heightfield *s = state;
  const GpuTextureDesc surface = {"heightfield: surface", picture->width, picture->height, GPU_RGBA32F, false};
  const GpuTargetDesc target = {"heightfield: surface", {&s->surface}, &picture->depth};
  return gpu_texture_create(&s->surface, &surface, error) && gpu_target_create(&s->surface_target, &target, error) &&
         render_object_maps_resize(&s->object_maps, picture, error);
}

static void heightfield_destroy(void *state) {
  Heightfield *s = state;
  GpuProgram *const programs[] = {&s->surface_program, &s->wall_program,       &s->tile_program,
                                  &s->light_program,   &s->wall_light_program, &s->submerged_program};
  for (size_t i = 0; i < sizeof programs / sizeof programs[0]; ++i) gpu_program_destroy(programs[i]);
  gpu_buffer_destroy(&s->tiles[0]);
  gpu_buffer_destroy(&s->tiles[1]);
  gpu_texture_destroy(&s->surface);
  gpu_target_destroy(&s->surface_target);
  render_water_objects_destroy(&s->objects);
  render_height_map_destroy(&s->map);
  render_caustics_destroy(&s->caustics);
  render_water_colours_destroy(&s->colours);
  render_pool_destroy(&s->pool);
  render_object_maps_destroy(&s->object_maps);
  render_overhang_destroy(&s->overhang);
  render_drops_destroy(&s->drops);
}

// ---- Passes ----------------------------------------------------------------------------------------------------------

#define MOST_QUADS 60000 // of the surface, or its vertices would cost more than its pixels

static RenderSurfaceMesh surface_mesh(const RenderHeightMap *map) {
  RenderSurfaceMesh mesh = {.step = 1};
  while ((int64_t)(map->size[0] / mesh.step) * (map->size[1] / mesh.step) > MOST_QUADS) ++mesh.step;
  for (int k = 0; k < 2; ++k) mesh.size[k] = (map->size[k] - 1 + mesh.step - 1) / mesh.step + 1;
  return mesh;
}

// What light in and around the water reads, beside what is a pass's own.
static GpuInputs light_inputs(const Heightfield *s, const RenderPicture *picture) {
  return (GpuInputs){.textures = {[3] = &s->map.surface,
                                  &s->caustics.light,
                                  &picture->sun_map.normal,
                                  &picture->sun_map.water,
                                  &picture->sun_map.solid,
                                  &picture->background.colour,
                                  &s->caustics.solid},
                     .storage = {&picture->obstacles.bodies, [5] = &s->pool.object_of_body, &s->pool.pool},
                     .views = {s->colours.any ? &s->colours.values : NULL},
                     .frame = &picture->uniforms};
}

static const char *tint_define(const Heightfield *s) {
  return s->colours.any ? "#define TINTED 1\n" : "";
}

static bool draw_sides(Heightfield *s, RenderPicture *picture, const RenderSurfaceMesh *mesh, RenderError *error) {
  const SimFrame *frame = picture->frame;
  const int32_t glass_pieces = 96;
  char defines[sizeof picture->defines + 256];
  const int used = render_scene_defines(picture, defines, sizeof defines);
  snprintf(defines + used, sizeof defines - (size_t)used, "%s%s#define SIDES 1\n", render_container_define(frame),
           render_caustics_defines(&s->caustics));
  const GpuProgramDesc desc = {"heightfield: sides", "heightfield_surface.glsl", defines};
  if (!gpu_program_prepare(&s->wall_program, &desc, error)) return false;
  const RenderBodyEnds ends = render_body_ends(picture);
  GpuDraw draw = {.program = &s->wall_program,
                  .target = &s->surface_target,
                  .vertices =
                      6 * (frame->container.shape == SIM_CONTAINER_GLASS ? glass_pieces
                                                                         : 2 * (mesh->size[0] - 1 + mesh->size[1] - 1)),
                  .depth = GPU_DEPTH_WRITE,
                  .in = light_inputs(s, picture)};
  draw.in.params = &ends;
  draw.in.params_size = sizeof ends;
  if (draw.vertices > 0) gpu_draw(picture->gpu, &draw);
  return true;
}

static bool draw_surface(Heightfield *s, RenderPicture *picture, const RenderSurfaceMesh *mesh, RenderError *error) {
  const char *container = render_container_define(picture->frame);
  const GpuProgramDesc desc = {"heightfield: surface", "heightfield_surface.glsl", container};
  if (!gpu_program_prepare(&s->surface_program, &desc, error)) return false;
  const GpuDraw draw = {.program = &s->surface_program,
                        .target = &s->surface_target,
                        .vertices = 6 * (mesh->size[0] - 1) * (mesh->size[1] - 1),
                        .depth = GPU_DEPTH_WRITE,
                        .in = light_inputs(s, picture)};
  if (draw.vertices > 0) gpu_draw(picture->gpu, &draw);
  return container[0] == '\0' || draw_sides(s, picture, mesh, error);
}

static int32_t tiles_along(int32_t pixels) {
  return (pixels + RENDER_TILE_SIZE - 1) / RENDER_TILE_SIZE;
}

static bool find_tiles(Heightfield *s, RenderPicture *picture, RenderError *error) {
  const int32_t columns = tiles_along(picture->width), rows = tiles_along(picture->height);
  const size_t size = sizeof(uint32_t) * (size_t)columns * (size_t)rows;
  const GpuProgramDesc desc = {.label = "heightfield: tiles", .file = "heightfield_tiles.glsl", .compute = true};
  if (!gpu_program_prepare(&s->tile_program, &desc, error) ||
      !gpu_buffer_reserve(&s->tiles[0], "heightfield: tiles of the surface", size, error) ||
      !gpu_buffer_reserve(&s->tiles[1], "heightfield: tiles of the sides", size, error)) {
    return false;
  }
  gpu_dispatch(picture->gpu, &(GpuDispatch){.program = &s->tile_program,
                                            .width = columns,
                                            .height = rows,
                                            .in = {.textures = {&s->surface},
                                                   .storage = {&s->tiles[0], &s->tiles[1]},
                                                   .frame = &picture->uniforms}});
  return true;
}

// std140 block of heightfield_light.glsl
typedef struct LightParams {
  RenderBodyEnds ends;
  float spread[4];
} LightParams;

// `tiles`: those of the pixels; NULL: all.
static bool draw_light(Heightfield *s, RenderPicture *picture, GpuProgram *program, const char *pixels, bool mapped,
                       const GpuBuffer *tiles, RenderError *error) {
  const RenderHeightfield *settings = &picture->settings->heightfield;
  char defines[sizeof picture->defines + 512];
  const int used = render_scene_defines(picture, defines, sizeof defines);
  snprintf(defines + used, sizeof defines - (size_t)used, "%s%s%s#define %s 1\n%s%s%s%s%s",
           render_container_define(picture->frame), render_caustics_defines(&s->caustics), tint_define(s), pixels,
           mapped ? "#define MAPPED 1\n" : "#define ROOF 1\n",
           mapped && !s->pool.surroundings ? "#undef BODIES\n" : "", // all of them are in the maps
           settings->trapezium ? "#define TRAPEZIUM 1\n" : "",
           settings->access == RENDER_ACCESS_DIRECTION ? "#define ACCESS_DIRECTION 1\n" : "",
           settings->dispersion > 0 ? "#define DISPERSION 1\n" : "");
  const GpuProgramDesc desc = {.label = pixels, .file = "heightfield_light.glsl", .defines = defines};
  if (!gpu_program_prepare(program, &desc, error)) return false;
  const LightParams params = {render_body_ends(picture), {settings->dispersion}};
  GpuDraw draw = {.program = program, .target = &picture->target, .in = light_inputs(s, picture)};
  const RenderObjectMap *maps = s->object_maps.maps;
  draw.in.textures[0] = &s->surface;
  draw.in.textures[1] = &maps[RENDER_REFRACTED].colour;
  draw.in.textures[2] = &maps[RENDER_REFRACTED].way;
  draw.in.textures[10] = &maps[RENDER_REFLECTED].colour;
  draw.in.textures[11] = &maps[RENDER_REFLECTED].way;
  if (tiles != NULL) {
    draw.vertices = 6 * tiles_along(picture->width) * tiles_along(picture->height);
    draw.in.storage[7] = tiles;
  }
  draw.in.params = &params;
  draw.in.params_size = sizeof params;
  gpu_draw(picture->gpu, &draw);
  return true;
}

static bool draw_maps(Heightfield *s, RenderPicture *picture, RenderError *error) {
  char defines[sizeof picture->defines + 64];
  snprintf(defines, sizeof defines, "%s%s", picture->defines, render_caustics_defines(&s->caustics));
  return render_object_maps_draw(&s->object_maps, picture, &s->pool, light_inputs(s, picture), defines, error);
}

static bool find_water(Heightfield *s, RenderPicture *picture, RenderError *error) {
  const RenderHeightfield *settings = &picture->settings->heightfield;
  const SimFrame *frame = picture->frame;
  SimFrame lowest = *frame; // with the water that reaches down to the floor
  if (settings->second_layer) {
    if (!render_overhang_find(&s->overhang, frame, settings->smoothing, error)) return false;
    lowest.height_field.height = s->overhang.nodes;
  }
  return render_water_objects_find(&s->objects, &lowest, picture->block.eye, settings,
                                   picture->settings->refractive_index, error) &&
         render_height_map_draw(&s->map, picture, &s->objects.field, s->objects.heights, settings->smoothing, error) &&
         render_water_colours_find(&s->colours, frame, &s->objects.field, error);
}

static bool draw_overhang(Heightfield *s, RenderPicture *picture, RenderError *error) {
  const RenderHeightfield *settings = &picture->settings->heightfield;
  if (!settings->second_layer) return true;
  char defines[sizeof picture->defines + 512];
  const int used = render_scene_defines(picture, defines, sizeof defines);
  snprintf(defines + used, sizeof defines - (size_t)used, "%s%s%s#define ROOF 1\n",
           render_container_define(picture->frame), render_caustics_defines(&s->caustics), tint_define(s));
  return render_overhang_draw(&s->overhang, picture, &picture->frame->height_field, settings->smoothing,
                              light_inputs(s, picture), defines, error);
}

static bool draw_drops(Heightfield *s, RenderPicture *picture, RenderError *error) {
  if (!picture->settings->heightfield.drops) return true;
  char defines[sizeof picture->defines + 64];
  snprintf(defines, sizeof defines, "%s%s", picture->defines, tint_define(s));
  return render_drops_find(&s->drops, picture->frame, &s->objects.field, error) &&
         render_drops_draw(&s->drops, picture, light_inputs(s, picture), defines, error);
}

// In the container and below the surface there.
static bool eye_in_water(const Heightfield *s, const RenderPicture *picture) {
  const SimFrame *frame = picture->frame;
  const SimHeightField *field = &s->objects.field;
  const float *eye = picture->block.eye;
  if (!(eye[1] < s->map.highest) || (frame->has_container && !(eye[1] > frame->container.min[1]))) return false;
  const float x = (eye[0] - field->origin[0]) / field->spacing, z = (eye[2] - field->origin[1]) / field->spacing;
  if (!(x >= 0 && x <= (float)(field->size[0] - 1) && z >= 0 && z <= (float)(field->size[1] - 1))) return false;
  const size_t node = (size_t)(z + 0.5f) * (size_t)field->size[0] + (size_t)(x + 0.5f);
  return eye[1] < field->height[node];
}

static bool heightfield_draw(void *state, RenderPicture *picture, RenderError *error) {
  Heightfield *s = state;
  Gpu *gpu = picture->gpu;

  gpu_pass_begin(gpu, "height map");
  bool ok = find_water(s, picture, error);
  const RenderSurfaceMesh mesh = surface_mesh(&s->map);
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "caustics");
  ok = ok && render_caustics_draw(&s->caustics, picture, &s->map, error) &&
       render_pool_upload(&s->pool, picture, &s->map, &s->caustics, &s->colours, &s->objects, &mesh,
                          (float)s->object_maps.border, error);
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "objects");
  ok = ok && draw_maps(s, picture, error);
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "surface");
  const float nothing[4] = {0};
  gpu_clear_colour(&s->surface_target, 0, nothing);
  const bool water = s->map.lowest <= s->map.highest, submerged = water && eye_in_water(s, picture);
  ok = ok && (!water || submerged || (draw_surface(s, picture, &mesh, error) && find_tiles(s, picture, error)));
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "light");
  const bool mapped = picture->settings->heightfield.mapped;
  if (submerged) {
    ok = ok && draw_light(s, picture, &s->submerged_program, "SUBMERGED", false, NULL, error);
  } else if (water) {
    ok = ok && draw_light(s, picture, &s->light_program, "SURFACE", mapped, &s->tiles[0], error);
  }
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "sides");
  ok = ok &&
       (!water || submerged || draw_light(s, picture, &s->wall_light_program, "SIDES", false, &s->tiles[1], error));
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "overhang");
  ok = ok && (submerged || draw_overhang(s, picture, error));
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "drops");
  ok = ok && (submerged || draw_drops(s, picture, error));
  gpu_pass_end(gpu);
  return ok;
}

static unsigned needs_more(const RenderSettings *settings) {
  return settings->heightfield.second_layer ? SIM_NEED_SECOND_LAYER : SIM_NEED_NOTHING;
}

const RenderStyle style_heightfield = {
    .name = "heightfield",
    .summary = "calm water as a height field that bends what stands in it, after Cords 2007",
    .needs = SIM_NEED_HEIGHT_FIELD | SIM_NEED_CLASS,
    .needs_more = needs_more,
    .state_size = sizeof(Heightfield),
    .layers = layers,
    .layer_count = sizeof layers / sizeof layers[0],
    .resize = heightfield_resize,
    .draw = heightfield_draw,
    .destroy = heightfield_destroy,
};
