// What the renderer's tests share: a context, a renderer, the pinned environment, and the camera's truth in C.
#ifndef LIDO_TESTS_RENDER_HARNESS_H
#define LIDO_TESTS_RENDER_HARNESS_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "app/context.h"
#include "render/render.h"
#include "tests/render/frames.h"

/// A context and a renderer in it. Every function fails the test at once when something does not work.
typedef struct Harness {
  Context *context;
  Render *render;
  int32_t width, height;
} Harness;

Harness harness_open(ContextKind kind, int32_t width, int32_t height);
void harness_close(Harness *harness); ///< also asserts that GL reported nothing
/// One for all tests of a group, as its state: to be called in its setup, and as its teardown.
int harness_open_group(void **state, int32_t width, int32_t height);
int harness_close_group(void **state);

/// Gradient sky, checker floor at y = 0, no sun, no container, no tone map: a picture that can be computed.
RenderSettings harness_pinned_settings(void);
RenderView harness_view(float ex, float ey, float ez, float tx, float ty, float tz, float fov);

/// Draw and read back; (height, width, 3), to be freed.
uint8_t *harness_draw(Harness *harness, const SimFrame *frame, const RenderView *view, const RenderSettings *settings);
/// Draw with `layer` shown and read its values; (height, width, channels), to be freed. The picture is shown again after.
float *harness_layer(Harness *harness, const char *layer, int32_t channels, const SimFrame *frame,
                     const RenderView *view, const RenderSettings *settings);

/// The ray through the middle of pixel (x, y), counted from the top left. Its length along the view axis is 1, so that
/// a parameter along it is the depth.
typedef struct Ray {
  double origin[3], direction[3];
} Ray;
Ray harness_ray(const RenderView *view, int32_t width, int32_t height, int32_t x, int32_t y);

/// Where a point is in the picture, pixels from the top left corner; returns its depth, negative behind the eye.
double harness_project(const RenderView *view, int32_t width, int32_t height, const double point[3], double pixel[2]);

/// Turn a vector from the world's axes into those of a body with this rotation, and back.
void harness_to_body(double v[3], const float rotation[4]);
void harness_from_body(double v[3], const float rotation[4]);

/// Depths of entry and exit of a ray and a sphere; false when it misses. *margin: how far inside the silhouette the ray
/// passes, in radii (negative outside).
bool harness_ray_sphere(const Ray *ray, const float centre[3], double radius, double t[2], double *margin);

#endif
