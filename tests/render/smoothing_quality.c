// Prints how well the smoothing filters do on pools with a known surface, at their default settings: see quality.h.
//
//   smoothing_quality            the pools of jittered columns
//   smoothing_quality MARGIN     … with pixels nearer than MARGIN radii to the pool's outline left out (default 3)
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tests/render/quality.h"

// ---- The filters -----------------------------------------------------------------------------------------------------

static void none(const SmoothInput *input, const void *parameters, float *smoothed) {
  (void)parameters;
  memcpy(smoothed, input->depth, sizeof *smoothed * (size_t)input->lens.width * (size_t)input->lens.height);
}

static void plane_fit(const SmoothInput *input, const void *parameters, float *smoothed) {
  smooth_plane_fit(input, parameters, smoothed);
}

static void bilateral(const SmoothInput *input, const void *parameters, float *smoothed) {
  smooth_bilateral(input, parameters, smoothed);
}

static void narrow_range(const SmoothInput *input, const void *parameters, float *smoothed) {
  smooth_narrow_range(input, parameters, smoothed);
}

static void regression(const SmoothInput *input, const void *parameters, float *smoothed) {
  smooth_regression(input, parameters, smoothed);
}

static const struct {
  const char *name;
  QualityFilter *filter;
  const void *parameters;
  int32_t taps; // a pixel
} filters[] = {
    {"none", none, NULL, 0},
    {"bilateral 21x21, 2", bilateral, &(SmoothBilateral){21, 2, 2.6}, 2 * 441},
    {"plane fit 9x9, 2", plane_fit, &(SmoothPlaneFit){9, 0, 2, 5.3, false}, 2 * 81},
    {"plane fit 9x9, 5", plane_fit, &(SmoothPlaneFit){9, 0, 5, 5.3, false}, 5 * 81},
    {"plane fit 9x9 of 3 r, 5", plane_fit, &(SmoothPlaneFit){9, 3, 5, 5.3, false}, 5 * 81},
    {"plane fit, no view, 5", plane_fit, &(SmoothPlaneFit){9, 0, 5, 5.3, true}, 5 * 81},
    {"narrow range 9 taps, 3", narrow_range, &(SmoothNarrowRange){9, 6, 3, 2, 10, 1}, 6 * 19 + 25},
    {"narrow range 20 taps, 1", narrow_range, &(SmoothNarrowRange){20, 6, 1, 2, 10, 1}, 2 * 41 + 25},
    {"regression", regression, &smooth_regression_default, 2 * (11 + 11 + 9)},
};

// ---- The table -------------------------------------------------------------------------------------------------------

typedef struct Summary {
  double wave_mean, wave_p95, flat_mean, flat_flicker, wave_flicker, bias; // the largest bias, the mean of the others
} Summary;

static void add(Summary *s, const QualityPool *pool, const QualityFigures *f, int flat_cases, int wave_cases) {
  if (pool->amplitude > 0) {
    s->wave_mean += f->mean / wave_cases;
    s->wave_p95 += f->p95 / wave_cases;
    s->wave_flicker += f->flicker / wave_cases;
  } else {
    s->flat_mean += f->mean / flat_cases;
    s->flat_flicker += f->flicker / flat_cases;
  }
  s->bias = fabs(f->bias) > fabs(s->bias) ? f->bias : s->bias;
}

int main(int argc, char **argv) {
  const double margin = argc > 1 ? atof(argv[1]) : 3;
  // A radius covers from 2.7 to 10 pixels.
  static const int32_t sizes[2][2] = {{1024, 768}, {640, 480}};
  static QualityCase cases[QUALITY_POOLS];
  int flat = 0;
  for (int k = 0; k < QUALITY_POOLS; ++k) {
    cases[k] = quality_case_create(&quality_pools[k], sizes[k % 2][0], sizes[k % 2][1], margin);
    flat += cases[k].truth.pool->amplitude == 0;
  }
  printf("%-26s %5s  %-13s %-6s %-13s %-6s  %s\n", "", "", "wave, degrees", "flat", "flicker", "bias",
         "distance from exact surfaces, r");
  printf("%-26s %5s  %-6s %-6s %-6s %-6s %-6s %-6s  %-6s %-6s %-6s %-6s %-6s\n", "filter", "taps", "mean", "p95",
         "mean", "flat", "wave", "r", "patch", "step 3", "step 6", "step12", "tilted");
  for (size_t n = 0; n < sizeof filters / sizeof *filters; ++n) {
    Summary s = {0};
    for (int k = 0; k < QUALITY_POOLS; ++k) {
      const QualityFigures f = quality_measure(&cases[k], filters[n].filter, filters[n].parameters);
      add(&s, cases[k].truth.pool, &f, flat, QUALITY_POOLS - flat);
    }
    const QualityEdges e = quality_edges(filters[n].filter, filters[n].parameters);
    printf("%-26s %5d  %6.2f %6.2f %6.2f %6.2f %6.2f %6.3f  %6.3f %6.3f %6.3f %6.3f %6.3f\n", filters[n].name,
           filters[n].taps, s.wave_mean, s.wave_p95, s.flat_mean, s.flat_flicker, s.wave_flicker, s.bias, e.patch,
           e.step[0], e.step[1], e.step[2], e.tilted);
  }
  for (int k = 0; k < QUALITY_POOLS; ++k) quality_case_destroy(&cases[k]);
}
