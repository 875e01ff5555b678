// The eye of the window against computed truth: rays, round trips, and the point under the cursor.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "app/camera.h"

#define PI 3.14159265358979323846
enum { WIDTH = 1280, HEIGHT = 720 };

static void assert_near(double got, double want, double tolerance) {
  if (!(fabs(got - want) <= tolerance)) fail_msg("got %.9g, want %.9g within %g", got, want, tolerance);
}

static void assert_near3(const float got[3], double x, double y, double z, double tolerance) {
  assert_near(got[0], x, tolerance);
  assert_near(got[1], y, tolerance);
  assert_near(got[2], z, tolerance);
}

static double distance_to(const float a[3], const float b[3]) {
  double sum = 0;
  for (int k = 0; k < 3; k++) sum += ((double)a[k] - b[k]) * ((double)a[k] - b[k]);
  return sqrt(sum);
}

static RenderView some_view(void) {
  return (RenderView){.eye = {3, 2.5f, 4}, .target = {1.5f, 0.4f, 0.5f}, .vertical_fov = 38};
}

// ---- A view becomes a camera and a view again ----------------------------------------------------------------------

static void views_survive_the_round_trip(void **state) {
  (void)state;
  for (int i = 0; i < 200; i++) {
    double yaw = -PI + 2 * PI * i / 200, pitch = -1.5 + 3.0 * ((i * 37) % 200) / 200;
    RenderView view = {.target = {1, -2, 3}, .vertical_fov = 50};
    view.eye[0] = (float)(1 + 4 * cos(pitch) * sin(yaw));
    view.eye[1] = (float)(-2 + 4 * sin(pitch));
    view.eye[2] = (float)(3 + 4 * cos(pitch) * cos(yaw));
    Camera camera = camera_from_view(&view, 3);
    RenderView back = camera_view(&camera);
    assert_near(camera.distance, 4, 1e-5);
    assert_near3(back.eye, view.eye[0], view.eye[1], view.eye[2], 1e-5);
    assert_near3(back.target, 1, -2, 3, 0);
    assert_near(back.vertical_fov, 50, 0);
  }
}

static void an_eye_on_its_target_steps_back(void **state) {
  (void)state;
  RenderView view = {.eye = {1, 1, 1}, .target = {1, 1, 1}, .vertical_fov = 38};
  Camera camera = camera_from_view(&view, 2);
  RenderView back = camera_view(&camera);
  assert_near3(back.eye, 1, 1, 3, 1e-6);
}

static void an_eye_above_stays_just_short_of_the_pole(void **state) {
  (void)state;
  RenderView view = {.eye = {0, 5, 0}, .vertical_fov = 38};
  Camera camera = camera_from_view(&view, 5);
  RenderView back = camera_view(&camera);
  assert_near(back.eye[0], 0, 1e-6);
  assert_near(back.eye[1], 5 * sin(89 * PI / 180), 1e-5);
  assert_near(back.eye[2], 5 * cos(89 * PI / 180), 1e-5);
}

// ---- Axes and rays --------------------------------------------------------------------------------------------------

static void axes_are_orthonormal_and_level(void **state) {
  (void)state;
  const float eyes[][3] = {{3, 2, 1}, {-1, -4, 2}, {0, 5, 0}, {0, -5, 0}, {0, 0, -2}, {0, 0, 0}};
  for (size_t i = 0; i < sizeof eyes / sizeof eyes[0]; i++) {
    RenderView view = {.eye = {eyes[i][0], eyes[i][1], eyes[i][2]}, .vertical_fov = 38};
    float right[3], up[3], forward[3], zero[3] = {0};
    camera_axes(&view, right, up, forward);
    assert_near(distance_to(right, zero), 1, 1e-6);
    assert_near(distance_to(up, zero), 1, 1e-6);
    assert_near(distance_to(forward, zero), 1, 1e-6);
    assert_near(right[1], 0, 1e-6); // no roll
    // right × up = −forward: a right-handed picture, not a mirrored one.
    assert_near(right[1] * up[2] - right[2] * up[1], -forward[0], 1e-6);
    assert_near(right[2] * up[0] - right[0] * up[2], -forward[1], 1e-6);
    assert_near(right[0] * up[1] - right[1] * up[0], -forward[2], 1e-6);
  }
}

static void the_centre_ray_is_the_view_direction(void **state) {
  (void)state;
  RenderView view = some_view();
  float origin[3], ray[3], right[3], up[3], forward[3];
  camera_ray(&view, WIDTH / 2.0f, HEIGHT / 2.0f, WIDTH, HEIGHT, origin, ray);
  camera_axes(&view, right, up, forward);
  assert_near3(origin, view.eye[0], view.eye[1], view.eye[2], 0);
  assert_near3(ray, forward[0], forward[1], forward[2], 1e-6);
  double length = sqrt(1.5 * 1.5 + 2.1 * 2.1 + 3.5 * 3.5);
  assert_near3(ray, -1.5 / length, -2.1 / length, -3.5 / length, 1e-6);
}

static void edge_rays_open_the_field_of_view(void **state) {
  (void)state;
  RenderView view = {.eye = {0, 0, 0}, .target = {0, 0, -1}, .vertical_fov = 90};
  float origin[3], ray[3];
  camera_ray(&view, 100, 0, 200, 100, origin, ray); // top edge: 45° up
  assert_near3(ray, 0, sqrt(0.5), -sqrt(0.5), 1e-6);
  camera_ray(&view, 200, 50, 200, 100, origin, ray); // right edge: twice as far out as the top
  assert_near3(ray, 2 / sqrt(5), 0, -1 / sqrt(5), 1e-6);
}

static void points_on_a_ray_project_to_its_pixel(void **state) {
  (void)state;
  RenderView view = some_view();
  for (int i = 0; i < 100; i++) {
    float x = (float)((i * 131) % WIDTH), y = (float)((i * 71) % HEIGHT), px, py;
    float origin[3], ray[3], point[3];
    camera_ray(&view, x, y, WIDTH, HEIGHT, origin, ray);
    for (int k = 0; k < 3; k++) point[k] = origin[k] + (0.5f + 0.1f * (float)i) * ray[k];
    assert_true(camera_project(&view, point, WIDTH, HEIGHT, &px, &py));
    assert_near(px, x, 0.01);
    assert_near(py, y, 0.01);
  }
  float behind[3] = {4, 3, 6}, px, py;
  assert_false(camera_project(&view, behind, WIDTH, HEIGHT, &px, &py));
}

// ---- Orbit, pan, zoom -----------------------------------------------------------------------------------------------

static void orbit_keeps_target_and_distance(void **state) {
  (void)state;
  RenderView view = some_view();
  Camera camera = camera_from_view(&view, 3);
  for (int i = 0; i < 500; i++) {
    camera_orbit(&camera, (float)((i * 97) % 301 - 150), (float)((i * 53) % 211 - 105), HEIGHT);
    RenderView turned = camera_view(&camera);
    assert_near(distance_to(turned.eye, turned.target), camera.distance, 1e-4);
    assert_near3(turned.target, view.target[0], view.target[1], view.target[2], 0);
    assert_true(fabsf(camera.yaw) <= (float)PI + 1e-6f);
  }
}

static void orbit_turns_as_far_as_it_says(void **state) {
  (void)state;
  RenderView view = {.eye = {0, 0, 2}, .vertical_fov = 38};
  Camera camera = camera_from_view(&view, 2);
  camera_orbit(&camera, -HEIGHT / 2.0f, 0, HEIGHT); // a quarter: dragging left shows the right-hand side
  assert_near3(camera_view(&camera).eye, 2, 0, 0, 1e-5);
  camera_orbit(&camera, 0, HEIGHT / 6.0f, HEIGHT); // 30° up: dragging down looks from above
  assert_near3(camera_view(&camera).eye, 2 * cos(PI / 6), 1, 0, 1e-5);
}

static void orbit_never_flips(void **state) {
  (void)state;
  RenderView view = some_view();
  Camera camera = camera_from_view(&view, 3);
  for (int turn = -1; turn <= 1; turn += 2) {
    for (int i = 0; i < 50; i++) {
      camera_orbit(&camera, 0, (float)(turn * 100), HEIGHT);
      float right[3], up[3], forward[3];
      RenderView turned = camera_view(&camera);
      camera_axes(&turned, right, up, forward);
      assert_true(up[1] > 0.01f);
    }
    assert_near(camera.pitch, turn * CAMERA_MAX_PITCH, 1e-6);
  }
}

// The point of the target's plane that a pixel shows.
static void point_under(const Camera *camera, float x, float y, float point[3]) {
  RenderView view = camera_view(camera);
  float origin[3], ray[3], right[3], up[3], forward[3];
  camera_ray(&view, x, y, WIDTH, HEIGHT, origin, ray);
  camera_axes(&view, right, up, forward);
  float along = ray[0] * forward[0] + ray[1] * forward[1] + ray[2] * forward[2];
  for (int k = 0; k < 3; k++) point[k] = origin[k] + camera->distance / along * ray[k];
}

static void panning_moves_the_point_under_the_cursor_with_it(void **state) {
  (void)state;
  RenderView view = some_view();
  Camera camera = camera_from_view(&view, 3);
  for (int i = 0; i < 50; i++) {
    float x = (float)((i * 131) % WIDTH), y = (float)((i * 71) % HEIGHT);
    float dx = (float)((i * 17) % 61 - 30), dy = (float)((i * 29) % 47 - 23), point[3], px, py;
    point_under(&camera, x, y, point);
    camera_pan(&camera, dx, dy, HEIGHT);
    RenderView panned = camera_view(&camera);
    assert_true(camera_project(&panned, point, WIDTH, HEIGHT, &px, &py));
    assert_near(px, x + dx, 0.02);
    assert_near(py, y + dy, 0.02);
  }
}

static void zoom_keeps_its_limits(void **state) {
  (void)state;
  RenderView view = {.eye = {0, 0, 2}, .vertical_fov = 38};
  Camera camera = camera_from_view(&view, 2);
  camera_zoom(&camera, 1);
  assert_near(camera.distance, 1.8, 1e-6);
  camera_zoom(&camera, -1);
  assert_near(camera.distance, 2, 1e-6);
  camera_zoom(&camera, 1e6f);
  assert_near(camera.distance, 0.1, 1e-6);
  camera_zoom(&camera, -1e6f);
  assert_near(camera.distance, 20, 1e-5);
}

static void limits_hold_a_view_from_far_away(void **state) {
  (void)state;
  RenderView view = {.eye = {0, 0, 500}, .vertical_fov = 38};
  Camera camera = camera_from_view(&view, 2);
  assert_near(camera.max_distance, 500, 1e-3);
  assert_near(camera_view(&camera).eye[2], 500, 1e-3);
}

static void nonsense_leaves_the_camera_usable(void **state) {
  (void)state;
  RenderView view = some_view();
  Camera before = camera_from_view(&view, 3), camera = before;
  camera_orbit(&camera, NAN, NAN, HEIGHT);
  camera_pan(&camera, NAN, INFINITY, HEIGHT);
  camera_zoom(&camera, NAN);
  assert_memory_equal(&camera, &before, sizeof camera);
  camera_orbit(&camera, 10, 10, 0);
  camera_pan(&camera, 10, 10, 0);
  RenderView after = camera_view(&camera);
  for (int k = 0; k < 3; k++) assert_true(isfinite(after.eye[k]) && isfinite(after.target[k]));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(views_survive_the_round_trip),
      cmocka_unit_test(an_eye_on_its_target_steps_back),
      cmocka_unit_test(an_eye_above_stays_just_short_of_the_pole),
      cmocka_unit_test(axes_are_orthonormal_and_level),
      cmocka_unit_test(the_centre_ray_is_the_view_direction),
      cmocka_unit_test(edge_rays_open_the_field_of_view),
      cmocka_unit_test(points_on_a_ray_project_to_its_pixel),
      cmocka_unit_test(orbit_keeps_target_and_distance),
      cmocka_unit_test(orbit_turns_as_far_as_it_says),
      cmocka_unit_test(orbit_never_flips),
      cmocka_unit_test(panning_moves_the_point_under_the_cursor_with_it),
      cmocka_unit_test(zoom_keeps_its_limits),
      cmocka_unit_test(limits_hold_a_view_from_far_away),
      cmocka_unit_test(nonsense_leaves_the_camera_usable),
  };
  return cmocka_run_group_tests_name("app_camera", tests, NULL, NULL);
}
