// What the readers of particle files share: a cursor over the bytes, tokens, numbers of every type, errors that name the
// place, and the one function through which every value goes into a ParticleFile.
#ifndef LIDO_APP_PARTICLE_PARSE_H
#define LIDO_APP_PARTICLE_PARSE_H

#include <stdint.h>

#include "app/app.h"
#include "app/particle_file.h"

/// A file and where we are in it.
typedef struct ParticleReader {
  const char *path; ///< for messages
  /// (size) and one more byte, 0. What parse_has has been asked for and the megabyte behind the cursor are the file's
  /// bytes; the rest is 0.
  const uint8_t *data;
  size_t size, at;
  bool binary;        ///< numbers are bytes, not text
  bool by_byte;       ///< past the first binary block: errors name the byte instead of the line
  bool big_endian;    ///< of binary numbers
  bool to_draw;       ///< check ids and densities, but do not keep them
  bool id_refused;    ///< a value was no id: drop them at the end
  bool class_refused; ///< a value was no class: drop them at the end
  AppError *error;

  // The window of the file that is in memory (particle_bytes.c)
  int descriptor; ///< −1: none
  int failed;     ///< errno of a read that went wrong: the file then ends before it
  uint8_t *bytes; ///< `data`, writable
  size_t room;    ///< bytes set aside
  size_t filled;  ///< bytes before this have been read or skipped
  size_t dropped; ///< bytes before this have been given back …
  size_t lines;   ///< … with so many ends of lines, in the text at the file's beginning
} ParticleReader;

/// Open reader->path. False and the error when it cannot be read or is not a regular file; parse_close in any case.
bool parse_open(ParticleReader *reader);
void parse_close(ParticleReader *reader);
/// Read on until the next `bytes` (at most 64) from the cursor are in memory. False: the file ends before them.
bool parse_fill(ParticleReader *reader, size_t bytes);
/// The same, if they are not there yet. To be asked before any byte is looked at.
static inline bool parse_has(ParticleReader *reader, size_t bytes) {
  return reader->at + bytes <= reader->filled || parse_fill(reader, bytes);
}

/// Fill *reader->error with "FILE: line 3: cause" or "FILE: byte 120: cause" and return false.
#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
bool parse_fail(ParticleReader *reader, size_t place, const char *format, ...);

// ---- Text ----------------------------------------------------------------------------------------------------------------

typedef struct ParseToken {
  const char *text; ///< not terminated
  size_t length;    ///< 0: there is no more
  size_t place;     ///< where it begins
} ParseToken;

/// The next word, over any white space, or on the same line only. The cursor goes behind it.
ParseToken parse_token(ParticleReader *reader);
ParseToken parse_token_on_line(ParticleReader *reader);
/// The rest of the line without its end; the cursor goes to the next line.
ParseToken parse_line(ParticleReader *reader);
/// Compare, whatever the case.
bool parse_is(ParseToken token, const char *word);
/// A token as text for a message, cut to a reasonable length.
const char *parse_text(ParseToken token, char text[64]);

/// The next word as a number. False and the error when it is none. `what` names it in the message.
bool parse_number(ParticleReader *reader, const char *what, double *value);
/// The next word as a count in [0, largest]; more is refused as "at most … can be".
bool parse_count(ParticleReader *reader, const char *what, uint64_t largest, uint64_t *value);

// ---- Numbers -------------------------------------------------------------------------------------------------------------

typedef enum ParseType {
  PARSE_NONE,
  PARSE_INT8,
  PARSE_UINT8,
  PARSE_INT16,
  PARSE_UINT16,
  PARSE_INT32,
  PARSE_UINT32,
  PARSE_INT64,
  PARSE_UINT64,
  PARSE_FLOAT32,
  PARSE_FLOAT64
} ParseType;
size_t parse_type_size(ParseType type); ///< bytes
double parse_binary(const uint8_t *bytes, ParseType type, bool big_endian);

/// Refuse, before any memory is taken, what the rest of the file cannot hold: `count` values of `size` bytes when binary,
/// of at least two characters each when ASCII.
bool parse_check_room(ParticleReader *reader, const char *what, uint64_t count, size_t size);

// ---- Values into a particle file -----------------------------------------------------------------------------------------

typedef enum ParticleField {
  FIELD_NONE,
  FIELD_POSITION,
  FIELD_VELOCITY,
  FIELD_DENSITY,
  FIELD_COLOUR,
  FIELD_RADIUS,
  FIELD_CLASS,
  FIELD_ID
} ParticleField;

/// The field that an array of this name and number of components is.
ParticleField parse_field(ParseToken name, uint64_t components);

/// Memory for a field of file->count particles, unless it is not to be kept. False and the error when memory runs out.
bool parse_begin_field(ParticleReader *reader, ParticleFile *file, ParticleField field);

/// Put one value, read at `place`, into its field. False and the error when it may not be there (not finite …).
bool parse_store(ParticleReader *reader, ParticleFile *file, ParticleField field, uint64_t particle, int component,
                 double value, ParseType type, size_t place);

/// Time, spacing and container from a title that particle_file_title wrote; any other is left alone.
void parse_title(ParticleFile *file, ParseToken title);

#endif
