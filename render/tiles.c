// Tiles of the picture in which there is water. Passes over the water's pixels draw only these, which saves most of their
// cost where the water fills a part of the picture.
#include "render/picture.h"

#include <stdlib.h>

#define ROW 1024 // spheres in a row of the dispatch

// std140 block of tiles.glsl
typedef struct TileParams {
  float scale, count, row, columns;
  float tile_size, unused[3];
} TileParams;

static bool clear_mask(RenderTiles *tiles, RenderError *error) {
  const size_t count = (size_t)tiles->columns * (size_t)tiles->rows;
  uint32_t *zeros = calloc(count, sizeof *zeros);
  if (zeros == NULL) return gpu_fail(error, "out of memory for %zu tiles", count);
  const bool written = gpu_buffer_write(&tiles->mask, "tiles", zeros, count * sizeof *zeros, error);
  free(zeros);
  return written;
}

bool render_tiles_mark(RenderPicture *picture, float scale, RenderError *error) {
  RenderTiles *tiles = &picture->tiles;
  const int32_t count = picture->particles.count;
  tiles->columns = (picture->width + RENDER_TILE_SIZE - 1) / RENDER_TILE_SIZE;
  tiles->rows = (picture->height + RENDER_TILE_SIZE - 1) / RENDER_TILE_SIZE;
  const GpuProgramDesc desc = {.label = "tiles", .file = "tiles.glsl", .compute = true};
  if (!clear_mask(tiles, error) || !gpu_program_prepare(&tiles->program, &desc, error)) return false;
  if (count == 0) return true;
  const TileParams params = {scale, (float)count, ROW, (float)tiles->columns, RENDER_TILE_SIZE, {0}};
  gpu_dispatch(picture->gpu, &(GpuDispatch){
                                 .program = &tiles->program,
                                 .width = ROW,
                                 .height = (count + ROW - 1) / ROW,
                                 .in = {.storage = {&picture->particles.spheres, &tiles->mask},
                                        .frame = &picture->uniforms,
                                        .params = &params,
                                        .params_size = sizeof params},
                             });
  return true;
}

void render_tiles_destroy(RenderTiles *tiles) {
  gpu_program_destroy(&tiles->program);
  gpu_buffer_destroy(&tiles->mask);
  *tiles = (RenderTiles){0};
}
