// lido bench through the program: its JSON is JSON, and its figures fit each other.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>
#include <cmocka.h>

#include "run_lido.h"
#include "small_scene.h"

static double number(const cJSON *object, const char *name) {
  const cJSON *item = cJSON_GetObjectItem(object, name);
  if (!cJSON_IsNumber(item)) fail_msg("no number %s", name);
  return item->valuedouble;
}

static cJSON *read_report(const char *output) {
  size_t size = 0;
  char *text = (char *)file_get(output, &size);
  cJSON *report = cJSON_ParseWithLength(text, size);
  if (!report) fail_msg("not JSON: %.*s", (int)size, text);
  free(text);
  return report;
}

static cJSON *run_bench(const char *folder, const char *threads) {
  const char *scene = in(folder, "scene.json"), *output = in(folder, "bench.json");
  file_put_text(scene, SMALL_SCENE SMALL_END);
  LidoRun run = {.stdout_to = output};
  LIDO(&run, "bench", "--json", "--frames", "3", "--threads", threads, scene);
  assert_int_equal(run.code, 0);
  return read_report(output);
}

static void figures_fit_each_other(void **state) {
  (void)state;
  char folder[256];
  folder_make(folder);
  cJSON *report = run_bench(folder, "3");
  assert_true(number(report, "particles") > 0 && number(report, "frames") == 3);
  assert_true(number(report, "world_bytes") > 100 * number(report, "particles"));
  assert_true(number(report, "bytes") > number(report, "world_bytes"));
  const cJSON *scaling = cJSON_GetObjectItem(report, "scaling"), *row;
  const int threads[3] = {1, 2, 3};
  assert_int_equal(cJSON_GetArraySize(scaling), 3);
  for (int k = 0; k < 3; k++) {
    assert_true(number(cJSON_GetArrayItem(scaling, k), "threads") == threads[k]);
    assert_true(number(cJSON_GetArrayItem(scaling, k), "median_ms") > 0);
  }
  const cJSON *machine = cJSON_GetObjectItem(report, "machine");
  const cJSON *sweeps = cJSON_GetObjectItem(report, "density_and_correct");
  assert_true(number(machine, "fma_per_second") > number(sweeps, "multiply_adds_per_second"));
  assert_true(number(sweeps, "bytes_per_second") > 0 && number(machine, "copy_bytes_per_second") > 0);
  double parts = 0, total = 0, median = 0;
  cJSON_ArrayForEach(row, cJSON_GetObjectItem(report, "rows")) {
    if (strcmp(cJSON_GetObjectItem(row, "group")->valuestring, "sim") != 0) continue;
    bool whole = !strcmp(cJSON_GetObjectItem(row, "name")->valuestring, "total");
    assert_true(number(row, "least_ms") <= number(row, "median_ms") && number(row, "ns_per_particle") >= 0);
    *(whole ? &total : &parts) += number(row, "least_ms");
    if (whole) median = number(row, "median_ms");
  }
  double steps = number(report, "substeps_per_second"), each = number(report, "substeps_per_second_with_a_surface_each");
  assert_float_equal(steps, number(report, "substeps") / 3 * 1000 / median, 1e-3 * steps);
  assert_true(each > 0 && each <= steps * 1.0001);
  assert_true(total > 0 && parts <= total); // the least of each stage; they are parts of one whole
  cJSON_Delete(report);
  folder_remove(folder);
}

// One row for each size, with each number of particles, about as many as asked for.
static void table_of_pictures(void **state) {
  (void)state;
  char folder[256];
  folder_make(folder);
  const char *scene = in(folder, "scene.json"), *output = in(folder, "bench.json");
  file_put_text(scene, SMALL_SCENE SMALL_END);
  LidoRun run = {.stdout_to = output};
  LIDO(&run, "bench", "--json", "--style", "points", "--particles", "500,4000", "--sizes", "40x30,64x64", "--frames",
       "1:3", scene);
  assert_int_equal(run.code, 0);
  cJSON *report = read_report(output);
  const cJSON *times = cJSON_GetObjectItem(report, "times");
  assert_int_equal(cJSON_GetArraySize(times), 4);
  assert_true(number(report, "pictures") == 2);
  for (int k = 0; k < 4; k++) {
    const cJSON *cell = cJSON_GetArrayItem(times, k);
    const double wanted = k % 2 ? 4000 : 500, particles = number(cell, "particles");
    assert_true(number(cell, "width") == (k < 2 ? 40 : 64) && number(cell, "height") == (k < 2 ? 30 : 64));
    assert_true(particles > 0.7 * wanted && particles < 1.4 * wanted);
    assert_true(number(cell, "median_ms") >= number(cell, "least_ms") && number(cell, "least_ms") > 0);
  }
  cJSON_Delete(report);
  LIDO(&run, "bench", "--json", "--style", "points", "--sizes", "40x30", "--frames", "1", scene);
  report = read_report(output);
  assert_int_equal(cJSON_GetArraySize(cJSON_GetObjectItem(report, "times")), 1);
  cJSON_Delete(report);
  folder_remove(folder);
}

static void check_varied_row(const cJSON *row, const cJSON *first, double scale, const char *sky) {
  const cJSON *values = cJSON_GetObjectItem(row, "values");
  assert_true(number(values, "render.points.scale") == scale);
  assert_string_equal(cJSON_GetObjectItem(values, "environment.sky")->valuestring, sky);
  assert_string_equal(cJSON_GetObjectItem(row, "style")->valuestring, "points");
  assert_true(number(row, "least_ms") > 0 && number(row, "median_ms") >= number(row, "least_ms"));
  assert_true(number(row, "with_simulation_median_ms") > number(row, "median_ms"));
  if (row == first) assert_true(number(row, "ratio") == 1 && number(row, "with_simulation_ratio") == 1);
  // One frame was counted: the medians are its own times.
  double ratio = number(row, "median_ms") / number(first, "median_ms");
  double with_simulation = number(row, "with_simulation_median_ms") / number(first, "with_simulation_median_ms");
  assert_true(fabs(number(row, "ratio") - ratio) < 1e-3 * ratio);
  assert_true(fabs(number(row, "with_simulation_ratio") - with_simulation) < 1e-3 * with_simulation);
}

// For each scene a row of each combination, the last key changing first; times of one frame, so ratios can be checked.
static void varied_pictures(void **state) {
  (void)state;
  char folder[256];
  folder_make(folder);
  const char *scene = in(folder, "scene.json"), *again = in(folder, "again.json"), *output = in(folder, "bench.json");
  file_put_text(scene, SMALL_SCENE SMALL_END);
  file_put_text(again, SMALL_SCENE SMALL_END);
  LidoRun run = {.stdout_to = output};
  LIDO(&run, "bench", "--json", "--style", "points", "--vary", "render.points.scale=1,2", scene, "--vary",
       "environment.sky=clear,gradient", again, "--size", "40x30", "--frames", "2:3");
  assert_int_equal(run.code, 0);
  cJSON *report = read_report(output);
  assert_true(number(report, "pictures") == 1 && number(report, "width") == 40 && number(report, "height") == 30);
  const cJSON *scenes = cJSON_GetObjectItem(report, "scenes");
  assert_int_equal(cJSON_GetArraySize(scenes), 2);
  for (int s = 0; s < 2; s++) {
    const cJSON *table = cJSON_GetArrayItem(scenes, s), *times = cJSON_GetObjectItem(table, "times");
    assert_string_equal(cJSON_GetObjectItem(table, "scene")->valuestring, s == 0 ? scene : again);
    assert_true(number(table, "particles") > 0 && number(table, "simulation_median_ms") > 0);
    assert_int_equal(cJSON_GetArraySize(times), 4);
    for (int k = 0; k < 4; k++)
      check_varied_row(cJSON_GetArrayItem(times, k), times->child, k < 2 ? 1 : 2, k % 2 ? "gradient" : "clear");
  }
  cJSON_Delete(report);
  folder_remove(folder);
}

// A line of the printed table for each combination, the first with ratios of 1.
static void varied_table(void **state) {
  (void)state;
  char folder[256], first[40], last[40];
  folder_make(folder);
  const char *scene = in(folder, "scene.json"), *output = in(folder, "bench.txt");
  file_put_text(scene, SMALL_SCENE SMALL_END);
  LidoRun run = {.stdout_to = output};
  LIDO(&run, "bench", "--vary", "light.colour=[1,1,1],[2,2,2]", "--vary", "render.style=points,refraction", "--size",
       "40x30", "--frames", "2", scene);
  assert_int_equal(run.code, 0);
  char *text = (char *)file_get(output, &(size_t){0});
  char *row = strstr(text, "[1,1,1] ");
  double picture, ratio, total, total_ratio;
  assert_non_null(row);
  assert_int_equal(sscanf(row, "%39s %39s %lf %lf %lf %lf", first, last, &picture, &ratio, &total, &total_ratio), 6);
  assert_string_equal(last, "points");
  assert_true(picture > 0 && total >= picture && ratio == 1 && total_ratio == 1);
  row = strrchr(text, '[');
  assert_non_null(row);
  assert_int_equal(sscanf(row, "%39s %39s", first, last), 2);
  assert_string_equal(first, "[2,2,2]");
  assert_string_equal(last, "refraction");
  assert_string_equal(strchr(row, '\n'), "\n"); // it is the last line
  free(text);
  folder_remove(folder);
}

// Bad values are told as --set tells them, of the last scene too, and before anything is drawn.
static void values_that_cannot_vary(void **state) {
  (void)state;
  char folder[256];
  folder_make(folder);
  const char *scene = in(folder, "scene.json"), *none = in(folder, "none.json"), *output = in(folder, "bench.txt");
  file_put_text(scene, SMALL_SCENE SMALL_END);
  const struct {
    const char *vary, *second, *message;
  } cases[] = {
      {"render.points.scal=1,2", scene, "--set render.points.scal=1: render.points.scal: unknown key"},
      {"render.points.scale=1,9", scene, "--set render.points.scale=9: render.points.scale: must be in [0.1, 5]"},
      {"render.refraction.smoothing=none,blur", scene, "render.refraction.smoothing: must be one of"},
      {"render.points.scale=1,2", none, "none.json"},
      {"simulation.cfl=0.5,1", scene, "--vary: only keys that change nothing but the picture"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    size_t size;
    LidoRun run = {.stdout_to = output};
    LIDO(&run, "bench", "--frames", "1", "--size", "40x30", "--vary", cases[i].vary, scene, cases[i].second);
    check_said(&run, 2, cases[i].message);
    free(file_get(output, &size));
    assert_int_equal(size, 0);
  }
  folder_remove(folder);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(figures_fit_each_other),  cmocka_unit_test(table_of_pictures),
      cmocka_unit_test(varied_pictures),         cmocka_unit_test(varied_table),
      cmocka_unit_test(values_that_cannot_vary),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
