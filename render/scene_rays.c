#include "render/scene_rays.h"

#include <stdio.h>

int render_scene_defines(const RenderPicture *picture, char *defines, size_t size) {
  const RenderObstacles *o = &picture->obstacles;
  const int32_t *first = o->first;
  const bool edges = picture->block.container_min[3] != 0 && picture->frame->container.shape == SIM_CONTAINER_BOX;
  return snprintf(defines, size,
                  "%s%s%s#define BOXES %d\n#define BALLS %d\n#define CYLINDERS %d\n#define CAPSULES %d\n"
                  "#define STAIRS %d\n#define MESHES %d\n",
                  picture->defines, edges ? "#define BOX_EDGES 1\n" : "", o->count > 0 ? "#define BODIES 1\n" : "",
                  o->count > 0 && first[1] > first[0], o->count > 0 && first[2] > first[1],
                  o->count > 0 && first[3] > first[2], o->count > 0 && first[4] > first[3],
                  o->count > 0 && first[5] > first[4], o->count > 0 && first[6] > first[5]);
}

RenderBodyEnds render_body_ends(const RenderPicture *picture) {
  RenderBodyEnds ends = {{0}};
  for (int shape = 0; shape < SIM_SHAPE_COUNT; ++shape) ends.ends[shape] = picture->obstacles.first[shape + 1];
  return ends;
}

const char *render_container_define(const SimFrame *frame) {
  const SimContainer *c = &frame->container;
  bool sensible = frame->has_container;
  for (int k = 0; k < 3; ++k) {
    sensible = sensible && c->min[k] > -RENDER_FARTHEST && c->max[k] < RENDER_FARTHEST && c->min[k] < c->max[k];
  }
  if (sensible && c->shape == SIM_CONTAINER_BOX) return "#define CLIP_BOX 1\n";
  if (sensible && c->shape == SIM_CONTAINER_GLASS) return "#define CLIP_GLASS 1\n";
  return "";
}
