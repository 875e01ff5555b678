// The time of a picture with each combination of the values that --vary gives to keys of the scene, as Table I of Rocha and
// Neto (2014) has it: with the simulation of the frame, and without.
//
// Each frame is simulated once and drawn with every combination right after each other, so that ratios are between
// pictures of one moment, whatever else the machine does meanwhile. The turn begins with another combination in every
// frame, since the first one may find caches and clocks as the simulation has left them.
#include "app/bench_vary.h"

#include <stdio.h>
#include <stdlib.h>

#include "app/bench_frames.h"

/// One combination, and what draws it: a style may make its targets anew when its settings change.
typedef struct Combination {
  Scene scene;
  RenderSettings settings;
  RenderView view;
  Render *render;
  double *picture_ms; // (frames)
} Combination;

typedef struct Measuring {
  const Options *options;
  Bench bench; // the world; it moves alike in all combinations
  int count, frames, counted;
  Combination combinations[VARY_MOST_COMBINATIONS]; // (count)
  double *simulated_ms;                             // (frames)
  double *scratch;                                  // (frames)
  int32_t particles;
} Measuring;

// ---- Scenes ----------------------------------------------------------------------------------------------------------

/// The scene with the values of one combination on top of what --set says.
static bool load_combination(const Options *options, const char *source, int combination, Scene *scene,
                             AppError *error) {
  int count = options->set_count + options->vary_count;
  const char **sets = malloc((size_t)count * sizeof *sets);
  char *varied[VARY_MOST_KEYS] = {NULL};
  bool ok = sets != NULL;
  for (int i = 0; ok && i < options->set_count; i++) sets[i] = options->sets[i];
  for (int k = 0; ok && k < options->vary_count; k++) {
    varied[k] = vary_set(options->varies[k], vary_place(options->varies, options->vary_count, k, combination));
    sets[options->set_count + k] = varied[k];
    ok = varied[k] != NULL;
  }
  ok = ok ? scene_load(scene, source, sets, count, error) : app_fail(error, APP_FAILED, "out of memory");
  for (int k = 0; k < options->vary_count; k++) free(varied[k]);
  free(sets);
  return ok;
}

/// Whatever is wrong with any of them is said before the first is run.
static bool check_scenes(const Options *options, AppError *error) {
  int count = vary_combination_count(options->varies, options->vary_count);
  for (int s = 0; s < options->source_count; s++) {
    for (int c = 0; c < count; c++) {
      Scene scene;
      if (!load_combination(options, options->sources[s], c, &scene, error)) return false;
      scene_free(&scene);
    }
  }
  return true;
}

static bool open_combination(Combination *combination, const Measuring *m, const char *source, int index,
                             AppError *error) {
  const int size[2] = {m->options->width, m->options->height};
  if (!load_combination(m->options, source, index, &combination->scene, error)) return false;
  combination->render = bench_render_create(size, error);
  if (!combination->render) return false;
  combination->picture_ms = malloc((size_t)m->frames * sizeof(double));
  return combination->picture_ms || app_fail(error, APP_FAILED, "out of memory");
}

static bool open_measuring(Measuring *m, const char *source, AppError *error) {
  m->simulated_ms = malloc((size_t)m->frames * sizeof(double));
  m->scratch = malloc((size_t)m->frames * sizeof(double));
  if (!m->simulated_ms || !m->scratch) return app_fail(error, APP_FAILED, "out of memory");
  for (int c = 0; c < m->count; c++)
    if (!open_combination(&m->combinations[c], m, source, c, error)) return false;
  return load_combination(m->options, source, 0, &m->bench.scene, error) &&
         bench_frames_open(&m->bench, m->options, error);
}

static void close_measuring(Measuring *m) {
  for (int c = 0; c < m->count; c++) {
    render_destroy(m->combinations[c].render);
    scene_free(&m->combinations[c].scene);
    free(m->combinations[c].picture_ms);
  }
  bench_frames_close(&m->bench);
  free(m->simulated_ms);
  free(m->scratch);
}

// ---- Frames ----------------------------------------------------------------------------------------------------------

static unsigned prepare(void *self, int index) {
  Measuring *m = self;
  unsigned needs = SIM_NEED_NOTHING;
  for (int c = 0; c < m->count; c++) {
    Combination *combination = &m->combinations[c];
    bench_look(&combination->scene, m->options, index, &combination->settings, &combination->view);
    needs |= render_style_needs(combination->settings.style, &combination->settings);
  }
  return needs;
}

static bool draw_combinations(void *self, const SimFrame *frame, double simulated_ms, bool counted, AppError *error) {
  Measuring *m = self;
  for (int turn = 0; turn < m->count && !app_interrupted(); turn++) {
    Combination *combination = &m->combinations[(turn + m->counted) % m->count];
    double milliseconds;
    if (!bench_draw(combination->render, frame, &combination->view, &combination->settings, &milliseconds, error))
      return false;
    if (counted) combination->picture_ms[m->counted] = milliseconds;
  }
  m->particles = frame->count;
  if (counted) m->simulated_ms[m->counted++] = simulated_ms;
  return true;
}

// ---- What comes of them ----------------------------------------------------------------------------------------------

static double median_of_scratch(const Measuring *m) {
  BenchSeries series = {m->scratch, m->frames};
  return bench_median(&series); // sorts
}

/// Of a combination, with as much of the simulation as `share` says; *ratio: to the first combination.
static double median(const Measuring *m, int index, double share, double *ratio) {
  const double *first = m->combinations[0].picture_ms, *own = m->combinations[index].picture_ms;
  for (int i = 0; i < m->frames; i++)
    m->scratch[i] = (own[i] + share * m->simulated_ms[i]) / (first[i] + share * m->simulated_ms[i]);
  *ratio = median_of_scratch(m);
  for (int i = 0; i < m->frames; i++) m->scratch[i] = own[i] + share * m->simulated_ms[i];
  return median_of_scratch(m);
}

static void fill_table(const Measuring *m, VaryTable *table) {
  table->particles = m->particles;
  for (int i = 0; i < m->frames; i++) m->scratch[i] = m->simulated_ms[i];
  table->simulation_ms = median_of_scratch(m);
  for (int c = 0; c < m->count; c++) {
    VaryTimes *times = &table->times[c];
    snprintf(times->style, sizeof times->style, "%s", m->combinations[c].settings.style);
    times->with_simulation_ms = median(m, c, 1, &times->with_simulation_ratio);
    times->median_ms = median(m, c, 0, &times->ratio);
    times->least_ms = m->scratch[0];
  }
}

static bool measure(const Options *options, const char *source, VaryTable *table, Text *json, AppError *error) {
  Measuring m = {.options = options, .count = table->combinations, .frames = table->frames};
  BenchPainter painter = {.self = &m, .prepare = prepare, .draw = draw_combinations};
  bool ok = open_measuring(&m, source, error) && bench_frames_run(&m.bench, options, &painter, error);
  if (ok && app_interrupted()) ok = app_fail(error, APP_FAILED, "interrupted");
  if (ok) {
    fill_table(&m, table);
    if (options->json)
      bench_vary_json(table, json);
    else
      bench_vary_print(table, render_gl_description(m.combinations[0].render));
  }
  close_measuring(&m);
  return ok;
}

bool bench_vary(const Options *options, AppError *error) {
  if (!check_scenes(options, error)) return false;
  Context *context = context_create_headless(options->context, error);
  bool ok = context != NULL;
  int frames = bench_frames_counted(options);
  Text json = {0};
  text_format(&json, "{\"pictures\": %d, \"width\": %d, \"height\": %d, \"scenes\": [\n", frames, options->width,
              options->height);
  for (int s = 0; ok && s < options->source_count; s++) {
    VaryTable table = {.options = options, .source = options->sources[s], .frames = frames};
    table.combinations = vary_combination_count(options->varies, options->vary_count);
    if (s > 0) text_add(&json, ",\n");
    ok = measure(options, options->sources[s], &table, &json, error);
    if (s + 1 < options->source_count && ok && !options->json) printf("\n");
  }
  context_destroy(context);
  text_add(&json, "\n]}\n");
  char *text = text_take(&json);
  if (ok && options->json) ok = text ? fputs(text, stdout) >= 0 : app_fail(error, APP_FAILED, "out of memory");
  free(text);
  return ok;
}
