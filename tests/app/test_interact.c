// The hand in the water: sequences of mouse positions against the pushes they must give.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "app/camera.h"
#include "app/interact.h"

enum { WIDTH = 800, HEIGHT = 400 };

static const SimContainer tank = {.min = {0, 0, 0}, .max = {2, 1, 1}};
static const float earth[3] = {0, -9.81f, 0};

// From the front: right is +x, up is +y, into the picture is −z.
static RenderView front_view(void) {
  return (RenderView){.eye = {1, 0.25f, 5}, .target = {1, 0.25f, 0.5f}, .vertical_fov = 38};
}

static void assert_near(double got, double want, double tolerance) {
  if (!(fabs(got - want) <= tolerance)) fail_msg("got %.9g, want %.9g within %g", got, want, tolerance);
}

static void assert_near3(const float got[3], double x, double y, double z, double tolerance) {
  assert_near(got[0], x, tolerance);
  assert_near(got[1], y, tolerance);
  assert_near(got[2], z, tolerance);
}

static InteractStrength strength_of_tank(void) {
  return interact_strength(&tank, earth, 0.01f);
}

// A stroke from the middle by (dx, dy) pixels in `seconds`.
static int take_stroke(InteractMode mode, float dx, float dy, double seconds, SimPush pushes[INTERACT_MAX_PUSHES]) {
  InteractStrength strength = strength_of_tank();
  RenderView view = front_view();
  Interact hand;
  interact_begin(&hand, mode, WIDTH / 2.0f, HEIGHT / 2.0f);
  interact_move(&hand, WIDTH / 2.0f + dx, HEIGHT / 2.0f + dy);
  return interact_take(&hand, &strength, &view, WIDTH, HEIGHT, seconds, pushes);
}

static void strength_follows_size_and_gravity(void **state) {
  (void)state;
  InteractStrength small = strength_of_tank();
  assert_near(small.radius, sqrt(6) / 8, 1e-6);
  assert_near(small.acceleration, 4 * 9.81, 1e-4);
  assert_near(small.speed, 0.5 * sqrt(9.81 * sqrt(6)), 1e-5);
  const SimContainer large_tank = {.min = {0, 0, 0}, .max = {20, 10, 10}};
  const float moon[3] = {0, -1.62f, 0}, none[3] = {0};
  assert_near(interact_strength(&large_tank, earth, 0.01f).radius, 10 * small.radius, 1e-5);
  assert_near(interact_strength(&tank, moon, 0.01f).acceleration, 4 * 1.62, 1e-5);
  assert_near(interact_strength(&tank, none, 0.01f).acceleration, 4 * 9.81, 1e-4);
  // Coarse water: the hand is never thinner than a few particles.
  assert_near(interact_strength(&tank, earth, 0.1f).radius, 0.8, 1e-6);
}

static void an_idle_hand_does_nothing(void **state) {
  (void)state;
  SimPush pushes[INTERACT_MAX_PUSHES];
  assert_int_equal(take_stroke(INTERACT_NONE, 100, 0, 0.1, pushes), 0);
}

static void a_fast_stroke_drags_in_its_direction(void **state) {
  (void)state;
  const float strokes[][2] = {{200, 0}, {-200, 0}, {0, 150}, {0, -150}, {120, -160}};
  for (size_t i = 0; i < sizeof strokes / sizeof strokes[0]; i++) {
    SimPush pushes[INTERACT_MAX_PUSHES];
    float dx = strokes[i][0], dy = strokes[i][1], length = hypotf(dx, dy);
    int count = take_stroke(INTERACT_PUSH, dx, dy, 0.01, pushes);
    assert_true(count >= 1);
    for (int p = 0; p < count; p++) // pixels count downwards, metres upwards
      assert_near3(pushes[p].acceleration, 4 * 9.81 * dx / length, 4 * 9.81 * -dy / length, 0, 1e-3);
  }
}

static void a_stroke_follows_the_picture_not_the_world(void **state) {
  (void)state;
  // From the right-hand side, the picture's right is −z.
  RenderView view = {.eye = {6, 0.25f, 0.5f}, .target = {1, 0.25f, 0.5f}, .vertical_fov = 38};
  InteractStrength strength = strength_of_tank();
  SimPush pushes[INTERACT_MAX_PUSHES];
  Interact hand;
  interact_begin(&hand, INTERACT_PUSH, 300, 200);
  interact_move(&hand, 500, 200);
  assert_true(interact_take(&hand, &strength, &view, WIDTH, HEIGHT, 0.01, pushes) >= 1);
  assert_near3(pushes[0].acceleration, 0, 0, -4 * 9.81, 1e-3);
}

static void a_slow_stroke_is_weak(void **state) {
  (void)state;
  SimPush slow[INTERACT_MAX_PUSHES], slower[INTERACT_MAX_PUSHES];
  take_stroke(INTERACT_PUSH, 10, 0, 0.1, slow);
  take_stroke(INTERACT_PUSH, 10, 0, 0.2, slower);
  assert_true(slow[0].acceleration[0] > 0.1f);
  assert_near(slower[0].acceleration[0] / slow[0].acceleration[0], 0.5, 0.05);
}

static void a_still_hand_presses_or_lifts_along_the_ray(void **state) {
  (void)state;
  SimPush pushes[INTERACT_MAX_PUSHES];
  assert_int_equal(take_stroke(INTERACT_PUSH, 0, 0, 0.1, pushes), 1);
  assert_near3(pushes[0].acceleration, 0, 0, -2 * 9.81, 1e-3);
  assert_int_equal(take_stroke(INTERACT_PULL, 0, 0, 0.1, pushes), 1);
  assert_near3(pushes[0].acceleration, 0, 0, 2 * 9.81, 1e-3);
}

static void the_ray_goes_through_the_cursor(void **state) {
  (void)state;
  SimPush pushes[INTERACT_MAX_PUSHES];
  RenderView view = front_view();
  take_stroke(INTERACT_PUSH, 90, -60, 0.1, pushes);
  float point[3], x, y;
  for (int k = 0; k < 3; k++) point[k] = pushes[0].origin[k] + 3 * pushes[0].direction[k];
  assert_true(camera_project(&view, point, WIDTH, HEIGHT, &x, &y));
  assert_near(x, WIDTH / 2.0 + 90, 0.01);
  assert_near(y, HEIGHT / 2.0 - 60, 0.01);
  assert_near(pushes[0].radius, strength_of_tank().radius, 0);
}

static void a_long_stroke_is_felt_all_along(void **state) {
  (void)state;
  SimPush pushes[INTERACT_MAX_PUSHES];
  assert_int_equal(take_stroke(INTERACT_PUSH, 5, 0, 0.1, pushes), 1);
  int count = take_stroke(INTERACT_PUSH, 300, 0, 0.1, pushes);
  assert_true(count > 3 && count <= INTERACT_MAX_PUSHES);
  for (int i = 0; i < count; i++) {
    // In the plane of the water (z = 0.5), rays are apart by at most the reach of the hand.
    double along = (0.5 - pushes[i].origin[2]) / pushes[i].direction[2];
    double x = pushes[i].origin[0] + along * pushes[i].direction[0];
    double metres = 2 * 4.5 * tan(19 * 3.14159265358979 / 180) / HEIGHT * 300;
    assert_near(x, 1 + metres * (1 - (double)i / count), 1e-3);
    assert_true(metres / count <= strength_of_tank().radius * 1.0001);
  }
  assert_int_equal(take_stroke(INTERACT_PUSH, 1e7f, 0, 0.1, pushes), INTERACT_MAX_PUSHES);
}

static void each_way_is_taken_once(void **state) {
  (void)state;
  InteractStrength strength = strength_of_tank();
  RenderView view = front_view();
  SimPush pushes[INTERACT_MAX_PUSHES];
  Interact hand;
  interact_begin(&hand, INTERACT_PUSH, 100, 100);
  for (int i = 1; i <= 10; i++) interact_move(&hand, 100 + 30 * (float)i, 100); // several events, one frame
  interact_take(&hand, &strength, &view, WIDTH, HEIGHT, 0.01, pushes);
  assert_near(pushes[0].acceleration[0], 4 * 9.81, 1e-3);
  assert_int_equal(interact_take(&hand, &strength, &view, WIDTH, HEIGHT, 0.01, pushes), 1); // still since then
  assert_near3(pushes[0].acceleration, 2 * 9.81 * pushes[0].direction[0], 2 * 9.81 * pushes[0].direction[1],
               2 * 9.81 * pushes[0].direction[2], 1e-3);
  interact_end(&hand);
  assert_int_equal(interact_take(&hand, &strength, &view, WIDTH, HEIGHT, 0.01, pushes), 1); // the time until then
  assert_int_equal(interact_take(&hand, &strength, &view, WIDTH, HEIGHT, 0.01, pushes), 0);
}

static void a_short_click_is_not_lost(void **state) {
  (void)state;
  InteractStrength strength = strength_of_tank();
  RenderView view = front_view();
  SimPush pushes[INTERACT_MAX_PUSHES];
  Interact hand;
  interact_begin(&hand, INTERACT_PULL, 400, 200); // down, moved and up again within one frame
  interact_move(&hand, 500, 200);
  interact_end(&hand);
  assert_true(interact_take(&hand, &strength, &view, WIDTH, HEIGHT, 0.01, pushes) >= 1);
  assert_near3(pushes[0].acceleration, 4 * 9.81, 0, 0, 1e-3);
  assert_int_equal(interact_take(&hand, &strength, &view, WIDTH, HEIGHT, 0.01, pushes), 0);
}

static void a_leaning_tank_sends_water_to_that_side(void **state) {
  (void)state;
  RenderView view = front_view();
  float leaned[3], angle = INTERACT_MAX_LEAN;
  interact_lean(earth, &view, angle, 0, leaned);
  assert_near3(leaned, 9.81 * sin(angle), -9.81 * cos(angle), 0, 1e-5);
  interact_lean(earth, &view, 0, angle, leaned); // away from the eye is −z here
  assert_near3(leaned, 0, -9.81 * cos(angle), -9.81 * sin(angle), 1e-5);
  interact_lean(earth, &view, 0.1f, -0.2f, leaned);
  assert_near(sqrt((double)leaned[0] * leaned[0] + leaned[1] * leaned[1] + leaned[2] * leaned[2]), 9.81, 1e-4);
  interact_lean(earth, &view, 0, 0, leaned);
  assert_near3(leaned, 0, -9.81f, 0, 0);
  const float none[3] = {0};
  interact_lean(none, &view, angle, 0, leaned);
  assert_near3(leaned, 0, 0, 0, 0);
  // Looking straight down, away is up in the picture.
  RenderView above = {.eye = {1, 5, 0.5f}, .target = {1, 0, 0.5f}, .vertical_fov = 38};
  interact_lean(earth, &above, 0, angle, leaned);
  assert_near3(leaned, 0, -9.81 * cos(angle), -9.81 * sin(angle), 1e-5);
}

static void a_hand_leans_a_tank_as_far_as_it_goes(void **state) {
  (void)state;
  const SimContainer box = {{0}, {1, 1, 1}, SIM_CONTAINER_BOX}, glass = {{0}, {1, 1, 1}, SIM_CONTAINER_GLASS};
  const float degree = 3.14159265f / 180, none[2] = {0}, right[2] = {1, 0}, keys[2] = {-1, 1};
  float goal[2];
  interact_lean_goal(&box, none, none, HEIGHT, goal);
  assert_true(goal[0] == 0 && goal[1] == 0);
  // A tenth of the picture's height is 9°, whatever the height.
  for (int height = 100; height <= 1600; height *= 4) {
    const float hand[2] = {0.1f * (float)height, -0.05f * (float)height};
    interact_lean_goal(&box, none, hand, height, goal);
    assert_near(goal[0], 9 * degree, 1e-6);
    assert_near(goal[1], -4.5 * degree, 1e-6);
  }
  // Keys and hand add up, and a tank stops at its most where a glass goes on; in any direction.
  const float hand[2] = {0.1f * HEIGHT, 0}, far[2] = {3e7f, 4e7f};
  interact_lean_goal(&glass, right, hand, HEIGHT, goal);
  assert_near(goal[0], 29 * degree, 1e-6);
  interact_lean_goal(&box, right, hand, HEIGHT, goal);
  assert_near(goal[0], INTERACT_MAX_LEAN, 1e-6);
  interact_lean_goal(&glass, none, far, HEIGHT, goal);
  assert_near(goal[0], 0.6 * INTERACT_MAX_GLASS_LEAN, 1e-6);
  assert_near(goal[1], 0.8 * INTERACT_MAX_GLASS_LEAN, 1e-6);
  interact_lean_goal(&box, keys, none, 0, goal);
  assert_near(hypotf(goal[0], goal[1]), INTERACT_MAX_LEAN, 1e-6);
}

static void a_tank_springs_back_evenly(void **state) {
  (void)state;
  InteractLean lean = {0};
  const float there[2] = {0.3f, -0.1f}, upright[2] = {0};
  assert_false(interact_lean_step(&lean, upright, 1.0 / 60)); // it stands: gravity is left alone
  for (int frame = 0; frame < 20; frame++) assert_true(interact_lean_step(&lean, there, 1.0 / 60));
  assert_near(lean.angle[0], 0.3 * (1 - exp(-20.0 / 60 / 0.12)), 1e-5);
  assert_near(lean.angle[1], -lean.angle[0] / 3, 1e-6);
  int frames = 0;
  for (float before = lean.angle[0]; interact_lean_step(&lean, upright, 1.0 / 60); before = lean.angle[0], frames++) {
    assert_true(lean.angle[0] < before && lean.angle[0] >= 0); // never beyond, never a jump
    assert_true(before - lean.angle[0] < 0.15f * 0.3f);
  }
  assert_true(!lean.leans && lean.angle[0] == 0 && lean.angle[1] == 0);
  assert_in_range(frames, 20, 60); // the last of them has set gravity upright
  // The same way in steps of any length.
  InteractLean coarse = {0}, fine = {0};
  for (int k = 0; k < 10; k++) interact_lean_step(&coarse, there, 0.02);
  for (int k = 0; k < 100; k++) interact_lean_step(&fine, there, 0.002);
  assert_near(coarse.angle[0], fine.angle[0], 1e-5);
}

static void nonsense_gives_no_push(void **state) {
  (void)state;
  SimPush pushes[INTERACT_MAX_PUSHES];
  assert_int_equal(take_stroke(INTERACT_PUSH, NAN, 0, 0.1, pushes), 0);
  assert_int_equal(take_stroke(INTERACT_PUSH, INFINITY, 0, 0.1, pushes), 0);
  assert_int_equal(take_stroke(INTERACT_PUSH, 10, 0, 0, pushes), 0);
  assert_int_equal(take_stroke(INTERACT_PUSH, 10, 0, NAN, pushes), 0);
}

static void an_eye_in_the_water_still_pushes_finitely(void **state) {
  (void)state;
  InteractStrength strength = strength_of_tank();
  RenderView view = {.eye = {1, 0.25f, 0.5f}, .target = {1, 0.25f, -1}, .vertical_fov = 38};
  SimPush pushes[INTERACT_MAX_PUSHES];
  Interact hand;
  interact_begin(&hand, INTERACT_PUSH, 100, 100);
  interact_move(&hand, 300, 100);
  int count = interact_take(&hand, &strength, &view, WIDTH, HEIGHT, 0.01, pushes);
  assert_true(count >= 1);
  for (int k = 0; k < 3; k++) assert_true(isfinite(pushes[0].acceleration[k]));
  assert_true(pushes[0].acceleration[0] > 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(strength_follows_size_and_gravity),
      cmocka_unit_test(an_idle_hand_does_nothing),
      cmocka_unit_test(a_fast_stroke_drags_in_its_direction),
      cmocka_unit_test(a_stroke_follows_the_picture_not_the_world),
      cmocka_unit_test(a_slow_stroke_is_weak),
      cmocka_unit_test(a_still_hand_presses_or_lifts_along_the_ray),
      cmocka_unit_test(the_ray_goes_through_the_cursor),
      cmocka_unit_test(a_long_stroke_is_felt_all_along),
      cmocka_unit_test(each_way_is_taken_once),
      cmocka_unit_test(a_short_click_is_not_lost),
      cmocka_unit_test(a_leaning_tank_sends_water_to_that_side),
      cmocka_unit_test(a_hand_leans_a_tank_as_far_as_it_goes),
      cmocka_unit_test(a_tank_springs_back_evenly),
      cmocka_unit_test(nonsense_gives_no_push),
      cmocka_unit_test(an_eye_in_the_water_still_pushes_finitely),
  };
  return cmocka_run_group_tests_name("app_interact", tests, NULL, NULL);
}
