// The commands of the program, one row each: main calls exactly one of them.
#ifndef LIDO_APP_COMMANDS_H
#define LIDO_APP_COMMANDS_H

#include <stdbool.h>

#include "app/app.h"
#include "app/options.h"

/// X(name, its arguments, what it does)
#define COMMANDS(X) \
  X(window, "[SCENE]", "Open a window and play with the water.") \
  X(render, "SOURCE -o PATTERN", "Make pictures or a film without a window.") \
  X(simulate, "SCENE -o PATTERN", "Write the particles of every frame to files.") \
  X(check, "SCENE", "Check a scene and print it with every default filled in.") \
  X(bench, "[SCENE ...]", "Measure the time of every stage and pass.") \
  X(list, "", "Name the scenes, styles and contexts that work here.")

/// COMMAND_window, COMMAND_render …
typedef enum CommandIndex {
#define COMMAND_ENUM(name, arguments, summary) COMMAND_##name,
  COMMANDS(COMMAND_ENUM)
#undef COMMAND_ENUM
  COMMAND_COUNT
} CommandIndex;

// bool command_window(const Options *options, AppError *error); …
// true: exit code 0. false: main prints *error and ends with its code.
#define COMMAND_FUNCTION(name, arguments, summary) bool command_##name(const Options *options, AppError *error);
COMMANDS(COMMAND_FUNCTION)
#undef COMMAND_FUNCTION

#endif
