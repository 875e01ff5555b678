#include "tests/render/harness.h"

#include <math.h>
#include <stdlib.h>

Harness harness_open(ContextKind kind, int32_t width, int32_t height) {
  Harness harness = {.width = width, .height = height};
  AppError app_error = {0};
  harness.context = context_create_headless(kind, &app_error);
  if (harness.context == NULL) fail_msg("%s", app_error.message);
  RenderError error = {0};
  harness.render = render_create(width, height, &error);
  if (harness.render == NULL) fail_msg("%s", error.message);
  return harness;
}

void harness_close(Harness *harness) {
  assert_int_equal(render_gl_error_count(harness->render), 0);
  render_destroy(harness->render);
  context_destroy(harness->context);
  *harness = (Harness){0};
}

int harness_open_group(void **state, int32_t width, int32_t height) {
  Harness *harness = malloc(sizeof *harness);
  assert_non_null(harness);
  *harness = harness_open(CONTEXT_AUTO, width, height);
  *state = harness;
  return 0;
}

int harness_close_group(void **state) {
  harness_close(*state);
  free(*state);
  return 0;
}

RenderSettings harness_pinned_settings(void) {
  RenderSettings settings = render_default_settings();
  settings.sun = false;
  settings.shadow = false;
  settings.sky = RENDER_SKY_GRADIENT;
  settings.floor = RENDER_FLOOR_CHECKER;
  settings.floor_level = 0;
  settings.container_visible = false;
  settings.tone_map = RENDER_TONE_NONE;
  return settings;
}

RenderView harness_view(float ex, float ey, float ez, float tx, float ty, float tz, float fov) {
  return (RenderView){{ex, ey, ez}, {tx, ty, tz}, fov};
}

uint8_t *harness_draw(Harness *harness, const SimFrame *frame, const RenderView *view, const RenderSettings *settings) {
  RenderError error = {0};
  if (!render_draw(harness->render, frame, view, settings, &error)) fail_msg("%s", error.message);
  uint8_t *rgb = malloc(3 * (size_t)harness->width * (size_t)harness->height);
  assert_non_null(rgb);
  render_read_rgb8(harness->render, rgb);
  return rgb;
}

float *harness_layer(Harness *harness, const char *layer, int32_t channels, const SimFrame *frame,
                     const RenderView *view, const RenderSettings *settings) {
  assert_true(render_show_layer(harness->render, layer));
  free(harness_draw(harness, frame, view, settings));
  int32_t count = 0;
  assert_true(render_read_layer(harness->render, NULL, &count));
  assert_int_equal(count, channels);
  float *values = malloc(sizeof(float) * (size_t)count * (size_t)harness->width * (size_t)harness->height);
  assert_non_null(values);
  assert_true(render_read_layer(harness->render, values, &count));
  assert_true(render_show_layer(harness->render, NULL));
  return values;
}

// ---- The camera's truth, in double precision -------------------------------------------------------------------------

static void cross(double out[3], const double a[3], const double b[3]) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void normalize(double v[3]) {
  const double length = sqrt(dot(v, v));
  for (int k = 0; k < 3; ++k) v[k] /= length;
}

typedef struct Camera {
  double gaze[3], right[3], up[3], tan_x, tan_y;
} Camera;

static Camera camera_of(const RenderView *view, int32_t width, int32_t height) {
  Camera camera;
  const double y_axis[3] = {0, 1, 0};
  for (int k = 0; k < 3; ++k) camera.gaze[k] = (double)view->target[k] - (double)view->eye[k];
  normalize(camera.gaze);
  cross(camera.right, camera.gaze, y_axis);
  normalize(camera.right);
  cross(camera.up, camera.right, camera.gaze);
  camera.tan_y = tan((double)view->vertical_fov * 3.14159265358979323846 / 360);
  camera.tan_x = camera.tan_y * width / height;
  return camera;
}

Ray harness_ray(const RenderView *view, int32_t width, int32_t height, int32_t x, int32_t y) {
  const Camera camera = camera_of(view, width, height);
  const double px = camera.tan_x * (2 * (x + 0.5) / width - 1), py = camera.tan_y * (1 - 2 * (y + 0.5) / height);
  Ray ray;
  for (int k = 0; k < 3; ++k) {
    ray.origin[k] = (double)view->eye[k];
    ray.direction[k] = camera.gaze[k] + px * camera.right[k] + py * camera.up[k];
  }
  return ray;
}

double harness_project(const RenderView *view, int32_t width, int32_t height, const double point[3], double pixel[2]) {
  const Camera camera = camera_of(view, width, height);
  double p[3];
  for (int k = 0; k < 3; ++k) p[k] = point[k] - (double)view->eye[k];
  const double depth = dot(p, camera.gaze);
  pixel[0] = (dot(p, camera.right) / depth / camera.tan_x + 1) / 2 * width;
  pixel[1] = (1 - dot(p, camera.up) / depth / camera.tan_y) / 2 * height;
  return depth;
}

// v' = R(x, y, z, w) v
static void rotate(double v[3], double x, double y, double z, double w) {
  const double cx = y * v[2] - z * v[1] + w * v[0], cy = z * v[0] - x * v[2] + w * v[1],
               cz = x * v[1] - y * v[0] + w * v[2];
  v[0] += 2 * (y * cz - z * cy);
  v[1] += 2 * (z * cx - x * cz);
  v[2] += 2 * (x * cy - y * cx);
}

void harness_to_body(double v[3], const float rotation[4]) {
  rotate(v, -(double)rotation[0], -(double)rotation[1], -(double)rotation[2], (double)rotation[3]);
}

void harness_from_body(double v[3], const float rotation[4]) {
  rotate(v, (double)rotation[0], (double)rotation[1], (double)rotation[2], (double)rotation[3]);
}

bool harness_ray_sphere(const Ray *ray, const float centre[3], double radius, double t[2], double *margin) {
  double to_centre[3], foot[3];
  for (int k = 0; k < 3; ++k) to_centre[k] = (double)centre[k] - ray->origin[k];
  const double dd = dot(ray->direction, ray->direction);
  const double middle = dot(to_centre, ray->direction) / dd;
  for (int k = 0; k < 3; ++k) foot[k] = ray->direction[k] * middle - to_centre[k];
  const double distance = sqrt(dot(foot, foot));
  *margin = 1 - distance / radius;
  if (distance >= radius) return false;
  const double half = sqrt((radius * radius - distance * distance) / dd);
  t[0] = middle - half;
  t[1] = middle + half;
  return true;
}
