#include "app/app.h"

#include <signal.h>
#include <stdio.h>

bool app_fail(AppError *error, AppCode code, const char *format, ...) {
  error->code = code;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(error->message, sizeof error->message, format, arguments);
  va_end(arguments);
  for (char *c = error->message; *c; c++)
    if ((unsigned char)*c < 0x20 || *c == 0x7f) *c = '?';
  return false;
}

static volatile sig_atomic_t interrupted;

static void on_interrupt(int signal_number) {
  // A second Ctrl-C ends the program at once, in case a frame hangs.
  if (interrupted) {
    signal(signal_number, SIG_DFL);
    raise(signal_number);
  }
  interrupted = 1;
}

bool app_interrupted(void) {
  return interrupted != 0;
}

void app_catch_interrupts(void) {
  signal(SIGINT, on_interrupt);
  signal(SIGTERM, on_interrupt);
#ifdef SIGPIPE
  signal(SIGPIPE, SIG_IGN); // a reader that goes away is a write error, with a message
#endif
}
