// Cords 2007, section 2.2: "We approximate the surface surrounding area of an object with a plane", and "the surface close
// to the object is adapted linearly, in a way that it approximates the plane in the surroundings of the object".
#include "render/water_planes.h"

#include <math.h>

#define MOST_SAMPLES 16384 // nodes looked at for a plane: of more, every second, third …
#define STEEPEST 1.f       // slope of a plane: 45°

// ---- Nodes around a box ----------------------------------------------------------------------------------------------

typedef struct Patch {
  int32_t begin[2], end[2], step; // nodes along x and z
} Patch;

static int32_t node_at(float nodes, int32_t size) {
  return nodes > 0 ? nodes < (float)size ? (int32_t)nodes : size : 0;
}

// Not more than `most` nodes within `reach` of the footprint, evenly chosen.
static Patch patch_around(const RenderWaterNodes *nodes, const float low[2], const float high[2], float reach,
                          double most) {
  Patch patch = {.step = 1};
  for (int k = 0; k < 2; ++k) {
    patch.begin[k] = node_at(ceilf((low[k] - reach - nodes->origin[k]) / nodes->spacing), nodes->size[k]);
    patch.end[k] = node_at(floorf((high[k] + reach - nodes->origin[k]) / nodes->spacing) + 1, nodes->size[k]);
  }
  const double count = (double)(patch.end[0] - patch.begin[0]) * (patch.end[1] - patch.begin[1]);
  if (count > most) patch.step = (int32_t)ceil(sqrt(count / most));
  return patch;
}

static size_t node_index(const RenderWaterNodes *nodes, int32_t i, int32_t k) {
  return (size_t)k * (size_t)nodes->size[0] + (size_t)i;
}

static void node_place(const RenderWaterNodes *nodes, int32_t i, int32_t k, float p[3]) {
  p[0] = nodes->origin[0] + (float)i * nodes->spacing;
  p[2] = nodes->origin[1] + (float)k * nodes->spacing;
}

float render_water_level(const RenderWaterNodes *nodes, const float min[3], const float max[3], float reach) {
  const Patch patch = patch_around(nodes, (float[2]){min[0], min[2]}, (float[2]){max[0], max[2]}, reach, 256);
  double sum = 0;
  int32_t count = 0;
  for (int32_t k = patch.begin[1]; k < patch.end[1]; k += patch.step) {
    for (int32_t i = patch.begin[0]; i < patch.end[0]; i += patch.step) {
      const float height = nodes->height[node_index(nodes, i, k)];
      if (isnan(height)) continue;
      sum += (double)height;
      ++count;
    }
  }
  return count > 0 ? (float)(sum / count) : nodes->mean;
}

// ---- The plane that fits best ----------------------------------------------------------------------------------------

// Weighted sums over nodes, around `from`.
typedef struct Sums {
  double from[3];
  double weight, x, z, y, xx, xz, zz, xy, zy;
  int32_t count;
} Sums;

static void add(Sums *s, double weight, const float p[3]) {
  const double x = (double)p[0] - s->from[0], y = (double)p[1] - s->from[1], z = (double)p[2] - s->from[2];
  s->weight += weight;
  s->x += weight * x;
  s->y += weight * y;
  s->z += weight * z;
  s->xx += weight * x * x;
  s->xz += weight * x * z;
  s->zz += weight * z * z;
  s->xy += weight * x * y;
  s->zy += weight * z * y;
  ++s->count;
}

// Slopes by least squares; none where the nodes are few or lie in a row.
static void fit_slopes(const Sums *s, double slope[2]) {
  const double w = s->weight;
  const double xx = s->xx - s->x * s->x / w, xz = s->xz - s->x * s->z / w, zz = s->zz - s->z * s->z / w;
  const double xy = s->xy - s->x * s->y / w, zy = s->zy - s->z * s->y / w;
  const double determinant = xx * zz - xz * xz;
  slope[0] = slope[1] = 0;
  if (s->count < 6 || !(determinant > 1e-4 * (xx + zz) * (xx + zz))) return;
  slope[0] = (xy * zz - zy * xz) / determinant;
  slope[1] = (zy * xx - xy * xz) / determinant;
  const double steep = hypot(slope[0], slope[1]);
  for (int k = 0; k < 2 && steep > STEEPEST; ++k) slope[k] *= STEEPEST / steep;
}

static void plane_of_sums(const Sums *s, float plane[4]) {
  double slope[2];
  fit_slopes(s, slope);
  const double length = sqrt(slope[0] * slope[0] + slope[1] * slope[1] + 1);
  const double normal[3] = {-slope[0] / length, 1 / length, -slope[1] / length};
  const double middle[3] = {s->from[0] + s->x / s->weight, s->from[1] + s->y / s->weight,
                            s->from[2] + s->z / s->weight};
  for (int k = 0; k < 3; ++k) plane[k] = (float)normal[k];
  plane[3] = -(float)(normal[0] * middle[0] + normal[1] * middle[1] + normal[2] * middle[2]);
}

static float nearest_distance(const RenderSolid *solids, int32_t count, const float p[3]) {
  float nearest = INFINITY;
  for (int32_t i = 0; i < count; ++i) nearest = fminf(nearest, render_solid_distance(&solids[i], p));
  return nearest;
}

void render_water_plane_fit(const RenderWaterNodes *nodes, const RenderSolid *solids, int32_t count, float from,
                            float to, float plane[4]) {
  float min[3], max[3];
  render_solids_bounds(solids, count, min, max);
  const float level = render_water_level(nodes, min, max, to);
  // What is over or under the water has no distance from it along the surface: that at half its height stands for it.
  const bool crosses = min[1] < level && level < max[1];
  Sums sums = {.from = {(double)(min[0] + max[0]) / 2, (double)level, (double)(min[2] + max[2]) / 2}};
  const Patch patch = patch_around(nodes, (float[2]){min[0], min[2]}, (float[2]){max[0], max[2]}, to, MOST_SAMPLES);
  for (int32_t k = patch.begin[1]; k < patch.end[1]; k += patch.step) {
    for (int32_t i = patch.begin[0]; i < patch.end[0]; i += patch.step) {
      float p[3] = {0, nodes->height[node_index(nodes, i, k)], 0};
      if (isnan(p[1])) continue;
      node_place(nodes, i, k, p);
      const float beside[3] = {p[0], crosses ? p[1] : (min[1] + max[1]) / 2, p[2]};
      const float distance = nearest_distance(solids, count, beside);
      if (!(distance >= from && distance < to)) continue;
      const double share = (double)(distance / to), weight = (1 - share * share) * (1 - share * share);
      add(&sums, weight, p);
    }
  }
  if (sums.count == 0) add(&sums, 1, (float[3]){(min[0] + max[0]) / 2, level, (min[2] + max[2]) / 2});
  plane_of_sums(&sums, plane);
}

// ---- The surface pulled to planes ------------------------------------------------------------------------------------

typedef struct Pulling {
  const RenderWaterNodes *nodes;
  const RenderWaterPull *pulls;
  int32_t count;
  float full, blend, fill; // m
} Pulling;

// What the planes make of a node.
typedef struct Pulled {
  float height;   // m, where the planes are
  float weight;   // of that against what the surface is, [0, 1]
  float distance; // m, from the nearest solid
} Pulled;

static float plane_height(const float plane[4], const float p[3]) {
  return -(plane[0] * p[0] + plane[2] * p[2] + plane[3]) / plane[1];
}

static float reach_of(const Pulling *pulling) {
  return fmaxf(pulling->fill, pulling->blend > 0 ? pulling->full + pulling->blend : 0);
}

static bool in_reach(const RenderWaterPull *pull, const float p[3], float reach) {
  return p[0] > pull->min[0] - reach && p[0] < pull->max[0] + reach && p[2] > pull->min[1] - reach &&
         p[2] < pull->max[1] + reach;
}

// Between several solids the planes are blended so that a solid's own prevails beside it.
static Pulled pull_node(const Pulling *pulling, const float p[3]) {
  const float reach = reach_of(pulling), full = fmaxf(pulling->full, 1e-6f);
  Pulled pulled = {0, 0, INFINITY};
  float sum = 0;
  for (int32_t i = 0; i < pulling->count; ++i) {
    const RenderWaterPull *pull = &pulling->pulls[i];
    if (!in_reach(pull, p, reach)) continue;
    const float height = plane_height(pull->plane, p);
    const float distance = nearest_distance(pull->solids, pull->count, (float[3]){p[0], height, p[2]});
    if (!(distance < reach)) continue;
    pulled.distance = fminf(pulled.distance, distance);
    const float beyond = fmaxf(distance - full, 0);
    const float weight = pulling->blend > 0 ? fmaxf(1 - beyond / pulling->blend, 0) : 0;
    const float near = fmaxf(distance, 0) / full,
                share = (weight + 1e-6f) / ((1.001f - weight) * (near * near + 1e-3f));
    pulled.height += share * height;
    pulled.weight = fmaxf(pulled.weight, weight);
    sum += share;
  }
  if (sum > 0) pulled.height /= sum;
  return pulled;
}

enum { DRY = 0, WET, DRY_BUT_NEAR, JUST_WET };

// Output: heights and marks. Dry nodes near solids hold what they would be.
static Patch pull_nodes(const Pulling *pulling, const Patch *patch, uint8_t *marks) {
  const RenderWaterNodes *nodes = pulling->nodes;
  Patch near = {{nodes->size[0], nodes->size[1]}, {0, 0}, 1};
  for (int32_t k = patch->begin[1]; k < patch->end[1]; ++k) {
    for (int32_t i = patch->begin[0]; i < patch->end[0]; ++i) {
      float p[3], *height = &nodes->height[node_index(nodes, i, k)];
      node_place(nodes, i, k, p);
      const Pulled pulled = pull_node(pulling, p);
      if (!isnan(*height)) {
        *height += pulled.weight * (pulled.height - *height);
      } else if (pulled.distance < pulling->fill) {
        *height = pulled.height;
        marks[node_index(nodes, i, k)] = DRY_BUT_NEAR;
        near.begin[0] = i < near.begin[0] ? i : near.begin[0];
        near.begin[1] = k < near.begin[1] ? k : near.begin[1];
        near.end[0] = i >= near.end[0] ? i + 1 : near.end[0];
        near.end[1] = k >= near.end[1] ? k + 1 : near.end[1];
      }
    }
  }
  return near;
}

static bool beside_wet(const RenderWaterNodes *nodes, const uint8_t *marks, int32_t i, int32_t k) {
  for (int32_t z = k - 1; z <= k + 1; ++z) {
    for (int32_t x = i - 1; x <= i + 1; ++x) {
      const bool within = x >= 0 && x < nodes->size[0] && z >= 0 && z < nodes->size[1];
      if (within && marks[node_index(nodes, x, z)] == WET) return true;
    }
  }
  return false;
}

// One node farther. Output: whether any became wet.
static bool spread(const RenderWaterNodes *nodes, const Patch *near, uint8_t *marks) {
  bool any = false;
  for (int pass = 0; pass < 2; ++pass) {
    for (int32_t k = near->begin[1]; k < near->end[1]; ++k) {
      for (int32_t i = near->begin[0]; i < near->end[0]; ++i) {
        uint8_t *mark = &marks[node_index(nodes, i, k)];
        if (pass == 1 && *mark == JUST_WET) *mark = WET;
        if (pass == 1 || *mark != DRY_BUT_NEAR || !beside_wet(nodes, marks, i, k)) continue;
        *mark = JUST_WET;
        any = true;
      }
    }
  }
  return any;
}

void render_water_pull(const RenderWaterNodes *nodes, const RenderWaterPull *pulls, int32_t count, float full,
                       float blend, float fill, uint8_t *marks) {
  if (count == 0 || !nodes->wet) return;
  const Pulling pulling = {nodes, pulls, count, full, blend, fill};
  const size_t all = (size_t)nodes->size[0] * (size_t)nodes->size[1];
  float low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  for (int32_t i = 0; i < count; ++i) {
    for (int k = 0; k < 2; ++k) {
      low[k] = fminf(low[k], pulls[i].min[k]);
      high[k] = fmaxf(high[k], pulls[i].max[k]);
    }
  }
  for (size_t i = 0; i < all; ++i) marks[i] = isnan(nodes->height[i]) ? DRY : WET;
  const Patch patch = patch_around(nodes, low, high, reach_of(&pulling), INFINITY);
  const Patch near = pull_nodes(&pulling, &patch, marks);
  // Water is as far as `full` away at most: what stands on dry ground stays dry.
  const int32_t passes = (int32_t)fminf(fmaxf(full, fill) / nodes->spacing + 2, 1000);
  for (int32_t i = 0; i < passes && spread(nodes, &near, marks); ++i) {
  }
  for (int32_t k = near.begin[1]; k < near.end[1]; ++k) {
    for (int32_t i = near.begin[0]; i < near.end[0]; ++i) {
      const size_t node = node_index(nodes, i, k);
      if (marks[node] == DRY_BUT_NEAR) nodes->height[node] = NAN;
    }
  }
}
