// What the reference ray tracer sees without water is what the renderer draws.
#include "tests/reference/reference.h"

#include <stdlib.h>

#include "tests/render/harness.h"

static const SimObstacle bodies[] = {
    {SIM_BOX, {0.3f, 0.4f, 0.2f}, {0.4f, 0.3f, 0.5f}, {0.2f, 0.3f, 0.1f, 0.9f}, {0.8f, 0.35f, 0.2f}},
    {SIM_SPHERE, {0.3f, 0, 0}, {0.9f, 0.2f, 0.3f}, {0, 0, 0, 1}, {0.3f, 0.7f, 0.2f}},
    {SIM_CYLINDER, {0.2f, 0.5f, 0}, {1.3f, 0.35f, 0.5f}, {0.3f, 0, 0.2f, 0.9f}, {0.2f, 0.35f, 0.8f}},
    {SIM_CAPSULE, {0.2f, 0.6f, 0}, {1.8f, 0.4f, 0.4f}, {0, 0, 0.4f, 0.9f}, {0.7f, 0.7f, 0.1f}},
    {SIM_STAIRS, {0.6f, 0.5f, 0.4f}, {2.4f, 0.25f, 0.6f}, {0, 0.3f, 0, 0.95f}, {0.8f, 0.7f, 0.6f}, .steps = 5}};
enum { BODIES = sizeof bodies / sizeof *bodies, W = 320, H = 180 };

static int to_byte(float light) {
  return light >= 1 ? 255 : light <= 0 ? 0 : (int)(255 * light + 0.5f);
}

// Share of the bytes that differ by more than the rounding of a byte.
static double share_of_differences(const uint8_t *drawn, const float *traced) {
  int differ = 0;
  for (int i = 0; i < 3 * W * H; ++i) differ += abs(drawn[i] - to_byte(traced[i])) > 1;
  return (double)differ / (3 * W * H);
}

// Differences are left only where a pixel's middle lies on an edge.
static void check(const SimFrame *frame, const RenderSettings *settings) {
  Harness harness = harness_open(CONTEXT_AUTO, W, H);
  const RenderView views[] = {harness_view(1.4f, 0.9f, 2.4f, 1.4f, 0.2f, 0.5f, 45),
                              harness_view(-0.8f, 1.5f, -0.6f, 1.2f, 0.2f, 0.4f, 45)};
  Reference *reference = reference_create(frame, settings);
  assert_non_null(reference);
  float *traced = malloc(sizeof(float) * 3 * W * H);
  for (int i = 0; i < 2; ++i) {
    uint8_t *drawn = harness_draw(&harness, frame, &views[i], settings);
    reference_trace(reference, &views[i], W, H, 0, traced);
    const double share = share_of_differences(drawn, traced);
    print_message("view %d: %.5f of the bytes differ\n", i, share);
    assert_true(share < 0.001);
    free(drawn);
  }
  free(traced);
  reference_destroy(reference);
  harness_close(&harness);
}

static void test_bodies_on_checker(void **state) {
  (void)state;
  TestFrame *t = test_frame_create(0, 0.0175f);
  for (int i = 0; i < BODIES; ++i) t->obstacles[t->frame.obstacle_count++] = bodies[i];
  const RenderSettings settings = harness_pinned_settings();
  check(&t->frame, &settings);
  test_frame_destroy(t);
}

static void test_bodies_in_the_sky(void **state) {
  (void)state;
  TestFrame *t = test_frame_create(0, 0.0175f);
  for (int i = 0; i < BODIES; ++i) t->obstacles[t->frame.obstacle_count++] = bodies[i];
  RenderSettings settings = harness_pinned_settings();
  settings.floor = RENDER_FLOOR_NONE;
  check(&t->frame, &settings);
  test_frame_destroy(t);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_bodies_on_checker),
      cmocka_unit_test(test_bodies_in_the_sky),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
