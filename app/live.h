// The simulation behind a window: a worker thread simulates frame n + 1 while the caller shows frame n.
//
// One thread, the caller's, calls everything here. The world is touched by the worker while a job runs and by nobody
// else; the frame of live_frame is never written while it is shown. Input is handed over between frames. See pipeline.h
// for why this is free of races.
#ifndef LIDO_APP_LIVE_H
#define LIDO_APP_LIVE_H

#include "app/app.h"
#include "app/interact.h"
#include "app/scene.h"
#include "sim/sim.h"

typedef struct Live Live;

/// What acts during the next frame.
typedef struct LiveInput {
  unsigned needs; ///< SimNeed bits that the frame is to hold
  int push_count;
  SimPush pushes[INTERACT_MAX_PUSHES]; ///< (push_count)
  bool set_gravity;                    ///< gravity is `gravity` from now on, instead of the scene's or the last one
  float gravity[3];                    ///< m/s²
  bool drag;                           ///< the draggable obstacle `body` is wanted at `position` from now on
  int32_t body;                        ///< its place among the scene's obstacles
  float position[3];                   ///< m
} LiveInput;

/// A frame that can be shown, and how it came about.
typedef struct LiveFrame {
  SimFrame frame; ///< its index counts frames since the start
  unsigned needs; ///< SimNeed bits that it holds
  SimCounts counts;
  double milliseconds; ///< wall time of the simulation
} LiveFrame;

/// A world of the scene, and its frame 0. The scene must outlive it. NULL and *error: the scene cannot be simulated
/// (APP_BAD_INPUT), no memory or no thread (APP_FAILED).
Live *live_create(const Scene *scene, double fps, int threads, unsigned needs, AppError *error);
void live_destroy(Live *live); ///< waits for the job at hand; NULL is allowed

/// Start work on the next frame, with what the timeline and the input say. Only while not busy and not failed.
void live_advance(Live *live, const LiveInput *input);
/// Start making frame 0 again, from a new world; ends a failure.
void live_reset(Live *live, unsigned needs);
/// Start making the present frame again, with other needs.
void live_refresh(Live *live, unsigned needs);
bool live_busy(const Live *live);

typedef enum LiveEvent {
  LIVE_NOTHING,   ///< the work goes on, or there is none
  LIVE_NEW_FRAME, ///< live_frame is a new one
  LIVE_FAILURE    ///< the work failed: live_frame is the last good one, live_failure says why
} LiveEvent;
/// Take the result of the work at hand; waits at most `seconds` for it.
LiveEvent live_poll(Live *live, double seconds);

const LiveFrame *live_frame(const Live *live);
/// Why the simulation stands still until it is reset; NULL while all is well.
const char *live_failure(const Live *live);
/// The world, for measuring. Only while not busy.
SimWorld *live_world(Live *live);

#endif
