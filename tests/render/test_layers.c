// The style table, the layers, and text over the picture.
#include "tests/render/harness.h"

#include <stdlib.h>
#include <string.h>

#define WIDTH 96
#define HEIGHT 64

static const RenderView front = {{1.5f, 1, 4}, {1.5f, 0.5f, 0.5f}, 38};

static void test_style_table(void **state) {
  (void)state;
  assert_true(render_style_count() >= 1);
  for (int32_t i = 0; i < render_style_count(); ++i) {
    assert_true(render_style_exists(render_style_name(i)));
    assert_non_null(render_style_summary(i));
    for (int32_t k = 0; k < i; ++k) assert_string_not_equal(render_style_name(i), render_style_name(k));
  }
  assert_null(render_style_name(-1));
  assert_null(render_style_name(render_style_count()));
  assert_null(render_style_summary(render_style_count()));
  assert_false(render_style_exists("watercolour"));
  assert_false(render_style_exists(NULL));
  assert_int_equal(render_style_needs("watercolour", NULL), 0);
  assert_int_equal(render_style_needs("points", NULL), SIM_NEED_DENSITY);
  assert_true(render_style_exists(render_default_settings().style));
}

static void test_layer_lists(void **state) {
  (void)state;
  assert_int_equal(render_layer_count("watercolour"), 0);
  const char *const wanted[] = {"depth", "normal", "thickness", "background_depth"};
  for (size_t w = 0; w < sizeof wanted / sizeof wanted[0]; ++w) {
    bool found = false;
    for (int32_t i = 0; i < render_layer_count("points"); ++i) {
      found = found || strcmp(render_layer_name("points", i), wanted[w]) == 0;
    }
    if (!found) fail_msg("points has no layer \"%s\"", wanted[w]);
  }
  for (int32_t i = 0; i < render_layer_count("points"); ++i) {
    assert_non_null(render_layer_summary("points", i));
    for (int32_t k = 0; k < i; ++k) {
      assert_string_not_equal(render_layer_name("points", i), render_layer_name("points", k));
    }
  }
  assert_null(render_layer_name("points", render_layer_count("points")));
  assert_null(render_layer_name("points", -1));
}

// Every layer that is listed can be shown and read, looks like something, and is not the picture.
static void test_every_layer_is_readable(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  TestFrame *t = test_frame_pool();
  const RenderSettings settings = render_default_settings();
  uint8_t *picture = harness_draw(&harness, &t->frame, &front, &settings);
  int32_t channels;
  assert_false(render_read_layer(harness.render, NULL, &channels));
  for (int32_t i = 0; i < render_layer_count("points"); ++i) {
    const char *name = render_layer_name("points", i);
    assert_true(render_show_layer(harness.render, name));
    uint8_t *shown = harness_draw(&harness, &t->frame, &front, &settings);
    assert_true(memcmp(shown, picture, 3 * WIDTH * HEIGHT) != 0);
    assert_true(render_read_layer(harness.render, NULL, &channels));
    assert_true(channels == 1 || channels == 3);
    const size_t count = (size_t)channels * WIDTH * HEIGHT;
    float *values = malloc(count * sizeof *values);
    memset(values, 0xff, count * sizeof *values); // NaN
    assert_true(render_read_layer(harness.render, values, &channels));
    int not_zero = 0;
    for (size_t k = 0; k < count; ++k) {
      assert_true(values[k] == values[k]);
      not_zero += values[k] != 0;
    }
    if (not_zero < 10) fail_msg("layer %s is empty", name);
    free(values);
    free(shown);
  }
  assert_true(render_show_layer(harness.render, NULL));
  uint8_t *again = harness_draw(&harness, &t->frame, &front, &settings);
  assert_memory_equal(again, picture, 3 * WIDTH * HEIGHT);
  free(again);
  free(picture);
  test_frame_destroy(t);
  harness_close(&harness);
}

static void test_unknown_layers_are_refused(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  assert_false(render_show_layer(harness.render, "no_such_layer"));
  assert_false(render_show_layer(harness.render, ""));
  assert_true(render_show_layer(harness.render, "depth"));
  assert_true(render_show_layer(harness.render, NULL));
  harness_close(&harness);
}

// ---- Text ------------------------------------------------------------------------------------------------------------

static int white_pixels(const uint8_t *rgb, int32_t x0, int32_t y0, int32_t x1, int32_t y1) {
  int white = 0;
  for (int32_t y = y0; y < y1; ++y) {
    for (int32_t x = x0; x < x1; ++x) {
      const uint8_t *p = rgb + 3 * (y * WIDTH + x);
      white += p[0] == 255 && p[1] == 255 && p[2] == 255;
    }
  }
  return white;
}

static void test_text_is_where_it_should_be(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  RenderSettings settings = harness_pinned_settings();
  memset(settings.sky_horizon, 0, sizeof settings.sky_horizon);
  memset(settings.sky_zenith, 0, sizeof settings.sky_zenith);
  settings.floor = RENDER_FLOOR_NONE;
  TestFrame *t = test_frame_create(1, 0.1f);
  uint8_t *rgb = harness_draw(&harness, &t->frame, &front, &settings);
  assert_int_equal(white_pixels(rgb, 0, 0, WIDTH, HEIGHT), 0);
  // 'I' has 3 + 5 + 3 pixels, '.' has 4 in its lowest two rows.
  render_text(harness.render, 10, 20, 1, "I.\n I");
  render_read_rgb8(harness.render, rgb);
  assert_int_equal(white_pixels(rgb, 10, 20, 15, 27), 11);
  assert_int_equal(white_pixels(rgb, 16, 25, 21, 27), 4);
  assert_int_equal(white_pixels(rgb, 16, 31, 21, 38), 11);
  assert_int_equal(white_pixels(rgb, 0, 0, WIDTH, HEIGHT), 26);
  render_text(harness.render, 40, 40, 2, "I");
  render_read_rgb8(harness.render, rgb);
  assert_int_equal(white_pixels(rgb, 40, 40, 50, 54), 44);
  // None of these may do harm.
  render_text(harness.render, -500, 9000, 3, "outside");
  render_text(harness.render, 0, 0, 0, "no scale");
  render_text(harness.render, 0, 0, 1, "");
  render_text(harness.render, 0, 0, 1, "\n\n");
  render_text(harness.render, 0, 60, 1, "\x01\x7f\xc3\xa4");
  free(rgb);
  test_frame_destroy(t);
  harness_close(&harness);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_style_table),
      cmocka_unit_test(test_layer_lists),
      cmocka_unit_test(test_every_layer_is_readable),
      cmocka_unit_test(test_unknown_layers_are_refused),
      cmocka_unit_test(test_text_is_where_it_should_be),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
