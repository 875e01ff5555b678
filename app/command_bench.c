// lido bench: how long each stage of the simulator and each pass of the renderer takes on a scene.
//
// Warm-up frames are run first and not counted; then every frame's times are kept and the least and the median are
// shown: "draw" is the time of each pass, from which the next one is kept apart by waiting for the GPU; "cpu" the processor
// time of all threads in it, which is what a picture costs with a software renderer.
// Simulation and drawing run one after the other here, so that neither disturbs the other's figures. Then the world is
// run alone on 1, 2, 4 … threads, and what the machine can do at best is measured.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "app/bench_frames.h"
#include "app/commands.h"
#include "app/events.h"

enum { DEFAULT_FRAMES = 60 };

double bench_now_ms(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

// Processor time of all threads of this process, a software renderer's among them.
static double processor_ms(void) {
  struct timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static int compare_doubles(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

double bench_median(BenchSeries *series) {
  int n = series->count;
  if (n == 0) return 0;
  qsort(series->value, (size_t)n, sizeof *series->value, compare_doubles);
  return n % 2 ? series->value[n / 2] : (series->value[n / 2 - 1] + series->value[n / 2]) / 2;
}

// ---- Samples ---------------------------------------------------------------------------------------------------------

static void add_value(const Bench *bench, BenchSeries *series, double value) {
  if (!series->value) series->value = malloc((size_t)bench->frames * sizeof *series->value);
  if (series->value && series->count < bench->frames) series->value[series->count++] = value;
}

// `particles` and `pairs` are what the time stands for; 0: nothing that could be counted.
static void add_sample(Bench *bench, const char *group, const char *name, double ms, double particles, double pairs) {
  BenchRow *row = NULL;
  for (int i = 0; i < bench->row_count && !row; i++)
    if (!strcmp(bench->rows[i].group, group) && !strcmp(bench->rows[i].name, name)) row = &bench->rows[i];
  if (!row) {
    if (bench->row_count == BENCH_ROWS) return;
    row = &bench->rows[bench->row_count++];
    snprintf(row->group, sizeof row->group, "%s", group);
    snprintf(row->name, sizeof row->name, "%s", name);
  }
  add_value(bench, &row->milliseconds, ms);
  if (particles > 0) add_value(bench, &row->each, ms * 1e6 / particles);
  if (pairs > 0) add_value(bench, &row->pair, ms * 1e6 / pairs);
}

// A stage of the step works on every particle in each substep, a stage of the frame once.
static void add_stage(Bench *bench, SimStage stage, const SimProfile *profile, int32_t count) {
  bool frame = stage >= SIM_STAGE_frame;
  static const bool visits_pairs[SIM_STAGE_COUNT] = {
      [SIM_STAGE_neighbours] = true, [SIM_STAGE_tension] = true, [SIM_STAGE_warm_start] = true,
      [SIM_STAGE_density] = true,    [SIM_STAGE_correct] = true, [SIM_STAGE_vorticity] = true,
      [SIM_STAGE_viscosity] = true,  [SIM_STAGE_mix] = true,     [SIM_STAGE_classify] = true,
      [SIM_STAGE_flags] = true};
  double times = frame ? 1 : (double)profile->substeps;
  double pairs = profile->substeps ? (double)profile->neighbour_pairs / (double)profile->substeps : 0;
  double ms = profile->milliseconds[stage];
  add_sample(bench, "sim", sim_stage_name(stage), ms, times * count, visits_pairs[stage] && ms > 0 ? times * pairs : 0);
}

// ---- Frames ----------------------------------------------------------------------------------------------------------

bool bench_advance(Bench *bench, SimWorld *world, int index, AppError *error) {
  SimError sim_error;
  double time = index * bench->frame_seconds;
  if (!events_apply(&bench->scene, time, bench->frame_seconds, world, &bench->settings, &bench->view, error))
    return false;
  return sim_world_advance(world, bench->frame_seconds, &sim_error) ||
         app_fail(error, APP_FAILED, "%s", sim_error.message);
}

static bool simulate_frame(Bench *bench, int index, bool counted, const SimFrame **frame, AppError *error) {
  SimError sim_error;
  sim_world_clear_profile(bench->world);
  double start = bench_now_ms();
  if (!bench_advance(bench, bench->world, index, error)) return false;
  unsigned needs = SIM_NEED_ALL & ~(unsigned)SIM_NEED_SECOND_LAYER; // which is off by default
  if (bench->render) needs = render_style_needs(bench->settings.style, &bench->settings);
  *frame = sim_world_frame(bench->world, needs, bench->buffer, &sim_error);
  if (!*frame) return app_fail(error, APP_FAILED, "%s", sim_error.message);
  double elapsed = bench_now_ms() - start;
  if (!counted) return true;

  const SimProfile *profile = sim_world_profile(bench->world);
  for (int s = 0; s < SIM_STAGE_COUNT; s++) add_stage(bench, (SimStage)s, profile, (*frame)->count);
  double steps = (double)profile->substeps * (*frame)->count;
  add_sample(bench, "sim", "total", elapsed, steps, (double)profile->neighbour_pairs);
  bench->simulated_ms += elapsed;
  bench->substeps += profile->substeps;
  bench->particle_steps += profile->substeps * (*frame)->count;
  bench->pairs += profile->neighbour_pairs;
  return true;
}

static bool draw_frame(Bench *bench, const SimFrame *frame, bool counted, AppError *error) {
  RenderError render_error;
  RenderPassTime passes[BENCH_PASSES];
  double start = bench_now_ms(), used = processor_ms();
  if (!render_draw(bench->render, frame, &bench->view, &bench->settings, &render_error))
    return app_fail(error, APP_FAILED, "%s", render_error.message);
  int count = render_pass_times(bench->render, passes, BENCH_PASSES); // waits for the GPU
  double elapsed = bench_now_ms() - start;
  used = processor_ms() - used;
  if (!counted) return true;
  for (int p = 0; p < count && p < BENCH_PASSES; p++)
    add_sample(bench, "draw", passes[p].name, passes[p].cpu_milliseconds, 0, 0);
  add_sample(bench, "draw", "total", elapsed, 0, 0);
  for (int p = 0; p < count && p < BENCH_PASSES; p++)
    add_sample(bench, "cpu", passes[p].name, passes[p].processor_milliseconds, 0, 0);
  add_sample(bench, "cpu", "total", used, 0, 0);
  return true;
}

// ---- The command -----------------------------------------------------------------------------------------------------

static bool open_bench(Bench *bench, const Options *options, AppError *error) {
  if (!scene_load(&bench->scene, options->source, options->sets, options->set_count, error)) return false;
  bench_look(&bench->scene, options, 0, &bench->settings, &bench->view);
  bench->frame_seconds = 1 / options->fps;
  bench->frames = options->last_frame >= 0 ? options->last_frame - options->first_frame + 1 : DEFAULT_FRAMES;

  bench->threads = options->threads;
  bench->world = scene_world_create(&bench->scene, options->threads, error);
  if (!bench->world) return false;
  SimCounts counts = sim_world_counts(bench->world);
  if (!options->quiet) scene_tell_left_out(&bench->scene, &counts);
  bench->buffer = sim_frame_buffer_create();
  if (!bench->buffer) return app_fail(error, APP_FAILED, "out of memory");

  // The simulator can be timed where there is no OpenGL; say so rather than fail.
  AppError context_error;
  bench->context = context_create_headless(options->context, &context_error);
  if (!bench->context) {
    if (options->context != CONTEXT_AUTO) return *error = context_error, false;
    fprintf(stderr, "lido: timing the simulator only: %s\n", context_error.message);
    return true;
  }
  RenderError render_error;
  bench->render = render_create(options->width, options->height, &render_error);
  if (!bench->render) return app_fail(error, APP_FAILED, "%s", render_error.message);
  render_measure_passes(bench->render, true);
  return true;
}

static void close_bench(Bench *bench) {
  for (int i = 0; i < bench->row_count; i++) {
    free(bench->rows[i].milliseconds.value);
    free(bench->rows[i].each.value);
    free(bench->rows[i].pair.value);
  }
  render_destroy(bench->render);
  context_destroy(bench->context);
  sim_frame_buffer_destroy(bench->buffer);
  sim_world_destroy(bench->world);
  scene_free(&bench->scene);
}

static bool measure_machine(Bench *bench, AppError *error) {
  SimError sim_error;
  return sim_measure_machine(bench->threads, &bench->machine, &sim_error) ||
         app_fail(error, APP_FAILED, "measuring the machine: %s", sim_error.message);
}

bool command_bench(const Options *options, AppError *error) {
  if (options->vary_count > 0) return bench_vary(options, error);
  if (options->size_count > 0 || options->particle_counts > 0) return bench_pictures(options, error);
  Bench bench = {0};
  bool ok = open_bench(&bench, options, error);
  for (int i = 0; ok && i < BENCH_WARM_UP + bench.frames && !app_interrupted(); i++) {
    const SimFrame *frame = NULL;
    bool counted = i >= BENCH_WARM_UP;
    ok = simulate_frame(&bench, i, counted, &frame, error) &&
         (!bench.render || draw_frame(&bench, frame, counted, error));
  }
  SimCounts counts = ok ? sim_world_counts(bench.world) : (SimCounts){0};
  ok = ok && bench_scaling(&bench, error) && measure_machine(&bench, error);
  if (ok && app_interrupted()) ok = app_fail(error, APP_FAILED, "interrupted");
  if (ok) {
    if (options->json)
      bench_print_json(&bench, &counts);
    else
      bench_print_table(&bench, &counts);
  }
  close_bench(&bench);
  return ok;
}
