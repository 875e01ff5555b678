// Water made by hand for the tests of the style "cartoon": the test says which particles are of the body and which are drops.
#ifndef LIDO_TESTS_RENDER_DRAWN_H
#define LIDO_TESTS_RENDER_DRAWN_H

#include "tests/render/harness.h"
#include "tests/render/reference/pinhole.h"

enum { DRAWN_MOST = 60000 };

typedef struct DrawnWater {
  SimFrame frame; ///< without a container
  float position[3 * DRAWN_MOST], radius[DRAWN_MOST];
  uint8_t particle_class[DRAWN_MOST], near_surface[DRAWN_MOST];
} DrawnWater;

DrawnWater *drawn_create(float particle_radius); ///< empty; to be freed
/// One that can be seen; returns its index.
int32_t drawn_add(DrawnWater *water, float x, float y, float z, SimClass class);
/// A lattice of the body with nx × ny × nz particles around a middle, each moved by up to `disorder` spacings along each axis.
void drawn_add_block(DrawnWater *water, const float middle[3], int nx, int ny, int nz, float disorder);
/// What of a lattice of the body is in a ball, whose radius is in m.
void drawn_add_ball(DrawnWater *water, const float middle[3], float radius);

/// The style "cartoon" in the pinned environment, without a floor.
RenderSettings drawn_settings(void);

/// A layer of the style that has one channel and 1/scale of the picture's resolution, rows from the top; to be freed.
double *drawn_map(Harness *harness, const char *layer, int32_t scale, const SimFrame *frame, const RenderView *view,
                  const RenderSettings *settings);
/// What such a map is seen through.
Lens drawn_lens(const Harness *harness, const RenderView *view, int32_t scale);

#endif
