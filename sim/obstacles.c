// Signed distances after Quilez, Distance Functions, 2008: exact for all three shapes.
#include "sim/obstacles.h"

#include <math.h>
#include <string.h>

SimBody sim_body_make(const SimObstacle *obstacle) {
  SimBody body = {.shape = obstacle->shape};
  const float *q = obstacle->rotation;
  double length = sqrt((double)q[0] * q[0] + (double)q[1] * q[1] + (double)q[2] * q[2] + (double)q[3] * q[3]);
  double x = q[0] / length, y = q[1] / length, z = q[2] / length, w = q[3] / length;
  double m[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                 2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                 2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
  for (int k = 0; k < 9; k++) body.rotation[k] = (float)m[k];
  memcpy(body.position, obstacle->position, sizeof body.position);
  int sizes = body.shape == SIM_BOX ? 3 : body.shape == SIM_SPHERE ? 1 : 2;
  for (int k = 0; k < sizes; k++) body.half[k] = obstacle->size[k] / 2;
  body.bound = sqrtf(body.half[0] * body.half[0] + body.half[1] * body.half[1] + body.half[2] * body.half[2]);
  return body;
}

static void to_body(const SimBody *body, const float point[3], float local[3]) {
  const float *r = body->rotation;
  float d[3] = {point[0] - body->position[0], point[1] - body->position[1], point[2] - body->position[2]};
  for (int k = 0; k < 3; k++) local[k] = r[k] * d[0] + r[3 + k] * d[1] + r[6 + k] * d[2];
}

static void to_world(const SimBody *body, const float local[3], float vector[3]) {
  const float *r = body->rotation;
  for (int k = 0; k < 3; k++) vector[k] = r[3 * k] * local[0] + r[3 * k + 1] * local[1] + r[3 * k + 2] * local[2];
}

// Distance from the excesses over the half sizes along `axes` independent directions; which of them the nearest face is.
static float rounded_distance(const float excess[3], int axes, float normal[3]) {
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
  float distance = rounded_distance(excess, 3, normal);
  for (int k = 0; k < 3; k++) normal[k] = copysignf(normal[k], p[k]);
  return distance;
}

static float sphere_distance(const SimBody *body, const float p[3], float normal[3]) {
  float r = sqrtf(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
  for (int k = 0; k < 3; k++) normal[k] = r > 0 ? p[k] / r : k == 1; // at the centre every way is as good: up
  return r - body->half[0];
}

static float cylinder_distance(const SimBody *body, const float p[3], float normal[3]) {
  float r = sqrtf(p[0] * p[0] + p[2] * p[2]);
  float excess[3] = {r - body->half[0], fabsf(p[1]) - body->half[1], 0}, n[3];
  float distance = rounded_distance(excess, 2, n);
  normal[0] = r > 0 ? n[0] * p[0] / r : n[0];
  normal[1] = copysignf(n[1], p[1]);
  normal[2] = r > 0 ? n[0] * p[2] / r : 0;
  return distance;
}

float sim_body_distance(const SimBody *body, const float point[3], float normal[3]) {
  float p[3], n[3] = {0, 1, 0}, distance = 0;
  to_body(body, point, p);
  switch (body->shape) {
  case SIM_BOX:
    distance = box_distance(body, p, n);
    break;
  case SIM_SPHERE:
    distance = sphere_distance(body, p, n);
    break;
  case SIM_CYLINDER:
    distance = cylinder_distance(body, p, n);
    break;
  default:
    break;
  }
  to_world(body, n, normal);
  return distance;
}

// ---- Share of the density sum ----------------------------------------------------------------------------------------

// The share between two parallel walls at −half and +half, seen from p.
static float slab(const SimWall *wall, float p, float half, float *slope) {
  float upper, lower;
  float share = sim_wall_share(wall, p - half, &upper) - sim_wall_share(wall, p + half, &lower);
  *slope = upper - lower;
  return share > 0 ? share : 0;
}

static float box_solid(const SimBody *body, const SimWall *wall, const float p[3], float g[3]) {
  float share[3], slope[3];
  for (int k = 0; k < 3; k++) share[k] = slab(wall, p[k], body->half[k], &slope[k]);
  g[0] = slope[0] * share[1] * share[2];
  g[1] = share[0] * slope[1] * share[2];
  g[2] = share[0] * share[1] * slope[2];
  return share[0] * share[1] * share[2];
}

static float sphere_solid(const SimBody *body, const SimWall *wall, const float p[3], float g[3]) {
  float slope, normal[3], share = sim_wall_share(wall, sphere_distance(body, p, normal), &slope);
  for (int k = 0; k < 3; k++) g[k] = slope * normal[k];
  return share;
}

static float cylinder_solid(const SimBody *body, const SimWall *wall, const float p[3], float g[3]) {
  float r = sqrtf(p[0] * p[0] + p[2] * p[2]), along, across;
  float side = sim_wall_share(wall, r - body->half[0], &across), height = slab(wall, p[1], body->half[1], &along);
  g[0] = r > 0 ? across * height * p[0] / r : 0;
  g[1] = side * along;
  g[2] = r > 0 ? across * height * p[2] / r : 0;
  return side * height;
}

float sim_body_solid(const SimBody *body, const SimWall *wall, const float point[3], float gradient[3]) {
  float p[3], g[3] = {0}, share = 0;
  to_body(body, point, p);
  switch (body->shape) {
  case SIM_BOX:
    share = box_solid(body, wall, p, g);
    break;
  case SIM_SPHERE:
    share = sphere_solid(body, wall, p, g);
    break;
  case SIM_CYLINDER:
    share = cylinder_solid(body, wall, p, g);
    break;
  default:
    break;
  }
  to_world(body, g, gradient);
  return share;
}
