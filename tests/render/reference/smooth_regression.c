// Smoothing by regression of the inverse depth, the default.
//
// The inverse depth w = 1/z of a plane is affine in the position on the screen. So a weighted least-squares line through w
// along a row, then one along a column, keep a plane as it is whatever the weights are: up to its very boundary (Imai et
// al. 2016, section 3.2, problem 2), where an average would bend it. Local linear regression: Cleveland, Robust Locally
// Weighted Regression and Smoothing Scatterplots, 1979; Fan & Gijbels, Local Polynomial Modelling and Its Applications, 1996.
//
// Windows have a constant size in the world. Their taps lie apart where a window is larger than its taps, so that a step
// misses what is finer; the next, smaller windows are against that, and so must come later.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/render/reference/smooth.h"

const SmoothRegression smooth_regression_default = {
    .step_count = 3, .steps = {{5, 4.5, 0}, {5, 2, 0}, {4, 0.8, 0}}, .range = 7};

// A window of 4 taps on either side covers 4.5 pixels on either side where the taps are neighbours. Half as far again they
// begin to miss what lies between them: then every step has twice the taps, and steps follow whose windows are as wide as
// the gap of two taps before them, until none misses anything.
SmoothRegression smooth_regression_near(double largest) {
  const double covered = 4.5, widest = 1.5 * covered;
  SmoothRegression p = smooth_regression_default;
  double reach = p.steps[2].reach;
  if (reach * largest <= widest) return p;
  for (int32_t i = 0; i < 3; ++i) p.steps[i].taps *= 2;
  while (p.step_count < SMOOTH_REGRESSION_STEPS && reach * largest > widest) {
    reach = reach * 2 / covered;
    p.steps[p.step_count++] = (SmoothStep){4, reach, 1.5};
  }
  return p;
}

// (1 − t²)², close to a Gaussian and without an exponential
static double kernel(double t) {
  return t * t < 1 ? (1 - t * t) * (1 - t * t) : 0;
}

static double inverse_at(const Lens *lens, const float *inverse, int32_t x, int32_t y) {
  if (x < 0 || y < 0 || x >= lens->width || y >= lens->height) return 0;
  return (double)inverse[(size_t)y * (size_t)lens->width + (size_t)x];
}

// Weighted sums over the taps at t in half windows, of v in units of the range against the middle's.
typedef struct Sums {
  double w, wt, wtt, wv, wtv;
} Sums;

static void add(Sums *s, double t, double v) {
  const double weight = kernel(t) * kernel(v);
  s->w += weight;
  s->wt += weight * t;
  s->wtt += weight * t * t;
  s->wv += weight * v;
  s->wtv += weight * t * v;
}

// Value in the middle of the least-squares line. The middle itself has weight 1, so that w ≥ 1, and the determinant is zero
// only where it stands alone.
static double line_value(const Sums *s) {
  const double determinant = s->w * s->wtt - s->wt * s->wt;
  return determinant > 1e-6 * s->w * s->w ? (s->wtt * s->wv - s->wt * s->wtv) / determinant : s->wv / s->w;
}

// Half of the window in pixels where the inverse depth is w.
static double half_window(const SmoothInput *input, const SmoothStep *step, double w) {
  return step->reach * input->radius * w / lens_pixel(&input->lens);
}

static double along_line(const SmoothInput *input, const SmoothRegression *p, const SmoothStep *step,
                         const float *inverse, int32_t column, int32_t row, bool vertical) {
  const double w = inverse_at(&input->lens, inverse, column, row), window = half_window(input, step, w);
  if (window < step->too_small) return w;
  const double half = fmax(window, 1.5);
  // A depth that differs by δ has an inverse that differs by about δ w².
  const double range = p->range * input->radius * w * w, stride = fmax(half / (step->taps + 0.5), 1);
  Sums sums = {.w = 1};
  for (int32_t k = -step->taps; k <= step->taps; ++k) {
    const int32_t offset = (int32_t)lround(k * stride);
    const double tap =
        inverse_at(&input->lens, inverse, column + (vertical ? 0 : offset), row + (vertical ? offset : 0));
    if (k != 0 && tap > 0) add(&sums, offset / half, (tap - w) / range);
  }
  return w + range * line_value(&sums);
}

static void pass(const SmoothInput *input, const SmoothRegression *p, const float *from, int32_t index, float *to) {
  const Lens *lens = &input->lens;
  for (int32_t row = 0; row < lens->height; ++row)
    for (int32_t column = 0; column < lens->width; ++column) {
      const size_t i = (size_t)row * (size_t)lens->width + (size_t)column;
      if (from[i] > 0) to[i] = (float)along_line(input, p, &p->steps[index / 2], from, column, row, index % 2 == 1);
    }
}

static void invert(float *to, const float *from, size_t count) {
  for (size_t i = 0; i < count; ++i) to[i] = from[i] > 0 ? 1 / from[i] : 0;
}

void smooth_regression(const SmoothInput *input, const SmoothRegression *p, float *smoothed) {
  const size_t pixels = (size_t)input->lens.width * (size_t)input->lens.height;
  float *from = malloc(pixels * sizeof *from);
  invert(smoothed, input->depth, pixels);
  for (int32_t index = 0; index < 2 * p->step_count; ++index) {
    memcpy(from, smoothed, pixels * sizeof *from);
    pass(input, p, from, index, smoothed);
  }
  invert(smoothed, smoothed, pixels);
  free(from);
}
