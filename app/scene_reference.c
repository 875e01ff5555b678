// docs/scene.md: every key of a scene in tables, from the field table.
#include <stdio.h>
#include <string.h>

#include "app/scene_table.h"

static const char introduction[] =
    "# Scenes\n"
    "\n"
    "<!-- Made by: lido check --reference > docs/scene.md. Edit app/scene_fields.h instead. -->\n"
    "\n"
    "A scene is a JSON file. Lengths are in metres, y points up, colours are linear light. Only keys without a "
    "default\n"
    "must be given; unknown keys are errors. `lido check SCENE` prints a scene with every default filled in, and\n"
    "`--set key.path=value` changes any key from the command line: `--set simulation.cfl=0.3`,\n"
    "`--set fluid.0.velocity=[1,0,0]`, `--set render.style=points`. An obstacle or emitter is called by its `name` or "
    "by\n"
    "its place in the list, from 0.\n"
    "[scene.schema.json](../configs/scene.schema.json) lets an editor complete and check scenes.\n"
    "\n"
    "```json\n"
    "{\n"
    "  \"version\": 1,\n"
    "  \"container\": {\"min\": [0, 0, 0], \"max\": [2, 1, 1]},\n"
    "  \"fluid\": [{\"type\": \"block\", \"min\": [0, 0, 0], \"max\": [0.5, 0.8, 1]}],\n"
    "  \"obstacles\": [{\"type\": \"sphere\", \"radius\": 0.15, \"position\": [1.3, 0.15, 0.5]},\n"
    "                {\"type\": \"box\", \"size\": [0.2, 0.1, 0.2], \"position\": [1.3, 0.6, 0.5], \"motion\": "
    "\"floating\"}],\n"
    "  \"events\": [{\"type\": \"tilt\", \"time\": 2, \"duration\": 1, \"gravity\": [3, -9.3, 0]}]\n"
    "}\n"
    "```\n";

static const char *type_name(const SceneField *field) {
  switch (field->type) {
  case SCENE_NUMBER:
  case SCENE_REAL:
    return "number";
  case SCENE_INTEGER:
  case SCENE_SEED:
    return "whole number";
  case SCENE_SWITCH:
    return "true or false";
  case SCENE_TEXT:
    return "string";
  case SCENE_CHOICE:
  case SCENE_STYLE:
    return "one of";
  case SCENE_VECTOR:
  case SCENE_DIRECTION:
    return "3 numbers";
  case SCENE_OPTIONAL:
  case SCENE_OPTIONAL_REAL:
    return "number or null";
  case SCENE_OPTIONAL_PAIR:
    return "2 numbers or null";
  case SCENE_REFERENCE:
    return field->fallback ? "name, index or null" : "name or index";
  case SCENE_OPTIONAL_VECTOR:
    return "3 numbers or null";
  case SCENE_OBJECT:
    return "object";
  case SCENE_LIST:
    return "list of objects";
  case SCENE_VARIANT:
    return "";
  }
  return "";
}

static void add_range(Text *text, const SceneField *field) {
  SceneChoices choices;
  char list[256];
  switch (field->type) {
  case SCENE_CHOICE:
  case SCENE_STYLE:
    scene_choices(field, &choices);
    scene_choices_list(&choices, list, sizeof list);
    text_add(text, list);
    break;
  case SCENE_TEXT:
    text_format(text, "at most %d bytes", SCENE_TEXT_SIZE - 1);
    break;
  case SCENE_REFERENCE:
    text_format(text, "in `%s`", field->range);
    break;
  case SCENE_LIST:
    text_format(text, "at most %d", field->limit);
    break;
  default:
    text_add(text, field->range);
    break;
  }
}

static void add_row(Text *text, const SceneField *field) {
  text_format(text, "| `%s` | %s | ", field->key, type_name(field));
  add_range(text, field);
  text_format(text, " | %s | ", field->unit);
  if (!field->fallback)
    text_add(text, "**required**");
  else if (field->type != SCENE_OBJECT)
    text_format(text, "`%s`", field->fallback);
  text_format(text, " | %s |\n", field->doc);
}

static void add_table(Text *text, const SceneObject *object) {
  text_add(text, "\n| key | type | range | unit | default | meaning |\n|---|---|---|---|---|---|\n");
  for (int i = 0; i < object->field_count; i++)
    if (object->fields[i].type != SCENE_VARIANT) add_row(text, &object->fields[i]);
}

/// A section per object; `path` is the key path that leads to it.
static void add_section(Text *text, const SceneObject *object, const char *path, const char *doc, int level) {
  text_format(text, "\n%.*s `%s`\n\n%s\n", level, "######", path, doc);
  add_table(text, object);
  for (int i = 0; i < object->field_count; i++) {
    const SceneField *field = &object->fields[i];
    char inner[128];
    if (field->type == SCENE_VARIANT)
      snprintf(inner, sizeof inner, "\"type\": \"%.40s\"", field->key);
    else
      snprintf(inner, sizeof inner, "%.80s.%.40s", path, field->key);
    if (field->type == SCENE_OBJECT || field->type == SCENE_LIST || field->type == SCENE_VARIANT)
      add_section(text, field->object, inner, field->doc, level + 1);
  }
}

char *scene_reference(void) {
  Text text = {0};
  text_add(&text, introduction);
  text_add(&text, "\n## The scene\n");
  add_table(&text, &scene_top);
  for (int i = 0; i < scene_top.field_count; i++) {
    const SceneField *field = &scene_top.fields[i];
    if (field->type == SCENE_OBJECT || field->type == SCENE_LIST)
      add_section(&text, field->object, field->key, field->doc, 2);
  }
  return text_take(&text);
}
