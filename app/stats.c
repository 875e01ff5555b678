#include "app/stats.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>

#include "app/output.h"

enum { MAX_PASSES = 128 };

struct Stats {
  OutputFile *output;
};

Stats *stats_open(const char *path, AppError *error) {
  Stats *stats = calloc(1, sizeof *stats);
  if (!stats) {
    app_fail(error, APP_FAILED, "%s: out of memory", path);
    return NULL;
  }
  stats->output = output_open(path, error);
  if (stats->output) return stats;
  free(stats);
  return NULL;
}

// JSON knows no NaN.
static void put_number(FILE *file, const char *before, double value) {
  if (isfinite(value))
    fprintf(file, "%s%.9g", before, value);
  else
    fprintf(file, "%snull", before);
}

static void put_world(FILE *file, SimWorld *world) {
  SimMeasures measures = sim_world_measures(world);
  const SimProfile *profile = sim_world_profile(world);
  put_number(file, ", \"density_error\": {\"mean\": ", measures.mean_density_error);
  put_number(file, ", \"max\": ", measures.max_density_error);
  put_number(file, "}, \"energy\": {\"kinetic\": ", measures.kinetic_energy);
  put_number(file, ", \"potential\": ", measures.potential_energy);
  put_number(file, "}, \"max_speed\": ", measures.max_speed);
  fprintf(file, ", \"substeps\": %" PRId64 ", \"stage_ms\": {", profile->substeps);
  for (int i = 0; i < SIM_STAGE_COUNT; i++) {
    fprintf(file, "%s\"%s\"", i ? ", " : "", sim_stage_name((SimStage)i));
    put_number(file, ": ", profile->milliseconds[i]);
  }
  fputc('}', file);
}

static void put_passes(FILE *file, Render *render) {
  RenderPassTime times[MAX_PASSES];
  int32_t count = render_pass_times(render, times, MAX_PASSES);
  fputs(", \"pass_ms\": [", file);
  for (int32_t i = 0; i < count && i < MAX_PASSES; i++) {
    fprintf(file, "%s{\"name\": \"%s\"", i ? ", " : "", times[i].name);
    put_number(file, ", \"gpu\": ", times[i].gpu_milliseconds);
    put_number(file, ", \"cpu\": ", times[i].cpu_milliseconds);
    fputc('}', file);
  }
  fputc(']', file);
}

// What the style says of the picture: in "refraction" the share of pixels in each order of bodies.
static void put_figures(FILE *file, Render *render) {
  RenderFigure figures[MAX_PASSES];
  int32_t count = render_figures(render, figures, MAX_PASSES);
  fputs(", \"figures\": {", file);
  for (int32_t i = 0; i < count && i < MAX_PASSES; i++) {
    fprintf(file, "%s\"%s\"", i ? ", " : "", figures[i].name);
    put_number(file, ": ", figures[i].value);
  }
  fputc('}', file);
}

void stats_frame(Stats *stats, const SimFrame *frame, SimWorld *world, Render *render) {
  FILE *file = output_file(stats->output);
  fprintf(file, "{\"frame\": %" PRId64, frame->index);
  put_number(file, ", \"time\": ", frame->time);
  fprintf(file, ", \"particles\": %" PRId32, frame->count);
  if (world)
    put_world(file, world);
  else
    fputs(", \"density_error\": null, \"energy\": null, \"max_speed\": null, \"substeps\": null, \"stage_ms\": null",
          file);
  if (render) {
    put_passes(file, render);
    put_figures(file, render);
    fprintf(file, ", \"buffer_bytes\": %zu", render_buffer_bytes());
  } else {
    fputs(", \"pass_ms\": null, \"figures\": null, \"buffer_bytes\": null", file);
  }
  fputs("}\n", file);
}

bool stats_close(Stats *stats, AppError *error) {
  if (!stats) return true;
  bool fine = output_commit(stats->output, error);
  free(stats);
  return fine;
}

void stats_abort(Stats *stats) {
  if (!stats) return;
  output_abort(stats->output);
  free(stats);
}
