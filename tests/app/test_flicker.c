// Water at rest looks at rest: how much a pixel changes from one frame of the still pool to the next, in the style
// "refraction", through the program, and how many pixels change their tone in the style "cartoon". With "long": the scene as it ships; otherwise coarser, smaller and shorter.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "app/image.h"
#include "run_lido.h"

/// Of the mean change over all pixels and channels between successive frames, in 1/255.
#define MOST_CHANGE 1.0

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

/// Raw pictures, one behind the other.
typedef struct Film {
  uint8_t *bytes;
  size_t picture; // bytes of one
  int count;
} Film;

static Film film_of(const char *frames, int count, const char *size, int pixels, const char *setting) {
  const char *path = in(folder, "raw.rgb");
  LidoRun run = {.stdout_to = path};
  LIDO(&run, "render", "configs/still_pool.json", "--style", "refraction", "--frames", frames, "--size", size, "--set",
       setting, "-q", "-o", "-");
  check_done(&run);
  size_t bytes;
  Film film = {.bytes = file_get(path, &bytes), .picture = 3 * (size_t)pixels, .count = count};
  assert_int_equal(bytes, film.picture * (size_t)count);
  return film;
}

typedef struct Change {
  double mean; // over all pixels, channels and pairs of frames
  double most; // of a pair's mean
  int largest; // of one pixel and channel
} Change;

static Change change_of(const Film *film) {
  Change change = {0};
  for (int i = 1; i < film->count; i++) {
    const uint8_t *a = film->bytes + (size_t)(i - 1) * film->picture, *b = a + film->picture;
    double sum = 0;
    for (size_t k = 0; k < film->picture; k++) {
      int difference = abs(a[k] - b[k]);
      sum += difference;
      if (difference > change.largest) change.largest = difference;
    }
    sum /= (double)film->picture;
    if (sum > change.most) change.most = sum;
    change.mean += sum / (film->count - 1);
  }
  return change;
}

// A picture of nothing would not change either: the least and the most of the first picture's bytes are far apart.
static void check_shows_something(const Film *film) {
  int least = 255, most = 0;
  for (size_t k = 0; k < film->picture; k++) {
    if (film->bytes[k] < least) least = film->bytes[k];
    if (film->bytes[k] > most) most = film->bytes[k];
  }
  assert_true(most - least > 100);
}

static void check_film(Film film) {
  check_shows_something(&film);
  Change change = change_of(&film);
  print_message("change between frames in 1/255: mean %.3f, of the worst pair %.3f, largest of a channel %d\n",
                change.mean, change.most, change.largest);
  assert_true(change.mean > 0); // the water is simulated, and never quite at rest
  assert_true(change.most < MOST_CHANGE);
  free(film.bytes);
}

static void test_still_pool(void **state) {
  (void)state;
  check_film(film_of("120:180", 60, "480x360", 480 * 360, "simulation.particle_radius=0.0175"));
}

static void test_coarse_pool(void **state) {
  (void)state;
  check_film(film_of("120:126", 6, "160x120", 160 * 120, "simulation.particle_radius=0.035"));
}

// ---- Drawn -----------------------------------------------------------------------------------------------------------

static Image tones_of(int frame) {
  char path[320];
  snprintf(path, sizeof path, "%s/tone_%d.pfm", folder, frame);
  Image image;
  AppError error;
  if (!image_read_pfm(path, &image, &error)) fail_msg("%s", error.message);
  assert_int_equal(image.channels, 1);
  return image;
}

// Frames 1/30 s apart, 4 s after the start.
static void check_tones(const char *size, const char *setting) {
  LidoRun run = {0};
  LIDO(&run, "render", "configs/still_pool.json", "--style", "cartoon", "--fps", "30", "--frames", "120:122", "--size",
       size, "--set", setting, "--layer", "tone", "-q", "-o", in(folder, "tone_%d.pfm"));
  check_done(&run);
  Image before = tones_of(120), after = tones_of(121);
  int water = 0, changed = 0;
  for (int i = 0; i < before.width * before.height; i++) {
    water += before.values[i] > 0;
    changed += before.values[i] != after.values[i];
  }
  print_message("%d of %d pixels of water change their tone: %.3f %%\n", changed, water, 100.0 * changed / water);
  assert_true(water > before.width * before.height / 20);
  assert_true(1000 * changed < water);
  image_free(&before);
  image_free(&after);
}

static void test_drawn_pool(void **state) {
  (void)state;
  check_tones("480x360", "simulation.particle_radius=0.0175");
}

static void test_coarse_drawn_pool(void **state) {
  (void)state;
  check_tones("240x180", "simulation.particle_radius=0.035");
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {cmocka_unit_test_setup_teardown(test_coarse_pool, set_up, tear_down),
                                     cmocka_unit_test_setup_teardown(test_coarse_drawn_pool, set_up, tear_down)};
  const struct CMUnitTest long_tests[] = {cmocka_unit_test_setup_teardown(test_still_pool, set_up, tear_down),
                                          cmocka_unit_test_setup_teardown(test_drawn_pool, set_up, tear_down)};
  if (argc > 1 && strcmp(argv[1], "long") == 0) return cmocka_run_group_tests(long_tests, NULL, NULL);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
