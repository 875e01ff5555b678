// What the parts of `lido bench` share: command_bench.c runs the scene, bench_scaling.c runs it again on other numbers of
// threads, bench_report.c prints; bench_pictures.c makes a table of pictures of several sizes and numbers of particles,
// bench_vary.c one of pictures with several values of keys.
#ifndef LIDO_APP_BENCH_H
#define LIDO_APP_BENCH_H

#include "app/app.h"
#include "app/context.h"
#include "app/options.h"
#include "app/scene.h"

enum {
  BENCH_WARM_UP = 5, ///< frames that are run first and not counted
  BENCH_PASSES = 64, ///< passes of the renderer
  BENCH_ROWS = SIM_STAGE_COUNT + 2 * BENCH_PASSES + 3,
  BENCH_RUNS = 9 ///< numbers of threads: 1, 2, 4 … 256
};

/// One number in every counted frame.
typedef struct BenchSeries {
  double *value; ///< (frames)
  int count;
} BenchSeries;

/// One line of the table: the time of one stage or pass.
typedef struct BenchRow {
  char group[16], name[48];
  BenchSeries milliseconds; ///< a frame
  BenchSeries each;         ///< ns per particle, and substep if it is a stage of the step; none: not of the simulator
  BenchSeries pair;         ///< ns per neighbour pair (i, j), i ≠ j, and substep likewise
} BenchRow;

/// The world alone on some number of threads.
typedef struct BenchRun {
  int threads;
  double median_ms; ///< a frame
} BenchRun;

typedef struct Bench {
  Scene scene;
  SimWorld *world;
  SimFrameBuffer *buffer;
  Context *context; ///< NULL: no OpenGL here, only the simulator is timed
  Render *render;
  RenderSettings settings;
  RenderView view;
  double frame_seconds;
  int frames, threads; ///< threads: as asked for, 0: as many as there are cores
  BenchRow rows[BENCH_ROWS];
  int row_count;
  BenchRun runs[BENCH_RUNS];
  int run_count;
  size_t world_bytes; ///< of a warm world alone
  SimMachine machine;
  // Sums over the counted frames.
  double simulated_ms;
  int64_t substeps, particle_steps, pairs;
} Bench;

double bench_now_ms(void); ///< of a clock that never goes back

/// Events of the frame `index`, then one frame's time of the world. Events that concern the picture change settings and view.
bool bench_advance(Bench *bench, SimWorld *world, int index, AppError *error);

/// Median of a series, which is sorted by that; 0 when it is empty.
double bench_median(BenchSeries *series);

/// Fill runs and world_bytes. The scene is run from its start on 1, 2, 4 … threads, up to the number asked for.
bool bench_scaling(Bench *bench, AppError *error);

/// The table that --sizes and --particles ask for.
bool bench_pictures(const Options *options, AppError *error);
/// The table that --vary asks for, one of each scene.
bool bench_vary(const Options *options, AppError *error);

void bench_print_table(Bench *bench, const SimCounts *counts);
void bench_print_json(Bench *bench, const SimCounts *counts);

#endif
