#include "app/particle_file.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "app/output.h"
#include "app/particle_parse.h"

static bool ends_with(const char *text, const char *ending) {
  size_t length = strlen(text), ending_length = strlen(ending);
  return length > ending_length && strcmp(text + length - ending_length, ending) == 0;
}

bool particle_file_named(const char *path) {
  return ends_with(path, ".vtk") || ends_with(path, ".ply");
}

void particle_file_free(ParticleFile *file) {
  free(file->position);
  free(file->velocity);
  free(file->density);
  free(file->colour);
  free(file->radius);
  free(file->particle_class);
  free(file->id);
  *file = (ParticleFile){0};
}

SimParticleSet particle_file_set(const ParticleFile *file) {
  return (SimParticleSet){.index = file->index,
                          .time = file->time,
                          .count = file->count,
                          .position = file->position,
                          .velocity = file->velocity,
                          .colour = file->colour,
                          .radius = file->radius,
                          .particle_class = file->particle_class,
                          .id = file->id,
                          .particle_radius = file->particle_radius,
                          .container = file->has_container ? &file->container : NULL};
}

// ---- Order by id -----------------------------------------------------------------------------------------------------------

// Radix sort in two passes of 16 bits: the places 0 … count − 1 in the order of their ids. NULL when memory runs out.
static uint32_t *order_by_id(const uint32_t *id, int32_t count) {
  uint32_t *order = malloc(((size_t)count + 1) * sizeof *order);
  uint32_t *scratch = malloc(((size_t)count + 1) * sizeof *scratch);
  uint32_t *start = malloc(65537 * sizeof *start);
  bool fine = order && scratch && start;
  if (fine) {
    for (int32_t i = 0; i < count; i++) scratch[i] = (uint32_t)i;
    for (int pass = 0; pass < 2; pass++) {
      const uint32_t *from = pass == 0 ? scratch : order;
      uint32_t *to = pass == 0 ? order : scratch;
      memset(start, 0, 65537 * sizeof *start);
      for (int32_t i = 0; i < count; i++) start[(id[i] >> (16 * pass) & 0xffff) + 1]++;
      for (int k = 0; k < 65536; k++) start[k + 1] += start[k];
      for (int32_t i = 0; i < count; i++) to[start[id[from[i]] >> (16 * pass) & 0xffff]++] = from[i];
    }
    memcpy(order, scratch, (size_t)count * sizeof *order);
  }
  free(scratch);
  free(start);
  if (fine) return order;
  free(order);
  return NULL;
}

// ---- Reading ---------------------------------------------------------------------------------------------------------------

static bool starts_with(ParticleReader *reader, const char *text) {
  size_t length = strlen(text);
  return parse_has(reader, length) && memcmp(reader->data, text, length) == 0;
}

static bool read_any(ParticleReader *reader, ParticleFile *file) {
  if (reader->size == 0) return app_fail(reader->error, APP_BAD_INPUT, "%s: the file is empty", reader->path);
  if (starts_with(reader, "# vtk DataFile")) return particle_vtk_read(reader, file);
  if (starts_with(reader, "ply\n") || starts_with(reader, "ply\r\n")) return particle_ply_read(reader, file);
  if (starts_with(reader, "<?xml") || starts_with(reader, "<VTKFile"))
    return parse_fail(reader, 0, "VTK files in XML are not read, only legacy ones ('# vtk DataFile Version')");
  return parse_fail(reader, 0, "neither a legacy VTK file ('# vtk DataFile Version') nor a PLY file ('ply')");
}

// Drop ids and classes that cannot be ours. False when memory runs out.
static bool drop_foreign(const ParticleReader *reader, ParticleFile *file) {
  if (reader->class_refused) {
    free(file->particle_class);
    file->particle_class = NULL;
  }
  bool unique = !reader->id_refused;
  if (file->id && unique) {
    uint32_t *order = order_by_id(file->id, file->count);
    if (!order) return app_fail(reader->error, APP_FAILED, "%s: out of memory", reader->path);
    for (int32_t i = 1; i < file->count; i++) unique = unique && file->id[order[i - 1]] != file->id[order[i]];
    free(order);
  }
  if (!unique) {
    free(file->id);
    file->id = NULL;
  }
  return true;
}

static bool read_file(ParticleReader *reader, ParticleFile *file) {
  *file = (ParticleFile){0};
  bool fine = parse_open(reader) && read_any(reader, file) && drop_foreign(reader, file);
  // Whatever the parser makes of the end, this is the cause of it.
  if (reader->failed)
    fine = app_fail(reader->error, APP_BAD_INPUT, "%s: cannot be read: %s", reader->path, strerror(reader->failed));
  parse_close(reader);
  if (!fine) particle_file_free(file);
  return fine;
}

bool particle_file_read(const char *path, ParticleFile *file, AppError *error) {
  return read_file(&(ParticleReader){.path = path, .error = error, .descriptor = -1}, file);
}

bool particle_file_read_to_draw(const char *path, ParticleFile *file, AppError *error) {
  return read_file(&(ParticleReader){.path = path, .error = error, .descriptor = -1, .to_draw = true}, file);
}

// ---- Writing ---------------------------------------------------------------------------------------------------------------

void particle_file_title(const SimFrame *frame, char title[256]) {
  int length = snprintf(title, 256, "Lido %s time=%.17g frame=%" PRId64 " particle_radius=%.9g", SIM_VERSION_STRING,
                        frame->time, frame->index, frame->particle_radius);
  if (!frame->has_container || length < 0 || length > 200) return;
  const float *min = frame->container.min, *max = frame->container.max;
  snprintf(title + length, 256 - (size_t)length, " container=%.9g,%.9g,%.9g,%.9g,%.9g,%.9g", min[0], min[1], min[2],
           max[0], max[1], max[2]);
}

bool particle_file_write(const char *path, const SimFrame *frame, AppError *error) {
  uint32_t *order = order_by_id(frame->id, frame->count);
  if (!order) return app_fail(error, APP_FAILED, "%s: out of memory", path);
  OutputFile *output = output_open(path, error);
  bool written = false;
  if (output) {
    setvbuf(output_file(output), NULL, _IOFBF, 1 << 18);
    if (ends_with(path, ".ply"))
      particle_ply_write(output_file(output), frame, order);
    else
      particle_vtk_write(output_file(output), frame, order);
    written = output_commit(output, error);
  }
  free(order);
  return written;
}
