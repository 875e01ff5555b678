#include "app/scene_table.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// ---- The table as data ----------------------------------------------------------------------------------------------

#define FIELD(S, type, key, unit, range, fallback, doc)                                                                \
  {SCENE_##type, #key, unit, range, fallback, doc, offsetof(S, key), 0, 0, NULL},
#define OBJECT(S, Struct, key, doc) {SCENE_OBJECT, #key, "", "", "{}", doc, offsetof(S, key), 0, 0, &object_##Struct},
#define LIST(S, Struct, key, limit, doc)                                                                               \
  {SCENE_LIST, #key, "", "", "[]", doc, offsetof(S, key), offsetof(S, key##_count), limit, &object_##Struct},
#define VARIANT(S, NAME, key, Struct, doc)                                                                             \
  {SCENE_VARIANT, #key, "", "", "{}", doc, offsetof(S, key), 0, 0, &object_##Struct},

#define TABLE_OF(S, TABLE)                                                                                             \
  static const SceneField fields_##S[] = {TABLE(FIELD, OBJECT, LIST, VARIANT, S)};                                     \
  static const SceneObject object_##S = {#S, sizeof(S), (int)(sizeof fields_##S / sizeof fields_##S[0]), fields_##S};
SCENE_STRUCTS(TABLE_OF)

static const SceneField fields_top[] = {SCENE_TOP(FIELD, OBJECT, LIST, VARIANT, Scene)};
const SceneObject scene_top = {"Scene", sizeof(Scene), (int)(sizeof fields_top / sizeof fields_top[0]), fields_top};

// ---- What the columns say -------------------------------------------------------------------------------------------

SceneInterval scene_interval(const SceneField *field) {
  const char *range = field->range;
  SceneInterval interval = {.low_open = *range == '('};
  char *end;
  interval.low = strtod(range + 1, &end);
  interval.high = strtod(end + 1, &end);
  interval.high_open = *end == ')';
  return interval;
}

bool scene_interval_has(const SceneInterval *interval, double value) {
  bool above = interval->low_open ? value > interval->low : value >= interval->low;
  bool below = interval->high_open ? value < interval->high : value <= interval->high;
  return above && below; // false for NaN
}

static void style_choices(SceneChoices *choices) {
  for (int32_t i = 0; i < render_style_count() && choices->count < SCENE_MOST_CHOICES; i++)
    choices->names[choices->count++] = render_style_name(i);
}

void scene_choices(const SceneField *field, SceneChoices *choices) {
  *choices = (SceneChoices){0};
  if (field->type == SCENE_STYLE) {
    style_choices(choices);
    return;
  }
  snprintf(choices->text, sizeof choices->text, "%s", field->range);
  for (char *rest = choices->text, *name; (name = strtok_r(rest, " |", &rest));)
    choices->names[choices->count++] = name;
}

void scene_choices_list(const SceneChoices *choices, char *list, size_t size) {
  size_t used = 0;
  *list = 0;
  for (int i = 0; i < choices->count && used < size; i++)
    used += (size_t)snprintf(list + used, size - used, "%s%s", i ? ", " : "", choices->names[i]);
}

const SceneField *scene_field_find(const SceneObject *object, const char *key) {
  for (int i = 0; i < object->field_count; i++) {
    const SceneField *field = &object->fields[i];
    const SceneField *found = field->type == SCENE_VARIANT ? scene_field_find(field->object, key) : NULL;
    if (field->type != SCENE_VARIANT && strcmp(field->key, key) == 0) found = field;
    if (found) return found;
  }
  return NULL;
}

bool scene_is_variant(const SceneObject *object, const SceneField *field, int32_t type) {
  SceneChoices choices;
  scene_choices(&object->fields[0], &choices); // "type" is the first row of an object with variants
  return type >= 0 && type < choices.count && strcmp(choices.names[type], field->key) == 0;
}

bool scene_type_is_text(SceneType type) {
  return type == SCENE_TEXT || type == SCENE_CHOICE || type == SCENE_STYLE;
}
