// The clamp: where a particle that wants to go from one place to another ends, see boundary.h.
//
// 1. Into the container.
// 2. Along the path. In a body's own axes a particle goes from where it is in the body's old pose to where it wants to
//    be in the new one, in a straight line: then the body rests, and a fast particle and a fast paddle are the same
//    thing. On this line sphere tracing (Hart, Sphere Tracing, 1996) steps by the distance to the body, so that nothing
//    is jumped over; in a mesh the triangles themselves are asked. Where the line comes down to the body, what is left
//    of it goes on along the surface.
// 3. Out of bodies and walls by turns, until `clearance` is kept from all of them.
// 4. The place found must lie in no body, and the way to it must pass through none. Wedged between bodies and walls,
//    where no place keeps the clearance from all, another one is taken, in this order: one that touches, where it was,
//    where the body that came carries it. If all of them lie in a body (a paddle that presses against the wall), the
//    container wins.
//
// Nothing is searched for unless the end of the path is nearer to a body than the path is long, or than the clearance:
// for most particles one distance a body is all.
#include <math.h>
#include <string.h>

#include "sim/boundary.h"

// In clearances: a path that comes nearer than this has arrived at the body.
#define TOUCH 0.25f
// In clearances: the distance that is kept when there is no room for the clearance.
#define TIGHT 0.02f
// In clearances: shortest step of the tracing.
#define LEAST_STEP 0.0625f
#define MOST_STEPS 64
#define ROUNDS 8

typedef struct Move {
  const SimBoundary *boundary;
  const SimNear *near;
  const float *from; ///< m, where the particle was
  int32_t floating;  ///< the floating body that had a say, −1: none
} Move;

// A straight way in the axes of a body.
typedef struct Path {
  float from[3], way[3], to[3]; ///< way = to − from
  float length;
} Path;

static void set_path(Path *path, const float from[3], const float to[3]) {
  float d2 = 0;
  for (int k = 0; k < 3; k++) {
    path->from[k] = from[k];
    path->to[k] = to[k];
    path->way[k] = to[k] - from[k];
    d2 += path->way[k] * path->way[k];
  }
  path->length = sqrtf(d2);
}

static void path_in_body(const SimBody *body, const float from[3], const float to[3], Path *path) {
  const float *old = body->moves ? body->old_position : body->position;
  float a[3], b[3], local[2][3];
  for (int k = 0; k < 3; k++) a[k] = from[k] - old[k], b[k] = to[k] - body->position[k];
  sim_to_local(body->moves ? body->old_rotation : body->rotation, a, local[0]);
  sim_to_local(body->rotation, b, local[1]);
  set_path(path, local[0], local[1]);
}

// Whether the particle, seen from the body's centre, passes within reach of the ball around the body.
static bool passes_ball(const SimBody *body, const float from[3], const float to[3], float reach) {
  if (body->beyond) return false;
  const float *old = body->moves ? body->old_position : body->position;
  float a[3], d[3], along = 0, length2 = 0, distance2 = 0, r = body->bound + reach;
  for (int k = 0; k < 3; k++) {
    a[k] = from[k] - old[k];
    d[k] = to[k] - body->position[k] - a[k];
    along -= a[k] * d[k];
    length2 += d[k] * d[k];
  }
  float t = along <= 0 ? 0 : along >= length2 ? 1 : along / length2;
  for (int k = 0; k < 3; k++) distance2 += (a[k] + t * d[k]) * (a[k] + t * d[k]);
  return distance2 <= r * r;
}

static int32_t list_length(const Move *move) {
  return move->near && move->near->count >= 0 ? move->near->count : move->boundary->body_count;
}

static int32_t listed(const Move *move, int32_t n) {
  return move->near && move->near->count >= 0 ? move->near->body[n] : n;
}

// How much a distance may be too large: an interpolated one near an edge of a mesh.
static float distance_error(const SimBody *body) {
  return body->mesh ? 0.5f * body->mesh->cell : 0;
}

// ---- Along the path --------------------------------------------------------------------------------------------------

static bool trace(const SimBody *body, const Path *path, float touch, float least_step, float *t, float normal[3]) {
  float travelled = 0;
  for (int step = 0; step < MOST_STEPS; step++) {
    float p[3], inward = 0;
    *t = travelled / path->length;
    for (int k = 0; k < 3; k++) p[k] = path->from[k] + *t * path->way[k];
    float gap = sim_body_local_distance(body, p, normal);
    for (int k = 0; k < 3; k++) inward -= path->way[k] * normal[k];
    if (gap <= touch && inward > 0) return true;
    if (gap > path->length - travelled) return false;
    travelled += gap > least_step ? gap : least_step;
    if (travelled >= path->length) return false;
  }
  return true; // a long way close by: go no farther than is known to be free
}

// Whether the path comes down to the body, and at which part of its length, with the surface's normal there.
static bool first_touch(const SimBoundary *boundary, const SimBody *body, const Path *path, float touch, float *t,
                        float normal[3]) {
  if (!(path->length > 0)) return false;
  float least_step = LEAST_STEP * boundary->clearance;
  if (!body->mesh) return trace(body, path, touch, least_step, t, normal);
  if (!sim_mesh_tree_hit(&body->mesh->tree, path->from, path->to, t, normal)) return false;
  *t = sim_larger(0, *t - touch / path->length);
  return true;
}

// Stop the move at the body and let it slide on; whether it was changed.
static bool follow(const SimBoundary *boundary, const SimBody *body, const Path *path, float to[3]) {
  float touch = TOUCH * boundary->clearance, t, normal[3], inward = 0, stop[3], end[3];
  if (!first_touch(boundary, body, path, touch, &t, normal)) return false;
  for (int k = 0; k < 3; k++) inward += path->way[k] * normal[k];
  if (inward > 0) inward = 0;
  for (int k = 0; k < 3; k++) {
    stop[k] = path->from[k] + t * path->way[k];
    end[k] = stop[k] + (1 - t) * (path->way[k] - inward * normal[k]);
  }
  Path slide;
  set_path(&slide, stop, end);
  if (first_touch(boundary, body, &slide, touch, &t, normal))
    for (int k = 0; k < 3; k++) end[k] = stop[k] + t * slide.way[k];
  sim_to_world(body->rotation, end, to);
  for (int k = 0; k < 3; k++) to[k] += body->position[k];
  return true;
}

// The first look at a body: whether the move can be left as it is, as far as this body is concerned.
static bool leaves_alone(Move *move, int32_t b, float to[3]) {
  const SimBoundary *boundary = move->boundary;
  const SimBody *body = &boundary->bodies[b];
  if (!passes_ball(body, move->from, to, boundary->clearance)) return true;
  Path path;
  float normal[3];
  path_in_body(body, move->from, to, &path);
  float gap = sim_body_local_distance(body, path.to, normal), sure = gap - distance_error(body);
  bool clear = gap >= 0.999f * boundary->clearance;
  if (sure > path.length) return clear;
  // Two balls that touch no body and together hold the whole path.
  if (sure + sim_body_local_distance(body, path.from, normal) - distance_error(body) > path.length) return clear;
  if (!follow(boundary, body, &path, to)) return clear;
  if (body->floats) move->floating = b;
  return false;
}

// ---- Out of bodies and walls -----------------------------------------------------------------------------------------

static bool push_out_of_bodies(Move *move, float clearance, float point[3]) {
  bool moved = false;
  for (int32_t n = 0; n < list_length(move); n++) {
    int32_t b = listed(move, n);
    const SimBody *body = &move->boundary->bodies[b];
    if (!passes_ball(body, move->from, point, clearance)) continue;
    float normal[3], gap = sim_body_distance(body, point, normal);
    if (!(gap < clearance * 0.999f)) continue;
    for (int k = 0; k < 3; k++) point[k] += (clearance - gap) * normal[k];
    if (body->floats) move->floating = b;
    moved = true;
  }
  return moved;
}

static void settle(Move *move, float clearance, float point[3]) {
  sim_boundary_into_container(move->boundary, clearance, point);
  for (int round = 0; round < ROUNDS && push_out_of_bodies(move, clearance, point); round++)
    sim_boundary_into_container(move->boundary, clearance, point);
}

// Whether a place lies in no body, and the way there passes through none. A particle that was in a body already may
// leave it anywhere.
static bool acceptable(const Move *move, const float point[3]) {
  for (int32_t n = 0; n < list_length(move); n++) {
    const SimBody *body = &move->boundary->bodies[listed(move, n)];
    if (!passes_ball(body, move->from, point, 0)) continue;
    Path path;
    float normal[3], t;
    path_in_body(body, move->from, point, &path);
    float gap = sim_body_local_distance(body, path.to, normal);
    if (gap < 0) return false;
    float before = sim_body_local_distance(body, path.from, normal);
    if (before <= 0 || before + gap - 2 * distance_error(body) > path.length) continue;
    if (first_touch(move->boundary, body, &path, 0, &t, normal)) return false;
  }
  return true;
}

// Where a body that moved would have the particle if it took it along.
static bool carried(const Move *move, float place[3]) {
  for (int32_t n = 0; n < list_length(move); n++) {
    const SimBody *body = &move->boundary->bodies[listed(move, n)];
    if (!body->moves || !passes_ball(body, move->from, place, move->boundary->clearance)) continue;
    float offset[3], local[3], candidate[3];
    for (int k = 0; k < 3; k++) offset[k] = move->from[k] - body->old_position[k];
    sim_to_local(body->old_rotation, offset, local);
    sim_to_world(body->rotation, local, candidate);
    for (int k = 0; k < 3; k++) candidate[k] += body->position[k];
    sim_boundary_into_container(move->boundary, TIGHT * move->boundary->clearance, candidate);
    if (!acceptable(move, candidate)) continue;
    memcpy(place, candidate, sizeof candidate);
    return true;
  }
  return false;
}

static void find_place(Move *move, float to[3]) {
  float place[3] = {to[0], to[1], to[2]};
  settle(move, move->boundary->clearance, place);
  if (!acceptable(move, place)) {
    settle(move, TIGHT * move->boundary->clearance, place);
    if (!acceptable(move, place)) {
      memcpy(place, move->from, sizeof place);
      sim_boundary_into_container(move->boundary, move->boundary->clearance, place);
      if (!acceptable(move, place) && !carried(move, place)) {
        memcpy(place, to, sizeof place);
        sim_boundary_into_container(move->boundary, move->boundary->clearance, place);
      }
    }
  }
  memcpy(to, place, sizeof place);
}

int32_t sim_boundary_clamp(const SimBoundary *boundary, const SimNear *near, const float from[3], float to[3]) {
  sim_boundary_into_container(boundary, boundary->clearance, to);
  Move move = {boundary, near, from, -1};
  int32_t count = list_length(&move);
  if (count == 0 || !(isfinite(to[0]) && isfinite(to[1]) && isfinite(to[2]))) return -1;
  bool alone = true;
  for (int32_t n = 0; n < count; n++)
    if (!leaves_alone(&move, listed(&move, n), to)) alone = false;
  if (!alone) find_place(&move, to);
  return move.floating;
}
