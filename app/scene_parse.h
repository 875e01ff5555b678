// From a JSON tree to a scene, one field of the table after the other, and what must hold between fields.
#ifndef LIDO_APP_SCENE_PARSE_H
#define LIDO_APP_SCENE_PARSE_H

#include "app/scene_source.h"
#include "app/scene_table.h"

struct cJSON;

/// Fill the scene from the tree: known keys, right types, in range, defaults for the rest.
bool scene_parse(const SceneSource *source, const struct cJSON *root, Scene *scene);

/// Check what no field can tell alone (boxes, overlaps, number of particles, names), then complete the scene: sorted
/// events, unit directions, a camera.
bool scene_complete(const SceneSource *source, const struct cJSON *root, Scene *scene);

/// Find out which items references mean (scene_names.c): every name stands for one item, every place for a fitting one.
bool scene_resolve_names(const SceneSource *source, const struct cJSON *root, Scene *scene);

/// Make what the simulation reads (scene_def.c): scene->defs. Reads the files of meshes.
bool scene_defs_make(const SceneSource *source, const struct cJSON *root, Scene *scene);
void scene_defs_free(Scene *scene);

/// Fail at a key path given as text, "fluid.0.min": its place in the file is looked up in the tree.
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
bool scene_fail_at(const SceneSource *source, const struct cJSON *root, const char *keys, const char *format, ...);

/// The message for a scene that scene_find does not find.
bool scene_fail_not_found(const char *name, AppError *error);

#endif
