// The style "cartoon": Rocha Neto, Guimarães, Apolinário, Mello, "Real-Time Screen Space Rendering of Cartoon Water", 2014.
//
// The depth of the particles' spheres is smoothed by a bilateral filter (sections III-A, III-B), the thickness of the water is
// added up from Gaussians (III-C), and the surface is shaded in a few flat tones, with what is behind or before it (III-D).
//
// Beyond the paper: outlines; drops apart from the body of water, so that a stray one smears nothing; maps at half the
// picture's resolution; smooth outlines of the body (cartoon_tidy.glsl); planes instead of means in the filter; curvature flow;
// tones that still water does not flicker between; water that lies flat on the walls of its container; coloured water; the
// rest of the scene drawn as well.
#include "render/cartoon_surface.h"
#include "render/eye.h"
#include "render/outlines.h"
#include "render/scene_rays.h"
#include "render/splat.h"
#include "render/style.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Cartoon {
  RenderQuadrics quadrics;
  GpuBuffer spheres; // (sphere_count) vec4 of the body: centre, radius; m
  GpuBuffer colours; // (sphere_count) vec4: linear; –; only where the frame has colours
  int32_t sphere_count;
  bool coloured;  // the frame has colours
  bool submerged; // the eye is in the water
  bool drops;     // the layer of drops is not empty
  bool empty;     // the layers hold no water
  RenderCartoonSurface surface;
  GpuProgram thickness_program;
  GpuTexture thickness; // metres of water along the ray, half the resolution
  GpuTarget thickness_target;
  // of frames that have colours, made when first needed
  GpuProgram tint_program;
  GpuTexture tint; // linear colour times weight, weight; half the resolution
  GpuTarget tint_target;
  RenderOutlines outlines;
  GpuTexture inked; // the background with its outlines
  GpuTarget inked_target;
  GpuProgram solid_program;
  GpuProgram light_program;
  GpuTexture tone; // see cartoon_light.glsl; 0 where there is no water
  GpuTexture seen; // outward unit normal (0: unknown), depth (m) of the nearest water or solid; 0: the sky
  GpuTarget seen_target, light_target;
} Cartoon;

static const RenderLayer layers[] = {
    {"depth", "metres along the view axis to the water or what stands before it", RENDER_MAP_DEPTH,
     offsetof(Cartoon, seen), 3, 1, 0},
    {"normal", "outward unit normal of the water in world axes, 0 where there is none", RENDER_MAP_NORMAL,
     offsetof(Cartoon, seen), 0, 3, 0},
    {"tone", "1 to 3: dark, medium and bright water; 4 and 5: drops in the light and away from it", RENDER_MAP_SCALAR,
     offsetof(Cartoon, tone), 0, 1, 5},
    {"thickness", "metres of water along the ray", RENDER_MAP_SCALAR, offsetof(Cartoon, thickness), 0, 1, 2},
    {"cover", "share of the surroundings that is the body of water", RENDER_MAP_SCALAR,
     offsetof(Cartoon, surface.layer[RENDER_BODY].map), 3, 1, 1},
    {"smooth_normal", "outward unit normal of the body before the walls cut it off", RENDER_MAP_NORMAL,
     offsetof(Cartoon, surface.layer[RENDER_BODY].surface), 0, 3, 0},
    {"raw_depth", "1/m: 1 / metres along the view axis to the body's nearest sphere", RENDER_MAP_SCALAR,
     offsetof(Cartoon, surface.layer[RENDER_BODY].raw), 0, 1, 2},
    {"smooth_depth", "metres along the view axis to the body before the walls cut it off", RENDER_MAP_DEPTH,
     offsetof(Cartoon, surface.layer[RENDER_BODY].surface), 3, 1, 0},
};

// ---- Making and unmaking ---------------------------------------------------------------------------------------------

static bool cartoon_resize(void *state, const RenderPicture *picture, RenderError *error) {
  Cartoon *s = state;
  const int32_t width = picture->width, height = picture->height;
  const struct {
    GpuTexture *texture;
    GpuTextureDesc desc;
  } textures[] = {{&s->thickness, {"cartoon: thickness", (width + 1) / 2, (height + 1) / 2, GPU_R32F, true}},
                  {&s->inked, {"cartoon: inked background", width, height, GPU_RGBA32F, false}},
                  {&s->tone, {"cartoon: tone", width, height, GPU_R32F, false}},
                  {&s->seen, {"cartoon: seen", width, height, GPU_RGBA32F, false}}};
  for (size_t i = 0; i < sizeof textures / sizeof textures[0]; ++i) {
    if (!gpu_texture_create(textures[i].texture, &textures[i].desc, error)) return false;
  }
  const GpuTargetDesc thickness = {"cartoon: thickness", {&s->thickness}, NULL};
  const GpuTargetDesc inked = {"cartoon: inked background", {&s->inked}, NULL};
  const GpuTargetDesc seen = {"cartoon: seen", {&s->seen}, NULL};
  const GpuTargetDesc light = {"cartoon: light", {&picture->colour, &s->tone, &s->seen}, NULL};
  return render_outlines_resize(&s->outlines, picture, error) && gpu_target_create(&s->seen_target, &seen, error) &&
         gpu_target_create(&s->thickness_target, &thickness, error) &&
         gpu_target_create(&s->inked_target, &inked, error) && gpu_target_create(&s->light_target, &light, error);
}

static void cartoon_destroy(void *state) {
  Cartoon *s = state;
  render_quadrics_destroy(&s->quadrics);
  gpu_buffer_destroy(&s->spheres);
  gpu_buffer_destroy(&s->colours);
  render_cartoon_surface_destroy(&s->surface);
  render_outlines_destroy(&s->outlines);
  gpu_program_destroy(&s->solid_program);
  gpu_program_destroy(&s->thickness_program);
  gpu_program_destroy(&s->tint_program);
  gpu_program_destroy(&s->light_program);
  GpuTexture *const textures[] = {&s->thickness, &s->tint, &s->inked, &s->tone, &s->seen};
  GpuTarget *const targets[] = {&s->thickness_target, &s->tint_target, &s->inked_target, &s->seen_target,
                                &s->light_target};
  for (size_t i = 0; i < sizeof textures / sizeof textures[0]; ++i) gpu_texture_destroy(textures[i]);
  for (size_t i = 0; i < sizeof targets / sizeof targets[0]; ++i) gpu_target_destroy(targets[i]);
}

// ---- Passes ----------------------------------------------------------------------------------------------------------

// The body's particles, all but drops that are apart, as spheres and, of coloured water, their colours.
static void take_body(Cartoon *s, const SimFrame *frame, bool apart, float (*spheres)[4], float (*colours)[4]) {
  for (int32_t i = 0; i < frame->count; ++i) {
    const float *p = frame->position + 3 * (size_t)i;
    const float radius = frame->radius != NULL ? frame->radius[i] : frame->particle_radius;
    const bool valid = fabsf(p[0]) < RENDER_FARTHEST && fabsf(p[1]) < RENDER_FARTHEST &&
                       fabsf(p[2]) < RENDER_FARTHEST && radius > 0 && radius < RENDER_FARTHEST;
    if (!valid || (apart && frame->particle_class[i] == SIM_SPLASH)) continue;
    const int32_t place = s->sphere_count++;
    memcpy(spheres[place], p, 3 * sizeof *p);
    spheres[place][3] = radius;
    for (int k = 0; s->coloured && k < 3; ++k) {
      const float c = frame->colour[3 * (size_t)i + (size_t)k];
      colours[place][k] = c > 0 ? fminf(c, 1) : 0; // NaN becomes 0
    }
  }
}

static bool upload_body(Cartoon *s, const RenderPicture *picture, RenderError *error) {
  const SimFrame *frame = picture->frame;
  s->coloured = frame->colour != NULL;
  const size_t count = (size_t)frame->count, each = 4 * sizeof(float);
  float(*spheres)[4] = malloc(each * count), (*colours)[4] = s->coloured ? calloc(count, each) : NULL;
  bool ok = spheres != NULL && (colours != NULL || !s->coloured);
  if (!ok) gpu_fail(error, "out of memory for %d particles", frame->count);
  s->sphere_count = 0;
  if (ok) take_body(s, frame, picture->settings->cartoon.splashes_apart, spheres, colours);
  const size_t size = each * (size_t)s->sphere_count;
  ok = ok && gpu_buffer_write(&s->spheres, "spheres of the body", spheres, size, error) &&
       (!s->coloured || gpu_buffer_write(&s->colours, "colours of the body", colours, size, error));
  free(spheres);
  free(colours);
  return ok;
}

static bool upload(Cartoon *s, RenderPicture *picture, RenderError *error) {
  const RenderCartoon *settings = &picture->settings->cartoon;
  const RenderQuadricSettings shapes = {.scale = settings->scale,
                                        .spheres = true,
                                        .splashes_apart = settings->splashes_apart,
                                        .ball_scale = settings->scale,
                                        .surface_only = true};
  const RenderQuadrics *q = &s->quadrics;
  const int32_t scale = settings->half_resolution ? 2 : 1;
  // Outlines reach a little beyond the spheres.
  return (s->surface.scale == scale || render_cartoon_surface_resize(&s->surface, picture, scale, error)) &&
         render_quadrics_upload(&s->quadrics, picture->frame, &shapes, error) && upload_body(s, picture, error) &&
         render_tiles_clear(picture, error) &&
         render_tiles_mark(picture, &(RenderTileMarks){&q->ellipsoids, q->ellipsoid_count, 4, 1.5f}, error) &&
         render_tiles_mark(picture, &(RenderTileMarks){&q->balls, q->ball_count, 2, 2}, error);
}

typedef bool (*SurfacePass)(RenderCartoonSurface *surface, RenderPicture *picture, const RenderQuadrics *quadrics,
                            int layer, RenderError *error);

// A pass over both layers; a frame without drops has an empty one. (The light is made from both all the same: two shaders, one
// with drops and one without, would round differently.)
static bool on_layers(Cartoon *s, RenderPicture *picture, SurfacePass pass, RenderError *error) {
  return pass(&s->surface, picture, &s->quadrics, RENDER_BODY, error) &&
         (s->quadrics.ball_count == 0 || pass(&s->surface, picture, &s->quadrics, RENDER_DROPS, error));
}

static bool normals(RenderCartoonSurface *surface, RenderPicture *picture, const RenderQuadrics *quadrics, int layer,
                    RenderError *error) {
  (void)quadrics;
  return render_cartoon_surface_normals(surface, picture, layer, error);
}

static bool draw_thickness(Cartoon *s, RenderPicture *picture, RenderError *error) {
  return render_splat_gaussians(picture, &s->thickness_program, &s->spheres, s->sphere_count, &s->thickness_target,
                                error);
}

// The colour of the water near its surface.
static bool draw_tint(Cartoon *s, RenderPicture *picture, RenderError *error) {
  if (!s->coloured) return true;
  if (s->tint_target.id == 0) {
    const GpuTextureDesc desc = {"cartoon: tint", (picture->width + 1) / 2, (picture->height + 1) / 2, GPU_RGBA32F,
                                 true};
    const GpuTargetDesc target = {"cartoon: tint", {&s->tint}, NULL};
    if (!gpu_texture_create(&s->tint, &desc, error) || !gpu_target_create(&s->tint_target, &target, error))
      return false;
  }
  const RenderCartoonLayer *body = &s->surface.layer[RENDER_BODY];
  return render_splat_colours(picture, &s->tint_program, &s->spheres, &s->colours, s->sphere_count,
                              &body->map[body->smoothed], &s->tint_target, error);
}

// std140 block of cartoon_light.glsl
typedef struct LightParams {
  RenderBodyEnds ends;
  float water[3][4], splash[2][4];
  float reflection[4], transparency[4], particle[4];
} LightParams;

static float cosine(float degrees) {
  return cosf(degrees * 3.14159265f / 180);
}

static LightParams light_params(const RenderPicture *picture) {
  const RenderCartoon *c = &picture->settings->cartoon;
  const float clearness = c->clearness > 0 ? c->clearness : picture->block.container_max[3] / 12;
  LightParams params = {.ends = render_body_ends(picture),
                        .reflection = {c->most_reflection, c->least_reflection,
                                       cosine(fminf(c->critical_angle + c->angle_interval, 90)),
                                       cosine(fmaxf(c->critical_angle - c->angle_interval, 0))},
                        .transparency = {c->most_transparency, c->least_transparency, clearness, c->bending},
                        .particle = {picture->frame->particle_radius}};
  const float *const colours[] = {c->palette.dark, c->palette.medium, c->palette.bright};
  for (int i = 0; i < 3; ++i) memcpy(params.water[i], colours[i], 3 * sizeof(float));
  for (int i = 0; i < 2; ++i) memcpy(params.splash[i], c->palette.splash[i], 3 * sizeof(float));
  params.reflection[3] = fmaxf(params.reflection[3], params.reflection[2] + 1e-6f);
  return params;
}

static bool draw_light(Cartoon *s, RenderPicture *picture, RenderError *error) {
  const RenderCartoon *settings = &picture->settings->cartoon;
  char defines[sizeof picture->defines + 256];
  const int used = render_scene_defines(picture, defines, sizeof defines);
  snprintf(defines + used, sizeof defines - (size_t)used, "%s%s%s%s%s", render_container_define(picture->frame),
           settings->reflection ? "#define REFLECTION 1\n" : "", settings->refraction ? "#define REFRACTION 1\n" : "",
           s->submerged ? "#define SUBMERGED 1\n" : "", s->coloured ? "#define COLOURED 1\n" : "");
  const GpuProgramDesc desc = {.label = "cartoon: light", .file = "cartoon_light.glsl", .defines = defines};
  if (!gpu_program_prepare(&s->light_program, &desc, error)) return false;
  const RenderTiles *tiles = &picture->tiles;
  const RenderCartoonLayer *layer = s->surface.layer;
  const LightParams params = light_params(picture);
  gpu_draw(picture->gpu, &(GpuDraw){
                             .program = &s->light_program,
                             .target = &s->light_target,
                             .vertices = 6 * tiles->columns * tiles->rows,
                             .in = {.textures = {&layer[RENDER_BODY].surface, &layer[RENDER_BODY].map[0],
                                                 &layer[RENDER_DROPS].surface, &layer[RENDER_DROPS].map[0],
                                                 &s->thickness, &picture->sun_map.normal, &picture->sun_map.water,
                                                 &picture->sun_map.solid, &picture->background.colour, &s->inked,
                                                 &layer[RENDER_BODY].raw, s->coloured ? &s->tint : NULL},
                                    .storage = {&picture->obstacles.bodies, [7] = &tiles->mask},
                                    .frame = &picture->uniforms,
                                    .params = &params,
                                    .params_size = sizeof params},
                         });
  return true;
}

// Outputs: seen, of the solids alone; inked, if something is seen through the water.
static bool draw_solids(Cartoon *s, RenderPicture *picture, RenderError *error) {
  const GpuProgramDesc desc = {.label = "cartoon: solids", .file = "cartoon_solids.glsl"};
  if (!gpu_program_prepare(&s->solid_program, &desc, error)) return false;
  gpu_draw(picture->gpu, &(GpuDraw){.program = &s->solid_program,
                                    .target = &s->seen_target,
                                    .in = {.textures = {&picture->background.colour}, .frame = &picture->uniforms}});
  if (!picture->settings->cartoon.refraction && !s->submerged) return true;
  gpu_texture_copy(&picture->background.colour, &s->inked);
  return render_outlines_draw(&s->outlines, picture, (RenderOutlined){&s->seen, false}, &s->inked_target, error);
}

static bool clear_water(Cartoon *s, const RenderPicture *picture, RenderError *error) {
  const float nothing[4] = {0};
  gpu_clear_colour(&s->thickness_target, 0, nothing);
  return render_cartoon_surface_resize(&s->surface, picture, picture->settings->cartoon.half_resolution ? 2 : 1, error);
}

static bool draw_water(Cartoon *s, RenderPicture *picture, RenderError *error) {
  Gpu *gpu = picture->gpu;
  gpu_pass_begin(gpu, "spheres");
  bool ok = upload(s, picture, error);
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "depths");
  if (ok && s->drops && s->quadrics.ball_count == 0) render_cartoon_surface_clear(&s->surface, RENDER_DROPS);
  s->drops = s->quadrics.ball_count > 0;
  ok = ok && on_layers(s, picture, render_cartoon_surface_depths, error);
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "smoothing");
  ok = ok && on_layers(s, picture, render_cartoon_surface_smooth, error);
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "normals");
  ok = ok && on_layers(s, picture, normals, error);
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "thickness");
  ok = ok && draw_thickness(s, picture, error) && draw_tint(s, picture, error);
  gpu_pass_end(gpu);

  gpu_pass_begin(gpu, "light");
  ok = ok && draw_light(s, picture, error);
  gpu_pass_end(gpu);
  return ok;
}

static bool cartoon_draw(void *state, RenderPicture *picture, RenderError *error) {
  Cartoon *s = state;
  Gpu *gpu = picture->gpu;
  const float nothing[4] = {0};
  s->submerged = picture->particles.count > 0 && render_eye_in_water(picture->frame, picture->block.eye);
  gpu_pass_begin(gpu, "solids");
  gpu_clear_colour(&s->light_target, 1, nothing);
  bool ok = draw_solids(s, picture, error);
  gpu_pass_end(gpu);

  if (picture->particles.count > 0) {
    ok = ok && draw_water(s, picture, error);
  } else if (!s->empty) {
    ok = ok && clear_water(s, picture, error);
  }
  s->empty = picture->particles.count == 0;

  gpu_pass_begin(gpu, "outlines");
  ok = ok && render_outlines_draw(&s->outlines, picture, (RenderOutlined){&s->seen, true}, &picture->target, error);
  gpu_pass_end(gpu);
  return ok;
}

const RenderStyle style_cartoon = {
    .name = "cartoon",
    .summary = "water as an animator would draw it, after Rocha Neto, Guimarães, Apolinário & Mello 2014",
    .needs = SIM_NEED_CLASS | SIM_NEED_SURFACE,
    .drawn = true,
    .state_size = sizeof(Cartoon),
    .layers = layers,
    .layer_count = sizeof layers / sizeof layers[0],
    .resize = cartoon_resize,
    .draw = cartoon_draw,
    .destroy = cartoon_destroy,
};
