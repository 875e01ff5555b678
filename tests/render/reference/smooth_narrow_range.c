// The narrow-range filter. Truong & Yuksel, A Narrow-Range Filter for Screen-Space Fluid Rendering, 2018.
//
// A Gaussian filter that takes farther neighbours for points a little (μ) behind the middle, and leaves out nearer ones
// together with their mirror images. What counts as near or far (δ) grows with the range of the depths met on the way
// outwards, so that tilted surfaces pass. Rows, then columns, then a small two-dimensional window against the streaks.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/render/reference/smooth.h"

// A map of depths, and the one by whose windows its taps are spaced. Of the back, which is seen from behind, depths count
// backwards.
typedef struct Depths {
  const SmoothInput *input;
  const float *own, *spacing;
  double sign;
} Depths;

// Depth of a pixel; nothing is infinitely far away.
static double depth_at(const Depths *map, int32_t x, int32_t y) {
  const Lens *lens = &map->input->lens;
  if (x < 0 || y < 0 || x >= lens->width || y >= lens->height) return INFINITY;
  const float z = map->own[(size_t)y * (size_t)lens->width + (size_t)x];
  return z > 0 ? map->sign * (double)z : INFINITY;
}

typedef struct Narrow {
  double near, far, clamped; // m: nearer is left out, farther becomes `clamped`
  double threshold, sum, weights;
} Narrow;

static Narrow narrow_begin(const SmoothInput *input, const SmoothNarrowRange *p, double z) {
  const double threshold = p->threshold * input->radius;
  return (Narrow){z - threshold, z + threshold, z + p->clamp * input->radius, threshold, z, 1};
}

// A tap and its mirror image.
static void narrow_add(Narrow *n, const double pair[2], double weight) {
  if (pair[0] < n->near || pair[1] < n->near) return;
  for (int k = 0; k < 2; ++k) n->sum += weight * (pair[k] > n->far ? n->clamped : pair[k]);
  n->weights += 2 * weight;
  const double far = n->far;
  for (int k = 0; k < 2; ++k) {
    if (pair[k] > far) continue;
    n->near = fmin(n->near, pair[k] - n->threshold);
    n->far = fmax(n->far, pair[k] + n->threshold);
  }
}

static double along_line(const Depths *map, const SmoothNarrowRange *p, int32_t column, int32_t row, bool vertical) {
  const Lens *lens = &map->input->lens;
  const double z = depth_at(map, column, row), reach = p->reach * map->input->radius / lens_pixel(lens);
  const double spaced = reach / (double)map->spacing[(size_t)row * (size_t)lens->width + (size_t)column];
  const double sigma = reach / fabs(z) / 3, stride = fmax(1, spaced / p->taps);
  Narrow n = narrow_begin(map->input, p, z);
  for (int32_t k = 1; k <= p->taps; ++k) {
    const int32_t offset = (int32_t)lround(k * stride), dx = vertical ? 0 : offset, dy = vertical ? offset : 0;
    const double pair[2] = {depth_at(map, column + dx, row + dy), depth_at(map, column - dx, row - dy)};
    narrow_add(&n, pair, exp(-offset * offset / (2 * sigma * sigma)));
  }
  return n.sum / n.weights;
}

static double around(const Depths *map, const SmoothNarrowRange *p, int32_t column, int32_t row) {
  const double sigma = p->cleanup / 2.0;
  Narrow n = narrow_begin(map->input, p, depth_at(map, column, row));
  // What counts as far depends on the order: outwards by rows, each from right to left.
  for (int32_t dy = 0; dy <= p->cleanup; ++dy) {
    for (int32_t dx = p->cleanup; dx >= -p->cleanup; --dx) {
      if (dy == 0 && dx >= 0) continue;
      const double pair[2] = {depth_at(map, column + dx, row + dy), depth_at(map, column - dx, row - dy)};
      narrow_add(&n, pair, exp(-(dx * dx + dy * dy) / (2 * sigma * sigma)));
    }
  }
  return n.sum / n.weights;
}

static void pass(const Depths *map, const SmoothNarrowRange *p, int32_t index, float *to) {
  const Lens *lens = &map->input->lens;
  for (int32_t row = 0; row < lens->height; ++row)
    for (int32_t column = 0; column < lens->width; ++column) {
      const size_t i = (size_t)row * (size_t)lens->width + (size_t)column;
      if (!(map->own[i] > 0)) continue;
      to[i] = (float)(map->sign * (index < 2 * p->iterations ? along_line(map, p, column, row, index % 2 == 1)
                                                             : around(map, p, column, row)));
    }
}

void smooth_narrow_range_sides(const SmoothInput side[], int32_t count, const SmoothNarrowRange *p,
                               float *const smoothed[]) {
  const size_t pixels = (size_t)side[0].lens.width * (size_t)side[0].lens.height;
  float *from = malloc((size_t)count * pixels * sizeof *from);
  for (int32_t s = 0; s < count; ++s) memcpy(smoothed[s], side[s].depth, pixels * sizeof *from);
  for (int32_t index = 0; index < 2 * p->iterations + (p->cleanup > 0); ++index) {
    for (int32_t s = 0; s < count; ++s) memcpy(from + (size_t)s * pixels, smoothed[s], pixels * sizeof *from);
    for (int32_t s = 0; s < count; ++s)
      pass(&(Depths){&side[s], from + (size_t)s * pixels, from, s == 0 ? 1 : -1}, p, index, smoothed[s]);
  }
  free(from);
}

void smooth_narrow_range(const SmoothInput *input, const SmoothNarrowRange *p, float *smoothed) {
  smooth_narrow_range_sides(input, 1, p, &smoothed);
}
