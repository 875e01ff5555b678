#include "app/camera.h"

#include <math.h>

#define PI 3.14159265358979323846

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3]) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

static double normalise(double v[3]) {
  double length = sqrt(dot(v, v));
  if (length > 0)
    for (int k = 0; k < 3; k++) v[k] /= length;
  return length;
}

static float clamp(float value, float low, float high) {
  return fminf(fmaxf(value, low), high);
}

// Axes of a view in double: [0] right, [1] up, [2] forward.
static void axes_of(const RenderView *view, double axes[3][3]) {
  for (int k = 0; k < 3; k++) axes[2][k] = (double)view->target[k] - view->eye[k];
  if (!(normalise(axes[2]) > 0)) axes[2][0] = 0, axes[2][1] = 0, axes[2][2] = -1;
  // Straight up or down there is no horizon to keep level: take −z (or +z, looking up) as up.
  double up[3] = {0, 1, 0};
  cross(axes[2], up, axes[0]);
  if (!(normalise(axes[0]) > 1e-6)) {
    up[1] = 0, up[2] = axes[2][1] > 0 ? 1 : -1;
    cross(axes[2], up, axes[0]);
    normalise(axes[0]);
  }
  cross(axes[0], axes[2], axes[1]);
}

static double tan_half_fov(float vertical_fov) {
  return tan(vertical_fov * PI / 360);
}

void camera_axes(const RenderView *view, float right[3], float up[3], float forward[3]) {
  double axes[3][3];
  axes_of(view, axes);
  for (int k = 0; k < 3; k++) {
    right[k] = (float)axes[0][k];
    up[k] = (float)axes[1][k];
    forward[k] = (float)axes[2][k];
  }
}

Camera camera_from_view(const RenderView *view, float size) {
  double offset[3];
  for (int k = 0; k < 3; k++) offset[k] = (double)view->eye[k] - view->target[k];
  double distance = normalise(offset);
  if (!(distance > 0)) {
    distance = size;
    offset[0] = 0, offset[1] = 0, offset[2] = 1;
  }
  Camera camera = {.target = {view->target[0], view->target[1], view->target[2]},
                   .pitch = clamp((float)asin(fmin(fmax(offset[1], -1), 1)), -CAMERA_MAX_PITCH, CAMERA_MAX_PITCH),
                   .distance = (float)distance,
                   .min_distance = fminf(0.05f * size, (float)distance),
                   .max_distance = fmaxf(10 * size, (float)distance),
                   .vertical_fov = view->vertical_fov};
  // Above the pole any yaw will do; 0 agrees with camera_axes, whose up is then −z.
  if (offset[0] != 0 || offset[2] != 0) camera.yaw = (float)atan2(offset[0], offset[2]);
  return camera;
}

RenderView camera_view(const Camera *camera) {
  double level = cos(camera->pitch) * camera->distance;
  RenderView view = {.vertical_fov = camera->vertical_fov};
  const double offset[3] = {level * sin(camera->yaw), sin(camera->pitch) * camera->distance, level * cos(camera->yaw)};
  for (int k = 0; k < 3; k++) {
    view.target[k] = camera->target[k];
    view.eye[k] = (float)(camera->target[k] + offset[k]);
  }
  return view;
}

void camera_orbit(Camera *camera, float dx, float dy, int height) {
  double turn = PI / (height > 0 ? height : 1);
  double yaw = remainder(camera->yaw - dx * turn, 2 * PI);
  double pitch = camera->pitch + dy * turn;
  if (isfinite(yaw)) camera->yaw = (float)yaw;
  if (isfinite(pitch)) camera->pitch = clamp((float)pitch, -CAMERA_MAX_PITCH, CAMERA_MAX_PITCH);
}

void camera_pan(Camera *camera, float dx, float dy, int height) {
  RenderView view = camera_view(camera);
  double axes[3][3];
  axes_of(&view, axes);
  double metres = 2 * tan_half_fov(camera->vertical_fov) * camera->distance / (height > 0 ? height : 1);
  for (int k = 0; k < 3; k++) {
    double target = camera->target[k] + metres * (dy * axes[1][k] - dx * axes[0][k]);
    if (isfinite(target)) camera->target[k] = (float)target;
  }
}

void camera_zoom(Camera *camera, float steps) {
  double distance = camera->distance * pow(0.9, steps);
  if (isnan(distance)) return;
  camera->distance = (float)fmin(fmax(distance, camera->min_distance), camera->max_distance);
}

void camera_ray(const RenderView *view, float x, float y, int width, int height, float origin[3], float direction[3]) {
  double axes[3][3], ray[3];
  axes_of(view, axes);
  double scale = 2 * tan_half_fov(view->vertical_fov) / (height > 0 ? height : 1);
  double right = (x - 0.5 * width) * scale, up = (0.5 * height - y) * scale;
  for (int k = 0; k < 3; k++) ray[k] = axes[2][k] + right * axes[0][k] + up * axes[1][k];
  normalise(ray);
  for (int k = 0; k < 3; k++) {
    origin[k] = view->eye[k];
    direction[k] = (float)ray[k];
  }
}

bool camera_project(const RenderView *view, const float point[3], int width, int height, float *x, float *y) {
  double axes[3][3], offset[3];
  axes_of(view, axes);
  for (int k = 0; k < 3; k++) offset[k] = (double)point[k] - view->eye[k];
  double depth = dot(offset, axes[2]);
  if (!(depth > 0)) return false;
  double pixels = height / (2 * tan_half_fov(view->vertical_fov) * depth);
  *x = (float)(0.5 * width + dot(offset, axes[0]) * pixels);
  *y = (float)(0.5 * height - dot(offset, axes[1]) * pixels);
  return true;
}
