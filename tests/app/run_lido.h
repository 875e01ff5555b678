// For tests that run the real program: a folder of their own, a run with its output caught, and small file helpers.
#ifndef LIDO_TESTS_RUN_LIDO_H
#define LIDO_TESTS_RUN_LIDO_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// ThreadSanitizer keeps its own memory in files: a limit on files' sizes ends it, whatever the program does.
#if defined(__SANITIZE_THREAD__)
#define LIDO_NO_FILE_SIZE_LIMIT 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define LIDO_NO_FILE_SIZE_LIMIT 1
#endif
#endif
#ifndef LIDO_NO_FILE_SIZE_LIMIT
#define LIDO_NO_FILE_SIZE_LIMIT 0
#endif

/// How a run differs from an ordinary one; zero means it does not.
typedef struct LidoRun {
  // Set before the run
  const char *path_variable;  ///< value of PATH
  uint64_t file_size_limit;   ///< bytes that it may write to one file (RLIMIT_FSIZE)
  const char *interrupt_when; ///< Ctrl-C (SIGINT) as soon as this file is there
  bool interrupt_twice;       ///< in the middle of a frame (a slow one: some time later), and once more a moment later
  const char *stdout_to;      ///< file for standard output, instead of one of the helper's own
  bool terminal;              ///< standard error is a terminal
  bool no_colour;             ///< NO_COLOR is set
  bool as_nobody;             ///< without root's rights; the code is 127 where the program cannot be run like that
  bool close_reader;          ///< standard output is a pipe whose reader goes away after some bytes

  // Known after the run
  int code;         ///< exit code, or 1000 + the signal that ended it
  char text[16384]; ///< standard error
  int lines;        ///< of it
  int64_t peak;     ///< bytes: the most memory that it had resident
} LidoRun;

/// Whether this machine has pseudo-terminals (/dev/pts); a bare chroot may not.
bool lido_has_terminals(void);

/// Run `lido` with the arguments, the last one NULL.
void lido_run(LidoRun *run, const char *const *arguments);
#define LIDO(run, ...) lido_run(run, (const char *const[]){__VA_ARGS__, NULL})

/// Fail the test unless the run ended well; unless it ended with `code` and one line from us that names the cause.
void check_done(const LidoRun *run);
void check_said(const LidoRun *run, int code, const char *cause);

/// A fresh empty folder; at the end remove it with everything in it.
void folder_make(char folder[256]);
void folder_remove(const char *folder);
/// "folder/name" in one of 64 static buffers, which are used in turn.
const char *in(const char *folder, const char *name);
/// Number of entries in a folder, hidden ones included; -1 when it is not there.
int folder_count(const char *folder);

bool file_exists(const char *path);
void file_put(const char *path, const void *bytes, size_t size);
void file_put_text(const char *path, const char *text);
/// The whole file (free it), with a 0 behind it. Fails the test when it cannot be read.
uint8_t *file_get(const char *path, size_t *size);
bool files_equal(const char *a, const char *b);

#endif
