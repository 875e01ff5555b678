// What surrounds the water and is shared by all styles: sky, floor, obstacles, and the container's edges, of which the
// back ones lie behind the water and the front ones over it.
#include "render/picture.h"

#include <stdio.h>

// Quads of edges.glsl and panes.glsl, for each shape of container: a glass has three circles of 96 pieces and two outlines,
// and one wall in 96 pieces.
static const int32_t edge_quads[] = {[SIM_CONTAINER_BOX] = 12, [SIM_CONTAINER_GLASS] = 3 * 96 + 2};
static const int32_t wall_quads[] = {[SIM_CONTAINER_BOX] = 4, [SIM_CONTAINER_GLASS] = 96};
static const char *const container_defines[] = {[SIM_CONTAINER_BOX] = "", [SIM_CONTAINER_GLASS] = "#define GLASS 1\n"};

bool render_background_resize(RenderPicture *picture, RenderError *error) {
  RenderBackground *background = &picture->background;
  const GpuTextureDesc colour = {"background", picture->width, picture->height, GPU_RGBA32F, false};
  return gpu_texture_create(&background->colour, &colour, error) &&
         gpu_target_create(
             &background->target,
             &(GpuTargetDesc){.label = "background", .colour = {&background->colour}, .depth = &picture->depth}, error);
}

void render_background_destroy(RenderPicture *picture) {
  RenderBackground *background = &picture->background;
  gpu_program_destroy(&background->sky_program);
  gpu_program_destroy(&background->floor_program);
  gpu_program_destroy(&background->pane_program);
  gpu_program_destroy(&background->edge_program[0]);
  gpu_program_destroy(&background->edge_program[1]);
  gpu_texture_destroy(&background->colour);
  gpu_target_destroy(&background->target);
}

static GpuInputs sunlit_inputs(const RenderPicture *picture) {
  return (GpuInputs){
      .textures = {[5] = &picture->sun_map.normal, [6] = &picture->sun_map.water, [7] = &picture->sun_map.solid},
      .frame = &picture->uniforms};
}

// Output: colour and depth of every pixel. The floor first, then the sky where nothing has been drawn: a software
// rasteriser skips what fails the depth test, but runs both sides of a branch.
static bool draw_world(RenderPicture *picture, RenderError *error) {
  RenderBackground *background = &picture->background;
  const GpuProgramDesc floor = {.label = "floor", .file = "floor.glsl", .defines = picture->defines};
  const GpuProgramDesc sky = {.label = "sky", .file = "backdrop.glsl", .defines = picture->defines};
  GpuDraw draw = {.target = &background->target, .in = sunlit_inputs(picture)};
  gpu_clear_depth(&background->target, GPU_FARTHEST);
  if (picture->settings->floor != RENDER_FLOOR_NONE) {
    if (!gpu_program_prepare(&background->floor_program, &floor, error)) return false;
    draw.program = &background->floor_program;
    draw.vertices = 12;
    draw.depth = GPU_DEPTH_WRITE;
    gpu_draw(picture->gpu, &draw);
  }
  if (!gpu_program_prepare(&background->sky_program, &sky, error)) return false;
  draw.program = &background->sky_program;
  draw.vertices = 0;
  draw.depth = GPU_DEPTH_TEST;
  gpu_draw(picture->gpu, &draw);
  return true;
}

// Output: colour and depth where a body is nearer.
static bool draw_obstacles(RenderPicture *picture, RenderError *error) {
  const GpuDraw draw = {.target = &picture->background.target, .depth = GPU_DEPTH_WRITE, .in = sunlit_inputs(picture)};
  return render_obstacles_draw(picture, RENDER_EYE, draw, error);
}

static bool draw_edges(RenderPicture *picture, const GpuTarget *out, bool front, RenderError *error) {
  if (picture->block.container_min[3] == 0) return true;
  GpuProgram *program = &picture->background.edge_program[front];
  const SimContainerShape shape = picture->frame->container.shape;
  char defines[sizeof picture->defines + 64];
  snprintf(defines, sizeof defines, "%s%s%s", picture->defines, container_defines[shape],
           front ? "#define FRONT 1\n" : "");
  const GpuProgramDesc desc = {.label = front ? "front edges" : "back edges", .file = "edges.glsl", .defines = defines};
  if (!gpu_program_prepare(program, &desc, error)) return false;
  gpu_draw(picture->gpu, &(GpuDraw){
                             .program = program,
                             .target = out,
                             .vertices = 6 * edge_quads[shape],
                             .depth = GPU_DEPTH_TEST,
                             .blend = GPU_BLEND_OVER,
                             .in = {.frame = &picture->uniforms},
                         });
  return true;
}

bool render_background_draw(RenderPicture *picture, RenderError *error) {
  if (!draw_world(picture, error) || !draw_obstacles(picture, error) ||
      !draw_edges(picture, &picture->background.target, false, error)) {
    return false;
  }
  gpu_texture_copy(&picture->background.colour, &picture->colour);
  return true;
}

static bool draw_panes(RenderPicture *picture, RenderError *error) {
  if (picture->block.container_min[3] == 0) return true;
  GpuProgram *program = &picture->background.pane_program;
  const SimContainerShape shape = picture->frame->container.shape;
  char defines[sizeof picture->defines + 32];
  snprintf(defines, sizeof defines, "%s%s", picture->defines, container_defines[shape]);
  const GpuProgramDesc desc = {.label = "glass", .file = "panes.glsl", .defines = defines};
  if (!gpu_program_prepare(program, &desc, error)) return false;
  gpu_draw(picture->gpu, &(GpuDraw){
                             .program = program,
                             .target = &picture->target,
                             .vertices = 6 * wall_quads[shape],
                             .depth = GPU_DEPTH_OFF,
                             .blend = GPU_BLEND_OVER,
                             .in = {.frame = &picture->uniforms},
                         });
  return true;
}

bool render_front_glass_draw(RenderPicture *picture, RenderError *error) {
  return draw_panes(picture, error) && draw_edges(picture, &picture->target, true, error);
}
