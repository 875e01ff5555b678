// lido [SCENE]: open a window and play with the water.
#include "app/commands.h"
#include "app/scene.h"
#include "app/window.h"

bool command_window(const Options *options, AppError *error) {
  if (options->context != CONTEXT_AUTO && options->context != CONTEXT_GLFW)
    return app_fail(error, APP_BAD_INPUT,
                    "--context: a window needs auto or glfw; 'lido render' works with the others");
  Scene scene;
  if (!scene_load(&scene, options->source, options->sets, options->set_count, error)) return false;
  bool ok = window_run(&scene, options, error);
  scene_free(&scene);
  return ok;
}
