// --set key.path=value: any key of a scene can be changed, and a mistake names the --set as its place.
#include "scene_helpers.h"

static const char *const base =
    "{\"version\": 1, \"fluid\": [{\"min\": [0,0,0], \"max\": [1,1,1]}],\n \"name\": \"base\"}";

enum { MOST_SETS = 4 };

typedef struct Case {
  const char *sets[MOST_SETS];
  const char *message; // of the refusal
} Case;

static int count_sets(const char *const *sets) {
  int count = 0;
  while (count < MOST_SETS && sets[count]) count++;
  return count;
}

static Scene load_changed(const char *const sets[MOST_SETS]) {
  Scene scene;
  AppError error;
  if (!load_with(&scene, base, sets, count_sets(sets), &error)) fail_msg("%s", error.message);
  return scene;
}

static void test_values_of_every_kind_are_set(void **state) {
  (void)state;
  const char *const numbers[MOST_SETS] = {"simulation.iterations=9", "simulation.viscosity=0.25", "light.sun=false"};
  Scene scene = load_changed(numbers);
  assert_int_equal(scene.simulation.iterations, 9);
  assert_true(scene.simulation.viscosity == 0.25f);
  assert_false(scene.light.sun);
  scene_free(&scene);

  const char *const texts[MOST_SETS] = {"name=no quotes", "render.style=\"points\"", "environment.floor_level=null"};
  scene = load_changed(texts);
  assert_string_equal(scene.name, "no quotes");
  scene_free(&scene);

  // A name may look like a number.
  const char *const digits[MOST_SETS] = {"name=42"};
  scene = load_changed(digits);
  assert_string_equal(scene.name, "42");
  scene_free(&scene);
}

static void test_items_of_lists_are_set(void **state) {
  (void)state;
  const char *const sets[MOST_SETS] = {"fluid.0.velocity=[1, 0, 0]", "fluid.0.max.1=0.5",
                                       "obstacles.0={\"type\":\"sphere\",\"radius\":1,\"position\":[2,0,0]}",
                                       "obstacles.0.radius=0.5"};
  Scene scene = load_changed(sets);
  assert_true(scene.fluid[0].block.velocity[0] == 1);
  assert_true(scene.fluid[0].block.max[0] == 1 && scene.fluid[0].block.max[1] == 0.5f);
  assert_int_equal(scene.obstacles_count, 1);
  assert_true(scene.obstacles[0].sphere.radius == 0.5f);
  scene_free(&scene);
}

static void test_one_component_of_a_default_is_set(void **state) {
  (void)state;
  const char *const sets[MOST_SETS] = {"simulation.gravity.0=2", "fluid.0.velocity.2=3"};
  Scene scene = load_changed(sets);
  assert_true(scene.simulation.gravity[0] == 2 && scene.simulation.gravity[1] == -9.81f);
  assert_true(scene.fluid[0].block.velocity[0] == 0 && scene.fluid[0].block.velocity[2] == 3);
  scene_free(&scene);
}

static void test_the_last_set_wins(void **state) {
  (void)state;
  const char *const sets[MOST_SETS] = {"simulation.seed=5", "simulation.seed=6"};
  Scene scene = load_changed(sets);
  assert_int_equal(scene.simulation.seed, 6);
  scene_free(&scene);
}

static void test_mistakes_name_the_set(void **state) {
  (void)state;
  static const Case cases[] = {
      {{"simulation.iterations=x"},
       "--set simulation.iterations=x: simulation.iterations: must be a whole number in [1, 100], got \"x\""},
      {{"simulation.cfl=1", "simulation.cfl=NaN"},
       "--set simulation.cfl=NaN: simulation.cfl: must be a number in [0.05, 2] spacings, got \"NaN\""},
      {{"simulation.cfl=1e999"}, "--set simulation.cfl=1e999: simulation.cfl: must be in [0.05, 2] spacings, got inf"},
      {{"simulation.clf=1"}, "--set simulation.clf=1: simulation.clf: unknown key, did you mean \"cfl\"?"},
      {{"render.style=hightfield"},
       "--set render.style=hightfield: render.style: must be one of points, refraction, raycast, cartoon, heightfield, "
       "got \"hightfield\", did you mean \"heightfield\"?"},
      {{"fluid.0.min=[2,0,0]"},
       "--set fluid.0.min=[2,0,0]: fluid.0: min must be less than max, but in x 2 is not less than 1"},
      {{"fluid.5.min=[2,0,0]"}, "--set fluid.5.min=[2,0,0]: the list has 1 items, the next would be 1"},
      {{"fluid.x=1"}, "--set fluid.x=1: a list needs an index (0, 1, 2 ...), got x"},
      {{"name.first=1"}, "--set name.first=1: there is nothing inside a single value to set: first"},
      {{"simulation..cfl=1"}, "--set simulation..cfl=1: an empty key in the path"},
      {{"simulation.cfl"}, "--set simulation.cfl: must have the form key.path=value"},
      {{"=1"}, "--set =1: must have the form key.path=value"},
      {{"name=\xff"}, "--set name=?: is not UTF-8"},
      {{"simulation=3"}, "--set simulation=3: simulation: must be an object, got 3"},
      {{"light.direction.0=0", "light.direction.1=0", "light.direction.2=0"},
       "--set light.direction.2=0: light.direction: must not be the zero vector"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    Scene scene;
    AppError error;
    assert_false(load_with(&scene, base, cases[i].sets, count_sets(cases[i].sets), &error));
    assert_string_equal(error.message, cases[i].message);
    assert_int_equal(error.code, APP_BAD_INPUT);
  }
}

static void test_other_mistakes_keep_their_line(void **state) {
  (void)state;
  Scene scene;
  AppError error;
  const char *const sets[] = {"simulation.cfl=1", "name2=x"};
  const char *wrong = "{\"version\": 1,\n\"simulation\": {\n\"tensile\": 7}}";
  assert_false(load_with(&scene, wrong, sets, 1, &error));
  assert_string_equal(error.message, "t.json:3: simulation.tensile: must be in [0, 0.1], got 7");
  // "name2" begins like "name", but is another key.
  const char *unnamed = "{\"version\": 1,\n\"name\": 3}";
  assert_false(load_with(&scene, unnamed, sets, 2, &error));
  assert_string_equal(error.message, "--set name2=x: name2: unknown key, did you mean \"name\"?");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_values_of_every_kind_are_set),
      cmocka_unit_test(test_items_of_lists_are_set),
      cmocka_unit_test(test_one_component_of_a_default_is_set),
      cmocka_unit_test(test_the_last_set_wins),
      cmocka_unit_test(test_mistakes_name_the_set),
      cmocka_unit_test(test_other_mistakes_keep_their_line),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
