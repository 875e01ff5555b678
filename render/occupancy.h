// Where in space there is water at all: a grid of bits. Maps of depth know where a body of water begins and ends for
// the eye, not whether it is hollow; this does.
#ifndef LIDO_RENDER_OCCUPANCY_H
#define LIDO_RENDER_OCCUPANCY_H

#include "render/picture.h"

typedef struct RenderOccupancy {
  GpuBuffer bits;    // uint32: bit c % 32 of word c / 32 is 1 where cell c = (z·size[1] + y)·size[0] + x holds water
  float origin[3];   // m, of cell (0, 0, 0)
  float cell;        // m
  int32_t size[3];   // cells; 0 when there are no particles
  uint32_t *staging; // (capacity)
  size_t capacity;   // words
} RenderOccupancy;

typedef enum RenderOccupancyGrain {
  RENDER_OCCUPANCY_COARSE, ///< cells of 4 radii; a point no farther than 1.6 radii from a particle along each axis is wet
  RENDER_OCCUPANCY_FINE    ///< cells of 1 radius; 2.2 radii. 64 times as many: slower to make and to walk through
} RenderOccupancyGrain;

/// From all particles of the frame; what is not finite is left out.
bool render_occupancy_upload(RenderOccupancy *occupancy, const SimFrame *frame, RenderOccupancyGrain grain,
                             RenderError *error);
/// What occupancy.glsl has of it in a std140 block.
typedef struct RenderOccupancyBlock {
  float grid[4];    // origin, edge of a cell; m
  int32_t cells[4]; // along each axis; –
} RenderOccupancyBlock;
RenderOccupancyBlock render_occupancy_block(const RenderOccupancy *occupancy);
void render_occupancy_destroy(RenderOccupancy *occupancy);

#endif
