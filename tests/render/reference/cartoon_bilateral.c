// The bilateral filter of the inverse depth, the slow twin.
//
// Based on: Tomasi & Manduchi, Bilateral Filtering for Gray and Color Images, 1998; Rocha Neto, Guimarães, Apolinário &
// Mello, Real-Time Screen Space Rendering of Cartoon Water, 2014, Eqs. 1 and 2; the planes: Cleveland, Robust Locally
// Weighted Regression and Smoothing Scatterplots, 1979. Differences of inverse depths become metres of depth by the square
// of the depth in the middle.
#include "tests/render/reference/cartoon.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Window {
  double half, stride;         // pixels
  int32_t taps, columns, rows; // on either side: most, and along each axis
} Window;

static Window window_at(const Lens *lens, const CartoonBilateral *p, double own) {
  Window w = {.half = fmax(p->half > 0 ? p->half : p->reach * own / lens_pixel(lens), 1)};
  w.taps = (int32_t)fmin(ceil(w.half), p->taps);
  w.stride = fmax(w.half / w.taps, 1);
  w.columns = p->kernel == CARTOON_COLUMNS ? 0 : w.taps;
  w.rows = p->kernel == CARTOON_ROWS ? 0 : w.taps;
  return w;
}

// Weighted least squares: what is minimised is the sum of weight · (z − a·(1, x, y))². A little weight holds slopes down of
// which the taps tell nothing.
typedef struct Normal {
  double matrix[3][3], right[3];
} Normal;

static void add(Normal *n, double weight, double x, double y, double z) {
  const double basis[3] = {1, x, y};
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) n->matrix[i][k] += weight * basis[i] * basis[k];
    n->right[i] += weight * basis[i] * z;
  }
}

// Gauss's elimination; the matrix is symmetric and positive definite.
static void solve(Normal *n, double a[3]) {
  n->matrix[1][1] += 1e-4 * n->matrix[0][0];
  n->matrix[2][2] += 1e-4 * n->matrix[0][0];
  for (int i = 0; i < 3; ++i) {
    for (int row = i + 1; row < 3; ++row) {
      const double factor = n->matrix[row][i] / n->matrix[i][i];
      for (int k = 0; k < 3; ++k) n->matrix[row][k] -= factor * n->matrix[i][k];
      n->right[row] -= factor * n->right[i];
    }
  }
  for (int i = 2; i >= 0; --i) {
    a[i] = n->right[i];
    for (int k = i + 1; k < 3; ++k) a[i] -= n->matrix[i][k] * a[k];
    a[i] /= n->matrix[i][i];
  }
}

typedef struct Pixel {
  double own, slope[2];
} Pixel;

// g of Eq. 1 for a tap that differs by `z` metres.
static double similar(const Lens *lens, const CartoonBilateral *p, const Pixel *pixel, double z, int32_t dx,
                      int32_t dy) {
  const double own2 = pixel->own * pixel->own, metres = hypot(dx, dy) * lens_pixel(lens) / pixel->own;
  if (!p->fitted) return exp(-z * z / (2 * p->range * p->range));
  const double on_plane = -(pixel->slope[0] * dx + pixel->slope[1] * dy) / own2;
  const double range = p->range + p->wider * metres;
  return exp(-(z - on_plane) * (z - on_plane) / (2 * range * range));
}

// Taps on either side in the v-th of the window's rows: the full kernel is a disc.
static int32_t across(const Window *window, int32_t v) {
  if (window->rows == 0 || window->columns == 0) return window->columns;
  return (int32_t)floor(sqrt(window->taps * window->taps - v * v) + 0.5);
}

static Pixel filtered(const Lens *lens, const CartoonBilateral *p, const double *map, const double *slopes,
                      const Pixel *pixel, int32_t x, int32_t y) {
  const Window window = window_at(lens, p, pixel->own);
  const double sigma = window.half / 3, own2 = pixel->own * pixel->own;
  Normal normal = {{{0}}, {0}};
  double mean[2] = {0, 0};
  for (int32_t v = -window.rows; v <= window.rows; ++v) {
    for (int32_t u = -across(&window, v); u <= across(&window, v); ++u) {
      const int32_t dx = (int32_t)round(u * window.stride), dy = (int32_t)round(v * window.stride);
      const double w = cartoon_at(lens, map, x + dx, y + dy), z = (pixel->own - w) / own2; // how much farther
      if (w <= 0) continue;
      const double f = exp(-(dx * dx + dy * dy) / (2 * sigma * sigma));
      const double weight = f * similar(lens, p, pixel, z, dx, dy);
      const size_t tap = (size_t)(y + dy) * (size_t)lens->width + (size_t)(x + dx);
      add(&normal, weight, dx / window.half, dy / window.half, z);
      for (size_t k = 0; k < 2; ++k) mean[k] += weight * slopes[2 * tap + k];
    }
  }
  const double weights = normal.matrix[0][0];
  double a[3] = {normal.right[0] / weights, 0, 0};
  Pixel result = *pixel;
  if (p->fitted) {
    solve(&normal, a);
    for (int k = 0; k < 2 && p->averaged; ++k) result.slope[k] = mean[k] / weights;
    if (!p->averaged && p->kernel != CARTOON_COLUMNS) result.slope[0] = -a[1] * own2 / window.half;
    if (!p->averaged && p->kernel != CARTOON_ROWS) result.slope[1] = -a[2] * own2 / window.half;
  }
  result.own -= a[0] * own2;
  return result;
}

void cartoon_bilateral(const Lens *lens, const CartoonBilateral *p, double *map, double *slope) {
  const size_t pixels = (size_t)lens->width * (size_t)lens->height;
  double *before = malloc(3 * pixels * sizeof *before), *slopes = before + pixels;
  memcpy(before, map, pixels * sizeof *before);
  memcpy(slopes, slope, 2 * pixels * sizeof *slopes);
  for (int32_t y = 0; y < lens->height; ++y) {
    for (int32_t x = 0; x < lens->width; ++x) {
      const size_t i = (size_t)y * (size_t)lens->width + (size_t)x;
      if (before[i] <= 0) continue;
      const Pixel pixel = {before[i], {slope[2 * i], slope[2 * i + 1]}};
      const Pixel result = filtered(lens, p, before, slopes, &pixel, x, y);
      map[i] = result.own;
      memcpy(slope + 2 * i, result.slope, sizeof result.slope);
    }
  }
  free(before);
}
