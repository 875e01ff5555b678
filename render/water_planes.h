// The water's surface around objects: the plane that it nearly is, and the height field made to agree with it. Plain C: no
// GL.
#ifndef LIDO_RENDER_WATER_PLANES_H
#define LIDO_RENDER_WATER_PLANES_H

#include "render/solids.h"

/// The nodes of a frame's height field.
typedef struct RenderWaterNodes {
  float *height;   // (size[1], size[0]) m; NaN where there is no water
  int32_t size[2]; // 0: none
  float origin[2]; // m, x and z of node (0, 0)
  float spacing;   // m, between nodes
  float lowest;    // m, mean where there is no water at all
  float mean;      // m, of the nodes with water
  bool wet;        // there is water
} RenderWaterNodes;

/// Mean height of the water not farther than `reach` from a box's footprint, or of all the water where there is none.
float render_water_level(const RenderWaterNodes *nodes, const float min[3], const float max[3], float reach);

/// The plane that fits best to the water between `from` and `to` of the solids (m); nearer nodes count more. Where there is
/// too little of it, a level one.
void render_water_plane_fit(const RenderWaterNodes *nodes, const RenderSolid *solids, int32_t count, float from,
                            float to, float plane[4]);

/// A plane and the solids around which the surface shall be pulled to it.
typedef struct RenderWaterPull {
  float plane[4];
  const RenderSolid *solids;
  int32_t count;
  float min[2], max[2]; // m, along x and z, around the solids
} RenderWaterPull;

/// Make the surface that of the planes where it is nearer than `full` to their solids, and blend linearly to what it is
/// within `blend` from there; 0: leave it. In both cases dry nodes in the solids and up to `fill` around them become the
/// plane's where water is near, so that the surface meets the solids without a gap. `marks`: (size[1], size[0]), scratch.
void render_water_pull(const RenderWaterNodes *nodes, const RenderWaterPull *pulls, int32_t count, float full,
                       float blend, float fill, uint8_t *marks);

#endif
