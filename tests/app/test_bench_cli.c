// lido bench through the program: its JSON is JSON, and its figures fit each other.
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
  double parts = 0, total = 0;
  cJSON_ArrayForEach(row, cJSON_GetObjectItem(report, "rows")) {
    if (strcmp(cJSON_GetObjectItem(row, "group")->valuestring, "sim") != 0) continue;
    bool whole = !strcmp(cJSON_GetObjectItem(row, "name")->valuestring, "total");
    assert_true(number(row, "least_ms") <= number(row, "median_ms") && number(row, "ns_per_particle") >= 0);
    *(whole ? &total : &parts) += number(row, "least_ms");
  }
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

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(figures_fit_each_other), cmocka_unit_test(table_of_pictures)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
