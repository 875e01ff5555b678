// Names of obstacles and emitters: each stands for one item, and what refers to it by name or place finds it.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/scene_parse.h"

/// A list whose items can be called by name.
typedef struct Names {
  const SceneSource *source;
  const struct cJSON *root;
  const char *list, *kind; // "obstacles", "obstacle"
  const char **names;      // (count): empty where an item has none, NULL where it cannot be meant
  int count;
} Names;

static bool check_unique(const Names *names) {
  for (int i = 0; i < names->count; i++)
    for (int k = 0; names->names[i] && *names->names[i] && k < i; k++)
      if (names->names[k] && strcmp(names->names[i], names->names[k]) == 0) {
        char keys[40];
        snprintf(keys, sizeof keys, "%s.%d.name", names->list, i);
        return scene_fail_at(names->source, names->root, keys, "is also the name of %s.%d", names->list, k);
      }
  return true;
}

static bool refuse_name(const Names *names, const char *keys, const char *name) {
  char given[80], other[80] = "";
  const char **known = calloc((size_t)names->count + 1, sizeof *known);
  if (!known) return app_fail(names->source->error, APP_FAILED, "out of memory");
  int count = 0;
  for (int i = 0; i < names->count; i++)
    if (names->names[i] && *names->names[i]) known[count++] = names->names[i];
  const char *nearest = text_nearest(name, known, count);
  if (nearest) text_printable(other, sizeof other, nearest, 60);
  free(known);
  text_printable(given, sizeof given, name, 60);
  if (*other)
    return scene_fail_at(names->source, names->root, keys, "no %s is called \"%s\", did you mean \"%s\"?", names->kind,
                         given, other);
  return scene_fail_at(names->source, names->root, keys, "no %s is called \"%s\"", names->kind, given);
}

static bool resolve(const Names *names, const char *keys, SceneReference *reference) {
  if (*reference->name) {
    for (int i = 0; i < names->count; i++)
      if (names->names[i] && strcmp(names->names[i], reference->name) == 0) {
        reference->index = i;
        return true;
      }
    return refuse_name(names, keys, reference->name);
  }
  if (reference->index < 0) return true;
  if (reference->index >= names->count)
    return scene_fail_at(names->source, names->root, keys, "there is no %s.%d, the list has %d items", names->list,
                         (int)reference->index, names->count);
  return names->names[reference->index] || scene_fail_at(names->source, names->root, keys, "%s.%d is no %s",
                                                         names->list, (int)reference->index, names->kind);
}

static bool resolve_all(const Names *obstacles, const Names *emitters, Scene *scene) {
  char keys[40];
  if (!check_unique(obstacles) || !check_unique(emitters)) return false;
  for (int i = 0; i < scene->fluid_count; i++) {
    snprintf(keys, sizeof keys, "fluid.%d.obstacle", i);
    if (scene->fluid[i].type == FLUID_EMITTER && !resolve(obstacles, keys, &scene->fluid[i].emitter.obstacle))
      return false;
  }
  for (int i = 0; i < scene->events_count; i++) {
    SceneEvent *event = &scene->events[i];
    snprintf(keys, sizeof keys, "events.%d.%s", i, event->type == EVENT_DRAG ? "obstacle" : "emitter");
    if (event->type == EVENT_DRAG && !resolve(obstacles, keys, &event->drag.obstacle)) return false;
    if (event->type == EVENT_EMITTER && !resolve(emitters, keys, &event->emitter.emitter)) return false;
  }
  return true;
}

bool scene_resolve_names(const SceneSource *source, const struct cJSON *root, Scene *scene) {
  Names obstacles = {source, root, "obstacles", "obstacle", NULL, scene->obstacles_count};
  Names emitters = {source, root, "fluid", "emitter", NULL, scene->fluid_count};
  obstacles.names = calloc((size_t)obstacles.count + 1, sizeof *obstacles.names);
  emitters.names = calloc((size_t)emitters.count + 1, sizeof *emitters.names);
  bool good = obstacles.names && emitters.names;
  if (!good) app_fail(source->error, APP_FAILED, "out of memory");
  for (int i = 0; good && i < obstacles.count; i++) obstacles.names[i] = scene->obstacles[i].name;
  for (int i = 0; good && i < emitters.count; i++)
    if (scene->fluid[i].type == FLUID_EMITTER) emitters.names[i] = scene->fluid[i].emitter.name;
  good = good && resolve_all(&obstacles, &emitters, scene);
  free(obstacles.names);
  free(emitters.names);
  return good;
}
