// The command line: what is understood, and what is refused with which message.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdlib.h>
#include <string.h>

#include "app/commands.h"
#include "app/scene.h"
#include "app/style_grid.h"

enum { MOST_WORDS = 32 };

/// Split at spaces (no quoting) and parse.
static bool parse(Options *options, const char *line, AppError *error) {
  static char copy[512];
  static char *argv[MOST_WORDS];
  int argc = 0;
  strcpy(copy, line);
  for (char *rest = copy, *word; (word = strtok_r(rest, " ", &rest));) argv[argc++] = word;
  *error = (AppError){APP_OK, ""};
  return options_parse(options, argc, argv, error);
}

static Options parsed(const char *line) {
  Options options;
  AppError error;
  if (!parse(&options, line, &error)) fail_msg("%s: %s", line, error.message);
  return options;
}

static void test_commands_and_sources(void **state) {
  (void)state;
  const struct {
    const char *line;
    int command;
    const char *source;
  } cases[] = {
      {"lido", COMMAND_window, SCENE_DEFAULT},
      {"lido still_pool", COMMAND_window, "still_pool"},
      {"lido window", COMMAND_window, SCENE_DEFAULT},
      {"lido window still_pool", COMMAND_window, "still_pool"},
      {"lido --size 10x10 still_pool", COMMAND_window, "still_pool"},
      {"lido render a.json -o x", COMMAND_render, "a.json"},
      {"lido -o x render a.json", COMMAND_render, "a.json"},
      {"lido --fps 30 render -ox a.json", COMMAND_render, "a.json"},
      {"lido simulate a.json --output=x", COMMAND_simulate, "a.json"},
      {"lido check a.json", COMMAND_check, "a.json"},
      {"lido check --schema", COMMAND_check, NULL},
      {"lido bench", COMMAND_bench, SCENE_DEFAULT},
      {"lido bench --json a.json", COMMAND_bench, "a.json"},
      {"lido list", COMMAND_list, NULL},
      {"lido check -- --odd", COMMAND_check, "--odd"},
      {"lido -- check -", COMMAND_check, "-"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    Options options = parsed(cases[i].line);
    assert_int_equal(options.command, cases[i].command);
    if (cases[i].source)
      assert_string_equal(options.source, cases[i].source);
    else
      assert_null(options.source);
    options_free(&options);
  }
}

static void test_defaults(void **state) {
  (void)state;
  Options o = parsed("lido");
  assert_int_equal(o.width, 1280);
  assert_int_equal(o.height, 720);
  assert_int_equal(o.first_frame, 0);
  assert_int_equal(o.last_frame, -1);
  assert_true(o.fps == 60);
  assert_int_equal(o.context, CONTEXT_AUTO);
  assert_true(o.threads == 0 && !o.has_seed && !o.has_camera && o.set_count == 0);
  assert_true(!o.quiet && !o.json && !o.help && !o.version && !o.style && !o.output && !o.stats && !o.layer);
  options_free(&o);
}

static void test_values(void **state) {
  (void)state;
  Options o =
      parsed("lido render s --output a.png --style points --size=64x48 --frames 10:20 --fps 24.5 --context osmesa "
             "--threads 3 --quiet");
  assert_string_equal(o.output, "a.png");
  assert_string_equal(o.style, "points");
  assert_true(o.width == 64 && o.height == 48 && o.first_frame == 10 && o.last_frame == 19);
  assert_true(o.fps == 24.5 && o.context == CONTEXT_OSMESA && o.threads == 3 && o.quiet);
  options_free(&o);

  o = parsed("lido render s -o - --camera -1,2.5,3,0,-0.5,1e1 --layer depth --stats s.jsonl --seed 7 --set a.b=1=2");
  const float camera[6] = {-1, 2.5f, 3, 0, -0.5f, 10};
  assert_string_equal(o.output, "-");
  assert_true(o.has_camera);
  assert_memory_equal(o.camera, camera, sizeof camera);
  assert_string_equal(o.layer, "depth");
  assert_string_equal(o.stats, "s.jsonl");
  assert_true(o.has_seed && o.seed == 7);
  assert_int_equal(o.set_count, 2);
  assert_string_equal(o.sets[0], "a.b=1=2");
  assert_string_equal(o.sets[1], "simulation.seed=7");
  options_free(&o);
}

static void test_several_styles(void **state) {
  (void)state;
  Options o = parsed("lido render s -o x --style cartoon,points,cartoon --no-names --set render.style=refraction");
  assert_int_equal(o.style_count, 3);
  assert_string_equal(o.styles[0], "cartoon");
  assert_string_equal(o.styles[1], "points");
  assert_string_equal(o.styles[2], "cartoon");
  assert_true(o.no_names);
  assert_string_equal(o.style, "cartoon"); // a scene is loaded with the first one
  assert_string_equal(o.sets[1], "render.style=cartoon");
  options_free(&o);
  o = parsed("lido render s -o x --style points,cartoon --style raycast"); // the last one wins, as with other options
  assert_int_equal(o.style_count, 1);
  assert_string_equal(o.style, "raycast");
  options_free(&o);
}

/// As square as can be, filled row by row; every byte of every picture once.
static void test_grids_of_styles(void **state) {
  (void)state;
  const int expected[9][2] = {{0}, {1, 1}, {2, 1}, {2, 2}, {2, 2}, {3, 2}, {3, 2}, {3, 3}, {3, 3}};
  for (int count = 1; count <= 8; count++) {
    const StyleGrid grid = style_grid_make(count, 5, 4);
    assert_true(grid.columns == expected[count][0] && grid.rows == expected[count][1]);
    assert_true(grid.width == 5 * grid.columns && grid.height == 4 * grid.rows);
    uint8_t all[15 * 12 * 3] = {0}, cell[5 * 4 * 3];
    for (int i = 0; i < count; i++) {
      memset(cell, i + 1, sizeof cell);
      style_grid_put(&grid, i, cell, all);
    }
    for (int y = 0; y < grid.height; y++)
      for (int x = 0; x < 3 * grid.width; x++) {
        int place = y / 4 * grid.columns + x / 15;
        assert_int_equal(all[3 * y * grid.width + x], place < count ? place + 1 : 0);
      }
  }
}

static void test_scenes_of_a_varied_table(void **state) {
  (void)state;
  Options o = parsed("lido bench a b --vary render.exposure=1,2 c --vary light.colour=[1,2,3],[4,5,6]");
  assert_int_equal(o.source_count, 3);
  assert_string_equal(o.source, "a");
  assert_string_equal(o.sources[0], "a");
  assert_string_equal(o.sources[2], "c");
  assert_int_equal(o.vary_count, 2);
  assert_int_equal(vary_combination_count(o.varies, o.vary_count), 4);
  options_free(&o);
  o = parsed("lido bench --vary render.exposure=1");
  assert_int_equal(o.source_count, 1);
  assert_string_equal(o.sources[0], SCENE_DEFAULT);
  options_free(&o);
  o = parsed("lido still_pool");
  assert_int_equal(o.source_count, 1);
  assert_string_equal(o.sources[0], "still_pool");
  options_free(&o);
}

/// A comma in brackets or in a string ends no value, and the last key changes first.
static void test_values_that_vary(void **state) {
  (void)state;
  const struct {
    const char *vary;
    int count;
    const char *last;
  } cases[] = {
      {"render.a=1", 1, "render.a=1"},
      {"render.a=1,2=3", 2, "render.a=2=3"},
      {"render.a=[1,2],[3,[4,5]]", 2, "render.a=[3,[4,5]]"},
      {"render.a={\"x\":1,\"y\":[2,3]},4", 2, "render.a=4"},
      {"render.a=\"],\\\",[\",b", 2, "render.a=b"},
      {"render.a=],b", 2, "render.a=b"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char cause[300];
    assert_true(vary_check(cases[i].vary, cause, sizeof cause));
    assert_int_equal(vary_value_count(cases[i].vary), cases[i].count);
    char *set = vary_set(cases[i].vary, cases[i].count - 1);
    assert_string_equal(set, cases[i].last);
    free(set);
  }
  const char *const varies[] = {"render.a=1,2", "render.b=1,2,3"};
  const int places[6][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 0}, {1, 1}, {1, 2}};
  assert_int_equal(vary_combination_count(varies, 2), 6);
  for (int c = 0; c < 6; c++)
    for (int k = 0; k < 2; k++) assert_int_equal(vary_place(varies, 2, k, c), places[c][k]);
}

static void test_style_and_seed_win_over_set(void **state) {
  (void)state;
  Options o = parsed("lido --style points --seed 3 --set render.style=x --set simulation.seed=1");
  assert_int_equal(o.set_count, 4);
  assert_string_equal(o.sets[2], "render.style=points");
  assert_string_equal(o.sets[3], "simulation.seed=3");
  options_free(&o);
}

static void test_frames(void **state) {
  (void)state;
  const struct {
    const char *line;
    int first, last;
  } cases[] = {
      {"lido --frames 1", 0, 0},  {"lido --frames 60", 0, 59}, {"lido --frames 5:6", 5, 5},
      {"lido --frames :4", 0, 3}, {"lido --frames 7:", 7, -1}, {"lido --frames 0:10000000", 0, 9999999},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    Options o = parsed(cases[i].line);
    assert_int_equal(o.first_frame, cases[i].first);
    assert_int_equal(o.last_frame, cases[i].last);
    options_free(&o);
  }
}

static void test_help_and_version_need_nothing_else(void **state) {
  (void)state;
  const char *const lines[] = {"lido --help",      "lido render --help", "lido -h render",
                               "lido simulate -h", "lido --version",     "lido check --version"};
  for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
    Options o = parsed(lines[i]);
    assert_true(o.help || o.version);
    options_free(&o);
  }
}

static void test_refusals(void **state) {
  (void)state;
  const struct {
    const char *line, *message;
  } cases[] = {
      {"lido --styl points", "--styl: unknown option, did you mean --style?"},
      {"lido --xyzzy", "--xyzzy: unknown option (see lido --help)"},
      {"lido -x", "-x: unknown option (see lido --help)"},
      {"lido rendr a.json -o x", "rendr: unknown command, did you mean \"render\"?"},
      {"lido lsit", "lsit: unknown command, did you mean \"list\"?"},
      {"lido qqqqqq a.json", "qqqqqq: unknown command (see lido --help)"},
      {"lido check a b", "b: one argument too many"},
      {"lido list a", "a: one argument too many"},
      {"lido check --schema a", "a: one argument too many"},
      {"lido check", "lido check: which scene? Usage: lido check SCENE"},
      {"lido render -o x", "lido render: which scene? Usage: lido render SOURCE -o PATTERN"},
      {"lido render a.json", "lido render: needs -o PATTERN, like -o out/f_%05d.png"},
      {"lido simulate a.json", "lido simulate: needs -o PATTERN, like -o out/p_%05d.vtk"},
      {"lido simulate a.json -o", "--output: needs a value: PATTERN"},
      {"lido simulate a.json --output=", "--output: must not be empty, got \"\""},
      {"lido --quiet=1", "--quiet: takes no value, got \"1\""},
      {"lido -qx", "--quiet: takes no value, got \"x\""},
      {"lido list --size 10x10", "--size: lido list has no use for it"},
      {"lido -o x", "--output: lido window has no use for it"},
      {"lido --json", "--json: lido window has no use for it"},
      {"lido --style blue", "--style: must be one of points, refraction, raycast, cartoon, heightfield, got \"blue\""},
      {"lido render a -o x --style points,blue", "--style: must be one of points, refraction, raycast, cartoon, heightfield, or up to 8 of them with commas between, got \"points,blue\""},
      {"lido render a -o x --style points,", "--style: must be one of points, refraction, raycast, cartoon, heightfield, or up to 8 of them with commas between, got \"points,\""},
      {"lido render a -o x --style ,", "--style: must be one of points, refraction, raycast, cartoon, heightfield, or up to 8 of them with commas between, got \",\""},
      {"lido render a -o x --style=", "--style: must be one of points, refraction, raycast, cartoon, heightfield, got \"\""},
      {"lido render a -o x --style pointsx", "--style: must be one of points, refraction, raycast, cartoon, heightfield, got \"pointsx\""},
      {"lido render a -o x --style points,points,points,points,points,points,points,points,points", "--style: must be one of points, refraction, raycast, cartoon, heightfield, or up to 8 of them with commas between, got \"points,points,points,points,points,points,points,points,points\""},
      {"lido render a -o x --style points,cartoon --layer depth", "--layer: not together with several styles"},
      {"lido render a -o x --stats s --style points,cartoon", "--stats: not together with several styles"},
      {"lido render a -o x --style points,cartoon --size 8193x10", "--size: that many pictures side by side must not be larger than 16384x16384"},
      {"lido render a -o x --style points --no-names", "--no-names: only several styles side by side have names"},
      {"lido --style points,cartoon", "--style: lido window takes one style only"},
      {"lido bench --style points,cartoon", "--style: lido bench takes one style only"},
      {"lido check a --style points,cartoon", "--style: lido check takes one style only"},
      {"lido bench --no-names", "--no-names: lido bench has no use for it"},
      {"lido --size 10", "--size: must be WIDTHxHEIGHT, each from 1 to 16384 pixels, like 1280x720, got \"10\""},
      {"lido --threads 0", "--threads: must be a whole number in [1, 256], got \"0\""},
      {"lido --fps nan", "--fps: must be a number in [1, 10000], got \"nan\""},
      {"lido --seed -1", "--seed: must be a whole number in [0, 9007199254740991], got \"-1\""},
      {"lido --context vulkan", "--context: must be one of auto, glfw, egl, osmesa, got \"vulkan\""},
      {"lido bench --sizes 3x", "--sizes: must be up to 8 of WIDTHxHEIGHT with commas between, each from 1 to 16384 pixels, got \"3x\""},
      {"lido bench --sizes 4x4,", "--sizes: must be up to 8 of WIDTHxHEIGHT with commas between, each from 1 to 16384 pixels, got \"4x4,\""},
      {"lido bench --particles 1,0", "--particles: must be up to 8 whole numbers in [1, 100000000] with commas between, got \"1,0\""},
      {"lido bench --particles 1,2,3,4,5,6,7,8,9", "--particles: must be up to 8 whole numbers in [1, 100000000] with commas between, got \"1,2,3,4,5,6,7,8,9\""},
      {"lido bench --vary render.exposure", "--vary: must have the form key.path=value,value,... and no value may be empty, got \"render.exposure\""},
      {"lido bench --vary render.exposure=", "--vary: must have the form key.path=value,value,... and no value may be empty, got \"render.exposure=\""},
      {"lido bench --vary render.exposure=1,,2", "--vary: must have the form key.path=value,value,... and no value may be empty, got \"render.exposure=1,,2\""},
      {"lido bench --vary render.exposure=1,", "--vary: must have the form key.path=value,value,... and no value may be empty, got \"render.exposure=1,\""},
      {"lido bench --vary =1", "--vary: must have the form key.path=value,value,... and no value may be empty, got \"=1\""},
      {"lido bench --vary simulation.cfl=1", "--vary: only keys that change nothing but the picture can vary, those of render, light, environment and camera, got \"simulation.cfl=1\""},
      {"lido bench --vary lights.sun=1", "--vary: only keys that change nothing but the picture can vary, those of render, light, environment and camera, got \"lights.sun=1\""},
      {"lido bench --vary render=1", "--vary: only keys that change nothing but the picture can vary, those of render, light, environment and camera, got \"render=1\""},
      {"lido bench --vary light.a=1 --vary light.a=2", "--vary: this key varies already, got \"light.a=2\""},
      {"lido bench --vary light.a=1,2,3,4,5,6,7,8 --vary light.b=1,2,3,4,5,6,7,8,9", "--vary: these are more than 64 combinations, got \"light.b=1,2,3,4,5,6,7,8,9\""},
      {"lido bench --vary light.a=1 --sizes 4x4", "--vary: not together with --sizes"},
      {"lido bench --particles 9 --vary light.a=1", "--vary: not together with --particles"},
      {"lido bench --vary render.style=points --style points", "--vary render.style: not together with --style"},
      {"lido render a.json -o b_%d.png --vary light.a=1", "--vary: lido render has no use for it"},
      {"lido bench a b", "b: one argument too many"},
      {"lido check a b --vary light.a=1", "b: one argument too many"},
      {"lido a bench b --vary light.a=1", "b: one argument too many"},
      {"lido render a.json -o b_%d.png --sizes 4x4", "--sizes: lido render has no use for it"},
      {"lido --set simulation", "--set: must have the form key.path=value, got \"simulation\""},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    Options options;
    AppError error;
    bool good = parse(&options, cases[i].line, &error);
    options_free(&options);
    if (good) fail_msg("accepted: %s", cases[i].line);
    assert_string_equal(error.message, cases[i].message);
    assert_int_equal(error.code, APP_BAD_INPUT);
  }
}

static void test_values_out_of_range(void **state) {
  (void)state;
  const char *const lines[] = {
      "lido --size 0x5",
      "lido --size 5x0",
      "lido --size 16385x5",
      "lido --size 5x5x5",
      "lido --size -5x5",
      "lido --size x5",
      "lido --size 5x",
      "lido --frames 0",
      "lido --frames -1",
      "lido --frames :",
      "lido --frames 5:5",
      "lido --frames 5:4",
      "lido --frames a",
      "lido --frames 1:b",
      "lido --frames 1:2:3",
      "lido --frames 99999999999999999999",
      "lido --fps 0",
      "lido --fps -1",
      "lido --fps 1e9",
      "lido --fps inf",
      "lido --fps 5x",
      "lido --threads 257",
      "lido --threads 1.5",
      "lido --threads two",
      "lido --seed 1e3",
      "lido --seed 99999999999999999999",
      "lido --seed 9007199254740992",
      "lido --camera 1,2,3",
      "lido --camera 1,2,3,4,5",
      "lido --camera 1,2,3,4,5,6,7",
      "lido --camera 1,2,3,4,5,x",
      "lido --camera 1,2,3,1,2,3",
      "lido --camera 1,2,3,4,5,nan",
      "lido --camera 1,2,3,4,5,1e30",
      "lido --camera ,,,,,",
  };
  for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
    Options options;
    AppError error;
    bool good = parse(&options, lines[i], &error);
    options_free(&options);
    if (good) fail_msg("accepted: %s", lines[i]);
    assert_int_equal(error.code, APP_BAD_INPUT);
  }
}

static void test_no_argument_at_all(void **state) {
  (void)state;
  Options options;
  AppError error;
  char *none[] = {NULL};
  assert_true(options_parse(&options, 0, none, &error));
  assert_int_equal(options.command, COMMAND_window);
  options_free(&options);
}

static void test_control_characters_are_not_echoed(void **state) {
  (void)state;
  Options options;
  AppError error;
  assert_false(parse(&options, "lido --a\x1b[2J\nb", &error));
  options_free(&options);
  for (const char *c = error.message; *c; c++) assert_true(*c >= ' ');
}

static void test_help_names_every_command_and_option(void **state) {
  (void)state;
  const char *const options[] = {"output",    "style", "size",   "frames",  "fps",   "context",   "threads",
                                 "seed",      "set",   "camera", "layer",   "stats", "json",      "schema",
                                 "reference", "quiet", "help",   "version", "sizes", "particles", "vary",
                                 "no-names"};
  char *text = NULL;
  size_t size;
  FILE *file = open_memstream(&text, &size);
  assert_non_null(file);
  options_print_help(file, -1);
  for (int i = 0; i < COMMAND_COUNT; i++) options_print_help(file, i);
  fclose(file);
  for (size_t i = 0; i < sizeof options / sizeof *options; i++) {
    char name[32];
    snprintf(name, sizeof name, "--%s", options[i]);
    if (!strstr(text, name)) fail_msg("the help does not name %s", name);
  }
#define NAMED(name, arguments, summary) assert_non_null(strstr(text, summary));
  COMMANDS(NAMED)
#undef NAMED
  // It fits a terminal.
  for (const char *line = text, *end; (end = strchr(line, '\n')); line = end + 1) assert_true(end - line <= 100);
  free(text);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_commands_and_sources),
      cmocka_unit_test(test_defaults),
      cmocka_unit_test(test_values),
      cmocka_unit_test(test_several_styles),
      cmocka_unit_test(test_grids_of_styles),
      cmocka_unit_test(test_scenes_of_a_varied_table),
      cmocka_unit_test(test_values_that_vary),
      cmocka_unit_test(test_style_and_seed_win_over_set),
      cmocka_unit_test(test_frames),
      cmocka_unit_test(test_help_and_version_need_nothing_else),
      cmocka_unit_test(test_refusals),
      cmocka_unit_test(test_values_out_of_range),
      cmocka_unit_test(test_no_argument_at_all),
      cmocka_unit_test(test_control_characters_are_not_echoed),
      cmocka_unit_test(test_help_names_every_command_and_option),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
