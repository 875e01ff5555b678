// The key render.cartoon.palette: every palette of the renderer by its name.
#include "scene_helpers.h"

#define SCENE(keys)                                                                                                    \
  "{\"version\": 1, \"fluid\": [{\"min\": [0,0,0], \"max\": [1,1,1]}],\n"                                              \
  " \"render\": {\"style\": \"cartoon\", \"cartoon\": {" keys "}}}"

static RenderCartoon cartoon_of(const char *text) {
  Scene scene = load(text);
  const RenderCartoon cartoon = scene_render_settings(&scene).cartoon;
  scene_free(&scene);
  return cartoon;
}

static void expect_palette(const RenderCartoon *cartoon, const RenderNamedPalette *named) {
  assert_memory_equal(&cartoon->palette, &named->palette, sizeof cartoon->palette);
  assert_true(cartoon->most_reflection == named->most_reflection);
  assert_true(cartoon->most_transparency == named->most_transparency);
}

static void test_every_name_brings_its_colours(void **state) {
  (void)state;
  const RenderNamedPalette *named;
  int32_t count = 0;
  for (; (named = render_palette(count)) != NULL; ++count) {
    char text[256];
    snprintf(text, sizeof text, SCENE("\"palette\": \"%s\""), named->name);
    const RenderCartoon cartoon = cartoon_of(text);
    expect_palette(&cartoon, named);
    if (count > 0) {
      assert_memory_not_equal(&named->palette, &render_palette(0)->palette, sizeof named->palette);
    }
  }
  assert_true(count > 1);
  assert_null(render_palette(-1));
  const RenderCartoon none = cartoon_of("{\"version\": 1}");
  expect_palette(&none, render_palette(0));
}

// A scene without a word about it draws as a program that only sets the style.
static void test_scene_and_renderer_agree(void **state) {
  (void)state;
  const RenderCartoon scene = cartoon_of("{\"version\": 1}"), own = render_default_settings().cartoon;
  assert_memory_equal(&scene.palette, &own.palette, sizeof own.palette);
#define SAME(field) assert_true(scene.field == own.field)
  SAME(scale), SAME(smoothing), SAME(kernel), SAME(reach), SAME(separated), SAME(fitted), SAME(range);
  SAME(half_resolution), SAME(splashes_apart), SAME(levels), SAME(bright_levels), SAME(steady);
  SAME(bright_threshold), SAME(dark_threshold), SAME(bright_factor), SAME(dark_factor);
  SAME(reflection), SAME(refraction), SAME(most_reflection), SAME(least_reflection);
  SAME(most_transparency), SAME(least_transparency), SAME(critical_angle), SAME(angle_interval);
  SAME(clearness), SAME(bending), SAME(outline), SAME(crease_angle);
#undef SAME
}

static void test_unknown_names_are_refused(void **state) {
  (void)state;
  refused(SCENE("\"palette\": \"lavva\""),
          "t.json:2: render.cartoon.palette: must be one of lagoon, ink, lava, storm, got \"lavva\", did you mean "
          "\"lava\"?");
  refused(SCENE("\"pallette\": \"ink\""), "t.json:2: render.cartoon.pallette: unknown key, did you mean \"palette\"?");
}

// What the scene says itself wins over the palette's own, before it or after it.
static void test_values_by_key(void **state) {
  (void)state;
  const RenderNamedPalette *lava = render_palette(2);
  assert_string_equal(lava->name, "lava");
  static const char *const texts[] = {
      SCENE("\"palette\": \"lava\", \"bright\": [0.25, 0.5, 1], \"grout\": [0, 0, 1], \"most_transparency\": 0.75"),
      SCENE("\"bright\": [0.25, 0.5, 1], \"grout\": [0, 0, 1], \"most_transparency\": 0.75, \"palette\": \"lava\"")};
  for (int k = 0; k < 2; ++k) {
    const RenderCartoon cartoon = cartoon_of(texts[k]);
    RenderPalette expected = lava->palette;
    memcpy(expected.bright, (const float[3]){0.25f, 0.5f, 1}, sizeof expected.bright);
    memcpy(expected.floor[1], (const float[3]){0, 0, 1}, sizeof expected.floor[1]);
    assert_memory_equal(&cartoon.palette, &expected, sizeof expected);
    assert_true(cartoon.most_transparency == 0.75f);
    assert_true(cartoon.most_reflection == lava->most_reflection);
  }
  refused(SCENE("\"ink\": [0, 0, 1.5]"), "t.json:2: render.cartoon.ink.2: must be in [0, 1] linear, got 1.5");
  const RenderCartoon null = cartoon_of(SCENE("\"palette\": \"lava\", \"bright\": null, \"most_reflection\": null"));
  expect_palette(&null, lava);
}

// The printed scene loads again to the same, with a palette and keys of its own.
static void test_printed_scene_is_the_same(void **state) {
  (void)state;
  for (int32_t k = 0; render_palette(k) != NULL; ++k) {
    char text[320];
    snprintf(text, sizeof text,
             SCENE("\"palette\": \"%s\", \"medium\": [0.3, 0.1, 0.7], \"outline\": 3.5, \"levels\": 5"),
             render_palette(k)->name);
    Scene scene = load(text);
    char *printed = scene_print(&scene);
    Scene again = load(printed);
    const RenderCartoon before = scene_render_settings(&scene).cartoon, after = scene_render_settings(&again).cartoon;
    assert_memory_equal(&before.palette, &after.palette, sizeof before.palette);
    assert_true(after.outline == 3.5f && after.levels == 5 && after.palette.medium[2] == 0.7f);
    assert_true(before.most_reflection == after.most_reflection);
    char *printed_again = scene_print(&again);
    assert_string_equal(printed, printed_again);
    free(printed);
    free(printed_again);
    scene_free(&scene);
    scene_free(&again);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_every_name_brings_its_colours), cmocka_unit_test(test_scene_and_renderer_agree),
      cmocka_unit_test(test_unknown_names_are_refused),     cmocka_unit_test(test_values_by_key),
      cmocka_unit_test(test_printed_scene_is_the_same),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
