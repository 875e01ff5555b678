#include "app/scene_parse.h"

#include <cjson/cJSON.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// A value on its way into the scene.
typedef struct Value {
  const SceneSource *source;
  const ScenePath *path;
  const SceneField *field;
  const cJSON *json;
} Value;

// ---- Messages -------------------------------------------------------------------------------------------------------

/// What stands there, in a few words.
static const char *got(const cJSON *json, char *text, size_t size) {
  char printable[64];
  if (cJSON_IsNumber(json))
    snprintf(text, size, "%.9g", json->valuedouble);
  else if (cJSON_IsString(json))
    snprintf(text, size, "\"%s\"", text_printable(printable, sizeof printable, json->valuestring, 40));
  else
    snprintf(text, size, "%s",
             cJSON_IsBool(json)    ? cJSON_IsTrue(json) ? "true" : "false"
             : cJSON_IsNull(json)  ? "null"
             : cJSON_IsArray(json) ? "a list"
                                   : "an object");
  return text;
}

static bool must_be(const Value *value, const char *what) {
  char text[80];
  return scene_fail(value->source, value->path, "must be %s, got %s", what, got(value->json, text, sizeof text));
}

static bool must_be_in_range(const Value *value, const char *what) {
  char text[120];
  const SceneField *field = value->field;
  snprintf(text, sizeof text, "%sin %s%s%s", what, field->range, *field->unit ? " " : "", field->unit);
  return must_be(value, text);
}

// ---- Single values: each reader writes the member or fails with a message -------------------------------------------

static bool read_real(const Value *value, double *member) {
  if (!cJSON_IsNumber(value->json)) return must_be_in_range(value, "a number ");
  SceneInterval interval = scene_interval(value->field);
  double number = value->json->valuedouble;
  if (!scene_interval_has(&interval, number)) return must_be_in_range(value, "");
  *member = number;
  return true;
}

static bool read_number(const Value *value, float *member) {
  double number = 0;
  if (!read_real(value, &number)) return false;
  *member = (float)number;
  // An open end of the range must not be met by rounding.
  SceneInterval interval = scene_interval(value->field);
  if (interval.low_open && (double)*member <= interval.low) return must_be_in_range(value, "");
  if (interval.high_open && (double)*member >= interval.high) return must_be_in_range(value, "");
  return true;
}

static bool read_whole(const Value *value, double *member) {
  const SceneField *field = value->field;
  SceneInterval interval = scene_interval(field);
  double number = cJSON_IsNumber(value->json) ? value->json->valuedouble : NAN;
  bool whole = number == floor(number) && isfinite(number);
  if (!whole) return must_be_in_range(value, "a whole number ");
  if (interval.low == interval.high && number != interval.low) {
    char text[40];
    snprintf(text, sizeof text, "%.0f", interval.low);
    return must_be(value, text);
  }
  if (!scene_interval_has(&interval, number)) return must_be_in_range(value, "");
  *member = number;
  return true;
}

static bool read_text(const Value *value, char *member) {
  if (!cJSON_IsString(value->json)) return must_be(value, "a string");
  size_t length = strlen(value->json->valuestring);
  if (length >= SCENE_TEXT_SIZE)
    return scene_fail(value->source, value->path, "must have at most %d bytes, got %zu", SCENE_TEXT_SIZE - 1, length);
  memcpy(member, value->json->valuestring, length + 1);
  return true;
}

static int refuse_name(const Value *value, const SceneChoices *choices, const char *list, const char *name) {
  const char *nearest = name ? text_nearest(name, choices->names, choices->count) : NULL;
  char text[300], given[80];
  snprintf(text, sizeof text, choices->count > 1 ? "one of %s" : "\"%s\"", list);
  if (!nearest)
    must_be(value, text);
  else
    scene_fail(value->source, value->path, "must be %s, got %s, did you mean \"%s\"?", text,
               got(value->json, given, sizeof given), nearest);
  return -1;
}

/// The place of the value among the names of its field; −1 and a message when it is none of them.
static int read_name(const Value *value) {
  SceneChoices choices;
  scene_choices(value->field, &choices);
  char list[256];
  scene_choices_list(&choices, list, sizeof list);
  const char *name = cJSON_IsString(value->json) ? value->json->valuestring : NULL;
  for (int i = 0; name && i < choices.count; i++)
    if (strcmp(name, choices.names[i]) == 0) return i;
  return refuse_name(value, &choices, list, name);
}

static bool read_numbers(const Value *value, float *member, int count) {
  char text[80];
  snprintf(text, sizeof text, "a list of %s numbers", count == 2 ? "two" : "three");
  if (!cJSON_IsArray(value->json)) return must_be(value, text);
  if (cJSON_GetArraySize(value->json) != count)
    return scene_fail(value->source, value->path, "must be %s, got %d items", text, cJSON_GetArraySize(value->json));
  int i = 0;
  const cJSON *item;
  cJSON_ArrayForEach(item, value->json) {
    ScenePath path = {.parent = value->path, .ordinal = i};
    Value part = {value->source, &path, value->field, item};
    if (!read_number(&part, &member[i++])) return false;
  }
  return true;
}

static bool read_direction(const Value *value, float *member) {
  if (!read_numbers(value, member, 3)) return false;
  // Its square must not vanish in single precision either.
  float square = member[0] * member[0] + member[1] * member[1] + member[2] * member[2];
  return square >= 1e-20f || scene_fail(value->source, value->path, "must not be the zero vector");
}

/// Fill with NANs, then read unless it is null.
static bool read_optional(const Value *value, float *member, int count) {
  for (int i = 0; i < count; i++) member[i] = NAN;
  if (cJSON_IsNull(value->json)) return true;
  return count == 1 ? read_number(value, member) : read_numbers(value, member, count);
}

/// What a name stands for is looked up when all items are known (scene_complete.c).
static bool read_reference(const Value *value, SceneReference *member) {
  *member = (SceneReference){.index = -1};
  if (cJSON_IsNull(value->json) && value->field->fallback) return true;
  if (cJSON_IsString(value->json) && *value->json->valuestring) return read_text(value, member->name);
  double place = cJSON_IsNumber(value->json) ? value->json->valuedouble : -1;
  if (!(place >= 0 && place <= INT32_MAX && place == floor(place)))
    return must_be(value, "a name or a whole number that is not negative");
  member->index = (int32_t)place;
  return true;
}

static bool read_value(const Value *value, void *member) {
  double number = 0;
  switch (value->field->type) {
  case SCENE_NUMBER:
    return read_number(value, member);
  case SCENE_REAL:
    return read_real(value, member);
  case SCENE_INTEGER:
    if (!read_whole(value, &number)) return false;
    *(int32_t *)member = (int32_t)number;
    return true;
  case SCENE_SEED:
    if (!read_whole(value, &number)) return false;
    *(uint64_t *)member = (uint64_t)number;
    return true;
  case SCENE_SWITCH:
    if (!cJSON_IsBool(value->json)) return must_be(value, "true or false");
    *(bool *)member = cJSON_IsTrue(value->json);
    return true;
  case SCENE_TEXT:
    return read_text(value, member);
  case SCENE_CHOICE:
    return (*(int32_t *)member = read_name(value)) >= 0;
  case SCENE_STYLE:
    return read_name(value) >= 0 && read_text(value, member);
  case SCENE_VECTOR:
    return read_numbers(value, member, 3);
  case SCENE_DIRECTION:
    return read_direction(value, member);
  case SCENE_OPTIONAL:
    return read_optional(value, member, 1);
  case SCENE_OPTIONAL_PAIR:
    return read_optional(value, member, 2);
  case SCENE_OPTIONAL_VECTOR:
    return read_optional(value, member, 3);
  case SCENE_OPTIONAL_REAL:
    *(double *)member = NAN;
    return cJSON_IsNull(value->json) || read_real(value, member);
  case SCENE_REFERENCE:
    return read_reference(value, member);
  default:
    return false; // objects have readers of their own
  }
}

// ---- Objects and lists ----------------------------------------------------------------------------------------------

static bool read_object(const Value *value, const SceneObject *object, char *members);

/// Whether the object takes this key, and if so which of its fields it is for.
static const SceneField *known_key(const SceneObject *object, int32_t variant, const char *key) {
  for (int i = 0; i < object->field_count; i++) {
    const SceneField *field = &object->fields[i];
    if (field->type == SCENE_VARIANT) {
      if (!scene_is_variant(object, field, variant)) continue;
      const SceneField *inner = scene_field_find(field->object, key);
      if (inner) return inner;
    } else if (strcmp(field->key, key) == 0) {
      return field;
    }
  }
  return NULL;
}

static bool unknown_key(const Value *value, const SceneObject *object, int32_t variant, const char *key, int ordinal) {
  ScenePath path = {value->path, key, ordinal};
  const char *names[64];
  int count = 0;
  for (int i = 0; i < object->field_count; i++) {
    const SceneField *field = &object->fields[i];
    if (field->type != SCENE_VARIANT)
      names[count++] = field->key;
    else if (scene_is_variant(object, field, variant))
      for (int k = 0; k < field->object->field_count; k++) names[count++] = field->object->fields[k].key;
  }
  const char *nearest = text_nearest(key, names, count);
  if (nearest) return scene_fail(value->source, &path, "unknown key, did you mean \"%s\"?", nearest);
  return scene_fail(value->source, &path, "unknown key");
}

/// Every key must be known and stand there once. The number of rows looked at is bounded, however long the object is.
static bool check_keys(const Value *value, const SceneObject *object, int32_t variant) {
  const SceneField *seen[64];
  int count = 0;
  const cJSON *child;
  cJSON_ArrayForEach(child, value->json) {
    const SceneField *field = known_key(object, variant, child->string);
    if (!field) return unknown_key(value, object, variant, child->string, count);
    for (int i = 0; i < count; i++) {
      ScenePath path = {value->path, child->string, count};
      if (seen[i] == field) return scene_fail(value->source, &path, "stands here twice");
    }
    seen[count++] = field;
  }
  return true;
}

/// The JSON of a field, from the file or else from the default; *ordinal is −1 for the latter.
static const cJSON *find_json(const cJSON *object, const SceneField *field, cJSON **made, int *ordinal) {
  const cJSON *child;
  *made = NULL;
  *ordinal = 0;
  cJSON_ArrayForEach(child, object) {
    if (strcmp(child->string, field->key) == 0) return child;
    ++*ordinal;
  }
  *ordinal = -1;
  return field->fallback ? *made = cJSON_Parse(field->fallback) : NULL;
}

static bool read_list(const Value *value, char *owner) {
  const SceneField *field = value->field;
  if (!cJSON_IsArray(value->json)) return must_be(value, "a list of objects");
  int count = cJSON_GetArraySize(value->json);
  if (count > field->limit)
    return scene_fail(value->source, value->path, "must have at most %d items, got %d", field->limit, count);
  char *items = calloc((size_t)count + 1, field->object->size);
  if (!items) return app_fail(value->source->error, APP_FAILED, "out of memory");
  memcpy(owner + field->offset, &items, sizeof items);
  memcpy(owner + field->count_offset, &(int32_t){count}, sizeof(int32_t));
  int i = 0;
  const cJSON *json;
  cJSON_ArrayForEach(json, value->json) {
    ScenePath path = {.parent = value->path, .ordinal = i};
    Value item = {value->source, &path, field, json};
    if (!read_object(&item, field->object, items + (size_t)i * field->object->size)) return false;
    i++;
  }
  return true;
}

static bool read_field(const Value *owner, const SceneField *field, char *members) {
  cJSON *made;
  int ordinal;
  const cJSON *json = find_json(owner->json, field, &made, &ordinal);
  ScenePath path = {owner->path, field->key, ordinal};
  Value value = {owner->source, &path, field, json};
  bool good;
  if (!json && field->fallback)
    good = app_fail(owner->source->error, APP_FAILED, "out of memory");
  else if (!json)
    good = scene_fail(owner->source, &path, "is missing");
  else if (field->type == SCENE_OBJECT)
    good = read_object(&value, field->object, members + field->offset);
  else if (field->type == SCENE_LIST)
    good = read_list(&value, members);
  else
    good = read_value(&value, members + field->offset);
  cJSON_Delete(made);
  return good;
}

static bool read_fields(const Value *value, const SceneObject *object, char *members, int first, int32_t variant) {
  for (int i = first; i < object->field_count; i++) {
    const SceneField *field = &object->fields[i];
    if (field->type == SCENE_VARIANT) {
      if (!scene_is_variant(object, field, variant)) continue;
      if (!read_fields(value, field->object, members + field->offset, 0, -1)) return false;
    } else if (!read_field(value, field, members)) {
      return false;
    }
  }
  return true;
}

static bool read_object(const Value *value, const SceneObject *object, char *members) {
  if (!cJSON_IsObject(value->json)) return must_be(value, "an object");
  // The first field decides what the rest means: the version of a scene, the type of an item.
  bool typed = object->fields[object->field_count - 1].type == SCENE_VARIANT;
  bool decides = typed || object == &scene_top;
  if (decides && !read_field(value, &object->fields[0], members)) return false;
  int32_t variant = typed ? *(int32_t *)(members + object->fields[0].offset) : -1;
  return check_keys(value, object, variant) && read_fields(value, object, members, decides ? 1 : 0, variant);
}

bool scene_parse(const SceneSource *source, const cJSON *root, Scene *scene) {
  ScenePath path = {0};
  Value value = {source, &path, NULL, root};
  return read_object(&value, &scene_top, (char *)scene);
}
