// Obstacles from the frame to the GPU and into the picture or the sun map. Like particles, they may be absurd; those are
// left out. They are kept sorted by shape, and each shape has its own program.
#include "render/picture.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// struct Body of body.glsl, std430.
typedef struct Body {
  float position[3], unused;
  float half_size[3]; // m, of the box around the body, along its own axes
  float detail;       // stairs: number of steps; capsule: half the length of its straight part, m
  float rotation[4];  // unit quaternion x, y, z, w
  float colour[4];    // linear; –
} Body;

static const char *const shape_names[SIM_SHAPE_COUNT] = {"boxes",    "spheres", "cylinders",
                                                         "capsules", "stairs",  "meshes"};

#define MAX_STEPS 1000

// ---- From the frame --------------------------------------------------------------------------------------------------

static bool all_below(const float *values, int count, float limit) {
  for (int i = 0; i < count; ++i) {
    if (!(fabsf(values[i]) < limit)) return false;
  }
  return true;
}

// Place, axes and colour.
static bool place_body(Body *body, const SimObstacle *o) {
  const float *q = o->rotation;
  const float length = sqrtf(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(length > 1e-6f && length < 1e6f) || !all_below(o->position, 3, RENDER_FARTHEST)) return false;
  for (int k = 0; k < 3; ++k) {
    body->position[k] = o->position[k];
    body->colour[k] = render_clamp01(o->colour[k]);
  }
  for (int k = 0; k < 4; ++k) body->rotation[k] = q[k] / length;
  return true;
}

// All but meshes.
static bool size_body(Body *body, const SimObstacle *o) {
  const float *s = o->size;
  // A capsule that is shorter than wide is a ball.
  if (o->shape == SIM_CAPSULE && !(s[1] > 0)) return false;
  const float length = fmaxf(s[1], s[0]);
  // clang-format off
  const float full[][3] = {
    [SIM_BOX]      = { s[0], s[1],   s[2] },
    [SIM_SPHERE]   = { s[0], s[0],   s[0] },
    [SIM_CYLINDER] = { s[0], s[1],   s[0] },
    [SIM_CAPSULE]  = { s[0], length, s[0] },
    [SIM_STAIRS]   = { s[0], s[1],   s[2] },
  };
  // clang-format on
  for (int k = 0; k < 3; ++k) {
    body->half_size[k] = full[o->shape][k] / 2;
    if (!(body->half_size[k] > 0 && body->half_size[k] < RENDER_FARTHEST)) return false;
  }
  if (o->shape == SIM_CAPSULE) body->detail = body->half_size[1] - body->half_size[0];
  if (o->shape == SIM_STAIRS) body->detail = (float)o->steps;
  return o->shape != SIM_STAIRS || (o->steps >= 1 && o->steps <= MAX_STEPS);
}

// How far a turned box reaches along the world's axis k: its half edges, each by the size of that part of its direction. The
// direction of the box's own axis a is column a of the rotation's matrix.
static float reach_along(const float q[4], const float half[3], int k) {
  const float rows[3][3] = {
      {1 - 2 * (q[1] * q[1] + q[2] * q[2]), 2 * (q[0] * q[1] - q[2] * q[3]), 2 * (q[0] * q[2] + q[1] * q[3])},
      {2 * (q[0] * q[1] + q[2] * q[3]), 1 - 2 * (q[0] * q[0] + q[2] * q[2]), 2 * (q[1] * q[2] - q[0] * q[3])},
      {2 * (q[0] * q[2] - q[1] * q[3]), 2 * (q[1] * q[2] + q[0] * q[3]), 1 - 2 * (q[0] * q[0] + q[1] * q[1])}};
  return half[0] * fabsf(rows[k][0]) + half[1] * fabsf(rows[k][1]) + half[2] * fabsf(rows[k][2]);
}

static void add_to_bounds(RenderObstacles *obstacles, const Body *body, const float half[3]) {
  for (int k = 0; k < 3; ++k) {
    const float reach = reach_along(body->rotation, half, k);
    obstacles->bounds_min[k] = fminf(obstacles->bounds_min[k], body->position[k] - reach);
    obstacles->bounds_max[k] = fmaxf(obstacles->bounds_max[k], body->position[k] + reach);
  }
}

// Add the obstacle to `bodies` if it can be drawn. false: GL or the machine is out of memory.
static bool add_body(RenderObstacles *obstacles, Body *bodies, const SimFrame *frame, int32_t i, RenderError *error) {
  const SimObstacle *o = &frame->obstacles[i];
  Body *body = &bodies[obstacles->count];
  *body = (Body){0};
  const float *half = body->half_size;
  if (!place_body(body, o)) return true;
  if (o->shape == SIM_MESH) {
    int32_t mesh;
    if (!render_meshes_take(&obstacles->meshes, o->mesh, &mesh, error)) return false;
    if (mesh < 0) return true;
    obstacles->mesh_of_body[obstacles->count - obstacles->first[SIM_MESH]] = mesh;
    body->half_size[0] = obstacles->meshes.meshes[mesh].reach;
    half = obstacles->meshes.meshes[mesh].half;
  } else if (!size_body(body, o)) {
    return true;
  }
  add_to_bounds(obstacles, body, half);
  obstacles->obstacle_of_body[obstacles->count] = i;
  ++obstacles->count;
  return true;
}

static bool add_bodies(RenderObstacles *obstacles, Body *bodies, const SimFrame *frame, RenderError *error) {
  render_meshes_forget(&obstacles->meshes);
  for (int shape = 0; shape < SIM_SHAPE_COUNT; ++shape) {
    obstacles->first[shape] = obstacles->count;
    for (int32_t i = 0; i < frame->obstacle_count; ++i) {
      if ((int)frame->obstacles[i].shape == shape && !add_body(obstacles, bodies, frame, i, error)) return false;
    }
  }
  obstacles->first[SIM_SHAPE_COUNT] = obstacles->count;
  return true;
}

bool render_obstacles_upload(RenderPicture *picture, RenderError *error) {
  const SimFrame *frame = picture->frame;
  RenderObstacles *obstacles = &picture->obstacles;
  obstacles->count = 0;
  for (int k = 0; k < 3; ++k) {
    obstacles->bounds_min[k] = FLT_MAX;
    obstacles->bounds_max[k] = -FLT_MAX;
  }
  if (frame->obstacle_count <= 0 || frame->obstacles == NULL) {
    render_meshes_forget(&obstacles->meshes);
    return true;
  }
  const size_t most = (size_t)frame->obstacle_count;
  Body *bodies = malloc(sizeof *bodies * most);
  free(obstacles->mesh_of_body);
  free(obstacles->obstacle_of_body);
  obstacles->mesh_of_body = malloc(sizeof *obstacles->mesh_of_body * most);
  obstacles->obstacle_of_body = malloc(sizeof *obstacles->obstacle_of_body * most);
  bool ok = bodies != NULL && obstacles->mesh_of_body != NULL && obstacles->obstacle_of_body != NULL;
  if (!ok) gpu_fail(error, "out of memory for %d obstacles", frame->obstacle_count);
  ok = ok && add_bodies(obstacles, bodies, frame, error) &&
       gpu_buffer_write(&obstacles->bodies, "obstacles", bodies, sizeof *bodies * (size_t)obstacles->count, error);
  free(bodies);
  return ok;
}

void render_obstacles_destroy(RenderObstacles *obstacles) {
  for (int shape = 0; shape < SIM_SHAPE_COUNT; ++shape) {
    for (int looker = 0; looker < 3; ++looker) gpu_program_destroy(&obstacles->program[looker][shape]);
  }
  gpu_buffer_destroy(&obstacles->bodies);
  render_meshes_destroy(&obstacles->meshes);
  free(obstacles->mesh_of_body);
  free(obstacles->obstacle_of_body);
  *obstacles = (RenderObstacles){0};
}

// ---- Drawing ---------------------------------------------------------------------------------------------------------

static bool prepare(RenderPicture *picture, RenderLooker looker, int shape, RenderError *error) {
  static const char *const lookers[] = {"", " from the sun", " from the sun in the water"};
  const char *const choices[] = {picture->defines, "#define SUN 1\n", "#define SUN 1\n#define IN_WATER 1\n"};
  char label[64], defines[sizeof picture->defines + 64];
  snprintf(label, sizeof label, "%s%s", shape_names[shape], lookers[looker]);
  snprintf(defines, sizeof defines, "%s#define SHAPE %d\n", choices[looker], shape);
  const GpuProgramDesc desc = {
      .label = label, .file = shape == SIM_MESH ? "meshes.glsl" : "obstacles.glsl", .defines = defines};
  return gpu_program_prepare(&picture->obstacles.program[looker][shape], &desc, error);
}

// The closed mesh seen from within is not there, like every other body.
static void draw_meshes(RenderPicture *picture, RenderLooker looker, GpuDraw draw) {
  const RenderObstacles *obstacles = &picture->obstacles;
  draw.cull = looker == RENDER_EYE ? GPU_CULL_BACK : GPU_CULL_NONE;
  for (int32_t body = obstacles->first[SIM_MESH]; body < obstacles->count; ++body) {
    const RenderMesh *mesh = &obstacles->meshes.meshes[obstacles->mesh_of_body[body - obstacles->first[SIM_MESH]]];
    const int32_t which[4] = {body};
    draw.vertices = mesh->corner_count;
    draw.in.storage[1] = &mesh->corners;
    draw.in.params = which;
    draw.in.params_size = sizeof which;
    gpu_draw(picture->gpu, &draw);
  }
}

bool render_obstacles_draw(RenderPicture *picture, RenderLooker looker, GpuDraw draw, RenderError *error) {
  const RenderObstacles *obstacles = &picture->obstacles;
  draw.in.storage[0] = &obstacles->bodies;
  for (int shape = 0; shape < SIM_SHAPE_COUNT && obstacles->count > 0; ++shape) {
    const int32_t first = obstacles->first[shape], count = obstacles->first[shape + 1] - first;
    if (count == 0) continue;
    if (!prepare(picture, looker, shape, error)) return false;
    draw.program = &obstacles->program[looker][shape];
    if (shape == SIM_MESH) {
      draw_meshes(picture, looker, draw);
      continue;
    }
    draw.first_vertex = 36 * first;
    draw.vertices = 36 * count;
    // The far sides of the box are in view also from within it.
    draw.cull = looker == RENDER_EYE ? GPU_CULL_FRONT : GPU_CULL_NONE;
    gpu_draw(picture->gpu, &draw);
  }
  return true;
}
