// How far a long command is: one bar with the time left on a terminal, a plain line now and then elsewhere. On stderr.
#ifndef LIDO_APP_PROGRESS_H
#define LIDO_APP_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

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

/// Seconds since progress_start.
double progress_seconds(const Progress *progress);

#endif
