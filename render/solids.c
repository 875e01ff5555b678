// Signed distances of the simple shapes: Quilez, Distance Functions, 2008–2024.
#include "render/solids.h"

#include "render/picture.h"

#include <math.h>

#define MAX_STEPS 1000

static float dot(const float a[3], const float b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static float clamp(float x, float low, float high) {
  return fminf(fmaxf(x, low), high);
}

// ---- From the frame --------------------------------------------------------------------------------------------------

static bool near_origin(const float p[3]) {
  return fabsf(p[0]) < RENDER_FARTHEST && fabsf(p[1]) < RENDER_FARTHEST && fabsf(p[2]) < RENDER_FARTHEST;
}

static bool take_axes(RenderSolid *solid, const float rotation[4]) {
  const float *r = rotation;
  const float length = sqrtf(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3]);
  if (!(length > 1e-6f && length < 1e6f)) return false;
  const float x = r[0] / length, y = r[1] / length, z = r[2] / length, w = r[3] / length;
  const float axis[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)},
                            {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)},
                            {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}};
  for (int k = 0; k < 3; ++k) {
    for (int c = 0; c < 3; ++c) solid->axis[k][c] = axis[k][c];
  }
  return true;
}

// The box around the vertices that are somewhere; `middle` is its own, from the origin of the vertices. It may be flat.
static bool take_mesh(RenderSolid *solid, const SimMesh *mesh, float middle[3]) {
  float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  if (mesh == NULL || mesh->vertex == NULL) return false;
  for (int32_t i = 0; i < mesh->vertex_count; ++i) {
    const float *v = mesh->vertex + 3 * (size_t)i;
    if (!near_origin(v)) continue;
    for (int k = 0; k < 3; ++k) {
      low[k] = fminf(low[k], v[k]);
      high[k] = fmaxf(high[k], v[k]);
    }
  }
  for (int k = 0; k < 3; ++k) {
    middle[k] = (low[k] + high[k]) / 2;
    solid->half[k] = (high[k] - low[k]) / 2;
  }
  return low[0] <= high[0];
}

static bool take_size(RenderSolid *solid, const SimObstacle *o) {
  const float *s = o->size;
  // A capsule that is shorter than wide is a ball.
  if (o->shape == SIM_CAPSULE && !(s[1] > 0)) return false;
  const bool ball = o->shape == SIM_SPHERE, round = ball || o->shape == SIM_CYLINDER || o->shape == SIM_CAPSULE;
  const float full[3] = {s[0], ball ? s[0] : o->shape == SIM_CAPSULE ? fmaxf(s[1], s[0]) : s[1], round ? s[0] : s[2]};
  for (int k = 0; k < 3; ++k) {
    solid->half[k] = full[k] / 2;
    if (!(solid->half[k] > 0 && solid->half[k] < RENDER_FARTHEST)) return false;
  }
  solid->steps = o->steps;
  return o->shape != SIM_STAIRS || (o->steps >= 1 && o->steps <= MAX_STEPS);
}

bool render_solid_take(RenderSolid *solid, const SimObstacle *obstacle) {
  *solid = (RenderSolid){.shape = obstacle->shape};
  float middle[3] = {0};
  if ((unsigned)obstacle->shape >= SIM_SHAPE_COUNT || !near_origin(obstacle->position)) return false;
  if (!take_axes(solid, obstacle->rotation)) return false;
  if (!(obstacle->shape == SIM_MESH ? take_mesh(solid, obstacle->mesh, middle) : take_size(solid, obstacle))) {
    return false;
  }
  for (int c = 0; c < 3; ++c) {
    solid->centre[c] = obstacle->position[c];
    for (int k = 0; k < 3; ++k) solid->centre[c] += middle[k] * solid->axis[k][c];
    const float direction[3] = {c == 0, c == 1, c == 2};
    const float extent = render_solid_extent(solid, direction);
    solid->min[c] = solid->centre[c] - extent;
    solid->max[c] = solid->centre[c] + extent;
  }
  return true;
}

// ---- Extents and distances -------------------------------------------------------------------------------------------

float render_solid_extent(const RenderSolid *solid, const float direction[3]) {
  const float *half = solid->half;
  const float up = fabsf(dot(direction, solid->axis[1]));
  switch (solid->shape) {
  case SIM_SPHERE:
    return half[0];
  case SIM_CAPSULE:
    return half[0] + up * (half[1] - half[0]);
  case SIM_CYLINDER:
    return up * half[1] + sqrtf(fmaxf(1 - up * up, 0)) * half[0];
  default:
    return fabsf(dot(direction, solid->axis[0])) * half[0] + up * half[1] +
           fabsf(dot(direction, solid->axis[2])) * half[2];
  }
}

// Of the set in which none of the excesses is positive.
static float corner_distance(const float excess[3]) {
  const float outside[3] = {fmaxf(excess[0], 0), fmaxf(excess[1], 0), fmaxf(excess[2], 0)};
  return sqrtf(dot(outside, outside)) + fminf(fmaxf(excess[0], fmaxf(excess[1], excess[2])), 0);
}

// Step k is the box from its riser to the end of the flight.
static float step_distance(const RenderSolid *solid, float step, const float p[3]) {
  const float *half = solid->half;
  const float begin = (2 * step / (float)solid->steps - 1) * half[0];
  const float top = (2 * (step + 1) / (float)solid->steps - 1) * half[1];
  const float excess[3] = {fmaxf(begin - p[0], p[0] - half[0]), fmaxf(-half[1] - p[1], p[1] - top),
                           fabsf(p[2]) - half[2]};
  return corner_distance(excess);
}

// A point outside is nearest to the tread over which it is, to the riser before which it is, to the edge that is nearest
// along the slope, or to the first or the last step: these few are enough, however many there are.
static float stairs_distance(const RenderSolid *solid, const float p[3]) {
  const float *half = solid->half, last = (float)solid->steps - 1;
  const float run = 2 * half[0] / (float)solid->steps, rise = 2 * half[1] / (float)solid->steps;
  const float x = p[0] + half[0], y = p[1] + half[1];
  const float edge = (x * run + (y - rise) * rise) / (run * run + rise * rise);
  const float steps[] = {0, last, floorf(x / run), floorf(y / rise), floorf(edge), floorf(edge) + 1};
  float nearest = INFINITY;
  for (size_t i = 0; i < sizeof steps / sizeof steps[0]; ++i) {
    nearest = fminf(nearest, step_distance(solid, clamp(steps[i], 0, last), p));
  }
  return nearest;
}

float render_solid_distance(const RenderSolid *solid, const float point[3]) {
  const float *half = solid->half;
  const float from[3] = {point[0] - solid->centre[0], point[1] - solid->centre[1], point[2] - solid->centre[2]};
  const float p[3] = {dot(from, solid->axis[0]), dot(from, solid->axis[1]), dot(from, solid->axis[2])};
  switch (solid->shape) {
  case SIM_SPHERE:
    return sqrtf(dot(p, p)) - half[0];
  case SIM_CAPSULE: {
    const float straight = half[1] - half[0], y = p[1] - clamp(p[1], -straight, straight);
    return sqrtf(p[0] * p[0] + y * y + p[2] * p[2]) - half[0];
  }
  case SIM_CYLINDER:
    return corner_distance((float[3]){sqrtf(p[0] * p[0] + p[2] * p[2]) - half[0], fabsf(p[1]) - half[1], -INFINITY});
  case SIM_STAIRS:
    return stairs_distance(solid, p);
  default:
    return corner_distance((float[3]){fabsf(p[0]) - half[0], fabsf(p[1]) - half[1], fabsf(p[2]) - half[2]});
  }
}

void render_solids_bounds(const RenderSolid *solids, int32_t count, float min[3], float max[3]) {
  for (int k = 0; k < 3; ++k) {
    min[k] = INFINITY;
    max[k] = -INFINITY;
    for (int32_t i = 0; i < count; ++i) {
      min[k] = fminf(min[k], solids[i].min[k]);
      max[k] = fmaxf(max[k], solids[i].max[k]);
    }
  }
}
