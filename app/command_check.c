// lido check: validate a scene and print it whole. Also prints what else comes from the field table, so that
// configs/scene.schema.json and docs/scene.md can be made anew:
//   lido check --schema > configs/scene.schema.json
//   lido check --reference > docs/scene.md
#include <stdio.h>
#include <stdlib.h>

#include "app/commands.h"
#include "app/scene.h"

static bool print_and_free(char *text, AppError *error) {
  if (!text) return app_fail(error, APP_FAILED, "out of memory");
  fputs(text, stdout);
  free(text);
  return true;
}

bool command_check(const Options *options, AppError *error) {
  if (options->schema) return print_and_free(scene_schema(), error);
  if (options->reference) return print_and_free(scene_reference(), error);
  Scene scene;
  if (!scene_load(&scene, options->source, options->sets, options->set_count, error)) return false;
  char *text = options->quiet ? NULL : scene_print(&scene);
  scene_free(&scene);
  return options->quiet || print_and_free(text, error);
}
