#include "tests/reference/reference.h"

#include <stdlib.h>

#include "tests/reference/optics.h"

struct Reference {
  Environment environment;
  Water *water;
  Optics optics;
};

Reference *reference_create(const SimFrame *frame, const RenderSettings *settings) {
  Reference *r = calloc(1, sizeof *r);
  if (r == NULL) return NULL;
  r->environment = environment_create(frame, settings);
  r->water = water_create(frame, &r->environment);
  if (r->water == NULL) {
    reference_destroy(r);
    return NULL;
  }
  r->optics = (Optics){&r->environment, r->water, vec_of(settings->absorption), (double)settings->refractive_index};
  return r;
}

void reference_destroy(Reference *r) {
  if (r == NULL) return;
  water_destroy(r->water);
  environment_destroy(&r->environment);
  free(r);
}

// ---- Rays of a picture -----------------------------------------------------------------------------------------------

typedef struct Camera {
  Vec eye, gaze, right, up; // unit axes
  double tan_x, tan_y;
  int32_t width, height;
  Medium medium; // around the eye
} Camera;

static Camera camera_of(const Reference *r, const RenderView *view, int32_t width, int32_t height) {
  Camera c = {.eye = vec_of(view->eye), .width = width, .height = height};
  c.gaze = vec_unit(vec_sub(vec_of(view->target), c.eye));
  c.right = vec_unit(vec_cross(c.gaze, (Vec){0, 1, 0}));
  c.up = vec_cross(c.right, c.gaze);
  c.tan_y = tan((double)view->vertical_fov * 3.14159265358979323846 / 360);
  c.tan_x = c.tan_y * width / height;
  c.medium = water_medium_at(r->water, c.eye);
  return c;
}

static WaterRay ray_through(const Camera *c, int32_t x, int32_t y) {
  const double px = c->tan_x * (2 * (x + 0.5) / c->width - 1), py = c->tan_y * (1 - 2 * (y + 0.5) / c->height);
  const Vec direction = vec_along(vec_along(c->gaze, px, c->right), py, c->up);
  return (WaterRay){c->eye, vec_unit(direction), c->medium, WATER_NOWHERE, WATER_NOWHERE};
}

/// What one pixel becomes; `detail` is the caller's number.
typedef void PixelFunction(const Reference *r, WaterRay ray, int detail, void *pixel);

static void each_pixel(const Reference *r, const RenderView *view, int32_t width, int32_t height,
                       PixelFunction *function, int detail, void *picture, size_t pixel_size) {
  const Camera camera = camera_of(r, view, width, height);
#pragma omp parallel for schedule(dynamic)
  for (int32_t y = 0; y < height; ++y) {
    char *row = (char *)picture + pixel_size * (size_t)width * (size_t)y;
    for (int32_t x = 0; x < width; ++x) function(r, ray_through(&camera, x, y), detail, row + pixel_size * (size_t)x);
  }
}

static void store(Vec light, float *rgb) {
  rgb[0] = (float)light.x;
  rgb[1] = (float)light.y;
  rgb[2] = (float)light.z;
}

static void tree_pixel(const Reference *r, WaterRay ray, int max_depth, void *pixel) {
  store(optics_tree(&r->optics, ray, max_depth > 0 ? max_depth : REFERENCE_DEPTH), pixel);
}

static void chain_pixel(const Reference *r, WaterRay ray, int max_refractions, void *pixel) {
  store(optics_chain(&r->optics, ray, max_refractions), pixel);
}

static void cover_pixel(const Reference *r, WaterRay ray, int detail, void *pixel) {
  double t;
  WaterHit hit;
  (void)detail;
  environment_light(&r->environment, ray.origin, ray.direction, &t);
  *(uint8_t *)pixel = water_meet(r->water, &ray, t, &hit);
}

void reference_trace(const Reference *r, const RenderView *view, int32_t width, int32_t height, int max_depth,
                     float *rgb) {
  each_pixel(r, view, width, height, tree_pixel, max_depth, rgb, 3 * sizeof *rgb);
}

void reference_trace_chain(const Reference *r, const RenderView *view, int32_t width, int32_t height,
                           int max_refractions, float *rgb) {
  each_pixel(r, view, width, height, chain_pixel, max_refractions, rgb, 3 * sizeof *rgb);
}

void reference_cover(const Reference *r, const RenderView *view, int32_t width, int32_t height, uint8_t *covered) {
  each_pixel(r, view, width, height, cover_pixel, 0, covered, sizeof *covered);
}

// ---- Single rays -----------------------------------------------------------------------------------------------------

static Vec vec_from(const double v[3]) {
  return (Vec){v[0], v[1], v[2]};
}

static WaterRay ray_from(const Reference *r, const double origin[3], const double direction[3]) {
  const Vec from = vec_from(origin);
  return (WaterRay){from, vec_unit(vec_from(direction)), water_medium_at(r->water, from), WATER_NOWHERE, WATER_NOWHERE};
}

static void store_double(Vec v, double out[3]) {
  out[0] = v.x;
  out[1] = v.y;
  out[2] = v.z;
}

void reference_ray(const Reference *r, const double origin[3], const double direction[3], int max_depth,
                   double rgb[3]) {
  const int depth = max_depth > 0 ? max_depth : REFERENCE_DEPTH;
  store_double(optics_tree(&r->optics, ray_from(r, origin, direction), depth), rgb);
}

void reference_ray_chain(const Reference *r, const double origin[3], const double direction[3], int max_refractions,
                         double rgb[3]) {
  store_double(optics_chain(&r->optics, ray_from(r, origin, direction), max_refractions), rgb);
}

bool reference_meet(const Reference *r, const double origin[3], const double direction[3], double *distance,
                    double normal[3]) {
  WaterRay ray = ray_from(r, origin, direction);
  WaterHit hit;
  if (!water_meet(r->water, &ray, INFINITY, &hit)) return false;
  *distance = hit.t;
  store_double(hit.normal, normal);
  return true;
}

bool reference_inside(const Reference *r, const double point[3]) {
  const Medium medium = water_medium_at(r->water, vec_from(point));
  return water_wet(&medium);
}

// ---- The mesh --------------------------------------------------------------------------------------------------------

static int by_edge(const void *a, const void *b) {
  const int32_t *x = a, *y = b;
  return x[0] != y[0] ? (x[0] < y[0] ? -1 : 1) : x[1] != y[1] ? (x[1] < y[1] ? -1 : 1) : 0;
}

// Sides as (lower vertex, higher vertex, +1 or −1 by the sense): in a closed mesh the senses of each edge add up to 0.
static int32_t count_open_edges(const Surface *s) {
  const size_t count = 3 * (size_t)s->triangle_count;
  int32_t(*side)[3] = malloc((count + 1) * sizeof *side), open = 0;
  if (side == NULL) return -1;
  for (size_t i = 0; i < count; ++i) {
    const int32_t a = s->triangle[i], b = s->triangle[i % 3 == 2 ? i - 2 : i + 1];
    side[i][0] = a < b ? a : b;
    side[i][1] = a < b ? b : a;
    side[i][2] = a < b ? 1 : -1;
  }
  qsort(side, count, sizeof *side, by_edge);
  for (size_t i = 0, next; i < count; i = next) {
    int32_t senses = 0;
    for (next = i; next < count && by_edge(side[i], side[next]) == 0; ++next) senses += side[next][2];
    open += abs(senses);
  }
  free(side);
  return open;
}

ReferenceMesh reference_mesh(const Reference *r) {
  const Surface *s = water_surface(r->water);
  return (ReferenceMesh){s->vertex_count, s->triangle_count, count_open_edges(s), surface_volume(s)};
}
