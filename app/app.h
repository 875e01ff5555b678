// What every file of the program shares: exit codes, the one-line error, and its version.
#ifndef LIDO_APP_APP_H
#define LIDO_APP_APP_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

/// Exit codes of the program.
typedef enum AppCode {
  APP_OK = 0,
  APP_FAILED = 1,   ///< it failed while running: disk full, no OpenGL, the simulation exploded
  APP_BAD_INPUT = 2 ///< the command line or an input file is wrong
} AppCode;

/// Why something failed: one line without "lido: " in front and without a newline, e.g.
/// "configs/x.json:12: simulation.particle_radius: must be in (0, 1] m, got -1". Only main prints it.
typedef struct AppError {
  AppCode code;
  char message[1024];
} AppError;

/// Fill *error and return false, so that a failing function can end with `return app_fail(…)`. The message is cut to
/// fit; control characters in it (from file names or files) are replaced by '?', so that it stays one line.
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
bool app_fail(AppError *error, AppCode code, const char *format, ...);

/// True once Ctrl-C (or SIGTERM) was pressed; loops over frames end after the frame at hand.
bool app_interrupted(void);
void app_catch_interrupts(void);
/// What a second Ctrl-C does before it ends the program at once. Must be safe in a signal handler.
void app_before_abrupt_end(void (*function)(void));

#endif
