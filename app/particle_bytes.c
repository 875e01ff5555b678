// The bytes of a particle file, each at its place in memory, of which only a window around the cursor is there: room for
// the whole file is set aside, filled as the cursor moves on and given back behind it. So a parser may look at any byte
// that it has been at, and the largest file takes a few megabytes. A file that shrinks meanwhile ends early, no more.
#define _DEFAULT_SOURCE // MAP_ANONYMOUS, MAP_NORESERVE, madvise

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/particle_parse.h"

enum { STEP = 1 << 20 }; // bytes: read at a time, kept behind the cursor, given back at a time; whole pages

bool parse_open(ParticleReader *reader) {
  const char *path = reader->path;
  struct stat status;
  reader->descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); // does not wait for a pipe's other end
  if (reader->descriptor < 0 || fstat(reader->descriptor, &status) != 0)
    return app_fail(reader->error, APP_BAD_INPUT, "%s: cannot be read: %s", path, strerror(errno));
  if (!S_ISREG(status.st_mode))
    return app_fail(reader->error, APP_BAD_INPUT, "%s: cannot be read: it is not a regular file", path);
  reader->size = (size_t)status.st_size;
  void *room = mmap(NULL, reader->size + 1, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room == MAP_FAILED) return app_fail(reader->error, APP_FAILED, "%s: out of memory", path);
  reader->room = reader->size + 1;
  reader->data = reader->bytes = room;
  return true;
}

void parse_close(ParticleReader *reader) {
  if (reader->bytes) munmap(reader->bytes, reader->room);
  if (reader->descriptor >= 0) close(reader->descriptor);
  reader->data = reader->bytes = NULL;
  reader->descriptor = -1;
}

// Give back what lies a step behind the cursor. Lines are counted as long as errors name them.
static void drop(ParticleReader *reader) {
  if (reader->at < 2 * (size_t)STEP) return;
  size_t keep = (reader->at / STEP - 1) * STEP;
  if (keep <= reader->dropped) return;
  for (size_t i = reader->dropped; i < keep && !reader->by_byte; i++) reader->lines += reader->bytes[i] == '\n';
  madvise(reader->bytes + reader->dropped, keep - reader->dropped, MADV_DONTNEED);
  reader->dropped = keep;
}

bool parse_fill(ParticleReader *reader, size_t bytes) {
  drop(reader);
  size_t from = reader->at > reader->filled ? reader->at : reader->filled; // what was skipped is never read
  size_t left = reader->size - from, wanted = left < STEP ? left : STEP;
  while (wanted > 0) {
    ssize_t got = pread(reader->descriptor, reader->bytes + from, wanted, (off_t)from);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) reader->failed = errno;
    if (got <= 0) reader->size = from;
    if (got <= 0) break;
    from += (size_t)got;
    wanted -= (size_t)got;
  }
  reader->filled = from;
  return bytes <= reader->filled - reader->at;
}
