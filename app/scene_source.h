// The text behind a scene: strict JSON, and where in it a value stands, so that every message can name the line.
#ifndef LIDO_APP_SCENE_SOURCE_H
#define LIDO_APP_SCENE_SOURCE_H

#include <stdbool.h>
#include <stddef.h>

#include "app/app.h"

struct cJSON;

enum {
  SCENE_MOST_BYTES = 16 * 1024 * 1024, ///< of a scene file
  SCENE_MOST_VALUES = 1000000,         ///< numbers, strings … in it
  SCENE_MOST_LEVELS = 64,              ///< of objects and lists inside each other
  SCENE_PATH_SIZE = 256                ///< bytes of a printed key path
};

/// What messages are about: the text, the changes that came from the command line, and where the message goes.
typedef struct SceneSource {
  const char *name;                    ///< of the file
  const char *text;                    ///< (size), the byte order mark left out
  size_t size;
  const char *const *sets;             ///< (set_count) "key.path=value"
  int set_count;
  AppError *error;
} SceneSource;

/// The way from the scene down to a value, as a chain on the stack.
typedef struct ScenePath {
  const struct ScenePath *parent;      ///< NULL: this is the scene itself
  const char *key;                     ///< NULL for an item of a list
  int ordinal;                         ///< its place among its siblings in the file; −1: not in the file
} ScenePath;

/// "fluid.0.min.1"
char *scene_path_print(const ScenePath *path, char *text, size_t size);

/// Fill source->error with "PLACE: PATH: …" and return false. PLACE is the file and line of the value (or of what it is
/// missing in), or the --set that it came from.
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
bool scene_fail(const SceneSource *source, const ScenePath *path, const char *format, ...);

/// Check the text: valid JSON (RFC 8259) and nothing after it, UTF-8, not too deep, not too much.
bool scene_check_syntax(const SceneSource *source);
/// Whether the text is one valid JSON value.
bool scene_is_json(const char *text, size_t size);

/// Line (from 1) of the value that the chain leads to, or of the last part of it that is in the text.
int scene_locate(const char *text, size_t size, const ScenePath *path);

/// Change the tree by one "key.path=value". Missing parts of the path are made.
bool scene_apply_set(const SceneSource *source, struct cJSON *root, const char *set);

#endif
