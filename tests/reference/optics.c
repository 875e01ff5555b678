#include "tests/reference/optics.h"

#define LEAST_WEIGHT 1e-4

/// A ray's way to the first surface of the water, or to what lies behind.
typedef struct Segment {
  bool meets_water;
  WaterHit hit;
  Vec environment;   // what it would see without the rest of the water
  Vec transmittance; // of the way to the water's surface or, without one, to a solid
} Segment;

static Vec beer_lambert(const Optics *o, double length) {
  return (Vec){exp(-o->absorption.x * length), exp(-o->absorption.y * length), exp(-o->absorption.z * length)};
}

// A ray that ends in the sky has no length in water: it can only have slipped out at an edge of the mesh.
static Segment follow(const Optics *o, WaterRay *ray) {
  double t;
  Segment s = {.environment = environment_light(o->environment, ray->origin, ray->direction, &t)};
  s.meets_water = water_meet(o->water, ray, t, &s.hit);
  const double length = s.meets_water ? s.hit.t : isfinite(t) ? t : 0;
  s.transmittance = beer_lambert(o, water_wet(&ray->medium) ? length : 0);
  return s;
}

/// Both ways on from a surface.
typedef struct Split {
  double reflectance; // F; 1: there is no refracted ray
  WaterRay reflected, refracted;
} Split;

// Smooth normals may send a ray through the triangle to the wrong side: such a ray just grazes it.
static Vec keep_side(Vec direction, Vec flat, double side) {
  const double along = side * vec_dot(direction, flat), least = 1e-4;
  return along >= least ? direction : vec_unit(vec_along(direction, side * (least - along), flat));
}

static double schlick(double n, double cos_in_air) {
  const double f0 = (n - 1) / (n + 1) * ((n - 1) / (n + 1));
  return f0 + (1 - f0) * pow(1 - cos_in_air, 5);
}

static Split split_at(const Optics *o, const WaterRay *ray, const WaterHit *hit) {
  const bool leaves = water_wet(&ray->medium);
  const double n = o->refractive_index, eta = leaves ? n : 1 / n;
  const double side = vec_dot(hit->flat, ray->direction) < 0 ? 1 : -1; // of the flat normal, where the ray comes from
  const Vec normal = vec_scale(side, hit->normal);
  const double cos_in = fmin(1, -vec_dot(normal, ray->direction)), sin2_out = eta * eta * (1 - cos_in * cos_in);
  Split split = {.reflectance = 1};
  WaterRay next = {.origin = hit->point, .geometry = hit->geometry, .primitive = hit->primitive};
  split.reflected = split.refracted = next;
  split.reflected.medium = ray->medium;
  split.reflected.direction = keep_side(vec_unit(vec_along(ray->direction, 2 * cos_in, normal)), hit->flat, side);
  if (sin2_out >= 1) return split;
  const double cos_out = sqrt(1 - sin2_out);
  split.reflectance = schlick(n, leaves ? cos_out : cos_in);
  split.refracted.medium = hit->behind;
  const Vec bent = vec_along(vec_scale(eta, ray->direction), eta * cos_in - cos_out, normal);
  split.refracted.direction = keep_side(vec_unit(bent), hit->flat, -side);
  return split;
}

static Vec tree(const Optics *o, WaterRay ray, int surfaces_left, double weight) {
  const Segment s = follow(o, &ray);
  weight *= vec_largest(s.transmittance);
  if (!s.meets_water || surfaces_left == 0 || weight < LEAST_WEIGHT) return vec_times(s.transmittance, s.environment);
  const Split split = split_at(o, &ray, &s.hit);
  const double f = split.reflectance;
  Vec light = vec_scale(f, tree(o, split.reflected, surfaces_left - 1, weight * f));
  if (f < 1) light = vec_along(light, 1 - f, tree(o, split.refracted, surfaces_left - 1, weight * (1 - f)));
  return vec_times(s.transmittance, light);
}

Vec optics_tree(const Optics *optics, WaterRay ray, int max_depth) {
  return tree(optics, ray, max_depth, 1);
}

Vec optics_chain(const Optics *o, WaterRay ray, int max_refractions) {
  const Segment s = follow(o, &ray);
  if (!s.meets_water || max_refractions == 0) return vec_times(s.transmittance, s.environment);
  const Split split = split_at(o, &ray, &s.hit);
  const double f = split.reflectance;
  double t;
  const Vec reflected = environment_light(o->environment, s.hit.point, split.reflected.direction, &t);
  Vec light = vec_scale(f, reflected);
  if (f < 1) light = vec_along(light, 1 - f, optics_chain(o, split.refracted, max_refractions - 1));
  return vec_times(s.transmittance, light);
}
