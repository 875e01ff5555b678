// Outlines in four passes over the tiles of the picture that have any: cracks between pixels where a line runs, places on
// the lines to a part of a pixel, the nearest of them along the row, and along the column, which gives the distance to the
// line. The two passes along rows and columns cost the width of the lines, not its square.
//
// Based on: Saito & Takahashi, "Comprehensible Rendering of 3-D Shapes", 1990 (edges from depths and normals); Meijster,
// Roerdink & Hesselink, "A General Algorithm for Computing Distance Transforms in Linear Time", 2000 (rows, then columns);
// Reshetov, "Morphological Antialiasing", 2009 (the line through a staircase of pixels).
#include "render/outlines.h"

#include <stdlib.h>

bool render_outlines_resize(RenderOutlines *outlines, const RenderPicture *picture, RenderError *error) {
  const GpuTextureDesc cracks = {"outlines: cracks", picture->width, picture->height, GPU_RGBA32F, false};
  const GpuTextureDesc seeds = {"outlines: seeds", picture->width, picture->height, GPU_RGBA32F, false};
  return gpu_texture_create(&outlines->cracks, &cracks, error) && gpu_texture_create(&outlines->seeds, &seeds, error) &&
         gpu_target_create(&outlines->crack_target,
                           &(GpuTargetDesc){.label = "outlines: cracks", .colour = {&outlines->cracks}}, error) &&
         gpu_target_create(&outlines->seed_target,
                           &(GpuTargetDesc){.label = "outlines: seeds", .colour = {&outlines->seeds}}, error);
}

void render_outlines_destroy(RenderOutlines *outlines) {
  gpu_program_destroy(&outlines->tile_program);
  gpu_buffer_destroy(&outlines->tiles);
  gpu_program_destroy(&outlines->crack_program);
  gpu_program_destroy(&outlines->seed_program);
  gpu_program_destroy(&outlines->row_program);
  gpu_program_destroy(&outlines->ink_program);
  gpu_texture_destroy(&outlines->cracks);
  gpu_texture_destroy(&outlines->seeds);
  gpu_target_destroy(&outlines->crack_target);
  gpu_target_destroy(&outlines->seed_target);
}

// ---- Tiles -----------------------------------------------------------------------------------------------------------

#define TILE 16 // pixels; TILES in the shaders
#define TILES "#define TILES 16\n"

static int32_t tile_count(const RenderPicture *picture) {
  return ((picture->width + TILE - 1) / TILE) * ((picture->height + TILE - 1) / TILE);
}

// Output: the tiles that lines may touch.
static bool mark_tiles(RenderOutlines *outlines, RenderPicture *picture, RenderOutlined outlined, RenderError *error) {
  const size_t size = (size_t)tile_count(picture) * sizeof(uint32_t);
  const GpuProgramDesc desc = {.label = "outlines: tiles",
                               .file = "outline_tiles.glsl",
                               .defines = outlined.normals ? TILES "#define NORMALS 1\n" : TILES,
                               .compute = true};
  uint32_t *zeros = calloc(1, size);
  if (zeros == NULL) return gpu_fail(error, "out of memory for %zu bytes of tiles", size);
  const bool cleared = gpu_buffer_write(&outlines->tiles, "outlines: tiles", zeros, size, error);
  free(zeros);
  if (!cleared || !gpu_program_prepare(&outlines->tile_program, &desc, error)) return false;
  gpu_dispatch(picture->gpu, &(GpuDispatch){.program = &outlines->tile_program,
                                            .width = picture->width,
                                            .height = picture->height,
                                            .in = {.textures = {outlined.surface},
                                                   .storage = {[7] = &outlines->tiles},
                                                   .frame = &picture->uniforms}});
  return true;
}

// ---- Passes ----------------------------------------------------------------------------------------------------------

typedef struct Pass {
  GpuProgram *program;
  const char *label, *file, *defines;
  const GpuTarget *out;
  GpuBlend blend;
  const GpuTexture *in[2];
} Pass;

// Over the marked tiles.
static bool run(const RenderOutlines *outlines, RenderPicture *picture, const Pass *pass, RenderError *error) {
  const GpuProgramDesc desc = {.label = pass->label, .file = pass->file, .defines = pass->defines};
  if (!gpu_program_prepare(pass->program, &desc, error)) return false;
  gpu_draw(picture->gpu, &(GpuDraw){.program = pass->program,
                                    .target = pass->out,
                                    .vertices = 6 * tile_count(picture),
                                    .blend = pass->blend,
                                    .in = {.textures = {pass->in[0], pass->in[1]},
                                           .storage = {[7] = &outlines->tiles},
                                           .frame = &picture->uniforms}});
  return true;
}

bool render_outlines_draw(RenderOutlines *outlines, RenderPicture *picture, RenderOutlined outlined,
                          const GpuTarget *out, RenderError *error) {
  const GpuTexture *surface = outlined.surface, *cracks = &outlines->cracks, *seeds = &outlines->seeds;
  const GpuTarget *to_cracks = &outlines->crack_target, *to_seeds = &outlines->seed_target;
  const float nothing[4] = {0, 0, 0, 0};
  const Pass passes[] = {
      {&outlines->crack_program,
       "outlines: cracks",
       "outline_cracks.glsl",
       outlined.normals ? TILES "#define NORMALS 1\n" : TILES,
       to_cracks,
       GPU_BLEND_OFF,
       {surface}},
      {&outlines->seed_program,
       "outlines: seeds",
       "outline_seeds.glsl",
       TILES,
       to_seeds,
       GPU_BLEND_OFF,
       {surface, cracks}},
      {&outlines->row_program,
       "outlines: rows",
       "outlines.glsl",
       TILES "#define ROWS 1\n",
       to_cracks,
       GPU_BLEND_OFF,
       {surface, seeds}},
      {&outlines->ink_program, "outlines: ink", "outlines.glsl", TILES, out, GPU_BLEND_OVER, {surface, cracks}},
  };
  if (picture->block.drawn_levels[3] == 0) return true;
  if (!mark_tiles(outlines, picture, outlined, error)) return false;
  gpu_clear_colour(to_cracks, 0, nothing);
  gpu_clear_colour(to_seeds, 0, nothing);
  for (size_t i = 0; i < sizeof passes / sizeof passes[0]; ++i) {
    if (!run(outlines, picture, &passes[i], error)) return false;
  }
  return true;
}
