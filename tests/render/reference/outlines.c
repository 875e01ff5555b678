#include "tests/render/reference/outlines.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#define GAP 3
#define WIDE_GAP 30
#define LONGEST 10

typedef struct Way {
  int32_t x, y;
} Way;

// A place on a line.
typedef struct Seed {
  double x, y;                   // pixels
  double inverse;                // of the depth there
  double outwards_x, outwards_y; // out of the nearer thing
  bool silhouette;
  int32_t pixel; // that it belongs to
} Seed;

typedef struct Map {
  const Lens *lens;
  const float *depth;
  OutlineShape shape;
  Seed *seeds;
  int32_t count;
} Map;

static bool inside(const Map *map, int32_t x, int32_t y) {
  return x >= 0 && y >= 0 && x < map->lens->width && y < map->lens->height;
}

static double inverse_depth(const Map *map, int32_t x, int32_t y) {
  x = x < 0 ? 0 : x >= map->lens->width ? map->lens->width - 1 : x;
  y = y < 0 ? 0 : y >= map->lens->height ? map->lens->height - 1 : y;
  const double depth = (double)map->depth[y * map->lens->width + x];
  return depth > 0 ? 1 / depth : 0;
}

// ---- Cracks ----------------------------------------------------------------------------------------------------------

// Inverse depths along a line of pixels; the crack is between the third and the fourth of them.
typedef struct Line {
  double at[6];
} Line;

static bool line_across(const Map *map, int32_t x, int32_t y, Way way, Line *line) {
  for (int32_t k = 0; k < 6; ++k) line->at[k] = inverse_depth(map, x + (k - 2) * way.x, y + (k - 2) * way.y);
  return inside(map, x - 2 * way.x, y - 2 * way.y) && inside(map, x + 3 * way.x, y + 3 * way.y);
}

static bool stands_before(double a, double b, double c, double d, double pixel) {
  if (b <= 0) return false;
  if (c <= 0) return 2 * b - a > 0.5 * b;
  if (d <= 0) return false;
  const double by = b - (2 * c - d), beyond = (2 * b - a) - c;
  const bool wide = by > WIDE_GAP * pixel * b && b - c > 0.5 * by;
  return by > GAP * pixel * b && (wide || beyond > 0.3 * by);
}

// Inverse depth of what is nearer at the crack between a pixel and its neighbour, where that is the neighbour; else 0.
static double neighbour_before(const Map *map, int32_t x, int32_t y, Way way) {
  Line line;
  const double pixel = lens_pixel(map->lens);
  const bool backwards = way.x + way.y < 0; // a crack is looked at from below or from the left
  const Way ahead = backwards ? (Way){-way.x, -way.y} : way;
  if (!inside(map, x, y) || !inside(map, x + way.x, y + way.y)) return 0;
  if (!line_across(map, backwards ? x + way.x : x, backwards ? y + way.y : y, ahead, &line)) return 0;
  const double *p = line.at;
  const bool first = stands_before(p[1], p[2], p[3], p[4], pixel);
  if (backwards) return first ? p[2] : 0;
  return !first && stands_before(p[4], p[3], p[2], p[1], pixel) ? p[3] : 0;
}

// ---- Silhouettes -----------------------------------------------------------------------------------------------------

// Length of the stair of silhouettes to one side; *end: 1 the nearer thing grows there, −1 it shrinks, 0 neither.
static int32_t stair(const Map *map, int32_t x, int32_t y, Way way, Way aside, int *end) {
  *end = 0;
  for (int32_t k = 1; k <= LONGEST; ++k) {
    const int32_t nx = x + k * aside.x, ny = y + k * aside.y;
    if (neighbour_before(map, nx, ny, way) > 0) continue;
    const Way back = {-aside.x, -aside.y};
    if (neighbour_before(map, nx - aside.x, ny - aside.y, aside) > 0) {
      *end = 1;
    } else if (neighbour_before(map, nx + way.x, ny + way.y, back) > 0) {
      *end = -1;
    }
    return k;
  }
  return LONGEST + 1;
}

static double distance_along(const Map *map, int32_t x, int32_t y, Way way) {
  const Way up = {abs(way.y), abs(way.x)}, down = {-up.x, -up.y};
  int ends[2];
  const int32_t lengths[2] = {stair(map, x, y, way, up, &ends[0]), stair(map, x, y, way, down, &ends[1])};
  const double middle = 0.5 * (lengths[0] + lengths[1] - 1);
  double away = 0.5;
  for (int i = 0; i < 2; ++i) away -= 0.5 * ends[i] * fmax(1 - (lengths[i] - 0.5) / middle, 0);
  return away;
}

// Of what stands before the pixel (`before`), or of what the pixel is on. false: there is none.
static bool add_silhouette(Map *map, int32_t x, int32_t y, bool before) {
  static const Way ways[4] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
  double along[2] = {1e9, 1e9}, side[2] = {0, 0};
  Seed seed = {.silhouette = true, .pixel = y * map->lens->width + x};
  for (int i = 0; i < 4; ++i) {
    const Way way = ways[i], back = {-way.x, -way.y};
    const double near = before ? neighbour_before(map, x, y, way) : neighbour_before(map, x + way.x, y + way.y, back);
    if (near == 0) continue;
    const double away = before ? distance_along(map, x, y, way) : 1 - distance_along(map, x + way.x, y + way.y, back);
    if (away < along[i / 2]) {
      along[i / 2] = away;
      side[i / 2] = way.x + way.y;
    }
    seed.outwards_x += before ? -way.x : way.x;
    seed.outwards_y += before ? -way.y : way.y;
    seed.inverse = fmax(seed.inverse, near);
  }
  if (seed.inverse == 0) return false;
  // The foot of the perpendicular on the line across both axes, or the only crossing.
  double foot[2] = {along[0] < along[1] ? along[0] : 0, along[0] < along[1] ? 0 : along[1]};
  if (along[0] < 1e9 && along[1] < 1e9) {
    const double squares = fmax(along[0] * along[0] + along[1] * along[1], 1e-12);
    foot[0] = along[0] * along[1] * along[1] / squares;
    foot[1] = along[1] * along[0] * along[0] / squares;
  }
  seed.x = x + foot[0] * side[0];
  seed.y = y + foot[1] * side[1];
  map->seeds[map->count++] = seed;
  return true;
}

// ---- Creases ---------------------------------------------------------------------------------------------------------

// Unit normal of the plane with this inverse depth at a pixel that changes so from pixel to pixel; in view space.
static void plane_normal(const Map *map, int32_t x, int32_t y, double inverse, const double change[2], double n[3]) {
  const Lens *lens = map->lens;
  const double ray_x = lens_x(lens, x), ray_y = -lens_y(lens, y); // rows from the bottom
  n[0] = change[0] * lens->width / (2 * lens->tan_x);
  n[1] = change[1] * lens->height / (2 * lens->tan_y);
  n[2] = n[0] * ray_x + n[1] * ray_y - inverse;
  const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (int k = 0; k < 3; ++k) n[k] /= length;
}

static double change_aside(const Map *map, int32_t x, int32_t y, Way aside) {
  double at[5];
  for (int32_t k = 0; k < 5; ++k) at[k] = inverse_depth(map, x + (k - 2) * aside.x, y + (k - 2) * aside.y);
  const double up = fabs(at[4] - 2 * at[3] + at[2]), down = fabs(at[2] - 2 * at[1] + at[0]);
  return up < down ? at[3] - at[2] : at[2] - at[1];
}

static double cosine_of_sides(const Map *map, int32_t x, int32_t y, Way way, const double *p) {
  double normal[2][3], cosine = 0;
  for (int i = 0; i < 2; ++i) {
    const int32_t sx = x + i * way.x, sy = y + i * way.y;
    const double aside = change_aside(map, sx, sy, (Way){way.y, way.x});
    const double along = i == 0 ? p[2] - p[1] : p[4] - p[3];
    const double change[2] = {way.x == 1 ? along : aside, way.x == 1 ? aside : along};
    plane_normal(map, sx, sy, p[2 + i], change, normal[i]);
  }
  for (int k = 0; k < 3; ++k) cosine += normal[0][k] * normal[1][k];
  return cosine;
}

// Where the crease between a pixel and the one behind it lies, 0 … 1; −1: there is none.
static double crease_between(const Map *map, int32_t x, int32_t y, Way way) {
  Line line;
  const double pixel = lens_pixel(map->lens);
  if (!line_across(map, x, y, way, &line)) return -1;
  const double *p = line.at;
  for (int k = 0; k < 3; ++k) { // in the crack, and before and behind it
    if (stands_before(p[k], p[k + 1], p[k + 2], p[k + 3], pixel)) return -1;
    if (stands_before(p[k + 3], p[k + 2], p[k + 1], p[k], pixel)) return -1;
  }
  double bends[4];
  for (int k = 0; k < 4; ++k) bends[k] = p[k] - 2 * p[k + 1] + p[k + 2];
  const double bend = bends[1] + bends[2], wide = WIDE_GAP * pixel * fmin(p[2], p[3]);
  for (int k = 1; k < 5; ++k) {
    if (p[k] <= 0) return -1;
  }
  for (int k = 0; k < 4; k += 3) {
    if (fabs(bends[k]) >= 0.25 * fabs(bend) && fabs(bends[k]) <= wide) return -1;
  }
  if (fabs(bend) < 0.66 * sqrt(2 - 2 * map->shape.crease_cosine) * pixel * fmax(p[2], p[3])) return -1;
  const double place = bends[2] / bend;
  if (fabs(place - 0.5) > 0.55 || cosine_of_sides(map, x, y, way, p) >= map->shape.crease_cosine) return -1;
  return fmin(fmax(place, 0), 1);
}

static void add_crease(Map *map, int32_t x, int32_t y) {
  static const Way ways[4] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  Seed seed = {.inverse = inverse_depth(map, x, y), .pixel = y * map->lens->width + x};
  double nearest = 0.501;
  for (int i = 0; i < 4; ++i) {
    const bool behind = i >= 2;
    const double place =
        behind ? crease_between(map, x + ways[i].x, y + ways[i].y, ways[i - 2]) : crease_between(map, x, y, ways[i]);
    if (place < 0) continue;
    const double away = behind ? 1 - place : place;
    if (away >= nearest) continue;
    nearest = away;
    seed.x = x + away * ways[i].x;
    seed.y = y + away * ways[i].y;
  }
  if (nearest < 0.501) map->seeds[map->count++] = seed;
}

// ---- Ink -------------------------------------------------------------------------------------------------------------

// How much of a pixel the line of a seed covers.
static double covered(const Map *map, const Seed *seed, int32_t x, int32_t y) {
  const double inverse = inverse_depth(map, x, y), pixel = lens_pixel(map->lens), width = fmax(map->shape.width, 1);
  const double distance = hypot(x - seed->x, y - seed->y);
  const bool own = seed->pixel == y * map->lens->width + x;
  const bool outside = (x - seed->x) * seed->outwards_x + (y - seed->y) * seed->outwards_y > -1e-3;
  double reach = 0.5 * width;
  if (seed->silhouette) {
    if (!own && !(inverse < seed->inverse * (1 - 2 * pixel) && outside)) return 0;
    reach = outside ? width - 0.5 : 0.5;
  } else if (!own && inverse >= seed->inverse * (1 + 16 * pixel)) {
    return 0;
  }
  return fmin(fmax(reach + 0.5 - distance, 0), 1) * fmin(map->shape.width, 1);
}

double *outlines_drawn(const Lens *lens, const float *depth, OutlineShape shape) {
  const size_t pixels = (size_t)lens->width * (size_t)lens->height;
  Map map = {lens, depth, shape, malloc(pixels * sizeof(Seed)), 0};
  double *ink = calloc(pixels, sizeof *ink);
  for (int32_t y = 0; y < lens->height; ++y) {
    for (int32_t x = 0; x < lens->width; ++x) {
      if (!add_silhouette(&map, x, y, true) && !add_silhouette(&map, x, y, false)) add_crease(&map, x, y);
    }
  }
  for (int32_t y = 0; y < lens->height; ++y) {
    for (int32_t x = 0; x < lens->width; ++x) {
      double *here = &ink[y * lens->width + x];
      for (int32_t i = 0; i < map.count; ++i) *here = fmax(*here, covered(&map, &map.seeds[i], x, y));
    }
  }
  free(map.seeds);
  return ink;
}
