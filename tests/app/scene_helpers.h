// What the tests of scenes share.
#ifndef LIDO_TESTS_SCENE_HELPERS_H
#define LIDO_TESTS_SCENE_HELPERS_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/scene_table.h"

static inline bool load_with(Scene *scene, const char *text, const char *const *sets, int set_count, AppError *error) {
  return scene_load_text(scene, "t.json", text, strlen(text), sets, set_count, error);
}

/// A scene that must load.
static inline Scene load(const char *text) {
  Scene scene;
  AppError error = {APP_OK, ""};
  if (!load_with(&scene, text, NULL, 0, &error)) fail_msg("%s", error.message);
  return scene;
}

/// A scene that must be refused with exactly this message.
static inline void refused(const char *text, const char *message) {
  Scene scene;
  AppError error = {APP_OK, ""};
  if (load_with(&scene, text, NULL, 0, &error)) {
    scene_free(&scene);
    fail_msg("loaded, but should be refused: %s", message);
  }
  assert_string_equal(error.message, message);
  assert_int_equal(error.code, APP_BAD_INPUT);
  assert_null(scene.fluid);
}

/// Whole file as a string, to be freed.
static inline char *read_all(const char *path) {
  FILE *file = fopen(path, "rb");
  if (!file) fail_msg("%s cannot be opened", path);
  char *text = calloc(1, 1 << 20);
  assert_non_null(text);
  size_t size = fread(text, 1, (1 << 20) - 1, file);
  assert_true(size < (1 << 20) - 1);
  fclose(file);
  return text;
}

#endif
