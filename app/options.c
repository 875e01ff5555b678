// One table of options, read by the parser and by the help. An option that a command has no use for is refused, so that
// nothing given is silently ignored.
#include "app/options.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/commands.h"
#include "app/scene_table.h"
#include "app/style_grid.h"

// ---- Readers of values: each fills its part of the options, false and *cause when it cannot -------------------------

typedef bool OptionReader(Options *options, const char *value, char *cause, size_t size);

static bool whole(const char *text, const char **end, long low, long high, long *number) {
  if (*text < '0' || *text > '9') return false;
  char *stop;
  errno = 0;
  *number = strtol(text, &stop, 10);
  if (end)
    *end = stop;
  else if (*stop)
    return false;
  return errno == 0 && *number >= low && *number <= high;
}

/// Say why, and be false.
static bool because(char *cause, size_t size, const char *text) {
  snprintf(cause, size, "%s", text);
  return false;
}

static bool read_output(Options *options, const char *value, char *cause, size_t size) {
  options->output = value;
  return *value || because(cause, size, "must not be empty");
}

// "A,B,C": each value by `read`, which says where it ends, NULL: it is wrong.
static int read_list(const char *value, void *options,
                     const char *(*read)(void *options, int index, const char *text)) {
  for (int count = 0; count < OPTIONS_MOST;) {
    value = read(options, count++, value);
    if (!value || !*value) return value ? count : 0;
    if (*value++ != ',') return 0;
  }
  return 0;
}

static const char *one_style(void *options, int index, const char *text) {
  size_t length = strcspn(text, ",");
  for (int32_t i = 0; i < render_style_count(); i++) {
    const char *name = render_style_name(i);
    if (strlen(name) != length || strncmp(name, text, length) != 0) continue;
    ((Options *)options)->styles[index] = name;
    return text + length;
  }
  return NULL;
}

static bool read_style(Options *options, const char *value, char *cause, size_t size) {
  static const SceneField field = {.type = SCENE_STYLE};
  options->style_count = read_list(value, options, one_style);
  options->style = options->style_count > 0 ? options->styles[0] : NULL;
  if (options->style) return true;
  SceneChoices choices;
  char list[200];
  scene_choices(&field, &choices);
  scene_choices_list(&choices, list, sizeof list);
  snprintf(cause, size, "must be one of %s%s", list,
           strchr(value, ',') ? ", or up to 8 of them with commas between" : "");
  return false;
}

static bool read_size(Options *options, const char *value, char *cause, size_t size) {
  const char *rest;
  long width, height;
  if (!whole(value, &rest, 1, 16384, &width) || *rest != 'x' || !whole(rest + 1, NULL, 1, 16384, &height))
    return because(cause, size, "must be WIDTHxHEIGHT, each from 1 to 16384 pixels, like 1280x720");
  options->width = (int)width;
  options->height = (int)height;
  return true;
}

static const char *one_size(void *options, int index, const char *text) {
  long width, height;
  if (!whole(text, &text, 1, 16384, &width) || *text != 'x' || !whole(text + 1, &text, 1, 16384, &height)) return NULL;
  int *size = ((Options *)options)->sizes[index];
  size[0] = (int)width;
  size[1] = (int)height;
  return text;
}

static bool read_sizes(Options *options, const char *value, char *cause, size_t size) {
  options->size_count = read_list(value, options, one_size);
  return options->size_count > 0 ||
         because(cause, size, "must be up to 8 of WIDTHxHEIGHT with commas between, each from 1 to 16384 pixels");
}

static const char *one_count(void *options, int index, const char *text) {
  long count;
  if (!whole(text, &text, 1, 100000000, &count)) return NULL;
  ((Options *)options)->particles[index] = (int32_t)count;
  return text;
}

static bool read_particles(Options *options, const char *value, char *cause, size_t size) {
  options->particle_counts = read_list(value, options, one_count);
  return options->particle_counts > 0 ||
         because(cause, size, "must be up to 8 whole numbers in [1, 100000000] with commas between");
}

static bool read_frames(Options *options, const char *value, char *cause, size_t size) {
  const long most = 10000000;
  const char *rest = value;
  long first = 0, last = 0;
  bool good = *value == ':' || whole(value, &rest, 0, most, &first);
  if (good && *rest == ':') {
    good = !rest[1] || (whole(rest + 1, NULL, 1, most, &last) && last > first); // "A:" goes to the end
  } else {
    last = first;
    first = 0;
    good = good && !*rest && last > 0;
  }
  if (!good || !strcmp(value, ":"))
    return because(cause, size, "must be a number of frames, or A:B for the frames from A up to but not with B");
  options->first_frame = (int)first;
  options->last_frame = (int)last - 1;
  return true;
}

static bool read_fps(Options *options, const char *value, char *cause, size_t size) {
  char *end;
  options->fps = strtod(value, &end);
  bool good = end != value && !*end && options->fps >= 1 && options->fps <= 10000;
  return good || because(cause, size, "must be a number in [1, 10000]");
}

static bool read_context(Options *options, const char *value, char *cause, size_t size) {
  static const char *const names[] = {"auto", "glfw", "egl", "osmesa"};
  static const ContextKind kinds[] = {CONTEXT_AUTO, CONTEXT_GLFW, CONTEXT_EGL, CONTEXT_OSMESA};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++)
    if (strcmp(value, names[i]) == 0) {
      options->context = kinds[i];
      return true;
    }
  return because(cause, size, "must be one of auto, glfw, egl, osmesa");
}

static bool read_threads(Options *options, const char *value, char *cause, size_t size) {
  long threads;
  if (!whole(value, NULL, 1, 256, &threads)) return because(cause, size, "must be a whole number in [1, 256]");
  options->threads = (int)threads;
  return true;
}

static bool read_seed(Options *options, const char *value, char *cause, size_t size) {
  char *end;
  errno = 0;
  unsigned long long seed = *value >= '0' && *value <= '9' ? strtoull(value, &end, 10) : 0;
  bool good = *value >= '0' && *value <= '9' && !*end && errno == 0 && seed <= (UINT64_C(1) << 53) - 1;
  options->has_seed = true;
  options->seed = seed;
  return good || because(cause, size, "must be a whole number in [0, 9007199254740991]");
}

static bool read_set(Options *options, const char *value, char *cause, size_t size) {
  const char *equals = strchr(value, '=');
  if (!equals || equals == value) return because(cause, size, "must have the form key.path=value");
  options->sets[options->set_count++] = value; // room for one per argument
  return true;
}

static bool read_vary(Options *options, const char *value, char *cause, size_t size) {
  if (!vary_check(value, cause, size)) return false;
  for (int i = 0; i < options->vary_count; i++)
    if (vary_same_key(options->varies[i], value)) return because(cause, size, "this key varies already");
  if (options->vary_count == VARY_MOST_KEYS) return because(cause, size, "no more than 8 keys can vary at once");
  options->varies[options->vary_count++] = value;
  if (vary_combination_count(options->varies, options->vary_count) <= VARY_MOST_COMBINATIONS) return true;
  return because(cause, size, "these are more than 64 combinations");
}

static bool read_stats(Options *options, const char *value, char *cause, size_t size) {
  options->stats = value;
  return *value || because(cause, size, "must not be empty");
}

static bool read_camera(Options *options, const char *value, char *cause, size_t size) {
  float *camera = options->camera;
  bool good = true;
  const char *rest = value;
  for (int i = 0; good && i < 6; i++) {
    char *end;
    camera[i] = strtof(rest, &end);
    good = end != rest && isfinite(camera[i]) && fabsf(camera[i]) <= 10000 && *end == (i < 5 ? ',' : 0);
    rest = end + 1;
  }
  good = good && memcmp(camera, camera + 3, 3 * sizeof(float)) != 0;
  options->has_camera = true;
  return good || because(cause, size, "must be x,y,z,tx,ty,tz: where the eye is and what it looks at, two points in m");
}

static bool read_layer(Options *options, const char *value, char *cause, size_t size) {
  options->layer = value;
  return *value || because(cause, size, "must not be empty (lido list names the layers)");
}

#define SWITCH_READER(name)                                                                                            \
  static bool read_##name(Options *options, const char *value, char *cause, size_t size) {                             \
    (void)value, (void)cause, (void)size;                                                                              \
    options->name = true;                                                                                              \
    return true;                                                                                                       \
  }
SWITCH_READER(no_names)
SWITCH_READER(quiet)
SWITCH_READER(json)
SWITCH_READER(schema)
SWITCH_READER(reference)
SWITCH_READER(help)
SWITCH_READER(version)

// ---- The table ------------------------------------------------------------------------------------------------------

enum {
  WINDOW = 1 << COMMAND_window,
  RENDER = 1 << COMMAND_render,
  SIMULATE = 1 << COMMAND_simulate,
  CHECK = 1 << COMMAND_check,
  BENCH = 1 << COMMAND_bench,
  LIST = 1 << COMMAND_list,
  DRAWS = WINDOW | RENDER | BENCH,
  RUNS = DRAWS | SIMULATE,
  ALL = RUNS | CHECK | LIST
};

typedef struct Option {
  const char *name;
  char letter;       // 0: none
  const char *value; // what the help calls it; NULL: a switch
  int commands;      // that take it
  OptionReader *read;
  const char *help;
} Option;

// clang-format off
static const Option option_table[] = {
  {"output",    'o', "PATTERN",     RENDER | SIMULATE, read_output,    "where the frames go, like out/f_%05d.png"},
  {"style",     0,   "NAME,...",    DRAWS | CHECK,     read_style,     "how the water is drawn (see lido list)"},
  {"no-names",  0,   NULL,          RENDER,            read_no_names,  "several styles side by side without their names"},
  {"size",      0,   "WxH",         DRAWS,             read_size,      "pixels of a picture, default 1280x720"},
  {"sizes",     0,   "WxH,...",     BENCH,             read_sizes,     "a table: time of a picture, for each size …"},
  {"particles", 0,   "N,...",       BENCH,             read_particles, "… and each number of particles (about)"},
  {"vary",      0,   "KEY=A,B,...", BENCH,             read_vary,      "a table: pictures with each value of a scene's key"},
  {"frames",    0,   "N|A:B",       RUNS,              read_frames,    "the first N frames, or A up to B, without B"},
  {"fps",       0,   "F",           RUNS,              read_fps,       "frames per simulated second, default 60"},
  {"context",   0,   "NAME",        DRAWS,             read_context,   "where OpenGL is from: auto, glfw, egl, osmesa"},
  {"threads",   0,   "N",           RUNS,              read_threads,   "default: as many as there are cores"},
  {"seed",      0,   "N",           RUNS | CHECK,      read_seed,      "of every random choice, default: the scene's"},
  {"set",       0,   "KEY=VALUE",   RUNS | CHECK,      read_set,       "change the scene, like simulation.cfl=0.3"},
  {"camera",    0,   "X,Y,Z,X,Y,Z", DRAWS,             read_camera,    "where the eye is and what it looks at, in m"},
  {"layer",     0,   "NAME",        WINDOW | RENDER,   read_layer,     "an intermediate of the style (see lido list)"},
  {"stats",     0,   "FILE",        RUNS & ~BENCH,     read_stats,     "a line of JSON a frame: energy, errors, times"},
  {"json",      0,   NULL,          BENCH | LIST,      read_json,      "print JSON instead of a table"},
  {"schema",    0,   NULL,          CHECK,             read_schema,    "print the JSON schema of scenes instead"},
  {"reference", 0,   NULL,          CHECK,             read_reference, "print the table of all keys instead"},
  {"quiet",     'q', NULL,          ALL,               read_quiet,     "no progress, only errors"},
  {"help",      'h', NULL,          ALL,               read_help,      "print this"},
  {"version",   0,   NULL,          ALL,               read_version,   "print the version"},
};
// clang-format on
enum { OPTION_COUNT = sizeof option_table / sizeof *option_table };

static const struct {
  const char *name, *arguments, *summary;
} command_table[] = {
#define COMMAND_ROW(name, arguments, summary) {#name, arguments, summary},
    COMMANDS(COMMAND_ROW)
#undef COMMAND_ROW
};

// ---- Parsing --------------------------------------------------------------------------------------------------------

typedef struct Parser {
  Options *options;
  AppError *error;
  int argc, at;
  char **argv;
  const Option *given[OPTION_COUNT]; // options that were given, for the check against the command
  int given_count;
  int word_count; // of options->words: command and sources, or a source
} Parser;

/// Up to two strings from the command line go into the message, made printable.
static bool refuse(const Parser *parser, const char *format, const char *a, const char *b) {
  char first[120], second[400];
  text_printable(first, sizeof first, a, 80);
  text_printable(second, sizeof second, b, 300);
  return app_fail(parser->error, APP_BAD_INPUT, format, first, second);
}

static bool unknown_option(const Parser *parser, const char *name) {
  const char *names[OPTION_COUNT];
  for (int i = 0; i < OPTION_COUNT; i++) names[i] = option_table[i].name;
  const char *nearest = text_nearest(name, names, OPTION_COUNT);
  if (nearest) return refuse(parser, "--%s: unknown option, did you mean --%s?", name, nearest);
  return refuse(parser, "--%s: unknown option (see lido --help)", name, "");
}

/// Hand the value to the option. `value` NULL: it is the next argument, if the option takes one.
static bool take_option(Parser *parser, const Option *option, const char *value) {
  if (!option->value && value) return refuse(parser, "--%s: takes no value, got \"%s\"", option->name, value);
  if (option->value && !value) {
    if (parser->at + 1 >= parser->argc) return refuse(parser, "--%s: needs a value: %s", option->name, option->value);
    value = parser->argv[++parser->at];
  }
  bool seen = false;
  for (int i = 0; i < parser->given_count; i++) seen = seen || parser->given[i] == option;
  if (!seen) parser->given[parser->given_count++] = option;
  char cause[300], message[400], printable[120];
  if (option->read(parser->options, value ? value : "", cause, sizeof cause)) return true;
  // What was given is added, unless the reader has said so already.
  snprintf(message, sizeof message, "%s, got \"%s\"", cause, text_printable(printable, sizeof printable, value, 80));
  return refuse(parser, "--%s: %s", option->name, strchr(cause, '"') ? cause : message);
}

static bool take_long(Parser *parser, const char *argument) {
  size_t length = strcspn(argument, "=");
  const char *value = argument[length] ? argument + length + 1 : NULL;
  char name[64];
  snprintf(name, sizeof name, "%.*s", (int)(length < 63 ? length : 63), argument);
  for (int i = 0; i < OPTION_COUNT; i++)
    if (strcmp(option_table[i].name, name) == 0) return take_option(parser, &option_table[i], value);
  return unknown_option(parser, name);
}

/// -o FILE, -oFILE, -q
static bool take_short(Parser *parser, const char *argument) {
  for (int i = 0; i < OPTION_COUNT; i++) {
    const Option *option = &option_table[i];
    if (option->letter != argument[1]) continue;
    return take_option(parser, option, argument[2] ? argument + 2 : NULL);
  }
  return refuse(parser, "%s: unknown option (see lido --help)", argument, "");
}

static bool take_word(Parser *parser, const char *word) {
  parser->options->words[parser->word_count++] = word; // room for one per argument
  return true;
}

static bool take_arguments(Parser *parser) {
  bool only_words = false; // after "--"
  for (parser->at = 1; parser->at < parser->argc; parser->at++) {
    const char *argument = parser->argv[parser->at];
    bool good;
    if (only_words || argument[0] != '-' || !argument[1])
      good = take_word(parser, argument);
    else if (strcmp(argument, "--") == 0)
      good = only_words = true;
    else
      good = argument[1] == '-' ? take_long(parser, argument + 2) : take_short(parser, argument);
    if (!good) return false;
  }
  return true;
}

// ---- What the whole must be -----------------------------------------------------------------------------------------

/// Only a table of varied pictures is made of more than one scene.
static bool check_word_count(const Parser *parser) {
  const char *const *words = parser->options->words;
  bool several = parser->options->vary_count > 0 && parser->word_count > 0 && strcmp(words[0], "bench") == 0;
  return parser->word_count <= 2 || several || refuse(parser, "%s: one argument too many", words[2], "");
}

/// The first word is a command, or the scene for the window.
static bool find_command(Parser *parser) {
  Options *options = parser->options;
  const char *const *words = options->words;
  const char *names[COMMAND_COUNT];
  options->command = COMMAND_window;
  options->source = words[0];
  for (int i = 0; i < COMMAND_COUNT; i++) {
    names[i] = command_table[i].name;
    if (!words[0] || strcmp(words[0], names[i]) != 0) continue;
    options->command = i;
    options->source = words[1];
    return true;
  }
  if (parser->word_count == 0) return true;
  const char *nearest = text_nearest(words[0], names, COMMAND_COUNT);
  // A lone word that is neither a scene nor like a command is left to the scene's own message.
  char path[4096];
  if (parser->word_count == 1 && (!nearest || scene_find(words[0], path, sizeof path))) return true;
  if (nearest) return refuse(parser, "%s: unknown command, did you mean \"%s\"?", words[0], nearest);
  return refuse(parser, "%s: unknown command (see lido --help)", words[0], "");
}

/// Several styles are drawn side by side by lido render, as pictures.
static bool check_styles(const Parser *parser) {
  const Options *options = parser->options;
  const char *name = command_table[options->command].name;
  if (options->style_count < 2)
    return !options->no_names || refuse(parser, "--no-names: only several styles side by side have names", "", "");
  if (options->command != COMMAND_render) return refuse(parser, "--style: lido %s takes one style only", name, "");
  if (options->layer || options->stats)
    return refuse(parser, "--%s: not together with several styles", options->layer ? "layer" : "stats", "");
  StyleGrid grid = style_grid_make(options->style_count, options->width, options->height);
  return (grid.width <= 16384 && grid.height <= 16384) ||
         refuse(parser, "--size: that many pictures side by side must not be larger than 16384x16384", "", "");
}

/// What cannot be asked for together with --vary.
static bool check_vary(const Parser *parser) {
  const Options *options = parser->options;
  if (options->vary_count > 0 && (options->size_count > 0 || options->particle_counts > 0))
    return refuse(parser, "--vary: not together with --%s", options->size_count > 0 ? "sizes" : "particles", "");
  for (int k = 0; options->style && k < options->vary_count; k++)
    if (vary_same_key(options->varies[k], "render.style="))
      return refuse(parser, "--vary render.style: not together with --style", "", "");
  return true;
}

static void name_sources(Parser *parser) {
  Options *options = parser->options;
  bool commanded = options->words[0] && options->source != options->words[0];
  options->sources = options->words + (commanded ? 1 : 0);
  options->source_count = parser->word_count - (commanded ? 1 : 0);
  if (options->source_count > 0) return;
  options->sources[0] = options->source; // the default, or NULL
  options->source_count = options->source ? 1 : 0;
}

static bool check_against_command(Parser *parser) {
  Options *options = parser->options;
  const char *name = command_table[options->command].name;
  int bit = 1 << options->command;
  for (int i = 0; i < parser->given_count; i++)
    if (!(parser->given[i]->commands & bit))
      return refuse(parser, "--%s: lido %s has no use for it", parser->given[i]->name, name);
  bool text_only = options->schema || options->reference;
  if ((bit & LIST || text_only) && options->source)
    return refuse(parser, "%s: one argument too many", options->source, "");
  if (!options->source && bit & (WINDOW | BENCH)) options->source = SCENE_DEFAULT;
  if (!options->source && bit & (RENDER | SIMULATE | CHECK) && !text_only)
    return refuse(parser, "lido %s: which scene? Usage: lido %s", name,
                  options->command == COMMAND_render     ? "render SOURCE -o PATTERN"
                  : options->command == COMMAND_simulate ? "simulate SCENE -o PATTERN"
                                                         : "check SCENE");
  name_sources(parser);
  for (int i = 0; i < options->source_count; i++)
    if (!*options->sources[i]) return refuse(parser, "lido %s: the name of the scene is empty", name, "");
  if (!options->output && bit & (RENDER | SIMULATE))
    return refuse(parser, "lido %s: needs -o PATTERN, like -o %s", name,
                  options->command == COMMAND_render ? "out/f_%05d.png" : "out/p_%05d.vtk");
  return check_styles(parser) && check_vary(parser);
}

/// --style and --seed change the scene like a --set, and win over one.
static void add_sets(Options *options) {
  if (options->style) {
    snprintf(options->style_set, sizeof options->style_set, "render.style=%s", options->style);
    options->sets[options->set_count++] = options->style_set;
  }
  if (options->has_seed) {
    snprintf(options->seed_set, sizeof options->seed_set, "simulation.seed=%" PRIu64, options->seed);
    options->sets[options->set_count++] = options->seed_set;
  }
}

bool options_parse(Options *options, int argc, char **argv, AppError *error) {
  *options = (Options){.width = 1280, .height = 720, .last_frame = -1, .fps = 60, .context = CONTEXT_AUTO};
  options->sets = calloc((size_t)argc + 2, sizeof *options->sets);
  options->words = calloc((size_t)argc + 2, sizeof *options->words);
  if (!options->sets || !options->words) return app_fail(error, APP_FAILED, "out of memory");
  Parser parser = {.options = options, .error = error, .argc = argc, .argv = argv};
  if (!take_arguments(&parser) || !check_word_count(&parser) || !find_command(&parser)) return false;
  if (options->help || options->version) return true;
  if (!check_against_command(&parser)) return false;
  add_sets(options);
  return true;
}

void options_free(Options *options) {
  free(options->sets);
  free(options->words);
  options->sets = options->words = options->sources = NULL;
}

// ---- Help -----------------------------------------------------------------------------------------------------------

static void print_option(FILE *file, const Option *option) {
  char left[40], letter[8] = "    ";
  if (option->letter) snprintf(letter, sizeof letter, "-%c, ", option->letter);
  snprintf(left, sizeof left, "%s--%s%s%s", letter, option->name, option->value ? " " : "",
           option->value ? option->value : "");
  fprintf(file, "  %-28s %s\n", left, option->help);
}

static void print_notes(FILE *file, int command) {
  if (command == COMMAND_render)
    fprintf(file,
            "\nSOURCE is a scene, or particle files such as 'run/p_%%05d.vtk' (.vtk or .ply).\n"
            "PATTERN is 'out/f_%%05d.png' for pictures, 'film.mp4' for a film (needs ffmpeg),\n"
            "or '-' for raw RGB24 frames on the standard output.\n"
            "Several styles, like --style refraction,cartoon, are laid side by side in one picture, each as large\n"
            "as --size says.\n");
  if (command == COMMAND_simulate) fprintf(file, "\nPATTERN is 'out/p_%%05d.vtk' or 'out/p_%%05d.ply'.\n");
  if (command == COMMAND_bench)
    fprintf(file,
            "\nTables are of the pictures of --frames, of three where it is not given. --vary may be given for\n"
            "several keys of render, light, environment and camera, and for several scenes: every frame is\n"
            "simulated once and drawn with every combination of the values, %d of them at most.\n",
            VARY_MOST_COMBINATIONS);
}

static void print_command_help(FILE *file, int command) {
  const char *name = command_table[command].name, *arguments = command_table[command].arguments;
  fprintf(file, "Usage: lido %s%s%s [OPTION ...]\n\n%s\n\nOptions:\n", command == COMMAND_window ? "" : name,
          *arguments && command != COMMAND_window ? " " : "", arguments, command_table[command].summary);
  for (int i = 0; i < OPTION_COUNT; i++)
    if (option_table[i].commands & 1 << command) print_option(file, &option_table[i]);
  print_notes(file, command);
}

void options_print_help(FILE *file, int command) {
  if (command >= 0) {
    print_command_help(file, command);
    return;
  }
  fprintf(file, "Lido simulates water with particles and draws it.\n\nUsage:\n");
  for (int i = 0; i < COMMAND_COUNT; i++) {
    char left[64];
    snprintf(left, sizeof left, "lido %s%s%s", i == COMMAND_window ? "" : command_table[i].name,
             i != COMMAND_window && *command_table[i].arguments ? " " : "", command_table[i].arguments);
    fprintf(file, "  %-32s %s\n", left, command_table[i].summary);
  }
  fprintf(file, "\nSCENE is a JSON file or the name of a shipped scene; default %s.\n\nOptions:\n", SCENE_DEFAULT);
  for (int i = 0; i < OPTION_COUNT; i++) print_option(file, &option_table[i]);
  fprintf(file, "\nlido COMMAND --help tells more, lido list names what there is.\n"
                "Exit codes: 0 done, 1 it failed while running, 2 the command line or an input file is wrong.\n");
}
