// The time of a picture against its size and the number of particles, as Table 1 of Xiao, Zhang & Yang (2017) has it.
//
// The scene is the same for every number of particles: their radius is chosen so that its fluid holds about as many. Each
// frame is simulated once and drawn in every size. The first frame's pictures are not counted: they compile and allocate.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/bench_frames.h"

typedef struct Pictures {
  const Options *options;
  Context *context;
  int size_count, particle_counts, frames; // frames: counted, after the first
  int sizes[OPTIONS_MOST][2];
  Render *render[OPTIONS_MOST];                   // one for each size
  BenchSeries series[OPTIONS_MOST][OPTIONS_MOST]; // ms; of a number of particles, of a size
  int32_t particles[OPTIONS_MOST];                // as they turned out in the last frame
  char style[64];

  Bench bench; // of the present number of particles
  int present; // which one it is
} Pictures;

static bool open_pictures(Pictures *p, const Options *options, AppError *error) {
  p->options = options;
  p->size_count = options->size_count > 0 ? options->size_count : 1;
  p->particle_counts = options->particle_counts > 0 ? options->particle_counts : 1;
  p->frames = bench_frames_counted(options);
  p->context = context_create_headless(options->context, error);
  if (!p->context) return false;
  for (int s = 0; s < p->size_count; s++) {
    const int *size = options->sizes[s];
    p->sizes[s][0] = options->size_count > 0 ? size[0] : options->width;
    p->sizes[s][1] = options->size_count > 0 ? size[1] : options->height;
    p->render[s] = bench_render_create(p->sizes[s], error);
    if (!p->render[s]) return false;
    for (int n = 0; n < p->particle_counts; n++) {
      p->series[n][s].value = malloc((size_t)p->frames * sizeof(double));
      if (!p->series[n][s].value) return app_fail(error, APP_FAILED, "out of memory");
    }
  }
  return true;
}

static void close_pictures(Pictures *p) {
  for (int s = 0; s < p->size_count; s++) {
    render_destroy(p->render[s]);
    for (int n = 0; n < p->particle_counts; n++) free(p->series[n][s].value);
  }
  context_destroy(p->context);
}

// ---- One number of particles -----------------------------------------------------------------------------------------

// The scene with about as many particles as `wanted`; 0: as it is.
static bool load_scene(const Options *options, int32_t wanted, Scene *scene, AppError *error) {
  if (!scene_load(scene, options->source, options->sets, options->set_count, error)) return false;
  int64_t count = scene_particle_count(scene);
  if (wanted == 0) return true;
  if (count == 0) return app_fail(error, APP_BAD_INPUT, "%s: --particles: the scene begins without water", scene->path);
  const char **sets = malloc(((size_t)options->set_count + 1) * sizeof *sets);
  if (!sets) return app_fail(error, APP_FAILED, "out of memory");
  char radius[80];
  double factor = cbrt((double)count / wanted), present = (double)scene_world_def(scene).particle_radius;
  snprintf(radius, sizeof radius, "simulation.particle_radius=%.6g", present * factor);
  for (int i = 0; i < options->set_count; i++) sets[i] = options->sets[i];
  sets[options->set_count] = radius;
  scene_free(scene);
  bool ok = scene_load(scene, options->source, sets, options->set_count + 1, error);
  free(sets);
  return ok;
}

static unsigned prepare(void *self, int index) {
  Pictures *p = self;
  bench_look(&p->bench.scene, p->options, index, &p->bench.settings, &p->bench.view);
  snprintf(p->style, sizeof p->style, "%s", p->bench.settings.style);
  return render_style_needs(p->bench.settings.style, &p->bench.settings);
}

static bool draw_sizes(void *self, const SimFrame *frame, double simulated_ms, bool counted, AppError *error) {
  (void)simulated_ms;
  Pictures *p = self;
  p->particles[p->present] = frame->count;
  for (int s = 0; s < p->size_count && !app_interrupted(); s++) {
    double milliseconds;
    if (!bench_draw(p->render[s], frame, &p->bench.view, &p->bench.settings, &milliseconds, error)) return false;
    BenchSeries *series = &p->series[p->present][s];
    if (counted && series->count < p->frames) series->value[series->count++] = milliseconds;
  }
  return true;
}

static bool run_count(Pictures *p, int n, AppError *error) {
  const Options *options = p->options;
  int32_t wanted = options->particle_counts > 0 ? options->particles[n] : 0;
  BenchPainter painter = {.self = p, .prepare = prepare, .draw = draw_sizes};
  p->bench = (Bench){0};
  p->present = n;
  bool ok = load_scene(options, wanted, &p->bench.scene, error) && bench_frames_open(&p->bench, options, error) &&
            bench_frames_run(&p->bench, options, &painter, error);
  bench_frames_close(&p->bench);
  return ok;
}

// ---- What is printed -------------------------------------------------------------------------------------------------

// The x of a time that goes as particles^x, from the fewest to the most.
static double growth(Pictures *p, int s) {
  int last = p->particle_counts - 1;
  double times = bench_median(&p->series[last][s]) / bench_median(&p->series[0][s]);
  return log(times) / log((double)p->particles[last] / p->particles[0]);
}

static bool has_growth(const Pictures *p) {
  return p->particle_counts > 1 && p->particles[0] > 0 && p->particles[p->particle_counts - 1] > p->particles[0];
}

static void print_table(Pictures *p) {
  printf("%s, style %s on %s\n", p->options->source, p->style, render_gl_description(p->render[0]));
  printf("ms a picture, medians of %d\n\n%-12s", p->frames, "particles");
  for (int n = 0; n < p->particle_counts; n++) printf(" %12d", p->particles[n]);
  printf(has_growth(p) ? "   grows as particles^\n" : "\n");
  for (int s = 0; s < p->size_count; s++) {
    char size[24];
    snprintf(size, sizeof size, "%dx%d", p->sizes[s][0], p->sizes[s][1]);
    printf("%-12s", size);
    for (int n = 0; n < p->particle_counts; n++) printf(" %12.1f", bench_median(&p->series[n][s]));
    if (has_growth(p)) printf("   %.2f", growth(p, s));
    printf("\n");
  }
}

static void print_json(Pictures *p) {
  printf("{\"style\": \"%s\", \"pictures\": %d, \"times\": [\n", p->style, p->frames);
  for (int s = 0; s < p->size_count; s++) {
    for (int n = 0; n < p->particle_counts; n++) {
      double middle = bench_median(&p->series[n][s]); // sorts
      printf(" {\"width\": %d, \"height\": %d, \"particles\": %d, \"median_ms\": %.6f, \"least_ms\": %.6f}%s\n",
             p->sizes[s][0], p->sizes[s][1], p->particles[n], middle, p->series[n][s].value[0],
             s + 1 == p->size_count && n + 1 == p->particle_counts ? "" : ",");
    }
  }
  printf("]}\n");
}

bool bench_pictures(const Options *options, AppError *error) {
  Pictures p = {0};
  bool ok = open_pictures(&p, options, error);
  for (int n = 0; ok && n < p.particle_counts && !app_interrupted(); n++) ok = run_count(&p, n, error);
  if (ok && app_interrupted()) ok = app_fail(error, APP_FAILED, "interrupted");
  if (ok) {
    if (options->json)
      print_json(&p);
    else
      print_table(&p);
  }
  close_pictures(&p);
  return ok;
}
