// Particles that fly above the water's height field: balls of water. A height field cannot show them, and nothing may vanish.
#ifndef LIDO_RENDER_DROPS_H
#define LIDO_RENDER_DROPS_H

#include "render/picture.h"

typedef struct RenderDrops {
  GpuProgram program;
  GpuBuffer spheres; // (count, 2) vec4: centre and radius, m; linear colour, –
  int32_t count;
  float *staging; // (capacity, 8)
  int32_t capacity;
  GpuTexture behind; // the picture before the drops
} RenderDrops;

/// Is it above the field? Heights are NaN where there is no water: there every particle is. Splashes count from half
/// a radius above the surface on, other particles from two radii on.
bool render_is_drop(const SimFrame *frame, const SimHeightField *field, int32_t particle);

/// Those of a frame whose particles have classes.
bool render_drops_find(RenderDrops *drops, const SimFrame *frame, const SimHeightField *field, RenderError *error);
/// Over the picture at hand. `in`: what lights them, with the height map. `defines`: those of the scene, and TINTED
/// where particles have colours.
bool render_drops_draw(RenderDrops *drops, RenderPicture *picture, GpuInputs in, const char *defines,
                       RenderError *error);
void render_drops_destroy(RenderDrops *drops);

#endif
