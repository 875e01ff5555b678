// Mesh files through Assimp's C interface. It is handed the bytes of the one file; what the file refers to (materials,
// textures, other files) is not there for it.
#include "app/mesh_file.h"

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "app/text.h"

enum { MOST_REACH = 1000 }; // m, from the mesh's origin

/// One reading at work.
typedef struct Reading {
  const char *path;
  char *data; // of the file
  size_t size;
  char *cause;
  bool *memory;
  // The mesh as it grows
  double *corner; // m, (3 per triangle, 3)
  int32_t *triangle;
  int32_t corner_count, vertex_count, triangle_count;
  float *vertex;
} Reading;

static bool fail(Reading *reading, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(reading->cause, MESH_FILE_CAUSE_SIZE, format, arguments);
  va_end(arguments);
  return false;
}

static bool out_of_memory(Reading *reading) {
  *reading->memory = false;
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

static const struct aiScene *import(Reading *reading) {
  struct aiFileIO io = {.OpenProc = open_cursor, .CloseProc = close_cursor, .UserData = (char *)reading};
  struct aiPropertyStore *properties = aiCreatePropertyStore();
  if (!properties) return NULL;
  // Places of corners and nothing else; points and lines are left out.
  aiSetImportPropertyInteger(properties, AI_CONFIG_PP_RVC_FLAGS,
                             aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS | aiComponent_COLORS |
                                 aiComponent_TEXCOORDS | aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
                                 aiComponent_TEXTURES | aiComponent_LIGHTS | aiComponent_CAMERAS);
  aiSetImportPropertyInteger(properties, AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const struct aiScene *scene = aiImportFileExWithProperties(
      reading->path,
      aiProcess_RemoveComponent | aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_PreTransformVertices, &io,
      properties);
  aiReleasePropertyStore(properties);
  return scene;
}

// ---- From Assimp's meshes to corners ----------------------------------------------------------------------------------

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

static bool take_corners(Reading *reading, const struct aiScene *scene, double scale) {
  int64_t count = count_triangles(scene);
  if (count < 0) return fail(reading, "has faces that are not triangles");
  if (count == 0) return fail(reading, "holds no triangle");
  if (count > MESH_FILE_MOST_TRIANGLES)
    return fail(reading, "has %lld triangles, more than the limit of %d", (long long)count, MESH_FILE_MOST_TRIANGLES);
  reading->corner = calloc((size_t)count * 9, sizeof *reading->corner);
  if (!reading->corner) return out_of_memory(reading);
  double *to = reading->corner;
  for (unsigned m = 0; m < scene->mNumMeshes; m++)
    for (unsigned f = 0; f < scene->mMeshes[m]->mNumFaces; f++)
      for (int k = 0; k < 3; k++, to += 3) {
        const struct aiVector3D *v = &scene->mMeshes[m]->mVertices[scene->mMeshes[m]->mFaces[f].mIndices[k]];
        to[0] = scale * (double)v->x;
        to[1] = scale * (double)v->y;
        to[2] = scale * (double)v->z;
        if (!isfinite(to[0]) || !isfinite(to[1]) || !isfinite(to[2])) return fail(reading, "a corner is not finite");
      }
  reading->corner_count = (int32_t)(3 * count);
  return true;
}

static bool move_corners(Reading *reading, bool centre) {
  for (int k = 0; k < 3; k++) {
    double low = INFINITY, high = -INFINITY;
    for (int32_t i = 0; i < reading->corner_count; i++) {
      low = fmin(low, reading->corner[3 * i + k]);
      high = fmax(high, reading->corner[3 * i + k]);
    }
    double middle = centre ? 0.5 * (low + high) : 0;
    if (!(high - middle <= MOST_REACH && low - middle >= -MOST_REACH))
      return fail(reading, "reaches %g m from its origin, the most is %d m (see scale)",
                  fmax(high - middle, middle - low), MOST_REACH);
    for (int32_t i = 0; i < reading->corner_count; i++) reading->corner[3 * i + k] -= middle;
  }
  return true;
}

// ---- From corners to vertices and triangles ---------------------------------------------------------------------------

typedef struct Place {
  float at[3];
  int32_t corner;
} Place;

static int compare_places(const void *a, const void *b) {
  const Place *x = a, *y = b;
  for (int k = 0; k < 3; k++)
    if (x->at[k] != y->at[k]) return x->at[k] < y->at[k] ? -1 : 1;
  return x->corner < y->corner ? -1 : 1;
}

/// Corners in the same place become one vertex; triangles that have two of one vertex go.
static bool join_corners(Reading *reading) {
  int32_t count = reading->corner_count;
  Place *places = calloc((size_t)count, sizeof *places);
  reading->vertex = calloc((size_t)count * 3, sizeof *reading->vertex);
  reading->triangle = calloc((size_t)count, sizeof *reading->triangle);
  if (!places || !reading->vertex || !reading->triangle) {
    free(places);
    return out_of_memory(reading);
  }
  for (int32_t i = 0; i < count; i++) {
    for (int k = 0; k < 3; k++) places[i].at[k] = (float)reading->corner[3 * i + k];
    places[i].corner = i;
  }
  qsort(places, (size_t)count, sizeof *places, compare_places);
  for (int32_t i = 0; i < count; i++) {
    bool same = i > 0 && places[i].at[0] == places[i - 1].at[0] && places[i].at[1] == places[i - 1].at[1] &&
                places[i].at[2] == places[i - 1].at[2];
    if (!same) memcpy(reading->vertex + 3 * reading->vertex_count++, places[i].at, sizeof places[i].at);
    reading->triangle[places[i].corner] = reading->vertex_count - 1;
  }
  free(places);
  for (int32_t t = 0; t < count / 3; t++) {
    const int32_t *from = reading->triangle + 3 * t;
    if (from[0] == from[1] || from[1] == from[2] || from[2] == from[0]) continue;
    memmove(reading->triangle + 3 * reading->triangle_count++, from, 3 * sizeof *from);
  }
  return reading->triangle_count >= 4 || fail(reading, "is no body: fewer than four triangles with an area");
}

static int compare_edges(const void *a, const void *b) {
  const int32_t *x = a, *y = b;
  for (int k = 0; k < 3; k++)
    if (x[k] != y[k]) return x[k] < y[k] ? -1 : 1;
  return 0;
}

/// Closed: along every edge as many triangles run one way as the other.
static bool check_closed(Reading *reading) {
  int32_t count = 3 * reading->triangle_count, open = 0;
  int32_t(*edges)[3] = calloc((size_t)count, sizeof *edges); // lower vertex, higher vertex, direction
  if (!edges) return out_of_memory(reading);
  for (int32_t i = 0; i < count; i++) {
    int32_t a = reading->triangle[i], b = reading->triangle[i % 3 == 2 ? i - 2 : i + 1];
    edges[i][0] = a < b ? a : b;
    edges[i][1] = a < b ? b : a;
    edges[i][2] = a < b ? 1 : -1;
  }
  qsort(edges, (size_t)count, sizeof *edges, compare_edges);
  for (int32_t i = 0, end; i < count; i = end) {
    int32_t balance = 0;
    for (end = i; end < count && edges[end][0] == edges[i][0] && edges[end][1] == edges[i][1]; end++)
      balance += edges[end][2];
    open += balance != 0;
  }
  free(edges);
  return open == 0 || fail(reading, "is not closed: at %d of its edges triangles are missing or face the other way", open);
}

/// Six times the volume, positive where normals point outwards.
static double six_volumes(const Reading *reading) {
  double sum = 0;
  for (int32_t t = 0; t < reading->triangle_count; t++) {
    const float *a = reading->vertex + 3 * reading->triangle[3 * t];
    const float *b = reading->vertex + 3 * reading->triangle[3 * t + 1];
    const float *c = reading->vertex + 3 * reading->triangle[3 * t + 2];
    for (int k = 0; k < 3; k++) {
      int m = (k + 1) % 3, n = (k + 2) % 3;
      sum += (double)a[k] * ((double)b[m] * c[n] - (double)b[n] * c[m]);
    }
  }
  return sum;
}

static bool turn_outwards(Reading *reading) {
  double volume = six_volumes(reading);
  if (!(fabs(volume) > 0)) return fail(reading, "is no body: it has no volume");
  for (int32_t t = 0; volume < 0 && t < reading->triangle_count; t++) {
    int32_t *triangle = reading->triangle + 3 * t, second = triangle[1];
    triangle[1] = triangle[2];
    triangle[2] = second;
  }
  return true;
}

// ---- All of it ----------------------------------------------------------------------------------------------------------

static bool read_corners(Reading *reading, double scale) {
  if (!read_bytes(reading)) return false;
  const struct aiScene *scene = import(reading);
  if (!scene) {
    char reason[200];
    const char *said = aiGetErrorString();
    return fail(reading, "cannot be read: %s", text_printable(reason, sizeof reason, said ? said : "", 180));
  }
  bool taken = take_corners(reading, scene, scale);
  aiReleaseImport(scene);
  return taken;
}

bool mesh_file_read(const char *path, double scale, bool centre, SimMesh *mesh, char cause[MESH_FILE_CAUSE_SIZE],
                    bool *memory) {
  Reading reading = {.path = path, .cause = cause, .memory = memory};
  *mesh = (SimMesh){0};
  *memory = true;
  bool good = read_corners(&reading, scale) && move_corners(&reading, centre) && join_corners(&reading) &&
              check_closed(&reading) && turn_outwards(&reading);
  free(reading.data);
  free(reading.corner);
  if (good) {
    *mesh = (SimMesh){reading.vertex_count, reading.triangle_count, reading.vertex, reading.triangle};
    return true;
  }
  free(reading.vertex);
  free(reading.triangle);
  return false;
}

void mesh_file_free(SimMesh *mesh) {
  free((void *)mesh->vertex);
  free((void *)mesh->triangle);
  *mesh = (SimMesh){0};
}
