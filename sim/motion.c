// Scripted and draggable bodies, and the order of things for all moving ones: see motion.h.
//
// A script is evaluated at the exact time at which a substep ends, never summed up, so where a paddle is does not depend
// on how a frame is cut into substeps. A dragged body goes straight to its target while it turns by the shortest way, both
// evenly and both ending together: with d the way of its centre, θ the angle and R the distance of its farthest point from
// the centre, no point has farther to go than d + θ R, and it does the share max_speed dt/(d + θ R) of the rest in a
// substep. Its target is first moved to the nearest point of the container; the container is convex, so a centre that starts
// inside stays inside. A body may stick out of the walls (water cannot), as a hand may.
#include "sim/motion.h"

#include <stdio.h>
#include <string.h>

#include "sim/memory.h"
#include "sim/quaternion.h"
#include "sim/world.h"

#define PI 3.14159265358979323846
#define MAX_KEYS 65536
/// m/s: no body is told to be faster. Substeps as short as that needs would never end.
#define MAX_SPEED 1000.0f
/// Largest move of a point of a body in a substep, in spacings, whatever the world's cfl allows.
#define MAX_MOVE 0.5f

// ---- What can be asked for -------------------------------------------------------------------------------------------

static bool range_check(int32_t index, const char *field, double value, double low, double high, bool open,
                        SimError *error) {
  if (value <= high && (open ? value > low : value >= low)) return true;
  return sim_fail(error, "obstacles[%d].%s must be in %s%g, %g], got %g", index, field, open ? "(" : "[", low, high,
                  value);
}

static bool vector_check(int32_t index, const char *field, const float *v, int count, SimError *error) {
  for (int k = 0; k < count; k++)
    if (!(fabsf(v[k]) <= 1e6f))
      return sim_fail(error, "obstacles[%d].%s: component %d must be finite and at most 1e6 in size, got %g", index,
                      field, k, (double)v[k]);
  return true;
}

static bool rotation_check(int32_t index, const char *field, const float q[4], SimError *error) {
  if (!vector_check(index, field, q, 4, error)) return false;
  if (fabsf(q[0]) + fabsf(q[1]) + fabsf(q[2]) + fabsf(q[3]) > 1e-6f) return true;
  return sim_fail(error, "obstacles[%d].%s must be a quaternion that is not zero", index, field);
}

static double distance(const float a[3], const float b[3]) {
  double d[3];
  for (int k = 0; k < 3; k++) d[k] = (double)b[k] - (double)a[k];
  return sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

static double angle_between(const float a[4], const float b[4]) {
  double from[4], to[4], way[3];
  sim_quaternion_from(a, from);
  sim_quaternion_from(b, to);
  return sim_quaternion_way(from, to, way);
}

static bool key_check(const SimObstacleDef *def, int32_t index, int32_t k, SimError *error) {
  const SimPoseKey *key = &def->keys[k];
  char field[48];
  snprintf(field, sizeof field, "keys[%d].position", k);
  if (!vector_check(index, field, key->position, 3, error)) return false;
  snprintf(field, sizeof field, "keys[%d].rotation", k);
  if (!rotation_check(index, field, key->rotation, error)) return false;
  snprintf(field, sizeof field, "keys[%d].time", k);
  if (!range_check(index, field, key->time, -1e9, 1e9, false, error)) return false;
  if (k == 0) return true;
  double span = key->time - key[-1].time;
  if (!(span > 0))
    return sim_fail(error, "obstacles[%d].%s must be later than %g s, got %g", index, field, key[-1].time, key->time);
  snprintf(field, sizeof field, "keys[%d]: its speed in m/s", k);
  return range_check(index, field, distance(key[-1].position, key->position) / span, 0, (double)MAX_SPEED, false,
                     error);
}

static bool scripted_check(const SimObstacleDef *def, int32_t index, SimError *error) {
  if (!range_check(index, "key_count", def->key_count, 0, MAX_KEYS, false, error)) return false;
  if (def->key_count > 0 && !def->keys) return sim_fail(error, "obstacles[%d].keys are missing", index);
  for (int32_t k = 0; k < def->key_count; k++)
    if (!key_check(def, index, k, error)) return false;
  if (def->repeat) {
    const SimPoseKey *first = def->keys, *last = def->keys + def->key_count - 1;
    if (def->key_count < 2) return sim_fail(error, "obstacles[%d].repeat needs two keys or more", index);
    // Otherwise the body would jump, through whatever is in its way.
    if (distance(first->position, last->position) > 1e-4 || angle_between(first->rotation, last->rotation) > 1e-3)
      return sim_fail(error, "obstacles[%d].repeat: the last key must have the pose of the first", index);
  }
  if (!vector_check(index, "stroke", def->stroke, 3, error) ||
      !range_check(index, "start", def->start, -1e9, 1e9, false, error))
    return false;
  double stroke = distance((const float[3]){0, 0, 0}, def->stroke);
  return stroke == 0 || (range_check(index, "period", (double)def->period, 0, 1e6, true, error) &&
                         range_check(index, "stroke: its speed in m/s", PI * stroke / (double)def->period, 0,
                                     (double)MAX_SPEED, false, error));
}

bool sim_motion_check(const SimObstacleDef *def, int32_t index, SimError *error) {
  switch (def->motion) {
  case SIM_STATIC:
    return true;
  case SIM_SCRIPTED:
    return scripted_check(def, index, error);
  case SIM_DRAGGABLE:
    return range_check(index, "max_speed", (double)def->max_speed, 0, (double)MAX_SPEED, true, error);
  case SIM_FLOATING:
    if (!range_check(index, "density", (double)def->density, 0, 1e6, true, error)) return false;
    if (sim_mass_make(&def->body, (double)def->density).mass > 0) return true;
    return sim_fail(error, "obstacles[%d]: a floating body must hold a volume; its triangles must point outwards",
                    index);
  }
  return sim_fail(error, "obstacles[%d].motion: unknown motion %d", index, (int)def->motion);
}

// ---- Scripts ---------------------------------------------------------------------------------------------------------

static void pose_of_key(const SimPoseKey *key, SimPose *pose) {
  for (int k = 0; k < 3; k++) pose->position[k] = (double)key->position[k];
  sim_quaternion_from(key->rotation, pose->rotation);
}

static void pose_of_start(const SimObstacleDef *def, SimPose *pose) {
  for (int k = 0; k < 3; k++) pose->position[k] = (double)def->body.position[k];
  sim_quaternion_from(def->body.rotation, pose->rotation);
}

// The time within the keys: with `repeat`, times after the last key are those of a later round.
static double key_time(const SimObstacleDef *def, double time) {
  double first = def->keys[0].time, last = def->keys[def->key_count - 1].time;
  return def->repeat && time > last ? first + fmod(time - first, last - first) : time;
}

static void pose_of_keys(const SimObstacleDef *def, double time, SimPose *pose) {
  const SimPoseKey *keys = def->keys;
  int32_t low = 0, high = def->key_count - 1;
  time = key_time(def, time);
  if (time <= keys[low].time) high = low;
  if (time >= keys[high].time) low = high;
  while (high - low > 1) {
    int32_t middle = low + (high - low) / 2;
    *(keys[middle].time <= time ? &low : &high) = middle;
  }
  pose_of_key(&keys[low], pose);
  if (low == high) return;
  SimPose next;
  pose_of_key(&keys[high], &next);
  double share = (time - keys[low].time) / (keys[high].time - keys[low].time);
  for (int k = 0; k < 3; k++) pose->position[k] += share * (next.position[k] - pose->position[k]);
  sim_quaternion_between(pose->rotation, next.rotation, share, pose->rotation);
}

void sim_motion_scripted(const SimObstacleDef *def, double time, SimPose *pose) {
  if (def->key_count > 0)
    pose_of_keys(def, time, pose);
  else
    pose_of_start(def, pose);
  if (time <= def->start) return;
  double share = 0.5 * (1 - cos(2 * PI * fmod((time - def->start) / (double)def->period, 1)));
  for (int k = 0; k < 3; k++)
    if (def->stroke[k] != 0) pose->position[k] += share * (double)def->stroke[k];
}

static double segment_speed(const SimPoseKey *key, double reach) {
  return (distance(key[0].position, key[1].position) + reach * angle_between(key[0].rotation, key[1].rotation)) /
         (key[1].time - key[0].time);
}

// A bound on the speed of the farthest point between two moments.
static double scripted_speed(const SimObstacleDef *def, double from, double to, double reach) {
  double speed = 0;
  if (def->key_count > 1) {
    double first = def->keys[0].time, last = def->keys[def->key_count - 1].time, begin = key_time(def, from);
    double end = begin + (to - from);
    bool wraps = def->repeat && end > last;
    for (int32_t k = 0; k + 1 < def->key_count; k++) {
      double a = def->keys[k].time, b = def->keys[k + 1].time;
      if ((a <= end && b >= begin) || (wraps && a <= end - (last - first)))
        speed = fmax(speed, segment_speed(&def->keys[k], reach));
    }
  }
  double stroke = distance((const float[3]){0, 0, 0}, def->stroke);
  return stroke > 0 && to > def->start ? speed + PI * stroke / (double)def->period : speed;
}

// ---- Dragging --------------------------------------------------------------------------------------------------------

static double way_to_go(const SimPose *from, const SimPose *to, double reach) {
  double d2 = 0, way[3];
  for (int k = 0; k < 3; k++) d2 += (to->position[k] - from->position[k]) * (to->position[k] - from->position[k]);
  return sqrt(d2) + reach * sim_quaternion_way(from->rotation, to->rotation, way);
}

static void drag(SimMover *mover, double most, double reach) {
  double way = way_to_go(&mover->now, &mover->target, reach);
  if (way <= most) {
    mover->now = mover->target;
    return;
  }
  double share = most / way;
  for (int k = 0; k < 3; k++) mover->now.position[k] += share * (mover->target.position[k] - mover->now.position[k]);
  sim_quaternion_between(mover->now.rotation, mover->target.rotation, share, mover->now.rotation);
}

static void into_container(const SimContainer *container, double point[3]) {
  double middle[3], radius = INFINITY;
  for (int k = 0; k < 3; k++) {
    double low = (double)container->min[k], high = (double)container->max[k];
    point[k] = fmin(fmax(point[k], low), high);
    middle[k] = 0.5 * (low + high);
    if (k != 1) radius = fmin(radius, 0.5 * (high - low));
  }
  double x = point[0] - middle[0], z = point[2] - middle[2], away = sqrt(x * x + z * z);
  if (container->shape != SIM_CONTAINER_GLASS || away <= radius) return;
  point[0] = middle[0] + x * radius / away;
  point[2] = middle[2] + z * radius / away;
}

static bool all_finite(const float *v, int count) {
  for (int k = 0; k < count; k++)
    if (!isfinite(v[k])) return false;
  return true;
}

bool sim_world_drag(SimWorld *world, int32_t obstacle, const float position[3], const float rotation[4]) {
  if (obstacle < 0 || obstacle >= world->def.obstacle_count || world->def.obstacles[obstacle].motion != SIM_DRAGGABLE ||
      !position || !all_finite(position, 3))
    return false;
  if (rotation && (!all_finite(rotation, 4) ||
                   !(fabsf(rotation[0]) + fabsf(rotation[1]) + fabsf(rotation[2]) + fabsf(rotation[3]) > 1e-6f)))
    return false;
  SimMover *mover = &world->motion.movers[obstacle];
  mover->target = mover->now;
  for (int k = 0; k < 3; k++) mover->target.position[k] = (double)position[k];
  into_container(&world->def.container, mover->target.position);
  if (rotation) sim_quaternion_from(rotation, mover->target.rotation);
  return true;
}

// ---- The bodies follow -----------------------------------------------------------------------------------------------

static void place(SimBody *body, const SimPose *pose) {
  double m[9];
  sim_quaternion_matrix(pose->rotation, m);
  for (int k = 0; k < 3; k++) body->position[k] = (float)pose->position[k];
  for (int k = 0; k < 9; k++) body->rotation[k] = (float)m[k];
}

static void follow(const SimMover *mover, double dt, SimBody *body) {
  double way[3];
  place(body, &mover->now);
  sim_quaternion_way(mover->old.rotation, mover->now.rotation, way);
  for (int k = 0; k < 3; k++) {
    body->velocity[k] = (float)((mover->now.position[k] - mover->old.position[k]) / dt);
    body->spin[k] = (float)(way[k] / dt);
  }
}

static float length3(const float v[3]) {
  return sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static void show(SimObstacle *obstacle, const SimPose *pose) {
  for (int k = 0; k < 3; k++) obstacle->position[k] = (float)pose->position[k];
  for (int k = 0; k < 4; k++) obstacle->rotation[k] = (float)pose->rotation[k];
}

static void keep_start(SimWorld *world) {
  SimMotionState *motion = &world->motion;
  motion->start = world->boundary;
  motion->start.bodies = motion->start_bodies;
  for (int32_t b = 0; b < world->def.obstacle_count; b++) motion->start_bodies[b] = world->bodies[b];
}

bool sim_motion_begin(SimWorld *world, double end) {
  if (world->motion.movers) keep_start(world);
  double dt = end - world->time, fastest = 0;
  for (int32_t b = 0; world->motion.movers && b < world->def.obstacle_count; b++) {
    const SimObstacleDef *def = &world->def.obstacles[b];
    SimMover *mover = &world->motion.movers[b];
    SimBody *body = &world->bodies[b];
    if (def->motion == SIM_STATIC) continue;
    mover->old = mover->now;
    memcpy(body->old_position, body->position, sizeof body->position);
    memcpy(body->old_rotation, body->rotation, sizeof body->rotation);
    if (def->motion == SIM_SCRIPTED) sim_motion_scripted(def, end, &mover->now);
    if (def->motion == SIM_DRAGGABLE) drag(mover, (double)def->max_speed * dt, (double)body->bound);
    if (def->motion == SIM_FLOATING)
      sim_rigid_predict(world->motion.rigid, b, dt, mover->now.position, mover->now.rotation);
    follow(mover, dt, body);
    fastest = fmax(fastest, (double)(length3(body->velocity) + body->bound * length3(body->spin)));
  }
  world->motion.clamp_speed = (float)fastest + sim_reaction_recovery(world->cubic.spacing);
  if (!world->motion.rigid) return true;
  sim_reaction_clear(&world->motion.reaction, (float)dt);
  return sim_reaction_reserve(&world->motion.reaction, world->particles.count);
}

bool sim_motion_end(SimWorld *world, double end, SimError *error) {
  SimRigid *rigid = world->motion.rigid;
  if (!rigid) return true;
  SimReaction *reaction = &world->motion.reaction;
  double dt = end - world->time;
  sim_reaction_layer(reaction, world->threads, &world->particles);
  if (!sim_rigid_step(rigid, dt, world->gravity, reaction->given, world->bodies))
    return sim_fail(error, "out of memory");
  sim_reaction_follow(reaction, world->threads, &world->particles);
  for (int32_t b = 0; b < world->def.obstacle_count; b++) {
    if (world->def.obstacles[b].motion != SIM_FLOATING) continue;
    double speed = sim_rigid_speed(rigid, b, 0);
    if (!(speed <= (double)world->speed_limit))
      return sim_fail(error, "motion: obstacles[%d] %s at %.6g s", b,
                      isfinite(speed) ? "exploded" : "has no finite velocity", world->time);
    SimMover *mover = &world->motion.movers[b];
    sim_rigid_predict(rigid, b, 0, mover->now.position, mover->now.rotation);
    follow(mover, dt, &world->bodies[b]);
  }
  return true;
}

void sim_motion_commit(SimWorld *world) {
  for (int32_t b = 0; world->motion.movers && b < world->def.obstacle_count; b++)
    if (world->def.obstacles[b].motion != SIM_STATIC) show(&world->obstacles[b], &world->motion.movers[b].now);
}

void sim_motion_cancel(SimWorld *world) {
  for (int32_t b = 0; world->motion.movers && b < world->def.obstacle_count; b++) {
    if (world->def.obstacles[b].motion == SIM_STATIC) continue;
    world->motion.movers[b].now = world->motion.movers[b].old;
    place(&world->bodies[b], &world->motion.movers[b].now);
  }
}

double sim_motion_longest(const SimWorld *world, double longest) {
  double pull = 0, speed = 0, most = (double)(fminf(world->def.cfl, MAX_MOVE) * world->cubic.spacing);
  for (int k = 0; k < 3; k++) pull += (double)world->gravity[k] * (double)world->gravity[k];
  for (int32_t b = 0; world->motion.movers && b < world->def.obstacle_count; b++) {
    const SimObstacleDef *def = &world->def.obstacles[b];
    const SimMover *mover = &world->motion.movers[b];
    double reach = (double)world->bodies[b].bound;
    if (def->motion == SIM_SCRIPTED)
      speed = fmax(speed, scripted_speed(def, world->time, world->time + longest, reach));
    if (def->motion == SIM_DRAGGABLE && memcmp(&mover->now, &mover->target, sizeof(SimPose)) != 0)
      speed = fmax(speed, (double)def->max_speed);
    if (def->motion == SIM_FLOATING)
      speed = fmax(speed, sim_rigid_speed(world->motion.rigid, b, reach) + sqrt(pull) * longest);
  }
  return speed * longest > most ? most / speed : longest;
}

// ---- Life ------------------------------------------------------------------------------------------------------------

static bool copy_keys(SimWorld *world) {
  size_t count = 0;
  for (int32_t b = 0; b < world->def.obstacle_count; b++)
    if (world->obstacle_defs[b].motion == SIM_SCRIPTED) count += (size_t)world->obstacle_defs[b].key_count;
  if (count == 0) return true;
  SimPoseKey *next = world->motion.keys = sim_allocate(count * sizeof(SimPoseKey));
  if (!next) return false;
  for (int32_t b = 0; b < world->def.obstacle_count; b++) {
    SimObstacleDef *def = &world->obstacle_defs[b];
    if (def->motion != SIM_SCRIPTED || def->key_count == 0) continue;
    memcpy(next, def->keys, (size_t)def->key_count * sizeof(SimPoseKey));
    def->keys = next;
    next += def->key_count;
  }
  return true;
}

bool sim_motion_create(SimWorld *world) {
  SimMotionState *motion = &world->motion;
  int32_t count = world->def.obstacle_count, moving = 0, floating = 0;
  for (int32_t b = 0; b < count; b++) {
    SimMotion kind = world->obstacle_defs[b].motion;
    moving += kind != SIM_STATIC;
    floating += kind == SIM_FLOATING;
    world->bodies[b].moves = kind != SIM_STATIC;
    world->bodies[b].floats = kind == SIM_FLOATING;
  }
  if (moving > 0 && (!(motion->movers = sim_allocate((size_t)count * sizeof(SimMover))) ||
                     !(motion->start_bodies = sim_allocate((size_t)count * sizeof(SimBody)))))
    return false;
  if (floating > 0 && (!(motion->rigid = sim_rigid_create(&world->def.container, world->obstacle_defs, count,
                                                          (double)world->cubic.spacing)) ||
                       !sim_reaction_create(&motion->reaction, &world->boundary, motion->rigid,
                                            (double)(world->def.rest_density * world->cubic.volume))))
    return false;
  return copy_keys(world);
}

void sim_motion_destroy(SimWorld *world) {
  sim_release(world->motion.movers);
  sim_release(world->motion.start_bodies);
  sim_release(world->motion.keys);
  sim_reaction_destroy(&world->motion.reaction);
  sim_rigid_destroy(world->motion.rigid);
}

bool sim_motion_reset(SimWorld *world) {
  for (int32_t b = 0; world->motion.movers && b < world->def.obstacle_count; b++) {
    const SimObstacleDef *def = &world->def.obstacles[b];
    SimMover *mover = &world->motion.movers[b];
    pose_of_start(def, &mover->now);
    if (def->motion == SIM_SCRIPTED) sim_motion_scripted(def, 0, &mover->now);
    mover->old = mover->target = mover->now;
    if (def->motion == SIM_STATIC) continue;
    place(&world->bodies[b], &mover->now);
    memcpy(world->bodies[b].old_position, world->bodies[b].position, sizeof world->bodies[b].position);
    memcpy(world->bodies[b].old_rotation, world->bodies[b].rotation, sizeof world->bodies[b].rotation);
    memset(world->bodies[b].velocity, 0, sizeof world->bodies[b].velocity);
    memset(world->bodies[b].spin, 0, sizeof world->bodies[b].spin);
    show(&world->obstacles[b], &mover->now);
  }
  return !world->motion.rigid || sim_rigid_reset(world->motion.rigid);
}
