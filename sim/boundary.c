// Walls and obstacles in the density sum: see boundary.h. After the idea of Akinci et al., Versatile Rigid-Fluid
// Coupling for Incompressible SPH, 2012 (Eq. 3–5: a boundary counts like fluid at rest), with the sum over the boundary
// in closed form.
//
// How shares are put together. F_k is the share of the container's faces across axis k, s_b that of body b.
// - Faces at right angles: what is free is A = Π (1 − F_k), see wall.h.
// - A body inside the container shares no volume with the walls, so shares add up: A − s is free. This is the corner
//   where a box stands on the floor. A body that reaches through a face, a pillar sunk into the floor, is as good as
//   independent of that face, as the faces are of each other: (1 − F) (1 − s) is free. How far it reaches through the
//   face, in spacings, weighs between the two: w in [0, 1], and A − s Π (1 − w_k F_k) is free.
// - A body wholly outside of the container, the deck around a pool, counts for nothing: the face before it is what the
//   water feels, and it would be felt twice.
// - Several bodies: each leaves the same part of what the others leave free. Those that touch each other count a little
//   less in the edge where they meet than they should, as if each reached into the other.
#include "sim/boundary.h"

#include <math.h>
#include <string.h>

// ---- The container ---------------------------------------------------------------------------------------------------

// The container's faces in its own coordinates. A box has two faces across each axis; a glass has its side across the
// radius (axis 0), floor and lid across y (axis 1) and nothing across axis 2.
typedef struct Faces {
  float share[3][2], slope[3][2]; ///< of the lower and the upper face, and the derivatives, 1/m
  float outward[2];               ///< glass: the direction of the radius in x and z
} Faces;

static void glass_axis(const SimContainer *container, float axis[2], float *radius) {
  axis[0] = 0.5f * (container->min[0] + container->max[0]);
  axis[1] = 0.5f * (container->min[2] + container->max[2]);
  *radius = 0.5f * sim_smaller(container->max[0] - container->min[0], container->max[2] - container->min[2]);
}

static void face_pair(const SimBoundary *boundary, Faces *faces, int k, float x) {
  const SimContainer *c = &boundary->container;
  faces->share[k][0] = sim_wall_share(&boundary->wall, x - c->min[k], &faces->slope[k][0]);
  faces->share[k][1] = sim_wall_share(&boundary->wall, c->max[k] - x, &faces->slope[k][1]);
  faces->slope[k][1] = -faces->slope[k][1];
}

static void glass_faces(const SimBoundary *boundary, const float point[3], Faces *faces) {
  float axis[2], radius;
  *faces = (Faces){0};
  glass_axis(&boundary->container, axis, &radius);
  float x = point[0] - axis[0], z = point[2] - axis[1], r = sqrtf(x * x + z * z);
  if (r > 0) faces->outward[0] = x / r, faces->outward[1] = z / r;
  float shift = 0.5f * boundary->wall.spread / radius; // the wall bends around the water
  faces->share[0][1] = sim_wall_share(&boundary->wall, radius - r - shift, &faces->slope[0][1]);
  faces->slope[0][1] = -faces->slope[0][1];
  face_pair(boundary, faces, 1, point[1]);
}

static void container_faces(const SimBoundary *boundary, const float point[3], Faces *faces) {
  if (boundary->container.shape == SIM_CONTAINER_GLASS) {
    glass_faces(boundary, point, faces);
    return;
  }
  for (int k = 0; k < 3; k++) face_pair(boundary, faces, k, point[k]);
}

// A derivative in the container's coordinates as one in space.
static void gradient_of(const SimBoundary *boundary, const Faces *faces, const float slope[3], float gradient[3]) {
  memcpy(gradient, slope, 3 * sizeof(float));
  if (boundary->container.shape != SIM_CONTAINER_GLASS) return;
  gradient[0] = slope[0] * faces->outward[0];
  gradient[2] = slope[0] * faces->outward[1];
}

/// One number for each face.
typedef struct Weights {
  float w[3][2];
} Weights;

// Π (1 − w F) over the axes, never negative, and its gradient.
static float left_free(const SimBoundary *boundary, const Faces *faces, const Weights *weights, float gradient[3]) {
  float a[3], da[3];
  for (int k = 0; k < 3; k++) {
    const float *w = weights->w[k];
    a[k] = 1 - w[0] * faces->share[k][0] - w[1] * faces->share[k][1];
    da[k] = -w[0] * faces->slope[k][0] - w[1] * faces->slope[k][1];
    if (a[k] < 0) a[k] = da[k] = 0;
  }
  const float slope[3] = {da[0] * a[1] * a[2], a[0] * da[1] * a[2], a[0] * a[1] * da[2]};
  gradient_of(boundary, faces, slope, gradient);
  return a[0] * a[1] * a[2];
}

static const Weights whole = {{{1, 1}, {1, 1}, {1, 1}}};

static bool near_container(const SimBoundary *boundary, const float low[3], const float high[3], float reach) {
  const SimContainer *c = &boundary->container;
  bool glass = c->shape == SIM_CONTAINER_GLASS;
  for (int k = 0; k < 3; k++) {
    if (glass && k != 1) continue;
    if (!(low[k] >= c->min[k] + reach && high[k] <= c->max[k] - reach)) return true;
  }
  if (!glass) return false;
  float axis[2], radius;
  glass_axis(c, axis, &radius);
  float x = sim_larger(axis[0] - low[0], high[0] - axis[0]), z = sim_larger(axis[1] - low[2], high[2] - axis[1]);
  reach += 0.5f * boundary->wall.spread / radius;
  return !(reach < radius && x * x + z * z <= (radius - reach) * (radius - reach));
}

void sim_boundary_into_container(const SimBoundary *boundary, float clearance, float point[3]) {
  const SimContainer *c = &boundary->container;
  bool glass = c->shape == SIM_CONTAINER_GLASS;
  for (int k = 0; k < 3; k++) {
    if (glass && k != 1) continue;
    float low = c->min[k] + clearance, high = c->max[k] - clearance;
    if (low > high) low = high = 0.5f * (c->min[k] + c->max[k]);
    // Written so that a NaN passes through and is caught by the world, not hidden.
    if (point[k] < low) point[k] = low;
    if (point[k] > high) point[k] = high;
  }
  if (!glass) return;
  float axis[2], radius;
  glass_axis(c, axis, &radius);
  float x = point[0] - axis[0], z = point[2] - axis[1], most = sim_larger(0, radius - clearance), r2 = x * x + z * z;
  if (!(r2 > most * most)) return;
  float scale = most / sqrtf(r2);
  point[0] = axis[0] + scale * x;
  point[2] = axis[1] + scale * z;
}

static bool in_container(const SimBoundary *boundary, float clearance, const float point[3]) {
  const SimContainer *c = &boundary->container;
  bool glass = c->shape == SIM_CONTAINER_GLASS;
  for (int k = 0; k < 3; k++) {
    if (glass && k != 1) continue;
    if (!(point[k] >= c->min[k] + clearance && point[k] <= c->max[k] - clearance)) return false;
  }
  if (!glass) return true;
  float axis[2], radius;
  glass_axis(c, axis, &radius);
  float x = point[0] - axis[0], z = point[2] - axis[1], most = radius - clearance;
  return most >= 0 && x * x + z * z <= most * most;
}

// ---- Bodies ----------------------------------------------------------------------------------------------------------

bool sim_boundary_beyond(const SimContainer *container, const SimBody *body, float tolerance) {
  float low[3], high[3], axis[2], radius, off[2];
  sim_body_box(body, low, high);
  for (int k = 0; k < 3; k++)
    if (low[k] >= container->max[k] - tolerance || high[k] <= container->min[k] + tolerance) return true;
  if (container->shape != SIM_CONTAINER_GLASS) return false;
  glass_axis(container, axis, &radius);
  for (int k = 0; k < 2; k++) off[k] = sim_larger(0, sim_larger(low[2 * k] - axis[k], axis[k] - high[2 * k]));
  return hypotf(off[0], off[1]) >= radius - tolerance;
}

static bool near_body(const SimBody *body, const float point[3], float reach) {
  if (body->beyond) return false;
  float d2 = 0, r = body->bound + reach;
  for (int k = 0; k < 3; k++) d2 += (point[k] - body->position[k]) * (point[k] - body->position[k]);
  return d2 < r * r;
}

// How far a body reaches through each face, from 0 (not) to 1 (by a spacing or more).
static void reach_through(const SimBoundary *boundary, const SimBody *body, Weights *weights) {
  float(*weight)[2] = weights->w;
  const SimContainer *c = &boundary->container;
  float low[3], high[3];
  sim_body_box(body, low, high);
  for (int k = 0; k < 3; k++) weight[k][0] = c->min[k] - low[k], weight[k][1] = high[k] - c->max[k];
  if (c->shape == SIM_CONTAINER_GLASS) {
    float axis[2], radius, x = body->position[0], z = body->position[2];
    glass_axis(c, axis, &radius);
    float corner =
        hypotf(sim_larger(axis[0] - low[0], high[0] - axis[0]), sim_larger(axis[1] - low[2], high[2] - axis[1]));
    weight[0][1] = sim_smaller(corner, hypotf(x - axis[0], z - axis[1]) + body->bound) - radius;
    weight[0][0] = weight[2][0] = weight[2][1] = 0;
  }
  for (int k = 0; k < 3; k++)
    for (int side = 0; side < 2; side++)
      weight[k][side] = sim_smaller(sim_larger(weight[k][side] / boundary->wall.spacing, 0), 1);
}

static void add_velocity(const SimBody *body, const float point[3], float share, SimSolid *solid) {
  float d[3];
  const float *w = body->spin, *v = body->velocity;
  for (int k = 0; k < 3; k++) d[k] = point[k] - body->position[k];
  solid->velocity[0] += share * (v[0] + w[1] * d[2] - w[2] * d[1]);
  solid->velocity[1] += share * (v[1] + w[2] * d[0] - w[0] * d[2]);
  solid->velocity[2] += share * (v[2] + w[0] * d[1] - w[1] * d[0]);
}

// What is gathered on the way over the bodies.
typedef struct Sum {
  Faces faces;
  bool walls;                       ///< the container is in reach, and faces are set
  float walls_free, walls_slope[3]; ///< A and its gradient
  float free, slope[3];             ///< what is free so far, and its gradient
  float shares;                     ///< Σ of all shares, to weigh velocity and friction by
} Sum;

// The part of what the walls leave free that the body leaves free, 1 − s Π (1 − w F)/A, and its gradient.
static float body_rest(const SimBoundary *boundary, const Sum *sum, const SimBody *body, float share, const float g[3],
                       float gradient[3]) {
  Weights weights;
  float apart_slope[3], a = sum->walls_free;
  for (int k = 0; k < 3; k++) gradient[k] = -g[k];
  if (!sum->walls || a <= 0) return 1 - share;
  reach_through(boundary, body, &weights);
  float apart = left_free(boundary, &sum->faces, &weights, apart_slope), rest = 1 - share * apart / a;
  for (int k = 0; k < 3; k++)
    gradient[k] =
        rest < 0 ? 0 : -(g[k] * apart + share * apart_slope[k]) / a + share * apart * sum->walls_slope[k] / (a * a);
  return rest < 0 ? 0 : rest;
}

static void add_body(const SimBoundary *boundary, int32_t b, const float point[3], Sum *sum, SimSolid *solid) {
  const SimBody *body = &boundary->bodies[b];
  float g[3], rest_slope[3], share = sim_body_solid(body, &boundary->wall, point, g);
  if (share <= 0) return;
  float rest = body_rest(boundary, sum, body, share, g, rest_slope);
  for (int slot = 0; slot < SIM_FLOATERS && solid->body[slot] >= 0; slot++)
    for (int k = 0; k < 3; k++) solid->body_gradient[slot][k] *= rest;
  if (body->floats) {
    int slot = 0;
    while (slot < SIM_FLOATERS - 1 && solid->body[slot] >= 0) slot++;
    if (solid->body[slot] < 0) solid->body[slot] = b;
    for (int k = 0; k < 3; k++) solid->body_gradient[slot][k] -= sum->free * rest_slope[k];
  }
  for (int k = 0; k < 3; k++) sum->slope[k] = sum->slope[k] * rest + sum->free * rest_slope[k];
  sum->free *= rest;
  sum->shares += share;
  solid->friction += share * body->friction;
  if (body->moves) add_velocity(body, point, share, solid);
}

void sim_boundary_solid(const SimBoundary *boundary, const SimNear *near, const float point[3], SimSolid *solid) {
  *solid = (SimSolid){.body = {-1, -1}};
  Sum sum;
  sum.walls = (!near || near->container) && near_container(boundary, point, point, boundary->wall.reach);
  sum.free = 1, sum.shares = 0;
  sum.slope[0] = sum.slope[1] = sum.slope[2] = 0;
  if (sum.walls) {
    container_faces(boundary, point, &sum.faces);
    sum.free = sum.walls_free = left_free(boundary, &sum.faces, &whole, sum.slope);
    memcpy(sum.walls_slope, sum.slope, sizeof sum.slope);
    sum.shares = 1 - sum.free;
    solid->friction = sum.shares * boundary->friction;
  }
  bool all = !near || near->count < 0;
  int32_t count = all ? boundary->body_count : near->count;
  for (int32_t n = 0; n < count; n++) {
    int32_t b = all ? n : near->body[n];
    if (near_body(&boundary->bodies[b], point, boundary->wall.reach)) add_body(boundary, b, point, &sum, solid);
  }
  solid->share = 1 - sum.free;
  for (int k = 0; k < 3; k++) solid->gradient[k] = -sum.slope[k];
  if (sum.shares <= 0) return;
  solid->friction /= sum.shares;
  for (int k = 0; k < 3; k++) solid->velocity[k] /= sum.shares;
}

// ---- What is near ----------------------------------------------------------------------------------------------------

// The ball around a body on its whole way from the old pose to the new one.
static void swept_ball(const SimBody *body, float centre[3], float *radius) {
  float d2 = 0;
  for (int k = 0; k < 3; k++) {
    float old = body->moves ? body->old_position[k] : body->position[k];
    centre[k] = 0.5f * (old + body->position[k]);
    d2 += (body->position[k] - old) * (body->position[k] - old);
  }
  *radius = body->bound + (d2 > 0 ? 0.5f * sqrtf(d2) : 0);
}

// The farthest that a point of the body went.
static float farthest_move(const SimBody *body) {
  float d2 = 0, turned2 = 0;
  if (!body->moves) return 0;
  for (int k = 0; k < 3; k++)
    d2 += (body->position[k] - body->old_position[k]) * (body->position[k] - body->old_position[k]);
  for (int k = 0; k < 9; k++)
    turned2 += (body->rotation[k] - body->old_rotation[k]) * (body->rotation[k] - body->old_rotation[k]);
  // A turn by θ differs from none by 2 √2 sin(θ/2) in this norm, and moves a point at distance r by 2 r sin(θ/2) at
  // most.
  return sqrtf(d2) + sqrtf(0.5f * turned2) * body->bound;
}

// Whether a body that stands still is farther than `reach` from the box along one axis: a long one fills little of its ball.
static bool beside(const SimBody *body, const float low[3], const float high[3], float reach) {
  float from[3], to[3];
  if (body->moves || body->mesh) return false;
  sim_body_box(body, from, to);
  for (int k = 0; k < 3; k++)
    if (from[k] - reach > high[k] || to[k] + reach < low[k]) return true;
  return false;
}

static void select_bodies(const SimBoundary *boundary, const float low[3], const float high[3], float reach,
                          SimNear *near) {
  near->count = 0;
  for (int32_t b = 0; b < boundary->body_count; b++) {
    if (boundary->bodies[b].beyond) continue;
    float centre[3], r, d2 = 0;
    swept_ball(&boundary->bodies[b], centre, &r);
    r += reach;
    for (int k = 0; k < 3; k++) {
      float outside = sim_larger(0, sim_larger(low[k] - centre[k], centre[k] - high[k]));
      d2 += outside * outside;
    }
    if (!(d2 <= r * r) || beside(&boundary->bodies[b], low, high, reach)) continue;
    if (near->count == SIM_MAX_NEAR) {
      near->count = -1;
      return;
    }
    near->body[near->count++] = b;
  }
}

bool sim_boundary_select(const SimBoundary *boundary, const float low[3], const float high[3], float margin,
                         SimNear *near) {
  float reach = sim_larger(boundary->wall.reach, boundary->clearance + margin), push = 0;
  near->container = near_container(boundary, low, high, reach);
  reach += 2 * boundary->clearance; // what one body pushes away may come to another one
  select_bodies(boundary, low, high, reach, near);
  for (int32_t n = 0; n < near->count; n++) push = sim_larger(push, farthest_move(&boundary->bodies[near->body[n]]));
  if (push > 0) select_bodies(boundary, low, high, reach + push, near);
  return near->container || near->count != 0;
}

bool sim_boundary_free(const SimBoundary *boundary, const float point[3]) {
  float needed = 0.9f * boundary->clearance, normal[3];
  if (!in_container(boundary, needed, point)) return false;
  for (int32_t b = 0; b < boundary->body_count; b++) {
    const SimBody *body = &boundary->bodies[b];
    if (near_body(body, point, needed) && sim_body_distance(body, point, normal) < needed) return false;
  }
  return true;
}
