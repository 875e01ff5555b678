// What bench_vary.c measures and bench_vary_report.c prints.
#ifndef LIDO_APP_BENCH_VARY_H
#define LIDO_APP_BENCH_VARY_H

#include "app/options.h"
#include "app/text.h"

/// One combination of values. Medians of the counted frames; ratios to the first combination are taken in each frame.
typedef struct VaryTimes {
  char style[64];
  double median_ms, least_ms, ratio; ///< of a picture
  double with_simulation_ms;         ///< of a picture and the simulation of its frame
  double with_simulation_ratio;
} VaryTimes;

/// One scene.
typedef struct VaryTable {
  const Options *options;
  const char *source;
  int frames, combinations;
  int32_t particles;    ///< in the last frame
  double simulation_ms; ///< of a frame, median
  VaryTimes times[VARY_MOST_COMBINATIONS];
} VaryTable;

void bench_vary_print(const VaryTable *table, const char *gl_description);
/// The JSON object of one scene.
void bench_vary_json(const VaryTable *table, Text *text);

#endif
