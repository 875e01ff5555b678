#include "tests/render/degenerate.h"

#include <float.h>

#include <math.h>
#include <stdlib.h>

const RenderView degenerate_view = {{0.5f, 0.6f, 2}, {0.5f, 0.3f, 0.25f}, 38};
const SimContainer degenerate_tank = {{0, 0, 0}, {1, 1, 0.5f}, SIM_CONTAINER_BOX};

void degenerate_pool(void *to, void (*add)(void *to, float x, float y, float z, bool drop)) {
  const float r = DEGENERATE_RADIUS;
  for (float z = r; z < 0.5f; z += 2 * r)
    for (float x = r; x < 1; x += 2 * r)
      for (float y = r; y < 0.3f; y += 2 * r) add(to, x, y, z, false);
  for (int i = 0; i < 9; ++i) add(to, 0.1f * (float)(i + 1), 0.5f, 0.25f, true);
}

const RenderView degenerate_eyes[DEGENERATE_EYES] = {
    {{0.5f, 0.15f, 0.25f}, {0.9f, 0.2f, 0.25f}, 70},                                      // in the water
    {{0.5f, 0.15f, 0.25f}, {0.5f, 2, 0.25f}, 70},                                         // looking up from there
    {{DEGENERATE_RADIUS, DEGENERATE_RADIUS, DEGENERATE_RADIUS}, {0.9f, 0.2f, 0.25f}, 60}, // in a particle at the corner
    {{0.5f, 0.29f, 0.25f}, {0.9f, 0.29f, 0.3f}, 60},                                      // on the surface
    {{0.1f, 0.5f, 0.25f}, {0.5f, 0.3f, 0.25f}, 60},                                       // in a splash
    {{0.5f, 0.5f, -2}, {0.5f, 0.5f, -9}, 38},                                             // the water behind the eye
    {{0.5f, 4, 0.25f}, {0.5f, 0, 0.25f}, 38},                                             // straight down
    {{0.5f, -2, 0.25f}, {0.5f, 0, 0.25f}, 38},                                            // from under the floor
    {{900, 900, 900}, {0.5f, 0, 0.25f}, 38},                                              // far away
    {{0.5f, 0, 2}, {0.5f, 0, 0.25f}, 160},                                                // in the floor's plane
};

const SimContainer degenerate_containers[DEGENERATE_CONTAINERS] = {
    {{NAN, 0, 0}, {1, 1, 1}, SIM_CONTAINER_BOX},        {{0, 0, 0}, {INFINITY, 1, 1}, SIM_CONTAINER_BOX},
    {{0, 0, 0}, {0, 0, 0}, SIM_CONTAINER_BOX},          {{1, 1, 1}, {0, 0, 0}, SIM_CONTAINER_BOX},
    {{-1e30f, 0, 0}, {1e30f, 1, 1}, SIM_CONTAINER_BOX}, {{0, 0, 0}, {1e-30f, 1e-30f, 1e-30f}, SIM_CONTAINER_BOX},
    {{5, 5, 5}, {6, 6, 6}, SIM_CONTAINER_BOX},          {{-50, -50, -50}, {50, 50, 50}, SIM_CONTAINER_BOX}};

const float degenerate_places[DEGENERATE_PLACES] = {NAN, INFINITY, -INFINITY, FLT_MAX, -FLT_MAX, 2e6f};
const float degenerate_radii[DEGENERATE_RADII] = {0, NAN, INFINITY, -1, FLT_MAX, FLT_MIN, 30, 1e-6f, DEGENERATE_RADIUS};
const float degenerate_frame_radii[DEGENERATE_FRAME_RADII] = {NAN, 0, -1, INFINITY, 1e-9f, 1e-4f, 1, 1e6f};

const int32_t degenerate_sizes[DEGENERATE_SIZES][2] = {{1, 1}, {1, 40}, {40, 1}, {3, 2}, {33, 31}, {65, 97}};

void degenerate_expect_layer(Harness *harness, const char *what, const char *layer, const SimFrame *frame,
                             const RenderView *view, const RenderSettings *settings) {
  assert_true(render_show_layer(harness->render, layer));
  free(harness_draw(harness, frame, view, settings));
  int32_t channels;
  assert_true(render_read_layer(harness->render, NULL, &channels));
  const size_t count = (size_t)channels * (size_t)harness->width * (size_t)harness->height;
  float *values = malloc(count * sizeof *values);
  assert_true(render_read_layer(harness->render, values, &channels));
  for (size_t k = 0; k < count; ++k) {
    if (!isfinite(values[k])) fail_msg("%s: layer %s holds %g", what, layer, (double)values[k]);
  }
  free(values);
  assert_true(render_show_layer(harness->render, NULL));
}

void degenerate_expect_picture(Harness *harness, const char *what, const SimFrame *frame, const RenderView *view,
                               const RenderSettings *settings) {
  uint8_t *rgb = harness_draw(harness, frame, view, settings);
  for (int i = 0; i < harness->width * harness->height; ++i) {
    const uint8_t *p = rgb + 3 * i;
    if (p[0] < 4 && p[1] < 4 && p[2] < 4) {
      fail_msg("%s: pixel %d, %d is black", what, i % harness->width, i / harness->width);
    }
  }
  free(rgb);
  assert_int_equal(render_gl_error_count(harness->render), 0);
}

void degenerate_expect_clean(Harness *harness, const char *what, const SimFrame *frame, const RenderView *view,
                             const RenderSettings *settings) {
  degenerate_expect_picture(harness, what, frame, view, settings);
  for (int32_t i = 0; i < render_layer_count(settings->style); ++i) {
    degenerate_expect_layer(harness, what, render_layer_name(settings->style, i), frame, view, settings);
  }
}
