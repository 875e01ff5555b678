// Passes that are compute shaders on hardware and fragment shaders on a software rasteriser: both give the same picture.
#include "render/gpu.h"
#include "tests/render/water.h"

#include <stdlib.h>

#define WIDTH 131 // no multiple of tiles or of work groups
#define HEIGHT 83
#define BYTES (3 * WIDTH * HEIGHT)

static uint8_t *draw(const SimFrame *frame, const RenderView *view, const char *style, bool like_hardware) {
  gpu_draw_like_hardware(like_hardware);
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  gpu_draw_like_hardware(false);
  RenderSettings settings = render_default_settings();
  settings.style = style;
  uint8_t *rgb = harness_draw(&harness, frame, view, &settings);
  harness_close(&harness);
  return rgb;
}

// The compiler may round differently in both; a pixel at an edge may then fall on the other side.
static void expect_alike(const char *style, const SimFrame *frame, const RenderView *view) {
  uint8_t *fragment = draw(frame, view, style, false), *compute = draw(frame, view, style, true);
  int beyond = 0;
  for (int i = 0; i < BYTES; ++i) beyond += abs(fragment[i] - compute[i]) > 1;
  print_message("%s: %d of %d values differ by more than 1\n", style, beyond, BYTES);
  assert_true(beyond <= BYTES / 500);
  free(fragment);
  free(compute);
}

static void test_styles(void **state) {
  (void)state;
  TestFrame *t = test_frame_pool();
  TestWater water = test_water_create(t->position, t->frame.count, t->frame.particle_radius, &t->frame.container);
  test_frame_destroy(t);
  const RenderView outside = {{1.5f, 1.1f, 3.4f}, {1.5f, 0.3f, 0.5f}, 38};
  const SimContainer *box = &water.frame.container;
  const float middle = 0.5f * (box->min[0] + box->max[0]), depth = 0.5f * (box->min[2] + box->max[2]);
  const RenderView within = {{middle, box->min[1] + 0.1f, depth}, {box->max[0], box->min[1] + 0.3f, depth}, 70};
  static const char *const styles[] = {"points", "refraction", "raycast", "cartoon"};
  for (int k = 0; k < 4; ++k) expect_alike(styles[k], &water.frame, &outside);
  for (int k = 1; k < 4; ++k) expect_alike(styles[k], &water.frame, &within);
  test_water_destroy(&water);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_styles)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
