#include "app/grab.h"

#include <math.h>
#include <string.h>

#include "app/camera.h"

/// A ray in a body's own axes.
typedef struct Ray {
  double origin[3], direction[3];
} Ray;

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// v turned by the inverse of the unit quaternion q: v + 2w (u × v) + 2 u × (u × v) with u = −(x, y, z).
static void turn_back(const float q[4], const double v[3], double out[3]) {
  double u[3] = {-(double)q[0], -(double)q[1], -(double)q[2]}, t[3];
  for (int k = 0; k < 3; k++) t[k] = 2 * (u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
  for (int k = 0; k < 3; k++)
    out[k] = v[k] + (double)q[3] * t[k] + u[(k + 1) % 3] * t[(k + 2) % 3] - u[(k + 2) % 3] * t[(k + 1) % 3];
}

static Ray ray_in_body(const SimObstacle *body, const float origin[3], const float direction[3]) {
  Ray ray;
  double from[3], along[3];
  for (int k = 0; k < 3; k++) {
    from[k] = (double)origin[k] - body->position[k];
    along[k] = direction[k];
  }
  turn_back(body->rotation, from, ray.origin);
  turn_back(body->rotation, along, ray.direction);
  return ray;
}

// ---- Shapes: the nearest distance ≥ 0, or INFINITY --------------------------------------------------------------------
// A convex body is where the ray is between begin and end; the eye inside counts as a hit at 0.

static double first_of(double begin, double end) {
  return begin <= end && end >= 0 ? fmax(begin, 0) : INFINITY;
}

/// The part of the ray with low ≤ coordinate ≤ high, cut out of [*begin, *end].
static void clip_slab(const Ray *ray, int axis, double low, double high, double *begin, double *end) {
  double o = ray->origin[axis], d = ray->direction[axis];
  if (d == 0) {
    if (o < low || o > high) *begin = INFINITY;
    return;
  }
  double a = (low - o) / d, b = (high - o) / d;
  *begin = fmax(*begin, fmin(a, b));
  *end = fmin(*end, fmax(a, b));
}

static double meet_box(const Ray *ray, const double min[3], const double max[3]) {
  double begin = -INFINITY, end = INFINITY;
  for (int k = 0; k < 3; k++) clip_slab(ray, k, min[k], max[k], &begin, &end);
  return first_of(begin, end);
}

/// Where the quadratic a t² + 2 b t + c ≤ 0, cut out of [*begin, *end].
static void clip_quadratic(double a, double b, double c, double *begin, double *end) {
  if (!(a > 1e-12)) { // along the axis of a cylinder: inside all the way or not at all
    if (c > 0) *begin = INFINITY;
    return;
  }
  double square = b * b - a * c;
  if (square < 0) {
    *begin = INFINITY;
    return;
  }
  *begin = fmax(*begin, (-b - sqrt(square)) / a);
  *end = fmin(*end, (-b + sqrt(square)) / a);
}

static double meet_ball(const Ray *ray, double height, double radius) {
  const double from[3] = {ray->origin[0], ray->origin[1] - height, ray->origin[2]};
  double begin = -INFINITY, end = INFINITY;
  clip_quadratic(dot(ray->direction, ray->direction), dot(from, ray->direction), dot(from, from) - radius * radius,
                 &begin, &end);
  return first_of(begin, end);
}

/// An upright cylinder around the origin.
static double meet_cylinder(const Ray *ray, double radius, double height) {
  const double *o = ray->origin, *d = ray->direction;
  double begin = -INFINITY, end = INFINITY;
  clip_quadratic(d[0] * d[0] + d[2] * d[2], o[0] * d[0] + o[2] * d[2], o[0] * o[0] + o[2] * o[2] - radius * radius,
                 &begin, &end);
  clip_slab(ray, 1, -height / 2, height / 2, &begin, &end);
  return first_of(begin, end);
}

static double meet_capsule(const Ray *ray, double radius, double height) {
  double middle = fmax(height / 2 - radius, 0);
  return fmin(meet_cylinder(ray, radius, 2 * middle),
              fmin(meet_ball(ray, middle, radius), meet_ball(ray, -middle, radius)));
}

static double meet_stairs(const Ray *ray, const float size[3], int32_t steps) {
  double nearest = INFINITY;
  for (int32_t k = 0; k < steps; k++) {
    const double min[3] = {size[0] * ((double)k / steps - 0.5), -0.5 * size[1], -0.5 * size[2]};
    const double max[3] = {size[0] * ((k + 1.0) / steps - 0.5), size[1] * ((k + 1.0) / steps - 0.5), 0.5 * size[2]};
    nearest = fmin(nearest, meet_box(ray, min, max));
  }
  return nearest;
}

/// Möller & Trumbore, Fast, minimum storage ray/triangle intersection, 1997.
static double meet_triangle(const Ray *ray, const float a[3], const float b[3], const float c[3]) {
  double p[3], q[3], s[3], e1[3], e2[3];
  for (int k = 0; k < 3; k++) {
    e1[k] = (double)b[k] - a[k];
    e2[k] = (double)c[k] - a[k];
    s[k] = ray->origin[k] - a[k];
  }
  const double *d = ray->direction;
  for (int k = 0; k < 3; k++) {
    p[k] = d[(k + 1) % 3] * e2[(k + 2) % 3] - d[(k + 2) % 3] * e2[(k + 1) % 3];
    q[k] = s[(k + 1) % 3] * e1[(k + 2) % 3] - s[(k + 2) % 3] * e1[(k + 1) % 3];
  }
  double determinant = dot(e1, p);
  if (determinant == 0) return INFINITY;
  double u = dot(s, p) / determinant, v = dot(d, q) / determinant, t = dot(e2, q) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && t >= 0 ? t : INFINITY;
}

/// From inside it meets the far side, not 0: whoever looks out of a mesh still finds it.
static double meet_mesh(const Ray *ray, const SimMesh *mesh) {
  double nearest = INFINITY;
  for (int32_t t = 0; mesh && t < mesh->triangle_count; t++) {
    const int32_t *corner = mesh->triangle + 3 * (size_t)t;
    nearest = fmin(nearest, meet_triangle(ray, mesh->vertex + 3 * (size_t)corner[0],
                                          mesh->vertex + 3 * (size_t)corner[1], mesh->vertex + 3 * (size_t)corner[2]));
  }
  return nearest;
}

static double meet(const SimObstacle *body, const Ray *ray) {
  const float *size = body->size;
  const double half[3] = {0.5 * size[0], 0.5 * size[1], 0.5 * size[2]}, minus[3] = {-half[0], -half[1], -half[2]};
  switch (body->shape) {
  case SIM_BOX:
    return meet_box(ray, minus, half);
  case SIM_SPHERE:
    return meet_ball(ray, 0, half[0]);
  case SIM_CYLINDER:
    return meet_cylinder(ray, half[0], size[1]);
  case SIM_CAPSULE:
    return meet_capsule(ray, half[0], size[1]);
  case SIM_STAIRS:
    return meet_stairs(ray, size, body->steps);
  case SIM_MESH:
    return meet_mesh(ray, body->mesh);
  }
  return INFINITY;
}

bool grab_ray_meets(const SimObstacle *body, const float origin[3], const float direction[3], float *distance) {
  Ray ray = ray_in_body(body, origin, direction);
  *distance = (float)meet(body, &ray);
  return isfinite(*distance);
}

int32_t grab_pick(const GrabBodies *bodies, const float origin[3], const float direction[3]) {
  int32_t nearest = -1;
  float least = INFINITY, distance;
  for (int32_t i = 0; i < bodies->count; i++)
    if (grab_ray_meets(&bodies->bodies[i], origin, direction, &distance) && distance < least) {
      least = distance;
      nearest = i;
    }
  return nearest >= 0 && bodies->defs[nearest].motion == SIM_DRAGGABLE ? nearest : -1;
}

bool grab_meets_glass(const SimContainer *container, const float origin[3], const float direction[3]) {
  SimObstacle glass = {.shape = SIM_CYLINDER, .rotation = {0, 0, 0, 1}};
  for (int k = 0; k < 3; k++) {
    glass.position[k] = 0.5f * (container->min[k] + container->max[k]);
    glass.size[k] = container->max[k] - container->min[k];
  }
  glass.size[0] = fminf(glass.size[0], glass.size[2]);
  float distance;
  return container->shape == SIM_CONTAINER_GLASS && grab_ray_meets(&glass, origin, direction, &distance) && distance > 0;
}

// ---- The hand -----------------------------------------------------------------------------------------------------------

bool grab_begin(Grab *grab, const GrabBodies *bodies, const RenderView *view, float x, float y, int width, int height) {
  float origin[3], direction[3];
  camera_ray(view, x, y, width, height, origin, direction);
  int32_t body = grab_pick(bodies, origin, direction);
  if (body < 0) return false;
  *grab = (Grab){.holds = true, .moved = true, .body = body, .x = x, .y = y};
  memcpy(grab->target, bodies->bodies[body].position, sizeof grab->target);
  return true;
}

void grab_move(Grab *grab, const RenderView *view, float x, float y, int width, int height) {
  if (!grab->holds || width <= 0 || height <= 0) return;
  float right[3], up[3], forward[3];
  camera_axes(view, right, up, forward);
  double depth = 0;
  for (int k = 0; k < 3; k++) depth += ((double)grab->target[k] - view->eye[k]) * forward[k];
  // Metres that a pixel spans in the plane through the centre; a body around the eye stays where it is.
  double metres = 2 * fmax(depth, 0) * tan(view->vertical_fov * 3.14159265358979323846 / 360) / height;
  double across = metres * (x - grab->x), upwards = -metres * (y - grab->y);
  for (int k = 0; k < 3; k++) grab->target[k] = (float)(grab->target[k] + across * right[k] + upwards * up[k]);
  grab->x = x;
  grab->y = y;
  grab->moved = true;
}

void grab_end(Grab *grab) {
  grab->holds = false;
}
