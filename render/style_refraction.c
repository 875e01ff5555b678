// The style "refraction": Imai, Kanamori, Mitani, "Real-Time Screen-Space Liquid Rendering with Complex Refractions", 2016.
//
// Particles near the surface are drawn as quadrics into four maps of depth, front and back of the splashes and of the
// aggregated water (section 4.2); the latter are smoothed (section 4.3); then every pixel follows its ray through up to
// two bodies of water, bent up to four times (sections 4.4, 4.5).
//
// Beyond the paper: the default filter (smooth_regression.glsl); splashes are met as the balls that they are instead of by
// their depths; water is flush with the walls of its container and wets what it touches; rays that leave the water meet
// the scene's geometry; total internal reflection goes on in the water.
#include "render/eye.h"
#include "render/occupancy.h"
#include "render/scene_rays.h"
#include "render/style.h"
#include "render/water_surface.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct Refraction {
  RenderQuadrics quadrics;
  RenderOccupancy occupancy;
  bool submerged; // the eye is in the water
  bool empty;     // the layers hold no water
  RenderWaterSurface water;
  // splashes
  GpuProgram ball_program[2];
  GpuTexture ball[2]; // front, back: from the centre to the surface (m), depth (m); 0 where there is none
  GpuTexture ball_depth;
  GpuTarget ball_target[2];
  // colour of the nearest particle, of frames that have colours; made when first needed
  GpuProgram colour_program[2];
  GpuTexture colour, colour_depth; // linear colour, 1; 0 where there is no water
  GpuTarget colour_target;
  // light
  GpuProgram light_program;
  GpuTexture order;   // in which a ray went through the two kinds of water, see refract.glsl; 0 where there is none
  GpuTexture surface; // outward unit normal, depth (m) of the water that the eye sees; 0 where there is none
  GpuTarget light_target;
} Refraction;

static const RenderLayer layers[] = {
    {"depth", "metres along the view axis to the water, 0 where there is none", RENDER_MAP_DEPTH,
     offsetof(Refraction, surface), 3, 1, 0},
    {"normal", "outward unit normal of the water in world axes, 0 where there is none", RENDER_MAP_NORMAL,
     offsetof(Refraction, surface), 0, 3, 0},
    {"order",
     "bodies on a ray's way: 1 splash, 2 splash and splash, 3 splash and aggregated, 4 to 6 the same after aggregated",
     RENDER_MAP_SCALAR, offsetof(Refraction, order), 0, 1, 6},
    {"front_depth", "metres along the view axis to the smoothed front of the aggregated water", RENDER_MAP_DEPTH,
     offsetof(Refraction, water.front), 3, 1, 0},
    {"front_normal", "its outward unit normal in world axes", RENDER_MAP_NORMAL, offsetof(Refraction, water.front), 0,
     3, 0},
    {"back_depth", "metres along the view axis to the smoothed back of the aggregated water", RENDER_MAP_DEPTH,
     offsetof(Refraction, water.back), 3, 1, 0},
    {"back_normal", "its outward unit normal in world axes", RENDER_MAP_NORMAL, offsetof(Refraction, water.back), 0, 3,
     0},
    {"splash_front", "metres along the view axis to the nearest front of a splash", RENDER_MAP_DEPTH,
     offsetof(Refraction, ball[0]), 3, 1, 0},
    {"splash_back", "metres along the view axis to the farthest back of a splash", RENDER_MAP_DEPTH,
     offsetof(Refraction, ball[1]), 3, 1, 0},
};

// ---- Making and unmaking ---------------------------------------------------------------------------------------------

static bool refraction_resize(void *state, const RenderPicture *picture, RenderError *error) {
  Refraction *s = state;
  const int32_t width = picture->width, height = picture->height;
  const struct {
    GpuTexture *texture;
    GpuTextureDesc desc;
  } textures[] = {{&s->ball[0], {"refraction: front of splashes", width, height, GPU_RGBA32F, false}},
                  {&s->ball[1], {"refraction: back of splashes", width, height, GPU_RGBA32F, false}},
                  {&s->ball_depth, {"refraction: depth of splashes", width, height, GPU_DEPTH32F, false}},
                  {&s->order, {"refraction: order", width, height, GPU_R32F, false}},
                  {&s->surface, {"refraction: surface", width, height, GPU_RGBA32F, false}}};
  for (size_t i = 0; i < sizeof textures / sizeof textures[0]; ++i) {
    if (!gpu_texture_create(textures[i].texture, &textures[i].desc, error)) return false;
  }
  const GpuTargetDesc front = {"refraction: front of splashes", {&s->ball[0]}, &s->ball_depth};
  const GpuTargetDesc back = {"refraction: back of splashes", {&s->ball[1]}, &s->ball_depth};
  const GpuTargetDesc light = {"refraction: light", {&picture->colour, &s->order, &s->surface}, NULL};
  return render_water_surface_resize(&s->water, width, height, error) &&
         gpu_target_create(&s->ball_target[0], &front, error) && gpu_target_create(&s->ball_target[1], &back, error) &&
         gpu_target_create(&s->light_target, &light, error);
}

static void refraction_destroy(void *state) {
  Refraction *s = state;
  render_quadrics_destroy(&s->quadrics);
  render_occupancy_destroy(&s->occupancy);
  render_water_surface_destroy(&s->water);
  for (int side = 0; side < 2; ++side) {
    gpu_program_destroy(&s->ball_program[side]);
    gpu_texture_destroy(&s->ball[side]);
    gpu_target_destroy(&s->ball_target[side]);
  }
  gpu_texture_destroy(&s->ball_depth);
  gpu_program_destroy(&s->colour_program[0]);
  gpu_program_destroy(&s->colour_program[1]);
  gpu_texture_destroy(&s->colour);
  gpu_texture_destroy(&s->colour_depth);
  gpu_target_destroy(&s->colour_target);
  gpu_program_destroy(&s->light_program);
  gpu_texture_destroy(&s->order);
  gpu_texture_destroy(&s->surface);
  gpu_target_destroy(&s->light_target);
}

// ---- Passes ----------------------------------------------------------------------------------------------------------

// The particles on the GPU, and the tiles of the picture that they may touch.
static bool upload(Refraction *s, RenderPicture *picture, RenderError *error) {
  const RenderRefraction *settings = &picture->settings->refraction;
  const RenderQuadrics *q = &s->quadrics;
  const RenderQuadricSettings shapes = {.scale = settings->scale,
                                        .lift = settings->lift,
                                        .splashes_apart = settings->splashes_apart,
                                        .ball_scale = 1,
                                        .surface_only = settings->surface_only};
  s->submerged = render_eye_in_water(picture->frame, picture->block.eye);
  // From within one sees where the air begins, and the edges of large cells there.
  const RenderOccupancyGrain grain = s->submerged ? RENDER_OCCUPANCY_FINE : RENDER_OCCUPANCY_COARSE;
  return render_quadrics_upload(&s->quadrics, picture->frame, &shapes, error) &&
         render_occupancy_upload(&s->occupancy, picture->frame, grain, error) && render_tiles_clear(picture, error) &&
         render_tiles_mark(picture, &(RenderTileMarks){&q->ellipsoids, q->ellipsoid_count, 4, 1}, error) &&
         render_tiles_mark(picture, &(RenderTileMarks){&q->balls, q->ball_count, 2, 1}, error);
}

static bool draw_splashes(Refraction *s, RenderPicture *picture, RenderError *error) {
  for (int side = RENDER_FRONT; side <= RENDER_BACK; ++side) {
    render_quadrics_clear((RenderQuadricSurface)side, &s->ball_target[side]);
    const RenderQuadricPass pass = {.kind = RENDER_BALLS,
                                    .surface = (RenderQuadricSurface)side,
                                    .program = &s->ball_program[side],
                                    .out = &s->ball_target[side]};
    if (!render_quadrics_draw(picture, &s->quadrics, &pass, error)) return false;
  }
  return true;
}

static bool draw_colours(Refraction *s, RenderPicture *picture, RenderError *error) {
  if (s->colour_target.id == 0) {
    const GpuTextureDesc colour = {"refraction: colour", picture->width, picture->height, GPU_RGBA8, true};
    const GpuTextureDesc depth = {"refraction: depth of colours", picture->width, picture->height, GPU_DEPTH32F, false};
    const GpuTargetDesc target = {"refraction: colour", {&s->colour}, &s->colour_depth};
    if (!gpu_texture_create(&s->colour, &colour, error) || !gpu_texture_create(&s->colour_depth, &depth, error) ||
        !gpu_target_create(&s->colour_target, &target, error))
      return false;
  }
  render_quadrics_clear(RENDER_COLOUR, &s->colour_target);
  for (int kind = RENDER_ELLIPSOIDS; kind <= RENDER_BALLS; ++kind) {
    const RenderQuadricPass pass = {.kind = (RenderQuadricKind)kind,
                                    .surface = RENDER_COLOUR,
                                    .program = &s->colour_program[kind],
                                    .out = &s->colour_target};
    if (!render_quadrics_draw(picture, &s->quadrics, &pass, error)) return false;
  }
  return true;
}

// Choices of refract.glsl that are made when it is compiled.
static void light_defines(const Refraction *s, const RenderPicture *picture, char *defines, size_t size) {
  const int used = render_scene_defines(picture, defines, size);
  snprintf(defines + used, size - (size_t)used, "#define REFRACTIONS %d\n%s%s%s%s", picture->settings->refraction.count,
           picture->frame->colour != NULL ? "#define COLOURED 1\n" : "", render_container_define(picture->frame),
           s->submerged ? "#define SUBMERGED 1\n" : "", s->quadrics.ball_count > 0 ? "#define SPLASHES 1\n" : "");
}

// std140 block of refract.glsl
typedef struct LightParams {
  float particle[4];
  RenderBodyEnds ends;
  RenderOccupancyBlock occupancy;
} LightParams;

static bool draw_light(Refraction *s, RenderPicture *picture, RenderError *error) {
  char defines[sizeof picture->defines + 416];
  light_defines(s, picture, defines, sizeof defines);
  const GpuProgramDesc desc = {.label = "refraction: light", .file = "refract.glsl", .defines = defines};
  if (!gpu_program_prepare(&s->light_program, &desc, error)) return false;
  const RenderTiles *tiles = &picture->tiles;
  const float r = picture->frame->particle_radius, nothing[4] = {0};
  const LightParams params = {{r, 0, picture->block.container_max[3], 1.5f * r},
                              render_body_ends(picture),
                              render_occupancy_block(&s->occupancy)};
  gpu_clear_colour(&s->light_target, 1, nothing);
  gpu_clear_colour(&s->light_target, 2, nothing);
  gpu_draw(picture->gpu,
           &(GpuDraw){
               .program = &s->light_program,
               .target = &s->light_target,
               .vertices = 6 * tiles->columns * tiles->rows,
               .in = {.textures = {&s->water.inverse[s->water.smoothed], &s->water.front, &s->water.back, &s->ball[0],
                                   &s->ball[1], &picture->sun_map.normal, &picture->sun_map.water,
                                   &picture->sun_map.solid, &picture->background.colour, &s->colour},
                      .storage = {[0] = &picture->obstacles.bodies, &s->occupancy.bits, [7] = &tiles->mask},
                      .frame = &picture->uniforms,
                      .params = &params,
                      .params_size = sizeof params},
           });
  return true;
}

// Without water the layers are empty, and the background is the picture.
static bool clear_layers(Refraction *s) {
  const float nothing[4] = {0};
  if (s->empty) return true;
  s->empty = true;
  const GpuTarget *const targets[] = {&s->ball_target[0], &s->ball_target[1], &s->water.surface_target};
  for (int i = 0; i < 3; ++i) gpu_clear_colour(targets[i], 0, nothing);
  gpu_clear_colour(&s->water.surface_target, 1, nothing);
  gpu_clear_colour(&s->light_target, 1, nothing);
  gpu_clear_colour(&s->light_target, 2, nothing);
  return true;
}

static bool refraction_draw(void *state, RenderPicture *picture, RenderError *error) {
  Refraction *s = state;
  Gpu *gpu = picture->gpu;
  if (picture->particles.count == 0) return clear_layers(s);
  s->empty = false;

  gpu_pass_begin(gpu, "quadrics");
  bool ok = upload(s, picture, error);
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "depths");
  ok = ok && render_water_surface_depths(&s->water, picture, &s->quadrics, s->submerged ? &s->occupancy : NULL, error);
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "splashes");
  ok = ok && draw_splashes(s, picture, error);
  gpu_pass_end(gpu);

  if (picture->frame->colour != NULL) {
    gpu_pass_begin(gpu, "colours");
    ok = ok && draw_colours(s, picture, error);
    gpu_pass_end(gpu);
  }

  gpu_pass_begin(gpu, "smoothing");
  ok = ok && render_water_surface_smooth(&s->water, picture, &s->quadrics, error);
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "normals");
  ok = ok && render_water_surface_normals(&s->water, picture, error);
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "light");
  ok = ok && draw_light(s, picture, error);
  gpu_pass_end(gpu);
  return ok;
}

// ---- Figures ---------------------------------------------------------------------------------------------------------

#define ORDERS 6
static const char *const order_names[ORDERS] = {"splash",     "splash_splash",     "splash_aggregated",
                                                "aggregated", "aggregated_splash", "aggregated_aggregated"};

// The share of the water's pixels in each order (section 4.4); all 0 where there is no water.
static int32_t refraction_figures(const void *state, RenderFigure *figures, int32_t capacity) {
  const Refraction *s = state;
  const size_t count = (size_t)s->order.width * (size_t)s->order.height;
  float *order = malloc(count * sizeof *order);
  int64_t pixels[ORDERS + 1] = {0}, all = 0;
  if (order == NULL) return 0;
  gpu_texture_read(&s->order, order);
  for (size_t i = 0; i < count; ++i) {
    const int code = (int)order[i];
    pixels[code >= 0 && code <= ORDERS ? code : 0] += 1;
  }
  free(order);
  for (int k = 1; k <= ORDERS; ++k) all += pixels[k];
  for (int32_t k = 0; k < ORDERS && k < capacity; ++k) {
    figures[k] = (RenderFigure){order_names[k], all > 0 ? (double)pixels[k + 1] / (double)all : 0};
  }
  return ORDERS;
}

const RenderStyle style_refraction = {
    .name = "refraction",
    .summary = "water that bends light up to four times, after Imai, Kanamori & Mitani 2016",
    .needs = SIM_NEED_CLASS | SIM_NEED_ANISOTROPY | SIM_NEED_SURFACE,
    .state_size = sizeof(Refraction),
    .layers = layers,
    .layer_count = sizeof layers / sizeof layers[0],
    .resize = refraction_resize,
    .draw = refraction_draw,
    .figures = refraction_figures,
    .destroy = refraction_destroy,
};
