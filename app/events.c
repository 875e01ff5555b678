#include "app/events.h"

#include <math.h>
#include <string.h>

// ---- Time ---------------------------------------------------------------------------------------------------------
// Two steps that follow each other must agree on the border between them, or an event on it happens twice or never.
// n·step + step and (n + 1)·step may differ in their last bit, so a border is computed from the frame's index wherever
// time is a whole number of steps, and all times are compared as whole nanoseconds.

typedef struct Interval {
  double begin, end; // ns, whole numbers
} Interval;

static double nanoseconds(double seconds) {
  return rint(seconds * 1e9);
}

static Interval interval_of(double time, double step) {
  double index = rint(time / step);
  if (fabs(time - index * step) <= 1e-6 * step)
    return (Interval){nanoseconds(index * step), nanoseconds((index + 1) * step)};
  return (Interval){nanoseconds(time), nanoseconds(time + step)};
}

// How much of the interval the event covers, [0, 1]; an event without a duration covers the one it falls into.
static double covered(const SceneEvent *event, Interval interval) {
  double begin = nanoseconds(event->time), end = nanoseconds((double)event->time + event->duration);
  if (end <= begin) return begin >= interval.begin && begin < interval.end ? 1 : 0;
  double overlap = fmin(end, interval.end) - fmax(begin, interval.begin);
  return overlap > 0 ? overlap / (interval.end - interval.begin) : 0;
}

// How far the event has come at a moment, [0, 1].
static double progress(const SceneEvent *event, double time) {
  if (time < event->time) return 0;
  return event->duration > 0 ? fmin((time - event->time) / event->duration, 1) : 1;
}

static double smoothstep(double x) {
  return x * x * (3 - 2 * x);
}

static void blend(const float from[3], const float to[3], double weight, float out[3]) {
  for (int k = 0; k < 3; k++) out[k] = weight >= 1 ? to[k] : (float)(from[k] + weight * ((double)to[k] - from[k]));
}

// ---- Values that move from event to event --------------------------------------------------------------------------
// Each event moves on from where the one before it has come to when it begins: events are sorted by time, so one pass
// suffices, which keeps the place where the present move started.

void events_gravity(const Scene *scene, double time, float gravity[3]) {
  float from[3];
  memcpy(from, scene->simulation.gravity, sizeof from);
  memcpy(gravity, from, sizeof from);
  const SceneEvent *last = NULL;
  for (int i = 0; i < scene->events_count && scene->events[i].time <= time; i++) {
    const SceneEvent *event = &scene->events[i];
    if (event->type != EVENT_TILT) continue;
    if (last) blend(from, last->tilt.gravity, progress(last, event->time), from);
    last = event;
  }
  if (last) blend(from, last->tilt.gravity, progress(last, time), gravity);
}

/// Spherical interpolation, the short way (Shoemake, Animating rotation with quaternion curves, 1985).
static void blend_turns(const float from[4], const float to[4], double weight, float out[4]) {
  double dot = 0, blended[4], length = 0;
  for (int k = 0; k < 4; k++) dot += (double)from[k] * to[k];
  double sign = dot < 0 ? -1 : 1, angle = acos(fmin(sign * dot, 1)), sine = sin(angle);
  // Nearly the same turn: on so short an arc the chord does.
  double a = sine > 1e-4 ? sin((1 - weight) * angle) / sine : 1 - weight;
  double b = sine > 1e-4 ? sin(weight * angle) / sine : weight;
  for (int k = 0; k < 4; k++) {
    blended[k] = a * from[k] + sign * b * to[k];
    length += blended[k] * blended[k];
  }
  for (int k = 0; k < 4; k++) out[k] = (float)(blended[k] / sqrt(length));
}

static void blend_drags(const SceneEvent *event, double time, float position[3], float rotation[4]) {
  blend(position, event->drag.position, progress(event, time), position);
  if (isnan(event->drag.rotation[0])) return;
  float to[4];
  scene_quaternion(event->drag.rotation, to);
  blend_turns(rotation, to, progress(event, time), rotation);
}

void events_drag(const Scene *scene, int32_t obstacle, double time, float position[3], float rotation[4]) {
  const SimObstacle *body = &scene->defs.obstacles[obstacle].body;
  memcpy(position, body->position, sizeof body->position);
  memcpy(rotation, body->rotation, sizeof body->rotation);
  const SceneEvent *last = NULL;
  for (int i = 0; i < scene->events_count && scene->events[i].time <= time; i++) {
    const SceneEvent *event = &scene->events[i];
    if (event->type != EVENT_DRAG || event->drag.obstacle.index != obstacle) continue;
    if (last) blend_drags(last, event->time, position, rotation);
    last = event;
  }
  if (last) blend_drags(last, time, position, rotation);
}

static void blend_views(const Scene *scene, const RenderView *from, const SceneEvent *event, double time,
                        RenderView *out) {
  double weight = smoothstep(progress(event, time));
  double from_fov = from->vertical_fov, to_fov = event->camera.fov;
  if (isnan(to_fov)) to_fov = scene->camera.fov;
  blend(from->eye, event->camera.eye, weight, out->eye);
  blend(from->target, event->camera.target, weight, out->target);
  out->vertical_fov = (float)(from_fov + weight * (to_fov - from_fov));
}

static void set_view(const Scene *scene, double time, Interval interval, RenderView *view) {
  RenderView from = scene_view(scene);
  const SceneEvent *last = NULL;
  for (int i = 0; i < scene->events_count && nanoseconds(scene->events[i].time) < interval.end; i++) {
    const SceneEvent *event = &scene->events[i];
    if (event->type != EVENT_CAMERA) continue;
    if (last) blend_views(scene, &from, last, event->time, &from);
    last = event;
  }
  if (last) blend_views(scene, &from, last, time, view);
}

static void set_style(const Scene *scene, Interval interval, RenderSettings *settings) {
  for (int i = 0; i < scene->events_count && nanoseconds(scene->events[i].time) < interval.end; i++)
    if (scene->events[i].type == EVENT_STYLE) settings->style = scene->events[i].style.name;
}

// ---- What moves the water -------------------------------------------------------------------------------------------

static bool push_world(const SceneEvent *event, int index, Interval interval, SimWorld *world, AppError *error) {
  double part = covered(event, interval);
  if (!(part > 0)) return true;
  SimPush push = {.radius = event->push.radius};
  memcpy(push.origin, event->push.origin, sizeof push.origin);
  memcpy(push.direction, event->push.direction, sizeof push.direction);
  for (int k = 0; k < 3; k++) push.acceleration[k] = (float)(event->push.acceleration[k] * part);
  if (sim_world_push(world, &push)) return true;
  return app_fail(error, APP_FAILED, "events[%d]: the push was refused: more than %d at once, or not a usable ray",
                  index, SIM_MAX_PUSHES);
}

static bool pour_world(const SceneEvent *event, int index, Interval interval, SimWorld *world, AppError *error) {
  if (!(covered(event, interval) > 0)) return true;
  SimBlockDef block;
  memcpy(block.min, event->pour.min, sizeof block.min);
  memcpy(block.max, event->pour.max, sizeof block.max);
  memcpy(block.velocity, event->pour.velocity, sizeof block.velocity);
  memcpy(block.colour, event->pour.colour, sizeof block.colour);
  SimError reason;
  if (sim_world_pour(world, &block, &reason) >= 0) return true;
  return app_fail(error, APP_FAILED, "events[%d]: %s", index, reason.message);
}

static bool drag_world(const Scene *scene, int index, double end, Interval interval, SimWorld *world, AppError *error) {
  const SceneEvent *event = &scene->events[index];
  if (!(covered(event, interval) > 0)) return true;
  float position[3], rotation[4];
  events_drag(scene, event->drag.obstacle.index, end, position, rotation);
  if (sim_world_drag(world, event->drag.obstacle.index, position, rotation)) return true;
  return app_fail(error, APP_FAILED, "events[%d]: the drag was refused: not a draggable obstacle, or not finite",
                  index);
}

static bool switch_world(const Scene *scene, int index, Interval interval, SimWorld *world, AppError *error) {
  const SceneEvent *event = &scene->events[index];
  if (!(nanoseconds(event->time) >= interval.begin)) return true;
  int32_t emitter = scene_emitter_index(scene, event->emitter.emitter.index);
  if (sim_world_set_emitter(world, emitter, event->emitter.on)) return true;
  return app_fail(error, APP_FAILED, "events[%d]: there is no such emitter", index);
}

static bool move_world(const Scene *scene, double time, double step, SimWorld *world, AppError *error) {
  Interval interval = interval_of(time, step);
  bool tilted = false;
  for (int i = 0; i < scene->events_count && nanoseconds(scene->events[i].time) < interval.end; i++) {
    const SceneEvent *event = &scene->events[i];
    if (event->type == EVENT_PUSH && !push_world(event, i, interval, world, error)) return false;
    if (event->type == EVENT_POUR && !pour_world(event, i, interval, world, error)) return false;
    if (event->type == EVENT_DRAG && !drag_world(scene, i, time + step, interval, world, error)) return false;
    if (event->type == EVENT_EMITTER && !switch_world(scene, i, interval, world, error)) return false;
    if (event->type == EVENT_TILT) tilted = true;
  }
  if (!tilted) return true;
  float gravity[3];
  events_gravity(scene, time + 0.5 * step, gravity);
  if (sim_world_set_gravity(world, gravity)) return true;
  return app_fail(error, APP_FAILED, "events: gravity was refused: not finite");
}

bool events_apply(const Scene *scene, double time, double step, SimWorld *world, RenderSettings *settings,
                  RenderView *view, AppError *error) {
  if (settings) set_style(scene, interval_of(time, step), settings);
  if (view) set_view(scene, time, interval_of(time, step), view);
  return world ? move_world(scene, time, step, world, error) : true;
}
