// The camera and the maps of the slow twins: one ray through the middle of every pixel.
//
// A ray's direction is x·right + y·up + gaze, so that a parameter along it is the depth along the view axis, and a point
// of depth z lies at z (x, y, −1) in view space (right, up, towards the viewer). x and y are the ray's coordinates.
#ifndef LIDO_TESTS_RENDER_REFERENCE_PINHOLE_H
#define LIDO_TESTS_RENDER_REFERENCE_PINHOLE_H

#include <stdint.h>

/// What a map of depths is seen through.
typedef struct Lens {
  int32_t width, height; ///< pixels
  double tan_x, tan_y;   ///< tangents of half the angles of view
} Lens;

/// Coordinates of the ray through the middle of a pixel; pixels are counted from the top left, y points up.
static inline double lens_x(const Lens *lens, int32_t column) {
  return lens->tan_x * (2 * (column + 0.5) / lens->width - 1);
}
static inline double lens_y(const Lens *lens, int32_t row) {
  return lens->tan_y * (1 - 2 * (row + 0.5) / lens->height);
}
/// Size of a pixel at depth 1.
static inline double lens_pixel(const Lens *lens) {
  return 2 * lens->tan_y / lens->height;
}

/// A lens somewhere: unit axes, right-handed (right, up, −gaze).
typedef struct Pinhole {
  Lens lens;
  double eye[3], right[3], up[3], gaze[3];
} Pinhole;

/// From eye to target, y up; the vertical angle of view in degrees.
Pinhole pinhole_make(const float eye[3], const float target[3], float vertical_fov, int32_t width, int32_t height);
/// The direction of the ray through the middle of a pixel, of length 1 along the gaze.
void pinhole_ray(const Pinhole *pinhole, int32_t column, int32_t row, double direction[3]);
/// A vector's components along right, up and −gaze.
void pinhole_to_view(const Pinhole *pinhole, const double world[3], double view[3]);

#endif
