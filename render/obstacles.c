// Obstacles from the frame to the GPU. Like particles, they may be absurd; those are left out.
#include "render/picture.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

// struct Body of obstacles.glsl, std430.
typedef struct Body {
  float position[3], shape;   // m; SimShape
  float half_size[3], unused; // m: of the box around the body, along its own axes
  float rotation[4];          // unit quaternion x, y, z, w
  float colour[4];            // linear; –
} Body;

static bool all_below(const float *values, int count, float limit) {
  for (int i = 0; i < count; ++i) {
    if (!(fabsf(values[i]) < limit)) return false;
  }
  return true;
}

static bool body_from_obstacle(Body *body, const SimObstacle *o) {
  // clang-format off
  const float half[3][3] = {
    [SIM_BOX]      = { o->size[0] / 2, o->size[1] / 2, o->size[2] / 2 },
    [SIM_SPHERE]   = { o->size[0] / 2, o->size[0] / 2, o->size[0] / 2 },
    [SIM_CYLINDER] = { o->size[0] / 2, o->size[1] / 2, o->size[0] / 2 },
  };
  // clang-format on
  const float *q = o->rotation;
  const float length = sqrtf(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if ((unsigned)o->shape > SIM_CYLINDER || !(length > 1e-6f && length < 1e6f)) return false;
  if (!all_below(o->position, 3, RENDER_FARTHEST) || !all_below(half[o->shape], 3, RENDER_FARTHEST)) return false;
  *body = (Body){.shape = (float)o->shape};
  for (int k = 0; k < 3; ++k) {
    if (!(half[o->shape][k] > 0)) return false;
    body->position[k] = o->position[k];
    body->half_size[k] = half[o->shape][k];
    body->colour[k] = o->colour[k] > 0 ? fminf(o->colour[k], 1) : 0;
  }
  for (int k = 0; k < 4; ++k) body->rotation[k] = q[k] / length;
  return true;
}

// The box around a ball that holds the body however it is turned.
static void add_to_bounds(RenderObstacles *obstacles, const Body *body) {
  const float *half = body->half_size;
  const float reach = sqrtf(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]);
  for (int k = 0; k < 3; ++k) {
    obstacles->bounds_min[k] = fminf(obstacles->bounds_min[k], body->position[k] - reach);
    obstacles->bounds_max[k] = fmaxf(obstacles->bounds_max[k], body->position[k] + reach);
  }
}

bool render_obstacles_upload(RenderPicture *picture, RenderError *error) {
  const SimFrame *frame = picture->frame;
  RenderObstacles *obstacles = &picture->obstacles;
  obstacles->count = 0;
  for (int k = 0; k < 3; ++k) {
    obstacles->bounds_min[k] = FLT_MAX;
    obstacles->bounds_max[k] = -FLT_MAX;
  }
  if (frame->obstacle_count <= 0 || frame->obstacles == NULL) return true;
  Body *bodies = malloc(sizeof *bodies * (size_t)frame->obstacle_count);
  if (bodies == NULL) return gpu_fail(error, "out of memory for %d obstacles", frame->obstacle_count);
  for (int32_t i = 0; i < frame->obstacle_count; ++i) {
    Body *body = &bodies[obstacles->count];
    if (!body_from_obstacle(body, &frame->obstacles[i])) continue;
    add_to_bounds(obstacles, body);
    ++obstacles->count;
  }
  const size_t size = sizeof *bodies * (size_t)obstacles->count;
  const bool written = gpu_buffer_write(&obstacles->bodies, "obstacles", bodies, size, error);
  free(bodies);
  return written;
}
