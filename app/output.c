#define _XOPEN_SOURCE 700 // realpath

#include "app/output.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#ifndef PATH_MAX
#define PATH_MAX 4096
#endif

struct OutputFile {
  FILE *stream;
  int slot;            // in `leftovers`, −1 when the file is written directly
  char *path;          // as the user gave it, for messages
  char *target;        // where it is renamed to: `path` with symbolic links followed
  char part[PATH_MAX]; // where it is written
};

// ---- Leftovers -----------------------------------------------------------------------------------------------------------

// Names of unfinished files, in plain memory so that a signal handler can read them. A name is complete before its
// `in_use` is set, and `in_use` is cleared before the name changes.
enum { MAX_LEFTOVERS = 16 };
static char leftovers[MAX_LEFTOVERS][PATH_MAX];
static atomic_int in_use[MAX_LEFTOVERS];
static volatile pid_t writers[MAX_LEFTOVERS]; // processes that write in our place, 0 for our own writing

static int leftover_add(const char *part) {
  for (int i = 0; i < MAX_LEFTOVERS; i++) {
    if (in_use[i]) continue;
    memcpy(leftovers[i], part, strlen(part) + 1);
    in_use[i] = 1;
    return i;
  }
  return -1; // too many at once to be remembered: only a killed program would leave it behind
}

static void leftover_forget(int slot) {
  if (slot < 0) return;
  in_use[slot] = 0;
  writers[slot] = 0;
}

void output_remove_leftovers(void) {
  for (int i = 0; i < MAX_LEFTOVERS; i++) {
    if (!in_use[i]) continue;
    if (writers[i] > 0 && kill(writers[i], SIGKILL) == 0) waitpid(writers[i], NULL, 0);
    unlink(leftovers[i]);
  }
}

void output_set_writer(OutputFile *output, pid_t process) {
  if (output->slot >= 0) writers[output->slot] = process;
}

// ---- Folders -------------------------------------------------------------------------------------------------------------

// Make one folder; one that is already there is fine.
static bool make_one_folder(const char *folder, AppError *error) {
  if (mkdir(folder, 0777) == 0) return true;
  int cause = errno;
  struct stat status;
  if (stat(folder, &status) == 0) {
    if (S_ISDIR(status.st_mode)) return true;
    return app_fail(error, APP_FAILED, "%.600s: cannot make this folder: a file of that name is there", folder);
  }
  return app_fail(error, APP_FAILED, "%.600s: cannot make this folder: %s", folder, strerror(cause));
}

bool output_make_folder(const char *path, AppError *error) {
  size_t length = strlen(path);
  if (length >= PATH_MAX) return app_fail(error, APP_FAILED, "%.200s...: the name is too long", path);
  char folder[PATH_MAX];
  memcpy(folder, path, length + 1);
  for (char *slash = strchr(folder + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
    if (slash[-1] == '/') continue;
    *slash = '\0';
    if (!make_one_folder(folder, error)) return false;
    *slash = '/';
  }
  return true;
}

// ---- One file ------------------------------------------------------------------------------------------------------------

// A name beside `target` that is short (a long name may not grow), hidden, and belongs to this process alone.
static bool name_part(OutputFile *output) {
  static unsigned counter;
  const char *slash = strrchr(output->target, '/');
  int folder = slash ? (int)(slash - output->target) + 1 : 0;
  int written = snprintf(output->part, sizeof output->part, "%.*s.lido-%ld-%u.part", folder, output->target,
                         (long)getpid(), ++counter);
  if (written > 0 && written < (int)sizeof output->part) return true;
  errno = ENAMETOOLONG;
  return false;
}

// Open a new part file. A name that a killed process of the same number left behind is passed over.
static int open_part(OutputFile *output) {
  for (int attempt = 0; attempt < 100; attempt++) {
    if (!name_part(output)) return -1;
    int descriptor = open(output->part, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0 || errno != EEXIST) return descriptor;
  }
  return -1;
}

// Open for writing: beside the target, or the target itself where it is a device or a pipe.
static int open_target(OutputFile *output, AppError *error) {
  struct stat status;
  bool exists = stat(output->target, &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) {
    errno = EISDIR;
    return -1;
  }
  if (exists && !S_ISREG(status.st_mode)) return open(output->target, O_WRONLY | O_CLOEXEC);
  int descriptor = open_part(output);
  if (descriptor < 0 && (errno == ENOENT || errno == ENOTDIR)) {
    // The folder is missing, or a file stands in its place: then making it says which.
    if (!output_make_folder(output->target, error)) return -2;
    descriptor = open_part(output);
  }
  if (descriptor >= 0) output->slot = leftover_add(output->part);
  return descriptor;
}

static void free_output(OutputFile *output) {
  free(output->path);
  free(output->target);
  free(output);
}

static void *open_failed(OutputFile *output, const char *path, AppError *error) {
  app_fail(error, APP_FAILED, "%.600s: cannot be written: %s", path, strerror(errno));
  if (output) free_output(output);
  return NULL;
}

OutputFile *output_open(const char *path, AppError *error) {
  app_before_abrupt_end(output_remove_leftovers);
  OutputFile *output = calloc(1, sizeof *output);
  if (!output) return open_failed(NULL, path, error);
  output->slot = -1;
  output->path = strdup(path);
  output->target = realpath(path, NULL); // a link stays a link, what it points at is replaced
  if (!output->target) output->target = strdup(path);
  if (!output->path || !output->target) return open_failed(output, path, error);

  int descriptor = open_target(output, error);
  if (descriptor == -2) {
    free_output(output);
    return NULL;
  }
  if (descriptor < 0) return open_failed(output, path, error);
  output->stream = fdopen(descriptor, "wb");
  if (!output->stream) {
    close(descriptor);
    if (output->part[0]) unlink(output->part);
    leftover_forget(output->slot);
    return open_failed(output, path, error);
  }
  return output;
}

FILE *output_file(OutputFile *output) {
  return output->stream;
}

const char *output_part(const OutputFile *output) {
  return output->part[0] ? output->part : output->target;
}

bool output_commit(OutputFile *output, AppError *error) {
  // The cause of a write that failed earlier is gone from errno, but writing once more finds it again; a close can fail
  // too, where the file system writes late.
  errno = 0;
  bool failed = fflush(output->stream) != 0;
  int cause = errno;
  if (!failed && ferror(output->stream)) {
    clearerr(output->stream);
    failed = true;
    if (fputc(0, output->stream) == EOF || fflush(output->stream) != 0) cause = errno;
    if (!cause) cause = EIO;
  }
  if (fclose(output->stream) != 0 && !failed) {
    failed = true;
    cause = errno;
  }
  if (!failed && output->part[0] && rename(output->part, output->target) != 0) {
    failed = true;
    cause = errno;
  }
  if (failed) {
    if (output->part[0]) unlink(output->part);
    app_fail(error, APP_FAILED, "%.600s: cannot be written: %s", output->path, strerror(cause));
  }
  leftover_forget(output->slot);
  free_output(output);
  return !failed;
}

void output_abort(OutputFile *output) {
  if (!output) return;
  fclose(output->stream);
  if (output->part[0]) unlink(output->part);
  leftover_forget(output->slot);
  free_output(output);
}

bool output_probe(const char *path, AppError *error) {
  OutputFile *output = output_open(path, error);
  output_abort(output);
  return output != NULL;
}

bool output_write_all(int descriptor, const void *bytes, size_t size) {
  const char *at = bytes;
  while (size > 0) {
    ssize_t written = write(descriptor, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    at += written;
    size -= (size_t)written;
  }
  return true;
}
