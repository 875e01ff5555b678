// Smooth outlines by a vote of the surroundings, the slow twin (render/shaders/cartoon_tidy.glsl says what for).
//
// A pixel is water where the Gaussian-weighted share of water around it is at least one half. It belongs to the piece of
// water, nearer or farther than what it shows, that has more than half of that.
#include "tests/render/reference/cartoon.h"

#include <math.h>
#include <stdlib.h>

#define EVEN 1e-5 // a share of votes that rounding may turn, or a part of a pixel

enum { TAPS = 5 };
typedef enum Side { SAME, NEARER, FARTHER, SIDES } Side;

typedef struct Votes {
  double weight[SIDES], sum[SIDES], all;
  bool doubtful;
} Votes;

static double nearest_around(const Lens *lens, const double *map, int32_t x, int32_t y) {
  double most = 0;
  for (int32_t stride = 1; stride <= 2; ++stride) {
    for (int32_t k = 0; k < 9; ++k) {
      most = fmax(most, cartoon_at(lens, map, x + (k % 3 - 1) * stride, y + (k / 3 - 1) * stride));
    }
  }
  return most;
}

static int32_t rounded(double at, bool *doubtful) {
  if (fabs(at - floor(at) - 0.5) < EVEN) *doubtful = true;
  return (int32_t)round(at);
}

// A tap's vote; gap in inverse depth.
static void vote(Votes *votes, double weight, double w, double middle, double gap) {
  votes->all += weight;
  if (w <= 0) return;
  const double off = w - middle;
  if (fabs(fabs(off) - gap) < EVEN * middle) votes->doubtful = true;
  const Side side = off > gap ? NEARER : off < -gap ? FARTHER : SAME;
  votes->weight[side] += weight;
  votes->sum[side] += weight * w;
}

static Votes votes_at(const Lens *lens, const CartoonTidy *p, const double *map, int32_t x, int32_t y, double middle) {
  const double pixel = lens_pixel(lens) / middle; // m
  const double sigma = fmax(p->sigma / pixel, 0.5);
  Votes votes = {0};
  const int32_t stride = rounded(fmax(1, 2.5 * sigma / TAPS), &votes.doubtful);
  for (int32_t v = -TAPS; v <= TAPS; ++v) {
    for (int32_t u = -TAPS; u <= TAPS; ++u) {
      if (abs(u) > (int32_t)(sqrt(TAPS * TAPS - v * v) + 0.5)) continue; // the window is round
      const int32_t dx = u * stride, dy = v * stride;
      if (!cartoon_inside(lens, x + dx, y + dy)) continue; // nothing is known of what lies there
      const double distance = hypot(dx, dy), gap = p->gap + CARTOON_STEEPEST * pixel * distance;
      vote(&votes, exp(-distance * distance / (2 * sigma * sigma)), cartoon_at(lens, map, x + dx, y + dy), middle,
           gap * middle * middle);
    }
  }
  return votes;
}

static double elected(const Votes *votes, double own) {
  const double *weight = votes->weight, *sum = votes->sum, water = weight[SAME] + weight[NEARER] + weight[FARTHER];
  if (2 * water < votes->all) return 0;
  if (2 * weight[NEARER] > water) return sum[NEARER] / weight[NEARER];
  if (2 * weight[FARTHER] > water) return sum[FARTHER] / weight[FARTHER];
  return own > 0 ? own : (sum[SAME] + sum[NEARER] + sum[FARTHER]) / water;
}

static bool nearly_even(const Votes *votes) {
  const double *weight = votes->weight, water = weight[SAME] + weight[NEARER] + weight[FARTHER];
  return fabs(2 * water - votes->all) < EVEN * votes->all || fabs(2 * weight[NEARER] - water) < EVEN * votes->all ||
         fabs(2 * weight[FARTHER] - water) < EVEN * votes->all;
}

void cartoon_tidy(const Lens *lens, const CartoonTidy *p, const double *map, double *tidied, double *share,
                  bool *doubtful) {
  for (int32_t y = 0; y < lens->height; ++y) {
    for (int32_t x = 0; x < lens->width; ++x) {
      const size_t i = (size_t)y * (size_t)lens->width + (size_t)x;
      const double own = map[i], middle = own > 0 ? own : nearest_around(lens, map, x, y);
      tidied[i] = share[i] = 0;
      doubtful[i] = false;
      if (middle <= 0) continue;
      const Votes votes = votes_at(lens, p, map, x, y, middle);
      share[i] = (votes.weight[SAME] + votes.weight[NEARER] + votes.weight[FARTHER]) / votes.all;
      tidied[i] = elected(&votes, own);
      doubtful[i] = votes.doubtful || nearly_even(&votes);
    }
  }
}
