// PLY files.
// Format: G. Turk, "The PLY Polygon File Format", Stanford, 1994.
#include <inttypes.h>
#include <string.h>

#include "app/particle_parse.h"

// ---- Writing ---------------------------------------------------------------------------------------------------------------

static void put_word(FILE *stream, uint32_t word) {
  uint8_t bytes[4] = {(uint8_t)word, (uint8_t)(word >> 8), (uint8_t)(word >> 16), (uint8_t)(word >> 24)};
  fwrite(bytes, 1, 4, stream);
}

static void put_floats(FILE *stream, const float *values, uint32_t particle, int components) {
  if (!values) return;
  for (int k = 0; k < components; k++) {
    uint32_t word;
    memcpy(&word, &values[(size_t)particle * (size_t)components + (size_t)k], 4);
    put_word(stream, word);
  }
}

static void put_header(FILE *stream, const SimFrame *frame) {
  char title[256];
  particle_file_title(frame, title);
  fprintf(stream, "ply\nformat binary_little_endian 1.0\ncomment %s\nelement vertex %" PRId32 "\n", title,
          frame->count);
  fputs("property float x\nproperty float y\nproperty float z\nproperty uint id\n", stream);
  if (frame->velocity) fputs("property float vx\nproperty float vy\nproperty float vz\n", stream);
  if (frame->density) fputs("property float density\n", stream);
  if (frame->colour) fputs("property float red\nproperty float green\nproperty float blue\n", stream);
  if (frame->radius) fputs("property float radius\n", stream);
  if (frame->particle_class) fputs("property uchar class\n", stream);
  fputs("end_header\n", stream);
}

void particle_ply_write(FILE *stream, const SimFrame *frame, const uint32_t *order) {
  put_header(stream, frame);
  for (int32_t i = 0; i < frame->count; i++) {
    uint32_t particle = order[i];
    put_floats(stream, frame->position, particle, 3);
    put_word(stream, frame->id[particle]);
    put_floats(stream, frame->velocity, particle, 3);
    put_floats(stream, frame->density, particle, 1);
    put_floats(stream, frame->colour, particle, 3);
    put_floats(stream, frame->radius, particle, 1);
    if (frame->particle_class) fputc(frame->particle_class[particle], stream);
  }
}

// ---- Reading: the header -----------------------------------------------------------------------------------------------------

enum { MAX_PROPERTIES = 256, MAX_ELEMENTS = 64 };

typedef struct PlyProperty {
  ParseType type;       // of the value, or of a list's items
  ParseType count_type; // PARSE_NONE: not a list
  ParticleField field;
  int component;
} PlyProperty;

typedef struct PlyElement {
  bool vertex;
  uint64_t count;
  int first, properties; // in PlyHeader.properties
} PlyElement;

typedef struct PlyHeader {
  int element_count, property_count;
  PlyElement elements[MAX_ELEMENTS];
  PlyProperty properties[MAX_PROPERTIES];
} PlyHeader;

static ParseType read_type(ParticleReader *reader) {
  static const struct {
    const char *name;
    ParseType type;
  } types[] = {
      {"float", PARSE_FLOAT32}, {"float32", PARSE_FLOAT32}, {"double", PARSE_FLOAT64}, {"float64", PARSE_FLOAT64},
      {"char", PARSE_INT8},     {"int8", PARSE_INT8},       {"uchar", PARSE_UINT8},    {"uint8", PARSE_UINT8},
      {"short", PARSE_INT16},   {"int16", PARSE_INT16},     {"ushort", PARSE_UINT16},  {"uint16", PARSE_UINT16},
      {"int", PARSE_INT32},     {"int32", PARSE_INT32},     {"uint", PARSE_UINT32},    {"uint32", PARSE_UINT32},
      {"int64", PARSE_INT64},   {"long", PARSE_INT64},      {"uint64", PARSE_UINT64},  {"ulong", PARSE_UINT64},
  };
  ParseToken token = parse_token_on_line(reader);
  for (size_t i = 0; i < sizeof types / sizeof *types; i++)
    if (parse_is(token, types[i].name)) return types[i].type;
  char text[64];
  parse_fail(reader, token.place, "'%s' is no type of number", parse_text(token, text));
  return PARSE_NONE;
}

// What a property of the vertices means.
static void name_property(PlyProperty *property, ParseToken name) {
  static const struct {
    const char *name;
    ParticleField field;
    int component;
  } names[] = {
      {"x", FIELD_POSITION, 0},  {"y", FIELD_POSITION, 1},   {"z", FIELD_POSITION, 2},
      {"vx", FIELD_VELOCITY, 0}, {"vy", FIELD_VELOCITY, 1},  {"vz", FIELD_VELOCITY, 2},
      {"red", FIELD_COLOUR, 0},  {"green", FIELD_COLOUR, 1}, {"blue", FIELD_COLOUR, 2},
  };
  property->field = parse_field(name, 1);
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    if (!parse_is(name, names[i].name)) continue;
    property->field = names[i].field;
    property->component = names[i].component;
  }
}

static bool read_element(ParticleReader *reader, PlyHeader *header) {
  ParseToken name = parse_token_on_line(reader);
  if (header->element_count == MAX_ELEMENTS)
    return parse_fail(reader, name.place, "there are more than %d elements", MAX_ELEMENTS);
  PlyElement *element = &header->elements[header->element_count++];
  *element = (PlyElement){.vertex = parse_is(name, "vertex"), .first = header->property_count};
  return parse_count(reader, "element", element->vertex ? SIM_MAX_SET_PARTICLES : UINT64_MAX / 2, &element->count);
}

static bool read_property(ParticleReader *reader, PlyHeader *header) {
  size_t place = reader->at;
  if (header->element_count == 0) return parse_fail(reader, place, "a property before the first element");
  if (header->property_count == MAX_PROPERTIES)
    return parse_fail(reader, place, "there are more than %d properties", MAX_PROPERTIES);
  PlyElement *element = &header->elements[header->element_count - 1];
  PlyProperty *property = &header->properties[header->property_count++];
  *property = (PlyProperty){0};
  element->properties++;

  if (parse_is(parse_token_on_line(reader), "list")) {
    property->count_type = read_type(reader);
    if (!property->count_type) return false;
    if (property->count_type == PARSE_FLOAT32 || property->count_type == PARSE_FLOAT64)
      return parse_fail(reader, place, "the length of a list must be a whole number");
  } else {
    reader->at = place;
  }
  property->type = read_type(reader);
  if (!property->type) return false;
  ParseToken name = parse_token_on_line(reader);
  if (name.length == 0) return parse_fail(reader, place, "a property has no name");
  if (element->vertex && !property->count_type) name_property(property, name);
  return true;
}

static bool read_format(ParticleReader *reader) {
  ParseToken token = parse_token_on_line(reader);
  reader->binary = !parse_is(token, "ascii");
  reader->big_endian = parse_is(token, "binary_big_endian");
  if (!reader->binary || reader->big_endian || parse_is(token, "binary_little_endian")) return true;
  char text[64];
  return parse_fail(reader, token.place, "format must be ascii, binary_little_endian or binary_big_endian, not '%s'",
                    parse_text(token, text));
}

static bool read_header(ParticleReader *reader, ParticleFile *file, PlyHeader *header) {
  bool has_format = false;
  parse_line(reader); // "ply"
  for (;;) {
    ParseToken keyword = parse_token(reader);
    bool fine = true;
    if (parse_is(keyword, "end_header")) break;
    if (parse_is(keyword, "format"))
      fine = has_format = read_format(reader);
    else if (parse_is(keyword, "element"))
      fine = read_element(reader, header);
    else if (parse_is(keyword, "property"))
      fine = read_property(reader, header);
    else if (parse_is(keyword, "comment")) {
      if (parse_has(reader, 1) && reader->data[reader->at] == ' ') reader->at++;
      ParseToken comment = parse_line(reader);
      parse_title(file, comment);
      continue;
    } else if (!parse_is(keyword, "obj_info")) {
      char text[64];
      return keyword.length == 0
                 ? parse_fail(reader, keyword.place, "the file ends in the header")
                 : parse_fail(reader, keyword.place, "'%s' is no keyword of a PLY header", parse_text(keyword, text));
    }
    if (!fine) return false;
    parse_line(reader);
  }
  parse_line(reader);
  return has_format || parse_fail(reader, reader->at, "the header has no format");
}

// ---- Reading: the rows -------------------------------------------------------------------------------------------------------

static bool read_value(ParticleReader *reader, ParseType type, double *value) {
  if (!reader->binary) return parse_number(reader, "element", value);
  size_t size = parse_type_size(type);
  if (!parse_has(reader, size)) return parse_fail(reader, reader->at, "the file is cut short here");
  *value = parse_binary(reader->data + reader->at, type, reader->big_endian);
  reader->at += size;
  return true;
}

static bool skip_list(ParticleReader *reader, const PlyProperty *property) {
  size_t place = reader->at;
  double length;
  if (!read_value(reader, property->count_type, &length)) return false;
  if (!(length >= 0 && length <= 1e15)) return parse_fail(reader, place, "a list cannot have %g items", length);
  uint64_t count = (uint64_t)length;
  if (!parse_check_room(reader, "list", count, parse_type_size(property->type))) return false;
  if (reader->binary) {
    reader->at += (size_t)count * parse_type_size(property->type);
    return true;
  }
  double value;
  for (uint64_t i = 0; i < count; i++)
    if (!parse_number(reader, "list", &value)) return false;
  return true;
}

static bool read_rows(ParticleReader *reader, ParticleFile *file, const PlyElement *element,
                      const PlyProperty *properties) {
  if (element->properties == 0) return true; // any number of nothing
  for (uint64_t row = 0; row < element->count; row++) {
    for (int i = 0; i < element->properties; i++) {
      const PlyProperty *property = &properties[i];
      if (property->count_type) {
        if (!skip_list(reader, property)) return false;
        continue;
      }
      size_t place = reader->at;
      double value;
      if (!read_value(reader, property->type, &value)) return false;
      if (!reader->binary) place = reader->at;
      if (property->field &&
          !parse_store(reader, file, property->field, row, property->component, value, property->type, place))
        return false;
    }
  }
  return true;
}

// The fewest bytes (characters, when ASCII) that a row can take.
static size_t smallest_row(const ParticleReader *reader, const PlyElement *element, const PlyProperty *properties) {
  size_t size = 0;
  for (int i = 0; i < element->properties; i++) {
    ParseType type = properties[i].count_type ? properties[i].count_type : properties[i].type;
    size += reader->binary ? parse_type_size(type) : 2;
  }
  return size;
}

// Keep only the fields of which every component is there, and take memory for them.
static bool begin_vertices(ParticleReader *reader, ParticleFile *file, const PlyElement *element,
                           PlyProperty *properties) {
  unsigned components[FIELD_ID + 1] = {0};
  for (int i = 0; i < element->properties; i++)
    if (properties[i].field) components[properties[i].field] |= 1u << properties[i].component;
  if (components[FIELD_POSITION] != 7) return parse_fail(reader, reader->at, "the vertices have no x, y and z");
  for (int i = 0; i < element->properties; i++) {
    ParticleField field = properties[i].field;
    bool vector = field == FIELD_POSITION || field == FIELD_VELOCITY || field == FIELD_COLOUR;
    if (field && components[field] != (vector ? 7 : 1)) properties[i].field = FIELD_NONE;
    if (properties[i].field && !parse_begin_field(reader, file, field)) return false;
  }
  return true;
}

bool particle_ply_read(ParticleReader *reader, ParticleFile *file) {
  PlyHeader header = {0};
  if (!read_header(reader, file, &header)) return false;
  for (int i = 0; i < header.element_count; i++) {
    const PlyElement *element = &header.elements[i];
    PlyProperty *properties = header.properties + element->first;
    if (element->vertex) file->count = (int32_t)element->count;
    // Room for the rows is checked before memory is taken for them.
    size_t row = smallest_row(reader, element, properties);
    size_t left = reader->size - reader->at + (reader->binary ? 0 : 1);
    if (row > 0 && element->count > left / row)
      return parse_fail(reader, reader->at, "%" PRIu64 " rows were announced, but the file has room for %zu",
                        element->count, left / row);
    if (element->vertex && !begin_vertices(reader, file, element, properties)) return false;
    reader->by_byte = reader->binary;
    if (!read_rows(reader, file, element, properties)) return false;
    if (element->vertex) return true; // what follows (faces …) means nothing here
  }
  return parse_fail(reader, reader->at, "the file has no vertices");
}
