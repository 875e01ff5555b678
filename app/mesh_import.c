// The triangles of a mesh file, by Assimp in a process of its own.
//
// Mesh files come from outside, and their readers are large: a broken file may end them, make them run for ever or take
// all memory. So the bytes are read here, with a bound; a child process with bounds on its time and memory makes triangles
// of them and sends these back through a pipe. Whatever happens to it is told as a fault of the file. Assimp is handed
// the bytes of the one file; what the file refers to (materials, textures, other files) is not there for it.
#include "app/mesh_import.h"

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/mesh_file.h"
#include "app/text.h"

enum { LEAST_SECONDS = 3, MOST_GIB = 4 }; // of the child: seconds of processor time for a small file

/// The file in memory, and who asks for it.
typedef struct Reading {
  const char *path;
  char *data; // (size)
  size_t size;
  MeshImport *import;
} Reading;

/// What the child says first; behind it come the cause, or the corners.
typedef struct Answer {
  int64_t triangles; // 0: a cause of `length` bytes follows
  int64_t length;
} Answer;

static bool fail(Reading *reading, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(reading->import->cause, reading->import->cause_size, format, arguments);
  va_end(arguments);
  return false;
}

static bool out_of_memory(Reading *reading) {
  reading->import->out_of_memory = true;
  return fail(reading, "out of memory");
}

// ---- The file -------------------------------------------------------------------------------------------------------

static bool known_format(const char *path) {
  const char *dot = strrchr(path, '.');
  char formats[] = MESH_FILE_FORMATS;
  for (char *rest = formats, *name; dot && (name = strtok_r(rest, ", ", &rest));)
    if (strcasecmp(dot + 1, name) == 0) return true;
  return false;
}

static bool read_bytes(Reading *reading) {
  struct stat status;
  if (!known_format(reading->path)) return fail(reading, "is not a mesh file: one of %s", MESH_FILE_FORMATS);
  if (stat(reading->path, &status) != 0) return fail(reading, "%s", strerror(errno));
  if (!S_ISREG(status.st_mode)) return fail(reading, "is not a file");
  if (status.st_size > MESH_FILE_MOST_BYTES)
    return fail(reading, "is larger than %d MiB, the most that a mesh file may have", MESH_FILE_MOST_BYTES >> 20);
  FILE *file = fopen(reading->path, "rb");
  if (!file) return fail(reading, "%s", strerror(errno));
  // One byte more than allowed, so that a file that has grown is noticed; one more for a NUL, which text readers like.
  size_t room = (size_t)status.st_size + 1;
  reading->data = calloc(1, room + 1);
  if (reading->data) reading->size = fread(reading->data, 1, room, file);
  bool broken = ferror(file) != 0;
  fclose(file);
  if (!reading->data) return out_of_memory(reading);
  if (broken) return fail(reading, "cannot be read");
  if (reading->size == 0) return fail(reading, "the file is empty");
  return reading->size < room || fail(reading, "changes while it is read");
}

// ---- What Assimp sees: one file in memory -----------------------------------------------------------------------------

typedef struct Cursor {
  const Reading *reading;
  size_t at;
} Cursor;

static size_t cursor_read(struct aiFile *file, char *to, size_t size, size_t count) {
  Cursor *cursor = (Cursor *)file->UserData;
  size_t whole = size ? (cursor->reading->size - cursor->at) / size : 0;
  if (count > whole) count = whole;
  memcpy(to, cursor->reading->data + cursor->at, size * count);
  cursor->at += size * count;
  return count;
}

static size_t cursor_write(struct aiFile *file, const char *from, size_t size, size_t count) {
  (void)file, (void)from, (void)size, (void)count;
  return 0;
}

static size_t cursor_tell(struct aiFile *file) {
  return ((const Cursor *)file->UserData)->at;
}

static size_t cursor_size(struct aiFile *file) {
  return ((const Cursor *)file->UserData)->reading->size;
}

static enum aiReturn cursor_seek(struct aiFile *file, size_t offset, enum aiOrigin origin) {
  Cursor *cursor = (Cursor *)file->UserData;
  size_t size = cursor->reading->size;
  size_t from = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? cursor->at : size;
  // From the end Assimp counts backwards.
  if (origin == aiOrigin_END ? offset > size : offset > size - from) return aiReturn_FAILURE;
  cursor->at = origin == aiOrigin_END ? size - offset : from + offset;
  return aiReturn_SUCCESS;
}

static void cursor_flush(struct aiFile *file) {
  (void)file;
}

static struct aiFile *open_cursor(struct aiFileIO *io, const char *path, const char *mode) {
  const Reading *reading = (const Reading *)io->UserData;
  if (strcmp(path, reading->path) != 0 || mode[0] != 'r') return NULL;
  struct aiFile *file = calloc(1, sizeof *file);
  Cursor *cursor = calloc(1, sizeof *cursor);
  if (!file || !cursor) {
    free(file);
    free(cursor);
    return NULL;
  }
  cursor->reading = reading;
  *file = (struct aiFile){.ReadProc = cursor_read,
                          .WriteProc = cursor_write,
                          .TellProc = cursor_tell,
                          .FileSizeProc = cursor_size,
                          .SeekProc = cursor_seek,
                          .FlushProc = cursor_flush,
                          .UserData = (char *)cursor};
  return file;
}

static void close_cursor(struct aiFileIO *io, struct aiFile *file) {
  (void)io;
  free(file->UserData);
  free(file);
}

static const struct aiScene *import_scene(Reading *reading) {
  struct aiFileIO io = {.OpenProc = open_cursor, .CloseProc = close_cursor, .UserData = (char *)reading};
  struct aiPropertyStore *properties = aiCreatePropertyStore();
  if (!properties) return NULL;
  // Places of corners and nothing else; points and lines are left out.
  aiSetImportPropertyInteger(properties, AI_CONFIG_PP_RVC_FLAGS,
                             aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS | aiComponent_COLORS |
                                 aiComponent_TEXCOORDS | aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
                                 aiComponent_TEXTURES | aiComponent_LIGHTS | aiComponent_CAMERAS);
  aiSetImportPropertyInteger(properties, AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const struct aiScene *scene = aiImportFileExWithProperties(reading->path,
                                                             aiProcess_RemoveComponent | aiProcess_Triangulate |
                                                                 aiProcess_SortByPType | aiProcess_PreTransformVertices,
                                                             &io, properties);
  aiReleasePropertyStore(properties);
  return scene;
}

// ---- In the child: from Assimp's meshes to corners --------------------------------------------------------------------

/// Triangles of all parts; −1 when a part is not made of sound triangles.
static int64_t count_triangles(const struct aiScene *scene) {
  int64_t count = 0;
  for (unsigned m = 0; m < scene->mNumMeshes; m++) {
    const struct aiMesh *mesh = scene->mMeshes[m];
    for (unsigned f = 0; f < mesh->mNumFaces; f++) {
      const struct aiFace *face = &mesh->mFaces[f];
      if (face->mNumIndices != 3) return -1;
      for (int k = 0; k < 3; k++)
        if (face->mIndices[k] >= mesh->mNumVertices) return -1;
    }
    count += mesh->mNumFaces;
  }
  return count;
}

static void send(int pipe_end, const void *bytes, size_t size) {
  for (const char *at = bytes; size > 0;) {
    ssize_t sent = write(pipe_end, at, size);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) _exit(1);
    at += sent;
    size -= (size_t)sent;
  }
}

static void send_cause(int pipe_end, const char *cause) {
  Answer answer = {.length = (int64_t)strlen(cause)};
  send(pipe_end, &answer, sizeof answer);
  send(pipe_end, cause, (size_t)answer.length);
}

static void send_triangles(int pipe_end, const struct aiScene *scene, int64_t count) {
  send(pipe_end, &(Answer){.triangles = count}, sizeof(Answer));
  for (unsigned m = 0; m < scene->mNumMeshes; m++)
    for (unsigned f = 0; f < scene->mMeshes[m]->mNumFaces; f++) {
      float corners[9];
      for (int k = 0; k < 3; k++) {
        const struct aiVector3D *v = &scene->mMeshes[m]->mVertices[scene->mMeshes[m]->mFaces[f].mIndices[k]];
        corners[3 * k] = v->x;
        corners[3 * k + 1] = v->y;
        corners[3 * k + 2] = v->z;
      }
      send(pipe_end, corners, sizeof corners);
    }
}

/// A second more for each MiB, several times what a sound file takes.
static int seconds_for(const Reading *reading) {
  return LEAST_SECONDS + (int)(reading->size >> 20);
}

static void limit(int what, rlim_t most) {
  setrlimit(what, &(struct rlimit){most, most});
}

/// Sanitizers reserve more addresses than there is memory.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define LIMIT_MEMORY 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define LIMIT_MEMORY 0
#endif
#endif
#ifndef LIMIT_MEMORY
#define LIMIT_MEMORY 1
#endif

static void be_child(Reading *reading, int pipe_end) {
  limit(RLIMIT_CPU, (rlim_t)seconds_for(reading));
  limit(RLIMIT_CORE, 0);
  if (LIMIT_MEMORY) limit(RLIMIT_AS, (rlim_t)MOST_GIB << 30);
  signal(SIGABRT, SIG_DFL);
  signal(SIGINT, SIG_DFL);
  // What it has to say about itself is nobody's business.
  int nowhere = open("/dev/null", O_WRONLY);
  if (nowhere >= 0) {
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
  }
  const struct aiScene *scene = import_scene(reading);
  int64_t count = scene ? count_triangles(scene) : 0;
  char cause[MESH_FILE_CAUSE_SIZE], reason[200];
  const char *said = scene ? NULL : aiGetErrorString();
  if (!scene)
    snprintf(cause, sizeof cause, "cannot be read: %s", text_printable(reason, sizeof reason, said ? said : "", 180));
  else if (count < 0)
    snprintf(cause, sizeof cause, "has faces that are not triangles");
  else if (count == 0)
    snprintf(cause, sizeof cause, "holds no triangle");
  else if (count > MESH_FILE_MOST_TRIANGLES)
    snprintf(cause, sizeof cause, "has %lld triangles, more than the limit of %d", (long long)count,
             MESH_FILE_MOST_TRIANGLES);
  else
    send_triangles(pipe_end, scene, count), _exit(0);
  send_cause(pipe_end, cause);
  _exit(0);
}

// ---- In the parent ------------------------------------------------------------------------------------------------------

static bool receive(int pipe_end, void *bytes, size_t size) {
  for (char *at = bytes; size > 0;) {
    ssize_t got = read(pipe_end, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got;
    size -= (size_t)got;
  }
  return true;
}

/// What the child sends, as far as it comes. true: all of it, and it holds triangles.
static bool receive_answer(Reading *reading, int pipe_end, bool *whole) {
  Answer answer;
  *whole = false;
  if (!receive(pipe_end, &answer, sizeof answer)) return false;
  if (answer.triangles < 0 || answer.triangles > MESH_FILE_MOST_TRIANGLES) return false;
  if (answer.triangles == 0) {
    char cause[MESH_FILE_CAUSE_SIZE] = "", printable[MESH_FILE_CAUSE_SIZE];
    if (answer.length < 0 || answer.length >= (int64_t)sizeof cause) return false;
    *whole = receive(pipe_end, cause, (size_t)answer.length);
    return fail(reading, "%s", text_printable(printable, sizeof printable, cause, sizeof cause));
  }
  size_t size = (size_t)answer.triangles * 9 * sizeof(float);
  reading->import->corner = malloc(size);
  if (!reading->import->corner) {
    *whole = true;
    return out_of_memory(reading);
  }
  reading->import->triangle_count = (int32_t)answer.triangles;
  return *whole = receive(pipe_end, reading->import->corner, size);
}

static bool import_in_child(Reading *reading) {
  int ends[2], status = 0;
  if (pipe(ends) != 0) return fail(reading, "cannot be read: %s", strerror(errno));
  pid_t child = fork();
  if (child < 0) {
    close(ends[0]);
    close(ends[1]);
    return fail(reading, "cannot be read: %s", strerror(errno));
  }
  if (child == 0) {
    close(ends[0]);
    be_child(reading, ends[1]);
  }
  close(ends[1]);
  bool whole, good = receive_answer(reading, ends[0], &whole);
  close(ends[0]);
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (whole) return good;
  bool slow = WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL);
  if (slow) return fail(reading, "cannot be read: it takes more than %d s or too much memory", seconds_for(reading));
  return fail(reading, "cannot be read: it breaks the reader");
}

bool mesh_import(const char *path, MeshImport *import) {
  Reading reading = {.path = path, .import = import};
  bool good = read_bytes(&reading) && import_in_child(&reading);
  free(reading.data);
  return good;
}
