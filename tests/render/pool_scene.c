#include "tests/render/pool_scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

PoolScene *pool_scene_create(PoolWave wave) {
  PoolScene *s = calloc(1, sizeof *s);
  assert_non_null(s);
  s->frame = test_frame_create(64, POOL_SPACING / 2);
  s->wave = wave;
  SimFrame *frame = &s->frame->frame;
  frame->container = (SimContainer){.min = {-2, 0, -2}, .max = {2, 1.2f, 2}};
  memcpy(frame->bounds_min, frame->container.min, sizeof frame->bounds_min);
  memcpy(frame->bounds_max, frame->container.max, sizeof frame->bounds_max);
  for (int i = 0; i < POOL_NODES * POOL_NODES; ++i) {
    const double x = -2 + (double)POOL_SPACING * (i % POOL_NODES), z = -2 + (double)POOL_SPACING * (i / POOL_NODES);
    s->height[i] = (float)pool_wave_at(x, z, &wave);
  }
  frame->height_field = (SimHeightField){{POOL_NODES, POOL_NODES}, {-2, -2}, POOL_SPACING, s->height, NULL};
  s->settings = harness_pinned_settings();
  s->settings.style = "heightfield";
  s->settings.heightfield.smoothing = 0;
  return s;
}

void pool_scene_destroy(PoolScene *s) {
  test_frame_destroy(s->frame);
  free(s);
}

SimObstacle *pool_scene_add(PoolScene *s, SimObstacle body) {
  SimObstacle *o = &s->frame->obstacles[s->frame->frame.obstacle_count++];
  *o = body;
  return o;
}

void pool_scene_add_bodies(PoolScene *s) {
  const SimObstacle bodies[] = {
      {SIM_BOX, {0.35f, 0.9f, 0.35f}, {-0.8f, 0.45f, 0.4f}, {0, 0.2588190f, 0, 0.9659258f}, {0.9f, 0.1f, 0.1f}},
      {SIM_SPHERE, {0.5f}, {0, 0.45f, 0.5f}, {0, 0, 0, 1}, {0.1f, 0.8f, 0.2f}},
      {SIM_CYLINDER, {0.3f, 0.8f, 0}, {0.8f, 0.4f, 0.3f}, {0, 0, 0.1736482f, 0.9848078f}, {0.9f, 0.8f, 0.1f}},
      {SIM_STAIRS, {0.9f, 0.6f, 0.5f}, {0.2f, 0.3f, -0.8f}, {0, 0, 0, 1}, {0.9f, 0.5f, 0.9f}, .steps = 4}};
  for (int i = 0; i < 4; ++i) pool_scene_add(s, bodies[i]);
}

RenderView pool_scene_view(double degrees) {
  const double angle = degrees * PI / 180, turn = 0.4, distance = 3;
  const float across = (float)(distance * cos(angle));
  return harness_view(across * (float)sin(turn), 0.45f + (float)(distance * sin(angle)), across * (float)cos(turn), 0,
                      0.45f, 0, 38);
}
