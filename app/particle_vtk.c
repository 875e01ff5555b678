// Legacy VTK files.
// Format: "VTK File Formats", in: The VTK User's Guide, Kitware (legacy part); cells as offsets and connectivity since
// version 5.1.
#include <inttypes.h>
#include <string.h>

#include "app/particle_parse.h"

// ---- Writing ---------------------------------------------------------------------------------------------------------------

static void put_word(FILE *stream, uint32_t word) {
  uint8_t bytes[4] = {(uint8_t)(word >> 24), (uint8_t)(word >> 16), (uint8_t)(word >> 8), (uint8_t)word};
  fwrite(bytes, 1, 4, stream);
}

static void put_floats(FILE *stream, const float *values, int components, const uint32_t *order, int32_t count) {
  for (int32_t i = 0; i < count; i++) {
    for (int k = 0; k < components; k++) {
      uint32_t word;
      memcpy(&word, &values[(size_t)order[i] * (size_t)components + (size_t)k], 4);
      put_word(stream, word);
    }
  }
  fputc('\n', stream);
}

static void put_float_field(FILE *stream, const char *name, const float *values, int components, const uint32_t *order,
                            int32_t count) {
  if (!values) return;
  fprintf(stream, "%s %d %" PRId32 " float\n", name, components, count);
  put_floats(stream, values, components, order, count);
}

static void put_cells(FILE *stream, int32_t count) {
  fprintf(stream, "CELLS %" PRId32 " %" PRId64 "\n", count, 2 * (int64_t)count);
  for (int32_t i = 0; i < count; i++) {
    put_word(stream, 1);
    put_word(stream, (uint32_t)i);
  }
  fprintf(stream, "\nCELL_TYPES %" PRId32 "\n", count);
  for (int32_t i = 0; i < count; i++) put_word(stream, 1); // VTK_VERTEX
  fputc('\n', stream);
}

void particle_vtk_write(FILE *stream, const SimFrame *frame, const uint32_t *order) {
  char title[256];
  particle_file_title(frame, title);
  int32_t count = frame->count;
  fprintf(stream, "# vtk DataFile Version 4.2\n%s\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS %" PRId32 " float\n",
          title, count);
  put_floats(stream, frame->position, 3, order, count);
  put_cells(stream, count);

  int fields = 1 + !!frame->velocity + !!frame->density + !!frame->colour + !!frame->radius + !!frame->particle_class;
  fprintf(stream, "POINT_DATA %" PRId32 "\nFIELD FieldData %d\nid 1 %" PRId32 " unsigned_int\n", count, fields, count);
  for (int32_t i = 0; i < count; i++) put_word(stream, frame->id[order[i]]);
  fputc('\n', stream);
  put_float_field(stream, "velocity", frame->velocity, 3, order, count);
  put_float_field(stream, "density", frame->density, 1, order, count);
  put_float_field(stream, "colour", frame->colour, 3, order, count);
  put_float_field(stream, "radius", frame->radius, 1, order, count);
  if (frame->particle_class) {
    fprintf(stream, "class 1 %" PRId32 " unsigned_char\n", count);
    for (int32_t i = 0; i < count; i++) fputc(frame->particle_class[order[i]], stream);
    fputc('\n', stream);
  }
}

// ---- Reading: one array ------------------------------------------------------------------------------------------------------

enum { TYPE_BIT = 100, TYPE_STRING }; // what a type name can be besides a ParseType

static int read_type(ParticleReader *reader) {
  static const struct {
    const char *name;
    int type;
  } types[] = {
      {"float", PARSE_FLOAT32},
      {"double", PARSE_FLOAT64},
      {"int", PARSE_INT32},
      {"unsigned_int", PARSE_UINT32},
      {"char", PARSE_INT8},
      {"signed_char", PARSE_INT8},
      {"unsigned_char", PARSE_UINT8},
      {"short", PARSE_INT16},
      {"unsigned_short", PARSE_UINT16},
      {"long", PARSE_INT64},
      {"unsigned_long", PARSE_UINT64},
      {"vtkidtype", PARSE_INT32},
      {"vtktypeint64", PARSE_INT64},
      {"vtktypeuint64", PARSE_UINT64},
      {"vtktypeint32", PARSE_INT32},
      {"vtktypeuint32", PARSE_UINT32},
      {"vtktypeint16", PARSE_INT16},
      {"vtktypeuint16", PARSE_UINT16},
      {"vtktypeint8", PARSE_INT8},
      {"vtktypeuint8", PARSE_UINT8},
      {"vtktypefloat32", PARSE_FLOAT32},
      {"bit", TYPE_BIT},
      {"vtktypefloat64", PARSE_FLOAT64},
      {"string", TYPE_STRING},
  };
  ParseToken token = parse_token_on_line(reader);
  for (size_t i = 0; i < sizeof types / sizeof *types; i++)
    if (parse_is(token, types[i].name)) return types[i].type;
  char text[64];
  parse_fail(reader, token.place, "'%s' is no type of number", parse_text(token, text));
  return PARSE_NONE;
}

// An array as its header announces it, about to be read.
typedef struct VtkArray {
  const char *what;    // for messages
  ParticleField field; // FIELD_NONE: skip it
  uint64_t tuples, components;
  int type;
} VtkArray;

// Strings have no fixed length: ASCII ones take a line each, binary ones begin with theirs, whose own length is told by
// the first two bits.
static bool skip_strings(ParticleReader *reader, uint64_t count) {
  for (uint64_t i = 0; i < count; i++) {
    if (!parse_has(reader, 1)) return parse_fail(reader, reader->at, "the file ends in an array of strings");
    if (!reader->binary) {
      parse_line(reader);
      continue;
    }
    size_t bytes = (size_t)1 << (3 - (reader->data[reader->at] >> 6));
    if (!parse_has(reader, bytes)) return parse_fail(reader, reader->at, "the file ends in an array of strings");
    uint64_t length = reader->data[reader->at] & 0x3f;
    for (size_t k = 1; k < bytes; k++) length = length << 8 | reader->data[reader->at + k];
    reader->at += bytes;
    if (length > reader->size - reader->at)
      return parse_fail(reader, reader->at, "the file ends in an array of strings");
    reader->at += (size_t)length;
  }
  return true;
}

static bool read_values(ParticleReader *reader, ParticleFile *file, const VtkArray *array) {
  ParseType type = (ParseType)array->type;
  size_t size = parse_type_size(type);
  for (uint64_t i = 0; i < array->tuples; i++) {
    for (uint64_t k = 0; k < array->components; k++) {
      size_t place = reader->at;
      double value;
      if (reader->binary) {
        if (!parse_has(reader, size)) return parse_fail(reader, place, "the file is cut short here");
        value = parse_binary(reader->data + place, type, true);
        reader->at += size;
      } else {
        if (!parse_number(reader, array->what, &value)) return false;
        place = reader->at;
      }
      if (array->field && k < 3 && !parse_store(reader, file, array->field, i, (int)k, value, type, place))
        return false;
    }
  }
  return true;
}

// Read or skip the numbers of an array; the cursor stands behind its header.
static bool read_array(ParticleReader *reader, ParticleFile *file, const VtkArray *array) {
  if (reader->binary) {
    parse_line(reader);
    reader->by_byte = true;
  } else if (array->type == TYPE_STRING) {
    parse_line(reader);
  }
  if (array->components != 0 && array->tuples > UINT64_MAX / array->components)
    return parse_fail(reader, reader->at, "%s: there are too many values", array->what);
  uint64_t count = array->tuples * array->components;
  if (array->type == TYPE_STRING) return skip_strings(reader, count);
  VtkArray plain = *array;
  if (array->type == TYPE_BIT) {
    // Eight to a byte when binary; a bit is never one of our fields.
    plain.field = FIELD_NONE;
    plain.type = PARSE_UINT8;
    if (reader->binary) count = count / 8 + (count % 8 != 0);
  }
  size_t size = parse_type_size((ParseType)plain.type);
  if (!parse_check_room(reader, array->what, count, size)) return false;
  if (plain.field && !parse_begin_field(reader, file, plain.field)) return false;
  if (count == 0) return true; // the other factor may be anything
  if (plain.field || !reader->binary) return read_values(reader, file, &plain);
  reader->at += (size_t)count * size;
  return true;
}

// ---- Reading: sections -------------------------------------------------------------------------------------------------------

// Which part of the file we are in: arrays of points mean something, those of cells and of the whole set do not.
typedef struct VtkState {
  bool has_points, in_point_data;
  uint64_t tuples;  // of the arrays that follow
  int major, minor; // version of the file
} VtkState;

static ParticleField field_here(const ParticleFile *file, const VtkState *state, ParseToken name, uint64_t tuples,
                                uint64_t components) {
  bool ours = state->in_point_data && tuples == (uint64_t)file->count;
  return ours ? parse_field(name, components) : FIELD_NONE;
}

static bool read_points(ParticleReader *reader, ParticleFile *file, VtkState *state) {
  size_t place = reader->at;
  uint64_t count;
  if (state->has_points) return parse_fail(reader, place, "POINTS is there twice");
  if (!parse_count(reader, "POINTS", SIM_MAX_SET_PARTICLES, &count)) return false;
  VtkArray array = {"POINTS", FIELD_POSITION, count, 3, read_type(reader)};
  if (!array.type) return false;
  if (array.type == TYPE_BIT || array.type == TYPE_STRING)
    return parse_fail(reader, place, "POINTS must be numbers, not bits or strings");
  file->count = (int32_t)count;
  state->has_points = true;
  return read_array(reader, file, &array);
}

// Cells of every kind are skipped: up to 5.0 one block of numbers, from 5.1 on two arrays.
static bool skip_cells(ParticleReader *reader, ParticleFile *file, const VtkState *state) {
  uint64_t first, second;
  if (!parse_count(reader, "cells", UINT64_MAX / 2, &first) || !parse_count(reader, "cells", UINT64_MAX / 2, &second))
    return false;
  if (state->major < 5 || (state->major == 5 && state->minor < 1))
    return read_array(reader, file, &(VtkArray){"cells", FIELD_NONE, second, 1, PARSE_INT32});
  const char *const names[2] = {"offsets", "connectivity"};
  uint64_t counts[2] = {first, second};
  for (int i = 0; i < 2; i++) {
    ParseToken token = parse_token(reader);
    char text[64];
    if (!parse_is(token, names[i]))
      return parse_fail(reader, token.place, "cells: '%s' was expected, not '%s'", i == 0 ? "OFFSETS" : "CONNECTIVITY",
                        parse_text(token, text));
    VtkArray array = {"cells", FIELD_NONE, counts[i], 1, read_type(reader)};
    if (!array.type || !read_array(reader, file, &array)) return false;
  }
  return true;
}

static bool skip_cell_types(ParticleReader *reader, ParticleFile *file) {
  uint64_t count;
  if (!parse_count(reader, "CELL_TYPES", UINT64_MAX / 2, &count)) return false;
  return read_array(reader, file, &(VtkArray){"CELL_TYPES", FIELD_NONE, count, 1, PARSE_INT32});
}

// METADATA is text that ends with an empty line.
static bool skip_metadata(ParticleReader *reader) {
  parse_line(reader);
  while (parse_has(reader, 1) && parse_line(reader).length > 0) continue;
  return true;
}

// FIELD name n, then n arrays "name components tuples type".
static bool read_field_arrays(ParticleReader *reader, ParticleFile *file, const VtkState *state) {
  parse_token_on_line(reader);
  uint64_t arrays;
  if (!parse_count(reader, "FIELD", UINT64_MAX / 2, &arrays)) return false;
  for (uint64_t i = 0; i < arrays; i++) {
    ParseToken name = parse_token(reader);
    if (name.length == 0)
      return parse_fail(reader, name.place,
                        "FIELD: %" PRIu64 " arrays were announced, but the file ends after %" PRIu64, arrays, i);
    if (parse_is(name, "null_array")) continue;
    if (parse_is(name, "metadata")) {
      skip_metadata(reader);
      i--;
      continue;
    }
    char text[64];
    parse_text(name, text);
    VtkArray array = {.what = text};
    if (!parse_count(reader, text, UINT64_MAX / 2, &array.components) ||
        !parse_count(reader, text, UINT64_MAX / 2, &array.tuples) || !(array.type = read_type(reader)))
      return false;
    if (state->in_point_data && array.tuples != state->tuples)
      return parse_fail(reader, name.place, "%s: %" PRIu64 " values for %" PRIu64 " points", text, array.tuples,
                        state->tuples);
    array.field = field_here(file, state, name, array.tuples, array.components);
    if (!read_array(reader, file, &array)) return false;
  }
  return true;
}

// SCALARS name type [components], then perhaps LOOKUP_TABLE name.
static bool read_scalars(ParticleReader *reader, ParticleFile *file, const VtkState *state) {
  ParseToken name = parse_token_on_line(reader);
  VtkArray array = {"SCALARS", FIELD_NONE, state->tuples, 1, read_type(reader)};
  if (!array.type) return false;
  size_t before = reader->at;
  if (parse_token_on_line(reader).length > 0) {
    reader->at = before;
    if (!parse_count(reader, "SCALARS", 4, &array.components)) return false;
  }
  before = reader->at;
  if (parse_is(parse_token(reader), "lookup_table"))
    parse_token_on_line(reader);
  else
    reader->at = before;
  array.field = field_here(file, state, name, array.tuples, array.components);
  return read_array(reader, file, &array);
}

// COLOR_SCALARS name components: bytes when binary, floats in [0, 1] when ASCII.
static bool read_colour_scalars(ParticleReader *reader, ParticleFile *file, const VtkState *state) {
  parse_token_on_line(reader);
  VtkArray array = {"COLOR_SCALARS", FIELD_NONE, state->tuples, 0, reader->binary ? PARSE_UINT8 : PARSE_FLOAT32};
  if (!parse_count(reader, "COLOR_SCALARS", 4, &array.components)) return false;
  if (state->in_point_data && array.tuples == (uint64_t)file->count && array.components >= 3)
    array.field = FIELD_COLOUR;
  return read_array(reader, file, &array);
}

// LOOKUP_TABLE name size: four components a row.
static bool skip_lookup_table(ParticleReader *reader, ParticleFile *file) {
  parse_token_on_line(reader);
  VtkArray array = {"LOOKUP_TABLE", FIELD_NONE, 0, 4, reader->binary ? PARSE_UINT8 : PARSE_FLOAT32};
  return parse_count(reader, "LOOKUP_TABLE", UINT64_MAX / 4, &array.tuples) && read_array(reader, file, &array);
}

// VECTORS name type, and its likes of a fixed number of components; TEXTURE_COORDINATES has it between the two.
static bool read_vectors(ParticleReader *reader, ParticleFile *file, const VtkState *state, uint64_t components) {
  ParseToken name = parse_token_on_line(reader);
  if (components == 0 && !parse_count(reader, "TEXTURE_COORDINATES", 3, &components)) return false;
  VtkArray array = {"VECTORS", FIELD_NONE, state->tuples, components, read_type(reader)};
  if (!array.type) return false;
  array.field = field_here(file, state, name, array.tuples, array.components);
  return read_array(reader, file, &array);
}

static bool begin_attributes(ParticleReader *reader, const ParticleFile *file, VtkState *state, bool of_points) {
  size_t place = reader->at;
  if (!parse_count(reader, of_points ? "POINT_DATA" : "CELL_DATA", UINT64_MAX / 16, &state->tuples)) return false;
  state->in_point_data = of_points;
  if (of_points && (!state->has_points || state->tuples != (uint64_t)file->count))
    return parse_fail(reader, place, "POINT_DATA: %" PRIu64 " values for %" PRId32 " points", state->tuples,
                      file->count);
  return true;
}

static bool read_section(ParticleReader *reader, ParticleFile *file, VtkState *state, ParseToken keyword) {
  static const struct {
    const char *name;
    uint64_t components;
  } vectors[] = {{"vectors", 3},  {"normals", 3},    {"texture_coordinates", 0}, {"tensors", 9},
                 {"tensors6", 6}, {"global_ids", 1}, {"pedigree_ids", 1},        {"edge_flags", 1}};
  static const char *const cells[] = {"cells", "vertices", "lines", "polygons", "triangle_strips"};
  for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++)
    if (parse_is(keyword, vectors[i].name)) return read_vectors(reader, file, state, vectors[i].components);
  for (size_t i = 0; i < sizeof cells / sizeof *cells; i++)
    if (parse_is(keyword, cells[i])) return skip_cells(reader, file, state);
  if (parse_is(keyword, "points")) return read_points(reader, file, state);
  if (parse_is(keyword, "cell_types")) return skip_cell_types(reader, file);
  if (parse_is(keyword, "point_data")) return begin_attributes(reader, file, state, true);
  if (parse_is(keyword, "cell_data")) return begin_attributes(reader, file, state, false);
  if (parse_is(keyword, "field")) return read_field_arrays(reader, file, state);
  if (parse_is(keyword, "scalars")) return read_scalars(reader, file, state);
  if (parse_is(keyword, "color_scalars")) return read_colour_scalars(reader, file, state);
  if (parse_is(keyword, "lookup_table")) return skip_lookup_table(reader, file);
  if (parse_is(keyword, "metadata")) return skip_metadata(reader);
  char text[64];
  return parse_fail(reader, keyword.place, "'%s' is no section of a VTK file that is known here",
                    parse_text(keyword, text));
}

// The three lines at the top and the kind of data set.
static bool read_header(ParticleReader *reader, ParticleFile *file, VtkState *state) {
  ParseToken version = parse_line(reader);
  char text[64];
  snprintf(text, sizeof text, "%.*s", version.length > 60 ? 60 : (int)version.length, version.text);
  if (sscanf(text, "# vtk DataFile Version %3d.%3d", &state->major, &state->minor) != 2 || state->major < 1 ||
      state->major > 5)
    return parse_fail(reader, 0, "'# vtk DataFile Version' 1.0 to 5.x was expected");
  parse_title(file, parse_line(reader));

  ParseToken token = parse_token(reader);
  reader->binary = parse_is(token, "binary");
  reader->big_endian = true;
  if (!reader->binary && !parse_is(token, "ascii"))
    return parse_fail(reader, token.place, "ASCII or BINARY was expected, not '%s'", parse_text(token, text));
  token = parse_token(reader);
  if (!parse_is(token, "dataset"))
    return parse_fail(reader, token.place, "DATASET was expected, not '%s'", parse_text(token, text));
  token = parse_token_on_line(reader);
  if (parse_is(token, "unstructured_grid") || parse_is(token, "polydata")) return true;
  return parse_fail(reader, token.place, "DATASET must be UNSTRUCTURED_GRID or POLYDATA, not '%s'",
                    parse_text(token, text));
}

bool particle_vtk_read(ParticleReader *reader, ParticleFile *file) {
  VtkState state = {0};
  if (!read_header(reader, file, &state)) return false;
  for (;;) {
    ParseToken keyword = parse_token(reader);
    if (keyword.length == 0) break;
    if (!read_section(reader, file, &state, keyword)) return false;
  }
  return state.has_points || parse_fail(reader, reader->size, "the file has no POINTS");
}
