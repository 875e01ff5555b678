// Walls and obstacles: see boundary.h. Density share after the idea of Akinci et al., Versatile Rigid-Fluid Coupling for
// Incompressible SPH, 2012 (Eq. 3–5: a boundary counts like fluid at rest), with the sum over the boundary in closed form.
#include "sim/boundary.h"

#include <math.h>
#include <string.h>

// Free share along one axis between the two walls at low and high, and its derivative.
static float free_between(const SimWall *wall, float x, float low, float high, float *slope) {
  float lower, upper;
  float share = 1 - sim_wall_share(wall, x - low, &lower) - sim_wall_share(wall, high - x, &upper);
  *slope = upper - lower;
  return share > 0 ? share : 0;
}

static bool near_container(const SimBoundary *boundary, const float point[3]) {
  for (int k = 0; k < 3; k++)
    if (point[k] < boundary->container.min[k] + boundary->wall.reach ||
        point[k] > boundary->container.max[k] - boundary->wall.reach)
      return true;
  return false;
}

static bool near_body(const SimBody *body, const float point[3], float reach) {
  float d2 = 0, r = body->bound + reach;
  for (int k = 0; k < 3; k++) d2 += (point[k] - body->position[k]) * (point[k] - body->position[k]);
  return d2 < r * r;
}

void sim_boundary_solid(const SimBoundary *boundary, const float point[3], SimSolid *solid) {
  *solid = (SimSolid){.body = -1};
  float space = 1, slope[3] = {0, 0, 0}; // what is free, and its gradient
  if (near_container(boundary, point)) {
    float a[3], da[3];
    for (int k = 0; k < 3; k++)
      a[k] = free_between(&boundary->wall, point[k], boundary->container.min[k], boundary->container.max[k], &da[k]);
    space = a[0] * a[1] * a[2];
    slope[0] = da[0] * a[1] * a[2];
    slope[1] = a[0] * da[1] * a[2];
    slope[2] = a[0] * a[1] * da[2];
  }
  for (int32_t b = 0; b < boundary->body_count; b++) {
    if (!near_body(&boundary->bodies[b], point, boundary->wall.reach)) continue;
    float g[3], rest = 1 - sim_body_solid(&boundary->bodies[b], &boundary->wall, point, g);
    for (int k = 0; k < 3; k++) slope[k] = slope[k] * rest - space * g[k];
    space *= rest;
  }
  for (int k = 0; k < 3; k++) solid->gradient[k] = -slope[k];
  solid->share = 1 - space;
}

bool sim_boundary_near_box(const SimBoundary *boundary, const float low[3], const float high[3], float margin) {
  float reach = boundary->wall.reach + margin;
  for (int k = 0; k < 3; k++)
    if (low[k] < boundary->container.min[k] + reach || high[k] > boundary->container.max[k] - reach) return true;
  for (int32_t b = 0; b < boundary->body_count; b++) {
    const SimBody *body = &boundary->bodies[b];
    float d2 = 0, r = body->bound + reach;
    for (int k = 0; k < 3; k++) {
      float outside = fmaxf(0, fmaxf(low[k] - body->position[k], body->position[k] - high[k]));
      d2 += outside * outside;
    }
    if (d2 < r * r) return true;
  }
  return false;
}

// ---- Clamp -----------------------------------------------------------------------------------------------------------

static void clamp_to_container(const SimBoundary *boundary, float point[3]) {
  for (int k = 0; k < 3; k++) {
    float low = boundary->container.min[k] + boundary->clearance,
          high = boundary->container.max[k] - boundary->clearance;
    if (low > high) low = high = 0.5f * (boundary->container.min[k] + boundary->container.max[k]);
    // Written so that a NaN passes through and is caught by the world, not hidden.
    if (point[k] < low) point[k] = low;
    if (point[k] > high) point[k] = high;
  }
}

static float body_gap(const SimBoundary *boundary, int32_t b, const float point[3]) {
  float normal[3];
  return sim_body_distance(&boundary->bodies[b], point, normal);
}

// Walk from `from` towards `to` in steps of the distance to the body (sphere tracing); stop where it is reached.
static void stop_at_body(const SimBoundary *boundary, int32_t b, const float from[3], float to[3]) {
  float d[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
  float length = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  float touch = 0.25f * boundary->clearance, travelled = 0;
  for (int step = 0; step < 32 && travelled < length; step++) {
    float t = travelled / length, p[3] = {from[0] + t * d[0], from[1] + t * d[1], from[2] + t * d[2]};
    float gap = body_gap(boundary, b, p);
    if (gap <= touch && step > 0) {
      memcpy(to, p, sizeof p);
      return;
    }
    travelled += gap > touch ? gap : touch;
  }
}

static bool push_out_of_bodies(const SimBoundary *boundary, float point[3]) {
  bool moved = false;
  for (int32_t b = 0; b < boundary->body_count; b++) {
    if (!near_body(&boundary->bodies[b], point, boundary->clearance)) continue;
    float normal[3], gap = sim_body_distance(&boundary->bodies[b], point, normal);
    if (!(gap < boundary->clearance * 0.999f)) continue;
    for (int k = 0; k < 3; k++) point[k] += (boundary->clearance - gap) * normal[k];
    moved = true;
  }
  return moved;
}

static float deepest(const SimBoundary *boundary, const float point[3]) {
  float least = INFINITY;
  for (int32_t b = 0; b < boundary->body_count; b++) least = fminf(least, body_gap(boundary, b, point));
  return least;
}

void sim_boundary_clamp(const SimBoundary *boundary, const float from[3], float to[3]) {
  clamp_to_container(boundary, to);
  if (boundary->body_count == 0) return;
  float d2 = 0;
  for (int k = 0; k < 3; k++) d2 += (to[k] - from[k]) * (to[k] - from[k]);
  float length = sqrtf(d2);
  bool near = false;
  for (int32_t b = 0; b < boundary->body_count; b++) {
    if (!near_body(&boundary->bodies[b], to, boundary->clearance + length)) continue;
    near = true;
    if (body_gap(boundary, b, from) < length) stop_at_body(boundary, b, from, to);
  }
  if (!near) return;
  for (int round = 0; round < 4 && push_out_of_bodies(boundary, to); round++) clamp_to_container(boundary, to);
  // Wedged between an obstacle and a wall that are nearer to each other than a particle is wide: stay where it was.
  if (deepest(boundary, to) < 0) memcpy(to, from, 3 * sizeof(float));
}

bool sim_boundary_free(const SimBoundary *boundary, const float point[3]) {
  float needed = 0.9f * boundary->clearance;
  for (int k = 0; k < 3; k++)
    if (!(point[k] >= boundary->container.min[k] + needed && point[k] <= boundary->container.max[k] - needed))
      return false;
  return boundary->body_count == 0 || deepest(boundary, point) >= needed;
}
