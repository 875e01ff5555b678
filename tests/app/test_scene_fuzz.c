// Deterministic mutations of the shipped scenes: whatever comes, the scene loads or is refused in one line, and what
// loads prints to something that loads again. Crashes and overruns are for the sanitizers to find.
#include "scene_helpers.h"

enum { ROUNDS = 4000, MOST_TEXT = 32 * 1024 };

static const char *const files[] = {"configs/dam_break.json", "configs/double_dam_break.json", "configs/glass.json",
                                    "configs/pontoon.json",   "configs/spouts.json",           "configs/steps.json",
                                    "configs/still_pool.json"};

// Pieces that are more likely to hurt than random bytes.
static const char *const pieces[] = {
    "1e999",
    "-1e999",
    "1e-400",
    "-0",
    "null",
    "true",
    "[]",
    "{}",
    "[0,0,0]",
    "\"",
    "\\",
    "\"\\ud800\"",
    "\"x\"",
    "NaN",
    "\"events\":[{\"type\":\"push\"}],",
    "\"type\":\"sphere\",",
    "\"fluid\":[{}],",
    "\"type\":\"emitter\",",
    "\"type\":\"mesh\",\"file\":\"x.obj\",",
    "\"motion\":\"scripted\",",
    "\"obstacle\":0,",
    "\"keys\":[{\"time\":1,\"position\":[0,0,0]}],",
    "\"name\":\"pontoon\",",
    "4294967296",
    "0.5",
    ",",
    ":",
    "{",
    "}",
    "[",
    "]",
    "\xff",
    "\xc3\xa9",
    "\"version\":1,",
    "\"min\":[0,0,0],",
    "[[[[[[[[",
    "}}}}",
};

// xorshift64 (Marsaglia 2003)
static uint64_t next_random(uint64_t *seed) {
  *seed ^= *seed << 13;
  *seed ^= *seed >> 7;
  *seed ^= *seed << 17;
  return *seed;
}

static size_t below(uint64_t *seed, size_t limit) {
  return limit ? (size_t)(next_random(seed) % limit) : 0;
}

/// Put `count` bytes in place of `removed` ones.
static size_t splice(char *text, size_t size, size_t at, size_t removed, const char *bytes, size_t count) {
  if (removed > size - at) removed = size - at;
  if (size - removed + count > MOST_TEXT) return size;
  memmove(text + at + count, text + at + removed, size - at - removed);
  memcpy(text + at, bytes, count);
  return size - removed + count;
}

/// Damage anywhere: most of it is no JSON any more.
static size_t damage(char *text, size_t size, uint64_t *seed) {
  size_t at = below(seed, size + 1);
  char byte = (char)next_random(seed);
  const char *piece = pieces[below(seed, sizeof pieces / sizeof *pieces)];
  char copy[64];
  size_t length = below(seed, sizeof copy);
  switch (below(seed, 6)) {
  case 0:
    return splice(text, size, at, 1, &byte, 1);
  case 1:
    return splice(text, size, at, below(seed, 40), "", 0);
  case 2:
    return splice(text, size, at, 0, piece, strlen(piece));
  case 3:
    return splice(text, size, at, below(seed, 8), piece, strlen(piece));
  case 4:
    return at; // cut short
  default:     // a stretch of itself somewhere else
    if (length > size - at) length = size - at;
    memcpy(copy, text + at, length);
    return splice(text, size, below(seed, size + 1), 0, copy, length);
  }
}

/// Another digit in some number, or another value behind some colon: mostly still JSON, often still a scene.
static size_t change_value(char *text, size_t size, uint64_t *seed) {
  size_t at = below(seed, size + 1);
  if (below(seed, 4) > 0) {
    while (at < size && (text[at] < '0' || text[at] > '9')) at++;
    if (at < size) text[at] = (char)('0' + below(seed, 10));
    return size;
  }
  while (at < size && text[at] != ':') at++;
  if (at == size) return size;
  size_t end = ++at;
  while (end < size && !strchr(",}\n", text[end])) end++;
  const char *piece = pieces[below(seed, 12)]; // the first ones are values
  return splice(text, size, at, end - at, piece, strlen(piece));
}

static size_t mutate(char *text, size_t size, uint64_t *seed, int round) {
  return round % 2 ? damage(text, size, seed) : change_value(text, size, seed);
}

static void check_refusal(const AppError *error) {
  assert_int_equal(error->code, APP_BAD_INPUT);
  size_t length = strlen(error->message);
  assert_true(length > 8 && length < sizeof error->message);
  for (size_t i = 0; i < length; i++) assert_true((unsigned char)error->message[i] >= ' ');
}

static void check_loaded(Scene *scene) {
  char *text = scene_print(scene);
  Scene again = load(text);
  char *second = scene_print(&again);
  assert_string_equal(text, second);
  free(text);
  free(second);
  scene_free(&again);
  scene_free(scene);
}

static void test_mutations_load_or_are_refused(void **state) {
  (void)state;
  uint64_t seed = 88172645463325252u;
  int loaded = 0, refused_count = 0;
  for (size_t f = 0; f < sizeof files / sizeof *files; f++) {
    char *original = read_all(files[f]);
    for (int round = 0; round < ROUNDS; round++) {
      // Exactly as large as its text, so that reading beyond it is caught.
      static char work[MOST_TEXT];
      size_t size = strlen(original);
      memcpy(work, original, size);
      for (size_t n = 1 + below(&seed, 3); n > 0; n--) size = mutate(work, size, &seed, round);
      char *exact = malloc(size ? size : 1);
      assert_non_null(exact);
      memcpy(exact, work, size);
      Scene scene;
      AppError error = {APP_OK, ""};
      if (scene_load_text(&scene, "m.json", exact, size, NULL, 0, &error)) {
        check_loaded(&scene);
        loaded++;
      } else {
        check_refusal(&error);
        refused_count++;
      }
      free(exact);
    }
    free(original);
  }
  // Both happen, or this tests nothing.
  assert_true(loaded > ROUNDS / 4 && refused_count > ROUNDS);
}

static void test_every_cut_is_refused(void **state) {
  (void)state;
  for (size_t f = 0; f < sizeof files / sizeof *files; f++) {
    char *text = read_all(files[f]);
    size_t end = strlen(text);
    while (end > 0 && text[end - 1] != '}') end--;
    for (size_t size = 0; size < end; size++) {
      char *cut = malloc(size + 1);
      assert_non_null(cut);
      memcpy(cut, text, size);
      Scene scene;
      AppError error = {APP_OK, ""};
      assert_false(scene_load_text(&scene, "m.json", cut, size, NULL, 0, &error));
      check_refusal(&error);
      free(cut);
    }
    free(text);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_mutations_load_or_are_refused),
      cmocka_unit_test(test_every_cut_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
