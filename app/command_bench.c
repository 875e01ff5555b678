// lido bench: how long each stage of the simulator and each pass of the renderer takes on a scene.
//
// Warm-up frames are run first and not counted; then every frame's times are kept and the least and the median are
// shown: "draw" is the GPU's time (with a software renderer, the processor's), "submit" the calling thread's.
// Simulation and drawing run one after the other here, so that neither disturbs the other's figures.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "app/commands.h"
#include "app/context.h"
#include "app/events.h"
#include "app/scene.h"

enum { WARM_UP_FRAMES = 5, DEFAULT_FRAMES = 60, MAX_PASSES = 64, MAX_ROWS = SIM_STAGE_COUNT + 2 * MAX_PASSES + 2 };

/// One line of the table: the milliseconds of one stage or pass in every counted frame.
typedef struct Row {
  char group[16], name[48];
  double *samples; // ms, (frames)
  int count;
} Row;

typedef struct Bench {
  Scene scene;
  SimWorld *world;
  SimFrameBuffer *buffer;
  Context *context; // NULL: no OpenGL here, only the simulator is timed
  Render *render;
  RenderSettings settings;
  RenderView view;
  double frame_seconds;
  int frames;
  Row rows[MAX_ROWS];
  int row_count;
  // Sums over the counted frames.
  double simulated_ms;
  int64_t substeps, particle_steps, pairs;
} Bench;

static double now_ms(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static void add_sample(Bench *bench, const char *group, const char *name, double ms) {
  Row *row = NULL;
  for (int i = 0; i < bench->row_count && !row; i++)
    if (!strcmp(bench->rows[i].group, group) && !strcmp(bench->rows[i].name, name)) row = &bench->rows[i];
  if (!row) {
    if (bench->row_count == MAX_ROWS) return;
    row = &bench->rows[bench->row_count];
    row->samples = malloc((size_t)bench->frames * sizeof *row->samples);
    if (!row->samples) return;
    bench->row_count++;
    snprintf(row->group, sizeof row->group, "%s", group);
    snprintf(row->name, sizeof row->name, "%s", name);
  }
  if (row->count < bench->frames) row->samples[row->count++] = ms;
}

static bool simulate_frame(Bench *bench, int index, bool counted, const SimFrame **frame, AppError *error) {
  SimError sim_error;
  double time = index * bench->frame_seconds;
  sim_world_clear_profile(bench->world);
  if (!events_apply(&bench->scene, time, bench->frame_seconds, bench->world, &bench->settings, &bench->view, error))
    return false;
  double start = now_ms();
  if (!sim_world_advance(bench->world, bench->frame_seconds, &sim_error))
    return app_fail(error, APP_FAILED, "%s", sim_error.message);
  unsigned needs = bench->render ? render_style_needs(bench->settings.style) : SIM_NEED_ALL;
  *frame = sim_world_frame(bench->world, needs, bench->buffer, &sim_error);
  if (!*frame) return app_fail(error, APP_FAILED, "%s", sim_error.message);
  double elapsed = now_ms() - start;
  if (!counted) return true;

  const SimProfile *profile = sim_world_profile(bench->world);
  for (int s = 0; s < SIM_STAGE_COUNT; s++)
    add_sample(bench, "sim", sim_stage_name((SimStage)s), profile->milliseconds[s]);
  add_sample(bench, "sim", "total", elapsed);
  bench->simulated_ms += elapsed;
  bench->substeps += profile->substeps;
  bench->particle_steps += profile->substeps * (*frame)->count;
  bench->pairs += profile->neighbour_pairs;
  return true;
}

static bool draw_frame(Bench *bench, const SimFrame *frame, bool counted, AppError *error) {
  RenderError render_error;
  RenderPassTime passes[MAX_PASSES];
  double start = now_ms();
  if (!render_draw(bench->render, frame, &bench->view, &bench->settings, &render_error))
    return app_fail(error, APP_FAILED, "%s", render_error.message);
  int count = render_pass_times(bench->render, passes, MAX_PASSES); // waits for the GPU
  double elapsed = now_ms() - start;
  if (!counted) return true;
  for (int p = 0; p < count && p < MAX_PASSES; p++)
    add_sample(bench, "draw", passes[p].name, passes[p].gpu_milliseconds);
  add_sample(bench, "draw", "total", elapsed);
  for (int p = 0; p < count && p < MAX_PASSES; p++)
    add_sample(bench, "submit", passes[p].name, passes[p].cpu_milliseconds);
  return true;
}

static bool open_bench(Bench *bench, const Options *options, AppError *error) {
  if (!scene_load(&bench->scene, options->source, options->sets, options->set_count, error)) return false;
  bench->settings = scene_render_settings(&bench->scene);
  bench->view = scene_view(&bench->scene);
  if (options->style) bench->settings.style = options->style;
  bench->frame_seconds = 1 / options->fps;
  bench->frames = options->last_frame >= 0 ? options->last_frame - options->first_frame + 1 : DEFAULT_FRAMES;

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
  return bench->render || app_fail(error, APP_FAILED, "%s", render_error.message);
}

static void close_bench(Bench *bench) {
  for (int i = 0; i < bench->row_count; i++) free(bench->rows[i].samples);
  render_destroy(bench->render);
  context_destroy(bench->context);
  sim_frame_buffer_destroy(bench->buffer);
  sim_world_destroy(bench->world);
  scene_free(&bench->scene);
}

static int compare_doubles(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/// Sorts the samples in place.
static double median(Row *row) {
  qsort(row->samples, (size_t)row->count, sizeof *row->samples, compare_doubles);
  return row->count % 2 ? row->samples[row->count / 2]
                        : (row->samples[row->count / 2 - 1] + row->samples[row->count / 2]) / 2;
}

static void print_table(Bench *bench, const SimCounts *counts) {
  printf("%s: %d particles, %d frames of 1/%.0f s, %.1f substeps each\n", bench->scene.path, counts->particles,
         bench->frames, 1 / bench->frame_seconds, (double)bench->substeps / bench->frames);
  if (bench->render) printf("style %s on %s\n", bench->settings.style, render_gl_description(bench->render));
  printf("\n%-6s %-24s %12s %12s\n", "", "", "median ms", "least ms");
  for (int i = 0; i < bench->row_count; i++) {
    double middle = median(&bench->rows[i]);
    printf("%-6s %-24s %12.3f %12.3f\n", bench->rows[i].group, bench->rows[i].name, middle, bench->rows[i].samples[0]);
  }
  if (bench->particle_steps > 0)
    printf("\nsimulator: %.3f us per particle and substep, %.2f ns per neighbour pair, %.1f neighbours per particle, "
           "%.0f bytes per particle\n",
           bench->simulated_ms * 1e3 / (double)bench->particle_steps,
           bench->simulated_ms * 1e6 / (double)(bench->pairs ? bench->pairs : 1),
           (double)bench->pairs / (double)bench->particle_steps,
           counts->particles ? (double)sim_bytes_in_use() / counts->particles : 0.0);
}

static void print_json(Bench *bench, const SimCounts *counts) {
  printf("{\"particles\": %d, \"frames\": %d, \"substeps\": %lld, \"neighbour_pairs\": %lld, \"bytes\": %zu,\n",
         counts->particles, bench->frames, (long long)bench->substeps, (long long)bench->pairs, sim_bytes_in_use());
  printf(" \"microseconds_per_particle_and_substep\": %.6f,\n",
         bench->particle_steps ? bench->simulated_ms * 1e3 / (double)bench->particle_steps : 0.0);
  printf(" \"rows\": [\n");
  for (int i = 0; i < bench->row_count; i++) {
    double middle = median(&bench->rows[i]);
    printf("  {\"group\": \"%s\", \"name\": \"%s\", \"median_ms\": %.6f, \"least_ms\": %.6f}%s\n", bench->rows[i].group,
           bench->rows[i].name, middle, bench->rows[i].samples[0], i + 1 < bench->row_count ? "," : "");
  }
  printf(" ]}\n");
}

bool command_bench(const Options *options, AppError *error) {
  Bench bench = {0};
  bool ok = open_bench(&bench, options, error);
  for (int i = 0; ok && i < WARM_UP_FRAMES + bench.frames && !app_interrupted(); i++) {
    const SimFrame *frame = NULL;
    bool counted = i >= WARM_UP_FRAMES;
    ok = simulate_frame(&bench, i, counted, &frame, error) &&
         (!bench.render || draw_frame(&bench, frame, counted, error));
  }
  if (ok && app_interrupted()) ok = app_fail(error, APP_FAILED, "interrupted");
  if (ok) {
    SimCounts counts = sim_world_counts(bench.world);
    if (options->json)
      print_json(&bench, &counts);
    else
      print_table(&bench, &counts);
  }
  close_bench(&bench);
  return ok;
}
