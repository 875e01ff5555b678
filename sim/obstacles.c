// Signed distances of solid bodies, and their shares of the density sum.
//
// Distances after Quilez, Distance Functions, 2008: exact for all shapes but the mesh (mesh_distance.h); stairs see
// stairs.h. Shares from that of a half-space, f: see wall.h.
#include "sim/obstacles.h"

#include <math.h>
#include <string.h>

#include "sim/stairs.h"

static int size_count(SimShape shape) {
  switch (shape) {
  case SIM_BOX:
  case SIM_STAIRS:
    return 3;
  case SIM_CYLINDER:
  case SIM_CAPSULE:
    return 2;
  case SIM_SPHERE:
    return 1;
  case SIM_MESH:
    break;
  }
  return 0;
}

SimBody sim_body_make(const SimObstacle *obstacle, const SimMeshDistance *mesh) {
  SimBody body = {.shape = obstacle->shape, .steps = obstacle->steps, .mesh = mesh};
  const float *q = obstacle->rotation;
  double length = sqrt((double)q[0] * q[0] + (double)q[1] * q[1] + (double)q[2] * q[2] + (double)q[3] * q[3]);
  double x = q[0] / length, y = q[1] / length, z = q[2] / length, w = q[3] / length;
  double m[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                 2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                 2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
  for (int k = 0; k < 9; k++) body.rotation[k] = (float)m[k];
  memcpy(body.position, obstacle->position, sizeof body.position);
  for (int k = 0; k < size_count(body.shape); k++) body.half[k] = obstacle->size[k] / 2;
  body.bound = sqrtf(body.half[0] * body.half[0] + body.half[1] * body.half[1] + body.half[2] * body.half[2]);
  if (body.shape == SIM_CAPSULE) body.bound = sim_larger(body.half[0], body.half[1]);
  if (mesh) body.bound = mesh->bound;
  memcpy(body.old_position, body.position, sizeof body.position);
  memcpy(body.old_rotation, body.rotation, sizeof body.rotation);
  return body;
}

void sim_to_local(const float rotation[9], const float vector[3], float local[3]) {
  const float *r = rotation;
  for (int k = 0; k < 3; k++) local[k] = r[k] * vector[0] + r[3 + k] * vector[1] + r[6 + k] * vector[2];
}

void sim_to_world(const float rotation[9], const float local[3], float vector[3]) {
  const float *r = rotation;
  for (int k = 0; k < 3; k++) vector[k] = r[3 * k] * local[0] + r[3 * k + 1] * local[1] + r[3 * k + 2] * local[2];
}

static void to_body(const SimBody *body, const float point[3], float local[3]) {
  const float d[3] = {point[0] - body->position[0], point[1] - body->position[1], point[2] - body->position[2]};
  sim_to_local(body->rotation, d, local);
}

// ---- Distances -------------------------------------------------------------------------------------------------------

float sim_rounded_distance(const float excess[3], int axes, float normal[3]) {
  float outside = 0, inside = -INFINITY;
  int nearest = 0;
  for (int k = 0; k < axes; k++) {
    float e = excess[k] > 0 ? excess[k] : 0;
    outside += e * e;
    if (excess[k] > inside) inside = excess[k], nearest = k;
  }
  for (int k = 0; k < axes; k++) normal[k] = 0;
  if (outside == 0) {
    normal[nearest] = 1;
    return inside;
  }
  float distance = sqrtf(outside);
  for (int k = 0; k < axes; k++) normal[k] = excess[k] > 0 ? excess[k] / distance : 0;
  return distance;
}

static float box_distance(const SimBody *body, const float p[3], float normal[3]) {
  float excess[3];
  for (int k = 0; k < 3; k++) excess[k] = fabsf(p[k]) - body->half[k];
  float distance = sim_rounded_distance(excess, 3, normal);
  for (int k = 0; k < 3; k++) normal[k] = copysignf(normal[k], p[k]);
  return distance;
}

static float sphere_distance(const float p[3], float radius, float normal[3]) {
  float r = sqrtf(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
  for (int k = 0; k < 3; k++) normal[k] = r > 0 ? p[k] / r : k == 1; // at the centre every way is as good: up
  return r - radius;
}

static float cylinder_distance(const SimBody *body, const float p[3], float normal[3]) {
  float r = sqrtf(p[0] * p[0] + p[2] * p[2]);
  float excess[3] = {r - body->half[0], fabsf(p[1]) - body->half[1], 0}, n[3];
  float distance = sim_rounded_distance(excess, 2, n);
  normal[0] = r > 0 ? n[0] * p[0] / r : n[0];
  normal[1] = copysignf(n[1], p[1]);
  normal[2] = r > 0 ? n[0] * p[2] / r : 0;
  return distance;
}

// Half the length of a capsule's straight part.
static float straight_half(const SimBody *body) {
  return sim_larger(0, body->half[1] - body->half[0]);
}

static float capsule_distance(const SimBody *body, const float p[3], float normal[3]) {
  float straight = straight_half(body), on_axis = sim_smaller(sim_larger(p[1], -straight), straight);
  const float from_axis[3] = {p[0], p[1] - on_axis, p[2]};
  float distance = sphere_distance(from_axis, body->half[0], normal);
  // On the axis the way up is none out of the straight part.
  if (p[0] == 0 && p[2] == 0 && p[1] == on_axis && straight > 0) normal[0] = 1, normal[1] = 0;
  return distance;
}

static SimStairs stairs_of(const SimBody *body) {
  return (SimStairs){{body->half[0], body->half[1], body->half[2]}, body->steps};
}

float sim_body_local_distance(const SimBody *body, const float p[3], float normal[3]) {
  SimStairs stairs;
  switch (body->shape) {
  case SIM_BOX:
    return box_distance(body, p, normal);
  case SIM_SPHERE:
    return sphere_distance(p, body->half[0], normal);
  case SIM_CYLINDER:
    return cylinder_distance(body, p, normal);
  case SIM_CAPSULE:
    return capsule_distance(body, p, normal);
  case SIM_STAIRS:
    stairs = stairs_of(body);
    return sim_stairs_distance(&stairs, p, normal);
  case SIM_MESH:
    break;
  }
  return sim_mesh_distance(body->mesh, p, normal);
}

float sim_body_distance(const SimBody *body, const float point[3], float normal[3]) {
  float p[3], n[3];
  to_body(body, point, p);
  float distance = sim_body_local_distance(body, p, n);
  sim_to_world(body->rotation, n, normal);
  return distance;
}

// ---- Share of the density sum ----------------------------------------------------------------------------------------

static float box_solid(const SimBody *body, const SimWall *wall, const float p[3], float g[3]) {
  float share[3], slope[3];
  for (int k = 0; k < 3; k++) share[k] = sim_wall_slab(wall, p[k], body->half[k], &slope[k]);
  g[0] = slope[0] * share[1] * share[2];
  g[1] = share[0] * slope[1] * share[2];
  g[2] = share[0] * share[1] * slope[2];
  return share[0] * share[1] * share[2];
}

static float sphere_solid(const SimBody *body, const SimWall *wall, const float p[3], float g[3]) {
  float slope, normal[3], s = sphere_distance(p, body->half[0], normal);
  float share = sim_wall_share(wall, s + wall->spread / body->half[0], &slope);
  for (int k = 0; k < 3; k++) g[k] = slope * normal[k];
  return share;
}

static float cylinder_solid(const SimBody *body, const SimWall *wall, const float p[3], float g[3]) {
  float r = sqrtf(p[0] * p[0] + p[2] * p[2]), along, across;
  float side = sim_wall_share(wall, r - body->half[0] + 0.5f * wall->spread / body->half[0], &across);
  float height = sim_wall_slab(wall, p[1], body->half[1], &along);
  g[0] = r > 0 ? across * height * p[0] / r : 0;
  g[1] = side * along;
  g[2] = r > 0 ? across * height * p[2] / r : 0;
  return side * height;
}

// The curvature is 1/r along the straight part and 2/r at the ends; between them it changes as the kernel sees it.
static float capsule_solid(const SimBody *body, const SimWall *wall, const float p[3], float g[3]) {
  float normal[3], slope, end_slope, straight = straight_half(body), shift = 0.5f * wall->spread / body->half[0];
  float s = capsule_distance(body, p, normal);
  float end = 1 - sim_wall_share(wall, fabsf(p[1]) - straight, &end_slope);
  float share = sim_wall_share(wall, s + shift * (1 + end), &slope);
  for (int k = 0; k < 3; k++) g[k] = slope * normal[k];
  g[1] -= slope * shift * (p[1] < 0 ? -end_slope : end_slope);
  return share;
}

static float local_solid(const SimBody *body, const SimWall *wall, const float p[3], float g[3]) {
  SimStairs stairs;
  switch (body->shape) {
  case SIM_BOX:
    return box_solid(body, wall, p, g);
  case SIM_SPHERE:
    return sphere_solid(body, wall, p, g);
  case SIM_CYLINDER:
    return cylinder_solid(body, wall, p, g);
  case SIM_CAPSULE:
    return capsule_solid(body, wall, p, g);
  case SIM_STAIRS:
    stairs = stairs_of(body);
    return sim_stairs_solid(&stairs, wall, p, g);
  case SIM_MESH:
    break;
  }
  return sim_mesh_solid(body->mesh, p, g);
}

// Whether a point lies so far beside a body, along one of its own axes, that it has no share there. Bodies are slender, and the
// ball around them says little.
static bool out_of_reach(const SimBody *body, const float p[3], float reach) {
  if (body->shape == SIM_SPHERE || body->shape == SIM_MESH) return false;
  float across = body->shape == SIM_BOX || body->shape == SIM_STAIRS ? body->half[2] : body->half[0];
  return fabsf(p[0]) > body->half[0] + reach || fabsf(p[1]) > body->half[1] + reach || fabsf(p[2]) > across + reach;
}

float sim_body_solid(const SimBody *body, const SimWall *wall, const float point[3], float gradient[3]) {
  float p[3], g[3] = {0};
  to_body(body, point, p);
  if (out_of_reach(body, p, wall->reach)) {
    gradient[0] = gradient[1] = gradient[2] = 0;
    return 0;
  }
  float share = local_solid(body, wall, p, g);
  sim_to_world(body->rotation, g, gradient);
  return share;
}

// ---- Bounds ----------------------------------------------------------------------------------------------------------

void sim_body_box(const SimBody *body, float low[3], float high[3]) {
  const float *r = body->rotation;
  float middle[3] = {0, 0, 0}, half[3] = {body->half[0], body->half[1], body->half[2]}, centre[3];
  if (body->mesh)
    for (int k = 0; k < 3; k++) {
      middle[k] = 0.5f * (body->mesh->low[k] + body->mesh->high[k]);
      half[k] = 0.5f * (body->mesh->high[k] - body->mesh->low[k]);
    }
  sim_to_world(r, middle, centre);
  for (int k = 0; k < 3; k++) {
    float up = fabsf(r[3 * k + 1]), extent; // of the body's y axis along this one
    if (body->shape == SIM_SPHERE)
      extent = half[0];
    else if (body->shape == SIM_CYLINDER)
      extent = up * half[1] + sqrtf(sim_larger(0, 1 - up * up)) * half[0];
    else if (body->shape == SIM_CAPSULE)
      extent = up * straight_half(body) + half[0];
    else
      extent = fabsf(r[3 * k]) * half[0] + up * half[1] + fabsf(r[3 * k + 2]) * half[2];
    low[k] = body->position[k] + centre[k] - extent;
    high[k] = body->position[k] + centre[k] + extent;
  }
}
