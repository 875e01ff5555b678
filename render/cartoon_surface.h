// The surface of drawn water: the depth of the particles' spheres, its outline made smooth, the depth smoothed, and normals
// (Rocha Neto, Guimarães, Apolinário, Mello 2014, sections III-A and III-B).
//
// The body of water and the drops apart from it are two layers, each with maps of its own, so that neither changes the
// other. The maps are as large as the picture, or half as large; cartoon_map.glsl tells what they hold. Their depths are
// inverse, which are affine functions of the pixel's place wherever the surface is a plane.
#ifndef LIDO_RENDER_CARTOON_SURFACE_H
#define LIDO_RENDER_CARTOON_SURFACE_H

#include "render/quadrics.h"

typedef struct RenderCartoonLayer {
  GpuTexture raw; // 1 / depth of the nearest sphere, depth of the farthest back
  GpuTarget raw_target;
  GpuTexture map[2]; // of cartoon_map.glsl, smoothed by turns from one into the other
  GpuTarget map_target[2];
  int smoothed;       // which of them the last pass wrote
  GpuTexture surface; // outward unit normal in world axes, depth (m); 0 where there is none
  GpuTarget surface_target;
} RenderCartoonLayer;

enum { RENDER_BODY = 0, RENDER_DROPS = 1, RENDER_CARTOON_LAYERS = 2 };

typedef struct RenderCartoonSurface {
  int32_t scale; // pixels of the picture across one of the maps
  RenderCartoonLayer layer[RENDER_CARTOON_LAYERS];
  GpuProgram depth_program[RENDER_CARTOON_LAYERS];
  GpuProgram tidy_program[RENDER_CARTOON_LAYERS];
  GpuProgram row_program, column_program, full_program, flow_program, normal_program;
} RenderCartoonSurface;

/// Also changes the scale of what is there. Maps are empty after.
bool render_cartoon_surface_resize(RenderCartoonSurface *surface, const RenderPicture *picture, int32_t scale,
                                   RenderError *error);
void render_cartoon_surface_destroy(RenderCartoonSurface *surface);
/// No water in a layer.
void render_cartoon_surface_clear(RenderCartoonSurface *surface, int layer);

/// Input: spheres as ellipsoids (body) and balls (drops), the tiles that they may touch. Output: raw, map[0].
bool render_cartoon_surface_depths(RenderCartoonSurface *surface, RenderPicture *picture,
                                   const RenderQuadrics *quadrics, int layer, RenderError *error);
/// Input: map[0]. Output: map[smoothed].
bool render_cartoon_surface_smooth(RenderCartoonSurface *surface, RenderPicture *picture,
                                   const RenderQuadrics *quadrics, int layer, RenderError *error);
/// Input: map[smoothed]. Output: surface.
bool render_cartoon_surface_normals(RenderCartoonSurface *surface, RenderPicture *picture, int layer,
                                    RenderError *error);

#endif
