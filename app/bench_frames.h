// What the tables of pictures share (bench_pictures.c, bench_vary.c): the frames of a scene, simulated once each from its
// start and handed on to be drawn, and the time of one picture.
#ifndef LIDO_APP_BENCH_FRAMES_H
#define LIDO_APP_BENCH_FRAMES_H

#include "app/bench.h"

/// Who draws the frames.
typedef struct BenchPainter {
  void *self;
  /// Make ready for the frame `index`; returns what its pictures need (SimNeed).
  unsigned (*prepare)(void *self, int index);
  /// Draw it. `simulated_ms`: what its simulation has taken.
  bool (*draw)(void *self, const SimFrame *frame, double simulated_ms, bool counted, AppError *error);
} BenchPainter;

/// How many frames of a table are counted.
int bench_frames_counted(const Options *options);

/// Make what is needed to run bench->scene, which is loaded; close it either way.
bool bench_frames_open(Bench *bench, const Options *options, AppError *error);
void bench_frames_close(Bench *bench); ///< and free the scene

/// Run the scene and let the frames be drawn that count, and once before them one that does not: its pictures compile and
/// allocate. Stops when Ctrl-C is pressed.
bool bench_frames_run(Bench *bench, const Options *options, const BenchPainter *painter, AppError *error);

/// The look of the frame `index`: the scene's, as its events have changed it, with --style and --camera on top. The style's
/// name points into the scene.
void bench_look(const Scene *scene, const Options *options, int index, RenderSettings *settings, RenderView *view);

/// NULL and *error.
Render *bench_render_create(const int size[2], AppError *error);
/// Draw one picture and wait for the GPU.
bool bench_draw(Render *render, const SimFrame *frame, const RenderView *view, const RenderSettings *settings,
                double *milliseconds, AppError *error);

#endif
