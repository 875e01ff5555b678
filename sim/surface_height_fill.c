// A height field where obstacles stand in the water: it goes on through them, level with the water around, and nowhere beside
// them is there a hole or a dip because particles keep away.
//
// Most nodes are known: no obstacle is near, or the water's surface there is none of its business (it lies on the ground, or
// hangs above). The others are filled from the known ones inwards, a ring at a time, so that what comes from two sides of an
// obstacle meets inside it, and no side sees the other one. A node's candidate is the mean of its known neighbours that have
// water, if these are at least half of the known ones. It is taken where it is higher than what particles say and where an
// obstacle is in the way at that height; otherwise particles are right. So water that runs up an obstacle stays as it is.
#include <math.h>

#include "sim/surface.h"

typedef enum NodeState { KNOWN = 0, UNKNOWN = 1, QUEUED = 2, BEYOND = 3 } NodeState; // BEYOND: outside a glass

/// A normal that is steeper than this, by its y, is the top or the bottom of an obstacle.
#define STEEP 0.7f

typedef struct Fill {
  const SimHeightContext *context;
  uint8_t *state; ///< NodeState, a node
  float reach;    ///< m, how far from an obstacle particles may be missing
} Fill;

// The nodes whose columns are in reach of a body: from `first` to `last` along x and z.
static bool footprint(const Fill *fill, const float low[3], const float high[3], int32_t first[2], int32_t last[2]) {
  const SimHeightField *f = fill->context->field;
  for (int k = 0; k < 2; k++) {
    double from = ((double)low[2 * k] - (double)fill->reach - (double)f->origin[k]) / (double)f->spacing;
    double to = ((double)high[2 * k] + (double)fill->reach - (double)f->origin[k]) / (double)f->spacing;
    first[k] = (int32_t)fmax(ceil(from), 0);
    last[k] = (int32_t)fmin(floor(to), f->size[k] - 1);
    if (!(fmax(ceil(from), 0) <= fmin(floor(to), f->size[k] - 1))) return false;
  }
  return true;
}

static void place_of(const Fill *fill, int32_t node, float height, float point[3]) {
  const SimHeightField *f = fill->context->field;
  point[0] = f->origin[0] + f->spacing * (float)(node % f->size[0]);
  point[1] = height;
  point[2] = f->origin[1] + f->spacing * (float)(node / f->size[0]);
}

// Whether the vertical line through a node comes nearer to a body than `near` between two heights; steps are as long as the
// distance allows.
static bool comes_near(const Fill *fill, const SimBody *body, int32_t node, float low, float high, float near) {
  float point[3], normal[3], least = 0.25f * fill->context->surface->spacing;
  place_of(fill, node, low, point);
  while (point[1] <= high) {
    float distance = sim_body_distance(body, point, normal) - near;
    if (distance < 0) return true;
    point[1] += fmaxf(distance, least);
  }
  return false;
}

static bool meets(const Fill *fill, const SimBody *body, int32_t node, float low, float high) {
  return comes_near(fill, body, node, low, high, 0);
}

// Whether a body stands in the topmost layer of water of this height, or beside it.
static bool in_the_way(const Fill *fill, const SimBody *body, int32_t node, float height) {
  float point[3], normal[3];
  place_of(fill, node, height - 0.5f * fill->context->surface->spacing, point);
  float distance = sim_body_distance(body, point, normal);
  return distance < 0 || (distance < fill->reach && fabsf(normal[1]) < STEEP);
}

// Whether a body hides water of this height from where it is by particles: it is in the way or lies between.
static bool hidden(const Fill *fill, int32_t node, float height, float own) {
  const SimSurface *surface = fill->context->surface;
  for (int32_t b = 0; b < surface->body_count; b++) {
    const SimBody *body = &surface->bodies[b];
    float point[3], d2 = 0, reach = body->bound + fill->reach + surface->spacing;
    place_of(fill, node, height, point);
    for (int k = 0; k < 3; k++) d2 += (point[k] - body->position[k]) * (point[k] - body->position[k]);
    if (d2 < reach * reach && (in_the_way(fill, body, node, height) || meets(fill, body, node, own, height)))
      return true;
  }
  return false;
}

// Mark what this body makes unknown: dry nodes in it, or so close that no particle has room there (farther off, ground behind a
// paddle that has left it is dry and stays so), nodes under it, where what was found may be the
// upper end of the water below a floating body, and those where it is in the way.
static void mark(Fill *fill, const SimBody *body) {
  const SimHeightContext *c = fill->context;
  float low[3], high[3];
  int32_t first[2], last[2];
  sim_body_box(body, low, high);
  if (!footprint(fill, low, high, first, last)) return;
  for (int32_t k = first[1]; k <= last[1]; k++)
    for (int32_t i = first[0]; i <= last[0]; i++) {
      int32_t node = k * c->field->size[0] + i;
      float height = c->height[node], point[3];
      place_of(fill, node, height, point);
      if (fill->state[node] != KNOWN) continue;
      bool under = point[0] > low[0] && point[0] < high[0] && point[2] > low[2] && point[2] < high[2];
      bool dry = height <= c->floor,
           beside = dry && comes_near(fill, body, node, low[1], high[1], 0.5f * c->surface->spacing);
      if (beside || (!dry && under && meets(fill, body, node, fmaxf(height, low[1]), high[1])) ||
          (!dry && in_the_way(fill, body, node, height)))
        fill->state[node] = UNKNOWN;
    }
}

// Go over the neighbours of a node that are in the field.
static int neighbours_of(const SimHeightField *f, int32_t node, int32_t neighbour[8]) {
  int32_t i = node % f->size[0], k = node / f->size[0];
  int count = 0;
  for (int32_t z = k > 0 ? k - 1 : 0; z <= k + 1 && z < f->size[1]; z++)
    for (int32_t x = i > 0 ? i - 1 : 0; x <= i + 1 && x < f->size[0]; x++)
      if (x != i || z != k) neighbour[count++] = z * f->size[0] + x;
  return count;
}

// What the node's height is, by its known neighbours and by its particles.
static float filled(const Fill *fill, int32_t node) {
  const SimHeightContext *c = fill->context;
  int32_t neighbour[8];
  int count = neighbours_of(c->field, node, neighbour), wet = 0, dry = 0;
  float sum = 0, own = c->height[node];
  for (int n = 0; n < count; n++) {
    float height = c->height[neighbour[n]];
    if (fill->state[neighbour[n]] != KNOWN) continue;
    if (height > c->floor) sum += height;
    wet += height > c->floor, dry += !(height > c->floor);
  }
  if (wet == 0 || wet < dry) return own;
  float candidate = sum / (float)wet;
  return candidate > own && hidden(fill, node, candidate, own) ? candidate : own;
}

// Queue the unknown neighbours of a node, in the order of the nodes.
static int32_t enqueue(Fill *fill, int32_t node, int32_t *queue, int32_t end) {
  int32_t neighbour[8];
  int count = neighbours_of(fill->context->field, node, neighbour);
  for (int n = 0; n < count; n++)
    if (fill->state[neighbour[n]] == UNKNOWN) {
      fill->state[neighbour[n]] = QUEUED;
      queue[end++] = neighbour[n];
    }
  return end;
}

// The first ring: unknown nodes beside known ones.
static int32_t first_ring(Fill *fill, int32_t *queue) {
  const SimHeightField *f = fill->context->field;
  int32_t end = 0;
  for (int32_t node = 0; node < f->size[0] * f->size[1]; node++) {
    int32_t neighbour[8];
    int count = fill->state[node] == UNKNOWN ? neighbours_of(f, node, neighbour) : 0;
    bool beside = false;
    for (int n = 0; n < count; n++) beside = beside || fill->state[neighbour[n]] == KNOWN;
    if (!beside) continue;
    fill->state[node] = QUEUED;
    queue[end++] = node;
  }
  return end;
}

// Water that an obstacle hides has no air below it that anybody knows of.
static void fill_node(const Fill *fill, int32_t node) {
  const SimHeightContext *c = fill->context;
  float height = filled(fill, node);
  if (c->underside && height > c->height[node]) c->underside[node] = c->second[node] = c->floor;
  c->height[node] = height;
}

void sim_surface_height_fill(const SimHeightContext *context, const SimHeightArrays *arrays) {
  const SimSurface *surface = context->surface;
  const SimHeightField *f = context->field;
  Fill fill = {context, arrays->state, context->radius};
  for (int32_t node = 0; node < f->size[0] * f->size[1]; node++) {
    float point[3];
    place_of(&fill, node, 0, point);
    fill.state[node] = sim_height_beyond(context, point[0], point[2]) ? BEYOND : KNOWN;
  }
  for (int32_t b = 0; b < surface->body_count; b++) mark(&fill, &surface->bodies[b]);
  int32_t *queue = arrays->queue, begin = 0, end = first_ring(&fill, queue);
  while (begin < end) {
    // A ring reads only what was known before it, and is known when all of it is filled.
    int32_t ring = end;
    for (int32_t n = begin; n < ring; n++) fill_node(&fill, queue[n]);
    for (int32_t n = begin; n < ring; n++) fill.state[queue[n]] = KNOWN;
    for (; begin < ring; begin++) end = enqueue(&fill, queue[begin], queue, end);
  }
}
