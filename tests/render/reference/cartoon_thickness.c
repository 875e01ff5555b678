// Metres of water along each ray, the slow twin: every particle of the body spreads its water as a Gaussian.
//
// Based on: Rocha Neto, Guimarães, Apolinário & Mello, Real-Time Screen Space Rendering of Cartoon Water, 2014, section
// III-C. A particle has the volume of a cube of edge 2r and a standard deviation of r; beyond 2.5 of these it has none, and
// what is left out there, the rest makes up for. What is behind cuts a particle off as if its water were 2r long.
#include "tests/render/reference/cartoon.h"

#include <math.h>

#define CUT 2.5   // standard deviations
#define EDGE 1e-4 // of the same: so near the cut, rounding decides
#define PI 3.14159265358979323846

static double squared_length(const double v[3]) {
  return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

static void add_particle(const double eye[3], const double ray[3], const float centre[3], double r, double behind,
                         double *metres, double *slack) {
  double from[3], foot[3], middle = 0;
  for (int k = 0; k < 3; ++k) from[k] = (double)centre[k] - eye[k];
  for (int k = 0; k < 3; ++k) middle += ray[k] * from[k] / squared_length(ray);
  for (int k = 0; k < 3; ++k) foot[k] = ray[k] * middle - from[k];
  const double away = sqrt(squared_length(foot)) / r;
  if (away > CUT + EDGE) return;
  // 8 r³ of water in a plane Gaussian of standard deviation r, cut off.
  const double highest = 8 * r / (2 * PI * (1 - exp(-CUT * CUT / 2)));
  const double before = (behind - middle) * sqrt(squared_length(ray)) / (2 * r) + 0.5;
  const double water = highest * exp(-away * away / 2) * fmin(fmax(before, 0), 1);
  if (away <= CUT) *metres += water;
  if (away > CUT - EDGE) *slack += water;
}

void cartoon_thickness(const Pinhole *pinhole, const SimFrame *frame, const float *behind, double *metres,
                       double *slack) {
  const Lens *lens = &pinhole->lens;
  for (int32_t y = 0; y < lens->height; ++y) {
    for (int32_t x = 0; x < lens->width; ++x) {
      const size_t i = (size_t)y * (size_t)lens->width + (size_t)x;
      double ray[3];
      pinhole_ray(pinhole, x, y, ray);
      metres[i] = slack[i] = 0;
      for (int32_t n = 0; n < frame->count; ++n) {
        if (frame->particle_class[n] == SIM_SPLASH) continue;
        const double r = frame->radius != NULL ? (double)frame->radius[n] : (double)frame->particle_radius;
        add_particle(pinhole->eye, ray, frame->position + 3 * (size_t)n, r,
                     behind[i] > 0 ? (double)behind[i] : INFINITY, &metres[i], &slack[i]);
      }
    }
  }
}
