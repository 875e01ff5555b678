// The passes of the drawn water's surface, slow twins: every pixel of a window has its say, in double precision.
//
// Maps are (height, width), rows from the top, and hold inverse depths along the view axis (1/m), 0 where there is no water.
#ifndef LIDO_TESTS_RENDER_REFERENCE_CARTOON_H
#define LIDO_TESTS_RENDER_REFERENCE_CARTOON_H

#include <stdbool.h>
#include <stddef.h>

#include "sim/frame.h"
#include "tests/render/reference/pinhole.h"

/// Depth per metre across the view that can still be one surface.
#define CARTOON_STEEPEST 8.0

static inline bool cartoon_inside(const Lens *lens, int32_t x, int32_t y) {
  return x >= 0 && y >= 0 && x < lens->width && y < lens->height;
}
/// The inverse depth at a pixel; 0 outside the map.
static inline double cartoon_at(const Lens *lens, const double *map, int32_t x, int32_t y) {
  return cartoon_inside(lens, x, y) ? map[(size_t)y * (size_t)lens->width + (size_t)x] : 0;
}

typedef enum CartoonKernel { CARTOON_FULL, CARTOON_ROWS, CARTOON_COLUMNS } CartoonKernel;

/// The bilateral filter (Rocha Neto et al. 2014, Eqs. 1 and 2), or local planes by its weights.
typedef struct CartoonBilateral {
  CartoonKernel kernel;
  double half;   ///< of the kernel, pixels; 0: by reach
  double reach;  ///< half of the kernel, m
  int32_t taps;  ///< most of them on either side
  double range;  ///< m, standard deviation in depth
  bool fitted;   ///< a plane instead of the mean
  double wider;  ///< fitted: by how much the range grows with a metre of distance
  bool averaged; ///< fitted: the slopes are the mean of those around, not the plane's
} CartoonBilateral;
/// `slope` (height, width, 2): change of the inverse depth from pixel to pixel, rightwards and downwards; in place.
void cartoon_bilateral(const Lens *lens, const CartoonBilateral *parameters, double *map, double *slope);

/// Unit normals in view space, towards the viewer, by slopes; (height, width, 3), 0 where there is nothing.
void cartoon_normals(const Lens *lens, const double *map, const double *slope, float *normal);

/// Outlines by a vote of the surroundings.
typedef struct CartoonTidy {
  double sigma; ///< m, of the Gaussian
  double gap;   ///< m, in depth, between two pieces of water
} CartoonTidy;
/// `doubtful` (height, width): 1 where a vote is so nearly even, or a tap so nearly on another pixel, that rounding decides.
void cartoon_tidy(const Lens *lens, const CartoonTidy *parameters, const double *map, double *tidied, double *share,
                  bool *doubtful);

/// One step of curvature flow.
typedef struct CartoonFlow {
  double step; ///< half of the variance that it adds, pixels²
  double gap;  ///< m, in depth, that is a border
} CartoonFlow;
void cartoon_flow(const Lens *lens, const CartoonFlow *parameters, const double *map, double *moved);

/// Metres of water along each ray as Gaussians. `behind` (height, width): m, depth of what is behind, 0: nothing.
/// `slack` (height, width): m, of particles whose edge is so near that rounding decides whether they count.
void cartoon_thickness(const Pinhole *pinhole, const SimFrame *frame, const float *behind, double *metres,
                       double *slack);

#endif
