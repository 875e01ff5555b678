#include "tests/render/quality.h"

#include <math.h>
#include <stdlib.h>

#define DEGREES (180 / 3.14159265358979323846)

// Long lines of numbers.
// clang-format off
const QualityPool quality_pools[QUALITY_POOLS] = {
    {"still flat", {1.4, 0, 1.05}, 0.0175, 0.35, 0, 1, QUALITY_COLUMNS, {0.4f, 0.78f, 2.45f}, {0.7f, 0.26f, 0.5f}, 38},
    {"dam flat", {3.01, 0, 1.015}, 0.0175, 0.35, 0, 1, QUALITY_COLUMNS, {0.8f, 1.15f, 3.5f}, {1.5f, 0.5f, 0.4f}, 38},
    {"wide flat", {2.56, 0, 2.56}, 0.02, 0.64, 0, 1, QUALITY_COLUMNS, {-0.75f, 2.6f, 5.3f}, {1.36f, 0.36f, 1.2f}, 38},
    {"still wave", {1.4, 0, 1.05}, 0.0175, 0.35, 1, 1, QUALITY_COLUMNS, {0.4f, 0.78f, 2.45f}, {0.7f, 0.26f, 0.5f}, 38},
    {"dam wave", {3.01, 0, 1.015}, 0.0175, 0.35, 1, 1, QUALITY_COLUMNS, {0.8f, 1.15f, 3.5f}, {1.5f, 0.5f, 0.4f}, 38},
    {"wide wave", {2.56, 0, 2.56}, 0.02, 0.64, 1, 1, QUALITY_COLUMNS, {-0.75f, 2.6f, 5.3f}, {1.36f, 0.36f, 1.2f}, 38},
    {"dam long", {3.01, 0, 1.015}, 0.0175, 0.35, 1.5, 2, QUALITY_COLUMNS, {0.8f, 1.15f, 3.5f}, {1.5f, 0.5f, 0.4f}, 38},
    {"dam short", {3.01, 0, 1.015}, 0.0175, 0.35, 0.6, 0.7, QUALITY_COLUMNS, {0.8f, 1.15f, 3.5f}, {1.5f, 0.5f, 0.4f}, 38},
};
// clang-format on

// ---- The surface -----------------------------------------------------------------------------------------------------

double quality_height(const QualityPool *pool, double x, double z, double normal[3]) {
  const double a = 4.2 * x / pool->stretch + 0.6, b = 2.1 * z / pool->stretch, c = (9 * x + 5 * z) / pool->stretch;
  const double large = 0.05 * pool->amplitude, small = 0.02 * pool->amplitude;
  const double hx = (large * 4.2 * cos(a) * cos(b) + small * 9 * cos(c)) / pool->stretch;
  const double hz = (-large * 2.1 * sin(a) * sin(b) + small * 5 * cos(c)) / pool->stretch;
  const double length = sqrt(hx * hx + hz * hz + 1);
  normal[0] = -hx / length;
  normal[1] = 1 / length;
  normal[2] = -hz / length;
  return pool->level + large * sin(a) * cos(b) + small * sin(c);
}

// ---- The particles ---------------------------------------------------------------------------------------------------

// A number in [−1, 1], the same every time.
static double noise(uint32_t n) {
  n = (n ^ 61) ^ (n >> 16);
  n *= 9;
  n ^= n >> 4;
  n *= 0x27d4eb2d;
  n ^= n >> 15;
  return n % 65536 / 32767.5 - 1;
}

// Displace the n-th particle, in units of a fifth of a spacing. Waves shorter than the spacing are as good as chance for
// most neighbours, but leave no dents and bumps that are wider than a particle, as liquids at rest leave none.
static void disorder(QualityFill kind, uint32_t n, const double p[3], double d[3]) {
  const double wave[3] = {sin(91 * p[1] + 37 * p[2]), sin(57 * p[0] + 83 * p[2]), sin(71 * p[0] + 47 * p[1])};
  for (uint32_t k = 0; k < 3; ++k) d[k] = kind == QUALITY_NOISE ? noise(3 * n + k) : wave[k];
}

// Height of the topmost particle of a column.
static double top_of(const QualityPool *pool, double x, double z) {
  double normal[3];
  const double spacing = 2 * pool->radius, height = quality_height(pool, x, z, normal);
  if (pool->fill == QUALITY_LATTICE) return spacing * (floor(height / spacing - 0.5) + 0.5);
  return height - pool->radius / normal[1];
}

// Particles in columns that are moved along x by `shift`; (count, 3), to be freed.
static float *fill(const QualityPool *pool, double shift, int32_t *count) {
  const double spacing = 2 * pool->radius;
  const int32_t nx = (int32_t)lround(pool->size[0] / spacing), nz = (int32_t)lround(pool->size[2] / spacing);
  const int32_t ny = (int32_t)((pool->level + 0.1 * pool->amplitude) / spacing) + 1;
  float *position = malloc(3 * (size_t)nx * (size_t)ny * (size_t)nz * sizeof *position), *to = position;
  for (int32_t k = 0; k < nz; ++k) {
    for (int32_t i = 0; i < nx; ++i) {
      const double x = spacing * (i + 0.5), z = spacing * (k + 0.5), top = top_of(pool, x + shift, z);
      for (int32_t j = 0; j < ny && top - spacing * j > 0; ++j) {
        const double place[3] = {x, top - spacing * j, z};
        double d[3];
        disorder(pool->fill, (uint32_t)((k * nx + i) * ny + j), place, d);
        for (int a = 0; a < 3; ++a) *to++ = (float)(place[a] + (a == 0 ? shift : 0) + 0.2 * spacing * d[a]);
      }
    }
  }
  *count = (int32_t)((to - position) / 3);
  return position;
}

const SimFrame *quality_frame(const QualityPool *pool, double shift, SimFrameBuffer *buffer) {
  SimParticleSet set = {.particle_radius = (float)pool->radius};
  float *position = fill(pool, shift, &set.count);
  set.position = position;
  SimError error;
  const SimFrame *frame =
      sim_frame_from_particles(&set, SIM_NEED_CLASS | SIM_NEED_ANISOTROPY | SIM_NEED_SURFACE, 1, buffer, &error);
  if (!frame) abort();
  free(position);
  return frame;
}

// ---- The truth -------------------------------------------------------------------------------------------------------

static void along(const Pinhole *pinhole, const double ray[3], double depth, double point[3]) {
  for (int k = 0; k < 3; ++k) point[k] = pinhole->eye[k] + depth * ray[k];
}

// How far a point of the ray lies above the surface.
static double above(const QualityPool *pool, const Pinhole *pinhole, const double ray[3], double depth) {
  double p[3], normal[3];
  along(pinhole, ray, depth, p);
  return p[1] - quality_height(pool, p[0], p[2], normal);
}

static bool inside(const QualityPool *pool, const double p[3], double margin) {
  return p[0] > margin && p[0] < pool->size[0] - margin && p[2] > margin && p[2] < pool->size[2] - margin;
}

// Where the ray first meets the water, by small steps and bisection; false where it does so through a side or within
// `margin` radii of the outline.
static bool meets(const QualityPool *pool, double margin, const Pinhole *pinhole, const double ray[3],
                  double point[3]) {
  const double highest = pool->level + 0.07 * pool->amplitude + 1e-6;
  if (ray[1] >= 0) return false;
  double depth = fmax((highest - pinhole->eye[1]) / ray[1], 0);
  const double lowest = -pinhole->eye[1] / ray[1], step = pool->radius / 2;
  for (; depth < lowest; depth += step) {
    along(pinhole, ray, depth + step, point);
    if (!inside(pool, point, 0) || above(pool, pinhole, ray, depth + step) > 0) continue;
    double near = depth, far = depth + step;
    for (int k = 0; k < 40; ++k) *(above(pool, pinhole, ray, (near + far) / 2) > 0 ? &near : &far) = (near + far) / 2;
    along(pinhole, ray, far, point);
    return inside(pool, point, margin * pool->radius);
  }
  return false;
}

// Where a ray from the water first comes out of it; false where it does not do so through the surface, or within `margin`
// radii of the outline.
static bool leaves(const QualityPool *pool, double margin, const Pinhole *pinhole, const double ray[3],
                   double point[3]) {
  const double lowest = pool->level - 0.07 * pool->amplitude - 1e-6, rise = lowest - pinhole->eye[1];
  if (rise > 0 && ray[1] <= 0) return false;
  const double step = pool->radius / 2;
  for (double depth = rise > 0 ? rise / ray[1] : 0;; depth += step) {
    along(pinhole, ray, depth + step, point);
    if (!inside(pool, point, 0) || point[1] < 0) return false;
    if (above(pool, pinhole, ray, depth + step) < 0) continue;
    double near = depth, far = depth + step;
    for (int k = 0; k < 40; ++k) *(above(pool, pinhole, ray, (near + far) / 2) < 0 ? &near : &far) = (near + far) / 2;
    along(pinhole, ray, far, point);
    return inside(pool, point, margin * pool->radius);
  }
}

QualityTruth quality_truth_create(const QualityPool *pool, int32_t width, int32_t height, double margin) {
  QualityTruth truth = {.pool = pool, .pinhole = pinhole_make(pool->eye, pool->target, pool->fov, width, height)};
  truth.normal = calloc(3 * (size_t)width * (size_t)height, sizeof(float));
  const bool submerged = inside(pool, truth.pinhole.eye, 0) && above(pool, &truth.pinhole, (double[3]){0}, 0) < 0;
  for (int32_t row = 0; row < height; ++row) {
    for (int32_t column = 0; column < width; ++column) {
      double ray[3], point[3], normal[3], view[3];
      pinhole_ray(&truth.pinhole, column, row, ray);
      if (!(submerged ? leaves : meets)(pool, margin, &truth.pinhole, ray, point)) continue;
      quality_height(pool, point[0], point[2], normal);
      pinhole_to_view(&truth.pinhole, normal, view);
      float *to = truth.normal + 3 * ((size_t)row * (size_t)width + (size_t)column);
      for (int k = 0; k < 3; ++k) to[k] = (float)view[k];
    }
  }
  return truth;
}

void quality_truth_destroy(QualityTruth *truth) {
  free(truth->normal);
}

// ---- The comparison --------------------------------------------------------------------------------------------------

static double angle(const float a[3], const float b[3]) {
  double difference = 0, sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double d = (double)a[k] - (double)b[k], s = (double)a[k] + (double)b[k];
    difference += d * d;
    sum += s * s;
  }
  return 2 * atan2(sqrt(difference), sqrt(sum)) * DEGREES;
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// Distance of a pixel's point above the true surface, in radii.
static double height_over(const QualityTruth *truth, size_t pixel, float depth) {
  const int32_t width = truth->pinhole.lens.width;
  double ray[3], p[3], normal[3];
  pinhole_ray(&truth->pinhole, (int32_t)(pixel % (size_t)width), (int32_t)(pixel / (size_t)width), ray);
  along(&truth->pinhole, ray, (double)depth, p);
  const double height = quality_height(truth->pool, p[0], p[2], normal);
  return (p[1] - height) * normal[1] / truth->pool->radius;
}

static bool is_seen(const float normal[3]) {
  return normal[0] != 0 || normal[1] != 0 || normal[2] != 0;
}

static double grain(const QualityTruth *truth, const SplatMap *map) {
  const size_t width = (size_t)truth->pinhole.lens.width, height = (size_t)truth->pinhole.lens.height;
  double sum = 0;
  size_t pairs = 0;
  for (size_t row = 0; row + 1 < height; ++row) {
    for (size_t column = 0; column + 1 < width; ++column) {
      const size_t i = row * width + column, next[2] = {i + 1, i + width};
      for (int k = 0; k < 2; ++k) {
        const float *here = truth->normal + 3 * i, *there = truth->normal + 3 * next[k];
        if (!is_seen(here) || !is_seen(there) || map->depth[i] <= 0 || map->depth[next[k]] <= 0) continue;
        sum += angle(map->normal + 3 * i, map->normal + 3 * next[k]) - angle(here, there);
        ++pairs;
      }
    }
  }
  return pairs > 0 ? sum / (double)pairs : 0;
}

QualityFigures quality_compare(const QualityTruth *truth, const SplatMap *still, const SplatMap *shifted) {
  const size_t pixels = (size_t)truth->pinhole.lens.width * (size_t)truth->pinhole.lens.height;
  double *angles = malloc(pixels * sizeof *angles);
  QualityFigures f = {0};
  size_t seen = 0, met = 0, both = 0;
  double squares = 0;
  for (size_t i = 0; i < pixels; ++i) {
    const float *n = truth->normal + 3 * i;
    if (!is_seen(n)) continue;
    ++seen;
    if (still->depth[i] <= 0) continue;
    angles[met] = angle(still->normal + 3 * i, n);
    f.mean += angles[met++];
    const double over = height_over(truth, i, still->depth[i]);
    f.bias += over;
    squares += over * over;
    if (shifted->depth[i] <= 0) continue;
    f.flicker += angle(still->normal + 3 * i, shifted->normal + 3 * i);
    ++both;
  }
  qsort(angles, met, sizeof *angles, ascending);
  f.p95 = met ? angles[met * 95 / 100] : 0;
  f.mean /= (double)met;
  f.bias /= (double)met;
  f.rough = sqrt(fmax(squares / (double)met - f.bias * f.bias, 0));
  f.flicker /= (double)both;
  f.lost = 1 - (double)met / (double)seen;
  f.grain = grain(truth, still);
  free(angles);
  return f;
}

// ---- Of filters ------------------------------------------------------------------------------------------------------

static SplatMap splat(const QualityTruth *truth, double shift) {
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  const SimFrame *frame = quality_frame(truth->pool, shift, buffer);
  SplatMap map = splat_map_create(&truth->pinhole.lens);
  splat_frame(&truth->pinhole, SPLAT_FRONT, frame, SIM_AGGREGATED, SPLAT_DEFAULT_SHAPE, &map);
  sim_frame_buffer_destroy(buffer);
  return map;
}

QualityCase quality_case_create(const QualityPool *pool, int32_t width, int32_t height, double margin) {
  QualityCase c = {.truth = quality_truth_create(pool, width, height, margin)};
  c.map = splat(&c.truth, 0);
  c.shifted = splat(&c.truth, pool->radius / 2);
  return c;
}

void quality_case_destroy(QualityCase *c) {
  quality_truth_destroy(&c->truth);
  splat_map_destroy(&c->map);
  splat_map_destroy(&c->shifted);
}

static SplatMap filtered(const QualityCase *c, const SplatMap *map, QualityFilter *filter, const void *parameters) {
  const SmoothInput input = {c->truth.pinhole.lens, c->truth.pool->radius, map->depth, map->normal};
  SplatMap out = splat_map_create(&input.lens);
  filter(&input, parameters, out.depth);
  smooth_normals(&input.lens, input.radius, out.depth, out.normal);
  return out;
}

QualityFigures quality_measure(const QualityCase *c, QualityFilter *filter, const void *parameters) {
  SplatMap still = filtered(c, &c->map, filter, parameters), shifted = filtered(c, &c->shifted, filter, parameters);
  const QualityFigures f = quality_compare(&c->truth, &still, &shifted);
  splat_map_destroy(&still);
  splat_map_destroy(&shifted);
  return f;
}

// ---- Exact maps ------------------------------------------------------------------------------------------------------

// Two halves of planes n·p = −d with a step between them, or one disc; both are kept exactly by a perfect filter.
typedef struct Planes {
  double tilt; // slope of the depth upwards, tan of the angle
  double gap;  // radii, of the right half behind the left one; 0: a disc
} Planes;

#define EDGE_SIZE 320
#define EDGE_RADIUS 0.0175

// Inverse depth of a plane that a pixel's ray meets at this depth in the middle of the picture.
static double plane_inverse(const Lens *lens, const Planes *planes, double depth, int32_t row) {
  return (1 - planes->tilt * lens_y(lens, row)) / depth;
}

static double largest_deviation(const Planes *planes, QualityFilter *filter, const void *parameters) {
  const Lens lens = {EDGE_SIZE, EDGE_SIZE, 0.15, 0.15};
  const size_t pixels = EDGE_SIZE * EDGE_SIZE;
  float *depth = calloc(2 * pixels, sizeof *depth), *normal = calloc(3 * pixels, sizeof *normal),
        *smoothed = depth + pixels;
  const double length = sqrt(1 + planes->tilt * planes->tilt);
  for (int32_t row = 0; row < EDGE_SIZE; ++row) {
    for (int32_t column = 0; column < EDGE_SIZE; ++column) {
      const size_t i = (size_t)row * EDGE_SIZE + (size_t)column;
      const double x = column - EDGE_SIZE / 2, y = row - EDGE_SIZE / 2;
      if (planes->gap == 0 && x * x + y * y > EDGE_SIZE * EDGE_SIZE / 9.0) continue;
      const double behind = x < 0 ? 0 : planes->gap * EDGE_RADIUS;
      depth[i] = (float)(1 / plane_inverse(&lens, planes, 2 + behind, row));
      normal[3 * i + 1] = (float)(planes->tilt / length);
      normal[3 * i + 2] = (float)(1 / length);
    }
  }
  const SmoothInput input = {lens, EDGE_RADIUS, depth, normal};
  filter(&input, parameters, smoothed);
  double largest = 0;
  // Away from the picture's own rim.
  for (int32_t row = 20; row < EDGE_SIZE - 20; ++row) {
    for (int32_t column = 20; column < EDGE_SIZE - 20; ++column) {
      const size_t i = (size_t)row * EDGE_SIZE + (size_t)column;
      const double behind = column < EDGE_SIZE / 2 ? 0 : planes->gap * EDGE_RADIUS;
      if (depth[i] <= 0) continue;
      // n·p + d of the point, d = depth in the middle / length
      const double d = (2 + behind) / length,
                   ratio = (double)smoothed[i] * plane_inverse(&lens, planes, 2 + behind, row);
      largest = fmax(largest, fabs(ratio - 1) * d / EDGE_RADIUS);
    }
  }
  free(depth);
  free(normal);
  return largest;
}

QualityEdges quality_edges(QualityFilter *filter, const void *parameters) {
  const double steep = tan(70 / DEGREES), gaps[3] = {3, 6, 12};
  QualityEdges edges;
  edges.patch = largest_deviation(&(Planes){steep, 0}, filter, parameters);
  for (int k = 0; k < 3; ++k) edges.step[k] = largest_deviation(&(Planes){0, gaps[k]}, filter, parameters);
  edges.tilted = largest_deviation(&(Planes){steep, gaps[2]}, filter, parameters);
  return edges;
}
