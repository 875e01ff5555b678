// PNG and PFM: what is written is read back equal, and other things are refused.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "app/image.h"
#include "run_lido.h"

static char folder[256];

static int set_up(void **state) {
  (void)state;
  folder_make(folder);
  return 0;
}

static int tear_down(void **state) {
  (void)state;
  folder_remove(folder);
  return 0;
}

static void check_png(int32_t width, int32_t height) {
  size_t size = (size_t)width * (size_t)height * 3;
  uint8_t *rgb = malloc(size);
  for (size_t i = 0; i < size; i++) rgb[i] = (uint8_t)(i * 2654435761u >> 13);
  AppError error;
  const char *path = in(folder, "a.png");
  assert_true(image_write_png(path, rgb, width, height, &error));
  Image image;
  assert_true(image_read_png(path, &image, &error));
  assert_int_equal(image.width, width);
  assert_int_equal(image.height, height);
  assert_memory_equal(image.bytes, rgb, size);
  image_free(&image);
  free(rgb);
}

static void test_png_round_trip(void **state) {
  (void)state;
  check_png(1, 1);
  check_png(3, 2);
  check_png(1, 500);
  check_png(640, 361);
  assert_int_equal(folder_count(folder), 1);
}

static void check_pfm(int32_t width, int32_t height, int32_t channels) {
  size_t count = (size_t)width * (size_t)height * (size_t)channels;
  float *values = malloc(count * sizeof *values);
  for (size_t i = 0; i < count; i++) values[i] = (float)i * 0.37f - 5;
  values[0] = INFINITY; // a depth where there is nothing
  AppError error;
  const char *path = in(folder, "a.pfm");
  assert_true(image_write_pfm(path, values, width, height, channels, &error));
  Image image;
  assert_true(image_read_pfm(path, &image, &error));
  assert_int_equal(image.width, width);
  assert_int_equal(image.channels, channels);
  assert_memory_equal(image.values, values, count * sizeof *values);
  image_free(&image);
  free(values);
}

static void test_pfm_round_trip(void **state) {
  (void)state;
  check_pfm(1, 1, 1);
  check_pfm(5, 3, 3);
  check_pfm(64, 37, 1);
  AppError error;
  assert_false(image_write_pfm(in(folder, "b.pfm"), (float[]){0, 0}, 1, 1, 2, &error));
  assert_false(file_exists(in(folder, "b.pfm")));
}

// The form that other programs read: rows from bottom to top, little-endian because the scale is negative.
static void test_pfm_layout(void **state) {
  (void)state;
  AppError error;
  assert_true(image_write_pfm(in(folder, "a.pfm"), (float[]){1, 2, 3, 4}, 2, 2, 1, &error));
  size_t size;
  uint8_t *bytes = file_get(in(folder, "a.pfm"), &size);
  static const uint8_t expected[] = "Pf\n2 2\n-1.0\n\0\0\x40\x40\0\0\x80\x40\0\0\x80\x3f\0\0\0\x40";
  assert_int_equal(size, sizeof expected - 1);
  assert_memory_equal(bytes, expected, size);
  free(bytes);
  // Big-endian ones are read too.
  static const char big[] = "Pf 1 1 1.0\n\x3f\x80\0\0";
  file_put(in(folder, "b.pfm"), big, sizeof big - 1);
  Image image;
  assert_true(image_read_pfm(in(folder, "b.pfm"), &image, &error));
  assert_float_equal(image.values[0], 1, 0);
  image_free(&image);
}

static void test_refused(void **state) {
  (void)state;
  static const char *const wrong[] = {"",
                                      "P",
                                      "Pf",
                                      "Pf 2",
                                      "PX 1 1 -1\n0000",
                                      "Pf 0 1 -1\n",
                                      "Pf -1 1 -1\n",
                                      "Pf 99999 99999 -1\n",
                                      "Pf 1 1 0\n0000",
                                      "Pf 1 1 nan\n0000",
                                      "Pf 16384 16384 -1\n0000",
                                      "Pf 1 1 -1\n000",
                                      "\x89PNG\r\n\x1a\n",
                                      "\x89PNG\r\n\x1a\nIHDR"};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    const char *path = in(folder, "wrong");
    file_put_text(path, wrong[i]);
    Image image;
    AppError error;
    assert_false(image_read_pfm(path, &image, &error));
    assert_int_equal(error.code, APP_BAD_INPUT);
    assert_false(image_read_png(path, &image, &error));
    assert_int_equal(error.code, APP_BAD_INPUT);
    assert_non_null(strstr(error.message, path));
  }
}

static void test_png_cut_short(void **state) {
  (void)state;
  AppError error;
  uint8_t rgb[8 * 8 * 3] = {1, 2, 3};
  assert_true(image_write_png(in(folder, "a.png"), rgb, 8, 8, &error));
  size_t size;
  uint8_t *bytes = file_get(in(folder, "a.png"), &size);
  size_t refused = 0;
  for (size_t cut = 0; cut < size; cut++) {
    file_put(in(folder, "cut.png"), bytes, cut);
    Image image;
    if (!image_read_png(in(folder, "cut.png"), &image, &error)) {
      refused++;
      continue;
    }
    assert_memory_equal(image.bytes, rgb, sizeof rgb); // only what stands behind the pixels may be missing
    image_free(&image);
  }
  assert_true(refused + 24 > size);
  free(bytes);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test_setup_teardown(test_png_round_trip, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_pfm_round_trip, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_pfm_layout, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_refused, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_png_cut_short, set_up, tear_down),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
