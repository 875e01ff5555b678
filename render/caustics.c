// Traced caustics: the triangles of a grid over the surface are refracted (Eq. 3 of Cords 2007) and drawn where they land, so
// that light is conserved however much it is bundled (Stam, "Random Caustics", 1996; Shah, Konttinen & Pattanaik, "Caustics
// Mapping", 2007). The map looks along the sunlight as plane water refracts it: what lands on a solid and what lands on the
// floor around it stay apart, and a point in the water finds its light by its place across that direction.
#include "render/caustics.h"

#include <cglm/cglm.h>
#include <float.h>
#include <stdio.h>
#include <string.h>

// Edge of the maps of light and of solids, pixels, and most squares of the grid along an axis if it is as long as the other.
typedef struct Fineness {
  int32_t light, solid, squares;
} Fineness;
static const Fineness on_hardware = {1024, 1024, 512}, in_software = {512, 512, 200};

#define LEAST_SQUARE 1.5f // pixels of the map across a square of the grid, or triangles are drawn wider than they are
#define STEEPEST 0.35f    // m that a metre of depth carries light aside by waves, beyond what level water does

static Fineness fineness(const RenderPicture *picture) {
  return picture->gpu->software ? in_software : on_hardware;
}

// ---- The refracted sunlight ------------------------------------------------------------------------------------------

// Share of unpolarised light that goes through a surface at these cosines of the angles before and behind it.
static float transmittance(float before, float behind, float index) {
  const float across = (before - index * behind) / (before + index * behind);
  const float along = (index * before - behind) / (index * before + behind);
  return 1 - 0.5f * (across * across + along * along);
}

// Through the plane that lies in the water as it lies on the whole: level, or slanted in a glass that is tilted. The beam is wider
// behind the surface, by the ratio of the cosines.
static void refract_sun(RenderCaustics *caustics, const RenderPicture *picture, const RenderHeightMap *map) {
  const float *sun = picture->block.sun_direction, index = picture->settings->refractive_index;
  const float down[3] = {0, -1, 0};
  vec3 normal = {-map->slope[0], 1, -map->slope[1]};
  glm_vec3_normalize(normal);
  memcpy(caustics->way, down, sizeof down);
  caustics->level_light = 0;
  const float before = sun[0] * normal[0] + sun[1] * normal[1] + sun[2] * normal[2];
  if (!picture->settings->sun || !(sun[1] > 1e-3f) || !(before > 1e-3f)) return;
  const float behind = sqrtf(fmaxf(1 - (1 - before * before) / (index * index), 0));
  for (int k = 0; k < 3; ++k) caustics->way[k] = -sun[k] / index + (before / index - behind) * normal[k];
  caustics->level_light = transmittance(before, behind, index) * before / behind;
}

// ---- What the maps cover ---------------------------------------------------------------------------------------------

typedef struct Box {
  float min[3], max[3];
} Box;

// The water from the floor up. A floor that lies very deep is left out.
static Box water_box(const RenderPicture *picture, const RenderHeightMap *map) {
  Box box;
  for (int k = 0; k < 2; ++k) {
    box.min[2 * k] = map->origin[k];
    box.max[2 * k] = map->origin[k] + map->spacing * (float)(map->size[k] - 1);
  }
  const float across = hypotf(box.max[0] - box.min[0], box.max[2] - box.min[2]);
  const float most = 10 * fmaxf(across, map->highest - map->lowest + map->spacing),
              floor = picture->block.floor_plane[0];
  box.max[1] = map->highest;
  box.min[1] = fminf(fmaxf(floor, map->highest - most), map->lowest);
  return box;
}

static float fit_axis(float row[4], const float axis[3], const Box *box) {
  float low = 0, high = 0;
  for (int k = 0; k < 3; ++k) {
    low += axis[k] * (axis[k] > 0 ? box->min[k] : box->max[k]);
    high += axis[k] * (axis[k] > 0 ? box->max[k] : box->min[k]);
  }
  const float extent = fmaxf(1.02f * (high - low), 1e-4f);
  for (int k = 0; k < 3; ++k) row[k] = axis[k] / extent;
  row[3] = 0.5f - 0.5f * (low + high) / extent;
  return extent;
}

// Right-handed axes across the light, u level with the floor.
static void set_axes(RenderCaustics *caustics, const Box *box) {
  vec3 up = {-caustics->way[0], -caustics->way[1], -caustics->way[2]}, u, v;
  glm_vec3_cross(up[1] > 0.9999f ? (vec3){0, 0, 1} : (vec3){0, 1, 0}, up, u);
  glm_vec3_normalize(u);
  glm_vec3_cross(up, u, v);
  caustics->extent[0] = fit_axis(caustics->u, u, box);
  caustics->extent[1] = fit_axis(caustics->v, v, box);
}

// ---- Making and unmaking ---------------------------------------------------------------------------------------------

static bool make_map(GpuTexture *texture, GpuTarget *target, const GpuTextureDesc *desc, RenderError *error) {
  if (texture->id != 0 && texture->width == desc->width && texture->height == desc->height) return true;
  return gpu_texture_create(texture, desc, error) &&
         gpu_target_create(target, &(GpuTargetDesc){.label = desc->label, .colour = {texture}}, error);
}

// The maps that shaders read are always there.
static bool make_maps(RenderCaustics *caustics, const RenderPicture *picture, RenderError *error) {
  const Fineness fine = fineness(picture);
  const GpuTextureDesc solid = {"caustics: solids", fine.solid, fine.solid, GPU_R32F, false};
  const GpuTextureDesc raw = {"caustics: raw light", fine.light, fine.light, GPU_RGBA32F, false};
  const GpuTextureDesc light = {"caustics: light", fine.light, fine.light, GPU_RGBA32F, true};
  return make_map(&caustics->solid, &caustics->solid_target, &solid, error) &&
         make_map(&caustics->raw, &caustics->raw_target, &raw, error) &&
         make_map(&caustics->light, &caustics->light_target, &light, error);
}

void render_caustics_destroy(RenderCaustics *caustics) {
  gpu_buffer_destroy(&caustics->frame);
  gpu_program_destroy(&caustics->landing_program);
  gpu_program_destroy(&caustics->light_program);
  gpu_program_destroy(&caustics->blur_program);
  gpu_texture_destroy(&caustics->solid);
  gpu_texture_destroy(&caustics->landing);
  gpu_texture_destroy(&caustics->raw);
  gpu_texture_destroy(&caustics->light);
  gpu_target_destroy(&caustics->solid_target);
  gpu_target_destroy(&caustics->landing_target);
  gpu_target_destroy(&caustics->raw_target);
  gpu_target_destroy(&caustics->light_target);
  *caustics = (RenderCaustics){0};
}

// ---- Solids ----------------------------------------------------------------------------------------------------------

static bool has_solids(const RenderPicture *picture) {
  return picture->settings->shadow && picture->obstacles.count > 0;
}

// They are drawn as the sun sees them (sun_map.c), with the refracted sunlight for the sun's.
static bool draw_solids(RenderCaustics *caustics, RenderPicture *picture, float level, RenderError *error) {
  RenderFrameBlock block = picture->block;
  for (int k = 0; k < 3; ++k) block.sun_direction[k] = -caustics->way[k];
  memcpy(block.sun_u, caustics->u, sizeof block.sun_u);
  memcpy(block.sun_v, caustics->v, sizeof block.sun_v);
  memcpy(block.sun_map, caustics->extent, sizeof caustics->extent);
  block.sun_map[3] = level;
  if (!gpu_buffer_write(&caustics->frame, "caustics: frame block", &block, sizeof block, error)) return false;
  const GpuDraw draw = {.target = &caustics->solid_target, .blend = GPU_BLEND_MAX, .in.frame = &caustics->frame};
  return render_obstacles_draw(picture, RENDER_SUN_IN_WATER, draw, error);
}

// ---- The grid --------------------------------------------------------------------------------------------------------

typedef struct Grid {
  float low[2], square; // m
  int32_t squares[2];
} Grid;

// The field and what lies beyond it from where light may come to the floor within: farthest towards the sun.
static Grid choose_grid(const RenderCaustics *caustics, const RenderPicture *picture, const RenderHeightMap *map,
                        const Box *box) {
  const Fineness fine = fineness(picture);
  const float depth = box->max[1] - box->min[1];
  const float pixel = fmaxf(caustics->extent[0], caustics->extent[1]) / (float)fine.light;
  float low[2], high[2];
  for (int k = 0; k < 2; ++k) {
    const float shift = depth * caustics->way[2 * k] / -caustics->way[1];
    low[k] = box->min[2 * k] - fmaxf(shift, 0) - STEEPEST * depth;
    high[k] = box->max[2 * k] - fminf(shift, 0) + STEEPEST * depth;
  }
  const float area = (high[0] - low[0]) * (high[1] - low[1]);
  const float coarse = fmaxf(sqrtf(fmaxf(area, 0)) / (float)fine.squares, LEAST_SQUARE * pixel);
  Grid grid = {.square = fmaxf(map->spacing, coarse)};
  for (int k = 0; k < 2; ++k) {
    // Points lie on texels where they are as far apart.
    const float from = floorf((low[k] - map->origin[k]) / grid.square),
                to = ceilf((high[k] - map->origin[k]) / grid.square);
    grid.low[k] = map->origin[k] + from * grid.square;
    grid.squares[k] = (int32_t)fminf(fmaxf(to - from, 1), 8191);
  }
  return grid;
}

// ---- Light -----------------------------------------------------------------------------------------------------------

// std140 block of caustics_landing.glsl
typedef struct LandingParams {
  float grid[4], place[4], slope[4], walls[4], u[4], v[4], way[4];
} LandingParams;

static bool prepare(RenderCaustics *caustics, const RenderPicture *picture, RenderError *error) {
  // SOLIDS are what light in the water may meet, SOLID_SHADOW is what keeps it from the water.
  const GpuProgramDesc landing = {.label = "caustics: landing",
                                  .file = "caustics_landing.glsl",
                                  .defines = has_solids(picture) ? "#define SOLIDS 1\n" : ""};
  const GpuProgramDesc light = {.label = "caustics: light",
                                .file = "caustics_light.glsl",
                                .defines = has_solids(picture) ? "#define SOLID_SHADOW 1\n" : ""};
  const GpuProgramDesc blur = {.label = "caustics: blur", .file = "caustics_blur.glsl"};
  return gpu_program_prepare(&caustics->landing_program, &landing, error) &&
         gpu_program_prepare(&caustics->light_program, &light, error) &&
         gpu_program_prepare(&caustics->blur_program, &blur, error);
}

static void land(const RenderCaustics *caustics, const RenderPicture *picture, const RenderHeightMap *map,
                 const Grid *grid, float index) {
  const RenderCausticsBlock block = render_caustics_block(caustics, picture);
  const RenderHeightBlock height = render_height_block(map);
  LandingParams params = {.grid = {grid->low[0], grid->low[1], grid->square, fmaxf(index, 1)}};
  memcpy(params.place, height.place, sizeof params.place);
  memcpy(params.slope, height.slope, sizeof params.slope);
  memcpy(params.walls, block.walls, sizeof params.walls);
  memcpy(params.u, caustics->u, sizeof params.u);
  memcpy(params.v, caustics->v, sizeof params.v);
  memcpy(params.way, caustics->way, sizeof caustics->way);
  params.way[3] = picture->block.floor_plane[0];
  const GpuInputs in = {.textures = {[3] = &map->surface, [9] = &caustics->solid},
                        .frame = &picture->uniforms,
                        .params = &params,
                        .params_size = sizeof params};
  gpu_draw(picture->gpu,
           &(GpuDraw){.program = &caustics->landing_program, .target = &caustics->landing_target, .in = in});
}

static void add_light(const RenderCaustics *caustics, const RenderPicture *picture, const Grid *grid,
                      const float colour[3]) {
  const float params[12] = {grid->low[0],
                            grid->low[1],
                            grid->square,
                            0,
                            (float)grid->squares[0],
                            grid->square * grid->square,
                            caustics->extent[0] * caustics->extent[1],
                            (float)caustics->light.width,
                            colour[0],
                            colour[1],
                            colour[2],
                            0};
  gpu_draw(picture->gpu, &(GpuDraw){.program = &caustics->light_program,
                                    .target = &caustics->raw_target,
                                    .vertices = 6 * grid->squares[0] * grid->squares[1],
                                    .blend = GPU_BLEND_ADD,
                                    .in = {.textures = {&caustics->landing, [7] = &picture->sun_map.solid},
                                           .frame = &picture->uniforms,
                                           .params = params,
                                           .params_size = sizeof params}});
}

static bool trace(RenderCaustics *caustics, RenderPicture *picture, const RenderHeightMap *map, const Grid *grid,
                  RenderError *error) {
  const GpuTextureDesc landing = {"caustics: landing", grid->squares[0] + 1, grid->squares[1] + 1, GPU_RGBA32F, false};
  if (!make_map(&caustics->landing, &caustics->landing_target, &landing, error) || !prepare(caustics, picture, error)) {
    return false;
  }
  const float index = picture->settings->refractive_index, dispersion = picture->settings->heightfield.dispersion;
  const float colours[4][3] = {{1, 1, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const float dark[4] = {0};
  gpu_clear_colour(&caustics->raw_target, 0, dark);
  const int first = dispersion > 0 ? 1 : 0, last = dispersion > 0 ? 3 : 0;
  for (int i = first; i <= last; ++i) {
    land(caustics, picture, map, grid, i > 0 ? index + 0.5f * dispersion * (float)(i - 2) : index);
    add_light(caustics, picture, grid, colours[i]);
  }
  gpu_draw(picture->gpu, &(GpuDraw){.program = &caustics->blur_program,
                                    .target = &caustics->light_target,
                                    .in.textures = {&caustics->raw}});
  return true;
}

bool render_caustics_draw(RenderCaustics *caustics, RenderPicture *picture, const RenderHeightMap *map,
                          RenderError *error) {
  const float nothing[4] = {-1e9f, 0, 0, 0}, dark[4] = {0};
  caustics->drawn = false;
  if (!make_maps(caustics, picture, error)) return false;
  gpu_clear_colour(&caustics->solid_target, 0, nothing);
  gpu_clear_colour(&caustics->light_target, 0, dark);
  refract_sun(caustics, picture, map);
  if (caustics->level_light == 0 || !(map->lowest <= map->highest)) return true;
  const Box box = water_box(picture, map);
  set_axes(caustics, &box);
  if (has_solids(picture) && !draw_solids(caustics, picture, map->level, error)) return false;
  caustics->drawn = picture->settings->heightfield.traced_caustics;
  const Grid grid = choose_grid(caustics, picture, map, &box);
  return !caustics->drawn || trace(caustics, picture, map, &grid, error);
}

// ---- For the shaders -------------------------------------------------------------------------------------------------

const char *render_caustics_defines(const RenderCaustics *caustics) {
  return caustics->drawn ? "#define POOL 1\n" : "#define POOL 1\n#define UNTRACED 1\n";
}

RenderCausticsBlock render_caustics_block(const RenderCaustics *caustics, const RenderPicture *picture) {
  const RenderHeightfield *settings = &picture->settings->heightfield;
  const SimFrame *frame = picture->frame;
  RenderCausticsBlock block = {
      .simple = {settings->simple_height, settings->simple_slope, settings->simple_base, settings->simple_caustics}};
  memcpy(block.u, caustics->u, sizeof block.u);
  memcpy(block.v, caustics->v, sizeof block.v);
  memcpy(block.way, caustics->way, sizeof caustics->way);
  if (frame->has_container && frame->container.shape == SIM_CONTAINER_GLASS) {
    const float *min = frame->container.min, *max = frame->container.max;
    block.walls[0] = 0.5f * (min[0] + max[0]);
    block.walls[1] = 0.5f * (min[2] + max[2]);
    // The outermost nodes within have dry ones beside them: the mirror stands before those.
    const float radius = 0.5f * fminf(max[0] - min[0], max[2] - min[2]), spacing = frame->height_field.spacing;
    block.walls[2] = fmaxf(radius - 1.5f * spacing, 0.5f * radius);
  }
  block.walls[3] = caustics->level_light;
  return block;
}
