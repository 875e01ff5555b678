// Drawn pictures: colours are the palette's, shadow is one flat tone, and what is pinned stays what it is.
#include "tests/render/harness.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 200
#define HEIGHT 120

static int srgb_byte(double linear) {
  const double x = linear < 0 ? 0 : linear > 1 ? 1 : linear;
  return (int)floor(255 * (x < 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055) + 0.5);
}

static RenderSettings drawn_settings(int32_t palette) {
  RenderSettings settings = render_default_settings();
  settings.style = "cartoon";
  settings.floor_level = 0;
  settings.tile_size = 100;
  settings.container_visible = false;
  memcpy(settings.sun_direction, (float[3]){-1, 1, 0}, sizeof settings.sun_direction);
  settings.cartoon.palette = render_palette(palette)->palette;
  return settings;
}

static void expect_colour(const uint8_t *rgb, int32_t x, int32_t y, const float colour[3], const float times[3]) {
  for (int k = 0; k < 3; ++k) {
    const int got = rgb[3 * (y * WIDTH + x) + k], want = srgb_byte((double)colour[k] * (double)times[k]);
    if (abs(got - want) > 1) fail_msg("pixel %d, %d, channel %d: %d, should be %d", x, y, k, got, want);
  }
}

static const float as_it_is[3] = {1, 1, 1};

// A box on the floor, seen from above with the sun at 45° from the left: its shadow is as long as it is high.
static void test_floor_and_shadow(void **state) {
  Harness *harness = *state;
  const SimObstacle box = {SIM_BOX, {0.5f, 0.5f, 0.5f}, {50, 0.25f, 50}, {0, 0, 0, 1}, {0.5f, 0.4f, 0.3f}};
  const SimFrame frame = {.particle_radius = 0.02f, .obstacle_count = 1, .obstacles = &box};
  const RenderView view = harness_view(50, 20, 50.01f, 50, 0, 50, 8);
  const double metre = HEIGHT / (2 * 20 * tan(4 * 3.14159265 / 180));
  for (int32_t palette = 0; render_palette(palette) != NULL; ++palette) {
    const RenderSettings settings = drawn_settings(palette);
    const RenderPalette *colours = &settings.cartoon.palette;
    uint8_t *rgb = harness_draw(harness, &frame, &view, &settings);
    int lit = 0, shaded = 0;
    for (int32_t x = 10; x < WIDTH - 10; ++x) {
      const double from_box = (x + 0.5 - WIDTH / 2) / metre;
      if (from_box < -0.4 || from_box > 0.9) {
        expect_colour(rgb, x, HEIGHT / 2, colours->floor[0], as_it_is);
        ++lit;
      } else if (from_box > 0.4 && from_box < 0.68) {
        expect_colour(rgb, x, HEIGHT / 2, colours->floor[0], colours->shade);
        ++shaded;
      }
    }
    expect_colour(rgb, WIDTH / 2, HEIGHT / 2, box.colour, as_it_is); // its top, in the light
    assert_true(lit > 50 && shaded > 5);
    free(rgb);
  }
}

// Straight up there is nothing but the first colour of the sky; without a tone map it is linear.
static void test_sky(void **state) {
  Harness *harness = *state;
  const SimFrame frame = {.particle_radius = 0.02f};
  RenderSettings settings = drawn_settings(0);
  const float *colour = settings.cartoon.palette.sky[0];
  const RenderView view = harness_view(0, 1, 0, 0, 2, 0, 20);
  uint8_t *rgb = harness_draw(harness, &frame, &view, &settings);
  settings.tone_map = RENDER_TONE_NONE;
  uint8_t *linear = harness_draw(harness, &frame, &view, &settings);
  for (int32_t y = 0; y < HEIGHT; y += 7) {
    for (int32_t x = 0; x < WIDTH; x += 7) {
      expect_colour(rgb, x, y, colour, as_it_is);
      for (int k = 0; k < 3; ++k)
        assert_in_range(linear[3 * (y * WIDTH + x) + k], (int)(255 * colour[k]), (int)(255 * colour[k]) + 1);
    }
  }
  free(rgb);
  free(linear);
}

// The gradient sky and the checker floor are the same bytes in every style.
static void test_pinned(void **state) {
  Harness *harness = *state;
  const SimFrame frame = {.particle_radius = 0.02f};
  RenderSettings settings = harness_pinned_settings();
  const RenderView view = harness_view(-1, 1.5f, 2, 0.5f, 0.6f, -1, 60);
  settings.style = "points";
  uint8_t *points = harness_draw(harness, &frame, &view, &settings);
  settings.style = "cartoon";
  uint8_t *drawn = harness_draw(harness, &frame, &view, &settings);
  assert_memory_equal(points, drawn, 3 * WIDTH * HEIGHT);
  free(points);
  free(drawn);
}

static int open_harness(void **state) {
  return harness_open_group(state, WIDTH, HEIGHT);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_floor_and_shadow), cmocka_unit_test(test_sky),
                                     cmocka_unit_test(test_pinned)};
  return cmocka_run_group_tests_name("drawn", tests, open_harness, harness_close_group);
}
