// Colours of the particles in the water of a height field: the mean of each column, in the water below and in what hangs over it, on
// a grid of places. Only for frames whose particles have colours.
#ifndef LIDO_RENDER_WATER_COLOURS_H
#define LIDO_RENDER_WATER_COLOURS_H

#include "render/picture.h"

typedef struct RenderWaterColours {
  bool any;         // the frame has colours
  GpuBuffer values; // (2, rows, columns) vec4: linear colour of the water below and of what hangs over it, –
  float *sums;      // the same on the processor, with the number of particles
  size_t capacity;  // places there is room for
  float origin[2], spacing; // m: x and z of the first place; between places
  int32_t size[2];          // places along x and z
  float thin;               // m of water that have 1 − 1/e of their colour
} RenderWaterColours;

/// `field`: heights of the water below, NaN where there is none. false: out of memory.
bool render_water_colours_find(RenderWaterColours *colours, const SimFrame *frame, const SimHeightField *field,
                               RenderError *error);
void render_water_colours_destroy(RenderWaterColours *colours);

/// What water_colours.glsl has of it, in the block of pool.glsl.
typedef struct RenderColoursBlock {
  float grid[4];      // x and z of the first place, between places, thin; m
  int32_t numbers[4]; // places along x and z; –
} RenderColoursBlock;
RenderColoursBlock render_water_colours_block(const RenderWaterColours *colours);

#endif
