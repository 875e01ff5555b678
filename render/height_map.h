// The water's height field on the GPU, as the style "heightfield" draws it: heights smoothed and refined, with slopes.
//
// Nodes come from the frame (SimHeightField); those near objects have been pulled to the objects' planes before
// (water_objects.h). Smoothing fits planes to the nodes that have water, weighted by a Gaussian: level and slanted water stay as
// they are, also at the border to what is dry. What lies beyond the outermost nodes is their mirror image.
#ifndef LIDO_RENDER_HEIGHT_MAP_H
#define LIDO_RENDER_HEIGHT_MAP_H

#include "render/picture.h"

typedef struct RenderHeightMap {
  GpuProgram row_program, column_program, slope_program;
  GpuBuffer nodes;       // (rows, columns) float: height over `reference`, m; DRY where there is no water
  GpuTexture moments[2]; // (rows of nodes, columns of texels): weighted sums along rows, see height_map_rows.glsl
  GpuTexture smooth;     // height (m), share of water [0, 1], –, –
  GpuTexture surface;    // height (m), share of water [0, 1], slope along x, slope along z; filtered linearly; RGBA32F
  GpuTarget moment_target, smooth_target, surface_target;
  float origin[2];       // m, x and z of the middle of texel (0, 0), which is node (0, 0)
  float spacing;         // m, between the middles of texels
  int32_t size[2];       // texels; 0 when the frame has no field
  float lowest, highest; // m, of the nodes with water; lowest > highest when there are none
  float level;           // m, their mean
  float slope[2];        // their mean slopes along x and z
} RenderHeightMap;

/// `heights`: (field->size[1], field->size[0]) m, NaN where there is no water. `smoothing`: standard deviation, spacings of
/// the nodes; 0: heights between nodes are interpolated, no more.
bool render_height_map_draw(RenderHeightMap *map, RenderPicture *picture, const SimHeightField *field,
                            const float *heights, float smoothing, RenderError *error);
void render_height_map_destroy(RenderHeightMap *map);

/// What height_map.glsl has of it, at the start of the block of pool.glsl.
typedef struct RenderHeightBlock {
  float place[4]; // texture coordinate of (x, z): (x, z)·place.xy + place.zw
  float range[4]; // lowest, highest, spacing of texels (m); –
  float slope[4]; // mean slopes along x and z; –
} RenderHeightBlock;
RenderHeightBlock render_height_block(const RenderHeightMap *map);

#endif
