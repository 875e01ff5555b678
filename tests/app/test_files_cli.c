// The real program against files that are wrong and places that cannot be written: one line that names the cause, the
// right exit code, nothing half written. (What is wrong inside a particle file is tested in full in test_particle_file;
// here the same must arrive on the terminal.)
#define _DEFAULT_SOURCE // mount

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "app/particle_file.h"
#include "run_lido.h"
#include "small_scene.h"

static char folder[256];
static char scene[512]; // a small scene in it

static int set_up(void **state) {
  (void)state;
  folder_make(folder);
  snprintf(scene, sizeof scene, "%s/scene.json", folder);
  file_put_text(scene, SMALL_SCENE SMALL_END);
  mkdir(in(folder, "out"), 0777);
  return 0;
}

static int tear_down(void **state) {
  (void)state;
  folder_remove(folder);
  return 0;
}

static void check_nothing_written(void) {
  assert_int_equal(folder_count(in(folder, "out")), 0);
}

// ---- Malformed particle files ------------------------------------------------------------------------------------------------

#define VTK "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\n"
#define PLY "ply\nformat ascii 1.0\n"
#define XYZ "property float x\nproperty float y\nproperty float z\nend_header\n"

static const struct {
  const char *name, *text, *cause;
} malformed[] = {
    {"a.vtk", "", "a.vtk: the file is empty"},
    {"a.vtk", "GIF89a", "a.vtk: line 1: neither a legacy VTK file"},
    {"a.vtk", VTK, "a.vtk: line 5: the file has no POINTS"},
    {"a.vtk", VTK "POINTS 99999999999999999999999 float\n", "is too many"},
    {"a.vtk", VTK "POINTS 268435456 double\n1 2 3\n", "the file is too short"},
    {"a.vtk", VTK "POINTS -1 float\n", "a whole number from 0 was expected, not '-1'"},
    {"a.vtk", VTK "POINTS 2 float\n0 0 0 0 nan 0\n", "a.vtk: line 6: position of particle 1 is not a finite number"},
    {"a.vtk", VTK "POINTS 1 float\n1e99 0 0\n", "position of particle 0 is not a finite number"},
    {"a.vtk", VTK "POINTS 1 float\n1e9 0 0\n", "the particles reach to 1e+09 m"},
    {"a.vtk", VTK "POINTS two float\n", "not 'two'"},
    {"a.vtk", VTK "POINTS 1 string\nabc\n", "POINTS must be numbers"},
    {"a.vtk", VTK "POINTS 1 float\n0 0 0\nPOINT_DATA 7\n", "POINT_DATA: 7 values for 1 points"},
    {"a.vtk", VTK "POINTS 1 float\n0 0 0\nPOINT_DATA 1\nSCALARS radius float\n-1\n",
     "radius of particle 0 must be above 0"},
    {"a.vtk", VTK "POINTS 1 float\n0 0 0\nCELLS 1 888888888\n", "cells: 888888888 values were announced"},
    {"a.vtk", VTK "DATASET CUBE\n", "'DATASET' is no section"},
    {"a.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET RECTILINEAR_GRID\n",
     "must be UNSTRUCTURED_GRID or POLYDATA"},
    {"a.ply", "ply", "neither a legacy VTK file"},
    {"a.ply", PLY, "a.ply: line 3: the file ends in the header"},
    {"a.ply", "ply\nformat morse 1.0\n", "line 2: format must be ascii"},
    {"a.ply", PLY "element vertex 268435457\n" XYZ, "268435457 is too many, at most 268435456 can be"},
    {"a.ply", PLY "element vertex 9999999\n" XYZ "0 0 0\n", "9999999 rows were announced"},
    {"a.ply", PLY "element vertex 1\n" XYZ "0 0 inf\n", "line 8: position of particle 0 is not a finite number"},
    {"a.ply", PLY "element vertex 1\nproperty list int int x\nend_header\n-5\n", "the vertices have no x, y and z"},
    {"a.ply", PLY "element vertex 1\nproperty colour x\n", "'colour' is no type of number"},
    {"p_%05d.vtk", NULL, "there is no file of this series"},
    {"none/p_%05d.vtk", NULL, "cannot read this folder: No such file or directory"},
    {"p_%s.vtk", NULL, "a name may hold one number"},
    {"missing.ply", NULL, "missing.ply: cannot be read: No such file or directory"},
};

static void test_malformed(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof malformed / sizeof *malformed; i++) {
    const char *path = in(folder, malformed[i].name);
    if (malformed[i].text) file_put_text(path, malformed[i].text);
    LidoRun run = {0};
    LIDO(&run, "render", path, "-o", in(folder, "out/f_%05d.png"));
    check_said(&run, 2, malformed[i].cause);
    check_nothing_written();
  }
}

// A valid file of ours, cut at many places.
static void test_cut_short(void **state) {
  (void)state;
  static const char *const endings[] = {"vtk", "ply"};
  for (int i = 0; i < 2; i++) {
    char name[32], path[512];
    snprintf(name, sizeof name, "p.%s", endings[i]);
    snprintf(path, sizeof path, "%s", in(folder, name));
    LidoRun run = {0};
    LIDO(&run, "simulate", scene, "--frames", "1", "-q", "-o", path);
    assert_int_equal(run.code, 0);
    size_t size;
    uint8_t *bytes = file_get(path, &size);
    for (int k = 0; k < 8; k++) {
      // Not in the last array's header or behind a section, where a VTK file may end.
      file_put(path, bytes, size * (size_t)k / 9);
      LIDO(&run, "render", path, "-o", in(folder, "out/f.png"));
      check_said(&run, 2, k == 0 ? "the file is empty" : name);
      check_nothing_written();
    }
    free(bytes);
    remove(path);
  }
}

// ---- Places that cannot be written -------------------------------------------------------------------------------------------

static void simulate_to(LidoRun *run, const char *output) {
  LIDO(run, "simulate", scene, "--frames", "3", "-q", "-o", output);
}

static void test_wrong_outputs(void **state) {
  (void)state;
  static const struct {
    const char *output, *cause;
  } simulate[] = {{"out/p_%05d.obj", "must end in .vtk or .ply"},
                  {"out/p.vtk", "the name needs a number"},
                  {"out/p_%5d.vtk", "a name may hold one number"},
                  {"out/%d/p.vtk", "not into its folder"},
                  {"out/%d_%d.ply", "only one number"}},
    render[] = {{"out/p.gif", "must be numbered pictures"},
                {"out/p.png", "the name needs a number"},
                {"out/film_%d.mp4", "a film is one file"},
                {"out/p_%05d.pfm", "name one with --layer"},
                {"out/p_%x.png", "a name may hold one number"}};
  for (size_t i = 0; i < 5; i++) {
    LidoRun run = {0};
    simulate_to(&run, in(folder, simulate[i].output));
    check_said(&run, 2, simulate[i].cause);
    LIDO(&run, "render", scene, "--frames", "3", "-q", "-o", in(folder, render[i].output), "--size", "16x16");
    check_said(&run, 2, render[i].cause);
    check_nothing_written();
  }
  LidoRun run = {0};
  file_put_text(in(folder, "p.vtk"), VTK "POINTS 1 float\n0 0 0\n");
  LIDO(&run, "simulate", in(folder, "p.vtk"), "-o", in(folder, "out/p_%05d.vtk"));
  check_said(&run, 2, "a scene is needed to simulate");
  LIDO(&run, "render", in(folder, "p.vtk"), "-o", in(folder, "out/p.png"), "--frames", "5:9");
  check_said(&run, 2, "no file of this series is in the range of --frames");
  check_nothing_written();
}

static void test_unwritable(void **state) {
  (void)state;
  LidoRun run = {0};
  file_put_text(in(folder, "file"), "x");
  simulate_to(&run, in(folder, "file/p_%05d.vtk")); // a file where the folder shall be
  check_said(&run, 1, "file: cannot make this folder: a file of that name is there");
  if (access("/proc/self", F_OK) == 0) { // not even root can write there
    simulate_to(&run, "/proc/lido/p_%05d.vtk");
    check_said(&run, 1, "/proc/lido: cannot make this folder: ");
  }
  mkdir(in(folder, "out/p_00000.ply"), 0777); // a folder where the file shall be
  simulate_to(&run, in(folder, "out/p_%05d.ply"));
  check_said(&run, 1, "p_00000.ply: cannot be written: Is a directory");
  assert_int_equal(folder_count(in(folder, "out")), 1);
  assert_int_equal(rmdir(in(folder, "out/p_00000.ply")), 0);
  LIDO(&run, "simulate", scene, "--frames", "2", "-q", "-o", in(folder, "out/p_%05d.vtk"), "--stats",
       in(folder, "file/stats.jsonl"));
  check_said(&run, 1, "a file of that name is there");
  check_nothing_written();
}

static void test_read_only_folder(void **state) {
  (void)state;
  LidoRun run = {.as_nobody = true};
  chmod(folder, 0755);
  chmod(in(folder, "out"), 0555);
  simulate_to(&run, in(folder, "out/p_%05d.vtk"));
  if (run.code == 127) skip(); // nobody may not enter the build folder; /sys above stands for it then
  check_said(&run, 1, "p_00000.vtk: cannot be written: Permission denied");
  check_nothing_written();
  simulate_to(&run, in(folder, "out/deeper/p_%05d.vtk"));
  check_said(&run, 1, "out/deeper: cannot make this folder: Permission denied");
  check_nothing_written();
}

// ---- A full disk ---------------------------------------------------------------------------------------------------------------

static void test_full_device(void **state) {
  (void)state;
  LidoRun run = {0};
  assert_int_equal(symlink("/dev/full", in(folder, "p_00001.vtk")), 0);
  simulate_to(&run, in(folder, "p_%05d.vtk"));
  check_said(&run, 1, "p_00001.vtk: cannot be written: No space left on device; 1 of 3 frames are in ");
  LIDO(&run, "simulate", scene, "--frames", "2", "-q", "-o", in(folder, "out/p_%05d.vtk"), "--stats", "/dev/full");
  check_said(&run, 1, "/dev/full: cannot be written: No space left on device");
}

static void test_file_size_limit(void **state) {
  (void)state;
  if (LIDO_NO_FILE_SIZE_LIMIT) skip();
  LidoRun run = {.file_size_limit = 5000};
  simulate_to(&run, in(folder, "out/p_%05d.vtk"));
  check_said(&run, 1, "p_00000.vtk: cannot be written: File too large");
  check_nothing_written();
}

// A file system that has room for the first frame only.
static void test_full_disk(void **state) {
  (void)state;
  char disk[512];
  snprintf(disk, sizeof disk, "%s/disk", folder);
  mkdir(disk, 0777);
  if (mount("tmpfs", disk, "tmpfs", 0, "size=48k") != 0) skip(); // not allowed here: the two tests above stand for it
  LidoRun run = {0};
  LIDO(&run, "simulate", scene, "--frames", "3", "-q", "-o", in(disk, "p_%05d.vtk"));
  int files = folder_count(disk);
  umount(disk);
  check_said(&run, 1, "cannot be written: No space left on device");
  char said[64];
  snprintf(said, sizeof said, "; %d of 3 frames are in ", files);
  assert_in_range(files, 1, 2);
  assert_non_null(strstr(run.text, said));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test_setup_teardown(test_malformed, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_cut_short, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_wrong_outputs, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_unwritable, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_read_only_folder, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_full_device, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_file_size_limit, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_full_disk, set_up, tear_down),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
