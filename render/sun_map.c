// The scene as the sun sees it: water (thickness and height) and obstacles (height), in parallel projection over the box
// around everything. Floor, obstacles and water look up there what light reaches them (sun.glsl).
#include "render/picture.h"

#include "render/splat.h"

#define WATER_SIZE 256
#define SOLID_SIZE 1024

bool render_sun_map_create(RenderPicture *picture, RenderError *error) {
  RenderSunMap *map = &picture->sun_map;
  const GpuTextureDesc descs[] = {
      {"sun map: raw splats", WATER_SIZE, WATER_SIZE, GPU_RGBA32F, false},
      {"sun map: half blurred", WATER_SIZE, WATER_SIZE, GPU_RGBA32F, false},
      {"sun map: blurred", WATER_SIZE, WATER_SIZE, GPU_RGBA32F, false},
      {"sun map: water", WATER_SIZE, WATER_SIZE, GPU_RGBA32F, true},
      {"sun map: normal", WATER_SIZE, WATER_SIZE, GPU_RGBA32F, true},
      {"sun map: obstacles", SOLID_SIZE, SOLID_SIZE, GPU_R32F, false},
  };
  GpuTexture *const textures[] = {&map->raw, &map->half_blurred, &map->blurred, &map->water, &map->normal, &map->solid};
  for (size_t i = 0; i < sizeof descs / sizeof descs[0]; ++i) {
    if (!gpu_texture_create(textures[i], &descs[i], error)) return false;
  }
  const GpuTargetDesc raw = {.label = "sun map: water", .colour = {&map->raw}};
  const GpuTargetDesc solid = {.label = "sun map: obstacles", .colour = {&map->solid}};
  return gpu_target_create(&map->raw_target, &raw, error) && gpu_target_create(&map->solid_target, &solid, error);
}

void render_sun_map_destroy(RenderPicture *picture) {
  RenderSunMap *map = &picture->sun_map;
  gpu_program_destroy(&map->splat_program);
  gpu_program_destroy(&map->blur_program[0]);
  gpu_program_destroy(&map->blur_program[1]);
  gpu_program_destroy(&map->relief_program);
  gpu_texture_destroy(&map->raw);
  gpu_texture_destroy(&map->half_blurred);
  gpu_texture_destroy(&map->blurred);
  gpu_texture_destroy(&map->water);
  gpu_texture_destroy(&map->normal);
  gpu_texture_destroy(&map->solid);
  gpu_target_destroy(&map->raw_target);
  gpu_target_destroy(&map->solid_target);
}

// ---- Water -----------------------------------------------------------------------------------------------------------

static bool prepare_smoothing(RenderSunMap *map, RenderError *error) {
  const GpuProgramDesc along_u = {.label = "sun blur along u", .file = "sun_blur.glsl", .compute = true};
  const GpuProgramDesc along_v = {
      .label = "sun blur along v", .file = "sun_blur.glsl", .defines = "#define SECOND 1\n", .compute = true};
  const GpuProgramDesc relief = {.label = "sun relief", .file = "sun_relief.glsl", .compute = true};
  return gpu_program_prepare(&map->blur_program[0], &along_u, error) &&
         gpu_program_prepare(&map->blur_program[1], &along_v, error) &&
         gpu_program_prepare(&map->relief_program, &relief, error);
}

// One compute pass over the map.
static void filter(RenderPicture *picture, const GpuProgram *program, const GpuTexture *in, const GpuTexture *out,
                   const GpuTexture *second_out, const float sigma[4]) {
  gpu_dispatch(
      picture->gpu,
      &(GpuDispatch){
          .program = program,
          .output = {out, second_out},
          .width = WATER_SIZE,
          .height = WATER_SIZE,
          .in = {.textures = {in}, .frame = &picture->uniforms, .params = sigma, .params_size = 4 * sizeof(float)},
      });
}

// Input: the raw map. Output: water and normal.
static void smooth(RenderPicture *picture) {
  RenderSunMap *map = &picture->sun_map;
  // About one and a half particle spacings, and neither less than a texel nor more than the kernel is made for.
  float sigma[4] = {0};
  for (int i = 0; i < 2; ++i) {
    const float texels = 3 * picture->frame->particle_radius * WATER_SIZE / picture->block.sun_map[i];
    sigma[i] = texels > 1 ? (texels < 12 ? texels : 12) : 1;
  }
  filter(picture, &map->blur_program[0], &map->raw, &map->half_blurred, NULL, sigma);
  filter(picture, &map->blur_program[1], &map->half_blurred, &map->blurred, NULL, sigma);
  filter(picture, &map->relief_program, &map->blurred, &map->water, &map->normal, sigma);
}

// ---- Obstacles -------------------------------------------------------------------------------------------------------

static bool draw_solids(RenderPicture *picture, RenderError *error) {
  const GpuTarget *out = &picture->sun_map.solid_target;
  const float nothing[4] = {-1e9f, 0, 0, 0};
  gpu_clear_colour(out, 0, nothing);
  const GpuDraw draw = {.target = out, .blend = GPU_BLEND_MAX, .in.frame = &picture->uniforms};
  return render_obstacles_draw(picture, RENDER_SUN, draw, error);
}

bool render_sun_map_draw(RenderPicture *picture, RenderError *error) {
  const RenderSettings *settings = picture->settings;
  if (!settings->sun || !settings->shadow) return true;
  if (picture->obstacles.count > 0 && !draw_solids(picture, error)) return false;
  if (picture->particles.count == 0) return true;
  if (!prepare_smoothing(&picture->sun_map, error)) return false;
  if (!render_splat_sun(picture, &picture->sun_map.splat_program, settings->points.scale, &picture->sun_map.raw_target,
                        error)) {
    return false;
  }
  smooth(picture);
  return true;
}
