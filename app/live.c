#include "app/live.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "app/events.h"
#include "app/pipeline.h"

typedef enum LiveJob { LIVE_ADVANCE, LIVE_RESET, LIVE_REFRESH } LiveJob;

struct Live {
  const Scene *scene;
  double fps;
  Pipeline *pipeline;
  SimFrameBuffer *buffers[2];
  LiveFrame frames[2]; // one per slot of the pipeline

  // The job at hand: written by the caller before it starts, by the worker while it runs.
  LiveJob job;
  LiveInput input;
  SimWorld *world;
  int64_t index;  // of the frame that the world's state is
  bool ok;        // the job's outcome …
  AppError error; // … and why it failed

  // The caller's own: it may be read while the worker runs.
  bool failed; // stands still until reset
  AppError failure;
};

static double now(void) {
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

// ---- On the worker thread -------------------------------------------------------------------------------------------

static bool advance(Live *live) {
  double step = 1 / live->fps;
  if (!events_apply(live->scene, (double)live->index * step, step, live->world, NULL, NULL, &live->error)) return false;
  // The hand comes after the timeline: where both want more pushes than act at once, the timeline has its way.
  for (int i = 0; i < live->input.push_count; i++) sim_world_push(live->world, &live->input.pushes[i]);
  if (live->input.drag) sim_world_drag(live->world, live->input.body, live->input.position, NULL);
  if (live->input.set_gravity) sim_world_set_gravity(live->world, live->input.gravity);
  SimError reason;
  if (!sim_world_advance(live->world, step, &reason)) return app_fail(&live->error, APP_FAILED, "%s", reason.message);
  live->index++;
  return true;
}

static bool write_frame(Live *live, int slot, double begin) {
  SimError reason;
  const SimFrame *frame = sim_world_frame(live->world, live->input.needs, live->buffers[slot], &reason);
  if (!frame) return app_fail(&live->error, APP_FAILED, "%s", reason.message);
  live->frames[slot] = (LiveFrame){.frame = *frame,
                                   .needs = live->input.needs,
                                   .counts = sim_world_counts(live->world),
                                   .milliseconds = 1e3 * (now() - begin)};
  live->frames[slot].frame.index = live->index;
  return true;
}

static void work(void *user, int slot) {
  Live *live = user;
  double begin = now();
  live->ok = true;
  sim_world_clear_profile(live->world);
  if (live->job == LIVE_ADVANCE) live->ok = advance(live);
  if (live->job == LIVE_RESET) {
    sim_world_reset(live->world);
    live->index = 0;
  }
  if (live->ok) live->ok = write_frame(live, slot, begin);
}

// ---- On the caller's thread -------------------------------------------------------------------------------------------

static bool start(Live *live, int threads, unsigned needs, AppError *error) {
  live->world = scene_world_create(live->scene, threads, error);
  if (!live->world) return false;
  for (int slot = 0; slot < 2; slot++)
    if (!(live->buffers[slot] = sim_frame_buffer_create())) return app_fail(error, APP_FAILED, "out of memory");
  live->pipeline = pipeline_create(work, live);
  if (!live->pipeline) return app_fail(error, APP_FAILED, "cannot start a thread for the simulation");
  live_refresh(live, needs);
  while (live_busy(live))
    if (live_poll(live, 1) == LIVE_FAILURE) {
      *error = live->error;
      return false;
    }
  return true;
}

Live *live_create(const Scene *scene, double fps, int threads, unsigned needs, AppError *error) {
  Live *live = calloc(1, sizeof *live);
  if (!live) {
    app_fail(error, APP_FAILED, "out of memory");
    return NULL;
  }
  live->scene = scene;
  live->fps = fps;
  if (start(live, threads, needs, error)) return live;
  live_destroy(live);
  return NULL;
}

void live_destroy(Live *live) {
  if (!live) return;
  pipeline_destroy(live->pipeline);
  for (int slot = 0; slot < 2; slot++) sim_frame_buffer_destroy(live->buffers[slot]);
  sim_world_destroy(live->world);
  free(live);
}

static void start_job(Live *live, LiveJob job, const LiveInput *input) {
  assert(!live_busy(live));
  live->job = job;
  live->input = *input;
  pipeline_start(live->pipeline);
}

void live_advance(Live *live, const LiveInput *input) {
  assert(!live->failed);
  start_job(live, LIVE_ADVANCE, input);
}

void live_reset(Live *live, unsigned needs) {
  start_job(live, LIVE_RESET, &(LiveInput){.needs = needs});
}

void live_refresh(Live *live, unsigned needs) {
  start_job(live, LIVE_REFRESH, &(LiveInput){.needs = needs});
}

bool live_busy(const Live *live) {
  return pipeline_busy(live->pipeline);
}

LiveEvent live_poll(Live *live, double seconds) {
  if (!pipeline_finished(live->pipeline, seconds)) return LIVE_NOTHING;
  if (!live->ok) {
    live->failed = true;
    live->failure = live->error;
    return LIVE_FAILURE;
  }
  // Making the same state again does not undo a failure; starting again does.
  if (live->job == LIVE_RESET) live->failed = false;
  pipeline_swap(live->pipeline);
  return LIVE_NEW_FRAME;
}

const LiveFrame *live_frame(const Live *live) {
  return &live->frames[pipeline_front(live->pipeline)];
}

const char *live_failure(const Live *live) {
  return live->failed ? live->failure.message : NULL;
}

SimWorld *live_world(Live *live) {
  assert(!live_busy(live));
  return live->world;
}
