#include "app/particle_parse.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

bool parse_fail(ParticleReader *reader, size_t place, const char *format, ...) {
  char cause[512];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(cause, sizeof cause, format, arguments);
  va_end(arguments);
  if (reader->by_byte) return app_fail(reader->error, APP_BAD_INPUT, "%s: byte %zu: %s", reader->path, place, cause);
  size_t line = 1 + reader->lines;
  for (size_t i = reader->dropped; i < place && i < reader->size; i++) line += reader->data[i] == '\n';
  return app_fail(reader->error, APP_BAD_INPUT, "%s: line %zu: %s", reader->path, line, cause);
}

// ---- Text ----------------------------------------------------------------------------------------------------------------

static bool is_blank(uint8_t c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

static bool is_space(uint8_t c) {
  return is_blank(c) || c == '\n';
}

ParseToken parse_token_on_line(ParticleReader *reader) {
  while (parse_has(reader, 1) && is_blank(reader->data[reader->at])) reader->at++;
  size_t start = reader->at;
  while (parse_has(reader, 1) && !is_space(reader->data[reader->at])) reader->at++;
  return (ParseToken){(const char *)reader->data + start, reader->at - start, start};
}

ParseToken parse_token(ParticleReader *reader) {
  while (parse_has(reader, 1) && is_space(reader->data[reader->at])) reader->at++;
  return parse_token_on_line(reader);
}

ParseToken parse_line(ParticleReader *reader) {
  size_t start = reader->at;
  while (parse_has(reader, 1) && reader->data[reader->at] != '\n') reader->at++;
  size_t length = reader->at - start;
  if (parse_has(reader, 1)) reader->at++;
  if (length > 0 && reader->data[start + length - 1] == '\r') length--;
  return (ParseToken){(const char *)reader->data + start, length, start};
}

bool parse_is(ParseToken token, const char *word) {
  size_t length = strlen(word);
  if (token.length != length) return false;
  for (size_t i = 0; i < length; i++) {
    char c = token.text[i];
    if (c >= 'A' && c <= 'Z') c = (char)(c - 'A' + 'a');
    if (c != word[i]) return false;
  }
  return true;
}

const char *parse_text(ParseToken token, char text[64]) {
  snprintf(text, 64, "%.*s%s", token.length > 40 ? 40 : (int)token.length, token.text, token.length > 40 ? "..." : "");
  return text;
}

// The token as a number. The data ends with a 0 and every token with white space or that 0, so strtod stops there.
static bool token_number(ParseToken token, double *value) {
  if (token.length == 0 || token.length > 400) return false;
  char *end;
  *value = strtod(token.text, &end);
  return end == token.text + token.length;
}

bool parse_number(ParticleReader *reader, const char *what, double *value) {
  ParseToken token = parse_token(reader);
  char text[64];
  if (token.length == 0) return parse_fail(reader, token.place, "%s: the file ends here", what);
  if (token_number(token, value)) return true;
  return parse_fail(reader, token.place, "%s: a number was expected, not '%s'", what, parse_text(token, text));
}

bool parse_count(ParticleReader *reader, const char *what, uint64_t largest, uint64_t *value) {
  ParseToken token = parse_token_on_line(reader);
  char text[64];
  if (token.length == 0) return parse_fail(reader, token.place, "%s: the number is missing", what);
  uint64_t count = 0;
  bool too_many = false;
  for (size_t i = 0; i < token.length; i++) {
    if (token.text[i] < '0' || token.text[i] > '9')
      return parse_fail(reader, token.place, "%s: a whole number from 0 was expected, not '%s'", what,
                        parse_text(token, text));
    uint64_t digit = (uint64_t)(token.text[i] - '0');
    too_many = too_many || count > (UINT64_MAX - digit) / 10;
    if (!too_many) count = count * 10 + digit;
  }
  if (too_many || count > largest)
    return parse_fail(reader, token.place, "%s: %s is too many, at most %" PRIu64 " can be", what,
                      parse_text(token, text), largest);
  *value = count;
  return true;
}

// ---- Numbers -------------------------------------------------------------------------------------------------------------

size_t parse_type_size(ParseType type) {
  static const size_t sizes[] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return sizes[type];
}

double parse_binary(const uint8_t *bytes, ParseType type, bool big_endian) {
  size_t size = parse_type_size(type);
  uint64_t bits = 0;
  for (size_t i = 0; i < size; i++) bits = bits << 8 | bytes[big_endian ? i : size - 1 - i];
  switch (type) {
  case PARSE_INT8:
    return (int8_t)bits;
  case PARSE_INT16:
    return (int16_t)bits;
  case PARSE_INT32:
    return (int32_t)bits;
  case PARSE_INT64:
    return (double)(int64_t)bits;
  case PARSE_FLOAT32: {
    uint32_t bits32 = (uint32_t)bits;
    float value;
    memcpy(&value, &bits32, sizeof value);
    return value;
  }
  case PARSE_FLOAT64: {
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
  }
  default:
    return (double)bits;
  }
}

bool parse_check_room(ParticleReader *reader, const char *what, uint64_t count, size_t size) {
  uint64_t left = reader->size - reader->at;
  // An ASCII value is a character and a separator, of which the last one may be missing.
  uint64_t room = reader->binary ? (size ? left / size : count) : (left + 1) / 2;
  if (count <= room) return true;
  if (reader->binary)
    return parse_fail(reader, reader->at, "%s: %" PRIu64 " values were announced, but the file ends after %" PRIu64,
                      what, count, room);
  return parse_fail(reader, reader->at, "%s: %" PRIu64 " values were announced, but the file is too short for them",
                    what, count);
}

// ---- Values into a particle file -----------------------------------------------------------------------------------------

static const struct {
  const char *name;
  uint64_t components;
  ParticleField field;
} array_names[] = {
    {"velocity", 3, FIELD_VELOCITY},
    {"velocities", 3, FIELD_VELOCITY},
    {"vel", 3, FIELD_VELOCITY},
    {"v", 3, FIELD_VELOCITY},
    {"density", 1, FIELD_DENSITY},
    {"colour", 3, FIELD_COLOUR},
    {"color", 3, FIELD_COLOUR},
    {"rgb", 3, FIELD_COLOUR},
    {"radius", 1, FIELD_RADIUS},
    {"class", 1, FIELD_CLASS},
    {"id", 1, FIELD_ID},
};

ParticleField parse_field(ParseToken name, uint64_t components) {
  for (size_t i = 0; i < sizeof array_names / sizeof *array_names; i++)
    if (array_names[i].components == components && parse_is(name, array_names[i].name)) return array_names[i].field;
  return FIELD_NONE;
}

static float **float_field(ParticleFile *file, ParticleField field) {
  switch (field) {
  case FIELD_POSITION:
    return &file->position;
  case FIELD_VELOCITY:
    return &file->velocity;
  case FIELD_DENSITY:
    return &file->density;
  case FIELD_COLOUR:
    return &file->colour;
  case FIELD_RADIUS:
    return &file->radius;
  default:
    return NULL;
  }
}

static int field_components(ParticleField field) {
  return field == FIELD_POSITION || field == FIELD_VELOCITY || field == FIELD_COLOUR ? 3 : 1;
}

bool parse_begin_field(ParticleReader *reader, ParticleFile *file, ParticleField field) {
  // One element more, so that an empty file still has arrays: a missing attribute is NULL, an empty one is not.
  size_t count = (size_t)file->count + 1;
  float **values = float_field(file, field);
  bool fine = true;
  if (reader->to_draw && (field == FIELD_ID || field == FIELD_DENSITY)) return true;
  if (values && !*values) fine = (*values = calloc(count * (size_t)field_components(field), sizeof **values)) != NULL;
  if (field == FIELD_CLASS && !file->particle_class) fine = (file->particle_class = calloc(count, 1)) != NULL;
  if (field == FIELD_ID && !file->id) fine = (file->id = calloc(count, sizeof *file->id)) != NULL;
  return fine || app_fail(reader->error, APP_FAILED, "%s: out of memory", reader->path);
}

static const char *field_name(ParticleField field) {
  static const char *const names[] = {"", "position", "velocity", "density", "colour", "radius", "class", "id"};
  return names[field];
}

static float srgb_to_linear(double value) {
  return (float)(value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4));
}

bool parse_store(ParticleReader *reader, ParticleFile *file, ParticleField field, uint64_t particle, int component,
                 double value, ParseType type, size_t place) {
  if (field == FIELD_ID) {
    bool fine = value >= 0 && value <= UINT32_MAX && value == floor(value);
    if (!fine) reader->id_refused = true;
    if (fine && file->id) file->id[particle] = (uint32_t)value;
    return true;
  }
  if (field == FIELD_CLASS) {
    if (value == 0 || value == 1)
      file->particle_class[particle] = (uint8_t)value;
    else
      reader->class_refused = true;
    return true;
  }
  if (!(fabs(value) <= FLT_MAX))
    return parse_fail(reader, place, "%s of particle %" PRIu64 " is not a finite number", field_name(field), particle);
  if (field == FIELD_RADIUS && !((float)value > 0))
    return parse_fail(reader, place, "radius of particle %" PRIu64 " must be above 0, got %g", particle, value);
  if (field == FIELD_COLOUR && type == PARSE_UINT8) value = srgb_to_linear(value / 255);
  if (field == FIELD_COLOUR) value = value < 0 ? 0 : value > 1 ? 1 : value;
  float *values = *float_field(file, field);
  if (values) values[particle * (uint64_t)field_components(field) + (uint64_t)component] = (float)value;
  return true;
}

// ---- The title -----------------------------------------------------------------------------------------------------------

static void title_container(ParticleFile *file, const char *text) {
  double v[6];
  for (int i = 0; i < 6; i++) {
    char *end;
    v[i] = strtod(text, &end);
    if (end == text || !(fabs(v[i]) <= FLT_MAX) || (i < 5 && *end != ',')) return;
    text = end + 1;
  }
  for (int i = 0; i < 3; i++) {
    if (!((float)v[i] < (float)v[i + 3])) return;
    file->container.min[i] = (float)v[i];
    file->container.max[i] = (float)v[i + 3];
  }
  file->has_container = true;
}

void parse_title(ParticleFile *file, ParseToken title) {
  char text[256];
  snprintf(text, sizeof text, "%.*s", title.length > 255 ? 255 : (int)title.length, title.text);
  if (strncmp(text, "Lido ", 5) != 0) return;
  const char *time = strstr(text, " time="), *frame = strstr(text, " frame=");
  const char *radius = strstr(text, " particle_radius="), *container = strstr(text, " container=");
  double value = time ? strtod(time + 6, NULL) : 0;
  if (isfinite(value) && value >= 0) file->time = value;
  value = frame ? strtod(frame + 7, NULL) : 0;
  if (value >= 0 && value <= 1e15) file->index = (int64_t)value;
  value = radius ? strtod(radius + 17, NULL) : 0;
  if (value >= 1e-6 && value <= 1e3) file->particle_radius = (float)value;
  if (container) title_container(file, container + 11);
}
