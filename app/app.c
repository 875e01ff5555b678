#include "app/app.h"

#include <signal.h>
#include <stdatomic.h>
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

// Any thread may be the one that a signal interrupts, so these are atomics (lock-free, as a handler needs) and not
// merely volatile.
static atomic_int interrupted;
static void (*_Atomic last_act)(void); // see app_before_abrupt_end

static void on_interrupt(int signal_number) {
  // A second Ctrl-C ends the program at once, in case a frame hangs.
  if (atomic_exchange(&interrupted, 1)) {
    void (*act)(void) = last_act;
    if (act) act();
    signal(signal_number, SIG_DFL);
    raise(signal_number);
  }
}

bool app_interrupted(void) {
  return interrupted != 0;
}

void app_before_abrupt_end(void (*function)(void)) {
  last_act = function;
}

// A signal that whoever started us has ignored (nohup, a shell's background) stays ignored.
static void catch_signal(int signal_number) {
  struct sigaction action = {.sa_handler = on_interrupt, .sa_flags = SA_RESTART}, before;
  sigemptyset(&action.sa_mask);
  if (sigaction(signal_number, NULL, &before) == 0 && before.sa_handler == SIG_IGN) return;
  sigaction(signal_number, &action, NULL);
}

void app_catch_interrupts(void) {
  catch_signal(SIGINT);
  catch_signal(SIGTERM);
  catch_signal(SIGHUP);
  // A reader that goes away and a file size limit are write errors, with a message.
  signal(SIGPIPE, SIG_IGN);
  signal(SIGXFSZ, SIG_IGN);
}
