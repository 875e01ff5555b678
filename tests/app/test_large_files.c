// Particle files that are large: read through a window, in little memory, and drawn. With the argument `long`: ten million
// particles through the program, whose peak of resident memory is what counts.
#define _DEFAULT_SOURCE // wait4, setenv
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "app/particle_file.h"
#include "app/source.h"
#include "make_particles.h"
#include "run_lido.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define LIDO_SANITIZED 1
#elif defined(__has_feature)
#define LIDO_SANITIZED (__has_feature(address_sanitizer) || __has_feature(thread_sanitizer))
#else
#define LIDO_SANITIZED 0
#endif

enum { MANY = 400000 }; // far more than the window holds

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

static void make(const char *path, MadeWater water) {
  if (!make_particles(path, &water)) fail_msg("%s cannot be written", path);
}

static void read_to_draw(const char *path, ParticleFile *file) {
  AppError error;
  if (!particle_file_read_to_draw(path, file, &error)) fail_msg("%s", error.message);
}

// ---- Through the window ------------------------------------------------------------------------------------------------------

// The bytes of a little-endian file are the positions themselves; the text means the same.
static void test_every_position_arrives(void **state) {
  (void)state;
  const char *binary = in(folder, "b.ply"), *text = in(folder, "t.ply");
  make(binary, (MadeWater){.count = MANY});
  make(text, (MadeWater){.count = MANY, .ascii = true});
  ParticleFile a, b;
  read_to_draw(binary, &a);
  read_to_draw(text, &b);
  assert_int_equal(a.count, MANY);
  assert_int_equal(b.count, MANY);
  size_t bytes = 3 * sizeof(float) * MANY, size;
  assert_true(memcmp(a.position, b.position, bytes) == 0);
  uint8_t *raw = file_get(binary, &size);
  assert_true(size > bytes && memcmp(raw + size - bytes, a.position, bytes) == 0);
  assert_null(a.velocity);
  free(raw);
  particle_file_free(&a);
  particle_file_free(&b);
}

// Arrays in a row, and cells between them that are passed over.
static void test_arrays_behind_skipped_ones_arrive(void **state) {
  (void)state;
  make(in(folder, "a.ply"), (MadeWater){.count = MANY, .shape = MADE_SLUMP, .velocity = true});
  ParticleFile made, read, drawn;
  read_to_draw(in(folder, "a.ply"), &made);
  uint32_t *id = malloc(MANY * sizeof *id);
  for (uint32_t i = 0; i < MANY; i++) id[i] = 7 * i;
  SimFrame frame = {.count = MANY,
                    .particle_radius = 0.01f,
                    .id = id,
                    .position = made.position,
                    .velocity = made.velocity,
                    .density = made.position};
  AppError error;
  assert_true(particle_file_write(in(folder, "a.vtk"), &frame, &error));
  if (!particle_file_read(in(folder, "a.vtk"), &read, &error)) fail_msg("%s", error.message);
  read_to_draw(in(folder, "a.vtk"), &drawn);
  const size_t vectors = 3 * sizeof(float) * MANY;
  assert_true(memcmp(read.position, made.position, vectors) == 0);
  assert_true(memcmp(read.velocity, made.velocity, vectors) == 0);
  assert_true(memcmp(read.id, id, MANY * sizeof *id) == 0);
  assert_true(memcmp(read.density, made.position, MANY * sizeof(float)) == 0);
  assert_true(memcmp(drawn.velocity, made.velocity, vectors) == 0);
  assert_null(drawn.id);
  assert_null(drawn.density);
  free(id);
  particle_file_free(&made);
  particle_file_free(&read);
  particle_file_free(&drawn);
}

static void refused(const char *path, const char *cause) {
  ParticleFile file;
  AppError error = {.code = APP_OK};
  assert_false(particle_file_read_to_draw(path, &file, &error));
  assert_int_equal(error.code, APP_BAD_INPUT);
  if (!strstr(error.message, cause)) fail_msg("expected '%s', got '%s'", cause, error.message);
}

// What is wrong far behind the beginning is told with its place.
static void test_errors_name_places_behind_the_window(void **state) {
  (void)state;
  const char *path = in(folder, "bad.ply");
  make(path, (MadeWater){.count = MANY, .ascii = true});
  FILE *stream = fopen(path, "r+b");
  assert_int_equal(fseek(stream, -4, SEEK_END), 0);
  fputs("x", stream);
  fclose(stream);
  char cause[64];
  snprintf(cause, sizeof cause, "bad.ply: line %d: element: a number was expected", MANY + 7);
  refused(path, cause);
  make(path, (MadeWater){.count = MANY});
  const uint32_t infinite = 0x7f800000; // in the last particle
  stream = fopen(path, "r+b");
  assert_int_equal(fseek(stream, -4, SEEK_END), 0);
  long place = ftell(stream);
  fwrite(&infinite, 1, 4, stream);
  fclose(stream);
  snprintf(cause, sizeof cause, "byte %ld: position of particle %d is not a finite", place, MANY - 1);
  refused(path, cause);
}

// ---- Drawn -------------------------------------------------------------------------------------------------------------------

// A picture of a file; bytes, rows of RGB.
static uint8_t *picture_of(const char *path, const char *style, size_t *size) {
  LidoRun run = {0};
  run.stdout_to = in(folder, "w.rgb");
  LIDO(&run, "render", path, "--style", style, "--size", "64x36", "--quiet", "-o", "-", "--camera", "2,1.5,5,2,0.3,1");
  check_done(&run);
  uint8_t *rgb = file_get(run.stdout_to, size);
  assert_int_equal(*size, 64 * 36 * 3);
  return rgb;
}

// Clear water has the colour of water, more blue than red, and is not dark.
static void expect_water(const uint8_t *rgb, const uint8_t *without, size_t size, const char *what) {
  int pixels = 0;
  double red = 0, blue = 0;
  for (size_t i = 0; i < size; i += 3) {
    int change = abs(rgb[i] - without[i]) + abs(rgb[i + 1] - without[i + 1]) + abs(rgb[i + 2] - without[i + 2]);
    if (change < 24) continue;
    pixels++;
    red += rgb[i];
    blue += rgb[i + 2];
  }
  if (pixels < 500) fail_msg("%s: only %d pixels differ from an empty picture", what, pixels);
  if (blue < 1.2 * red || blue < 80 * pixels)
    fail_msg("%s: red %.0f and blue %.0f are not water's", what, red / pixels, blue / pixels);
}

static void test_the_pictures_have_water(void **state) {
  (void)state;
  const MadeWater waters[3] = {
      {.count = 0}, {.count = 200000}, {.count = 30000, .shape = MADE_SLUMP, .velocity = true}};
  const char *const styles[] = {"points", "raycast"};
  for (int s = 0; s < 2; s++) {
    uint8_t *empty = NULL;
    for (int k = 0; k < 3; k++) {
      size_t size;
      make(in(folder, "w.ply"), waters[k]);
      uint8_t *rgb = picture_of(in(folder, "w.ply"), styles[s], &size);
      if (k > 0) expect_water(rgb, empty, size, styles[s]);
      if (k == 0)
        empty = rgb;
      else
        free(rgb);
    }
    free(empty);
  }
}

// ---- Memory ------------------------------------------------------------------------------------------------------------------

// From the file to the frame, as `lido render` does it before it draws. false: it failed.
static bool take_frame(const char *path, unsigned needs) {
  AppError error;
  Options options = {.source = path, .last_frame = -1, .fps = 60, .threads = 1};
  Source *source = source_open(&options, &error);
  bool fine = source && source_next(source, &error) == SOURCE_FRAME && source_frame(source, needs, &error);
  source_close(source);
  return fine;
}

// The most memory that a process of its own had resident for that.
static int64_t peak_of_frame(MadeWater water, unsigned needs) {
  const char *path = in(folder, "f.ply");
  make(path, water);
  pid_t process = fork();
  assert_true(process >= 0);
  if (process == 0) _exit(take_frame(path, needs) ? 0 : 1);
  int status;
  struct rusage usage;
  assert_true(wait4(process, &status, 0, &usage) == process);
  assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  return (int64_t)usage.ru_maxrss * 1024;
}

// With positions alone and where they bring velocities, which are measured together with the densities that spray takes.
static void expect_small_frames(int32_t count) {
  const unsigned needs[] = {SIM_NEED_NOTHING, SIM_NEED_DENSITY};
  for (int velocity = 0; velocity < 2; velocity++) {
    int64_t least = peak_of_frame((MadeWater){.count = 1000, .velocity = velocity}, needs[velocity]);
    int64_t most = peak_of_frame((MadeWater){.count = count, .velocity = velocity}, needs[velocity]);
    double each = (double)(most - least) / count;
    print_message("%.1f bytes a particle%s\n", each, velocity ? " that moves" : "");
    assert_true(each > (velocity ? 48 : 24)); // the positions, and velocities, of file and frame are certain
    if (each > (velocity ? 64 : 40)) fail_msg("%.1f bytes a particle", each);
  }
}

static void test_frames_take_little_memory(void **state) {
  (void)state;
#if LIDO_SANITIZED
  skip(); // which has its own memory beside every byte of the program's
#endif
  expect_small_frames(MANY);
}

// ---- Ten million -------------------------------------------------------------------------------------------------------------

enum { TEN_MILLION = 10000000 };

static void test_ten_million_in_a_frame_take_little_memory(void **state) {
  (void)state;
  expect_small_frames(TEN_MILLION);
}

static double now(void) {
  struct timespec at;
  clock_gettime(CLOCK_MONOTONIC, &at);
  return (double)at.tv_sec + 1e-9 * (double)at.tv_nsec;
}

static int64_t buffer_bytes(const char *stats) {
  size_t size;
  char *text = (char *)file_get(stats, &size), *number = strstr(text, "\"buffer_bytes\": ");
  assert_non_null(number);
  long long bytes = atoll(number + strlen("\"buffer_bytes\": "));
  free(text);
  return bytes;
}

// Draw it; the peak of memory in bytes, but for what OpenGL's buffers hold, which is in memory, too, because the software
// renderer draws. While there are buffers, that is: the file is gone then, and its share of the peak is measured above. The
// driver's own workings, which are not little, stay in.
static int64_t peak_without_buffers(MadeWater water, const char *style) {
  const char *path = in(folder, "l.ply"), *stats = in(folder, "l.json");
  make(path, water);
  LidoRun run = {0};
  double since = now();
  LIDO(&run, "render", path, "--style", style, "--size", "320x180", "--quiet", "--stats", stats, "-o",
       in(folder, "l.png"));
  check_done(&run);
  int64_t buffers = buffer_bytes(stats);
  print_message("%s, %d particles%s: %.1f s, peak %.0f MB, of which %.0f MB in buffers\n", style, water.count,
                water.velocity ? " that move" : "", now() - since, (double)run.peak / 1e6, (double)buffers / 1e6);
  return run.peak - buffers;
}

static void test_ten_million_are_drawn_in_little_memory(void **state) {
  (void)state;
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  setenv("LP_NUM_THREADS", "0", 1); // its own threads fall behind on a busy machine, and what they have to do piles up
  const char *const styles[] = {"points", "raycast"};
  for (int s = 0; s < 2; s++) {
    int64_t least = peak_without_buffers((MadeWater){.count = 1000, .velocity = true}, styles[s]);
    for (int velocity = 0; velocity < 2; velocity++) {
      MadeWater water = {.count = TEN_MILLION, .velocity = velocity};
      double each = (double)(peak_without_buffers(water, styles[s]) - least) / TEN_MILLION;
      print_message("%.1f bytes a particle\n", each);
      if (each > 64) fail_msg("%s: %.1f bytes a particle", styles[s], each);
    }
  }
}

static void test_ten_million_look_like_water(void **state) {
  (void)state;
  size_t size;
  make(in(folder, "e.ply"), (MadeWater){.count = 0});
  make(in(folder, "l.ply"), (MadeWater){.count = TEN_MILLION});
  uint8_t *empty = picture_of(in(folder, "e.ply"), "raycast", &size);
  uint8_t *rgb = picture_of(in(folder, "l.ply"), "raycast", &size);
  expect_water(rgb, empty, size, "raycast");
  free(rgb);
  free(empty);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      // First: what this process has had is there for its children to use again, and does not count.
      cmocka_unit_test_setup_teardown(test_frames_take_little_memory, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_every_position_arrives, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_arrays_behind_skipped_ones_arrive, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_errors_name_places_behind_the_window, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_the_pictures_have_water, set_up, tear_down),
  };
  const struct CMUnitTest long_tests[] = {
      cmocka_unit_test_setup_teardown(test_ten_million_in_a_frame_take_little_memory, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_ten_million_are_drawn_in_little_memory, set_up, tear_down),
      cmocka_unit_test_setup_teardown(test_ten_million_look_like_water, set_up, tear_down),
  };
  if (argc > 1 && strcmp(argv[1], "long") == 0) return cmocka_run_group_tests(long_tests, NULL, NULL);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
