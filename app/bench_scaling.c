// The world alone, without frames and pictures, on growing numbers of threads: how much faster more cores make it, and
// what memory it holds by itself.
#include <stdlib.h>
#include <unistd.h>

#include "app/bench.h"

enum { MOST_FRAMES = 30 };

static int most_threads(const Bench *bench) {
  long cores = sysconf(_SC_NPROCESSORS_ONLN);
  int most = bench->threads > 0 ? bench->threads : cores > 0 ? (int)cores : 1;
  return most > 256 ? 256 : most;
}

static bool run_world(Bench *bench, SimWorld *world, BenchRun *run, AppError *error) {
  int frames = bench->frames < MOST_FRAMES ? bench->frames : MOST_FRAMES;
  BenchSeries series = {malloc((size_t)frames * sizeof(double)), 0};
  bool ok = series.value || app_fail(error, APP_FAILED, "out of memory");
  for (int i = 0; ok && i < BENCH_WARM_UP + frames && !app_interrupted(); i++) {
    double start = bench_now_ms();
    ok = bench_advance(bench, world, i, error);
    if (i >= BENCH_WARM_UP) series.value[series.count++] = bench_now_ms() - start;
  }
  run->median_ms = bench_median(&series);
  free(series.value);
  return ok;
}

bool bench_scaling(Bench *bench, AppError *error) {
  // Events change the picture too; what the bench itself draws stays as it is.
  RenderSettings settings = bench->settings;
  RenderView view = bench->view;
  int most = most_threads(bench);
  bool ok = true;
  for (int threads = 1; ok && bench->run_count < BENCH_RUNS && !app_interrupted(); threads *= 2) {
    if (threads > most) threads = most;
    BenchRun *run = &bench->runs[bench->run_count++];
    size_t before = sim_bytes_in_use();
    run->threads = threads;
    SimWorld *world = scene_world_create(&bench->scene, threads, error);
    ok = world && run_world(bench, world, run, error);
    if (ok) bench->world_bytes = sim_bytes_in_use() - before;
    sim_world_destroy(world);
    if (threads == most) break;
  }
  bench->settings = settings;
  bench->view = view;
  return ok;
}
