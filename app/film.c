#include "app/film.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/output.h"

extern char **environ;

struct Film {
  char *path;         // for messages
  OutputFile *output; // holds the place; ffmpeg writes to its part file
  size_t frame_size;
  pid_t process; // 0 when it has been waited for
  int pipe;      // our end; −1 when closed
  FILE *words;   // what ffmpeg says on stderr, NULL when there is nowhere to keep it
};

const char *film_format(const char *path) {
  static const struct {
    const char *ending, *format;
  } formats[] = {{".mp4", "mp4"}, {".mov", "mov"}, {".mkv", "matroska"}};
  size_t length = strlen(path);
  for (size_t i = 0; i < sizeof formats / sizeof *formats; i++)
    if (length > 4 && strcmp(path + length - 4, formats[i].ending) == 0) return formats[i].format;
  return NULL;
}

// ---- ffmpeg ----------------------------------------------------------------------------------------------------------------

// A process of its own group, so that Ctrl-C on the terminal reaches only us, and we end the film in order.
static int spawn(Film *film, char *const *arguments, int input) {
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  int status = posix_spawn_file_actions_init(&actions);
  if (status) return status;
  status = posix_spawnattr_init(&attributes);
  if (status) {
    posix_spawn_file_actions_destroy(&actions);
    return status;
  }
  // Signals that we ignore would stay ignored there.
  sigset_t defaults;
  sigemptyset(&defaults);
  sigaddset(&defaults, SIGPIPE);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  status = posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  // Its words on stdout would end up among raw pictures, its words on stderr are kept for our own message.
  if (!status) status = posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  if (!status && film->words)
    status = posix_spawn_file_actions_adddup2(&actions, fileno(film->words), STDERR_FILENO);
  else if (!status)
    status = posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  if (!status) status = posix_spawnp(&film->process, "ffmpeg", &actions, &attributes, arguments, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (status) film->process = 0;
  return status;
}

static int start_ffmpeg(Film *film, const FilmDef *def, int input) {
  char size[32], rate[32], url[4200];
  snprintf(size, sizeof size, "%dx%d", def->width, def->height);
  snprintf(rate, sizeof rate, "%.10g", def->fps);
  snprintf(url, sizeof url, "file:%s", output_part(film->output)); // a name with a colon is a name, not a protocol
  // Without -xerror it tells of a full disk and ends as if all were well. Even sizes are what 4:2:0 needs; the matrix is
  // said, so that players do not guess the colours.
  // clang-format off
  char *const arguments[] = {
      "ffmpeg", "-hide_banner", "-loglevel", "error", "-xerror", "-y",
      "-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", size, "-framerate", rate, "-i", "pipe:0", "-an",
      "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p",
      "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv",
      "-movflags", "+faststart", "-f", (char *)film_format(film->path), url, NULL};
  // clang-format on
  return spawn(film, arguments, input);
}

// A pipe whose ends do not leak into other programs.
static bool open_pipe(int ends[2]) {
  if (pipe(ends) != 0) return false;
  for (int i = 0; i < 2; i++) fcntl(ends[i], F_SETFD, FD_CLOEXEC);
  return true;
}

static void free_film(Film *film) {
  if (film->words) fclose(film->words);
  free(film->path);
  free(film);
}

Film *film_open(const FilmDef *def, AppError *error) {
  Film *film = calloc(1, sizeof *film);
  if (film) film->path = strdup(def->path);
  if (!film || !film->path) {
    free(film);
    app_fail(error, APP_FAILED, "%s: out of memory", def->path);
    return NULL;
  }
  signal(SIGPIPE, SIG_IGN); // an ffmpeg that ends early is a write error, with a message
  signal(SIGCHLD, SIG_DFL); // and its exit code can be asked for, whoever started us
  film->frame_size = (size_t)def->width * (size_t)def->height * 3;
  film->words = tmpfile();
  film->output = output_open(def->path, error);
  int ends[2];
  if (!film->output) {
    free_film(film);
    return NULL;
  }
  int status = open_pipe(ends) ? 0 : errno;
  if (!status) {
    status = start_ffmpeg(film, def, ends[0]);
    close(ends[0]);
    film->pipe = ends[1];
    if (status) close(ends[1]);
  }
  if (!status) {
    output_set_writer(film->output, film->process);
    return film;
  }
  if (status == ENOENT)
    app_fail(error, APP_FAILED,
             "%s: ffmpeg is needed for films and was not found; install it, or write pictures "
             "('f_%%05d.png')",
             def->path);
  else
    app_fail(error, APP_FAILED, "%s: ffmpeg cannot be started: %s", def->path, strerror(status));
  output_abort(film->output);
  free_film(film);
  return NULL;
}

// ---- Ending ----------------------------------------------------------------------------------------------------------------

static int wait_for_ffmpeg(Film *film) {
  if (film->pipe >= 0) close(film->pipe);
  film->pipe = -1;
  int status = 0;
  while (waitpid(film->process, &status, 0) < 0)
    if (errno != EINTR) return -1;
  film->process = 0;
  output_set_writer(film->output, 0);
  return status;
}

// The first line that ffmpeg said: the cause; what follows are its consequences.
static void first_words(const Film *film, char text[256]) {
  text[0] = '\0';
  if (!film->words) return;
  rewind(film->words);
  while (!text[0] && fgets(text, 256, film->words)) text[strcspn(text, "\r\n")] = '\0';
}

static bool ffmpeg_failed(const Film *film, int status, AppError *error) {
  char words[256];
  first_words(film, words);
  if (words[0]) return app_fail(error, APP_FAILED, "%s: ffmpeg failed: %s", film->path, words);
  if (WIFSIGNALED(status))
    return app_fail(error, APP_FAILED, "%s: ffmpeg was ended by signal %d", film->path, WTERMSIG(status));
  return app_fail(error, APP_FAILED, "%s: ffmpeg failed with exit code %d", film->path, WEXITSTATUS(status));
}

bool film_write(Film *film, const uint8_t *rgb, AppError *error) {
  if (output_write_all(film->pipe, rgb, film->frame_size)) return true;
  if (errno != EPIPE) return app_fail(error, APP_FAILED, "%s: ffmpeg cannot be fed: %s", film->path, strerror(errno));
  return ffmpeg_failed(film, wait_for_ffmpeg(film), error);
}

bool film_close(Film *film, AppError *error) {
  int status = wait_for_ffmpeg(film);
  bool fine = status == 0;
  if (fine) {
    fine = output_commit(film->output, error);
  } else {
    ffmpeg_failed(film, status, error);
    output_abort(film->output);
  }
  free_film(film);
  return fine;
}

void film_abort(Film *film) {
  if (!film) return;
  if (film->process) {
    kill(film->process, SIGKILL);
    wait_for_ffmpeg(film);
  }
  output_abort(film->output);
  free_film(film);
}
