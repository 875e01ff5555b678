// lido render through the program: pictures, films, raw frames and layers; parts of a film; particle files against the
// scene they came from; one context against another.
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <cjson/cJSON.h>
#include <cmocka.h>

#include "app/image.h"
#include "run_lido.h"
#include "small_scene.h"

#define SIZE "--size", "96x54"

static char folder[256];
static char scene[512];

static int set_up(void **state) {
  (void)state;
  folder_make(folder);
  snprintf(scene, sizeof scene, "%s/scene.json", folder);
  file_put_text(scene, SMALL_SCENE SMALL_EVENTS SMALL_END);
  mkdir(in(folder, "out"), 0777);
  return 0;
}

static int tear_down(void **state) {
  (void)state;
  folder_remove(folder);
  return 0;
}

static void read_png(const char *name, Image *image) {
  AppError error;
  if (!image_read_png(in(folder, name), image, &error)) fail_msg("%s", error.message);
}

// The share of pixels of which no channel differs by more than `tolerance`.
static double share_equal(const Image *a, const Image *b, int tolerance) {
  assert_int_equal(a->width, b->width);
  assert_int_equal(a->height, b->height);
  int pixels = a->width * a->height, equal = 0;
  for (int i = 0; i < pixels; i++) {
    int worst = 0;
    for (int k = 0; k < 3; k++) {
      int difference = abs(a->bytes[3 * i + k] - b->bytes[3 * i + k]);
      if (difference > worst) worst = difference;
    }
    equal += worst <= tolerance;
  }
  return (double)equal / pixels;
}

static double compare_png(const char *name_a, const char *name_b, int tolerance) {
  Image a, b;
  read_png(name_a, &a);
  read_png(name_b, &b);
  double share = share_equal(&a, &b, tolerance);
  image_free(&a);
  image_free(&b);
  return share;
}

// What ffprobe says about a film: "width,height,frames".
static void probe(const char *path, char text[128]) {
  char command[1024];
  snprintf(command, sizeof command,
           "ffprobe -v error -count_frames -select_streams v:0 -show_entries "
           "stream=width,height,nb_read_frames -of csv=p=0 '%s'",
           path);
  FILE *pipe = popen(command, "r");
  assert_non_null(pipe);
  if (!fgets(text, 128, pipe)) text[0] = '\0';
  text[strcspn(text, "\r\n")] = '\0';
  assert_int_equal(pclose(pipe), 0);
}

// ---- Pictures ----------------------------------------------------------------------------------------------------------------

static void test_pictures(void **state) {
  (void)state;
  LidoRun run = {0};
  LIDO(&run, "render", scene, "--frames", "3", SIZE, "-o", in(folder, "out/f_%05d.png"));
  check_done(&run);
  assert_non_null(strstr(run.text, "lido: 3 frames written to "));
  assert_int_equal(folder_count(in(folder, "out")), 3);
  Image image;
  read_png("out/f_00002.png", &image);
  assert_int_equal(image.width, 96);
  assert_int_equal(image.height, 54);
  // There is something to see.
  int darkest = 255, brightest = 0;
  for (int i = 0; i < 96 * 54 * 3; i++) {
    if (image.bytes[i] < darkest) darkest = image.bytes[i];
    if (image.bytes[i] > brightest) brightest = image.bytes[i];
  }
  assert_true(brightest - darkest > 60);
  image_free(&image);
  assert_true(compare_png("out/f_00000.png", "out/f_00002.png", 0) < 1);
  // One picture needs no number; --camera looks from elsewhere.
  LIDO(&run, "render", scene, "--frames", "2:3", SIZE, "-o", in(folder, "one.png"), "--camera", "2,2,2,0,0,0");
  check_done(&run);
  assert_true(compare_png("one.png", "out/f_00002.png", 8) < 0.9);
}

static void test_part_of_film(void **state) {
  (void)state;
  LidoRun run = {0};
  LIDO(&run, "render", scene, "--frames", "9", SIZE, "-q", "-o", in(folder, "out/w_%02d.png"));
  check_done(&run);
  LIDO(&run, "render", scene, "--frames", "5:9", SIZE, "-q", "-o", in(folder, "out/p_%02d.png"));
  check_done(&run);
  assert_int_equal(run.lines, 0);
  assert_int_equal(folder_count(in(folder, "out")), 9 + 4);
  for (int i = 5; i < 9; i++) {
    char a[32], b[32];
    snprintf(a, sizeof a, "out/w_%02d.png", i);
    snprintf(b, sizeof b, "out/p_%02d.png", i);
    assert_true(files_equal(in(folder, a), in(folder, b)));
  }
}

// The same frame, simulated here or read from a file.
static void test_from_files(void **state) {
  (void)state;
  static const char *const endings[] = {"vtk", "ply"};
  file_put_text(scene, SMALL_SCENE SMALL_END);
  LidoRun run = {0};
  LIDO(&run, "render", scene, "--frames", "6:8", SIZE, "-q", "-o", in(folder, "out/s_%d.png"));
  check_done(&run);
  for (int e = 0; e < 2; e++) {
    char pattern[32], picture[32];
    snprintf(pattern, sizeof pattern, "p_%%03d.%s", endings[e]);
    LIDO(&run, "simulate", scene, "--frames", "9", "-q", "-o", in(folder, pattern));
    check_done(&run);
    snprintf(picture, sizeof picture, "out/%s_%%d.png", endings[e]);
    LIDO(&run, "render", in(folder, pattern), "--frames", "6:8", SIZE, "-q", "-o", in(folder, picture));
    check_done(&run);
    for (int i = 6; i < 8; i++) {
      char a[32], b[32];
      snprintf(a, sizeof a, "out/s_%d.png", i);
      snprintf(b, sizeof b, "out/%s_%d.png", endings[e], i);
      double share = compare_png(a, b, 2);
      if (share < 0.995) fail_msg("frame %d from %s: only %.2f %% of the pixels are equal", i, endings[e], 100 * share);
    }
  }
  assert_int_equal(folder_count(in(folder, "out")), 6);
}

// A series with gaps, from another program, of which nothing but positions is known.
static void test_foreign_series(void **state) {
  (void)state;
  for (int i = 10; i <= 30; i += 10) {
    char name[32], text[4000] = "# vtk DataFile Version 2.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 64 float\n";
    snprintf(name, sizeof name, "p_%d.vtk", i);
    for (int k = 0; k < 64; k++)
      snprintf(text + strlen(text), sizeof text - strlen(text), "%g %g %g\n", k % 4 * 0.1, k / 4 % 4 * 0.1 + i * 0.01,
               k / 16 * 0.1);
    file_put_text(in(folder, name), text);
  }
  LidoRun run = {0};
  LIDO(&run, "render", in(folder, "p_%d.vtk"), SIZE, "-q", "-o", in(folder, "out/f_%d.png"), "--stats",
       in(folder, "s.jsonl"));
  check_done(&run);
  assert_int_equal(folder_count(in(folder, "out")), 3);
  assert_true(compare_png("out/f_10.png", "out/f_30.png", 0) < 0.999);
  // Drawn alone, the last one looks just as it does in the series.
  LIDO(&run, "render", in(folder, "p_%d.vtk"), SIZE, "-q", "--frames", "30:31", "-o", in(folder, "one.png"));
  check_done(&run);
  assert_true(files_equal(in(folder, "one.png"), in(folder, "out/f_30.png")));
  size_t size;
  char *text = (char *)file_get(in(folder, "s.jsonl"), &size);
  assert_non_null(strstr(text, "\"frame\": 30"));
  assert_non_null(strstr(text, "\"energy\": null"));
  free(text);
}

static void test_no_particles(void **state) {
  (void)state;
  file_put_text(in(folder, "p.vtk"), "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 0 float\n");
  file_put_text(in(folder, "q.vtk"), "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n1 2 3\n");
  LidoRun run = {0};
  LIDO(&run, "render", in(folder, "p.vtk"), SIZE, "-q", "-o", in(folder, "p.png"));
  check_done(&run);
  LIDO(&run, "render", in(folder, "q.vtk"), SIZE, "-q", "-o", in(folder, "q.png"));
  check_done(&run);
}

// ---- Several styles side by side ---------------------------------------------------------------------------------------------

// How many pixels of a place of 96 × 54 in `all`, at (x, y), are not those of `cell`, within and without the corner that a
// name takes; black where `cell` is NULL.
static int count_differences(const Image *all, int x, int y, const Image *cell, bool corner) {
  int count = 0;
  for (int row = 0; row < 54; row++)
    for (int column = 0; column < 96; column++) {
      static const uint8_t black[3] = {0};
      const uint8_t *expected = cell ? cell->bytes + 3 * (96 * row + column) : black;
      bool in_corner = row < 2 * 11 && column < 14 * 6;
      if (in_corner == corner)
        count += memcmp(all->bytes + 3 * (all->width * (y + row) + x + column), expected, 3) != 0;
    }
  return count;
}

static const char *const three_styles[] = {"points", "refraction", "cartoon"};

// Each place holds exactly the picture that its style makes alone.
static void test_styles_side_by_side(void **state) {
  (void)state;
  LidoRun run = {0};
  LIDO(&run, "render", scene, "--frames", "2:4", SIZE, "--style", "points,refraction,cartoon", "--no-names", "-o",
       in(folder, "out/f_%d.png"));
  check_done(&run);
  assert_non_null(strstr(run.text, "lido: 2 frames written to "));
  LIDO(&run, "render", scene, "--frames", "3:4", SIZE, "-q", "--style", "points,refraction,cartoon", "-o",
       in(folder, "named.png"));
  check_done(&run);
  Image all, named, cell;
  read_png("out/f_3.png", &all);
  read_png("named.png", &named);
  assert_true(all.width == 192 && all.height == 108 && named.width == 192 && named.height == 108);
  for (int i = 0; i < 3; i++) {
    LIDO(&run, "render", scene, "--frames", "3:4", SIZE, "-q", "--style", three_styles[i], "-o",
         in(folder, "cell.png"));
    check_done(&run);
    read_png("cell.png", &cell);
    int x = i % 2 * 96, y = i / 2 * 54;
    assert_int_equal(count_differences(&all, x, y, &cell, false) + count_differences(&all, x, y, &cell, true), 0);
    assert_int_equal(count_differences(&named, x, y, &cell, false), 0);
    assert_in_range(count_differences(&named, x, y, &cell, true), 100, 14 * 6 * 2 * 11); // letters on a veil
    assert_true(count_differences(&all, 96 - x, y, &cell, false) > 100); // the one beside it is another one
    image_free(&cell);
  }
  assert_int_equal(count_differences(&all, 96, 54, NULL, false) + count_differences(&all, 96, 54, NULL, true), 0);
  image_free(&all);
  image_free(&named);
}

// The same as raw frames, as a film and from particle files.
static void test_styles_side_by_side_anywhere(void **state) {
  (void)state;
  const char *path = in(folder, "raw.rgb");
  LidoRun run = {.stdout_to = path};
  LIDO(&run, "render", scene, "--frames", "2", SIZE, "-q", "--style", "points,refraction", "-o", "-");
  check_done(&run);
  run = (LidoRun){0};
  LIDO(&run, "render", scene, "--frames", "1:2", SIZE, "-q", "--style", "points,refraction", "-o", in(folder, "f.png"));
  check_done(&run);
  size_t size;
  uint8_t *bytes = file_get(path, &size);
  Image image;
  read_png("f.png", &image);
  assert_true(image.width == 192 && image.height == 54);
  assert_int_equal(size, 2 * 192 * 54 * 3);
  assert_memory_equal(image.bytes, bytes + 192 * 54 * 3, 192 * 54 * 3);
  image_free(&image);
  free(bytes);
  LIDO(&run, "simulate", scene, "--frames", "2", "-q", "-o", in(folder, "p_%d.ply"));
  check_done(&run);
  LIDO(&run, "render", in(folder, "p_%d.ply"), "--frames", "1:2", SIZE, "-q", "--style", "points,refraction", "-o",
       in(folder, "g.png"));
  check_done(&run);
  read_png("g.png", &image);
  assert_true(image.width == 192 && image.height == 54);
  image_free(&image);
  if (system("command -v ffmpeg ffprobe >/dev/null") != 0) return;
  char text[128];
  LIDO(&run, "render", scene, "--frames", "3", SIZE, "-q", "--style", "points,refraction", "-o",
       in(folder, "film.mp4"));
  check_done(&run);
  probe(in(folder, "film.mp4"), text);
  assert_string_equal(text, "192,54,3");
}

// ---- Contexts ------------------------------------------------------------------------------------------------------------------

static void test_contexts(void **state) {
  (void)state;
#if LIDO_OSMESA
  static const char *const sources[] = {"configs/dam_break.json", "configs/double_dam_break.json"};
  for (int i = 0; i < 2; i++) {
    LidoRun run = {0};
    LIDO(&run, "render", sources[i], "--frames", "1:2", "--size", "320x180", "-q", "--context", "egl", "-o",
         in(folder, "egl.png"));
    check_done(&run);
    LIDO(&run, "render", sources[i], "--frames", "1:2", "--size", "320x180", "-q", "--context", "osmesa", "-o",
         in(folder, "osmesa.png"));
    check_done(&run);
    double share = compare_png("egl.png", "osmesa.png", 2);
    if (share < 0.995) fail_msg("%s: EGL and OSMesa agree on %.3f %% of the pixels only", sources[i], 100 * share);
  }
#else
  skip(); // built without OSMesa
#endif
}

// ---- Layers ----------------------------------------------------------------------------------------------------------------------

static void test_layers(void **state) {
  (void)state;
  LidoRun run = {0};
  LIDO(&run, "render", scene, "--frames", "1", SIZE, "-q", "--layer", "depth", "-o", in(folder, "d.png"));
  check_done(&run);
  LIDO(&run, "render", scene, "--frames", "1", SIZE, "-q", "--layer", "depth", "-o", in(folder, "d.pfm"));
  check_done(&run);
  LIDO(&run, "render", scene, "--frames", "1", SIZE, "-q", "-o", in(folder, "f.png"));
  check_done(&run);
  assert_true(compare_png("d.png", "f.png", 8) < 0.9);
  Image image;
  AppError error;
  assert_true(image_read_pfm(in(folder, "d.pfm"), &image, &error));
  assert_int_equal(image.width, 96);
  assert_int_equal(image.channels, 1);
  int plausible = 0;
  for (int i = 0; i < 96 * 54; i++) plausible += image.values[i] > 0.05f && image.values[i] < 50;
  assert_true(plausible > 100); // metres to the floor or the water
  image_free(&image);
  LIDO(&run, "render", scene, "--frames", "1", SIZE, "-q", "--layer", "smell", "-o", in(folder, "out/x.png"));
  check_said(&run, 2, "--layer smell: style 'refraction' has no such layer; it has: ");
  assert_int_equal(folder_count(in(folder, "out")), 0);
  LIDO(&run, "render", scene, "--frames", "1", "--style", "blue", "-o", in(folder, "out/x.png"));
  check_said(&run, 2, "--style: must be one of points, ");
}

// ---- Films and raw frames --------------------------------------------------------------------------------------------------------

static void test_film(void **state) {
  (void)state;
  if (system("command -v ffmpeg ffprobe >/dev/null") != 0) skip();
  LidoRun run = {0};
  char text[128];
  LIDO(&run, "render", scene, "--frames", "7", SIZE, "-q", "-o", in(folder, "out/film 50%%: a.mp4"));
  check_done(&run);
  assert_int_equal(run.lines, 0);
  assert_int_equal(folder_count(in(folder, "out")), 1);
  probe(in(folder, "out/film 50%: a.mp4"), text);
  assert_string_equal(text, "96,54,7");
  // Odd sizes grow by a pixel, which 4:2:0 needs.
  LIDO(&run, "render", scene, "--frames", "2", "--size", "33x17", "-q", "-o", in(folder, "odd.mkv"));
  check_done(&run);
  probe(in(folder, "odd.mkv"), text);
  assert_string_equal(text, "34,18,2");
}

static void test_film_interrupted(void **state) {
  (void)state;
  if (system("command -v ffmpeg ffprobe >/dev/null") != 0) skip();
  // As soon as the place of the film is held, many frames before its end.
  LidoRun run = {.interrupt_when = in(folder, "out")};
  LIDO(&run, "render", scene, "--frames", "100000", SIZE, "-q", "-o", in(folder, "out/film.mp4"));
  int written = -1;
  char text[128], expected[64];
  assert_int_equal(run.code, 1);
  assert_int_equal(sscanf(run.text, "lido: interrupted: %d of 100000 frames written", &written), 1);
  assert_int_equal(folder_count(in(folder, "out")), written > 0);
  if (written == 0) return;
  probe(in(folder, "out/film.mp4"), text);
  snprintf(expected, sizeof expected, "96,54,%d", written);
  assert_string_equal(text, expected);
}

// Twice Ctrl-C does not wait for the frame, and still leaves nothing half.
static void test_film_interrupted_twice(void **state) {
  (void)state;
  if (system("command -v ffmpeg >/dev/null") != 0) skip();
  LidoRun run = {.interrupt_when = in(folder, "out"), .interrupt_twice = true};
  LIDO(&run, "render", "configs/dam_break.json", "--frames", "100000", "--size", "4000x3000", "-q", "-o",
       in(folder, "out/film.mp4"));
  assert_int_equal(run.code, 1000 + SIGINT);
  assert_int_equal(folder_count(in(folder, "out")), 0);
}

// A program named ffmpeg that does what the script says.
static void fake_ffmpeg(const char *script) {
  file_put_text(in(folder, "bin/ffmpeg"), script);
  chmod(in(folder, "bin/ffmpeg"), 0777);
}

static void test_film_fails(void **state) {
  (void)state;
  static const struct {
    const char *script, *cause;
  } fakes[] = {
      {"#!/bin/sh\nexit 3\n", "ffmpeg failed with exit code 3"},
      {"#!/bin/sh\necho >&2\necho 'no such codec' >&2\necho 'nothing done' >&2\nexit 1\n",
       "film.mp4: ffmpeg failed: no such codec"},
      {"#!/bin/sh\nkill -9 $$\n", "ffmpeg was ended by signal 9"},
      {"#!/bin/sh\n/bin/cat >/dev/null\nexit 4\n", "ffmpeg failed with exit code 4"},
      {"no program at all\n", "film.mp4: ffmpeg "},
  };
  char bin[512];
  snprintf(bin, sizeof bin, "%s/bin", folder);
  mkdir(bin, 0777);
  LidoRun run = {.path_variable = bin};
  LIDO(&run, "render", scene, "--frames", "40", SIZE, "-q", "-o", in(folder, "out/film.mp4"));
  check_said(&run, 1, "film.mp4: ffmpeg is needed for films and was not found");
  assert_int_equal(folder_count(in(folder, "out")), 0);
  for (size_t i = 0; i < sizeof fakes / sizeof *fakes; i++) {
    fake_ffmpeg(fakes[i].script);
    LIDO(&run, "render", scene, "--frames", "40", SIZE, "-q", "-o", in(folder, "out/film.mp4"));
    check_said(&run, 1, fakes[i].cause);
    assert_int_equal(folder_count(in(folder, "out")), 0);
  }
}

static void test_film_full_disk(void **state) {
  (void)state;
  if (system("command -v ffmpeg >/dev/null") != 0) skip();
  if (LIDO_NO_FILE_SIZE_LIMIT) skip();
  LidoRun run = {.file_size_limit = 5000};
  LIDO(&run, "render", scene, "--frames", "12", "--size", "480x270", "-q", "-o", in(folder, "out/film.mp4"));
  check_said(&run, 1, "film.mp4: ffmpeg ");
  assert_int_equal(folder_count(in(folder, "out")), 0);
}

static void test_raw(void **state) {
  (void)state;
  const char *path = in(folder, "raw.rgb");
  LidoRun run = {.stdout_to = path};
  LIDO(&run, "render", scene, "--frames", "3", SIZE, "-o", "-");
  check_done(&run);
  assert_non_null(strstr(run.text, "lido: 3 frames written to standard output")); // which holds pictures only
  size_t size;
  uint8_t *bytes = file_get(path, &size);
  assert_int_equal(size, 3 * 96 * 54 * 3);
  LidoRun png = {0};
  LIDO(&png, "render", scene, "--frames", "2:3", SIZE, "-q", "-o", in(folder, "f.png"));
  check_done(&png);
  Image image;
  read_png("f.png", &image);
  assert_memory_equal(image.bytes, bytes + 2 * 96 * 54 * 3, 96 * 54 * 3);
  image_free(&image);
  free(bytes);
}

static void test_reader_goes_away(void **state) {
  (void)state;
  LidoRun run = {.close_reader = true};
  LIDO(&run, "render", scene, "--frames", "12", "--size", "640x360", "-q", "-o", "-");
  check_said(&run, 1, "standard output: its reader has gone");
  run = (LidoRun){.stdout_to = "/dev/full"};
  LIDO(&run, "render", scene, "--frames", "2", SIZE, "-q", "-o", "-");
  check_said(&run, 1, "standard output: cannot be written: No space left on device");
  if (!lido_has_terminals()) return;
  run = (LidoRun){.stdout_to = "/dev/ptmx"};
  LIDO(&run, "render", scene, "--frames", "2", SIZE, "-q", "-o", "-");
  check_said(&run, 2, "raw pictures are not for a terminal");
}

static void test_interrupt(void **state) {
  (void)state;
  LidoRun run = {.interrupt_when = in(folder, "out/f_00001.png")};
  LIDO(&run, "render", scene, "--frames", "100000", SIZE, "-q", "-o", in(folder, "out/f_%05d.png"));
  int written = 0;
  assert_int_equal(run.code, 1);
  assert_int_equal(run.lines, 1);
  assert_int_equal(sscanf(run.text, "lido: interrupted: %d of 100000 frames written", &written), 1);
  assert_int_equal(folder_count(in(folder, "out")), written);
  char name[32];
  snprintf(name, sizeof name, "out/f_%05d.png", written - 1);
  Image image;
  read_png(name, &image);
  image_free(&image);
}

// ---- Statistics ------------------------------------------------------------------------------------------------------------------

static void test_stats(void **state) {
  (void)state;
  LidoRun run = {0};
  LIDO(&run, "render", scene, "--frames", "4", SIZE, "-q", "-o", in(folder, "out/f_%05d.png"), "--stats",
       in(folder, "s.jsonl"));
  check_done(&run);
  size_t size;
  char *text = (char *)file_get(in(folder, "s.jsonl"), &size);
  int lines = 0;
  for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n"), lines++) {
    const char *end;
    cJSON *object = cJSON_ParseWithOpts(line, &end, true);
    if (!object) fail_msg("line %d is no JSON: %s", lines + 1, line);
    const cJSON *passes = cJSON_GetObjectItem(object, "pass_ms");
    assert_true(cJSON_GetArraySize(passes) >= 2);
    assert_true(cJSON_IsString(cJSON_GetObjectItem(cJSON_GetArrayItem(passes, 0), "name")));
    assert_true(cJSON_IsObject(cJSON_GetObjectItem(object, "stage_ms")));
    cJSON_Delete(object);
  }
  assert_int_equal(lines, 4);
  free(text);
}

// Shares of the orders in which rays went through two kinds of water.
static void test_figures(void **state) {
  (void)state;
  LidoRun run = {0};
  LIDO(&run, "render", scene, "--frames", "2", SIZE, "-q", "--style", "refraction", "-o", in(folder, "out/f_%05d.png"),
       "--stats", in(folder, "s.jsonl"));
  check_done(&run);
  size_t size;
  char *text = (char *)file_get(in(folder, "s.jsonl"), &size);
  int lines = 0;
  for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n"), lines++) {
    cJSON *object = cJSON_Parse(line), *figures = cJSON_GetObjectItem(object, "figures"), *figure;
    assert_int_equal(cJSON_GetArraySize(figures), 6);
    double bytes = cJSON_GetObjectItem(object, "buffer_bytes")->valuedouble;
    assert_true(bytes >= 16 * cJSON_GetObjectItem(object, "particles")->valuedouble); // a sphere each
    assert_true(cJSON_GetObjectItem(figures, "aggregated")->valuedouble > 0.3);
    double sum = 0;
    cJSON_ArrayForEach(figure, figures) sum += figure->valuedouble;
    assert_true(fabs(sum - 1) < 1e-3);
    cJSON_Delete(object);
  }
  assert_int_equal(lines, 2);
  free(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test_setup_teardown(test_pictures, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_part_of_film, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_from_files, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_foreign_series, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_no_particles, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_styles_side_by_side, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_styles_side_by_side_anywhere, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_contexts, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_layers, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_film, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_film_interrupted, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_film_interrupted_twice, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_film_fails, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_film_full_disk, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_raw, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_reader_goes_away, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_interrupt, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_stats, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_figures, set_up, tear_down),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
