// lido [SCENE]: open a window and play with the water.
#include "app/commands.h"
#include "app/context_glfw.h"
#include "app/scene.h"
#include "app/window.h"

bool command_window(const Options *options, AppError *error) {
  if (options->context != CONTEXT_AUTO && options->context != CONTEXT_GLFW)
    return app_fail(error, APP_BAD_INPUT,
                    "--context: a window needs auto or glfw; 'lido render' works with the others");
  Scene scene;
  if (!scene_load(&scene, options->source, options->sets, options->set_count, error)) return false;
  char why[256];
  bool ok = context_glfw_has_display(why, sizeof why)
                ? window_run(&scene, options, error)
                : app_fail(error, APP_FAILED, "no window: %s; 'lido render' makes pictures without one", why);
  scene_free(&scene);
  return ok;
}
