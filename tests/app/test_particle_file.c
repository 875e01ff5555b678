// Particle files: what is written is read back equal to the bit, files of other programs are understood, and whatever
// else a file holds, the answer is one line that names the place and the cause.
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "app/particle_file.h"
#include "run_lido.h"

enum { MOST = 300 };

static char folder[256];

static int set_up(void **state) {
  (void)state;
  folder_make(folder);
  return 0;
}

static int tear_down(void **state) {
  (void)state;
  folder_remove(folder);
  return 0;
}

// A frame made by hand, its particles in an order that is not that of their ids.
typedef struct Water {
  SimFrame frame;
  uint32_t id[MOST];
  float position[3 * MOST], velocity[3 * MOST], density[MOST], colour[3 * MOST], radius[MOST];
  uint8_t particle_class[MOST];
} Water;

static uint32_t random_state = 1;
static uint32_t random_bits(void) {
  random_state ^= random_state << 13;
  random_state ^= random_state >> 17;
  random_state ^= random_state << 5;
  return random_state;
}
static float random_float(void) {
  return (float)(random_bits() >> 8) / 16777216.0f;
}

static void make_water(Water *water, int count, bool everything) {
  memset(water, 0, sizeof *water);
  for (int i = 0; i < count; i++) {
    water->id[i] = (uint32_t)(i * 7919 % (count | 1)) + (i == count / 2 ? 4000000000u : 0);
    water->density[i] = 990 + random_float();
    water->radius[i] = 0.01f + random_float();
    water->particle_class[i] = random_bits() & 1;
    for (int k = 0; k < 3; k++) {
      water->position[3 * i + k] = random_float() * 3 - 1;
      water->velocity[3 * i + k] = (random_float() - 0.5f) * 1e-20f;
      water->colour[3 * i + k] = random_float();
    }
  }
  water->frame = (SimFrame){.index = 42,
                            .time = 0.1 + 0.2,
                            .count = count,
                            .particle_radius = 0.0175f,
                            .id = water->id,
                            .position = water->position,
                            .velocity = water->velocity,
                            .density = water->density,
                            .colour = everything ? water->colour : NULL,
                            .radius = everything ? water->radius : NULL,
                            .particle_class = everything ? water->particle_class : NULL,
                            .container = {{-1, 0, 0.1f}, {2, 3, 4}},
                            .has_container = everything};
}

static void read_good(const char *path, ParticleFile *file) {
  AppError error;
  if (!particle_file_read(path, file, &error)) fail_msg("%s", error.message);
}

static void check_same(const void *a, const void *b, size_t size) {
  if (size) assert_memory_equal(a, b, size);
}

static void check_round_trip(const char *name, int count, bool everything) {
  Water *water = malloc(sizeof *water);
  make_water(water, count, everything);
  AppError error;
  const char *path = in(folder, name);
  assert_true(particle_file_write(path, &water->frame, &error));
  assert_int_equal(folder_count(folder), 1);
  ParticleFile file;
  read_good(path, &file);
  assert_int_equal(file.count, count);
  assert_true(file.time == water->frame.time);
  assert_true(file.particle_radius == water->frame.particle_radius);
  assert_int_equal(file.index, 42);
  assert_int_equal(file.has_container, everything);
  if (everything) assert_memory_equal(&file.container, &water->frame.container, sizeof file.container);
  assert_int_equal(file.colour != NULL, everything);
  assert_int_equal(file.radius != NULL, everything);
  assert_int_equal(file.particle_class != NULL, everything);
  for (int k = 0; k < count; k++) {
    // In the order of ids: find the particle in the frame.
    assert_true(k == 0 || file.id[k - 1] < file.id[k]);
    int i = 0;
    while (water->id[i] != file.id[k]) i++;
    check_same(&file.position[3 * k], &water->position[3 * i], 12);
    check_same(&file.velocity[3 * k], &water->velocity[3 * i], 12);
    check_same(&file.density[k], &water->density[i], 4);
    if (!everything) continue;
    check_same(&file.colour[3 * k], &water->colour[3 * i], 12);
    check_same(&file.radius[k], &water->radius[i], 4);
    assert_int_equal(file.particle_class[k], water->particle_class[i]);
  }
  particle_file_free(&file);
  remove(path);
  free(water);
}

static void test_round_trip(void **state) {
  (void)state;
  static const int counts[] = {0, 1, 2, MOST - 1};
  for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
    check_round_trip("p.vtk", counts[i], true);
    check_round_trip("p.ply", counts[i], true);
    check_round_trip("p.vtk", counts[i], false);
    check_round_trip("p.ply", counts[i], false);
  }
}

// The exact bytes of the smallest file, so that what other programs read cannot change unnoticed.
static void test_vtk_bytes(void **state) {
  (void)state;
  Water *water = malloc(sizeof *water);
  make_water(water, 1, false);
  water->id[0] = 258;
  water->position[0] = 1;
  water->position[1] = 2;
  water->position[2] = -1;
  water->frame.velocity = NULL;
  water->frame.density = NULL;
  water->frame.time = 0.5;
  AppError error;
  assert_true(particle_file_write(in(folder, "p.vtk"), &water->frame, &error));
  static const char expected[] =
      "# vtk DataFile Version 4.2\n"
      "Lido " SIM_VERSION_STRING " time=0.5 frame=42 particle_radius=0.0175000001\n"
      "BINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 1 float\n"
      "\x3f\x80\0\0\x40\0\0\0\xbf\x80\0\0\nCELLS 1 2\n\0\0\0\1\0\0\0\0\nCELL_TYPES 1\n\0\0\0\1\n"
      "POINT_DATA 1\nFIELD FieldData 1\nid 1 1 unsigned_int\n\0\0\1\2\n";
  size_t size;
  uint8_t *bytes = file_get(in(folder, "p.vtk"), &size);
  assert_int_equal(size, sizeof expected - 1);
  assert_memory_equal(bytes, expected, size);
  free(bytes);
  free(water);
}

// ---- Files of other programs -------------------------------------------------------------------------------------------------

// Read a file from tests/app/particles.
static void read_fixture(const char *name, ParticleFile *file) {
  read_good(in("tests/app/particles", name), file);
}

// Every fixture holds the same three particles.
static void check_three(const ParticleFile *file) {
  static const float position[9] = {0, 0, 0, 0.5f, 0.25f, -1, 2, 0, 1e-3f};
  assert_int_equal(file->count, 3);
  for (int i = 0; i < 9; i++) assert_float_equal(file->position[i], position[i], 1e-7);
  assert_float_equal(file->particle_radius, 0, 0);
  assert_false(file->has_container);
}

static void test_foreign_vtk(void **state) {
  (void)state;
  static const char *const names[] = {"ascii_2.0.vtk",     "ascii_polydata.vtk",   "ascii_5.1.vtk", "binary_5.1.vtk",
                                      "binary_double.vtk", "ascii_attributes.vtk", "ascii_crlf.vtk"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    ParticleFile file;
    read_fixture(names[i], &file);
    check_three(&file);
    particle_file_free(&file);
  }
}

static void test_foreign_attributes(void **state) {
  (void)state;
  ParticleFile file;
  read_fixture("ascii_attributes.vtk", &file);
  assert_non_null(file.velocity);
  assert_float_equal(file.velocity[5], -3, 0);
  assert_non_null(file.colour); // COLOR_SCALARS
  assert_float_equal(file.colour[3], 0.5, 1e-7);
  assert_non_null(file.radius);
  assert_float_equal(file.radius[2], 0.03, 1e-7);
  assert_null(file.id);             // one is there twice: it means something else
  assert_null(file.particle_class); // 7 is no class of ours
  particle_file_free(&file);

  read_fixture("binary_double.vtk", &file); // double positions, long ids, bytes for a class, skipped strings and bits
  assert_non_null(file.id);
  assert_int_equal(file.id[2], 30);
  assert_non_null(file.particle_class);
  assert_int_equal(file.particle_class[1], 1);
  particle_file_free(&file);
}

static void test_foreign_ply(void **state) {
  (void)state;
  static const char *const names[] = {"ascii.ply", "big_endian.ply", "faces_first.ply"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    ParticleFile file;
    read_fixture(names[i], &file);
    check_three(&file);
    particle_file_free(&file);
  }
  ParticleFile file;
  read_fixture("big_endian.ply", &file); // colours of bytes are sRGB
  assert_non_null(file.colour);
  assert_float_equal(file.colour[0], 1, 1e-6);
  assert_float_equal(file.colour[1], 0.21586, 1e-5); // 128
  assert_null(file.velocity);                        // vx alone is no velocity
  particle_file_free(&file);
}

// ---- Malformed files -----------------------------------------------------------------------------------------------------------

#define VTK "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\n"
#define VTKB "# vtk DataFile Version 3.0\ntitle\nBINARY\nDATASET UNSTRUCTURED_GRID\n"
#define ONE VTK "POINTS 1 float\n0 0 0\n"
#define PLY "ply\nformat ascii 1.0\n"
#define XYZ "property float x\nproperty float y\nproperty float z\n"

static const struct {
  const char *text, *cause;
} malformed[] = {
    {"", "the file is empty"},
    {"hello", "line 1: neither a legacy VTK file"},
    {"<?xml version=\"1.0\"?><VTKFile>", "VTK files in XML are not read"},
    {"# vtk DataFile", "'# vtk DataFile Version' 1.0 to 5.x was expected"},
    {"# vtk DataFile Version 9.9\nt\nASCII\n", "1.0 to 5.x was expected"},
    {"# vtk DataFile Version 3.0\nt\nTEXT\n", "line 3: ASCII or BINARY was expected, not 'TEXT'"},
    {"# vtk DataFile Version 3.0\nt\nASCII\nPOINTS 1 float", "line 4: DATASET was expected, not 'POINTS'"},
    {"# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\n", "not 'STRUCTURED_POINTS'"},
    {VTK, "the file has no POINTS"},
    {VTK "POINTS", "line 5: POINTS: the number is missing"},
    {VTK "POINTS -3 float\n", "a whole number from 0 was expected, not '-3'"},
    {VTK "POINTS 1e3 float\n", "a whole number from 0 was expected, not '1e3'"},
    {VTK "POINTS 99999999999 float\n0 0 0", "POINTS: 99999999999 is too many, at most 268435456 can be"},
    {VTK "POINTS 18446744073709551617 float\n0 0 0", "is too many"},
    {VTK "POINTS 16000000 float\n0 0 0", "48000000 values were announced, but the file is too short"},
    {VTKB "POINTS 16000000 float\n0000", "byte 88: POINTS: 48000000 values were announced, but the file ends after 1"},
    {VTK "POINTS 2 quaternion\n0 0 0", "'quaternion' is no type of number"},
    {VTK "POINTS 2 bit\n0 0 0 0 0 0", "POINTS must be numbers"},
    {VTK "POINTS 2 float\n0 0 0\n0 0", "the file is too short"},
    {VTK "POINTS 2 float\n0.000000 0 0\n0 0", "line 7: POINTS: the file ends here"},
    {VTK "POINTS 2 float\n0 0 0\n0 x 0", "line 7: POINTS: a number was expected, not 'x'"},
    {VTK "POINTS 2 float\n0 0 0\n0 nan 0", "line 7: position of particle 1 is not a finite number"},
    {VTK "POINTS 2 float\n0 0 inf\n0 0 0", "line 6: position of particle 0 is not a finite number"},
    {VTK "POINTS 1 float\n0 1e999 0\n", "position of particle 0 is not a finite number"},
    {VTK "POINTS 1 double\n0 1e39 0\n", "position of particle 0 is not a finite number"},
    {VTKB "POINTS 1 float\n\x7f\xff\xff\xff\x7f\xff\xff\xff\x7f\xff\xff\xff", "byte 81: position of particle 0"},
    {ONE "POINTS 1 float\n0 0 0\n", "line 7: POINTS is there twice"},
    {ONE "HEXAHEDRA 3\n", "line 7: 'HEXAHEDRA' is no section"},
    {ONE "POINT_DATA 2\n", "POINT_DATA: 2 values for 1 points"},
    {VTK "POINT_DATA 0\n", "POINT_DATA: 0 values for 0 points"},
    {ONE "POINT_DATA 1\nFIELD f 2\nid 1 1 int\n0\n", "FIELD: 2 arrays were announced, but the file ends after 1"},
    {ONE "POINT_DATA 1\nFIELD f 1\nid 1 5 int\n0 0 0 0 0\n", "id: 5 values for 1 points"},
    {ONE "POINT_DATA 1\nFIELD f 1\nv 9000000000000000000 9000000000000000000 int\n", "values for 1 points"},
    {ONE "FIELD f 1\nv 9000000000000000000 9000000000000000000 int\n", "too many values"},
    {ONE "CELL_DATA 9\nFIELD f 1\nv 0 9000000000000000000 int\nw", "'w' is no section"},
    {ONE "POINT_DATA 1\nFIELD f 1\nradius 1 1 float\n0\n", "radius of particle 0 must be above 0, got 0"},
    {ONE "POINT_DATA 1\nFIELD f 1\nradius 1 1 float\nnan\n", "radius of particle 0 is not a finite number"},
    {ONE "POINT_DATA 1\nVECTORS velocity float\n0 0 nan\n", "velocity of particle 0 is not a finite number"},
    {ONE "POINT_DATA 1\nSCALARS density float 1\nLOOKUP_TABLE default\n", "line 10: SCALARS: the file ends here"},
    {ONE "POINT_DATA 1\nSCALARS density float 9\n", "SCALARS: 9 is too many, at most 4 can be"},
    {ONE "CELLS 3 99999999999\n1 0", "cells: 99999999999 values were announced"},
    {ONE "CELLS -1 2\n1 0", "cells: a whole number"},
    {"# vtk DataFile Version 5.1\nt\nASCII\nDATASET POLYDATA\nVERTICES 2 1\n0 1\n", "cells: 'OFFSETS' was expected"},
    {VTKB "FIELD f 1\nname 1 3 string\n\xc5"
          "abc",
     "the file ends in an array of strings"},
    {"ply\n", "the file ends in the header"},
    {"ply\nformat ascii 1.0\n", "the file ends in the header"},
    {"ply\nformat binary 1.0\n", "line 2: format must be ascii"},
    {"ply\nelement vertex 0\n" XYZ "end_header\n", "the header has no format"},
    {PLY "end_header\n", "the file has no vertices"},
    {PLY "property float x\nend_header\n", "line 3: a property before the first element"},
    {PLY "elephant vertex 3\n", "line 3: 'elephant' is no keyword of a PLY header"},
    {PLY "element vertex\n", "element: the number is missing"},
    {PLY "element vertex -1\n", "element: a whole number from 0 was expected, not '-1'"},
    {PLY "element vertex 99999999999\n" XYZ "end_header\n", "99999999999 is too many"},
    {PLY "element vertex 16000000\n" XYZ "end_header\n0 0 0\n",
     "16000000 rows were announced, but the file has room for"},
    {PLY "element vertex 1\nproperty half x\nend_header\n", "line 4: 'half' is no type of number"},
    {PLY "element vertex 1\nproperty float\nend_header\n", "a property has no name"},
    {PLY "element vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n", "the vertices have no x, y and z"},
    {PLY "element vertex 1\nproperty list float int x\nend_header\n0\n", "the length of a list must be a whole number"},
    {PLY "element vertex 2\n" XYZ "end_header\n0 0 0\n0 0 abc\n", "line 9: element: a number was expected, not 'abc'"},
    {PLY "element vertex 1\n" XYZ "end_header\n0 nan 0\n", "line 8: position of particle 0 is not a finite number"},
    {PLY "element vertex 1\n" XYZ "property float radius\nend_header\n0 0 0 -1\n",
     "radius of particle 0 must be above 0"},
    {PLY "element face 1\nproperty list int int i\nelement vertex 1\n" XYZ "end_header\n-1\n0 0 0\n",
     "a list cannot have -1 items"},
    {PLY "element face 1\nproperty list int int i\nelement vertex 1\n" XYZ "end_header\n2000000000\n0 0 0\n",
     "list: 2000000000 values were announced"},
    {PLY "element face 9000000000000000000\nproperty list int int i\nelement vertex 0\n" XYZ "end_header\n",
     "9000000000000000000 rows were announced"},
};

static void check_refused(const char *path, const char *cause) {
  ParticleFile file;
  AppError error = {.code = APP_OK};
  if (particle_file_read(path, &file, &error)) fail_msg("taken, but expected: %s", cause);
  assert_int_equal(error.code, APP_BAD_INPUT);
  if (strncmp(error.message, path, strlen(path)) != 0 || !strstr(error.message, cause))
    fail_msg("expected '%s: … %s', got '%s'", path, cause, error.message);
  assert_null(file.position);
}

static void test_malformed(void **state) {
  (void)state;
  const char *path = in(folder, "bad");
  for (size_t i = 0; i < sizeof malformed / sizeof *malformed; i++) {
    file_put_text(path, malformed[i].text);
    // Text ends at a 0, bytes that hold one do not matter here: such a file is cut short there.
    check_refused(path, malformed[i].cause);
  }
  check_refused(in(folder, "missing.vtk"), "cannot be read: No such file or directory");
  check_refused(folder, "cannot be read: it is not a regular file");
  check_refused("/dev/zero", "cannot be read: it is not a regular file");
}

// Nothing in a row or a section can be any number of.
static void test_any_number_of_nothing(void **state) {
  (void)state;
  ParticleFile file;
  const char *path = in(folder, "empty");
  file_put_text(path, PLY "element nothing 9000000000000000000\nelement vertex 0\n" XYZ "end_header\n");
  read_good(path, &file);
  assert_int_equal(file.count, 0);
  particle_file_free(&file);
  file_put_text(path, ONE "CELL_DATA 1\nFIELD f 1\nv 0 9000000000000000000 int\n");
  read_good(path, &file);
  assert_int_equal(file.count, 1);
  particle_file_free(&file);
}

// The title comes from outside too: what is not plausible there is not used.
static void test_titles(void **state) {
  (void)state;
  static const char *const titles[] = {"Lido time=nan particle_radius=inf container=1,2",
                                       "Lido time=-1 particle_radius=-1 frame=-5 container=0,0,0,0,0,0",
                                       "Lido time= particle_radius= frame=1e99 container=",
                                       "Lido container=nan,0,0,1,1,1",
                                       "Lido container=0,0,0,1e99,1,1",
                                       "someone else time=3 particle_radius=3"};
  const char *path = in(folder, "title.vtk");
  for (size_t i = 0; i < sizeof titles / sizeof *titles; i++) {
    char text[512];
    snprintf(text, sizeof text, "# vtk DataFile Version 3.0\n%s\nASCII\nDATASET POLYDATA\nPOINTS 0 float\n", titles[i]);
    file_put_text(path, text);
    ParticleFile file;
    read_good(path, &file);
    assert_true(file.time == 0 && file.particle_radius == 0 && file.index == 0);
    assert_false(file.has_container);
    particle_file_free(&file);
  }
}

// ---- Cut short and changed -------------------------------------------------------------------------------------------------------

// What must hold for whatever was read.
static void check_sane(const ParticleFile *file, size_t size) {
  assert_in_range(file->count, 0, size);
  for (int i = 0; i < 3 * file->count; i++) assert_true(fabsf(file->position[i]) <= FLT_MAX);
  for (int i = 0; file->radius && i < file->count; i++) assert_true(file->radius[i] > 0);
  for (int i = 0; file->particle_class && i < file->count; i++) assert_true(file->particle_class[i] <= 1);
  for (int i = 0; file->id && i < file->count; i++)
    for (int k = 0; k < i; k++) assert_true(file->id[i] != file->id[k]);
}

static bool read_bytes(const uint8_t *bytes, size_t size) {
  const char *path = in(folder, "changed");
  file_put(path, bytes, size);
  ParticleFile file;
  AppError error = {.code = APP_OK};
  if (particle_file_read(path, &file, &error)) {
    check_sane(&file, size);
    particle_file_free(&file);
    return true;
  }
  assert_int_equal(error.code, APP_BAD_INPUT);
  assert_true(strncmp(error.message, path, strlen(path)) == 0);
  assert_null(strchr(error.message, '\n'));
  return false;
}

// Valid files to change, in memory.
static size_t samples(uint8_t *bytes[8], size_t sizes[8]) {
  static const char *const names[] = {"ascii_2.0.vtk",        "binary_5.1.vtk", "binary_double.vtk",
                                      "ascii_attributes.vtk", "ascii.ply",      "faces_first.ply"};
  Water *water = malloc(sizeof *water);
  make_water(water, 5, true);
  AppError error;
  size_t count = 0;
  for (; count < 2; count++) {
    const char *path = in(folder, count ? "s.ply" : "s.vtk");
    assert_true(particle_file_write(path, &water->frame, &error));
    bytes[count] = file_get(path, &sizes[count]);
  }
  for (; count < 8; count++) bytes[count] = file_get(in("tests/app/particles", names[count - 2]), &sizes[count]);
  free(water);
  return count;
}

static void test_cut_short(void **state) {
  (void)state;
  uint8_t *bytes[8];
  size_t sizes[8], count = samples(bytes, sizes);
  for (size_t s = 0; s < count; s++) {
    assert_true(read_bytes(bytes[s], sizes[s]));
    size_t taken = 0;
    for (size_t cut = 0; cut < sizes[s]; cut++) taken += read_bytes(bytes[s], cut);
    // A file may end after any section and within an ASCII number; PLY without its last bytes never.
    if (s == 1) assert_int_equal(taken, 0);
    assert_true(taken < sizes[s] / 2);
    free(bytes[s]);
  }
}

// Small fuzz, the same every time: bytes flipped, pieces moved, numbers replaced.
static void mutate(uint8_t *bytes, size_t *size) {
  static const char *const tokens[] = {"-1",          "99999999999999999999", "4294967296", "nan",
                                       "0",           "2147483647",           "\n\n",       "POINTS 3 float\n",
                                       "FIELD f 9\n", "list uchar int",       "string",     "bit"};
  for (uint32_t changes = 1 + random_bits() % 4; changes > 0 && *size > 1; changes--) {
    size_t at = random_bits() % *size;
    size_t length = random_bits() % 24;
    switch (random_bits() % 4) {
    case 0:
      bytes[at] ^= (uint8_t)(1u << random_bits() % 8);
      break;
    case 1:
      bytes[at] = (uint8_t)random_bits();
      break;
    case 2:
      if (at + length > *size) length = *size - at;
      memmove(bytes + at, bytes + at + length, *size - at - length);
      *size -= length;
      break;
    default: {
      const char *token = tokens[random_bits() % (sizeof tokens / sizeof *tokens)];
      length = strlen(token);
      memmove(bytes + at + length, bytes + at, *size - at);
      memcpy(bytes + at, token, length);
      *size += length;
    }
    }
  }
}

static void test_fuzz(void **state) {
  (void)state;
  enum { ROUNDS = 3000 };
  uint8_t *bytes[8], work[8192];
  size_t sizes[8], count = samples(bytes, sizes), taken = 0;
  random_state = 20240229;
  for (size_t s = 0; s < count; s++) {
    for (int round = 0; round < ROUNDS; round++) {
      size_t size = sizes[s];
      assert_true(size + 200 < sizeof work);
      memcpy(work, bytes[s], size);
      mutate(work, &size);
      taken += read_bytes(work, size);
    }
    free(bytes[s]);
  }
  // Both ways must have been gone often, or the changes are too coarse or too fine to test anything.
  assert_in_range(taken, count * ROUNDS / 20, count * ROUNDS * 19 / 20);
}

int main(void) {
  // Tens of thousands of small files: in memory where that is possible.
  if (access("/dev/shm", W_OK) == 0) setenv("TMPDIR", "/dev/shm", 0);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test_setup_teardown(test_round_trip, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_vtk_bytes, set_up, tear_down),
      cmocka_unit_test(test_foreign_vtk),
      cmocka_unit_test(test_foreign_attributes),
      cmocka_unit_test(test_foreign_ply),
      cmocka_unit_test_setup_teardown(test_malformed, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_any_number_of_nothing, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_titles, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_cut_short, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_fuzz, set_up, tear_down),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
