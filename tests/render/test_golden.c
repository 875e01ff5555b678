// The default look, kept as small pictures. These come second to the computed truths of the other tests: they tell that
// something changed, not that it is wrong. On failure the actual picture and the difference (times eight) are kept in
// the build folder; LIDO_UPDATE_GOLDEN=1 in the environment writes new ones.
#include "tests/render/harness.h"

#include <spng.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 320
#define HEIGHT 180
#define BYTES ((size_t)3 * WIDTH * HEIGHT)

static bool write_png(const char *path, const uint8_t *rgb) {
  FILE *file = fopen(path, "wb");
  if (file == NULL) return false;
  spng_ctx *png = spng_ctx_new(SPNG_CTX_ENCODER);
  struct spng_ihdr header = {.width = WIDTH, .height = HEIGHT, .bit_depth = 8, .color_type = SPNG_COLOR_TYPE_TRUECOLOR};
  const bool ok = spng_set_png_file(png, file) == 0 && spng_set_ihdr(png, &header) == 0 &&
                  spng_encode_image(png, rgb, BYTES, SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE) == 0;
  spng_ctx_free(png);
  fclose(file);
  return ok;
}

static bool read_png(const char *path, uint8_t *rgb) {
  FILE *file = fopen(path, "rb");
  if (file == NULL) return false;
  spng_ctx *png = spng_ctx_new(0);
  struct spng_ihdr header;
  const bool ok = spng_set_png_file(png, file) == 0 && spng_get_ihdr(png, &header) == 0 && header.width == WIDTH &&
                  header.height == HEIGHT && spng_decode_image(png, rgb, BYTES, SPNG_FMT_RGB8, 0) == 0;
  spng_ctx_free(png);
  fclose(file);
  return ok;
}

// Drivers round differently and may place a sphere's border elsewhere: nearly all pixels must be close, and the mean.
static void compare(const char *name, const uint8_t *actual, const uint8_t *golden) {
  double sum = 0;
  int far_off = 0;
  uint8_t *difference = malloc(BYTES);
  for (size_t i = 0; i < BYTES; ++i) {
    const int d = abs(actual[i] - golden[i]);
    sum += d;
    far_off += d > 10;
    difference[i] = (uint8_t)(d * 8 > 255 ? 255 : d * 8);
  }
  const double mean = sum / (double)BYTES, share = (double)far_off / (double)BYTES;
  if (mean > 1 || share > 0.01) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s_actual.png", LIDO_TEST_OUTPUT, name);
    write_png(path, actual);
    snprintf(path, sizeof path, "%s/%s_difference.png", LIDO_TEST_OUTPUT, name);
    write_png(path, difference);
    free(difference);
    fail_msg("%s: mean difference %.2f, %.2f %% of the values are off by more than 10; see %s", name, mean, 100 * share,
             path);
  }
  free(difference);
}

static void check(const char *name, const TestFrame *t, const RenderView *view, const RenderSettings *settings) {
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  uint8_t *actual = harness_draw(&harness, &t->frame, view, settings), *golden = malloc(BYTES);
  harness_close(&harness);
  char path[256];
  snprintf(path, sizeof path, "tests/render/golden/%s.png", name);
  if (getenv("LIDO_UPDATE_GOLDEN") != NULL) assert_true(write_png(path, actual));
  if (!read_png(path, golden)) fail_msg("cannot read %s", path);
  compare(name, actual, golden);
  free(actual);
  free(golden);
}

static const RenderView tank_view = {{0.5f, 1.2f, 3.9f}, {1.5f, 0.5f, 0.45f}, 38};

static void test_pool(void **state) {
  (void)state;
  TestFrame *t = test_frame_pool();
  const RenderSettings settings = render_default_settings();
  check("pool", t, &tank_view, &settings);
  test_frame_destroy(t);
}

static void test_obstacles(void **state) {
  (void)state;
  TestFrame *t = test_frame_pool();
  const SimObstacle obstacles[3] = {
      {SIM_BOX, {0.3f, 0.9f, 0.3f}, {2.3f, 0.45f, 0.5f}, {0, 0.3826834f, 0, 0.9238795f}, {0.75f, 0.35f, 0.2f}},
      {SIM_SPHERE, {0.4f, 0, 0}, {1.2f, 0.35f, 0.5f}, {0, 0, 0, 1}, {0.8f, 0.7f, 0.3f}},
      {SIM_CYLINDER, {0.2f, 1.2f, 0}, {0.6f, 0.6f, 0.3f}, {0, 0, 0, 1}, {0.7f, 0.7f, 0.75f}}};
  memcpy(t->obstacles, obstacles, sizeof obstacles);
  t->frame.obstacle_count = 3;
  const RenderSettings settings = render_default_settings();
  check("obstacles", t, &tank_view, &settings);
  test_frame_destroy(t);
}

static void test_shapes(void **state) {
  (void)state;
  TestFrame *t = test_frame_shapes();
  const RenderSettings settings = render_default_settings();
  check("shapes", t, &tank_view, &settings);
  test_frame_destroy(t);
}

static void test_glass(void **state) {
  (void)state;
  TestFrame *t = test_frame_glass();
  RenderSettings settings = render_default_settings();
  settings.tile_size = 0.05f;
  for (int k = 0; k < 3; ++k) settings.absorption[k] *= 8;
  const RenderView view = {{0.02f, 0.17f, 0.34f}, {0.04f, 0.06f, 0.04f}, 30};
  check("glass", t, &view, &settings);
  test_frame_destroy(t);
}

static void test_empty_tank_without_sun(void **state) {
  (void)state;
  TestFrame *t = test_frame_create(1, 0.0175f);
  RenderSettings settings = render_default_settings();
  settings.sun = false;
  check("empty_tank", t, &tank_view, &settings);
  test_frame_destroy(t);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_pool),
      cmocka_unit_test(test_obstacles),
      cmocka_unit_test(test_shapes),
      cmocka_unit_test(test_glass),
      cmocka_unit_test(test_empty_tank_without_sun),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
