// A scene as JSON with every value in it, from the field table. Numbers are the shortest that read back the same.
#include <string.h>

#include "app/scene_table.h"

static void print_object(Text *text, const SceneObject *object, const char *members, int depth);

static void indent(Text *text, int depth) {
  text_format(text, "\n%*s", 2 * depth, "");
}

static void print_numbers(Text *text, const float *v, int count) {
  if (v[0] != v[0]) {
    text_add(text, "null");
    return;
  }
  for (int i = 0; i < count; i++) {
    text_add(text, i ? ", " : "[");
    text_add_float(text, v[i]);
  }
  text_add(text, "]");
}

static void print_choice(Text *text, const SceneField *field, int32_t number) {
  SceneChoices choices;
  scene_choices(field, &choices);
  text_add_json_string(text, choices.names[number]);
}

static void print_reference(Text *text, const SceneReference *reference) {
  if (*reference->name)
    text_add_json_string(text, reference->name);
  else if (reference->index < 0)
    text_add(text, "null");
  else
    text_format(text, "%d", (int)reference->index);
}

static void print_list(Text *text, const SceneField *field, const char *owner, int depth) {
  char *items;
  int32_t count;
  memcpy(&items, owner + field->offset, sizeof items);
  memcpy(&count, owner + field->count_offset, sizeof count);
  text_add(text, "[");
  for (int32_t i = 0; i < count; i++) {
    if (i) text_add(text, ",");
    indent(text, depth + 1);
    print_object(text, field->object, items + (size_t)i * field->object->size, depth + 1);
  }
  if (count) indent(text, depth);
  text_add(text, "]");
}

static void print_value(Text *text, const SceneField *field, const char *owner, int depth) {
  const void *member = owner + field->offset;
  switch (field->type) {
  case SCENE_NUMBER:
  case SCENE_OPTIONAL:
    text_add_float(text, *(const float *)member);
    break;
  case SCENE_REAL:
  case SCENE_OPTIONAL_REAL:
    text_add_double(text, *(const double *)member);
    break;
  case SCENE_INTEGER:
    text_format(text, "%d", (int)*(const int32_t *)member);
    break;
  case SCENE_SEED:
    text_format(text, "%llu", (unsigned long long)*(const uint64_t *)member);
    break;
  case SCENE_SWITCH:
    text_add(text, *(const bool *)member ? "true" : "false");
    break;
  case SCENE_TEXT:
  case SCENE_STYLE:
    text_add_json_string(text, member);
    break;
  case SCENE_CHOICE:
    print_choice(text, field, *(const int32_t *)member);
    break;
  case SCENE_VECTOR:
  case SCENE_DIRECTION:
  case SCENE_OPTIONAL_VECTOR:
    print_numbers(text, member, 3);
    break;
  case SCENE_OPTIONAL_PAIR:
    print_numbers(text, member, 2);
    break;
  case SCENE_REFERENCE:
    print_reference(text, member);
    break;
  case SCENE_OBJECT:
    print_object(text, field->object, member, depth);
    break;
  case SCENE_LIST:
    print_list(text, field, owner, depth);
    break;
  case SCENE_VARIANT:
    break; // print_fields goes into these
  }
}

static void print_fields(Text *text, const SceneObject *object, const char *members, int depth, int *printed) {
  for (int i = 0; i < object->field_count; i++) {
    const SceneField *field = &object->fields[i];
    if (field->type == SCENE_VARIANT) {
      // The type is the first member of an object with variants.
      if (scene_is_variant(object, field, *(const int32_t *)(members + object->fields[0].offset)))
        print_fields(text, field->object, members + field->offset, depth, printed);
      continue;
    }
    if ((*printed)++) text_add(text, ",");
    indent(text, depth);
    text_format(text, "\"%s\": ", field->key);
    print_value(text, field, members, depth);
  }
}

static void print_object(Text *text, const SceneObject *object, const char *members, int depth) {
  int printed = 0;
  text_add(text, "{");
  print_fields(text, object, members, depth + 1, &printed);
  indent(text, depth);
  text_add(text, "}");
}

char *scene_print(const Scene *scene) {
  Text text = {0};
  print_object(&text, &scene_top, (const char *)scene, 0);
  text_add(&text, "\n");
  return text_take(&text);
}
