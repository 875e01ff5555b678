// Where pictures go: numbered PNG or PFM files, a film through ffmpeg, or raw bytes on standard output.
//
// Nothing here ever writes to standard output but the pictures themselves.
#ifndef LIDO_APP_RECORD_H
#define LIDO_APP_RECORD_H

#include <stdint.h>

#include "app/app.h"

typedef enum RecordKind {
  RECORD_PNG,  ///< 'out/f_%05d.png', or one 'picture.png' for a single frame
  RECORD_PFM,  ///< 'out/f_%05d.pfm': raw floats of a layer
  RECORD_FILM, ///< 'film.mp4', or .mkv or .mov
  RECORD_RAW   ///< '-': RGB24, frame after frame
} RecordKind;

/// What the pictures are like.
typedef struct RecordDef {
  const char *output; ///< what follows -o
  int32_t width, height;
  double fps;          ///< of a film
  int64_t first_frame; ///< the number of the first one
  int64_t frame_count; ///< how many are to come: a name without a number is fine for one only
} RecordDef;

typedef struct Record Record;

/// The kind that `output` asks for. False and *error (APP_BAD_INPUT) when it asks for nothing known.
bool record_kind(const char *output, RecordKind *kind, AppError *error);

/// NULL and *error. A film's ffmpeg starts here.
Record *record_open(const RecordDef *def, AppError *error);
/// One picture, width·height·3 bytes, rows from top to bottom. `number` is the frame's. Not for RECORD_PFM.
bool record_picture(Record *record, int64_t number, const uint8_t *rgb, AppError *error);
/// One layer of raw values, for RECORD_PFM only.
bool record_values(Record *record, int64_t number, const float *values, int32_t channels, AppError *error);
/// End it well: a film is finished and renamed into place. Frees `record`, whatever comes of it.
bool record_close(Record *record, AppError *error);
/// End it: what is unfinished goes, pictures that were written stay. NULL is allowed.
void record_abort(Record *record);

#endif
