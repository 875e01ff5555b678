// The field table of scene_fields.h as data, for those who walk it: parser, printer, schema, reference.
#ifndef LIDO_APP_SCENE_TABLE_H
#define LIDO_APP_SCENE_TABLE_H

#include "app/scene.h"
#include "app/text.h"

typedef enum SceneType {
  SCENE_NUMBER,
  SCENE_REAL,
  SCENE_INTEGER,
  SCENE_SEED,
  SCENE_SWITCH,
  SCENE_TEXT,
  SCENE_CHOICE,
  SCENE_STYLE,
  SCENE_VECTOR,
  SCENE_DIRECTION,
  SCENE_OPTIONAL,
  SCENE_OPTIONAL_REAL,
  SCENE_OPTIONAL_PAIR,
  SCENE_OPTIONAL_VECTOR,
  SCENE_REFERENCE,
  SCENE_OBJECT,  ///< `object` says what is in it
  SCENE_LIST,    ///< of `object`s
  SCENE_VARIANT  ///< fields of the same JSON object, there when its "type" is `key`
} SceneType;

typedef struct SceneField {
  SceneType type;
  const char *key, *unit, *range;
  const char *fallback;             ///< JSON text of the default; NULL: the key is required
  const char *doc;
  size_t offset, count_offset;      ///< of the member, and of its count (lists only)
  int limit;                        ///< most items (lists only)
  const struct SceneObject *object;
} SceneField;

typedef struct SceneObject {
  const char *name;                 ///< of its struct
  size_t size;
  int field_count;
  const SceneField *fields;
} SceneObject;

extern const SceneObject scene_top;

/// A range such as "(0, 1]".
typedef struct SceneInterval {
  double low, high;
  bool low_open, high_open;
} SceneInterval;
SceneInterval scene_interval(const SceneField *field);
bool scene_interval_has(const SceneInterval *interval, double value);

/// Names that a CHOICE or STYLE takes.
enum { SCENE_MOST_CHOICES = 16 };
typedef struct SceneChoices {
  char text[256];                        ///< what the names of a CHOICE point into
  int count;
  const char *names[SCENE_MOST_CHOICES];
} SceneChoices;
void scene_choices(const SceneField *field, SceneChoices *choices);
/// "a, b, c"
void scene_choices_list(const SceneChoices *choices, char *list, size_t size);

/// The field of `object` that has this key, its variants' fields included; NULL: none.
const SceneField *scene_field_find(const SceneObject *object, const char *key);

/// Whether an item of the type with this number has the fields of `field`, a row of kind SCENE_VARIANT.
bool scene_is_variant(const SceneObject *object, const SceneField *field, int32_t type);

/// True for the types whose JSON is a string.
bool scene_type_is_text(SceneType type);

#endif
