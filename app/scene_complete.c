// What no field can tell alone: boxes the right way round, water inside the container and not twice in one place, no
// more particles than fit. Then what the rest of the program wants ready: sorted events, unit directions, a camera.
#include <cjson/cJSON.h>

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/scene_parse.h"

enum { MOST_SPACINGS = 100000 }; // from the origin to the container's walls

/// What every check needs: the scene, and where its values came from.
typedef struct Check {
  const SceneSource *source;
  const cJSON *root;
  Scene *scene;
} Check;

/// Fail at a key path given as text: its place in the file is looked up in the tree.
static bool fail_at(const Check *check, const char *keys, const char *format, ...) {
  enum { LEVELS = 8 };
  ScenePath chain[LEVELS] = {{0}};
  char parts[SCENE_PATH_SIZE], message[400];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  snprintf(parts, sizeof parts, "%s", keys);
  const cJSON *here = check->root;
  int level = 0;
  for (char *rest = parts, *key; level + 1 < LEVELS && (key = strtok_r(rest, ".", &rest));) {
    bool item = *key >= '0' && *key <= '9';
    int ordinal = item ? atoi(key) : 0;
    const cJSON *child = here ? here->child : NULL;
    if (item)
      for (int i = 0; child && i < ordinal; i++) child = child->next;
    else
      for (; child && strcmp(child->string, key) != 0; child = child->next) ordinal++;
    level++;
    chain[level] = (ScenePath){&chain[level - 1], item ? NULL : key, item || child ? ordinal : -1};
    here = child;
  }
  return scene_fail(check->source, &chain[level], "%s", message);
}

// ---- Boxes and particles --------------------------------------------------------------------------------------------

static bool check_box(const Check *check, const char *keys, const float min[3], const float max[3]) {
  for (int i = 0; i < 3; i++)
    if (min[i] >= max[i])
      return fail_at(check, keys, "min must be less than max, but in %c %g is not less than %g", "xyz"[i],
                     (double)min[i], (double)max[i]);
  return true;
}

/// Whether two boxes share more than `tolerance` in every direction.
static bool overlap(const float a_min[3], const float a_max[3], const float b_min[3], const float b_max[3],
                    float tolerance) {
  for (int i = 0; i < 3; i++)
    if (fminf(a_max[i], b_max[i]) - fmaxf(a_min[i], b_min[i]) <= tolerance) return false;
  return true;
}

/// Lattice points of a box filled with particles, as the simulation counts them: at least one layer, and a hundredth of
/// a spacing forgiven. As a double, because it may be huge.
static double lattice_count(const float min[3], const float max[3], float radius) {
  double count = 1;
  for (int i = 0; i < 3; i++) count *= fmax(1, floor(((double)max[i] - min[i]) / (2.0 * (double)radius) + 0.01));
  return count;
}

static bool check_block(const Check *check, const char *keys, const float min[3], const float max[3]) {
  const SceneContainer *container = &check->scene->container;
  float radius = check->scene->simulation.particle_radius;
  if (!check_box(check, keys, min, max)) return false;
  if (!overlap(min, max, container->min, container->max, 0)) return fail_at(check, keys, "lies outside the container");
  double count = lattice_count(min, max, radius);
  if (count > SIM_MAX_PARTICLES)
    return fail_at(check, keys, "would hold %.0f particles of radius %g m, more than the limit of %d", count,
                   (double)radius, SIM_MAX_PARTICLES);
  return true;
}

static bool check_fluid(const Check *check) {
  const Scene *scene = check->scene;
  char keys[40];
  for (int i = 0; i < scene->fluid_count; i++) {
    const SceneBlock *block = &scene->fluid[i].block;
    snprintf(keys, sizeof keys, "fluid.%d", i);
    if (!check_block(check, keys, block->min, block->max)) return false;
  }
  int64_t count = scene_particle_count(scene);
  if (count > SIM_MAX_PARTICLES)
    return fail_at(check, "fluid", "would hold %" PRId64 " particles of radius %g m, more than the limit of %d", count,
                   (double)scene->simulation.particle_radius, SIM_MAX_PARTICLES);
  // Blocks may touch. A tenth of a spacing does no harm; more would burst apart in the first step.
  float tolerance = 0.2f * scene->simulation.particle_radius;
  for (int i = 0; i < scene->fluid_count; i++)
    for (int k = 0; k < i; k++) {
      const SceneBlock *a = &scene->fluid[i].block, *b = &scene->fluid[k].block;
      snprintf(keys, sizeof keys, "fluid.%d", i);
      if (overlap(a->min, a->max, b->min, b->max, tolerance)) return fail_at(check, keys, "overlaps fluid.%d", k);
    }
  return true;
}

int64_t scene_particle_count(const Scene *scene) {
  double count = 0;
  for (int i = 0; i < scene->fluid_count; i++)
    count += lattice_count(scene->fluid[i].block.min, scene->fluid[i].block.max, scene->simulation.particle_radius);
  return (int64_t)count;
}

static bool check_container(const Check *check) {
  const SceneContainer *container = &check->scene->container;
  float spacing = 2 * check->scene->simulation.particle_radius;
  if (!check_box(check, "container", container->min, container->max)) return false;
  for (int i = 0; i < 3; i++)
    if (container->max[i] - container->min[i] < spacing)
      return fail_at(check, "container", "is thinner in %c than one particle (2 x particle_radius = %g m)", "xyz"[i],
                     (double)spacing);
  // Further out, single precision no longer resolves how particles move.
  float farthest = MOST_SPACINGS * spacing;
  for (int i = 0; i < 3; i++)
    if (fabsf(container->min[i]) > farthest || fabsf(container->max[i]) > farthest)
      return fail_at(check, "container", "must lie within %d particles (%g m) of the origin in %c", MOST_SPACINGS,
                     (double)farthest, "xyz"[i]);
  return true;
}

// ---- Events ---------------------------------------------------------------------------------------------------------

static float distance(const float a[3], const float b[3]) {
  return sqrtf((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

/// Made a unit vector; one that is a unit vector but for rounding stays as it is, so that printing and loading ends.
static void make_unit(float v[3]) {
  double square = (double)v[0] * v[0] + (double)v[1] * v[1] + (double)v[2] * v[2];
  if (fabs(square - 1) < 1e-6) return;
  double factor = 1 / sqrt(square);
  for (int i = 0; i < 3; i++) v[i] = (float)(v[i] * factor);
}

static bool complete_event(const Check *check, int index) {
  SceneEvent *event = &check->scene->events[index];
  char keys[40];
  snprintf(keys, sizeof keys, "events.%d", index);
  switch (event->type) {
  case EVENT_PUSH:
    make_unit(event->push.direction);
    return true;
  case EVENT_POUR:
    return check_block(check, keys, event->pour.min, event->pour.max);
  case EVENT_CAMERA:
    if (isnan(event->camera.fov)) event->camera.fov = check->scene->camera.fov;
    return distance(event->camera.eye, event->camera.target) > 0 ||
           fail_at(check, keys, "eye and target must not be the same point");
  default:
    return true;
  }
}

typedef struct EventOrder {
  double time;
  int index;
} EventOrder;

static int compare_events(const void *a, const void *b) {
  const EventOrder *x = a, *y = b;
  if (x->time != y->time) return x->time < y->time ? -1 : 1;
  return x->index - y->index; // those of the same time keep their order
}

static bool sort_events(const Check *check) {
  Scene *scene = check->scene;
  size_t count = (size_t)scene->events_count;
  EventOrder *order = calloc(count + 1, sizeof *order);
  SceneEvent *sorted = calloc(count + 1, sizeof *sorted);
  if (!order || !sorted) {
    free(order);
    free(sorted);
    return app_fail(check->source->error, APP_FAILED, "out of memory");
  }
  for (size_t i = 0; i < count; i++) order[i] = (EventOrder){scene->events[i].time, (int)i};
  qsort(order, count, sizeof *order, compare_events);
  for (size_t i = 0; i < count; i++) sorted[i] = scene->events[order[i].index];
  free(order);
  free(scene->events);
  scene->events = sorted;
  return true;
}

// ---- Camera ---------------------------------------------------------------------------------------------------------

/// From the front and slightly above, far enough that a 16:9 picture holds the whole container.
static void place_camera(Scene *scene) {
  const SceneContainer *container = &scene->container;
  double centre[3], size[3];
  for (int i = 0; i < 3; i++) {
    centre[i] = 0.5 * ((double)container->min[i] + container->max[i]);
    size[i] = (double)container->max[i] - container->min[i];
  }
  double tangent = tan((double)scene->camera.fov * 3.14159265358979 / 360);
  double across = 0.5 * size[0] / (tangent * 16 / 9), up = 0.5 * (size[1] + 0.2 * size[2]) / tangent;
  double far = 0.5 * size[2] + 1.1 * fmax(across, up);
  double target[3] = {centre[0], container->min[1] + 0.3 * size[1], centre[2]};
  double eye[3] = {centre[0] - 0.15 * far, target[1] + 0.22 * far, centre[2] + 0.96 * far};
  // To the millimetre: these numbers are printed.
  for (int i = 0; i < 3; i++) {
    if (isnan(scene->camera.eye[i])) scene->camera.eye[i] = (float)(round(1000 * eye[i]) / 1000);
    if (isnan(scene->camera.target[i])) scene->camera.target[i] = (float)(round(1000 * target[i]) / 1000);
  }
}

// ---- What the simulation reads --------------------------------------------------------------------------------------

/// Unit quaternion (x, y, z, w) of a turn about x, then y, then z, in degrees.
static void quaternion_from_degrees(const float degrees[3], float q[4]) {
  double c[3], s[3];
  for (int i = 0; i < 3; i++) {
    double half = (double)degrees[i] * 3.14159265358979323846 / 360;
    c[i] = cos(half);
    s[i] = sin(half);
  }
  q[0] = (float)(s[0] * c[1] * c[2] - c[0] * s[1] * s[2]);
  q[1] = (float)(c[0] * s[1] * c[2] + s[0] * c[1] * s[2]);
  q[2] = (float)(c[0] * c[1] * s[2] - s[0] * s[1] * c[2]);
  q[3] = (float)(c[0] * c[1] * c[2] + s[0] * s[1] * s[2]);
}

static SimBlockDef make_block(const SceneBlock *block) {
  SimBlockDef def = {0};
  memcpy(def.min, block->min, sizeof def.min);
  memcpy(def.max, block->max, sizeof def.max);
  memcpy(def.velocity, block->velocity, sizeof def.velocity);
  memcpy(def.colour, block->colour, sizeof def.colour);
  return def;
}

static SimObstacleDef make_solid(const SceneObstacle *obstacle) {
  SimObstacleDef def = sim_default_obstacle_def();
  SimObstacle solid = {.shape = (SimShape)obstacle->type};
  switch (solid.shape) {
  case SIM_BOX:
    memcpy(solid.size, obstacle->box.size, sizeof solid.size);
    break;
  case SIM_SPHERE:
    for (int i = 0; i < 3; i++) solid.size[i] = 2 * obstacle->sphere.radius;
    break;
  case SIM_CYLINDER:
    solid.size[0] = solid.size[2] = 2 * obstacle->cylinder.radius;
    solid.size[1] = obstacle->cylinder.height;
    break;
  default:
    break;
  }
  memcpy(solid.position, obstacle->position, sizeof solid.position);
  memcpy(solid.colour, obstacle->colour, sizeof solid.colour);
  quaternion_from_degrees(obstacle->rotation, solid.rotation);
  def.body = solid;
  return def;
}

static bool make_defs(const Check *check) {
  Scene *scene = check->scene;
  scene->blocks = calloc((size_t)scene->fluid_count + 1, sizeof *scene->blocks);
  scene->solids = calloc((size_t)scene->obstacles_count + 1, sizeof *scene->solids);
  if (!scene->blocks || !scene->solids) return app_fail(check->source->error, APP_FAILED, "out of memory");
  for (int i = 0; i < scene->fluid_count; i++) scene->blocks[i] = make_block(&scene->fluid[i].block);
  for (int i = 0; i < scene->obstacles_count; i++) scene->solids[i] = make_solid(&scene->obstacles[i]);
  return true;
}

bool scene_complete(const SceneSource *source, const cJSON *root, Scene *scene) {
  Check check = {source, root, scene};
  if (!check_container(&check) || !check_fluid(&check)) return false;
  place_camera(scene);
  if (distance(scene->camera.eye, scene->camera.target) <= 0)
    return fail_at(&check, "camera", "eye and target must not be the same point");
  for (int i = 0; i < scene->events_count; i++)
    if (!complete_event(&check, i)) return false;
  return sort_events(&check) && make_defs(&check);
}
