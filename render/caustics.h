// Sunlight that the water's surface bundles: Cords 2007, section 2.4. Traced caustics are the surface's triangles carried along
// their refracted rays to the floor or to the first object in the way, each with the light it took in, added up in a light map
// that looks along the sunlight as level water refracts it. Simple caustics are Eq. 4.
#ifndef LIDO_RENDER_CAUSTICS_H
#define LIDO_RENDER_CAUSTICS_H

#include "render/height_map.h"

typedef struct RenderCaustics {
  GpuBuffer frame;  // a Frame block in which the refracted sunlight is the sun's
  GpuTexture solid; // R32F: of what the refracted sun sees first in the water, its height along the map's axis (m)
  GpuTarget solid_target;
  GpuProgram landing_program, light_program;
  GpuTexture landing; // of the points of a grid: place in the map, light taken in there
  GpuTarget landing_target;
  GpuTexture raw; // the sum of what has landed
  GpuTarget raw_target;
  GpuProgram blur_program;
  GpuTexture light; // irradiance across the refracted sunlight, in the sun's, for red, green, blue; linear filter
  GpuTarget light_target;
  float u[4], v[4];  // dot(p, xyz) + w is the place in both maps, [0, 1]
  float extent[2];   // m, across the maps
  float way[3];      // unit, the refracted sunlight, downwards
  float level_light; // under level water: irradiance across it, in the sun's; 0 when there is no sunlight
  bool drawn;        // there is a light map
} RenderCaustics;

/// From picture->obstacles and the surface. Without a sun, without water or with a sun below the horizon nothing is drawn.
bool render_caustics_draw(RenderCaustics *caustics, RenderPicture *picture, const RenderHeightMap *map,
                          RenderError *error);
void render_caustics_destroy(RenderCaustics *caustics);

/// Definitions for shaders of what lies in the water, after the map was drawn: POOL, and UNTRACED when it was not.
const char *render_caustics_defines(const RenderCaustics *caustics);

/// What pool_light.glsl has of it, in the block of pool.glsl.
typedef struct RenderCausticsBlock {
  float u[4], v[4];
  float way[4];    // –
  float simple[4]; // a, b, c of Eq. 4; 1 when it is on
  float walls[4];  // middle (x, z) of a round container, radius at which the water is mirrored, m; radius 0: at the
                   // field's border; level_light
} RenderCausticsBlock;
RenderCausticsBlock render_caustics_block(const RenderCaustics *caustics, const RenderPicture *picture);

#endif
