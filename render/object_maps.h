// Pictures of the objects as plane water around them shows them, mirrored and refracted, and what shaders know about the water and
// its objects: Cords 2007, sections 2.1 to 2.3.
#ifndef LIDO_RENDER_OBJECT_MAPS_H
#define LIDO_RENDER_OBJECT_MAPS_H

#include "render/caustics.h"
#include "render/water_colours.h"
#include "render/water_objects.h"

/// Triangles of the surface: vertices along x and z, and texels of the height map from one to the next.
typedef struct RenderSurfaceMesh {
  int32_t size[2], step;
} RenderSurfaceMesh;

/// Struct Pool of pool.glsl and the objects of bodies.
typedef struct RenderPool {
  GpuBuffer pool;           // storage block 6
  GpuBuffer object_of_body; // storage block 5: (bodies) int32; −1: of the surroundings
  int32_t *staging;         // (capacity)
  int32_t capacity;
  bool surroundings; // there are bodies that belong to no object
} RenderPool;
bool render_pool_upload(RenderPool *pool, const RenderPicture *picture, const RenderHeightMap *map,
                        const RenderCaustics *caustics, const RenderWaterColours *colours, const RenderWaterObjects *objects,
                        const RenderSurfaceMesh *mesh, float border, RenderError *error);
void render_pool_destroy(RenderPool *pool);

/// The picture and a border around it, in the same pixels.
typedef enum RenderObjectMapKind {
  RENDER_REFRACTED = 0,
  RENDER_REFLECTED,
  RENDER_OBJECT_MAP_COUNT
} RenderObjectMapKind;
typedef struct RenderObjectMap {
  GpuProgram program[SIM_SHAPE_COUNT];
  GpuTexture colour; // linear light, coverage
  GpuTexture way;    // m from the plane along the ray of plane water; 0 where there is nothing
  GpuTarget target;
} RenderObjectMap;

typedef struct RenderObjectMaps {
  RenderObjectMap maps[RENDER_OBJECT_MAP_COUNT];
  GpuTexture depth;
  int32_t border; // pixels
} RenderObjectMaps;

bool render_object_maps_resize(RenderObjectMaps *maps, const RenderPicture *picture, RenderError *error);
void render_object_maps_destroy(RenderObjectMaps *maps);
/// `in`: what lights the objects. Without objects both maps are empty.
bool render_object_maps_draw(RenderObjectMaps *maps, RenderPicture *picture, const RenderPool *pool, GpuInputs in,
                             const char *defines, RenderError *error);

#endif
