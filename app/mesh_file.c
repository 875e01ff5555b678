// Mesh files: what the importer finds is scaled, joined and checked here. See mesh_import.h for the importer.
#include "app/mesh_file.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/mesh_import.h"

enum { MOST_REACH = 1000 }; // m, from the mesh's origin

/// One reading at work.
typedef struct Reading {
  char *cause;
  bool *memory;
  double *corner; // m, (corner_count, 3)
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

// ---- Corners in metres ------------------------------------------------------------------------------------------------

static bool scale_corners(Reading *reading, const float *corner, double scale) {
  reading->corner = calloc((size_t)reading->corner_count * 3, sizeof *reading->corner);
  if (!reading->corner) return out_of_memory(reading);
  for (int32_t i = 0; i < 3 * reading->corner_count; i++) {
    reading->corner[i] = scale * (double)corner[i];
    if (!isfinite(reading->corner[i])) return fail(reading, "a corner is not finite");
  }
  return true;
}

static bool read_corners(Reading *reading, const char *path, double scale) {
  MeshImport import = {.cause = reading->cause, .cause_size = MESH_FILE_CAUSE_SIZE};
  bool good = mesh_import(path, &import);
  if (!good && import.out_of_memory) *reading->memory = false;
  reading->corner_count = 3 * import.triangle_count;
  good = good && scale_corners(reading, import.corner, scale);
  free(import.corner);
  return good;
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
  return open == 0 ||
         fail(reading, "is not closed: at %d of its edges triangles are missing or face the other way", open);
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

bool mesh_file_read(const char *path, double scale, bool centre, SimMesh *mesh, char cause[MESH_FILE_CAUSE_SIZE],
                    bool *memory) {
  Reading reading = {.cause = cause, .memory = memory};
  *mesh = (SimMesh){0};
  *memory = true;
  bool good = read_corners(&reading, path, scale) && move_corners(&reading, centre) && join_corners(&reading) &&
              check_closed(&reading) && turn_outwards(&reading);
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
