// Tiles of the picture in which there is water. Passes over the water's pixels draw only these, which saves most of their
// cost where the water fills a part of the picture.
#include "render/picture.h"

#include <stdlib.h>

#define ROW 1024 // spheres in a row of the dispatch

// std140 block of tiles.glsl
typedef struct TileParams {
  float scale, count, row, columns;
  float tile_size, stride, unused[2];
} TileParams;

bool render_tiles_clear(RenderPicture *picture, RenderError *error) {
  RenderTiles *tiles = &picture->tiles;
  tiles->columns = (picture->width + RENDER_TILE_SIZE - 1) / RENDER_TILE_SIZE;
  tiles->rows = (picture->height + RENDER_TILE_SIZE - 1) / RENDER_TILE_SIZE;
  const size_t count = (size_t)tiles->columns * (size_t)tiles->rows;
  uint32_t *zeros = calloc(count, sizeof *zeros);
  if (zeros == NULL) return gpu_fail(error, "out of memory for %zu tiles", count);
  const bool written = gpu_buffer_write(&tiles->mask, "tiles", zeros, count * sizeof *zeros, error);
  free(zeros);
  return written;
}

// The spheres in a part of their buffer.
static void mark(RenderPicture *picture, const RenderTileMarks *marks, GpuPart part) {
  RenderTiles *tiles = &picture->tiles;
  const int32_t count = (int32_t)(part.size / (4 * sizeof(float) * (size_t)marks->stride));
  const TileParams params = {.scale = marks->scale,
                             .count = (float)count,
                             .row = ROW,
                             .columns = (float)tiles->columns,
                             .tile_size = RENDER_TILE_SIZE,
                             .stride = (float)marks->stride};
  gpu_dispatch(picture->gpu, &(GpuDispatch){
                                 .program = &tiles->program,
                                 .width = ROW,
                                 .height = (count + ROW - 1) / ROW,
                                 .in = {.storage = {marks->spheres, &tiles->mask},
                                        .parts = {part},
                                        .frame = &picture->uniforms,
                                        .params = &params,
                                        .params_size = sizeof params},
                             });
}

bool render_tiles_mark(RenderPicture *picture, const RenderTileMarks *marks, RenderError *error) {
  RenderTiles *tiles = &picture->tiles;
  const GpuProgramDesc desc = {.label = "tiles", .file = "tiles.glsl", .compute = true};
  if (!gpu_program_prepare(&tiles->program, &desc, error)) return false;
  const size_t each = 4 * sizeof(float) * (size_t)marks->stride;
  const int32_t most = gpu_block_elements(picture->gpu, each, error);
  if (most == 0) return false;
  for (int64_t first = 0; first < marks->count; first += most) {
    const int64_t left = marks->count - first;
    mark(picture, marks, (GpuPart){each * (size_t)first, each * (size_t)(left < most ? left : most)});
  }
  return true;
}

bool render_tile_pass(RenderPicture *picture, const RenderTilePass *pass, RenderError *error) {
  const RenderTiles *tiles = &picture->tiles;
  GpuProgramDesc desc = pass->desc;
  GpuInputs in = pass->in;
  desc.compute = !picture->gpu->software;
  in.storage[7] = &tiles->mask;
  in.frame = &picture->uniforms;
  if (!gpu_program_prepare(pass->program, &desc, error)) return false;
  if (desc.compute) {
    const int32_t scale = pass->scale > 0 ? pass->scale : 1;
    GpuDispatch dispatch = {.program = pass->program,
                            .width = (picture->width + scale - 1) / scale,
                            .height = (picture->height + scale - 1) / scale,
                            .in = in};
    for (int i = 0; i < GPU_MAX_COLOURS; ++i) dispatch.output[i] = pass->out[i];
    gpu_dispatch(picture->gpu, &dispatch);
  } else {
    gpu_draw(picture->gpu, &(GpuDraw){.program = pass->program,
                                      .target = pass->target,
                                      .vertices = 6 * tiles->columns * tiles->rows,
                                      .in = in});
  }
  return true;
}

void render_tiles_destroy(RenderTiles *tiles) {
  gpu_program_destroy(&tiles->program);
  gpu_buffer_destroy(&tiles->mask);
  *tiles = (RenderTiles){0};
}
