// Where bodies go into the water, in a picture: whether what is seen of them above it and through it meets.
//
// On either side of a body, the outline above the water and the outline of what is seen through it are each fitted by a
// straight line over a few rows and carried on to the row where the body goes in. A kink there is refraction; a gap between
// the two lines is a break. So are pixels between the body above the water and what is seen through it: a seam.
#ifndef LIDO_TESTS_RENDER_WATERLINE_H
#define LIDO_TESTS_RENDER_WATERLINE_H

#include "tests/render/harness.h"

/// Bodies are told apart by which of red, green and blue they have: bits of [1, 6]. In white light from everywhere and clear
/// water over a black floor nothing else has colour.
RenderSettings waterline_settings(void);
void waterline_paint(SimObstacle *obstacle, int hue); ///< 0: grey

/// Pixels are those of a picture so wide; it may be drawn some times as large, so that they are known to a part.
#define WATERLINE_WIDTH 640

typedef struct WaterlinePicture {
  int32_t width, height; // width: a multiple of WATERLINE_WIDTH
  const uint8_t *rgb;
  const float *water; // the style's layer "depth": m to the water, 0 where something is before it
} WaterlinePicture;

typedef struct WaterlineBreaks {
  int joins;        // sides of bodies that could be measured
  double gap, seam; // pixels, the largest
} WaterlineBreaks;

/// Of the body of this hue. What is hidden behind bodies of other hues is left out.
WaterlineBreaks waterline_measure(const WaterlinePicture *picture, int hue);

/// Draw a frame whose bodies are painted and measure all hues.
WaterlineBreaks waterline_of_frame(Harness *harness, const SimFrame *frame, const RenderView *view,
                                   const RenderSettings *settings);

#endif
