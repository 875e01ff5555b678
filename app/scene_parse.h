// From a JSON tree to a scene, one field of the table after the other, and what must hold between fields.
#ifndef LIDO_APP_SCENE_PARSE_H
#define LIDO_APP_SCENE_PARSE_H

#include "app/scene_source.h"
#include "app/scene_table.h"

struct cJSON;

/// Fill the scene from the tree: known keys, right types, in range, defaults for the rest.
bool scene_parse(const SceneSource *source, const struct cJSON *root, Scene *scene);

/// Check what no field can tell alone (boxes, overlaps, number of particles), then complete the scene: sorted events,
/// unit directions, a camera, and the arrays that the simulation reads.
bool scene_complete(const SceneSource *source, const struct cJSON *root, Scene *scene);

/// The message for a scene that scene_find does not find.
bool scene_fail_not_found(const char *name, AppError *error);

#endif
