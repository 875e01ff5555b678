// The outline of a box that stands in level water, seen through it: the style "heightfield" against traced rays, with one eye
// for every ray, with one for the object and its scaling (Cords 2007, Figure 3), and without that.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/render/pool_reference.h"

#define WIDTH 640
#define HEIGHT 480
#define PIXELS ((size_t)WIDTH * HEIGHT)
#define LEVEL 0.5f
#define PI 3.14159265358979323846

enum { NODES = 101, ANGLES = 3 };
static const double angles[ANGLES] = {20, 45, 70}; // of the view, degrees below the horizon

// ---- The measure -----------------------------------------------------------------------------------------------------

// A rectangle seen through the water, and over it one seen directly.
static PoolOutline rectangle(int left, int top, int right, int bottom) {
  uint8_t *seen = calloc(PIXELS, 1);
  assert_non_null(seen);
  for (int y = top - 40; y < bottom; ++y) {
    for (int x = left; x < right; ++x) seen[y * WIDTH + x] = y < top ? POOL_DIRECT : POOL_THROUGH_WATER;
  }
  const PoolOutline outline = pool_outline(seen, WIDTH, HEIGHT);
  free(seen);
  return outline;
}

static void expect_error(PoolOutline a, PoolOutline b, double largest, double most) {
  const PoolError error = pool_compare(&a, &b), back = pool_compare(&b, &a);
  assert_float_equal(error.largest, largest, 1e-6);
  assert_float_equal(error.most, most, 1e-6);
  assert_float_equal(back.largest, largest, 1e-6);
  pool_outline_destroy(&a);
  pool_outline_destroy(&b);
}

static void test_measure(void **state) {
  (void)state;
  expect_error(rectangle(200, 200, 300, 300), rectangle(200, 200, 300, 300), 0, 0);
  expect_error(rectangle(200, 200, 300, 300), rectangle(203, 200, 303, 300), 3, 3);
  expect_error(rectangle(200, 200, 300, 300), rectangle(200, 200, 300, 307), 7, 7);
  // The waterline itself counts only with what is seen of it at the sides, which is in both.
  expect_error(rectangle(200, 200, 300, 300), rectangle(200, 190, 300, 300), 0, 0);
  // A corner is as far away as it is, to the middle of its last side.
  expect_error(rectangle(200, 200, 300, 300), rectangle(200, 200, 303, 304), hypot(2.5, 4), 4);
}

// A part that is missing is not overlooked.
static void test_measure_of_nothing(void **state) {
  (void)state;
  PoolOutline some = rectangle(200, 200, 300, 300), none = rectangle(200, 200, 200, 200);
  assert_true(isinf(pool_compare(&some, &none).largest));
  assert_true(isinf(pool_compare(&none, &some).largest));
  assert_true(pool_compare(&none, &none).largest == 0);
  pool_outline_destroy(&some);
  pool_outline_destroy(&none);
  expect_error(rectangle(200, 200, 300, 300), rectangle(200, 200, 300, 201), 99, 99);
}

// ---- A box in a pool -------------------------------------------------------------------------------------------------

typedef struct Scene {
  TestFrame *frame;
  float height[NODES * NODES];
  Pool pool;
  RenderSettings settings;
  RenderWaterObjects found;
} Scene;

static Scene *scene_create(float width) {
  Scene *s = calloc(1, sizeof *s);
  assert_non_null(s);
  s->frame = test_frame_create(1, 0.02f);
  SimFrame *frame = &s->frame->frame;
  frame->container = (SimContainer){.min = {-2, 0, -2}, .max = {2, 1.2f, 2}};
  memcpy(frame->bounds_min, frame->container.min, sizeof frame->bounds_min);
  memcpy(frame->bounds_max, frame->container.max, sizeof frame->bounds_max);
  s->frame->obstacles[frame->obstacle_count++] = (SimObstacle){.shape = SIM_BOX,
                                                               .size = {width, 0.9f, width},
                                                               .position = {0, 0.45f, 0},
                                                               .rotation = {0, 0, 0, 1},
                                                               .colour = {1, 0, 0}};
  for (int i = 0; i < NODES * NODES; ++i) s->height[i] = LEVEL;
  frame->height_field = (SimHeightField){{NODES, NODES}, {-2, -2}, 0.04f, s->height, NULL};
  s->pool = (Pool){frame, (double)LEVEL, 1.333};
  // White light from everywhere: bodies and floor have their own colour, and only the box has red without blue.
  s->settings = harness_pinned_settings();
  s->settings.style = "heightfield";
  for (int k = 0; k < 3; ++k) {
    s->settings.sky_zenith[k] = s->settings.sky_horizon[k] = 0.8f;
    s->settings.absorption[k] = s->settings.scattering[k] = 0;
    s->settings.floor_colour[0][k] = s->settings.floor_colour[1][k] = k == 1 ? 0.3f : 0;
  }
  s->settings.heightfield.traced_caustics = false;
  return s;
}

static void scene_destroy(Scene *s) {
  render_water_objects_destroy(&s->found);
  test_frame_destroy(s->frame);
  free(s);
}

// From 3 m away, not square to its sides.
static RenderView view_from(double degrees) {
  const double angle = degrees * PI / 180, turn = 0.4, distance = 3;
  const float across = (float)(distance * cos(angle));
  return harness_view(across * (float)sin(turn), 0.35f + (float)(distance * sin(angle)), across * (float)cos(turn), 0,
                      0.35f, 0, 38);
}

static const RenderWaterObject *find_object(Scene *s, const RenderView *view) {
  RenderError error = {0};
  assert_true(
      render_water_objects_find(&s->found, &s->frame->frame, view->eye, &s->settings.heightfield, 1.333f, &error));
  assert_int_equal(s->found.count, 1);
  return &s->found.objects[0];
}

static uint8_t *traced(const Scene *s, const RenderView *view, PoolEyes eyes, const RenderWaterObject *object) {
  uint8_t *seen = malloc(PIXELS);
  assert_non_null(seen);
  pool_look(&s->pool, view, WIDTH, HEIGHT, eyes, object, seen);
  return seen;
}

static PoolError error_between(const uint8_t *a, const uint8_t *b) {
  PoolOutline first = pool_outline(a, WIDTH, HEIGHT), second = pool_outline(b, WIDTH, HEIGHT);
  const PoolError error = pool_compare(&first, &second);
  pool_outline_destroy(&first);
  pool_outline_destroy(&second);
  return error;
}

// What the paper's eyes cost on their own, before anything is drawn: the scaling fix is needed, and enough for this box.
static void test_virtual_eyes_traced(void **state) {
  (void)state;
  Scene *s = scene_create(0.3f);
  for (int i = 0; i < ANGLES; ++i) {
    const RenderView view = view_from(angles[i]);
    const RenderWaterObject *object = find_object(s, &view);
    uint8_t *truth = traced(s, &view, POOL_TRACED, NULL), *scaled = traced(s, &view, POOL_SCALED, object);
    uint8_t *one = traced(s, &view, POOL_ONE, object);
    const PoolError with = error_between(truth, scaled), without = error_between(truth, one);
    print_message("%2.0f°, traced: with the scaling fix %.2f px (95 %%: %.2f), without %.2f px (%.2f)\n", angles[i],
                  with.largest, with.most, without.largest, without.most);
    assert_true(with.largest <= 2.1);
    assert_true(i == 2 || without.largest > 2 * with.largest);
    free(truth);
    free(scaled);
    free(one);
  }
  scene_destroy(s);
}

// ---- Drawn -----------------------------------------------------------------------------------------------------------

// Box where there is more red than blue: at least half of what is left of it behind the least reflecting water. `truth` tells
// what is seen directly.
static uint8_t *classify(const uint8_t *rgb, const uint8_t *truth) {
  uint8_t *seen = calloc(PIXELS, 1);
  assert_non_null(seen);
  for (size_t i = 0; i < PIXELS; ++i) {
    const bool box = rgb[3 * i] - rgb[3 * i + 2] > 80;
    if (box) seen[i] = truth[i] == POOL_DIRECT ? POOL_DIRECT : POOL_THROUGH_WATER;
  }
  return seen;
}

static PoolError drawn_error(Harness *harness, Scene *s, const RenderView *view, const uint8_t *truth,
                             RenderVirtualEyes eyes) {
  s->settings.heightfield.eyes = eyes;
  uint8_t *rgb = harness_draw(harness, &s->frame->frame, view, &s->settings);
  uint8_t *seen = classify(rgb, truth);
  const PoolError error = error_between(truth, seen);
  free(rgb);
  free(seen);
  return error;
}

static void test_drawn(void **state) {
  Harness *harness = *state;
  Scene *s = scene_create(0.3f);
  for (int i = 0; i < ANGLES; ++i) {
    const RenderView view = view_from(angles[i]);
    uint8_t *truth = traced(s, &view, POOL_TRACED, NULL);
    const PoolError each = drawn_error(harness, s, &view, truth, RENDER_EYES_EACH);
    const PoolError scaled = drawn_error(harness, s, &view, truth, RENDER_EYES_SCALED);
    const PoolError one = drawn_error(harness, s, &view, truth, RENDER_EYES_ONE);
    print_message("%2.0f°, drawn: an eye for each ray %.2f px, one with the scaling fix %.2f px, one without %.2f px\n",
                  angles[i], each.largest, scaled.largest, one.largest);
    assert_true(each.largest <= 1.1);
    assert_true(scaled.largest <= 2.1);
    assert_true(i == 2 || one.largest > 2 * scaled.largest);
    free(truth);
  }
  scene_destroy(s);
}

static int open_harness(void **state) {
  return harness_open_group(state, WIDTH, HEIGHT);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_measure),
      cmocka_unit_test(test_measure_of_nothing),
      cmocka_unit_test(test_virtual_eyes_traced),
      cmocka_unit_test(test_drawn),
  };
  return cmocka_run_group_tests(tests, open_harness, harness_close_group);
}
