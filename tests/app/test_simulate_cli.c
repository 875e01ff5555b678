// lido simulate through the program: the same bytes for any number of threads, nothing outside the container, statistics
// that are JSON, and a Ctrl-C that leaves whole files only.
//
// With the argument `long` the dam break runs for its first second; without, a short piece of it.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>
#include <cmocka.h>

#include "app/particle_file.h"
#include "run_lido.h"
#include "small_scene.h"

static char folder[256];
static char scene[512];
static bool everything;

static int set_up(void **state) {
  (void)state;
  folder_make(folder);
  snprintf(scene, sizeof scene, "%s/scene.json", folder);
  file_put_text(scene, SMALL_SCENE SMALL_EVENTS SMALL_END);
  return 0;
}

static int tear_down(void **state) {
  (void)state;
  folder_remove(folder);
  return 0;
}

static void read_frame(const char *pattern, int number, ParticleFile *file) {
  char name[64];
  snprintf(name, sizeof name, pattern, number);
  AppError error;
  if (!particle_file_read(in(folder, name), file, &error)) fail_msg("%s", error.message);
}

static void check_inside(const ParticleFile *file) {
  assert_true(file->has_container);
  for (int i = 0; i < file->count; i++) {
    for (int k = 0; k < 3; k++) {
      float x = file->position[3 * i + k];
      if (!(x >= file->container.min[k] && x <= file->container.max[k]))
        fail_msg("frame %d: particle %u lies outside: %g along axis %d", (int)file->index, file->id[i], (double)x, k);
    }
  }
}

// Simulate twice, with one thread and with two, and compare all files.
static void check_threads(const char *source, int frames, const char *ending) {
  char count[16], pattern[2][32], name[2][64];
  snprintf(count, sizeof count, "%d", frames);
  for (int t = 0; t < 2; t++) {
    snprintf(pattern[t], sizeof pattern[t], "t%d/p_%%05d.%s", t + 1, ending);
    LidoRun run = {0};
    LIDO(&run, "simulate", source, "--frames", count, "--threads", t ? "2" : "1", "-q", "-o", in(folder, pattern[t]));
    check_done(&run);
    assert_int_equal(run.lines, 0);
    assert_int_equal(folder_count(in(folder, t ? "t2" : "t1")), frames);
  }
  for (int i = 0; i < frames; i++) {
    for (int t = 0; t < 2; t++) snprintf(name[t], sizeof name[t], "t%d/p_%05d.%s", t + 1, i, ending);
    if (!files_equal(in(folder, name[0]), in(folder, name[1]))) fail_msg("frame %d differs between 1 and 2 threads", i);
    ParticleFile file;
    AppError error;
    assert_true(particle_file_read(in(folder, name[0]), &file, &error));
    assert_int_equal(file.index, i);
    assert_true(file.count > 0);
    check_inside(&file);
    particle_file_free(&file);
  }
}

static void test_dam_break(void **state) {
  (void)state;
  check_threads("configs/dam_break.json", everything ? 60 : 4, "vtk");
}

static void test_small(void **state) {
  (void)state;
  check_threads(scene, 12, "ply");
}

// Particles keep their place from file to file, also when more are poured in.
static void test_ids(void **state) {
  (void)state;
  LidoRun run = {0};
  LIDO(&run, "simulate", scene, "--frames", "12", "-q", "-o", in(folder, "p_%05d.vtk"));
  check_done(&run);
  ParticleFile first, last;
  read_frame("p_%05d.vtk", 0, &first);
  read_frame("p_%05d.vtk", 11, &last);
  assert_true(last.count > first.count);
  for (int i = 0; i < first.count; i++) assert_int_equal(first.id[i], last.id[i]);
  assert_true(memcmp(first.position, last.position, (size_t)first.count * 12) != 0);
  assert_float_equal(last.time, 11.0 / 60, 1e-9);
  particle_file_free(&first);
  particle_file_free(&last);
}

// A part of the film holds the same frames as the whole.
static void test_part(void **state) {
  (void)state;
  LidoRun run = {0};
  LIDO(&run, "simulate", scene, "-q", "-o", in(folder, "whole/p_%05d.vtk")); // 0.2 s
  check_done(&run);
  assert_int_equal(folder_count(in(folder, "whole")), 12);
  LIDO(&run, "simulate", scene, "--frames", "5:8", "-q", "-o", in(folder, "part/p_%05d.vtk"));
  check_done(&run);
  assert_int_equal(folder_count(in(folder, "part")), 3);
  for (int i = 5; i < 8; i++) {
    char a[64], b[64];
    snprintf(a, sizeof a, "whole/p_%05d.vtk", i);
    snprintf(b, sizeof b, "part/p_%05d.vtk", i);
    assert_true(files_equal(in(folder, a), in(folder, b)));
  }
  LIDO(&run, "simulate", scene, "--frames", "12:", "-q", "-o", in(folder, "none/p_%05d.vtk"));
  assert_int_equal(run.code, 2);
  assert_non_null(strstr(run.text, "the scene ends with frame 11"));
}

// ---- Statistics ----------------------------------------------------------------------------------------------------------------

static double number(const cJSON *object, const char *key) {
  const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
  if (!cJSON_IsNumber(item)) fail_msg("%s is missing or no number", key);
  return item->valuedouble;
}

static void test_stats(void **state) {
  (void)state;
  LidoRun run = {0};
  LIDO(&run, "simulate", scene, "--frames", "2:10", "-q", "-o", in(folder, "p_%05d.vtk"), "--stats",
       in(folder, "logs/s.jsonl"));
  check_done(&run);
  size_t size;
  char *text = (char *)file_get(in(folder, "logs/s.jsonl"), &size);
  int lines = 0;
  for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n"), lines++) {
    const char *end;
    cJSON *object = cJSON_ParseWithOpts(line, &end, true);
    if (!object) fail_msg("line %d is no JSON: %s", lines + 1, line);
    assert_float_equal(number(object, "frame"), 2 + lines, 0);
    assert_float_equal(number(object, "time"), (2 + lines) / 60.0, 1e-8);
    assert_true(number(object, "particles") > 100);
    assert_true(number(object, "substeps") >= 1);
    assert_true(number(object, "max_speed") > 0);
    const cJSON *energy = cJSON_GetObjectItem(object, "energy"), *error = cJSON_GetObjectItem(object, "density_error");
    assert_true(number(energy, "kinetic") > 0);
    assert_true(number(energy, "potential") < 100); // also against tilted gravity
    assert_true(number(error, "mean") >= 0 && number(error, "mean") <= number(error, "max"));
    assert_true(number(cJSON_GetObjectItem(object, "stage_ms"), "density") > 0);
    assert_true(cJSON_IsNull(cJSON_GetObjectItem(object, "pass_ms")));
    cJSON_Delete(object);
  }
  assert_int_equal(lines, 8);
  assert_int_equal(folder_count(in(folder, "logs")), 1);
  free(text);
}

// ---- Ended early ---------------------------------------------------------------------------------------------------------------

static void test_interrupt(void **state) {
  (void)state;
  LidoRun run = {.interrupt_when = in(folder, "out/p_00002.vtk")};
  LIDO(&run, "simulate", "configs/dam_break.json", "--frames", "100000", "-q", "-o", in(folder, "out/p_%05d.vtk"),
       "--stats", in(folder, "s.jsonl"));
  assert_int_equal(run.code, 1);
  assert_int_equal(run.lines, 1);
  int written = 0;
  assert_int_equal(sscanf(run.text, "lido: interrupted: %d of 100000 frames written", &written), 1);
  assert_true(written >= 3);
  // Exactly the whole files, nothing half.
  assert_int_equal(folder_count(in(folder, "out")), written);
  for (int i = 0; i < written; i++) {
    ParticleFile file;
    read_frame("out/p_%05d.vtk", i, &file);
    assert_true(file.count > 10000);
    particle_file_free(&file);
  }
  size_t size;
  char *text = (char *)file_get(in(folder, "s.jsonl"), &size);
  int lines = 0;
  for (const char *c = text; *c; c++) lines += *c == '\n';
  assert_int_equal(lines, written);
  free(text);
}

// When a run fails in the middle, the frames until then stay.
static void test_failure(void **state) {
  (void)state;
  char text[8192] = SMALL_SCENE ", \"events\": [";
  for (int i = 0; i <= SIM_MAX_PUSHES; i++)
    snprintf(text + strlen(text), sizeof text - strlen(text),
             "%s{\"type\": \"push\", \"time\": 0.055, \"origin\": [0, 0, 0], \"direction\": [0, 0, -1], "
             "\"acceleration\": [0, 1, 0]}",
             i ? ", " : "");
  strcat(text, "]}");
  file_put_text(scene, text);
  LidoRun run = {0};
  LIDO(&run, "simulate", scene, "-q", "-o", in(folder, "out/p_%05d.ply"), "--stats", in(folder, "s.jsonl"));
  assert_int_equal(run.code, 1);
  assert_int_equal(run.lines, 1);
  assert_non_null(strstr(run.text, "; 4 of 12 frames are in "));
  assert_int_equal(folder_count(in(folder, "out")), 4);
  assert_int_equal(folder_count(folder), 3); // scene.json, out/, s.jsonl
}

static void test_seed(void **state) {
  (void)state;
  static const char *const seeds[] = {"5", "5", "6"};
  char name[32];
  LidoRun run = {0};
  for (int i = 0; i < 3; i++) {
    snprintf(name, sizeof name, "%d.vtk", i);
    LIDO(&run, "simulate", scene, "--frames", "2:3", "-q", "--set", "simulation.jitter=0.2", "--seed", seeds[i], "-o",
         in(folder, name));
    check_done(&run);
  }
  assert_true(files_equal(in(folder, "0.vtk"), in(folder, "1.vtk")));
  assert_false(files_equal(in(folder, "0.vtk"), in(folder, "2.vtk")));
}

// On a terminal and off it, quiet or not: what is said is said on stderr, and little of it.
static void test_words(void **state) {
  (void)state;
  const char *out = in(folder, "stdout");
  LidoRun run = {.stdout_to = out};
  LIDO(&run, "simulate", scene, "--frames", "3", "-o", in(folder, "p_%05d.vtk"));
  check_done(&run);
  assert_non_null(strstr(run.text, "lido: 3 frames written to "));
  assert_null(strchr(run.text, '\033'));
  size_t size;
  free(file_get(out, &size));
  assert_int_equal(size, 0);
}

// Water where a body stands is left out, and the program says so once, unless it is to be quiet.
static void test_left_out(void **state) {
  (void)state;
  const char *full = in(folder, "full.json");
  file_put_text(full, SMALL_SCENE ", \"obstacles\": [{\"type\": \"box\", \"size\": [0.08, 0.08, 0.08],"
                                  " \"position\": [0.12, 0.12, 0.2]}]" SMALL_END);
  const char *const quiet[] = {"--threads=1", "-q"};
  for (int q = 0; q < 2; q++) {
    LidoRun runs[3] = {{0}};
    LIDO(&runs[0], "simulate", full, "--frames", "2", quiet[q], "-o", in(folder, "p_%05d.vtk"));
    LIDO(&runs[1], "render", full, "--frames", "1", "--size", "32x32", quiet[q], "-o", in(folder, "f.png"));
    LIDO(&runs[2], "bench", full, "--frames", "1", "--size", "32x32", quiet[q]);
    for (int i = 0; i < 3; i++) {
      check_done(&runs[i]);
      const char *said = strstr(runs[i].text, "full.json: ");
      if (q && said) fail_msg("said in spite of -q: %s", runs[i].text);
      if (q) continue;
      int count = 0;
      if (!said || sscanf(said, "full.json: %d particles at the start left out, in an obstacle", &count) != 1)
        fail_msg("not said: %s", runs[i].text);
      // 2 x 2 x 2 of the lattice in the box of two spacings, more where centres would be too near its faces.
      assert_in_range(count, 8, 64);
      assert_null(strstr(said + 1, "full.json: ")); // once
    }
  }
  LidoRun run = {0};
  LIDO(&run, "simulate", scene, "--frames", "2", "-o", in(folder, "p_%05d.vtk"));
  assert_null(strstr(run.text, "left out"));
}

static void test_terminal(void **state) {
  (void)state;
  if (!lido_has_terminals()) skip();
  LidoRun run = {.terminal = true};
  LIDO(&run, "simulate", scene, "--frames", "3", "-o", in(folder, "p_%05d.vtk"));
  check_done(&run);
  assert_non_null(strstr(run.text, "\r"));
  assert_non_null(strstr(run.text, "3/3 frames"));
  assert_non_null(strstr(run.text, "\033[36m[########################]"));
  assert_non_null(strstr(run.text, "\033[Klido: 3 frames written to ")); // the bar is gone before something is said
  run = (LidoRun){.terminal = true, .no_colour = true};
  LIDO(&run, "simulate", scene, "--frames", "3", "-o", in(folder, "p_%05d.vtk"));
  assert_non_null(strstr(run.text, "[########################] 3/3 frames"));
  assert_null(strstr(run.text, "\033[36m"));
  // No bar where nothing has begun.
  run = (LidoRun){.terminal = true};
  LIDO(&run, "simulate", scene, "--frames", "3", "-q", "-o", in(folder, "nowhere/p.vtk"));
  assert_int_equal(run.code, 2);
  assert_int_equal(strncmp(run.text, "lido: -o: ", 10), 0);
}

int main(int argc, char **argv) {
  everything = argc > 1 && strcmp(argv[1], "long") == 0;
  const struct CMUnitTest long_tests[] = {cmocka_unit_test_setup_teardown(test_dam_break, set_up, tear_down)};
  const struct CMUnitTest tests[] = {
      cmocka_unit_test_setup_teardown(test_dam_break, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_small, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_ids, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_part, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_stats, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_interrupt, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_failure, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_seed, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_words, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_left_out, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_terminal, set_up, tear_down),
  };
  if (everything) return cmocka_run_group_tests(long_tests, NULL, NULL);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
