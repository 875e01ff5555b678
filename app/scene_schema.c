// The JSON schema of scene files (draft 7), from the field table: for editors that complete and check while one types.
#include <stdio.h>

#include "app/scene_table.h"

static void schema_object(Text *text, const SceneObject *object, const char *doc, int depth);

static void indent(Text *text, int depth) {
  text_format(text, "\n%*s", 2 * depth, "");
}

static void add_doc(Text *text, const SceneField *field) {
  char doc[400];
  snprintf(doc, sizeof doc, "%s%s%s%s", field->doc, *field->unit ? " Unit: " : "", field->unit,
           *field->unit ? "." : "");
  text_add(text, "\"description\": ");
  text_add_json_string(text, doc);
}

static void add_interval(Text *text, const SceneField *field) {
  SceneInterval interval = scene_interval(field);
  text_add(text, interval.low_open ? ", \"exclusiveMinimum\": " : ", \"minimum\": ");
  text_add_double(text, interval.low);
  text_add(text, interval.high_open ? ", \"exclusiveMaximum\": " : ", \"maximum\": ");
  text_add_double(text, interval.high);
}

static void add_number(Text *text, const SceneField *field, const char *type) {
  text_format(text, "\"type\": %s", type);
  add_interval(text, field);
}

static void add_numbers(Text *text, const SceneField *field, const char *type, int count) {
  text_format(text, "\"type\": %s, \"minItems\": %d, \"maxItems\": %d, \"items\": {", type, count, count);
  add_number(text, field, "\"number\"");
  text_add(text, "}");
}

static void add_names(Text *text, const SceneField *field) {
  SceneChoices choices;
  scene_choices(field, &choices);
  text_add(text, "\"enum\": [");
  for (int i = 0; i < choices.count; i++) {
    if (i) text_add(text, ", ");
    text_add_json_string(text, choices.names[i]);
  }
  text_add(text, "]");
}

static void add_constraints(Text *text, const SceneField *field) {
  switch (field->type) {
  case SCENE_NUMBER:
  case SCENE_REAL:
    add_number(text, field, "\"number\"");
    break;
  case SCENE_INTEGER:
  case SCENE_SEED:
    add_number(text, field, "\"integer\"");
    break;
  case SCENE_OPTIONAL:
  case SCENE_OPTIONAL_REAL:
    add_number(text, field, "[\"number\", \"null\"]");
    break;
  case SCENE_SWITCH:
    text_add(text, "\"type\": \"boolean\"");
    break;
  case SCENE_TEXT:
    text_format(text, "\"type\": \"string\", \"maxLength\": %d", SCENE_TEXT_SIZE - 1);
    break;
  case SCENE_CHOICE:
  case SCENE_STYLE:
    add_names(text, field);
    break;
  case SCENE_VECTOR:
  case SCENE_DIRECTION:
    add_numbers(text, field, "\"array\"", 3);
    break;
  case SCENE_OPTIONAL_PAIR:
    add_numbers(text, field, "[\"array\", \"null\"]", 2);
    break;
  case SCENE_OPTIONAL_VECTOR:
    add_numbers(text, field, "[\"array\", \"null\"]", 3);
    break;
  case SCENE_REFERENCE:
    text_format(text, "\"type\": [\"string\", \"integer\"%s], \"minLength\": 1, \"maxLength\": %d, \"minimum\": 0",
                field->fallback ? ", \"null\"" : "", SCENE_TEXT_SIZE - 1);
    break;
  default:
    break; // objects and lists have their own form
  }
}

static void schema_field(Text *text, const SceneField *field, int depth) {
  if (field->type == SCENE_OBJECT) {
    schema_object(text, field->object, field->doc, depth);
  } else if (field->type == SCENE_LIST) {
    text_add(text, "{");
    add_doc(text, field);
    text_format(text, ", \"type\": \"array\", \"maxItems\": %d, \"items\": ", field->limit);
    schema_object(text, field->object, NULL, depth);
    text_add(text, "}");
  } else {
    text_add(text, "{");
    add_doc(text, field);
    text_add(text, ", ");
    add_constraints(text, field);
    if (field->fallback) text_format(text, ", \"default\": %s", field->fallback);
    text_add(text, "}");
  }
}

/// Members of the "properties" of an object, those of one variant (or of none) among them.
static void schema_properties(Text *text, const SceneObject *object, const SceneField *variant, int depth, int *count) {
  for (int i = 0; i < object->field_count; i++) {
    const SceneField *field = &object->fields[i];
    if (field == variant) schema_properties(text, field->object, NULL, depth, count);
    if (field->type == SCENE_VARIANT) continue;
    if ((*count)++) text_add(text, ",");
    indent(text, depth);
    text_format(text, "\"%s\": ", field->key);
    if (variant && i == 0)
      text_format(text, "{\"const\": \"%s\"}", variant->key);
    else
      schema_field(text, field, depth);
  }
}

static void schema_required(Text *text, const SceneObject *object, const SceneField *variant, int *count) {
  for (int i = 0; i < object->field_count; i++) {
    const SceneField *field = &object->fields[i];
    if (field == variant) schema_required(text, field->object, NULL, count);
    if (field->type == SCENE_VARIANT || field->fallback) continue;
    text_add(text, (*count)++ ? ", " : "");
    text_format(text, "\"%s\"", field->key);
  }
}

/// One closed object: nothing but the keys named.
static void schema_body(Text *text, const SceneObject *object, const SceneField *variant, int depth) {
  int count = 0;
  text_add(text, "\"type\": \"object\", \"additionalProperties\": false, \"required\": [");
  schema_required(text, object, variant, &count);
  text_add(text, "],");
  indent(text, depth + 1);
  text_add(text, "\"properties\": {");
  count = 0;
  schema_properties(text, object, variant, depth + 2, &count);
  indent(text, depth + 1);
  text_add(text, "}");
  indent(text, depth);
  text_add(text, "}");
}

static void schema_variants(Text *text, const SceneObject *object, int depth) {
  int count = 0;
  text_add(text, "{\"oneOf\": [");
  for (int i = 0; i < object->field_count; i++) {
    const SceneField *field = &object->fields[i];
    if (field->type != SCENE_VARIANT) continue;
    if (count++) text_add(text, ",");
    indent(text, depth + 1);
    text_add(text, "{");
    add_doc(text, field);
    text_add(text, ", ");
    schema_body(text, object, field, depth + 1);
  }
  indent(text, depth);
  text_add(text, "]}");
}

static void schema_object(Text *text, const SceneObject *object, const char *doc, int depth) {
  if (object->fields[object->field_count - 1].type == SCENE_VARIANT) {
    schema_variants(text, object, depth);
    return;
  }
  text_add(text, "{");
  if (doc) {
    text_add(text, "\"description\": ");
    text_add_json_string(text, doc);
    text_add(text, ", ");
  }
  schema_body(text, object, NULL, depth);
}

char *scene_schema(void) {
  Text text = {0};
  text_add(&text, "{\n  \"$schema\": \"http://json-schema.org/draft-07/schema#\",\n"
                  "  \"title\": \"A scene of Lido\",\n"
                  "  \"$comment\": \"Made by: lido check --schema > configs/scene.schema.json\",\n  ");
  schema_body(&text, &scene_top, NULL, 0);
  text_add(&text, "\n");
  return text_take(&text);
}
