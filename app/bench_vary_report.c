#include "app/bench_vary.h"

#include <stdio.h>
#include <string.h>

#include "app/scene_source.h"

/// The value of the k-th key in a combination.
static const char *value_of(const VaryTable *table, int k, int combination, size_t *length) {
  const Options *options = table->options;
  int place = vary_place(options->varies, options->vary_count, k, combination);
  return vary_value(options->varies[k], place, length);
}

// ---- Table -----------------------------------------------------------------------------------------------------------

/// Of the column of the k-th key.
static int width_of(const VaryTable *table, int k) {
  size_t width = vary_key_length(table->options->varies[k]), length;
  for (int i = 0; vary_value(table->options->varies[k], i, &length); i++)
    if (length > width) width = length;
  return (int)width;
}

static bool same_style(const VaryTable *table) {
  for (int c = 1; c < table->combinations; c++)
    if (strcmp(table->times[c].style, table->times[0].style) != 0) return false;
  return true;
}

static void print_head(const VaryTable *table, const char *gl_description) {
  const Options *options = table->options;
  printf("%s: %d particles, ", table->source, table->particles);
  if (same_style(table)) printf("style %s, ", table->times[0].style);
  printf("%dx%d on %s\n", options->width, options->height, gl_description);
  printf(
      "ms a picture, medians of %d frames; ratios to the first row in each frame; the simulation of a frame takes %.1f "
      "ms\n\n",
      table->frames, table->simulation_ms);
  for (int k = 0; k < options->vary_count; k++)
    printf("%-*.*s  ", width_of(table, k), (int)vary_key_length(options->varies[k]), options->varies[k]);
  printf("%10s %8s %16s %8s\n", "picture", "ratio", "with simulation", "ratio");
}

void bench_vary_print(const VaryTable *table, const char *gl_description) {
  print_head(table, gl_description);
  for (int c = 0; c < table->combinations; c++) {
    const VaryTimes *times = &table->times[c];
    for (int k = 0; k < table->options->vary_count; k++) {
      size_t length;
      const char *value = value_of(table, k, c, &length);
      printf("%-*.*s  ", width_of(table, k), (int)length, value);
    }
    printf("%10.1f %8.3f %16.1f %8.3f\n", times->median_ms, times->ratio, times->with_simulation_ms,
           times->with_simulation_ratio);
  }
  fflush(stdout); // the next scene may take long
}

// ---- JSON ------------------------------------------------------------------------------------------------------------

/// {"KEY": VALUE, …}. A value that is no JSON is a name without its quotes, as --set takes it.
static void add_values(const VaryTable *table, int combination, Text *text) {
  const Options *options = table->options;
  for (int k = 0; k < options->vary_count; k++) {
    size_t length;
    const char *value = value_of(table, k, combination, &length);
    const char *quote = scene_is_json(value, length) ? "" : "\"";
    text_format(text, "%s\"%.*s\": %s%.*s%s", k > 0 ? ", " : "", (int)vary_key_length(options->varies[k]),
                options->varies[k], quote, (int)length, value, quote);
  }
}

void bench_vary_json(const VaryTable *table, Text *text) {
  text_add(text, " {\"scene\": ");
  text_add_json_string(text, table->source);
  text_format(text, ", \"particles\": %d, \"simulation_median_ms\": %.6f, \"times\": [\n", table->particles,
              table->simulation_ms);
  for (int c = 0; c < table->combinations; c++) {
    const VaryTimes *times = &table->times[c];
    text_format(text, "  {\"style\": \"%s\", \"values\": {", times->style);
    add_values(table, c, text);
    text_format(text,
                "}, \"median_ms\": %.6f, \"least_ms\": %.6f, \"ratio\": %.6f, \"with_simulation_median_ms\": %.6f, "
                "\"with_simulation_ratio\": %.6f}%s\n",
                times->median_ms, times->least_ms, times->ratio, times->with_simulation_ms,
                times->with_simulation_ratio, c + 1 == table->combinations ? "" : ",");
  }
  text_add(text, " ]}");
}
