// The last passes: the finished picture in linear light becomes bytes, or a layer becomes something to look at.
#include "render/picture.h"

bool render_compose_resize(RenderPicture *picture, RenderError *error) {
  RenderCompose *compose = &picture->compose;
  const GpuTextureDesc toned = {"toned", picture->width, picture->height, GPU_RGBA8, true};
  const GpuTextureDesc final = {"final", picture->width, picture->height, GPU_RGBA8, false};
  return gpu_texture_create(&compose->toned, &toned, error) && gpu_texture_create(&compose->final, &final, error) &&
         gpu_target_create(&compose->toned_target, &(GpuTargetDesc){.label = "toned", .colour = {&compose->toned}},
                           error) &&
         gpu_target_create(&compose->final_target, &(GpuTargetDesc){.label = "final", .colour = {&compose->final}},
                           error);
}

void render_compose_destroy(RenderPicture *picture) {
  RenderCompose *compose = &picture->compose;
  gpu_program_destroy(&compose->tone_program);
  gpu_program_destroy(&compose->smooth_program);
  gpu_program_destroy(&compose->layer_program);
  gpu_texture_destroy(&compose->toned);
  gpu_texture_destroy(&compose->final);
  gpu_target_destroy(&compose->toned_target);
  gpu_target_destroy(&compose->final_target);
}

// Input: the picture in linear light. Output: `out`.
static bool draw_tone(RenderPicture *picture, const char *defines, const GpuTarget *out, RenderError *error) {
  GpuProgram *program = &picture->compose.tone_program;
  const GpuProgramDesc desc = {.label = "tone", .file = "tone.glsl", .defines = defines};
  if (!gpu_program_prepare(program, &desc, error)) return false;
  const float tone[4] = {picture->settings->exposure};
  gpu_draw(picture->gpu, &(GpuDraw){
                             .program = program,
                             .target = out,
                             .in = {.textures = {&picture->colour},
                                    .frame = &picture->uniforms,
                                    .params = tone,
                                    .params_size = sizeof tone},
                         });
  return true;
}

// Input: `toned`. Output: `final`.
static bool draw_smooth(RenderPicture *picture, RenderError *error) {
  RenderCompose *compose = &picture->compose;
  const GpuProgramDesc desc = {
      .label = "antialias and dither", .file = "smooth.glsl", .defines = picture->drawn ? "#define FLAT 1\n" : NULL};
  if (!gpu_program_prepare(&compose->smooth_program, &desc, error)) return false;
  gpu_draw(picture->gpu, &(GpuDraw){
                             .program = &compose->smooth_program,
                             .target = &compose->final_target,
                             .in = {.textures = {&compose->toned}, .frame = &picture->uniforms},
                         });
  return true;
}

bool render_compose_draw(RenderPicture *picture, RenderError *error) {
  if (picture->settings->tone_map == RENDER_TONE_NONE) {
    return draw_tone(picture, "", &picture->compose.final_target, error);
  }
  const char *const curve = picture->drawn ? "#define FLAT 1\n" : "#define FILMIC 1\n";
  return draw_tone(picture, curve, &picture->compose.toned_target, error) && draw_smooth(picture, error);
}

bool render_compose_layer(RenderPicture *picture, const RenderLayer *layer, const GpuTexture *texture,
                          RenderError *error) {
  static const char *const maps[] = {"#define MAP_DEPTH 1\n", "#define MAP_NORMAL 1\n", "#define MAP_SCALAR 1\n",
                                     "#define MAP_COLOUR 1\n"};
  GpuProgram *program = &picture->compose.layer_program;
  const GpuProgramDesc desc = {.label = "layer", .file = "layer.glsl", .defines = maps[layer->map]};
  if (!gpu_program_prepare(program, &desc, error)) return false;
  const float mapping[4] = {(float)layer->channel, layer->top};
  gpu_draw(
      picture->gpu,
      &(GpuDraw){
          .program = program,
          .target = &picture->compose.final_target,
          .in = {.textures = {texture}, .frame = &picture->uniforms, .params = mapping, .params_size = sizeof mapping},
      });
  return true;
}
