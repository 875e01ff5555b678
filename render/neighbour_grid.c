#include "render/neighbour_grid.h"

// Shaders index with what stands in the grid: it is checked once here.
static bool sensible(const SimFrame *frame, int64_t *cells) {
  const SimGrid *grid = &frame->grid;
  *cells = 1;
  for (int k = 0; k < 3; ++k) {
    if (grid->size[k] < 1 || *cells > INT32_MAX / grid->size[k]) return false;
    *cells *= grid->size[k];
  }
  if (grid->cell_start == NULL || !(grid->cell_size > 0) || grid->cell_start[0] != 0) return false;
  for (int64_t c = 0; c < *cells; ++c) {
    if (grid->cell_start[c] > grid->cell_start[c + 1]) return false;
  }
  return grid->cell_start[*cells] == frame->count;
}

bool render_neighbour_grid_upload(RenderNeighbourGrid *grid, RenderPicture *picture, RenderError *error) {
  const SimFrame *frame = picture->frame;
  int64_t cells;
  if (!sensible(frame, &cells)) return gpu_fail(error, "the frame's particles are not sorted by the cells of its grid");
  const size_t starts = (size_t)cells + 1, count = (size_t)frame->count,
               colours = picture->particles.tinted ? count : 1;
  return gpu_buffer_write(&grid->cell_start, "cells", frame->grid.cell_start, starts * sizeof(int32_t), error) &&
         gpu_buffer_view(&grid->cell_start, GPU_R32I, starts, error) &&
         gpu_buffer_view(&picture->particles.spheres, GPU_RGBA32F, count, error) &&
         gpu_buffer_view(&picture->particles.colours, GPU_RGBA32F, colours, error);
}

RenderGridBlock render_grid_block(const SimFrame *frame) {
  const SimGrid *g = &frame->grid;
  return (RenderGridBlock){{g->origin[0], g->origin[1], g->origin[2], g->cell_size},
                           {g->size[0], g->size[1], g->size[2], 0}};
}

void render_neighbour_grid_destroy(RenderNeighbourGrid *grid) {
  gpu_buffer_destroy(&grid->cell_start);
}
