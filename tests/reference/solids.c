#include "tests/reference/solids.h"

#include <stdbool.h>
#include <stdlib.h>

#define FARTHEST 1e6 // m, as in the renderer

// ---- From the frame --------------------------------------------------------------------------------------------------

static double clamp01(float x) {
  return x > 0 ? fmin((double)x, 1) : 0; // NaN becomes 0
}

static bool place_solid(Solid *solid, const SimObstacle *o) {
  double length = 0;
  for (int k = 0; k < 4; ++k) length += (double)o->rotation[k] * (double)o->rotation[k];
  length = sqrt(length);
  if (!(length > 1e-6 && length < 1e6)) return false;
  for (int k = 0; k < 4; ++k) solid->rotation[k] = (double)o->rotation[k] / length;
  for (int k = 0; k < 3; ++k) {
    if (!(fabs((double)o->position[k]) < FARTHEST)) return false;
  }
  solid->position = vec_of(o->position);
  solid->colour = (Vec){clamp01(o->colour[0]), clamp01(o->colour[1]), clamp01(o->colour[2])};
  return true;
}

static bool positive(Vec half) {
  return half.x > 0 && half.y > 0 && half.z > 0 && half.x < FARTHEST && half.y < FARTHEST && half.z < FARTHEST;
}

static bool size_solid(Solid *solid, const SimObstacle *o) {
  const Vec size = vec_scale(0.5, vec_of(o->size));
  solid->shape = o->shape;
  switch (o->shape) {
  case SIM_BOX:
    solid->half = size;
    return positive(size);
  case SIM_SPHERE:
    solid->half = (Vec){size.x, size.x, size.x};
    return positive(solid->half);
  case SIM_CYLINDER:
    solid->half = (Vec){size.x, size.y, size.x};
    return positive(solid->half);
  case SIM_CAPSULE:
    solid->half = (Vec){size.x, fmax(size.y - size.x, 0), size.x};
    return size.x > 0 && size.y > 0;
  default:
    return false;
  }
}

static Vec rotate(const double q[4], double sign, Vec v) {
  const Vec axis = {sign * q[0], sign * q[1], sign * q[2]};
  return vec_along(v, 2, vec_cross(axis, vec_along(vec_cross(axis, v), q[3], v)));
}

// One box for each step: step k fills the flight from k/steps of its length to the end, up to (k + 1)/steps of its height.
static void add_stairs(Solids *solids, const SimObstacle *o, Solid solid) {
  const Vec half = vec_scale(0.5, vec_of(o->size));
  if (!positive(half) || o->steps < 1 || o->steps > 1000) return;
  const Vec middle = solid.position;
  solid.shape = SIM_BOX;
  for (int k = 0; k < o->steps; ++k) {
    const double from = (double)k / o->steps, top = (double)(k + 1) / o->steps;
    solid.half = (Vec){half.x * (1 - from), half.y * top, half.z};
    const Vec centre = {half.x * from, half.y * (top - 1), 0};
    solid.position = vec_add(middle, rotate(solid.rotation, 1, centre));
    solids->solid[solids->count++] = solid;
  }
}

Solids solids_create(const SimFrame *frame) {
  size_t room = 1;
  for (int32_t i = 0; i < frame->obstacle_count; ++i) {
    const SimObstacle *o = &frame->obstacles[i];
    room += o->shape == SIM_STAIRS && o->steps > 0 && o->steps <= 1000 ? (size_t)o->steps : 1;
  }
  Solids solids = {.solid = calloc(room, sizeof(Solid))};
  for (int32_t i = 0; solids.solid != NULL && i < frame->obstacle_count; ++i) {
    const SimObstacle *o = &frame->obstacles[i];
    Solid solid = {0};
    if (!place_solid(&solid, o)) continue;
    if (o->shape == SIM_STAIRS)
      add_stairs(&solids, o, solid);
    else if (size_solid(&solid, o))
      solids.solid[solids.count++] = solid;
  }
  return solids;
}

void solids_destroy(Solids *solids) {
  free(solids->solid);
  *solids = (Solids){0};
}

// ---- Rays ------------------------------------------------------------------------------------------------------------

/// Where a ray is inside a convex part: from enter to leave, and the outward normal at the entry.
typedef struct Span {
  double enter, leave;
  Vec normal;
} Span;

static const Span missed = {INFINITY, -INFINITY, {0, 0, 0}};

static Span slab(double o, double d, double half, Vec axis) {
  if (d == 0) return fabs(o) < half ? (Span){-INFINITY, INFINITY, axis} : missed;
  const double a = (-half - o) / d, b = (half - o) / d;
  return (Span){fmin(a, b), fmax(a, b), vec_scale(d > 0 ? -1 : 1, axis)};
}

static Span both(Span a, Span b) {
  return (Span){fmax(a.enter, b.enter), fmin(a.leave, b.leave), a.enter > b.enter ? a.normal : b.normal};
}

// A ball around the origin, or a tube where the components along its axis are zero.
static Span ball(Vec o, Vec d, double radius) {
  const double dd = vec_dot(d, d);
  if (dd == 0) return vec_dot(o, o) < radius * radius ? (Span){-INFINITY, INFINITY, {0, 0, 0}} : missed;
  const double middle = -vec_dot(o, d) / dd;
  const Vec foot = vec_along(o, middle, d);
  const double h2 = (radius * radius - vec_dot(foot, foot)) / dd;
  if (!(h2 > 0)) return missed;
  const double half = sqrt(h2);
  return (Span){middle - half, middle + half, vec_scale(1 / radius, vec_along(o, middle - half, d))};
}

static Span earlier(Span a, Span b) {
  if (!(b.enter <= b.leave)) return a;
  if (!(a.enter <= a.leave)) return b;
  return (Span){fmin(a.enter, b.enter), fmax(a.leave, b.leave), a.enter < b.enter ? a.normal : b.normal};
}

static Span tube(Vec o, Vec d, double radius, double half) {
  return both(ball((Vec){o.x, 0, o.z}, (Vec){d.x, 0, d.z}, radius), slab(o.y, d.y, half, (Vec){0, 1, 0}));
}

static Span meet(const Solid *solid, Vec o, Vec d) {
  const Vec half = solid->half;
  switch (solid->shape) {
  case SIM_SPHERE:
    return ball(o, d, half.x);
  case SIM_CYLINDER:
    return tube(o, d, half.x, half.y);
  case SIM_CAPSULE: {
    const Vec up = {0, half.y, 0};
    return earlier(tube(o, d, half.x, half.y),
                   earlier(ball(vec_sub(o, up), d, half.x), ball(vec_add(o, up), d, half.x)));
  }
  default:
    return both(slab(o.x, d.x, half.x, (Vec){1, 0, 0}),
                both(slab(o.y, d.y, half.y, (Vec){0, 1, 0}), slab(o.z, d.z, half.z, (Vec){0, 0, 1})));
  }
}

const Solid *solids_meet(const Solids *solids, Vec origin, Vec direction, double *t, Vec *normal) {
  const Solid *first = NULL;
  *t = INFINITY;
  for (int i = 0; i < solids->count; ++i) {
    const Solid *solid = &solids->solid[i];
    const Span span = meet(solid, rotate(solid->rotation, -1, vec_sub(origin, solid->position)),
                           rotate(solid->rotation, -1, direction));
    if (!(span.enter <= span.leave) || span.enter <= 0 || span.enter >= *t) continue;
    *t = span.enter;
    *normal = rotate(solid->rotation, 1, span.normal);
    first = solid;
  }
  return first;
}

// ---- Distances -------------------------------------------------------------------------------------------------------

static double radial(Vec p, double radius, Vec *outward) {
  const double length = vec_length(p);
  *outward = length > 0 ? vec_scale(1 / length, p) : (Vec){1, 0, 0};
  return length - radius;
}

// A shape that is a product of shapes along its axes: to the corner outside, to the nearest face inside.
static double product(const double excess[], const Vec axis[], int count, Vec *outward) {
  Vec corner = {0, 0, 0};
  int nearest = 0;
  for (int k = 0; k < count; ++k) {
    if (excess[k] > 0) corner = vec_along(corner, excess[k], axis[k]);
    if (excess[k] > excess[nearest]) nearest = k;
  }
  if (excess[nearest] <= 0) {
    *outward = axis[nearest];
    return excess[nearest];
  }
  return radial(corner, 0, outward);
}

static double distance(const Solid *solid, Vec p, Vec *outward) {
  const Vec half = solid->half;
  Vec out;
  switch (solid->shape) {
  case SIM_SPHERE:
    return radial(p, half.x, outward);
  case SIM_CAPSULE:
    return radial((Vec){p.x, p.y - fmax(-half.y, fmin(half.y, p.y)), p.z}, half.x, outward);
  case SIM_CYLINDER: {
    const double across = radial((Vec){p.x, 0, p.z}, half.x, &out);
    const double excess[] = {across, fabs(p.y) - half.y};
    const Vec axis[] = {out, {0, p.y < 0 ? -1 : 1, 0}};
    return product(excess, axis, 2, outward);
  }
  default: {
    const double excess[] = {fabs(p.x) - half.x, fabs(p.y) - half.y, fabs(p.z) - half.z};
    const Vec axis[] = {{p.x < 0 ? -1 : 1, 0, 0}, {0, p.y < 0 ? -1 : 1, 0}, {0, 0, p.z < 0 ? -1 : 1}};
    return product(excess, axis, 3, outward);
  }
  }
}

double solids_distance(const Solids *solids, Vec p, Vec *outward) {
  double nearest = INFINITY;
  for (int i = 0; i < solids->count; ++i) {
    const Solid *solid = &solids->solid[i];
    Vec out = {0, 0, 0};
    const double d = distance(solid, rotate(solid->rotation, -1, vec_sub(p, solid->position)), &out);
    if (d >= nearest) continue;
    nearest = d;
    *outward = rotate(solid->rotation, 1, out);
  }
  return nearest;
}
