#include "render/water_objects.h"

#include "render/picture.h"
#include "render/water_planes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_NODES (1 << 24) // of a height field
#define MOST_BODIES 1024     // that can be objects; what a frame has beyond belongs to the surroundings

// What the search works on. Solids are those that may be objects, with the obstacles they come from.
typedef struct Search {
  RenderWaterObjects *found;
  const SimFrame *frame;
  const float *eye;
  const RenderHeightfield *settings;
  float index;
  float spacing; // m, of the particles, but at least the field's
  RenderWaterNodes nodes;
  int32_t first[RENDER_MAX_WATER_OBJECTS + 1]; // the solids of an object: first[i] … first[i + 1] − 1
} Search;

// ---- Small vectors ---------------------------------------------------------------------------------------------------

static float dot(const float a[3], const float b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static float height_over(const float plane[4], const float p[3]) {
  return dot(plane, p) + plane[3];
}

// a + s·b
static void along(const float a[3], float s, const float b[3], float out[3]) {
  for (int k = 0; k < 3; ++k) out[k] = a[k] + s * b[k];
}

static void foot_of(const float plane[4], const float p[3], float foot[3]) {
  along(p, -height_over(plane, p), plane, foot);
}

static float distance_between(const float a[3], const float b[3]) {
  const float d[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return sqrtf(dot(d, d));
}

// ---- From the frame --------------------------------------------------------------------------------------------------

bool render_field_is_sensible(const SimHeightField *f) {
  return f->height != NULL && f->size[0] > 0 && f->size[1] > 0 && (int64_t)f->size[0] * f->size[1] <= MOST_NODES &&
         f->spacing > 1e-6f && f->spacing < RENDER_FARTHEST && fabsf(f->origin[0]) < RENDER_FARTHEST &&
         fabsf(f->origin[1]) < RENDER_FARTHEST;
}

static bool grow(void **array, size_t count, size_t size) {
  void *grown = realloc(*array, count * size);
  if (grown != NULL) *array = grown;
  return grown != NULL;
}

static bool make_room(RenderWaterObjects *found, const SimFrame *frame, RenderError *error) {
  const SimHeightField *f = &frame->height_field;
  const size_t obstacles = frame->obstacle_count > 0 ? (size_t)frame->obstacle_count : 0;
  const size_t nodes = render_field_is_sensible(f) ? (size_t)f->size[0] * (size_t)f->size[1] : 0;
  if (obstacles > found->capacity) {
    if (!grow((void **)&found->of_obstacle, obstacles, sizeof *found->of_obstacle) ||
        !grow((void **)&found->solids, 2 * obstacles, sizeof *found->solids) ||
        !grow((void **)&found->levels, obstacles, sizeof *found->levels) ||
        !grow((void **)&found->parents, obstacles, sizeof *found->parents)) {
      return gpu_fail(error, "out of memory for %zu obstacles", obstacles);
    }
    found->capacity = obstacles;
  }
  if (nodes > found->heights_capacity) {
    if (!grow((void **)&found->heights, nodes, sizeof *found->heights) ||
        !grow((void **)&found->marks, nodes, sizeof *found->marks)) {
      return gpu_fail(error, "out of memory for a height field of %zu nodes", nodes);
    }
    found->heights_capacity = nodes;
  }
  return true;
}

void render_water_objects_destroy(RenderWaterObjects *found) {
  free(found->of_obstacle);
  free(found->solids);
  free(found->levels);
  free(found->parents);
  free(found->heights);
  free(found->marks);
  *found = (RenderWaterObjects){0};
}

// A node that has no water is at the lowest y of the frame's bounds, see sim/frame.h.
static void take_heights(Search *s) {
  const SimHeightField *f = &s->frame->height_field;
  const float bottom = s->frame->bounds_min[1];
  const float lowest = fabsf(bottom) < RENDER_FARTHEST ? bottom : -RENDER_FARTHEST;
  s->nodes = (RenderWaterNodes){.height = s->found->heights, .spacing = 1, .mean = fmaxf(lowest, -RENDER_FARTHEST)};
  s->found->field = (SimHeightField){0};
  if (!render_field_is_sensible(f)) return;
  s->found->field = *f;
  s->found->field.height = s->found->heights;
  s->nodes.spacing = f->spacing;
  memcpy(s->nodes.size, f->size, sizeof f->size);
  memcpy(s->nodes.origin, f->origin, sizeof f->origin);
  const size_t count = (size_t)f->size[0] * (size_t)f->size[1];
  double sum = 0;
  size_t wet = 0;
  for (size_t i = 0; i < count; ++i) {
    const float height = f->height[i];
    const bool water = height > lowest && height < RENDER_FARTHEST;
    s->nodes.height[i] = water ? height : NAN;
    if (!water) continue;
    sum += (double)height;
    ++wet;
  }
  s->nodes.wet = wet > 0;
  if (wet > 0) s->nodes.mean = (float)(sum / (double)wet);
}

static float spacing_of(const Search *s) {
  const float particles = 2 * s->frame->particle_radius;
  const float field = s->nodes.size[0] > 0 ? s->nodes.spacing : 1e-3f;
  return particles > field && particles < RENDER_FARTHEST ? particles : field;
}

// Beside the container, or so large that it lies under or over all of it.
static bool in_surroundings(const Search *s, const RenderSolid *solid) {
  const SimContainer *c = &s->frame->container;
  if (!s->frame->has_container || !(c->min[0] < c->max[0]) || !(c->min[2] < c->max[2])) return false;
  bool covers = true;
  for (int k = 0; k < 3; k += 2) {
    if (solid->max[k] < c->min[k] + s->spacing || solid->min[k] > c->max[k] - s->spacing) return true;
    covers = covers && solid->min[k] <= c->min[k] && solid->max[k] >= c->max[k];
  }
  return covers;
}

// Output: solids in the obstacles' order, and for each obstacle the index of its solid.
static int32_t take_obstacles(Search *s) {
  int32_t count = 0;
  for (int32_t i = 0; i < s->frame->obstacle_count; ++i) {
    RenderSolid *solid = &s->found->solids[count];
    const bool taken = s->frame->obstacles != NULL && count < MOST_BODIES &&
                       render_solid_take(solid, &s->frame->obstacles[i]) && !in_surroundings(s, solid);
    s->found->of_obstacle[i] = taken ? count : -1;
    count += taken;
  }
  return count;
}

// ---- Groups ----------------------------------------------------------------------------------------------------------

static int32_t root_of(int32_t *parents, int32_t i) {
  while (parents[i] != i) i = parents[i] = parents[parents[i]];
  return i;
}

static float gap_between(const RenderSolid *a, const RenderSolid *b) {
  const float x = fmaxf(a->min[0] - b->max[0], b->min[0] - a->max[0]);
  const float z = fmaxf(a->min[2] - b->max[2], b->min[2] - a->max[2]);
  return hypotf(fmaxf(x, 0), fmaxf(z, 0));
}

// Do both stand in the water's surface at some height? A table's top over its legs does not.
static bool share_surface(const Search *s, int32_t i, int32_t j) {
  const RenderSolid *a = &s->found->solids[i], *b = &s->found->solids[j];
  const float *levels = s->found->levels, near = 2 * s->spacing;
  const float low = fmaxf(fmaxf(a->min[1], b->min[1]), fminf(levels[i], levels[j]) - near);
  const float high = fminf(fminf(a->max[1], b->max[1]), fmaxf(levels[i], levels[j]) + near);
  return high - low > 0.01f * s->spacing;
}

// Unite what is closer than this. Returns how many groups that leaves of so many before.
static int32_t unite(Search *s, int32_t count, int32_t groups, float distance, bool in_surface) {
  const RenderSolid *solids = s->found->solids;
  int32_t *parents = s->found->parents;
  for (int32_t i = 0; i < count; ++i) {
    for (int32_t j = i + 1; j < count; ++j) {
      if (!(gap_between(&solids[i], &solids[j]) < distance) || (in_surface && !share_surface(s, i, j))) continue;
      const int32_t a = root_of(parents, i), b = root_of(parents, j);
      parents[a < b ? b : a] = a < b ? a : b;
      groups -= a != b;
    }
  }
  return groups;
}

// Output: the parents of the solids; a root comes before all of its group.
static void group(Search *s, int32_t count) {
  const RenderHeightfield *settings = s->settings;
  for (int32_t i = 0; i < count; ++i) {
    const RenderSolid *solid = &s->found->solids[i];
    s->found->levels[i] = render_water_level(&s->nodes, solid->min, solid->max, settings->plane_reach * s->spacing);
    s->found->parents[i] = i;
  }
  float distance = settings->group_distance * s->spacing;
  int32_t groups = unite(s, count, count, distance, true);
  for (bool in_surface = true; groups > RENDER_MAX_WATER_OBJECTS;) {
    distance = fmaxf(2 * distance, s->spacing);
    groups = unite(s, count, groups, distance, in_surface);
    if (distance < 4 * RENDER_FARTHEST || !in_surface) continue;
    // What is far under or over the water is left, more of it than can be.
    in_surface = false;
    distance = 0;
  }
}

// Number the groups, sort the solids by them. Output: object count, of_obstacle, first.
static void sort_solids(Search *s, int32_t count) {
  RenderWaterObjects *found = s->found;
  int32_t next[RENDER_MAX_WATER_OBJECTS + 1] = {0};
  for (int32_t i = 0; i < count; ++i) {
    // From here on the parent is the number of the group.
    const int32_t root = found->parents[i];
    found->parents[i] = root == i ? found->count++ : found->parents[root];
    ++next[found->parents[i] + 1];
  }
  for (int32_t i = 0; i < found->count; ++i) next[i + 1] += next[i];
  memcpy(s->first, next, sizeof s->first);
  const RenderSolid *unsorted = found->solids + found->capacity;
  if (count > 0) memcpy(found->solids + found->capacity, found->solids, sizeof *found->solids * (size_t)count);
  for (int32_t i = 0; i < count; ++i) found->solids[next[found->parents[i]]++] = unsorted[i];
  for (int32_t i = 0; i < s->frame->obstacle_count; ++i) {
    if (found->of_obstacle[i] >= 0) found->of_obstacle[i] = found->parents[found->of_obstacle[i]];
  }
}

// ---- An object -------------------------------------------------------------------------------------------------------

// Lowest and highest point over the plane.
static void heights_of(const RenderSolid *solid, const float plane[4], float *low, float *high) {
  const float middle = height_over(plane, solid->centre), extent = render_solid_extent(solid, plane);
  *low = middle - extent;
  *high = middle + extent;
}

static bool solid_crosses(const RenderSolid *solid, const float plane[4]) {
  float low, high;
  heights_of(solid, plane, &low, &high);
  return low < 0 && high > 0;
}

// The ends of a body's own axis that is nearest to upright, the lower one first.
static void axis_of_solid(const RenderSolid *solid, float axis[2][3]) {
  int up = 1;
  for (int k = 0; k < 3; k += 2) {
    if (fabsf(solid->axis[k][1]) > fabsf(solid->axis[up][1]) + 1e-4f) up = k;
  }
  const float half = copysignf(solid->half[up], solid->axis[up][1]);
  along(solid->centre, -half, solid->axis[up], axis[0]);
  along(solid->centre, half, solid->axis[up], axis[1]);
}

// Output: centre, reach and main axis.
static void measure(RenderWaterObject *object, const RenderSolid *solids, int32_t count) {
  float min[3], max[3];
  render_solids_bounds(solids, count, min, max);
  for (int k = 0; k < 3; ++k) {
    object->centre[k] = (min[k] + max[k]) / 2;
    object->axis[0][k] = k == 1 ? min[k] : object->centre[k];
    object->axis[1][k] = k == 1 ? max[k] : object->centre[k];
  }
  object->reach = distance_between(min, max) / 2;
  if (count == 1) axis_of_solid(solids, object->axis);
}

// Where the main axis meets the plane, or the foot of the end that comes nearest to it.
static void cut_of_axis(const float bottom[3], const float top[3], const float plane[4], float cut[3]) {
  const float low = height_over(plane, bottom), high = height_over(plane, top);
  const bool meets = low < 0 && high > 0;
  const float share = meets ? -low / (high - low) : fabsf(low) < fabsf(high) ? 0 : 1;
  for (int k = 0; k < 3; ++k) cut[k] = bottom[k] + share * (top[k] - bottom[k]);
  foot_of(plane, cut, cut);
}

// The first point of the solid on the way from `from` to `to`: as far as it is away, nothing can be missed.
static void first_point(const RenderSolid *solid, const float from[3], const float to[3], float point[3]) {
  const float length = distance_between(from, to);
  float way = 0;
  for (int i = 0; i < 64; ++i) {
    const float share = way < length ? way / length : 1;
    for (int k = 0; k < 3; ++k) point[k] = from[k] + share * (to[k] - from[k]);
    const float distance = render_solid_distance(solid, point);
    if (distance < 1e-6f * (1 + length) || share == 1) return;
    way += distance;
  }
}

// a of the paper: on the line in the plane from the eye's foot to where the main axis meets it. Of several bodies, that of the
// nearest.
static void find_a(RenderWaterObject *object, const RenderSolid *solids, int32_t count, const float eye[3]) {
  float foot[3], nearest = INFINITY;
  foot_of(object->plane, eye, foot);
  for (int32_t i = 0; i < count; ++i) {
    float axis[2][3], cut[3], a[3];
    if (!solid_crosses(&solids[i], object->plane)) continue;
    axis_of_solid(&solids[i], axis);
    cut_of_axis(axis[0], axis[1], object->plane, cut);
    first_point(&solids[i], foot, cut, a);
    const float distance = distance_between(eye, a);
    if (!(distance < nearest)) continue;
    nearest = distance;
    memcpy(object->a, a, sizeof a);
  }
}

// Eqs. 2 and 3: back from a along the ray that the water refracts there, as far as the eye is away.
static void refracted_eye(const float plane[4], const float eye[3], const float a[3], float index, float out[3]) {
  const float distance = distance_between(eye, a);
  memcpy(out, eye, 3 * sizeof *out);
  if (!(height_over(plane, eye) > 0) || !(distance > 0)) return;
  const float eta = 1 / index;
  float in[3];
  for (int k = 0; k < 3; ++k) in[k] = (a[k] - eye[k]) / distance;
  const float cosine = dot(in, plane), k = 1 - eta * eta * (1 - cosine * cosine);
  for (int c = 0; c < 3; ++c) {
    const float refracted = eta * in[c] - (eta * cosine + sqrtf(fmaxf(k, 0))) * plane[c];
    out[c] = a[c] - distance * refracted;
  }
}

// Where the straight line between the two meets the plane, if they lie on either side of it.
static void straight_point(const float plane[4], const float above[3], const float below[3], float point[3]) {
  const float high = height_over(plane, above), low = height_over(plane, below);
  const float share = high > 0 && low < 0 ? high / (high - low) : 1;
  for (int k = 0; k < 3; ++k) point[k] = above[k] + share * (below[k] - above[k]);
  foot_of(plane, point, point);
}

// Points of the solid's cross-section with the plane, or their feet on it: of the edges of the box along its own axes.
typedef struct Outline {
  float points[12][3]; // m
  int count;
} Outline;

static Outline outline_of(const RenderSolid *solid, const float plane[4]) {
  float corners[8][3], heights[8];
  for (int c = 0; c < 8; ++c) {
    memcpy(corners[c], solid->centre, sizeof corners[c]);
    for (int k = 0; k < 3; ++k) {
      along(corners[c], c >> k & 1 ? solid->half[k] : -solid->half[k], solid->axis[k], corners[c]);
    }
    heights[c] = height_over(plane, corners[c]);
  }
  Outline outline = {.count = 0};
  for (int c = 0; c < 8; ++c) {
    for (int k = 0; k < 3; ++k) {
      const int other = c | 1 << k;
      if (other == c || (heights[c] < 0) == (heights[other] < 0)) continue;
      const float share = heights[c] / (heights[c] - heights[other]);
      float *point = outline.points[outline.count++];
      for (int i = 0; i < 3; ++i) point[i] = corners[c][i] + share * (corners[other][i] - corners[c][i]);
    }
  }
  for (int c = 0; c < 8 && outline.count < 8 && !solid_crosses(solid, plane); ++c) {
    foot_of(plane, corners[c], outline.points[outline.count++]);
  }
  return outline;
}

typedef struct Circle {
  float middle[3], radius; // m
} Circle;

// A circle around the cross-section of the solid, or around itself as seen along the normal.
static Circle circle_of(const RenderSolid *solid, const float plane[4]) {
  Circle circle = {.radius = 0};
  const float height = height_over(plane, solid->centre), half = solid->half[0];
  const float upright = fabsf(dot(solid->axis[1], plane)), straight = solid->half[1] - half;
  foot_of(plane, solid->centre, circle.middle);
  if (solid->shape == SIM_SPHERE) {
    circle.radius = fabsf(height) < half ? sqrtf(half * half - height * height) : half;
    return circle;
  }
  // An upright enough round body is cut through its straight part.
  const float length = solid->shape == SIM_CYLINDER ? solid->half[1] : solid->shape == SIM_CAPSULE ? straight : 0;
  if (upright > 0.7f && fabsf(height) < upright * length - half) {
    along(solid->centre, -height / dot(solid->axis[1], plane), solid->axis[1], circle.middle);
    circle.radius = half / upright;
    return circle;
  }
  const Outline outline = outline_of(solid, plane);
  for (int i = 0; i < outline.count; ++i) {
    for (int k = 0; k < 3; ++k)
      circle.middle[k] = (i > 0 ? circle.middle[k] : 0) + outline.points[i][k] / (float)outline.count;
  }
  for (int i = 0; i < outline.count; ++i) {
    circle.radius = fmaxf(circle.radius, distance_between(circle.middle, outline.points[i]));
  }
  return circle;
}

// A circle that holds both.
static Circle circle_around(Circle a, Circle b) {
  const float apart = distance_between(a.middle, b.middle);
  if (apart + b.radius <= a.radius) return a;
  if (apart + a.radius <= b.radius) return b;
  Circle both = {.radius = (apart + a.radius + b.radius) / 2};
  const float share = (both.radius - a.radius) / apart;
  for (int k = 0; k < 3; ++k) both.middle[k] = a.middle[k] + share * (b.middle[k] - a.middle[k]);
  return both;
}

// Output: half_width and middle. Of an object that stands in the surface, only what of it does.
static void find_width(RenderWaterObject *object, const RenderSolid *solids, int32_t count) {
  Circle all = {.radius = -1};
  for (int32_t i = 0; i < count; ++i) {
    if (object->crosses && !solid_crosses(&solids[i], object->plane)) continue;
    const Circle circle = circle_of(&solids[i], object->plane);
    all = all.radius < 0 ? circle : circle_around(all, circle);
  }
  object->half_width = all.radius;
  memcpy(object->middle, all.middle, sizeof all.middle);
}

// Output: a, b, the eyes and where they show b.
static void find_points(RenderWaterObject *object, const RenderSolid *solids, int32_t count, const float eye[3],
                        float index) {
  const float *plane = object->plane;
  memcpy(object->b, object->axis[0], sizeof object->b);
  if (height_over(plane, object->b) > 0) foot_of(plane, object->b, object->b);
  if (object->crosses) {
    find_a(object, solids, count, eye);
  } else {
    float top[3];
    memcpy(top, object->axis[1], sizeof top);
    if (height_over(plane, top) > 0) memcpy(top, object->b, sizeof top);
    render_refraction_point(plane, eye, top, index, object->a);
  }
  along(eye, -2 * height_over(plane, eye), plane, object->eye_reflected); // Eq. 1
  refracted_eye(plane, eye, object->a, index, object->eye_refracted);
  render_refraction_point(plane, eye, object->b, index, object->seen_b);
  straight_point(plane, object->eye_refracted, object->b, object->unscaled_b);
}

static void find_object(Search *s, int32_t i) {
  RenderWaterObject *object = &s->found->objects[i];
  const RenderSolid *solids = s->found->solids + s->first[i];
  const int32_t count = s->first[i + 1] - s->first[i];
  *object = (RenderWaterObject){.crosses = false};
  // Heights within a spacing of a solid lack the particles that would be in it.
  render_water_plane_fit(&s->nodes, solids, count, s->spacing, s->settings->plane_reach * s->spacing, object->plane);
  for (int32_t k = 0; k < count && s->nodes.wet; ++k) {
    object->crosses = object->crosses || solid_crosses(&solids[k], object->plane);
  }
  measure(object, solids, count);
  find_points(object, solids, count, s->eye, s->index);
  find_width(object, solids, count);
}

// ---- All of them -----------------------------------------------------------------------------------------------------

static void pull_heights(const Search *s) {
  RenderWaterPull pulls[RENDER_MAX_WATER_OBJECTS];
  int32_t count = 0;
  for (int32_t i = 0; i < s->found->count; ++i) {
    const RenderWaterObject *object = &s->found->objects[i];
    if (!object->crosses) continue;
    RenderWaterPull *pull = &pulls[count++];
    *pull = (RenderWaterPull){.solids = s->found->solids + s->first[i], .count = s->first[i + 1] - s->first[i]};
    memcpy(pull->plane, object->plane, sizeof pull->plane);
    float min[3], max[3];
    render_solids_bounds(pull->solids, pull->count, min, max);
    for (int k = 0; k < 2; ++k) {
      pull->min[k] = min[2 * k];
      pull->max[k] = max[2 * k];
    }
  }
  // So far that smoothing later leaves the plane as it is beside the solids.
  const float full = (2 * s->settings->smoothing + 1.5f) * s->spacing;
  render_water_pull(&s->nodes, pulls, count, full, s->settings->pull_reach * s->spacing, 0.5f * s->spacing,
                    s->found->marks);
}

static bool in_solid(const Search *s, int32_t i, int32_t k) {
  const RenderWaterNodes *n = &s->nodes;
  const float point[3] = {n->origin[0] + n->spacing * (float)i, n->height[(size_t)k * (size_t)n->size[0] + (size_t)i],
                          n->origin[1] + n->spacing * (float)k};
  for (int32_t o = 0; o < s->found->count; ++o) {
    for (int32_t b = s->first[o]; b < s->first[o + 1] && s->found->objects[o].crosses; ++b) {
      if (render_solid_distance(&s->found->solids[b], point) < 0.05f * s->spacing) return true;
    }
  }
  return false;
}

// Does the water in a solid end here? Beside it is dry ground, and no water that is in none.
static bool ends_in_solid(const Search *s, int32_t i, int32_t k) {
  const RenderWaterNodes *n = &s->nodes;
  bool dry = false;
  for (int pass = 0; pass < 2; ++pass) {
    for (int32_t z = k > 0 ? k - 1 : 0; z <= k + 1 && z < n->size[1]; ++z) {
      for (int32_t x = i > 0 ? i - 1 : 0; x <= i + 1 && x < n->size[0]; ++x) {
        const bool wet = !isnan(n->height[(size_t)z * (size_t)n->size[0] + (size_t)x]);
        dry = dry || !wet;
        if (pass == 1 && wet && !in_solid(s, x, z)) return false;
      }
    }
    if (!dry) return false; // the common case, and cheap
  }
  return in_solid(s, i, k);
}

// The surface goes on through solids; behind one that has dry ground there, as behind a paddle that has left the wall, it would
// come out again as a cliff. So it ends inside.
static void leave_dry_sides(Search *s) {
  const RenderWaterNodes *n = &s->nodes;
  if (s->found->count == 0 || !n->wet) return;
  const int32_t all = n->size[0] * n->size[1];
  for (int32_t node = 0; node < all; ++node) {
    s->found->marks[node] = !isnan(n->height[node]) && ends_in_solid(s, node % n->size[0], node / n->size[0]);
  }
  for (int32_t node = 0; node < all; ++node) {
    if (s->found->marks[node]) n->height[node] = NAN;
  }
}

bool render_water_objects_find(RenderWaterObjects *found, const SimFrame *frame, const float eye[3],
                               const RenderHeightfield *settings, float index, RenderError *error) {
  found->count = 0;
  if (!make_room(found, frame, error)) return false;
  Search search = {.found = found, .frame = frame, .eye = eye, .settings = settings, .index = index >= 1 ? index : 1};
  take_heights(&search);
  search.spacing = spacing_of(&search);
  const int32_t count = take_obstacles(&search);
  group(&search, count);
  sort_solids(&search, count);
  for (int32_t i = 0; i < found->count; ++i) find_object(&search, i);
  pull_heights(&search);
  leave_dry_sides(&search);
  return true;
}

float render_obstacle_distance(const SimObstacle *obstacle, const float point[3]) {
  RenderSolid solid;
  return render_solid_take(&solid, obstacle) ? render_solid_distance(&solid, point) : INFINITY;
}
