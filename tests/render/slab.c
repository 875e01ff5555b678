#include "tests/render/slab.h"

#include <math.h>
#include <string.h>

enum { SURFACES = 8 }; // on a path in the water

typedef struct Path {
  double p[3], d[3]; // d: unit
} Path;

static Path moved(const Path *path, double t) {
  Path next = *path;
  for (int k = 0; k < 3; ++k) next.p[k] += t * path->d[k];
  return next;
}

// ---- In the air ------------------------------------------------------------------------------------------------------

static void sky_light(const RenderSettings *s, double up, double light[3]) {
  for (int k = 0; k < 3; ++k) {
    const double h = (double)s->sky_horizon[k], z = (double)s->sky_zenith[k];
    light[k] = h + (z - h) * fmax(up, 0);
  }
}

static void floor_light(const RenderSettings *s, const double p[3], double light[3]) {
  const double squares = floor(p[0] / (double)s->tile_size) + floor(p[2] / (double)s->tile_size);
  for (int k = 0; k < 3; ++k) light[k] = (double)s->floor_colour[fmod(fabs(squares), 2) != 0][k];
}

static void air_light(const Slab *slab, const Path *path, double light[3]) {
  if (path->d[1] >= 0 || slab->settings->floor == RENDER_FLOOR_NONE) {
    sky_light(slab->settings, path->d[1], light);
    return;
  }
  const Path at = moved(path, (slab->min[1] - path->p[1]) / path->d[1]);
  floor_light(slab->settings, at.p, light);
}

// ---- At a face -------------------------------------------------------------------------------------------------------

static double schlick(double n, double cos_in_air) {
  const double f0 = pow((n - 1) / (n + 1), 2);
  return f0 + (1 - f0) * pow(1 - cos_in_air, 5);
}

// Both ways on from a face across `axis`; returns the reflectance, 1 where no light goes through.
static double split(double n, const Path *path, int axis, bool leaves, Path *mirrored, Path *bent) {
  const double eta = leaves ? n : 1 / n, cos_in = fabs(path->d[axis]), sin2 = eta * eta * (1 - cos_in * cos_in);
  *mirrored = *bent = *path;
  mirrored->d[axis] = -path->d[axis];
  if (sin2 >= 1) return 1;
  for (int k = 0; k < 3; ++k) bent->d[k] *= eta;
  bent->d[axis] = copysign(sqrt(1 - sin2), path->d[axis]);
  return schlick(n, leaves ? sqrt(1 - sin2) : cos_in);
}

// How far p is from the upright sides, other than the one that it lies on.
static double margin_at(const Slab *slab, const double p[3], int axis) {
  double least = INFINITY;
  for (int k = 0; k < 3; k += 2) {
    if (k != axis) least = fmin(least, fmin(p[k] - slab->min[k], slab->max[k] - p[k]));
  }
  return least;
}

// ---- In the water ----------------------------------------------------------------------------------------------------

static SlabPixel in_water(const Slab *slab, const Path *path, int left);

// `weight` of `from` on top of what is there.
static void add(double light[3], const double from[3], double weight) {
  for (int k = 0; k < 3; ++k) light[k] += weight * from[k];
}

// Out of the water through `face`, and back from it.
static SlabPixel at_face(const Slab *slab, const Path *at, int face, int left) {
  Path mirrored, bent;
  const double mirror = split((double)slab->settings->refractive_index, at, face / 2, true, &mirrored, &bent);
  SlabPixel pixel = {.way = 0, .margin = INFINITY};
  if (left > 0) {
    const SlabPixel inside = in_water(slab, &mirrored, left - 1);
    if (mirror > 0.5) pixel = (SlabPixel){.way = inside.way, .margin = inside.margin};
    add(pixel.light, inside.light, mirror);
  }
  double outside[3];
  if (mirror < 1) {
    air_light(slab, &bent, outside);
    add(pixel.light, outside, 1 - mirror);
  }
  return pixel;
}

static SlabPixel in_water(const Slab *slab, const Path *path, int left) {
  double t = INFINITY;
  int face = SLAB_FLOOR;
  for (int k = 0; k < 3; ++k) {
    const double end = path->d[k] > 0 ? slab->max[k] : slab->min[k], reach = (end - path->p[k]) / path->d[k];
    if (path->d[k] == 0 || reach >= t) continue;
    t = reach;
    face = 2 * k + (path->d[k] > 0);
  }
  const Path at = moved(path, t);
  SlabPixel pixel = {.way = 0, .margin = INFINITY};
  if (face == SLAB_TOP - 1 && slab->settings->floor != RENDER_FLOOR_NONE) {
    face = SLAB_FLOOR;
    floor_light(slab->settings, at.p, pixel.light);
  } else {
    pixel = at_face(slab, &at, face, left);
  }
  for (int k = 0; k < 3; ++k) pixel.light[k] *= exp(-(double)slab->settings->absorption[k] * t);
  pixel.way = 8 * pixel.way + face + 1;
  pixel.margin = fmin(pixel.margin, margin_at(slab, at.p, face == SLAB_FLOOR ? 1 : face / 2));
  return pixel;
}

// ---- From the eye ----------------------------------------------------------------------------------------------------

static Path path_of(const Ray *ray) {
  Path path;
  memcpy(path.p, ray->origin, sizeof path.p);
  const double length = sqrt(pow(ray->direction[0], 2) + pow(ray->direction[1], 2) + pow(ray->direction[2], 2));
  for (int k = 0; k < 3; ++k) path.d[k] = ray->direction[k] / length;
  return path;
}

// Where a path from outside enters; false when it misses. *t is below 0 where the eye is in the water.
static bool entry(const Slab *slab, const Path *path, double *t, int *axis) {
  double end = INFINITY;
  *t = -INFINITY;
  for (int k = 0; k < 3; ++k) {
    const double a = (slab->min[k] - path->p[k]) / path->d[k], b = (slab->max[k] - path->p[k]) / path->d[k];
    if (fmin(a, b) > *t) {
      *t = fmin(a, b);
      *axis = k;
    }
    end = fmin(end, fmax(a, b));
  }
  return *t < end && end > 0;
}

SlabPixel slab_look(const Slab *slab, const Ray *ray) {
  const Path path = path_of(ray);
  double t;
  int axis = 0;
  SlabPixel pixel = {.way = 0, .margin = INFINITY};
  if (!entry(slab, &path, &t, &axis)) {
    air_light(slab, &path, pixel.light);
    return pixel;
  }
  if (t < 0) return in_water(slab, &path, SURFACES);
  const Path at = moved(&path, t);
  Path mirrored, bent;
  const double mirror = split((double)slab->settings->refractive_index, &at, axis, false, &mirrored, &bent);
  const SlabPixel inside = in_water(slab, &bent, SURFACES);
  double outside[3];
  air_light(slab, &mirrored, outside);
  add(pixel.light, outside, mirror);
  add(pixel.light, inside.light, 1 - mirror);
  pixel.way = 8 * inside.way + 2 * axis + (path.d[axis] < 0) + 1;
  pixel.margin = fmin(inside.margin, margin_at(slab, at.p, axis));
  return pixel;
}
