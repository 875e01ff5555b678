// lido simulate: the particles of every frame to numbered files, without a renderer.
#include <stdlib.h>
#include <string.h>

#include "app/commands.h"
#include "app/output.h"
#include "app/particle_file.h"
#include "app/pattern.h"
#include "app/progress.h"
#include "app/source.h"
#include "app/stats.h"

// What is wrong with the command line beyond what its parser can know.
static bool check(const Options *options, Pattern *pattern, AppError *error) {
  if (!options->output) return app_fail(error, APP_BAD_INPUT, "-o: where to? Give a pattern like 'out/p_%%05d.vtk'");
  if (particle_file_named(options->source))
    return app_fail(error, APP_BAD_INPUT, "%s: a scene is needed to simulate, particle files can only be rendered",
                    options->source);
  if (!particle_file_named(options->output))
    return app_fail(error, APP_BAD_INPUT, "-o: '%s': must end in .vtk or .ply", options->output);
  return pattern_parse(pattern, options->output, error);
}

// Whether the first file can be written, before the frames up to it are simulated.
static bool probe(const Source *source, const Pattern *pattern, AppError *error) {
  char *path = pattern_expand(pattern, source_first(source));
  if (!path) return app_fail(error, APP_FAILED, "out of memory");
  bool fine = output_probe(path, error);
  free(path);
  return fine;
}

static bool write_frame(Source *source, const Pattern *pattern, Stats *stats, AppError *error) {
  const SimFrame *frame = source_frame(source, SIM_NEED_NOTHING, error);
  if (!frame) return false;
  char *path = pattern_expand(pattern, source_number(source));
  if (!path) return app_fail(error, APP_FAILED, "out of memory");
  bool written = particle_file_write(path, frame, error);
  free(path);
  if (written && stats) stats_frame(stats, frame, source_world(source), NULL);
  return written;
}

static bool run(const Options *options, const Pattern *pattern, Source *source, Stats *stats, AppError *error) {
  Progress progress;
  progress_start(&progress, source_count(source), options->quiet);
  int64_t written = 0;
  SourceStep step;
  bool fine = true;
  while (fine && (step = source_next(source, error)) != SOURCE_END) {
    fine = step == SOURCE_FRAME && write_frame(source, pattern, stats, error);
    if (fine) progress_step(&progress, ++written);
  }
  return progress_conclude(&progress, fine, written, options->output, error);
}

bool command_simulate(const Options *options, AppError *error) {
  Pattern *pattern = malloc(sizeof *pattern);
  if (!pattern) return app_fail(error, APP_FAILED, "out of memory");
  Source *source = NULL;
  Stats *stats = NULL;
  bool fine = check(options, pattern, error) && (source = source_open(options, error)) != NULL;
  if (fine && !pattern->numbered && source_count(source) > 1)
    fine = app_fail(error, APP_BAD_INPUT, "-o: '%s': the name needs a number (%%05d) where there are several frames",
                    options->output);
  if (fine && scene_ripple(source_scene(source)))
    fine = app_fail(error, APP_BAD_INPUT, "%s: its water is a ripple and has no particles to write; lido render draws it",
                    options->source);
  fine = fine && probe(source, pattern, error);
  if (fine && options->stats) fine = (stats = stats_open(options->stats, error)) != NULL;
  if (fine) {
    fine = run(options, pattern, source, stats, error);
    // What was measured is kept, also when the run ended early; the first error is the one that is told.
    AppError second;
    fine = stats_close(stats, fine ? error : &second) && fine;
  }
  source_close(source);
  free(pattern);
  return fine;
}
