// What the field table makes: the printed scene, the schema, the reference; and where scenes are found.
#include "scene_helpers.h"

#include <math.h>
#include <unistd.h>

static const char *const shipped[] = {"dam_break", "double_dam_break", "glass", "ocean_waves", "pontoon",    "ripple",
                                      "splash",    "spouts",           "steps", "still_pool",  "table_pool", "wave",
                                      "wave_pool"};

static bool same_fields(const SceneObject *object, const char *a, const char *b);

static bool same_list(const SceneField *field, const char *a, const char *b) {
  const char *items_a, *items_b;
  int32_t count_a, count_b;
  memcpy(&items_a, a + field->offset, sizeof items_a);
  memcpy(&items_b, b + field->offset, sizeof items_b);
  memcpy(&count_a, a + field->count_offset, sizeof count_a);
  memcpy(&count_b, b + field->count_offset, sizeof count_b);
  bool same = count_a == count_b;
  for (int i = 0; same && i < count_a; i++)
    same = same_fields(field->object, items_a + (size_t)i * field->object->size,
                       items_b + (size_t)i * field->object->size);
  return same;
}

static bool same_floats(const char *a, const char *b, int count) {
  for (int i = 0; i < count; i++) {
    float x, y;
    memcpy(&x, a + 4 * i, 4);
    memcpy(&y, b + 4 * i, 4);
    if (x != y && !(isnan(x) && isnan(y))) return false;
  }
  return true;
}

/// Every field of the table, bit for bit (but for the sign of zeros).
static bool same_fields(const SceneObject *object, const char *a, const char *b) {
  bool same = true;
  for (int i = 0; same && i < object->field_count; i++) {
    const SceneField *field = &object->fields[i];
    const char *x = a + field->offset, *y = b + field->offset;
    switch (field->type) {
    case SCENE_OBJECT:
    case SCENE_VARIANT:
      same = same_fields(field->object, x, y);
      break;
    case SCENE_LIST:
      same = same_list(field, a, b);
      break;
    case SCENE_NUMBER:
    case SCENE_OPTIONAL:
      same = same_floats(x, y, 1);
      break;
    case SCENE_VECTOR:
    case SCENE_DIRECTION:
    case SCENE_OPTIONAL_VECTOR:
      same = same_floats(x, y, 3);
      break;
    case SCENE_OPTIONAL_PAIR:
      same = same_floats(x, y, 2);
      break;
    case SCENE_REAL:
    case SCENE_OPTIONAL_REAL:
      same = *(const double *)x == *(const double *)y || (isnan(*(const double *)x) && isnan(*(const double *)y));
      break;
    case SCENE_REFERENCE:
      same = *(const int32_t *)x == *(const int32_t *)y &&
             strcmp(((const SceneReference *)x)->name, ((const SceneReference *)y)->name) == 0;
      break;
    case SCENE_SEED:
      same = *(const uint64_t *)x == *(const uint64_t *)y;
      break;
    case SCENE_INTEGER:
    case SCENE_CHOICE:
      same = *(const int32_t *)x == *(const int32_t *)y;
      break;
    case SCENE_SWITCH:
      same = *(const bool *)x == *(const bool *)y;
      break;
    case SCENE_TEXT:
    case SCENE_STYLE:
      same = strcmp(x, y) == 0;
      break;
    }
  }
  return same;
}

/// Print, load, print: the same scene and the same text.
static void check_round_trip(const Scene *scene) {
  char *text = scene_print(scene);
  Scene again = load(text);
  char *text_again = scene_print(&again);
  assert_string_equal(text, text_again);
  assert_true(same_fields(&scene_top, (const char *)scene, (const char *)&again));
  free(text);
  free(text_again);
  scene_free(&again);
}

static void test_shipped_scenes_round_trip(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof shipped / sizeof *shipped; i++) {
    Scene scene;
    AppError error;
    if (!scene_load(&scene, shipped[i], NULL, 0, &error)) fail_msg("%s", error.message);
    assert_true(*scene.name);
    check_round_trip(&scene);
    scene_free(&scene);
  }
}

static void test_odd_values_round_trip(void **state) {
  (void)state;
  Scene scene = load(
      "{\"version\": 1, \"name\": \"\\u0001 \\\\ \\\" \\u20ac\",\n"
      "\"simulation\": {\"particle_radius\": 0.0123456789, \"viscosity\": 1e-30, \"duration\": 0.1},\n"
      "\"container\": {\"min\": [-1e-45, 1e-7, 0]},\n"
      "\"obstacles\": [{\"type\": \"box\", \"size\": [1e-3, 3.3333333, 1], \"position\": [-0.0, 0, 0]},\n"
      " {\"type\": \"capsule\", \"radius\": 0.1, \"height\": 0.2, \"position\": [0, 0, 0], \"name\": \"3\",\n"
      "  \"motion\": \"scripted\", \"keys\": [{\"time\": 0.1, \"position\": [0,0,0]}]},\n"
      " {\"type\": \"stairs\", \"size\": [1,1,1], \"steps\": 3, \"position\": [0,0,0], \"motion\": \"draggable\"}],\n"
      "\"fluid\": [{\"type\": \"emitter\", \"diameter\": 0.3, \"position\": [1,1,0], \"direction\": [1,2,3],\n"
      "  \"stop\": 0.7, \"obstacle\": \"3\", \"name\": \"\\u20ac\"},\n"
      " {\"type\": \"emitter\", \"shape\": \"rectangle\", \"size\": [0.1, 0.3], \"position\": [1,1,0], \"direction\": "
      "[0,1,0],\n"
      "  \"obstacle\": 1}, {\"type\": \"drop\", \"centre\": [1, 1, 0.1], \"radius\": 0.1}],\n"
      "\"sinks\": [{\"min\": [0,0,0], \"max\": [0.1, 0.2, 0.3]}],\n"
      "\"events\": [{\"type\": \"push\", \"time\": 0.3333333333333333, \"origin\": [0,0,0],\n"
      "  \"direction\": [1, 2, 3], \"acceleration\": [0,0,1]},\n"
      " {\"type\": \"drag\", \"obstacle\": 2, \"position\": [0,0.1,1]},\n"
      " {\"type\": \"emitter\", \"emitter\": \"\\u20ac\", \"on\": false},\n"
      " {\"type\": \"camera\", \"eye\": [0,0,1], \"target\": [0,0,0]},\n"
      " {\"type\": \"tilt\", \"gravity\": [0.1, 0.2, 0.3]}]}");
  check_round_trip(&scene);
  scene_free(&scene);
  // The comparison can fail.
  Scene a = load("{\"version\": 1}"), b = load("{\"version\": 1, \"render\": {\"points\": {\"scale\": 1.2500002}}}");
  assert_false(same_fields(&scene_top, (const char *)&a, (const char *)&b));
  a.render.points.scale = b.render.points.scale;
  assert_true(same_fields(&scene_top, (const char *)&a, (const char *)&b));
  scene_free(&a);
  scene_free(&b);
}

static void check_file(const char *path, char *made, const char *command) {
  char *kept = read_all(path);
  if (strcmp(kept, made) != 0) fail_msg("%s is out of date: %s > %s", path, command, path);
  free(kept);
  free(made);
}

static void test_schema_file_is_up_to_date(void **state) {
  (void)state;
  check_file("configs/scene.schema.json", scene_schema(), "lido check --schema");
}

static void test_reference_file_is_up_to_date(void **state) {
  (void)state;
  check_file("docs/scene.md", scene_reference(), "lido check --reference");
}

static void test_scenes_are_found_by_name(void **state) {
  (void)state;
  char path[4096];
  const char *const found[] = {"dam_break", "dam_break.json", "configs/dam_break.json", "configs/dam_break"};
  for (size_t i = 0; i < sizeof found / sizeof *found; i++) {
    assert_true(scene_find(found[i], path, sizeof path));
    assert_int_equal(access(path, R_OK), 0);
  }
  // As given comes first.
  assert_true(scene_find("configs/dam_break.json", path, sizeof path));
  assert_string_equal(path, "configs/dam_break.json");
  const char *const nowhere[] = {"", "no_such_scene", "../dam_break", "x/dam_break", "dam_break.txt"};
  for (size_t i = 0; i < sizeof nowhere / sizeof *nowhere; i++) assert_false(scene_find(nowhere[i], path, sizeof path));
  // Too little room is "not found", not an overrun.
  char small[8];
  assert_false(scene_find("dam_break", small, sizeof small));
}

static void test_a_missing_scene_suggests_one(void **state) {
  (void)state;
  Scene scene;
  AppError error;
  assert_false(scene_load(&scene, "dam_braek", NULL, 0, &error));
  assert_string_equal(error.message, "dam_braek: no such scene, did you mean \"dam_break\"?");
  assert_false(scene_load(&scene, "configs", NULL, 0, &error));
  assert_string_equal(error.message, "configs: is a directory, not a scene file");
  assert_false(scene_load(&scene, "", NULL, 0, &error));
  assert_int_equal(error.code, APP_BAD_INPUT);
  scene_free(&scene);
}

static void test_nearest_name(void **state) {
  (void)state;
  const char *const names[] = {"viscosity", "cfl", "time_step", "tensile"};
  assert_string_equal(text_nearest("viscosty", names, 4), "viscosity");
  assert_string_equal(text_nearest("clf", names, 4), "cfl");
  assert_string_equal(text_nearest("timestep", names, 4), "time_step");
  assert_null(text_nearest("q", names, 4));
  assert_null(text_nearest("", names, 4));
  assert_null(text_nearest("something else altogether", names, 4));
  assert_null(text_nearest("cfl", names, 0));
}

static void test_printable_text(void **state) {
  (void)state;
  char out[16];
  assert_string_equal(text_printable(out, sizeof out, "a\x1b[1m\n", 15), "a?[1m?");
  assert_string_equal(text_printable(out, sizeof out, "\xc2\x9b\xc3\xa9\xff", 15), "?\xc3\xa9?");
  assert_string_equal(text_printable(out, sizeof out, "0123456789abcdefgh", 10), "0123456789...");
  assert_string_equal(text_printable(out, sizeof out, "0123456789abcdefgh", 100), "0123456789ab...");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_shipped_scenes_round_trip),
      cmocka_unit_test(test_odd_values_round_trip),
      cmocka_unit_test(test_schema_file_is_up_to_date),
      cmocka_unit_test(test_reference_file_is_up_to_date),
      cmocka_unit_test(test_scenes_are_found_by_name),
      cmocka_unit_test(test_a_missing_scene_suggests_one),
      cmocka_unit_test(test_nearest_name),
      cmocka_unit_test(test_printable_text),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
