#include "tests/render/pool_trace.h"

#include <math.h>
#include <stdlib.h>

#define MOST_SURFACES 6 // on a path
#define LEAST_WEIGHT 1e-4

double pool_wave_at(double x, double z, const void *context) {
  const PoolWave *w = context;
  return w->level + w->height * sin(w->turn[0] * x + w->turn[1] * z);
}

static Vec wave_normal(const PoolWave *w, Vec p) {
  const double slope = w->height * cos(w->turn[0] * p.x + w->turn[1] * p.z);
  return vec_unit((Vec){-slope * w->turn[0], 1, -slope * w->turn[1]});
}

// ---- Making ----------------------------------------------------------------------------------------------------------

static Vec sky_average(const Environment *e, double up) {
  return vec_mix(e->horizon, e->zenith, 0.25 + 0.25 * up);
}

PoolTrace pool_trace_create(const SimFrame *frame, const RenderSettings *settings, PoolWave wave) {
  PoolTrace p = {.environment = environment_create(frame, settings),
                 .container = frame->container,
                 .wave = wave,
                 .index = (double)settings->refractive_index,
                 .absorption = vec_of(settings->absorption),
                 .scattering = vec_of(settings->scattering)};
  p.glow = vec_scale(0.9, sky_average(&p.environment, 1));
  const double up = vec_unit(vec_of(settings->sun_direction)).y;
  p.slant = !settings->sun ? 1 : 1 / sqrt(1 - (1 - up * up) / (p.index * p.index));
  return p;
}

void pool_trace_destroy(PoolTrace *pool) {
  environment_destroy(&pool->environment);
}

// ---- Light in the water ----------------------------------------------------------------------------------------------

static Vec through_water(const PoolTrace *pool, Vec light, double t) {
  double out[3];
  const double a[3] = {pool->absorption.x, pool->absorption.y, pool->absorption.z};
  const double s[3] = {pool->scattering.x, pool->scattering.y, pool->scattering.z};
  const double glow[3] = {pool->glow.x, pool->glow.y, pool->glow.z}, in[3] = {light.x, light.y, light.z};
  for (int k = 0; k < 3; ++k) {
    const double left = exp(-(a[k] + s[k]) * t), share = a[k] + s[k] > 0 ? s[k] / (a[k] + s[k]) : 0;
    out[k] = in[k] * left + share * (1 - left) * glow[k];
  }
  return (Vec){out[0], out[1], out[2]};
}

// The sky's light on a body in the water is dimmed on its way down.
static Vec dimmed(const PoolTrace *pool, Vec light, Vec p) {
  const double path = 0.7 * pool->slant * fmax(pool_wave_at(p.x, p.z, &pool->wave) - p.y, 0);
  const Vec left = {exp(-pool->absorption.x * path), exp(-pool->absorption.y * path), exp(-pool->absorption.z * path)};
  return vec_times(light, left);
}

// ---- Where rays meet the water ---------------------------------------------------------------------------------------

typedef struct Crossing {
  double t;   // m; INFINITY: none
  Vec normal; // unit, outwards
} Crossing;

static bool over_pool(const SimContainer *c, Vec p) {
  return p.x >= (double)c->min[0] && p.x <= (double)c->max[0] && p.z >= (double)c->min[2] && p.z <= (double)c->max[2];
}

static double over_surface(const PoolTrace *pool, Vec o, Vec d, double t) {
  const Vec p = vec_along(o, t, d);
  return p.y - pool_wave_at(p.x, p.z, &pool->wave);
}

static double root_between(const PoolTrace *pool, Vec o, Vec d, double a, double b) {
  const bool above = over_surface(pool, o, d, a) > 0;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (a + b);
    if ((over_surface(pool, o, d, middle) > 0) == above) {
      a = middle;
    } else {
      b = middle;
    }
  }
  return 0.5 * (a + b);
}

// Along the ray in the layer that holds all waves. Level water is met at once.
static double meet_surface(const PoolTrace *pool, Vec o, Vec d, double least) {
  const PoolWave *w = &pool->wave;
  const double high = fabs(w->height) + 1e-9;
  const double a = (w->level - high - o.y) / d.y, b = (w->level + high - o.y) / d.y;
  const double from = fmax(fmin(a, b), least), to = fmin(fmax(a, b), from + 20);
  if (!(from < to)) return INFINITY;
  const int steps = w->height == 0 ? 1 : 64;
  for (int i = 0; i < steps; ++i) {
    const double t = from + (to - from) * i / steps, next = from + (to - from) * (i + 1) / steps;
    const bool above = over_surface(pool, o, d, t) > 0, above_next = over_surface(pool, o, d, next) > 0;
    if (above == above_next) continue;
    const double root = root_between(pool, o, d, t, next);
    return over_pool(&pool->container, vec_along(o, root, d)) ? root : INFINITY;
  }
  return INFINITY;
}

static void meet_wall(const PoolTrace *pool, Vec o, Vec d, double least, Vec outward, double limit, Crossing *first) {
  const double along = vec_dot(d, outward), t = (limit - vec_dot(o, outward)) / along;
  if (along == 0 || !(t > least && t < first->t)) return;
  const Vec p = vec_along(o, t, d), within = vec_along(p, -1e-9, outward);
  if (!over_pool(&pool->container, within) || p.y < 0 || p.y > pool_wave_at(p.x, p.z, &pool->wave)) return;
  *first = (Crossing){t, outward};
}

static Crossing meet_water(const PoolTrace *pool, Vec o, Vec d) {
  const double least = 1e-7;
  const SimContainer *c = &pool->container;
  Crossing first = {meet_surface(pool, o, d, least), {0, 1, 0}};
  if (isfinite(first.t)) first.normal = wave_normal(&pool->wave, vec_along(o, first.t, d));
  meet_wall(pool, o, d, least, (Vec){1, 0, 0}, (double)c->max[0], &first);
  meet_wall(pool, o, d, least, (Vec){-1, 0, 0}, -(double)c->min[0], &first);
  meet_wall(pool, o, d, least, (Vec){0, 0, 1}, (double)c->max[2], &first);
  meet_wall(pool, o, d, least, (Vec){0, 0, -1}, -(double)c->min[2], &first);
  return first;
}

// ---- Paths -----------------------------------------------------------------------------------------------------------

// `relative`: index of where light goes to, in that of where it comes from.
static double fresnel(double cosine, double relative) {
  const double sine2 = (1 - cosine * cosine) / (relative * relative);
  if (sine2 >= 1) return 1;
  const double bent = sqrt(1 - sine2);
  const double across = (cosine - relative * bent) / (cosine + relative * bent);
  const double along = (relative * cosine - bent) / (relative * cosine + bent);
  return (across * across + along * along) / 2;
}

static Vec trace(const PoolTrace *pool, Vec o, Vec d, bool wet, int surfaces, double weight);

static Vec split(const PoolTrace *pool, Vec p, Vec d, Vec normal, bool wet, int surfaces, double weight) {
  normal = vec_dot(normal, d) < 0 ? normal : vec_scale(-1, normal);
  const double cosine = fmin(-vec_dot(normal, d), 1), relative = wet ? 1 / pool->index : pool->index;
  const double mirror = fresnel(cosine, relative), sine2 = (1 - cosine * cosine) / (relative * relative);
  const Vec back = vec_along(d, 2 * cosine, normal);
  Vec light = vec_scale(mirror, trace(pool, p, back, wet, surfaces - 1, weight * mirror));
  if (mirror >= 1) return light;
  const Vec on = vec_along(vec_scale(1 / relative, d), cosine / relative - sqrt(1 - sine2), normal);
  return vec_along(light, 1 - mirror, trace(pool, p, vec_unit(on), !wet, surfaces - 1, weight * (1 - mirror)));
}

static Vec trace(const PoolTrace *pool, Vec o, Vec d, bool wet, int surfaces, double weight) {
  double t, t_body;
  Vec normal;
  Vec light = environment_light(&pool->environment, o, d, &t);
  const Crossing water = meet_water(pool, o, d);
  if (water.t < t) {
    if (surfaces > 0 && weight > LEAST_WEIGHT) {
      light = split(pool, vec_along(o, water.t, d), d, water.normal, wet, surfaces, weight);
    }
    t = water.t;
  } else if (wet && solids_meet(&pool->environment.solids, o, d, &t_body, &normal) != NULL && t_body <= t) {
    light = dimmed(pool, light, vec_along(o, t, d));
  }
  return wet && isfinite(t) ? through_water(pool, light, t) : light;
}

float *pool_trace_picture(const PoolTrace *pool, const RenderView *view, int32_t width, int32_t height,
                          uint8_t *water) {
  float *rgb = malloc(3 * sizeof *rgb * (size_t)width * (size_t)height);
  assert_non_null(rgb);
  for (int32_t i = 0; i < width * height; ++i) {
    const Ray ray = harness_ray(view, width, height, i % width, i / width);
    const Vec eye = {ray.origin[0], ray.origin[1], ray.origin[2]};
    const Vec way = vec_unit((Vec){ray.direction[0], ray.direction[1], ray.direction[2]});
    const bool wet = over_pool(&pool->container, eye) && eye.y < pool_wave_at(eye.x, eye.z, &pool->wave);
    const Vec light = trace(pool, eye, way, wet, MOST_SURFACES, 1);
    rgb[3 * i] = (float)light.x;
    rgb[3 * i + 1] = (float)light.y;
    rgb[3 * i + 2] = (float)light.z;
    double t;
    environment_light(&pool->environment, eye, way, &t);
    if (water != NULL) water[i] = wet || meet_water(pool, eye, way).t < t;
  }
  return rgb;
}

// ---- Comparing -------------------------------------------------------------------------------------------------------

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static PoolDifference summarise(double *values, int32_t count) {
  assert_true(count > 0);
  qsort(values, (size_t)count, sizeof *values, ascending);
  PoolDifference d = {0, values[count / 2], values[(int)(0.95 * (count - 1))], count};
  for (int32_t i = 0; i < count; ++i) d.mean += values[i] / count;
  free(values);
  return d;
}

PoolDifference pool_difference(const uint8_t *drawn, const float *truth, const uint8_t *mask, size_t pixels) {
  double *values = malloc(sizeof *values * pixels);
  int32_t count = 0;
  for (size_t i = 0; i < pixels; ++i) {
    if (!mask[i]) continue;
    double largest = 0;
    for (size_t k = 3 * i; k < 3 * i + 3; ++k) {
      const double wanted = 255 * fmin(fmax((double)truth[k], 0), 1);
      largest = fmax(largest, fabs(drawn[k] - wanted));
    }
    values[count++] = largest;
  }
  return summarise(values, count);
}

PoolDifference pool_difference_drawn(const uint8_t *a, const uint8_t *b, const uint8_t *mask, size_t pixels) {
  double *values = malloc(sizeof *values * pixels);
  int32_t count = 0;
  for (size_t i = 0; i < pixels; ++i) {
    if (!mask[i]) continue;
    double largest = 0;
    for (size_t k = 3 * i; k < 3 * i + 3; ++k) largest = fmax(largest, abs(a[k] - b[k]));
    values[count++] = largest;
  }
  return summarise(values, count);
}
