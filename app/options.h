// The command line: parsed into one plain struct, checked before any command runs.
#ifndef LIDO_APP_OPTIONS_H
#define LIDO_APP_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "app/app.h"
#include "app/context.h"
#include "app/vary.h"

enum { OPTIONS_MOST = 8 }; ///< values in a list

/// What the command line says. Strings point into argv.
typedef struct Options {
  int command;                 ///< CommandIndex of commands.h
  const char *source;          ///< SCENE or SOURCE; SCENE_DEFAULT for window and bench when none is given
  const char **sources;        ///< (source_count) `source` first; more than one only with --vary
  int source_count;
  const char *output;          ///< -o: pattern, film or "-"
  const char *style;           ///< --style, the first of several, or NULL: the scene's
  const char *styles[OPTIONS_MOST]; ///< (style_count) --style: more than one only for lido render
  int style_count;
  bool no_names;               ///< --no-names: several styles side by side without their names
  int width, height;           ///< --size, default 1280x720
  int sizes[OPTIONS_MOST][2];  ///< (size_count) --sizes
  int size_count;
  int32_t particles[OPTIONS_MOST]; ///< (particle_counts) --particles
  int particle_counts;
  const char *varies[VARY_MOST_KEYS]; ///< (vary_count) "key.path=a,b,c" of --vary
  int vary_count;
  int first_frame, last_frame; ///< --frames N: 0 … N − 1, A:B: A … B − 1; last_frame −1: to the end of the scene
  double fps;                  ///< --fps, default 60: a frame stands for 1/fps simulated seconds
  ContextKind context;         ///< --context, default CONTEXT_AUTO
  int threads;                 ///< --threads, default 0: as many as there are cores
  bool has_seed;               ///< --seed was given
  uint64_t seed;
  const char **sets;           ///< (set_count) "key.path=value" of --set; then what --style and --seed mean for a scene
  int set_count;
  const char *stats;           ///< --stats FILE or NULL
  bool has_camera;             ///< --camera was given
  float camera[6];             ///< m: eye, target
  const char *layer;           ///< --layer NAME or NULL
  bool quiet, json;
  bool schema, reference;      ///< check: print the schema or the reference instead
  bool help, version;          ///< print that and end

  char style_set[160], seed_set[64]; ///< text behind entries of `sets`
  const char **words;                ///< what is no option, and a NULL
} Options;

/// Parse the command line. false and *error (APP_BAD_INPUT; APP_FAILED when memory runs out). Free it either way.
bool options_parse(Options *options, int argc, char **argv, AppError *error);
void options_free(Options *options);

/// Print the help of the whole program (command −1) or of one command.
void options_print_help(FILE *file, int command);

#endif
