// What the styles' tests on frames that nobody checked share: odd things to draw, and what must hold of the pictures.
#ifndef LIDO_TESTS_RENDER_DEGENERATE_H
#define LIDO_TESTS_RENDER_DEGENERATE_H

#include "tests/render/harness.h"

/// A tank of 1 × 1 × 0.5 m at the origin, a view of it, and particles of this radius (m) in it up to 0.3 m, with nine drops
/// over them.
#define DEGENERATE_RADIUS 0.02f
extern const RenderView degenerate_view;
extern const SimContainer degenerate_tank;
/// Calls `add` for every particle; `drop`: it is one of the nine.
void degenerate_pool(void *to, void (*add)(void *to, float x, float y, float z, bool drop));

enum { DEGENERATE_EYES = 10, DEGENERATE_CONTAINERS = 8, DEGENERATE_SIZES = 6 };
extern const RenderView degenerate_eyes[DEGENERATE_EYES]; ///< at that tank; the first one is in the water
extern const SimContainer degenerate_containers[DEGENERATE_CONTAINERS];
extern const int32_t degenerate_sizes[DEGENERATE_SIZES][2]; ///< of pictures

/// Numbers that nobody checked: coordinates; radii of particles, the last of which is sensible; radii of a frame.
enum { DEGENERATE_PLACES = 6, DEGENERATE_RADII = 9, DEGENERATE_FRAME_RADII = 8 };
extern const float degenerate_places[DEGENERATE_PLACES], degenerate_radii[DEGENERATE_RADII],
    degenerate_frame_radii[DEGENERATE_FRAME_RADII];

/// No layer holds what is not a number.
void degenerate_expect_layer(Harness *harness, const char *what, const char *layer, const SimFrame *frame,
                             const RenderView *view, const RenderSettings *settings);
/// Nothing in the default scene is black, and so no pixel may be: one of NaN comes out black. GL says nothing.
void degenerate_expect_picture(Harness *harness, const char *what, const SimFrame *frame, const RenderView *view,
                               const RenderSettings *settings);
/// Both, and every layer of the style.
void degenerate_expect_clean(Harness *harness, const char *what, const SimFrame *frame, const RenderView *view,
                             const RenderSettings *settings);

#endif
