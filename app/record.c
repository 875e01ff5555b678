#include "app/record.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/film.h"
#include "app/image.h"
#include "app/output.h"
#include "app/pattern.h"

struct Record {
  RecordKind kind;
  RecordDef def;
  Pattern pattern; // of numbered files
  Film *film;
};

static bool ends_with(const char *text, const char *ending) {
  size_t length = strlen(text), ending_length = strlen(ending);
  return length > ending_length && strcmp(text + length - ending_length, ending) == 0;
}

bool record_kind(const char *output, RecordKind *kind, AppError *error) {
  if (strcmp(output, "-") == 0)
    *kind = RECORD_RAW;
  else if (ends_with(output, ".png"))
    *kind = RECORD_PNG;
  else if (ends_with(output, ".pfm"))
    *kind = RECORD_PFM;
  else if (film_format(output))
    *kind = RECORD_FILM;
  else
    return app_fail(error, APP_BAD_INPUT,
                    "-o: '%s': must be numbered pictures ('out/f_%%05d.png'), a film ('film.mp4') or '-'", output);
  return true;
}

static bool probe(const Record *record, AppError *error) {
  char *path = pattern_expand(&record->pattern, record->def.first_frame);
  if (!path) return app_fail(error, APP_FAILED, "out of memory");
  bool fine = output_probe(path, error);
  free(path);
  return fine;
}

// Everything that is wrong with where the pictures shall go, before any work is done.
static bool prepare(Record *record, AppError *error) {
  const RecordDef *def = &record->def;
  switch (record->kind) {
  case RECORD_PNG:
  case RECORD_PFM:
    if (!pattern_parse(&record->pattern, def->output, error)) return false;
    if (!record->pattern.numbered && def->frame_count > 1)
      return app_fail(error, APP_BAD_INPUT, "-o: '%s': the name needs a number (%%05d) where there are several frames",
                      def->output);
    return probe(record, error);
  case RECORD_FILM: {
    if (!pattern_parse(&record->pattern, def->output, error)) return false;
    if (record->pattern.numbered)
      return app_fail(error, APP_BAD_INPUT, "-o: '%s': a film is one file, its name has no number", def->output);
    FilmDef film = {record->pattern.before, def->width, def->height, def->fps};
    record->film = film_open(&film, error);
    return record->film != NULL;
  }
  case RECORD_RAW:
    if (!isatty(STDOUT_FILENO)) return true;
    return app_fail(error, APP_BAD_INPUT, "-o -: raw pictures are not for a terminal; pipe them into a program");
  }
  return false;
}

Record *record_open(const RecordDef *def, AppError *error) {
  RecordKind kind;
  if (!record_kind(def->output, &kind, error)) return NULL;
  Record *record = calloc(1, sizeof *record);
  if (!record) {
    app_fail(error, APP_FAILED, "out of memory");
    return NULL;
  }
  record->kind = kind;
  record->def = *def;
  if (prepare(record, error)) return record;
  free(record);
  return NULL;
}

static bool write_raw(const Record *record, const uint8_t *rgb, AppError *error) {
  size_t size = (size_t)record->def.width * (size_t)record->def.height * 3;
  if (output_write_all(STDOUT_FILENO, rgb, size)) return true;
  if (errno == EPIPE) return app_fail(error, APP_FAILED, "standard output: its reader has gone");
  return app_fail(error, APP_FAILED, "standard output: cannot be written: %s", strerror(errno));
}

bool record_picture(Record *record, int64_t number, const uint8_t *rgb, AppError *error) {
  if (record->kind == RECORD_RAW) return write_raw(record, rgb, error);
  if (record->kind == RECORD_FILM) return film_write(record->film, rgb, error);
  char *path = pattern_expand(&record->pattern, number);
  if (!path) return app_fail(error, APP_FAILED, "out of memory");
  bool written = image_write_png(path, rgb, record->def.width, record->def.height, error);
  free(path);
  return written;
}

bool record_values(Record *record, int64_t number, const float *values, int32_t channels, AppError *error) {
  char *path = pattern_expand(&record->pattern, number);
  if (!path) return app_fail(error, APP_FAILED, "out of memory");
  bool written = image_write_pfm(path, values, record->def.width, record->def.height, channels, error);
  free(path);
  return written;
}

bool record_close(Record *record, AppError *error) {
  bool fine = !record->film || film_close(record->film, error);
  free(record);
  return fine;
}

void record_abort(Record *record) {
  if (!record) return;
  film_abort(record->film);
  free(record);
}
