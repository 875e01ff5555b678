// What no field can tell alone: boxes the right way round, water inside the container and not twice in one place, no
// more particles than fit, names that stand for something. Then what the rest of the program wants ready: sorted events,
// unit directions, a camera.
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

bool scene_fail_at(const SceneSource *source, const cJSON *root, const char *keys, const char *format, ...) {
  enum { LEVELS = 8 };
  ScenePath chain[LEVELS] = {{0}};
  char parts[SCENE_PATH_SIZE], message[400];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  snprintf(parts, sizeof parts, "%s", keys);
  const cJSON *here = root;
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
  return scene_fail(source, &chain[level], "%s", message);
}

#define fail_at(check, ...) scene_fail_at((check)->source, (check)->root, __VA_ARGS__)

static float distance(const float a[3], const float b[3]) {
  return sqrtf((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
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

static double block_count(const float min[3], const float max[3], float radius) {
  SimBlockDef block = {{min[0], min[1], min[2]}, {max[0], max[1], max[2]}, {0, 0, 0}, {0, 0, 0}};
  return sim_block_particles(&block, radius);
}

static bool too_many(const Check *check, const char *keys, double count) {
  return fail_at(check, keys, "would hold %.0f particles of radius %g m, more than the limit of %d", count,
                 (double)check->scene->simulation.particle_radius, SIM_MAX_PARTICLES);
}

/// A box with room for water, at least a part of it in the container.
static bool check_place(const Check *check, const char *keys, const float min[3], const float max[3]) {
  const SceneContainer *container = &check->scene->container;
  if (!check_box(check, keys, min, max)) return false;
  return overlap(min, max, container->min, container->max, 0) || fail_at(check, keys, "lies outside the container");
}

static bool check_block(const Check *check, const char *keys, const float min[3], const float max[3]) {
  if (!check_place(check, keys, min, max)) return false;
  double count = block_count(min, max, check->scene->simulation.particle_radius);
  return count <= SIM_MAX_PARTICLES || too_many(check, keys, count);
}

static void drop_box(const SceneDrop *drop, float min[3], float max[3]) {
  for (int i = 0; i < 3; i++) {
    min[i] = drop->centre[i] - drop->radius;
    max[i] = drop->centre[i] + drop->radius;
  }
}

/// By its volume.
static double drop_count(const SceneDrop *drop, float radius) {
  return fmax(1, rint(4.0 / 3 * 3.14159265358979323846 * pow(drop->radius / (2.0 * (double)radius), 3)));
}

static bool check_drop(const Check *check, const char *keys, const SceneDrop *drop) {
  float min[3], max[3];
  drop_box(drop, min, max);
  if (!check_place(check, keys, min, max)) return false;
  double count = drop_count(drop, check->scene->simulation.particle_radius);
  return count <= SIM_MAX_PARTICLES || too_many(check, keys, count);
}

static bool check_emitter(const Check *check, const char *keys, const SceneEmitter *emitter) {
  const SceneContainer *container = &check->scene->container;
  bool disc = emitter->shape == EMITTER_DISC;
  if (disc && isnan(emitter->diameter)) return fail_at(check, keys, "a disc needs a diameter");
  if (!disc && isnan(emitter->size[0])) return fail_at(check, keys, "a rectangle needs a size");
  if (emitter->stop <= emitter->start) return fail_at(check, keys, "stop must be later than start");
  // One that is carried may come in from outside.
  bool carried = emitter->obstacle.index >= 0 || *emitter->obstacle.name;
  for (int i = 0; i < 3 && !carried; i++)
    if (emitter->position[i] < container->min[i] || emitter->position[i] > container->max[i])
      return fail_at(check, keys, "lies outside the container");
  return true;
}

static bool check_waves(const Check *check, const char *keys, const SceneRipple *ripple) {
  char place[96];
  float spacing = 2 * check->scene->simulation.particle_radius;
  for (int i = 0; i < ripple->waves_count; i++) {
    const SceneWave *wave = &ripple->waves[i];
    snprintf(place, sizeof place, "%.40s.waves.%d.wavelength", keys, i);
    if (wave->wavelength < spacing)
      return fail_at(check, place, "must be at least 2 x particle_radius = %g m, got %g", (double)spacing,
                     (double)wave->wavelength);
    snprintf(place, sizeof place, "%.40s.waves.%d.direction", keys, i);
    if (!(hypotf(wave->direction[0], wave->direction[2]) > 1e-10f))
      return fail_at(check, place, "must not point straight up or down");
  }
  return true;
}

/// Without particles there is nothing for the rest of a scene's water to do.
static bool check_alone(const Check *check, const char *keys) {
  const Scene *scene = check->scene;
  char place[40];
  if (scene->fluid_count > 1) return fail_at(check, keys, "a ripple must be the only water of a scene");
  if (scene->sinks_count > 0) return fail_at(check, "sinks.0", "a ripple has no particles that it could swallow");
  for (int i = 0; i < scene->obstacles_count; i++) {
    snprintf(place, sizeof place, "obstacles.%d.motion", i);
    if (scene->obstacles[i].motion == MOTION_FLOATING)
      return fail_at(check, place, "nothing floats on a ripple: it has no particles to carry it");
  }
  for (int i = 0; i < scene->events_count; i++) {
    snprintf(place, sizeof place, "events.%d", i);
    if (scene->events[i].type == EVENT_POUR) return fail_at(check, place, "no water can be poured into a ripple");
  }
  return true;
}

static bool check_ripple(const Check *check, const char *keys, const SceneRipple *ripple) {
  const SceneContainer *container = &check->scene->container;
  double reach = 0, level = (double)ripple->level;
  if (!check_alone(check, keys) || !check_waves(check, keys, ripple)) return false;
  if (!(check->scene->simulation.gravity[1] < 0))
    return fail_at(check, "simulation.gravity", "must point downwards for a ripple");
  for (int i = 0; i < ripple->waves_count; i++) reach += (double)ripple->waves[i].amplitude;
  if (level - reach > (double)container->min[1] && level + reach < (double)container->max[1]) return true;
  return fail_at(check, keys, "its waves reach from %g to %g m, which must lie in the container, between %g and %g m",
                 level - reach, level + reach, (double)container->min[1], (double)container->max[1]);
}

static bool check_item(const Check *check, const char *keys, const SceneFluid *fluid) {
  switch ((SceneFluidType)fluid->type) {
  case FLUID_BLOCK:
    return check_block(check, keys, fluid->block.min, fluid->block.max);
  case FLUID_DROP:
    return check_drop(check, keys, &fluid->drop);
  case FLUID_EMITTER:
    return check_emitter(check, keys, &fluid->emitter);
  case FLUID_RIPPLE:
    return check_ripple(check, keys, &fluid->ripple);
  }
  return false;
}

/// Whether a ball reaches more than `tolerance` into a box.
static bool ball_overlaps_box(const SceneDrop *drop, const SceneBlock *block, float tolerance) {
  double square = 0;
  for (int i = 0; i < 3; i++) {
    double nearest = fmin(fmax(drop->centre[i], block->min[i]), block->max[i]);
    square += (nearest - drop->centre[i]) * (nearest - drop->centre[i]);
  }
  return sqrt(square) < drop->radius - tolerance;
}

static bool items_overlap(const SceneFluid *a, const SceneFluid *b, float tolerance) {
  if (a->type == FLUID_EMITTER || b->type == FLUID_EMITTER) return false;
  if (a->type == FLUID_BLOCK && b->type == FLUID_BLOCK)
    return overlap(a->block.min, a->block.max, b->block.min, b->block.max, tolerance);
  if (a->type == FLUID_DROP && b->type == FLUID_DROP)
    return distance(a->drop.centre, b->drop.centre) < a->drop.radius + b->drop.radius - tolerance;
  bool drop_first = a->type == FLUID_DROP;
  return ball_overlaps_box(drop_first ? &a->drop : &b->drop, drop_first ? &b->block : &a->block, tolerance);
}

static bool check_fluid(const Check *check) {
  const Scene *scene = check->scene;
  char keys[40];
  for (int i = 0; i < scene->fluid_count; i++) {
    snprintf(keys, sizeof keys, "fluid.%d", i);
    if (!check_item(check, keys, &scene->fluid[i])) return false;
  }
  int64_t count = scene_particle_count(scene);
  if (count > SIM_MAX_PARTICLES) return too_many(check, "fluid", (double)count);
  // Water may touch. A tenth of a spacing does no harm; more would burst apart in the first step.
  float tolerance = 0.2f * scene->simulation.particle_radius;
  for (int i = 0; i < scene->fluid_count; i++)
    for (int k = 0; k < i; k++) {
      snprintf(keys, sizeof keys, "fluid.%d", i);
      if (items_overlap(&scene->fluid[i], &scene->fluid[k], tolerance))
        return fail_at(check, keys, "overlaps fluid.%d", k);
    }
  return true;
}

static bool check_sinks(const Check *check) {
  char keys[40];
  for (int i = 0; i < check->scene->sinks_count; i++) {
    snprintf(keys, sizeof keys, "sinks.%d", i);
    if (!check_place(check, keys, check->scene->sinks[i].min, check->scene->sinks[i].max)) return false;
  }
  return true;
}

int64_t scene_particle_count(const Scene *scene) {
  double count = 0;
  float radius = scene->simulation.particle_radius;
  for (int i = 0; i < scene->fluid_count; i++) {
    const SceneFluid *fluid = &scene->fluid[i];
    if (fluid->type == FLUID_BLOCK) count += block_count(fluid->block.min, fluid->block.max, radius);
    if (fluid->type == FLUID_DROP) count += drop_count(&fluid->drop, radius);
  }
  return (int64_t)fmin(count, 1e18);
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

// ---- Obstacles ------------------------------------------------------------------------------------------------------

static bool check_keys(const Check *check, const char *keys, const SceneObstacle *obstacle) {
  for (int i = 1; i < obstacle->keys_count; i++)
    if (!(obstacle->keys[i].time > obstacle->keys[i - 1].time)) {
      char place[64];
      snprintf(place, sizeof place, "%s.keys.%d.time", keys, i);
      return fail_at(check, place, "must be later than the key before it (%g s), got %g", obstacle->keys[i - 1].time,
                     obstacle->keys[i].time);
    }
  return true;
}

static bool check_obstacles(const Check *check) {
  for (int i = 0; i < check->scene->obstacles_count; i++) {
    const SceneObstacle *obstacle = &check->scene->obstacles[i];
    char keys[40];
    snprintf(keys, sizeof keys, "obstacles.%d", i);
    const float *stroke = obstacle->stroke;
    bool moves = obstacle->keys_count > 0 || stroke[0] != 0 || stroke[1] != 0 || stroke[2] != 0;
    bool scripted = obstacle->motion == MOTION_SCRIPTED;
    if (scripted && !moves) return fail_at(check, keys, "a scripted obstacle needs keys or a stroke");
    if (!scripted && moves) return fail_at(check, keys, "only a scripted obstacle has keys or a stroke");
    if (!check_keys(check, keys, obstacle)) return false;
    const SceneCapsule *capsule = &obstacle->capsule;
    if (obstacle->type == OBSTACLE_CAPSULE && capsule->height < 2 * capsule->radius)
      return fail_at(check, keys, "a capsule must be at least as high as two radii, got %g m and %g m",
                     (double)capsule->height, (double)capsule->radius);
  }
  return true;
}

// ---- Events ---------------------------------------------------------------------------------------------------------

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
  case EVENT_DRAG:
    return check->scene->obstacles[event->drag.obstacle.index].motion == MOTION_DRAGGABLE ||
           fail_at(check, keys, "obstacles.%d is not draggable", (int)event->drag.obstacle.index);
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

// ---- Liquid ---------------------------------------------------------------------------------------------------------

/// What the scene does not say of its liquid is that of its material; the key's choices are the renderer's, in their order.
static void take_material(const Check *check) {
  SceneRender *render = &check->scene->render;
  const RenderMaterial *material = render_material(render->material);
  const struct {
    const char *key;
    float *value;
    const float *of_material;
    size_t size;
  } keys[] = {
      {"absorption", render->absorption, material->absorption, sizeof material->absorption},
      {"scattering", render->scattering, material->scattering, sizeof material->scattering},
      {"reflectance", render->reflectance, material->reflectance, sizeof material->reflectance},
      {"refractive_index", &render->refractive_index, &material->refractive_index, sizeof(float)},
  };
  const cJSON *given = cJSON_GetObjectItemCaseSensitive(check->root, "render");
  for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
    if (!cJSON_HasObjectItem(given, keys[k].key)) memcpy(keys[k].value, keys[k].of_material, keys[k].size);
}

// ---- Palette --------------------------------------------------------------------------------------------------------

/// What the scene does not say of its colours is its palette's; the key's choices are the renderer's, in their order.
static void take_palette(Scene *scene) {
  SceneCartoon *cartoon = &scene->render.cartoon;
  const RenderNamedPalette *named = render_palette(cartoon->palette);
  const RenderPalette *p = &named->palette;
  const struct {
    float *value;
    const float *of_palette;
    int count;
  } keys[] = {{&cartoon->most_reflection, &named->most_reflection, 1},
              {&cartoon->most_transparency, &named->most_transparency, 1},
              {cartoon->dark, p->dark, 3},
              {cartoon->medium, p->medium, 3},
              {cartoon->bright, p->bright, 3},
              {cartoon->splash, p->splash[0], 3},
              {cartoon->splash_dark, p->splash[1], 3},
              {cartoon->ink, p->ink, 3},
              {cartoon->shade, p->shade, 3},
              {cartoon->sky_top, p->sky[0], 3},
              {cartoon->sky_middle, p->sky[1], 3},
              {cartoon->sky_low, p->sky[2], 3},
              {cartoon->floor, p->floor[0], 3},
              {cartoon->grout, p->floor[1], 3}};
  for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
    for (int i = 0; i < keys[k].count; i++)
      if (isnan(keys[k].value[i])) keys[k].value[i] = keys[k].of_palette[i];
}

bool scene_complete(const SceneSource *source, const cJSON *root, Scene *scene) {
  Check check = {source, root, scene};
  if (!check_container(&check) || !check_fluid(&check) || !check_sinks(&check) || !check_obstacles(&check))
    return false;
  if (!scene_resolve_names(source, root, scene)) return false;
  place_camera(scene);
  take_material(&check);
  take_palette(scene);
  if (distance(scene->camera.eye, scene->camera.target) <= 0)
    return fail_at(&check, "camera", "eye and target must not be the same point");
  for (int i = 0; i < scene->events_count; i++)
    if (!complete_event(&check, i)) return false;
  return sort_events(&check);
}
