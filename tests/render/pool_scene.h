// A pool of 4 × 4 m with water half a metre deep, made by hand for the style "heightfield", and what stands in it.
#ifndef LIDO_TESTS_RENDER_POOL_SCENE_H
#define LIDO_TESTS_RENDER_POOL_SCENE_H

#include "tests/render/pool_trace.h"

enum { POOL_NODES = 101 };
#define POOL_SPACING 0.04f // m

/// Around the origin, its floor at 0; the pinned surroundings; heights are not smoothed.
typedef struct PoolScene {
  TestFrame *frame;
  float height[POOL_NODES * POOL_NODES];
  PoolWave wave;
  RenderSettings settings;
} PoolScene;
PoolScene *pool_scene_create(PoolWave wave);
void pool_scene_destroy(PoolScene *scene);

SimObstacle *pool_scene_add(PoolScene *scene, SimObstacle body);
/// A box, a ball, a leaning cylinder and stairs, all of which stand in the surface.
void pool_scene_add_bodies(PoolScene *scene);

/// From 3 m away, so many degrees above the horizon.
RenderView pool_scene_view(double degrees);

#endif
