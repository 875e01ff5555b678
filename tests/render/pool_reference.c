#include "tests/render/pool_reference.h"

#include <math.h>
#include <stdlib.h>

#include "tests/reference/solids.h"

// ---- Rays ------------------------------------------------------------------------------------------------------------

static bool over_water(const SimContainer *c, Vec p) {
  return p.x > (double)c->min[0] && p.x < (double)c->max[0] && p.z > (double)c->min[2] && p.z < (double)c->max[2];
}

// Snell's law at a level surface, from above.
static Vec bend(Vec unit, double index) {
  const Vec along = {unit.x / index, 0, unit.z / index};
  return (Vec){along.x, -sqrt(1 - vec_dot(along, along)), along.z};
}

// The place in the picture of the one eye that the scaled one shows at p: it is stretched along the line through a and b.
static Vec unscale(const RenderWaterObject *object, Vec p) {
  const Vec a = vec_of(object->a), seen = vec_sub(vec_of(object->seen_b), a);
  const Vec way = vec_unit(seen), unscaled = vec_sub(vec_of(object->unscaled_b), a);
  const double stretched = vec_dot(vec_sub(p, a), way);
  return vec_along(p, stretched * (vec_dot(unscaled, way) / vec_length(seen) - 1), way);
}

static uint8_t look(const Pool *pool, const Solids *solids, Vec eye, Vec ray, PoolEyes eyes,
                    const RenderWaterObject *object) {
  double t_solid;
  Vec normal;
  const bool direct = solids_meet(solids, eye, ray, &t_solid, &normal) != NULL;
  const double t_water = (pool->level - eye.y) / ray.y;
  const Vec point = vec_along(eye, t_water, ray);
  if (!(t_water > 0) || !over_water(&pool->frame->container, point) || (direct && t_solid < t_water)) {
    return direct ? POOL_DIRECT : POOL_OTHER;
  }
  Vec start = point, way;
  if (eyes == POOL_TRACED) {
    way = bend(ray, pool->index);
  } else {
    start = eyes == POOL_SCALED ? unscale(object, point) : point;
    way = vec_unit(vec_sub(start, vec_of(object->eye_refracted)));
  }
  // A ray that starts inside of a body meets it at once: the body's part above the water is in its way.
  Vec outward;
  if (solids_distance(solids, start, &outward) < 0) return POOL_THROUGH_WATER;
  return solids_meet(solids, start, way, &t_solid, &normal) != NULL ? POOL_THROUGH_WATER : POOL_OTHER;
}

void pool_look(const Pool *pool, const RenderView *view, int32_t width, int32_t height, PoolEyes eyes,
               const RenderWaterObject *object, uint8_t *seen) {
  Solids solids = solids_create(pool->frame);
  for (int32_t y = 0; y < height; ++y) {
    for (int32_t x = 0; x < width; ++x) {
      const Ray ray = harness_ray(view, width, height, x, y);
      const Vec eye = {ray.origin[0], ray.origin[1], ray.origin[2]};
      const Vec way = vec_unit((Vec){ray.direction[0], ray.direction[1], ray.direction[2]});
      seen[(size_t)y * (size_t)width + (size_t)x] = look(pool, &solids, eye, way, eyes, object);
    }
  }
  solids_destroy(&solids);
}

// ---- Outlines --------------------------------------------------------------------------------------------------------

static void add_side(PoolOutline *outline, uint8_t a, uint8_t b, PoolSide side) {
  if ((a == POOL_OTHER) == (b == POOL_OTHER)) return;
  side.through = a == POOL_THROUGH_WATER || b == POOL_THROUGH_WATER;
  outline->side[outline->count++] = side;
}

PoolOutline pool_outline(const uint8_t *seen, int32_t width, int32_t height) {
  PoolOutline outline = {malloc(sizeof(PoolSide) * 2 * (size_t)width * (size_t)height), 0};
  assert_non_null(outline.side);
  for (int32_t y = 0; y < height; ++y) {
    for (int32_t x = 0; x < width; ++x) {
      const uint8_t *s = &seen[(size_t)y * (size_t)width + (size_t)x];
      if (x + 1 < width) add_side(&outline, s[0], s[1], (PoolSide){(float)x + 1, (float)y + 0.5f, true, false});
      if (y + 1 < height) add_side(&outline, s[0], s[width], (PoolSide){(float)x + 0.5f, (float)y + 1, false, false});
    }
  }
  return outline;
}

void pool_outline_destroy(PoolOutline *outline) {
  free(outline->side);
  *outline = (PoolOutline){0};
}

static double distance_to_side(const PoolSide *p, const PoolSide *side) {
  const double x = fabs((double)(p->x - side->x)), y = fabs((double)(p->y - side->y));
  return side->upright ? hypot(x, fmax(y - 0.5, 0)) : hypot(fmax(x - 0.5, 0), y);
}

static double *distances(const PoolOutline *from, const PoolOutline *to, double *out) {
  for (int32_t i = 0; i < from->count; ++i) {
    if (!from->side[i].through) continue;
    double nearest = INFINITY;
    for (int32_t j = 0; j < to->count; ++j) nearest = fmin(nearest, distance_to_side(&from->side[i], &to->side[j]));
    *out++ = nearest;
  }
  return out;
}

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

PoolError pool_compare(const PoolOutline *a, const PoolOutline *b) {
  double *all = malloc(sizeof *all * ((size_t)a->count + (size_t)b->count + 1));
  assert_non_null(all);
  const size_t count = (size_t)(distances(b, a, distances(a, b, all)) - all);
  qsort(all, count, sizeof *all, ascending);
  const PoolError error = {count > 0 ? all[count - 1] : 0, count > 0 ? all[(count - 1) * 95 / 100] : 0};
  free(all);
  return error;
}
