// lido render: pictures, a film or raw frames of a scene or of particle files, without a window.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/commands.h"
#include "app/context.h"
#include "app/hud.h"
#include "app/progress.h"
#include "app/record.h"
#include "app/source.h"
#include "app/stats.h"
#include "app/style_grid.h"

// Everything that a run holds, in the order in which it is made.
typedef struct Job {
  const Options *options;
  RecordKind kind;
  Source *source;
  Context *context;
  Render *render;
  StyleGrid grid;  // one place, or one for each style of a list
  uint8_t *pixels; // a picture, (grid.height, grid.width, 3)
  uint8_t *cell;   // a place in it, (height, width, 3); NULL where there is only one
  float *values;   // a raw layer, (height, width, 3)
  Stats *stats;
  Record *record;
  const SimFrame *frame; // the present one
  int64_t written;
} Job;

static bool render_fail(AppError *error, const RenderError *cause) {
  return app_fail(error, APP_FAILED, "%s", cause->message);
}

// ---- Layers --------------------------------------------------------------------------------------------------------------------

static bool has_layer(const char *style, const char *layer) {
  for (int32_t i = 0; i < render_layer_count(style); i++)
    if (strcmp(render_layer_name(style, i), layer) == 0) return true;
  return false;
}

static bool no_layer(const char *style, const char *layer, AppError *error) {
  char names[400] = "";
  for (int32_t i = 0; i < render_layer_count(style); i++) {
    size_t used = strlen(names);
    snprintf(names + used, sizeof names - used, "%s%s", i ? ", " : "", render_layer_name(style, i));
  }
  return app_fail(error, APP_BAD_INPUT, "--layer %.100s: style '%s' has no such layer; it has: %s", layer, style,
                  names);
}

// ---- Begin ---------------------------------------------------------------------------------------------------------------------

// What is wrong with the command line beyond what its parser can know.
static bool check(Job *job, AppError *error) {
  const Options *options = job->options;
  if (!options->output)
    return app_fail(error, APP_BAD_INPUT, "-o: where to? Give a pattern like 'out/f_%%05d.png', 'film.mp4' or '-'");
  if (!record_kind(options->output, &job->kind, error)) return false;
  if (job->kind == RECORD_PFM && !options->layer)
    return app_fail(error, APP_BAD_INPUT, "-o: '%s': .pfm holds the raw values of a layer, name one with --layer",
                    options->output);
  return true;
}

static bool begin_drawing(Job *job, AppError *error) {
  const Options *options = job->options;
  job->grid = style_grid_make(options->style_count > 1 ? options->style_count : 1, options->width, options->height);
  size_t size = (size_t)options->width * (size_t)options->height * 3,
         places = (size_t)(job->grid.columns * job->grid.rows);
  job->context = context_create_headless(options->context, error);
  if (!job->context) return false;
  RenderError cause;
  job->render = render_create(options->width, options->height, &cause);
  if (!job->render) return render_fail(error, &cause);
  if (options->layer)
    render_show_layer(job->render, options->layer); // whether the style has it is asked frame by frame
  job->pixels = calloc(places, size);
  if (places > 1) job->cell = malloc(size);
  if (job->kind == RECORD_PFM) job->values = malloc(size * sizeof *job->values);
  if (!job->pixels || (places > 1 && !job->cell) || (job->kind == RECORD_PFM && !job->values))
    return app_fail(error, APP_FAILED, "out of memory");
  return true;
}

static bool begin_recording(Job *job, AppError *error) {
  const Options *options = job->options;
  RecordDef def = {options->output, job->grid.width,           job->grid.height,
                   options->fps,    source_first(job->source), source_count(job->source)};
  if (options->stats && !(job->stats = stats_open(options->stats, error))) return false;
  job->record = record_open(&def, error);
  return job->record != NULL;
}

// ---- One frame -----------------------------------------------------------------------------------------------------------------

static bool draw_style(Job *job, const char *style, AppError *error) {
  const char *layer = job->options->layer;
  if (layer && !has_layer(style, layer)) return no_layer(style, layer, error);
  RenderSettings settings = *source_settings(job->source);
  settings.style = style;
  RenderError cause;
  return render_draw(job->render, job->frame, source_view(job->source), &settings, &cause) ||
         render_fail(error, &cause);
}

// The style's name in a corner of its picture.
static void draw_name(Job *job, const char *style) {
  char text[80];
  int scale = hud_scale(1, job->options->width, job->options->height);
  render_text(job->render, HUD_GLYPH_WIDTH * scale, HUD_LINE_HEIGHT * scale, scale,
              hud_block(style, text, sizeof text));
}

// One frame serves all styles: it is simulated once, with whatever one of them needs.
static bool draw_styles(Job *job, AppError *error) {
  const Options *options = job->options;
  unsigned needs = 0;
  for (int i = 0; i < options->style_count; i++)
    needs |= render_style_needs(options->styles[i], source_settings(job->source));
  job->frame = source_frame(job->source, needs, error);
  if (!job->frame) return false;
  for (int i = 0; i < options->style_count; i++) {
    if (!draw_style(job, options->styles[i], error)) return false;
    if (!options->no_names) draw_name(job, options->styles[i]);
    render_read_rgb8(job->render, job->cell);
    style_grid_put(&job->grid, i, job->cell, job->pixels);
  }
  return true;
}

static bool draw(Job *job, AppError *error) {
  if (job->cell) return draw_styles(job, error);
  const char *style = source_settings(job->source)->style;
  job->frame = source_frame(job->source, render_style_needs(style, source_settings(job->source)), error);
  if (!job->frame || !draw_style(job, style, error)) return false;
  if (job->kind != RECORD_PFM) render_read_rgb8(job->render, job->pixels);
  return true;
}

static bool record(Job *job, AppError *error) {
  int64_t number = source_number(job->source);
  if (job->kind != RECORD_PFM) return record_picture(job->record, number, job->pixels, error);
  int32_t channels;
  if (!render_read_layer(job->render, job->values, &channels))
    return app_fail(error, APP_FAILED, "--layer %s: its values cannot be read", job->options->layer);
  return record_values(job->record, number, job->values, channels, error);
}

static bool run(Job *job, AppError *error) {
  Progress progress;
  progress_start(&progress, source_count(job->source), job->options->quiet);
  SourceStep step;
  bool fine = true;
  while (fine && (step = source_next(job->source, error)) != SOURCE_END) {
    fine = step == SOURCE_FRAME && draw(job, error) && record(job, error);
    if (!fine) break;
    if (job->stats) stats_frame(job->stats, job->frame, source_world(job->source), job->render);
    progress_step(&progress, ++job->written);
  }
  // A film that ended early is finished all the same, so that its frames so far are kept; one without frames is none.
  int64_t kept = job->written;
  AppError second;
  if (kept > 0 && !record_close(job->record, fine ? error : &second)) {
    fine = false;
    if (job->kind == RECORD_FILM) kept = 0;
  } else if (kept == 0) {
    record_abort(job->record);
  }
  job->record = NULL;
  const char *where = job->kind == RECORD_RAW ? "standard output" : job->options->output;
  return progress_conclude(&progress, fine, kept, where, error);
}

static void end(Job *job) {
  record_abort(job->record);
  stats_abort(job->stats);
  free(job->values);
  free(job->cell);
  free(job->pixels);
  render_destroy(job->render);
  context_destroy(job->context);
  source_close(job->source);
}

bool command_render(const Options *options, AppError *error) {
  Job job = {.options = options};
  bool fine = check(&job, error) && (job.source = source_open(options, error)) != NULL && begin_drawing(&job, error) &&
              begin_recording(&job, error);
  if (fine) {
    fine = run(&job, error);
    // What was measured is kept, also when the run ended early; the first error is the one that is told.
    AppError second;
    fine = stats_close(job.stats, fine ? error : &second) && fine;
    job.stats = NULL;
  }
  end(&job);
  return fine;
}
