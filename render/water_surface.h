// The surface of aggregated water as the eye sees it: the depth of its front and of its back at every pixel, smoothed, and
// their normals (Imai, Kanamori, Mitani, 2016, sections 4.2 and 4.3).
//
// Between the passes a map holds 1 / depth, which is an affine function of the pixel's place wherever the surface is a
// plane; 0 is no water.
#ifndef LIDO_RENDER_WATER_SURFACE_H
#define LIDO_RENDER_WATER_SURFACE_H

#include "render/occupancy.h"
#include "render/quadrics.h"

typedef struct RenderWaterSurface {
  GpuProgram depth_program, gather_program, clip_program;
  bool submerged; // the eye is in the water
  // only then, made when first needed
  GpuProgram air_program;
  GpuTexture air; // depth (m) at which the air begins; 1e9: nowhere
  GpuTarget air_target;
  GpuTexture raw; // 1 / depth of the nearest front, depth of the farthest back
  GpuTarget raw_target;
  GpuTexture inverse[2]; // 1 / depth of front and back, smoothed by turns from one into the other
  GpuTarget inverse_target[2];
  int smoothed; // which of them the last pass wrote
  int uncut;    // which holds the surface before the container's walls cut it off
  GpuProgram smoothing_program[2];
  GpuProgram normal_program[2];
  GpuTarget surface_target; // both of
  GpuTexture front, back;   // outward unit normal in world axes, depth (m); 0 where there is none
  // only for plane_fit and none, made when first needed: analytic normals
  GpuProgram quadric_program[2];
  GpuTexture raw_normal[2], raw_depth;
  GpuTarget raw_normal_target[2];
} RenderWaterSurface;

bool render_water_surface_resize(RenderWaterSurface *surface, int32_t width, int32_t height, RenderError *error);
void render_water_surface_destroy(RenderWaterSurface *surface);

/// Input: the ellipsoids, the tiles that they may touch. Output: raw and inverse[0]. `around`: the water that the eye is
/// in, of which the back is then where the first air begins; NULL when the eye is in the air.
bool render_water_surface_depths(RenderWaterSurface *surface, RenderPicture *picture, const RenderQuadrics *quadrics,
                                 const RenderOccupancy *around, RenderError *error);
/// Input: inverse[0] and, for filters that start from the particles' own normals, the ellipsoids. Output: inverse[smoothed], cut
/// off at the container's walls; where the eye is in the water its front is at the near distance.
bool render_water_surface_smooth(RenderWaterSurface *surface, RenderPicture *picture, const RenderQuadrics *quadrics,
                                 RenderError *error);
/// Input: inverse[smoothed], inverse[uncut]. Output: front and back.
bool render_water_surface_normals(RenderWaterSurface *surface, RenderPicture *picture, RenderError *error);

#endif
