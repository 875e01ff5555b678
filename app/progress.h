// How far a long command is: one bar with the time left on a terminal, a plain line now and then elsewhere. On stderr.
#ifndef LIDO_APP_PROGRESS_H
#define LIDO_APP_PROGRESS_H

#include <stdint.h>

#include "app/app.h"

typedef struct Progress {
  bool quiet, terminal, colour;
  int64_t total, done;
  int64_t said;        // tenths of the whole that a plain line has told
  double start, drawn; // s, monotonic clock
  bool open;           // a bar stands on the present line
} Progress;

/// Begin with nothing done of `total` frames. With `quiet` nothing is ever written. NO_COLOR is respected.
void progress_start(Progress *progress, int64_t total, bool quiet);
/// So many are done now.
void progress_step(Progress *progress, int64_t done);
/// Take the bar away, so that a line can follow. May be called twice.
void progress_end(Progress *progress);

/// The last word of a run that gives `frames` to `where`. With `fine`: says how many were written unless quiet, or fails
/// with APP_FAILED where Ctrl-C ended it early. Without: adds to *error how many frames are `kept` nevertheless.
bool progress_conclude(Progress *progress, bool fine, int64_t kept, const char *where, AppError *error);

#endif
