// Files that are whole or not there, and names of numbered files.
#define _XOPEN_SOURCE 700 // realpath

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "app/output.h"
#include "app/pattern.h"
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

static bool write_text(const char *path, const char *text, AppError *error) {
  OutputFile *output = output_open(path, error);
  if (!output) return false;
  fputs(text, output_file(output));
  return output_commit(output, error);
}

static void check_holds(const char *path, const char *text) {
  size_t size;
  uint8_t *bytes = file_get(path, &size);
  assert_string_equal((char *)bytes, text);
  free(bytes);
}

// ---- Atomic files ----------------------------------------------------------------------------------------------------------

static void test_appears_when_committed(void **state) {
  (void)state;
  AppError error;
  const char *path = in(folder, "a.txt");
  OutputFile *output = output_open(path, &error);
  assert_non_null(output);
  fputs("new", output_file(output));
  fflush(output_file(output));
  assert_false(file_exists(path));
  assert_true(file_exists(output_part(output)));
  assert_true(output_commit(output, &error));
  check_holds(path, "new");
  assert_int_equal(folder_count(folder), 1);
}

static void test_abort_keeps_the_old(void **state) {
  (void)state;
  AppError error;
  const char *path = in(folder, "a.txt");
  assert_true(write_text(path, "old", &error));
  OutputFile *output = output_open(path, &error);
  fputs("new", output_file(output));
  output_abort(output);
  output_abort(NULL);
  check_holds(path, "old");
  assert_int_equal(folder_count(folder), 1);
}

static void test_makes_folders(void **state) {
  (void)state;
  AppError error;
  assert_true(write_text(in(folder, "one//two/three/a.txt"), "x", &error));
  assert_true(file_exists(in(folder, "one/two/three/a.txt")));
}

static void test_folder_that_is_a_file(void **state) {
  (void)state;
  AppError error;
  file_put_text(in(folder, "file"), "x");
  assert_false(write_text(in(folder, "file/a.txt"), "x", &error));
  assert_int_equal(error.code, APP_FAILED);
  assert_non_null(strstr(error.message, "file: cannot make this folder: a file of that name is there"));
  assert_false(write_text(in(folder, ""), "x", &error));
  assert_non_null(strstr(error.message, "Is a directory"));
}

// /dev/full takes every byte into its buffer's hands and then says that the disk is full.
static void test_full_disk(void **state) {
  (void)state;
  AppError error;
  assert_int_equal(symlink("/dev/full", in(folder, "full")), 0);
  assert_false(write_text(in(folder, "full"), "short", &error));
  assert_non_null(strstr(error.message, "full: cannot be written: No space left on device"));
  // The same when the failing write was long before the end.
  OutputFile *output = output_open(in(folder, "full"), &error);
  for (int i = 0; i < 100000; i++) fputc('x', output_file(output));
  assert_false(output_commit(output, &error));
  assert_non_null(strstr(error.message, "No space left on device"));
  // A device is written to, not replaced.
  assert_int_equal(symlink("/dev/null", in(folder, "null")), 0);
  assert_true(write_text(in(folder, "null"), "x", &error));
  struct stat status;
  assert_int_equal(stat("/dev/null", &status), 0);
  assert_true(S_ISCHR(status.st_mode));
}

static void test_links_stay_links(void **state) {
  (void)state;
  AppError error;
  assert_true(write_text(in(folder, "sub/real.txt"), "old", &error));
  assert_int_equal(symlink("sub/real.txt", in(folder, "link.txt")), 0);
  assert_true(write_text(in(folder, "link.txt"), "new", &error));
  check_holds(in(folder, "sub/real.txt"), "new");
  struct stat status;
  assert_int_equal(lstat(in(folder, "link.txt"), &status), 0);
  assert_true(S_ISLNK(status.st_mode));
}

static void test_longest_name(void **state) {
  (void)state;
  AppError error;
  char name[256];
  memset(name, 'a', 255);
  name[255] = '\0';
  assert_true(write_text(in(folder, name), "x", &error));
  char longer[6000];
  memset(longer, 'a', sizeof longer - 1);
  longer[sizeof longer - 1] = '\0';
  assert_false(write_text(longer, "x", &error));
  assert_non_null(strstr(error.message, "too long"));
}

static void test_leftovers(void **state) {
  (void)state;
  AppError error;
  OutputFile *outputs[20];
  char name[32];
  for (int i = 0; i < 20; i++) {
    snprintf(name, sizeof name, "f%d", i);
    outputs[i] = output_open(in(folder, name), &error);
    assert_non_null(outputs[i]);
  }
  output_abort(outputs[3]);
  assert_int_equal(folder_count(folder), 19);
  output_remove_leftovers();
  assert_true(folder_count(folder) <= 4); // sixteen are remembered
  for (int i = 0; i < 20; i++)
    if (i != 3) output_abort(outputs[i]);
  assert_int_equal(folder_count(folder), 0);
}

// ---- Patterns --------------------------------------------------------------------------------------------------------------

static void check_expands(const char *text, int64_t number, const char *expected) {
  Pattern pattern;
  AppError error;
  if (!pattern_parse(&pattern, text, &error)) fail_msg("%s", error.message);
  char *name = pattern_expand(&pattern, number);
  assert_string_equal(name, expected);
  free(name);
}

static void test_expand(void **state) {
  (void)state;
  check_expands("out/f_%05d.png", 12, "out/f_00012.png");
  check_expands("%d", 0, "0");
  check_expands("f%03d", 12345, "f12345");
  check_expands("100%%_%04d%%.vtk", 7, "100%_0007%.vtk");
  check_expands("a.png", 7, "a.png");
  check_expands("50%%", 7, "50%");
  check_expands("%018d", 5, "000000000000000005");
}

static void test_refuse(void **state) {
  (void)state;
  static const char *const wrong[] = {"",     "%",    "a%",   "%s",      "%5d",   "%-05d",  "%0d",
                                      "%05i", "%n%d", "%d%d", "%05d_%d", "%019d", "%0999d", "%05d/a",
                                      "%ld",  "%*d",  "%x.y", "a%05",    "%.3f",  "%1$d"};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
    Pattern pattern;
    AppError error = {.code = APP_OK};
    if (pattern_parse(&pattern, wrong[i], &error)) fail_msg("'%s' was taken", wrong[i]);
    assert_int_equal(error.code, APP_BAD_INPUT);
    assert_true(strlen(error.message) > 10);
  }
  char longer[6000];
  memset(longer, 'a', sizeof longer - 1);
  longer[sizeof longer - 1] = '\0';
  Pattern pattern;
  AppError error;
  assert_false(pattern_parse(&pattern, longer, &error));
}

static int64_t list(const char *text, int64_t **numbers) {
  Pattern pattern;
  AppError error;
  assert_true(pattern_parse(&pattern, in(folder, text), &error));
  return pattern_list(&pattern, numbers, &error);
}

static void test_series(void **state) {
  (void)state;
  static const char *const names[] = {"p_00010.vtk",
                                      "p_00000.vtk",
                                      "p_00002.vtk",
                                      "p_123456.vtk",
                                      "p_012345.vtk",
                                      "p_3.vtk",
                                      "p_0000x.vtk",
                                      "p_00004.ply",
                                      "q_00005.vtk",
                                      "p_.vtk",
                                      "p_00006.vtk~",
                                      "p_-0001.vtk",
                                      "p_99999999999999999999.vtk"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) file_put_text(in(folder, names[i]), "x");
  int64_t *numbers;
  // A gap is allowed; five digits at least, more only where the number needs them.
  assert_int_equal(list("p_%05d.vtk", &numbers), 4);
  const int64_t expected[] = {0, 2, 10, 123456};
  assert_memory_equal(numbers, expected, sizeof expected);
  free(numbers);
  assert_int_equal(list("p_%d.vtk", &numbers), 2); // 3 and 123456
  assert_int_equal(numbers[0], 3);
  free(numbers);
  assert_int_equal(list("none_%d.vtk", &numbers), 0);
  assert_null(numbers);
  assert_int_equal(list("nowhere/p_%d.vtk", &numbers), -1);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test_setup_teardown(test_appears_when_committed, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_abort_keeps_the_old, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_makes_folders, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_folder_that_is_a_file, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_full_disk, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_links_stay_links, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_longest_name, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_leftovers, set_up, tear_down),
      cmocka_unit_test(test_expand),
      cmocka_unit_test(test_refuse),
      cmocka_unit_test_setup_teardown(test_series, set_up, tear_down),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
