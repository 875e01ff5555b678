#include "app/progress.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static double now(void) {
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

void progress_start(Progress *progress, int64_t total, bool quiet) {
  const char *no_colour = getenv("NO_COLOR"), *terminal = getenv("TERM");
  bool dumb = !terminal || strcmp(terminal, "dumb") == 0;
  *progress = (Progress){.quiet = quiet, .total = total > 0 ? total : 1, .start = now()};
  progress->terminal = isatty(STDERR_FILENO) && !dumb;
  progress->colour = progress->terminal && !(no_colour && no_colour[0]);
}

// 75 → "1:15".
static const char *clock_text(double seconds, char text[32]) {
  int64_t s = seconds < 0 ? 0 : seconds > 1e7 ? 10000000 : (int64_t)(seconds + 0.5);
  if (s >= 3600)
    snprintf(text, 32, "%" PRId64 ":%02d:%02d", s / 3600, (int)(s / 60 % 60), (int)(s % 60));
  else
    snprintf(text, 32, "%d:%02d", (int)(s / 60), (int)(s % 60));
  return text;
}

static void draw_bar(Progress *progress, double elapsed, double left) {
  enum { WIDTH = 24 };
  char bar[WIDTH + 1], spent[32], rest[32];
  int filled = (int)(progress->done * WIDTH / progress->total);
  for (int i = 0; i < WIDTH; i++) bar[i] = i < filled ? '#' : '.';
  bar[WIDTH] = '\0';
  fprintf(stderr, "\r\033[K%s[%s]%s %" PRId64 "/%" PRId64 " frames  %s, %s left", progress->colour ? "\033[36m" : "",
          bar, progress->colour ? "\033[0m" : "", progress->done, progress->total, clock_text(elapsed, spent),
          clock_text(left, rest));
  fflush(stderr);
  progress->open = true;
}

void progress_step(Progress *progress, int64_t done) {
  progress->done = done < progress->total ? done : progress->total;
  if (progress->quiet) return;
  double time = now(), elapsed = time - progress->start;
  double left = progress->done > 0 ? elapsed / (double)progress->done * (double)(progress->total - progress->done) : 0;
  if (progress->terminal) {
    bool due = time - progress->drawn > 0.1 || progress->done == progress->total;
    if (due) draw_bar(progress, elapsed, left);
    if (due) progress->drawn = time;
    return;
  }
  // Plain lines: every tenth of the whole, and not for what is over in a moment.
  int64_t tenth = progress->done * 10 / progress->total;
  if (tenth == progress->said || tenth == 10 || elapsed < 2) return;
  progress->said = tenth;
  char rest[32];
  fprintf(stderr, "lido: %" PRId64 " of %" PRId64 " frames, %s left\n", progress->done, progress->total,
          clock_text(left, rest));
}

void progress_end(Progress *progress) {
  if (!progress->open) return;
  fputs("\r\033[K", stderr);
  fflush(stderr);
  progress->open = false;
}

bool progress_conclude(Progress *progress, bool fine, int64_t kept, const char *where, AppError *error) {
  progress_end(progress);
  if (!fine) {
    if (kept == 0) return false;
    AppError cause = *error;
    return app_fail(error, cause.code, "%.800s; %" PRId64 " of %" PRId64 " frames are in %.150s", cause.message, kept,
                    progress->total, where);
  }
  if (kept < progress->total)
    return app_fail(error, APP_FAILED, "interrupted: %" PRId64 " of %" PRId64 " frames written to %s", kept,
                    progress->total, where);
  char spent[32];
  if (!progress->quiet)
    fprintf(stderr, "lido: %" PRId64 " frame%s written to %s in %s\n", kept, kept == 1 ? "" : "s", where,
            clock_text(now() - progress->start, spent));
  return true;
}
