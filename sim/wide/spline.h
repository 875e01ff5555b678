// The cubic spline in wide floats.
//
// With q = r/h, a = max(0, 1 − q), b = max(0, ½ − q): W = 2 s (a³ − 4 b³) and dW/dr = 6 s/h (4 b² − a²), s = 8/(πh³). Both
// are summed without their constant factors, which come in at the end.
#ifndef LIDO_SIM_WIDE_SPLINE_H
#define LIDO_SIM_WIDE_SPLINE_H

#include "sim/kernels.h"
#include "sim/wide/simd.h"

/// Constants of a sweep in every lane.
typedef struct Spline {
  SimF inverse_h, tiny, zero, half, one, four;
} Spline;

static inline Spline spline_make(const SimCubic *cubic) {
  // Two particles in one place push each other nowhere; they do not divide by zero.
  return (Spline){sim_f(cubic->inverse_h), sim_f(1e-6f * cubic->spacing), sim_f(0), sim_f(0.5f), sim_f(1), sim_f(4)};
}

// g = 4 b² − a²; *w = a³ − 4 b³; *over_r = g/r.
static inline SimF spline(const Spline *s, SimF r2, SimF *w, SimF *over_r) {
  SimF r = sim_sqrt(r2), q = r * s->inverse_h;
  SimF a = sim_max(s->one - q, s->zero), b = sim_max(s->half - q, s->zero);
  SimF a2 = a * a, b2 = s->four * (b * b), g = b2 - a2;
  *w = a2 * a - b2 * b;
  *over_r = g / sim_max(r, s->tiny);
  return g;
}

#endif
