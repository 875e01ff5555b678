// What scene.glsl needs of a picture: which shapes there are, and the solids.
#ifndef LIDO_RENDER_SCENE_RAYS_H
#define LIDO_RENDER_SCENE_RAYS_H

#include "render/picture.h"

/// The picture's defines and those that tell scene.glsl what there is to meet; a software rasteriser runs both sides of a
/// branch, so that they are made when a shader is compiled. Returns what snprintf does.
int render_scene_defines(const RenderPicture *picture, char *defines, size_t size);

/// The shape of the container that water is cut off at, as a definition for shaders: CLIP_BOX, CLIP_GLASS or, where the frame
/// has no container that could hold anything, none.
const char *render_container_define(const SimFrame *frame);

/// std140: the ends of the bodies of each shape, `body_end` of scene.glsl.
typedef struct RenderBodyEnds {
  int32_t ends[8];
} RenderBodyEnds;
RenderBodyEnds render_body_ends(const RenderPicture *picture);

#endif
