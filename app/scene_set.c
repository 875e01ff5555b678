// --set key.path=value: changes of the tree before it is checked, so that they are checked like the file itself.
#include <cjson/cJSON.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/scene_source.h"
#include "app/scene_table.h"

enum { LONGEST_PATH = 200 };

/// One change, on its way down the tree.
typedef struct Change {
  const SceneSource *source;
  const char *set;           // as given
  char printable[220];       // the same, fit for a message
  const char *value;         // behind the '='
  const SceneObject *object; // of the table, where we are; NULL: the table does not know this place
  const SceneField *field;   // of the value reached last; NULL alike
} Change;

static bool refuse(const Change *change, const char *cause, const char *detail) {
  return app_fail(change->source->error, APP_BAD_INPUT, "--set %s: %s%s", change->printable, cause, detail);
}

/// "7" → 7; −1 when the key is no index.
static long index_of(const char *key) {
  size_t digits = strspn(key, "0123456789");
  return *key && !key[digits] && digits < 8 ? strtol(key, NULL, 10) : -1;
}

/// Keep the place in the table in step with the place in the tree.
static void follow_table(Change *change, const char *key) {
  bool item = change->field && change->field->type == SCENE_LIST && index_of(key) >= 0;
  if (item) {
    change->object = change->field->object;
    change->field = NULL;
    return;
  }
  change->field = change->object ? scene_field_find(change->object, key) : NULL;
  bool inner = change->field && change->field->type == SCENE_OBJECT;
  change->object = inner ? change->field->object : NULL;
}

/// The value to put in: JSON if it is JSON, else a string without its quotes. A key of a string takes any.
static cJSON *make_value(const Change *change) {
  size_t size = strlen(change->value);
  bool text = change->field && scene_type_is_text(change->field->type);
  cJSON *value = scene_is_json(change->value, size) ? cJSON_ParseWithLength(change->value, size) : NULL;
  if (value && (!text || cJSON_IsString(value))) return value;
  cJSON_Delete(value);
  return cJSON_CreateString(change->value);
}

/// What stands for a part of the path that the file does not have: its default, so that one item of it can be changed.
static cJSON *make_part(const Change *change, const char *next) {
  const char *fallback = change->field ? change->field->fallback : NULL;
  cJSON *part = fallback ? cJSON_Parse(fallback) : NULL;
  if (part && (cJSON_IsObject(part) || cJSON_IsArray(part))) return part;
  cJSON_Delete(part);
  return index_of(next) >= 0 ? cJSON_CreateArray() : cJSON_CreateObject();
}

/// Takes the value over, whatever comes of it.
static bool put(cJSON *parent, const char *key, cJSON *old, cJSON *value) {
  bool list = cJSON_IsArray(parent), done = false;
  if (value && old)
    done = list ? cJSON_ReplaceItemViaPointer(parent, old, value)
                : cJSON_ReplaceItemInObjectCaseSensitive(parent, key, value);
  else if (value)
    done = list ? cJSON_AddItemToArray(parent, value) : cJSON_AddItemToObject(parent, key, value);
  if (!done) cJSON_Delete(value);
  return done;
}

/// The child of `parent` that `key` names; *exists false when it may be made. false: it cannot be there.
static bool find_child(const Change *change, const cJSON *parent, const char *key, cJSON **child) {
  *child = NULL;
  if (cJSON_IsObject(parent)) {
    *child = cJSON_GetObjectItemCaseSensitive(parent, key);
    return true;
  }
  char printable[80];
  text_printable(printable, sizeof printable, key, 40);
  if (!cJSON_IsArray(parent)) return refuse(change, "there is nothing inside a single value to set: ", printable);
  long index = index_of(key);
  if (index < 0) return refuse(change, "a list needs an index (0, 1, 2 ...), got ", printable);
  int count = cJSON_GetArraySize(parent);
  if (index > count) {
    char detail[80];
    snprintf(detail, sizeof detail, "the list has %d items, the next would be %d", count, count);
    return refuse(change, detail, "");
  }
  *child = cJSON_GetArrayItem(parent, (int)index);
  return true;
}

static bool change_tree(Change *change, cJSON *root, char *path) {
  cJSON *here = root;
  for (char *key = path, *next; key; key = next) {
    next = strchr(key, '.');
    if (next) *next++ = 0;
    if (!*key) return refuse(change, "an empty key in the path", "");
    cJSON *child;
    if (!find_child(change, here, key, &child)) return false;
    follow_table(change, key);
    if (!next || !child) {
      cJSON *value = next ? make_part(change, next) : make_value(change);
      if (!put(here, key, child, value)) return app_fail(change->source->error, APP_FAILED, "out of memory");
      child = value;
    }
    here = child;
  }
  return true;
}

bool scene_apply_set(const SceneSource *source, cJSON *root, const char *set) {
  Change change = {.source = source, .set = set, .object = &scene_top};
  text_printable(change.printable, sizeof change.printable, set, 120);
  const char *equals = strchr(set, '=');
  size_t length = equals ? (size_t)(equals - set) : 0;
  if (length == 0) return refuse(&change, "must have the form key.path=value", "");
  if (length >= LONGEST_PATH) return refuse(&change, "the key path is too long", "");
  for (const char *c = set; *c; c += text_utf8_length(c, strlen(c)))
    if (!text_utf8_length(c, strlen(c))) return refuse(&change, "is not UTF-8", "");
  change.value = equals + 1;
  char path[LONGEST_PATH];
  memcpy(path, set, length);
  path[length] = 0;
  return change_tree(&change, root, path);
}
