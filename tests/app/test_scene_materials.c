// The key render.material: every liquid of the renderer by its name.
#include "scene_helpers.h"

#define SCENE(keys) "{\"version\": 1, \"fluid\": [{\"min\": [0,0,0], \"max\": [1,1,1]}],\n \"render\": {" keys "}}"

static void expect_material(const Scene *scene, const RenderMaterial *material) {
  const RenderSettings settings = scene_render_settings(scene);
  assert_memory_equal(settings.absorption, material->absorption, sizeof settings.absorption);
  assert_memory_equal(settings.scattering, material->scattering, sizeof settings.scattering);
  assert_memory_equal(settings.reflectance, material->reflectance, sizeof settings.reflectance);
  assert_true(settings.refractive_index == material->refractive_index);
}

static void test_every_name_brings_its_liquid(void **state) {
  (void)state;
  const RenderMaterial *material;
  int32_t count = 0;
  for (; (material = render_material(count)) != NULL; ++count) {
    char text[256];
    snprintf(text, sizeof text, SCENE("\"style\": \"raycast\", \"material\": \"%s\""), material->name);
    Scene scene = load(text);
    expect_material(&scene, material);
    scene_free(&scene);
  }
  assert_true(count > 1);
  Scene none = load(SCENE(""));
  expect_material(&none, render_material(0));
  scene_free(&none);
}

static void test_unknown_names_are_refused(void **state) {
  (void)state;
  refused(SCENE("\"material\": \"coppper\""), "t.json:2: render.material: must be one of water, milk, juice, oil, "
                                              "cola, ink, metal, gold, copper, got \"coppper\", did "
                                              "you mean \"copper\"?");
  refused(SCENE("\"matrial\": \"milk\""), "t.json:2: render.matrial: unknown key, did you mean \"material\"?");
}

// What the scene says itself wins over the liquid's own.
static void test_values_by_key(void **state) {
  (void)state;
  Scene water = load(SCENE("\"absorption\": [1, 2, 3], \"reflectance\": [0.5, 0.5, 0.25], \"material\": \"water\""));
  RenderSettings settings = scene_render_settings(&water);
  assert_true(settings.absorption[2] == 3 && settings.reflectance[2] == 0.25f);
  assert_memory_equal(settings.scattering, render_material(0)->scattering, sizeof settings.scattering);
  scene_free(&water);
  Scene milk = load(SCENE("\"absorption\": [1, 2, 3], \"material\": \"milk\""));
  settings = scene_render_settings(&milk);
  assert_true(settings.absorption[0] == 1 && settings.absorption[2] == 3);
  assert_memory_equal(settings.scattering, render_material_find("milk")->scattering, sizeof settings.scattering);
  scene_free(&milk);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_every_name_brings_its_liquid),
      cmocka_unit_test(test_unknown_names_are_refused),
      cmocka_unit_test(test_values_by_key),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
