// The frame's cell-sorted particles on the GPU as they are, so that shaders find the neighbours of any point.
#ifndef LIDO_RENDER_NEIGHBOUR_GRID_H
#define LIDO_RENDER_NEIGHBOUR_GRID_H

#include "render/picture.h"

typedef struct RenderNeighbourGrid {
  GpuBuffer cell_start; // int32, a view: see SimGrid
} RenderNeighbourGrid;

/// What neighbours.glsl has of it, first in its std140 block.
typedef struct RenderGridBlock {
  float grid[4];    // origin, edge of a cell; m
  int32_t cells[4]; // along each axis; –
} RenderGridBlock;

/// Output: the cells and a view of the particles (views 0 and 1 of neighbours.glsl). false: the frame has no sensible grid, or
/// it is larger than the driver allows.
bool render_neighbour_grid_upload(RenderNeighbourGrid *grid, RenderPicture *picture, RenderError *error);
RenderGridBlock render_grid_block(const SimFrame *frame);
void render_neighbour_grid_destroy(RenderNeighbourGrid *grid);

#endif
