#define _XOPEN_SOURCE 700 // nftw
#define _DEFAULT_SOURCE   // wait4

#include "run_lido.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

// ---- Files -----------------------------------------------------------------------------------------------------------------

void folder_make(char folder[256]) {
  const char *base = getenv("TMPDIR");
  snprintf(folder, 256, "%s/lido-test-XXXXXX", base && *base ? base : "/tmp");
  assert_non_null(mkdtemp(folder));
}

static int remove_entry(const char *path, const struct stat *status, int type, struct FTW *place) {
  (void)status, (void)type, (void)place;
  return remove(path);
}

void folder_remove(const char *folder) {
  nftw(folder, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

const char *in(const char *folder, const char *name) {
  static char paths[64][1024];
  static int next;
  char *path = paths[next++ % 64];
  snprintf(path, sizeof *paths, "%s/%s", folder, name);
  return path;
}

int folder_count(const char *folder) {
  DIR *directory = opendir(folder);
  if (!directory) return -1;
  int count = 0;
  for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory))
    count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
  closedir(directory);
  return count;
}

bool file_exists(const char *path) {
  return access(path, F_OK) == 0;
}

void file_put(const char *path, const void *bytes, size_t size) {
  FILE *file = fopen(path, "wb");
  assert_non_null(file);
  assert_int_equal(fwrite(bytes, 1, size, file), size);
  assert_int_equal(fclose(file), 0);
}

void file_put_text(const char *path, const char *text) {
  file_put(path, text, strlen(text));
}

uint8_t *file_get(const char *path, size_t *size) {
  FILE *file = fopen(path, "rb");
  if (!file) fail_msg("%s: %s", path, strerror(errno));
  fseek(file, 0, SEEK_END);
  *size = (size_t)ftell(file);
  rewind(file);
  uint8_t *bytes = malloc(*size + 1);
  assert_non_null(bytes);
  assert_int_equal(fread(bytes, 1, *size, file), *size);
  bytes[*size] = 0;
  fclose(file);
  return bytes;
}

bool files_equal(const char *a, const char *b) {
  size_t size_a, size_b;
  uint8_t *bytes_a = file_get(a, &size_a), *bytes_b = file_get(b, &size_b);
  bool equal = size_a == size_b && memcmp(bytes_a, bytes_b, size_a) == 0;
  free(bytes_a);
  free(bytes_b);
  return equal;
}

// ---- Running ---------------------------------------------------------------------------------------------------------------

static void child(const LidoRun *run, const char *const *arguments, int out, int err) {
  const char *argv[64] = {LIDO_PROGRAM};
  for (int i = 0; arguments[i] && i < 62; i++) argv[i + 1] = arguments[i];
#ifdef LIDO_PRELOAD
  setenv("LD_PRELOAD", LIDO_PRELOAD, 1);
  setenv("ASAN_OPTIONS", "verify_asan_link_order=0", 1);
  setenv("LSAN_OPTIONS", "print_suppressions=0:suppressions=" LIDO_SUPPRESSIONS, 1);
#endif
  if (run->path_variable) setenv("PATH", run->path_variable, 1);
  if (run->no_colour) setenv("NO_COLOR", "1", 1);
  if (run->terminal) setenv("TERM", "xterm", 1);
  if (run->file_size_limit) {
    struct rlimit limit = {run->file_size_limit, run->file_size_limit};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  if (run->as_nobody && geteuid() == 0 && (setgid(65534) != 0 || setuid(65534) != 0)) _exit(127);
  execv(LIDO_PROGRAM, (char *const *)argv);
  _exit(127);
}

static bool is_there(const char *path) {
  int entries = folder_count(path); // −1 for a file
  return entries < 0 ? file_exists(path) : entries > 0;
}

static void pause_ms(long ms) {
  nanosleep(&(struct timespec){ms / 1000, ms % 1000 * 1000000}, NULL);
}

// Read what the program says until it ends it; `reader` is our end of its standard output, −1 when that is a file.
static int wait_for(LidoRun *run, pid_t process, int reader) {
  if (reader >= 0) {
    char some[1000];
    assert_true(read(reader, some, sizeof some) > 0);
    close(reader);
  }
  int status;
  bool interrupted = false;
  struct rusage usage = {0};
  for (int waited = 0; wait4(process, &status, WNOHANG, &usage) == 0; waited++) {
    if (run->interrupt_when && !interrupted && is_there(run->interrupt_when)) {
      if (run->interrupt_twice) pause_ms(200);
      kill(process, SIGINT);
      interrupted = true;
    } else if (run->interrupt_twice && interrupted && waited % 10 == 0) {
      kill(process, SIGINT); // until two have arrived: a busy machine hands over two that are near each other as one
    }
    if (waited > 280000) {
      kill(process, SIGKILL);
      waitpid(process, &status, 0);
      fail_msg("the program did not end");
    }
    pause_ms(1);
  }
  run->peak = (int64_t)usage.ru_maxrss * 1024;
  if (run->interrupt_when && !interrupted) print_message("ended before it was interrupted: %s\n", run->text);
  return WIFSIGNALED(status) ? 1000 + WTERMSIG(status) : WEXITSTATUS(status);
}

// Our end of a new terminal; NULL where there are none.
static FILE *open_terminal(void) {
  int master = posix_openpt(O_RDWR | O_NOCTTY);
  if (master >= 0 && grantpt(master) == 0 && unlockpt(master) == 0) return fdopen(master, "rb+");
  if (master >= 0) close(master);
  return NULL;
}

bool lido_has_terminals(void) {
  FILE *terminal = open_terminal();
  if (terminal) fclose(terminal);
  return terminal != NULL;
}

void lido_run(LidoRun *run, const char *const *arguments) {
  FILE *out = run->stdout_to ? fopen(run->stdout_to, "wb") : tmpfile();
  FILE *err = run->terminal ? open_terminal() : tmpfile();
  assert_non_null(out);
  assert_non_null(err);
  int ends[2] = {-1, -1};
  if (run->close_reader) {
    assert_int_equal(pipe(ends), 0);
    fcntl(ends[0], F_SETFD, FD_CLOEXEC);
  }
  fflush(NULL);
  pid_t process = fork();
  assert_true(process >= 0);
  int slave = run->terminal ? open(ptsname(fileno(err)), O_RDWR | O_NOCTTY) : -1;
  if (process == 0) child(run, arguments, run->close_reader ? ends[1] : fileno(out), slave >= 0 ? slave : fileno(err));
  if (run->close_reader) close(ends[1]);
  run->code = wait_for(run, process, ends[0]);

  // Little is said to a terminal, it waits there until now.
  if (run->terminal)
    fcntl(fileno(err), F_SETFL, O_NONBLOCK);
  else
    rewind(err);
  size_t length = 0;
  for (ssize_t got = 1; got > 0; length += got > 0 ? (size_t)got : 0)
    got = read(fileno(err), run->text + length, sizeof run->text - 1 - length);
  if (slave >= 0) close(slave);
  run->text[length] = '\0';
  run->lines = 0;
  for (const char *c = run->text; *c; c++) run->lines += *c == '\n';
  fclose(err);
  fclose(out);
}

void check_done(const LidoRun *run) {
  if (run->code != 0) fail_msg("exit code %d:\n%s", run->code, run->text);
}

void check_said(const LidoRun *run, int code, const char *cause) {
  if (run->code != code || run->lines != 1 || strncmp(run->text, "lido: ", 6) != 0 || !strstr(run->text, cause))
    fail_msg("expected exit code %d and '%s', got %d and\n%s", code, cause, run->code, run->text);
}
