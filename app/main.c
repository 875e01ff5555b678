// lido: parse the command line, run one command, say in one line what went wrong.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/commands.h"
#include "sim/sim.h"

typedef bool CommandFunction(const Options *options, AppError *error);

static CommandFunction *const functions[] = {
#define COMMAND_ROW(name, arguments, summary) command_##name,
    COMMANDS(COMMAND_ROW)
#undef COMMAND_ROW
};

/// Output that could not be written is a failure too: a full disk, a closed pipe.
static bool flush_output(AppError *error) {
  if (fflush(stdout) == 0 && !ferror(stdout)) return true;
  return app_fail(error, APP_FAILED, "the standard output cannot be written");
}

static bool run(Options *options, int argc, char **argv, AppError *error) {
  if (!options_parse(options, argc, argv, error)) return false;
  if (options->help) {
    bool named = argc > 1 && (options->command != COMMAND_window || strcmp(argv[1], "window") == 0);
    options_print_help(stdout, named ? options->command : -1);
    return flush_output(error);
  }
  if (options->version) {
    printf("lido %s\n", SIM_VERSION_STRING);
    return flush_output(error);
  }
  app_catch_interrupts();
  return functions[options->command](options, error) && flush_output(error);
}

/// OpenMP's threads spin while they wait, which takes the cores away from the drawing thread, the driver's threads and
/// everybody else (a busy machine ran the simulator at a quarter of its speed). The runtime reads its wait policy before
/// main, so the program starts itself anew with the policy set, unless the user chose one. Should that fail, it is
/// merely slower.
static void wait_passively(char **argv) {
  if (getenv("OMP_WAIT_POLICY") || getenv("GOMP_SPINCOUNT")) return;
  if (setenv("OMP_WAIT_POLICY", "passive", 1) == 0 && setenv("GOMP_SPINCOUNT", "1000", 1) == 0)
    execv("/proc/self/exe", argv);
}

int main(int argc, char **argv) {
  wait_passively(argv);
  AppError error = {APP_OK, ""};
  Options options;
  bool good = run(&options, argc, argv, &error);
  options_free(&options);
  if (good) return APP_OK;
  fprintf(stderr, "lido: %s\n", error.message);
  return error.code == APP_OK ? APP_FAILED : (int)error.code;
}
