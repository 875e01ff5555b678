// Mesh files: cubes in every format, what is dropped, turned and joined, and what must be refused.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "app/mesh_file.h"
#include "app/scene.h"
#include "run_lido.h"

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

// A box of 2 x 4 x 6 with its lowest corner in the origin, its corners, and its faces seen from outside.
static const char corners[] = "v 0 0 0\nv 2 0 0\nv 2 4 0\nv 0 4 0\nv 0 0 6\nv 2 0 6\nv 2 4 6\nv 0 4 6\n";
static const char faces[] = "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";
static const char faces_inside_out[] = "f 1 2 3 4\nf 8 7 6 5\nf 5 6 2 1\nf 7 8 4 3\nf 6 7 3 2\nf 4 8 5 1\n";

static const char *put(const char *name, const char *first, const char *second) {
  char text[4096];
  snprintf(text, sizeof text, "%s%s", first, second);
  const char *path = in(folder, name);
  file_put_text(path, text);
  return path;
}

static SimMesh read_mesh(const char *path, double scale, bool centre) {
  SimMesh mesh;
  char cause[MESH_FILE_CAUSE_SIZE];
  bool memory;
  if (!mesh_file_read(path, scale, centre, &mesh, cause, &memory)) fail_msg("%s: %s", path, cause);
  return mesh;
}

static void check_refused(const char *path, const char *cause) {
  SimMesh mesh;
  char got[MESH_FILE_CAUSE_SIZE] = "";
  bool memory;
  if (mesh_file_read(path, 1, true, &mesh, got, &memory)) {
    mesh_file_free(&mesh);
    fail_msg("%s is taken, but should be refused: %s", path, cause);
  }
  assert_true(memory);
  if (!strstr(got, cause)) fail_msg("%s: got '%s', want '%s'", path, got, cause);
  assert_null(mesh.vertex);
}

static double volume(const SimMesh *mesh) {
  double sum = 0;
  for (int t = 0; t < mesh->triangle_count; t++) {
    const float *a = mesh->vertex + 3 * mesh->triangle[3 * t], *b = mesh->vertex + 3 * mesh->triangle[3 * t + 1],
                *c = mesh->vertex + 3 * mesh->triangle[3 * t + 2];
    sum += a[0] * ((double)b[1] * c[2] - (double)b[2] * c[1]) + a[1] * ((double)b[2] * c[0] - (double)b[0] * c[2]) +
           a[2] * ((double)b[0] * c[1] - (double)b[1] * c[0]);
  }
  return sum / 6;
}

/// The box, `scale` times as large, around the origin.
static void check_box(const SimMesh *mesh, double scale) {
  assert_int_equal(mesh->vertex_count, 8);
  assert_int_equal(mesh->triangle_count, 12);
  for (int i = 0; i < 8; i++)
    for (int k = 0; k < 3; k++) assert_float_equal(fabs(mesh->vertex[3 * i + k]), scale * (k + 1), 1e-5 * scale);
  assert_float_equal(volume(mesh), 48 * scale * scale * scale, 1e-4 * scale * scale * scale);
}

static void a_box_of_quads_becomes_triangles(void **state) {
  (void)state;
  SimMesh mesh = read_mesh(put("box.obj", corners, faces), 1, true);
  check_box(&mesh, 1);
  mesh_file_free(&mesh);
  assert_null(mesh.triangle);
  mesh = read_mesh(in(folder, "box.obj"), 0.01, true);
  check_box(&mesh, 0.01);
  mesh_file_free(&mesh);
}

static void without_centre_the_origin_is_the_files(void **state) {
  (void)state;
  SimMesh mesh = read_mesh(put("origin.obj", corners, faces), 0.5, false);
  float low[3] = {9, 9, 9}, high[3] = {-9, -9, -9};
  for (int i = 0; i < mesh.vertex_count; i++)
    for (int k = 0; k < 3; k++) {
      low[k] = fminf(low[k], mesh.vertex[3 * i + k]);
      high[k] = fmaxf(high[k], mesh.vertex[3 * i + k]);
    }
  for (int k = 0; k < 3; k++) assert_true(low[k] == 0 && high[k] == (float)(k + 1));
  mesh_file_free(&mesh);
}

static void normals_are_turned_outwards(void **state) {
  (void)state;
  SimMesh mesh = read_mesh(put("inside_out.obj", corners, faces_inside_out), 1, true);
  check_box(&mesh, 1);
  mesh_file_free(&mesh);
}

static void parts_and_materials_become_one(void **state) {
  (void)state;
  // Two groups with materials that are nowhere, a line, a face without area, corners that stand there twice.
  static const char parts[] = "mtllib /dev/zero\no a\nusemtl red\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\no b\nusemtl blue\n"
                              "f 3 4 8 7\nf 2 3 7 6\nf 1 9 8 4\nl 1 2\nf 1 1 2\nv 0 0 6\nf 1 5 9\n";
  SimMesh mesh = read_mesh(put("parts.obj", corners, parts), 1, true);
  check_box(&mesh, 1);
  mesh_file_free(&mesh);
}

static void other_formats_hold_the_same_box(void **state) {
  (void)state;
  static const char off[] = "OFF\n8 6 0\n0 0 0\n2 0 0\n2 4 0\n0 4 0\n0 0 6\n2 0 6\n2 4 6\n0 4 6\n"
                            "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 2 3 7 6\n4 1 2 6 5\n4 0 4 7 3\n";
  static const char ply[] =
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 6\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n2 0 0\n2 4 0\n0 4 0\n0 0 6\n2 0 6\n2 4 6\n0 4 6\n"
      "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 2 3 7 6\n4 1 2 6 5\n4 0 4 7 3\n";
  SimMesh mesh = read_mesh(put("box.OFF", off, ""), 1, true);
  check_box(&mesh, 1);
  // Its own triangles as STL: every corner three times and more.
  char stl[8192] = "solid box\n";
  for (int t = 0; t < mesh.triangle_count; t++) {
    char facet[512], *end = facet + sprintf(facet, "facet normal 0 0 0\nouter loop\n");
    for (int k = 0; k < 3; k++) {
      const float *v = mesh.vertex + 3 * mesh.triangle[3 * t + k];
      end += sprintf(end, "vertex %g %g %g\n", (double)v[0], (double)v[1], (double)v[2]);
    }
    sprintf(end, "endloop\nendfacet\n");
    strcat(stl, facet);
  }
  strcat(stl, "endsolid box\n");
  mesh_file_free(&mesh);
  const char *const paths[] = {put("box.ply", ply, ""), in(folder, "box.stl")};
  file_put_text(paths[1], stl);
  for (int i = 0; i < 2; i++) {
    mesh = read_mesh(paths[i], 1, true);
    check_box(&mesh, 1);
    mesh_file_free(&mesh);
  }
}

static void what_is_no_closed_body_is_refused(void **state) {
  (void)state;
  check_refused(put("open.obj", corners, "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\n"),
                "is not closed: at 4 of its edges triangles are missing or face the other way");
  check_refused(put("turned.obj", corners, "f 1 2 3 4\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n"),
                "is not closed");
  check_refused(put("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n", "f 1 2 3\nf 3 2 1\nf 2 4 3\nf 3 4 2\n"),
                "no volume");
  check_refused(put("one.obj", corners, "f 1 2 3\n"), "fewer than four triangles");
  check_refused(put("lines.obj", corners, "l 1 2\n"), "");
  check_refused(put("corners.obj", corners, ""), "");
}

static void what_is_no_mesh_is_refused(void **state) {
  (void)state;
  check_refused(in(folder, "nowhere.obj"), "No such file");
  check_refused(put("empty.obj", "", ""), "the file is empty");
  check_refused(put("mesh.txt", corners, faces), "is not a mesh file: one of obj, ply, stl, off, glb, dae, fbx, 3ds");
  check_refused(put("no_ending", corners, faces), "is not a mesh file");
  check_refused(folder, "is not a mesh file");
  check_refused("/dev/zero", "is not a mesh file");
  const char *odd = in(folder, "odd.obj");
  assert_int_equal(symlink("/dev/zero", odd), 0);
  check_refused(odd, "is not a file");
  const char *pipe_path = in(folder, "pipe.obj");
  assert_int_equal(mkfifo(pipe_path, 0600), 0);
  check_refused(pipe_path, "is not a file");
  check_refused(put("text.glb", "this is no glTF", ""), "");
  check_refused(put("text.stl", "this is no STL", ""), "");
  check_refused(
      put("huge.ply", "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n", "1\n"), "");
  check_refused(put("far.obj", "v 0 0 0\nv 1e5 0 0\nv 0 1 0\nv 0 0 1\n", "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"),
                "reaches 50000 m from its origin, the most is 1000 m");
  check_refused(put("infinite.obj", "v 0 0 0\nv 1e50 0 0\nv 0 1 0\nv 0 0 1\n", "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"),
                "");
  check_refused(put("outside.obj", corners, "f 1 2 99\nf 1 2 3\nf 1 4 3\nf 1 2 4\n"), "");
}

static void too_large_is_refused(void **state) {
  (void)state;
  const char *path = in(folder, "large.obj");
  file_put_text(path, "v 0 0 0\n");
  assert_int_equal(truncate(path, MESH_FILE_MOST_BYTES + 1), 0);
  check_refused(path, "is larger than 64 MiB");
  FILE *file = fopen(in(folder, "many.obj"), "w");
  assert_non_null(file);
  fputs(corners, file);
  for (int i = 0; i <= MESH_FILE_MOST_TRIANGLES; i++) fputs("f 1 2 3\n", file);
  fclose(file);
  check_refused(in(folder, "many.obj"), "has 500001 triangles, more than the limit of 500000");
}

// Bytes changed: it is read or refused, and never harms. A broken PLY often keeps Assimp busy: few of those.
static void damaged_files_are_read_or_refused(void **state) {
  (void)state;
  const char *const names[] = {"box.obj", "box.OFF", "box.ply", "box.stl"};
  uint32_t seed = 99;
  int read = 0, refused = 0;
  for (int n = 0; n < 4; n++) {
    size_t size;
    uint8_t *bytes = file_get(in(folder, names[n]), &size), *work = malloc(size);
    assert_non_null(work);
    char name[32];
    snprintf(name, sizeof name, "damaged%s", strrchr(names[n], '.'));
    for (int round = 0; round < (n == 2 ? 6 : 60); round++) {
      memcpy(work, bytes, size);
      for (int i = 0; i < 1 + round % 3; i++) {
        seed = seed * 1664525u + 1013904223u;
        work[(seed >> 8) % size] = round % 2 ? (uint8_t)('0' + (seed >> 4) % 10) : (uint8_t)(seed >> 24);
      }
      file_put(in(folder, name), work, size);
      SimMesh mesh;
      char cause[MESH_FILE_CAUSE_SIZE];
      bool memory;
      bool good = mesh_file_read(in(folder, name), 1, true, &mesh, cause, &memory);
      if (good) assert_true(volume(&mesh) > 0);
      good ? read++ : refused++;
      mesh_file_free(&mesh);
    }
    free(bytes);
    free(work);
  }
  if (read < 20 || refused < 20) fail_msg("%d were read and %d refused: this tests nothing", read, refused);
}

// Assimp never ends on this one.
static void a_file_that_keeps_its_reader_busy_is_given_up(void **state) {
  (void)state;
  check_refused(put("endless.ply", "ply\nformat ascii 1.00element vertex 8\nproperty float x\nproperty float", ""),
                "it takes more than 3 s");
}

static void a_scene_finds_the_mesh_beside_it(void **state) {
  (void)state;
  put("box.obj", corners, faces);
  const char *path = put("scene.json",
                         "{\"version\": 1, \"obstacles\": [{\"type\": \"mesh\", \"file\": \"box.obj\", \"scale\": 0.1,"
                         " \"position\": [1, 0.5, 0.5], \"motion\": \"floating\"}]}",
                         "");
  Scene scene;
  AppError error;
  if (!scene_load(&scene, path, NULL, 0, &error)) fail_msg("%s", error.message);
  SimWorldDef def = scene_world_def(&scene);
  assert_int_equal(def.obstacles[0].body.shape, SIM_MESH);
  check_box(def.obstacles[0].body.mesh, 0.1);
  scene_free(&scene);
  LidoRun run = {0};
  path = put(
      "wrong.json",
      "{\"version\": 1, \"obstacles\": [\n{\"type\": \"mesh\", \"file\": \"nowhere.obj\", \"position\": [0, 0, 0]}]}",
      "");
  LIDO(&run, "check", path);
  check_said(&run, 2, "wrong.json:2: obstacles.0.file: nowhere.obj: No such file or directory");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_box_of_quads_becomes_triangles),
      cmocka_unit_test(without_centre_the_origin_is_the_files),
      cmocka_unit_test(normals_are_turned_outwards),
      cmocka_unit_test(parts_and_materials_become_one),
      cmocka_unit_test(other_formats_hold_the_same_box),
      cmocka_unit_test(what_is_no_closed_body_is_refused),
      cmocka_unit_test(what_is_no_mesh_is_refused),
      cmocka_unit_test(too_large_is_refused),
      cmocka_unit_test(damaged_files_are_read_or_refused),
      cmocka_unit_test(a_file_that_keeps_its_reader_busy_is_given_up),
      cmocka_unit_test(a_scene_finds_the_mesh_beside_it),
  };
  return cmocka_run_group_tests_name("app_mesh_file", tests, set_up, tear_down);
}
