#include "app/bench_frames.h"

#include <string.h>

#include "app/events.h"

enum { DEFAULT_PICTURES = 3 };

int bench_frames_counted(const Options *options) {
  return options->last_frame >= 0 ? options->last_frame - options->first_frame + 1 : DEFAULT_PICTURES;
}

bool bench_frames_open(Bench *bench, const Options *options, AppError *error) {
  bench->frame_seconds = 1 / options->fps;
  bench->world = scene_world_create(&bench->scene, options->threads, error);
  if (!bench->world) return false;
  bench->buffer = sim_frame_buffer_create();
  return bench->buffer || app_fail(error, APP_FAILED, "out of memory");
}

void bench_frames_close(Bench *bench) {
  sim_frame_buffer_destroy(bench->buffer);
  sim_world_destroy(bench->world);
  scene_free(&bench->scene);
}

bool bench_frames_run(Bench *bench, const Options *options, const BenchPainter *painter, AppError *error) {
  int first = options->last_frame >= 0 ? options->first_frame : BENCH_WARM_UP, count = bench_frames_counted(options);
  for (int i = 0; i < first + count && !app_interrupted(); i++) {
    SimError sim_error;
    double start = bench_now_ms();
    if (!bench_advance(bench, bench->world, i, error)) return false;
    if (i + 1 < first) continue;
    double advanced = bench_now_ms() - start;
    unsigned needs = painter->prepare(painter->self, i);
    start = bench_now_ms();
    const SimFrame *frame = sim_world_frame(bench->world, needs, bench->buffer, &sim_error);
    if (!frame) return app_fail(error, APP_FAILED, "%s", sim_error.message);
    double simulated = advanced + bench_now_ms() - start;
    if ((i < first || first == 0) && !painter->draw(painter->self, frame, simulated, false, error)) return false;
    if (i >= first && !painter->draw(painter->self, frame, simulated, true, error)) return false;
  }
  return true;
}

void bench_look(const Scene *scene, const Options *options, int index, RenderSettings *settings, RenderView *view) {
  double step = 1 / options->fps;
  AppError none; // only what moves water can fail
  *settings = scene_render_settings(scene);
  *view = scene_view(scene);
  events_apply(scene, index * step, step, NULL, settings, view, &none);
  if (options->style) settings->style = options->style;
  if (!options->has_camera) return;
  memcpy(view->eye, options->camera, sizeof view->eye);
  memcpy(view->target, options->camera + 3, sizeof view->target);
}

Render *bench_render_create(const int size[2], AppError *error) {
  RenderError render_error;
  Render *render = render_create(size[0], size[1], &render_error);
  if (!render)
    app_fail(error, APP_FAILED, "%s", render_error.message);
  else
    render_measure_passes(render, true);
  return render;
}

bool bench_draw(Render *render, const SimFrame *frame, const RenderView *view, const RenderSettings *settings,
                double *milliseconds, AppError *error) {
  RenderError render_error;
  RenderPassTime passes[BENCH_PASSES];
  double start = bench_now_ms();
  if (!render_draw(render, frame, view, settings, &render_error))
    return app_fail(error, APP_FAILED, "%s", render_error.message);
  render_pass_times(render, passes, BENCH_PASSES); // waits for the GPU
  *milliseconds = bench_now_ms() - start;
  return true;
}
