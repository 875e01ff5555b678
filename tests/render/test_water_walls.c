// Water in a container: it lies flat on the glass and on the floor, whatever its particles do there.
#include "tests/render/walls.h"

#include <math.h>
#include <stdlib.h>

#define WIDTH 240
#define HEIGHT 180
#define MARGIN 2 // radii from the edges: where the water's own surface, which is smoothed, may round them off
#define DEGREES (180 / 3.14159265358979323846)

// ---- The comparison --------------------------------------------------------------------------------------------------

typedef struct Worst {
  double depth, angle; // radii, degrees
  int pixels;
} Worst;

static Worst measure(Harness *harness, const TestWater *water, const RenderView *view, WallMeet *meet, int side,
                     double margin) {
  static const char *const names[2][2] = {{"front_depth", "front_normal"}, {"back_depth", "back_normal"}};
  RenderSettings settings = harness_pinned_settings();
  settings.style = "refraction";
  float *depth = harness_layer(harness, names[side][0], 1, &water->frame, view, &settings);
  float *normal = harness_layer(harness, names[side][1], 3, &water->frame, view, &settings);
  Worst worst = {0};
  for (int y = 0; y < HEIGHT; ++y) {
    for (int x = 0; x < WIDTH; ++x) {
      const Ray ray = harness_ray(view, WIDTH, HEIGHT, x, y);
      WallMeeting m;
      if (!meet(&ray, side, &m) || m.from_edge < margin) continue;
      const size_t i = (size_t)y * WIDTH + (size_t)x;
      double sine = 0;
      for (size_t k = 0; k < 3; ++k) sine += pow((double)normal[3 * i + k] - m.normal[k], 2);
      worst.depth = fmax(worst.depth, fabs((double)depth[i] - m.depth) / (double)WALL_RADIUS);
      worst.angle = fmax(worst.angle, 2 * asin(fmin(sqrt(sine) / 2, 1)) * DEGREES);
      ++worst.pixels;
    }
  }
  free(depth);
  free(normal);
  return worst;
}

static void expect_flush(const char *what, const SimContainer *container, WallMeet *meet, const RenderView *view) {
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  TestWater water = test_water_pool(container, WALL_RADIUS, WALL_LEVEL);
  for (int side = 0; side < 2; ++side) {
    const Worst worst = measure(&harness, &water, view, meet, side, MARGIN);
    print_message("%s, %s: %d pixels: %.2g r, %.2g degrees\n", what, side == 0 ? "front" : "back", worst.pixels,
                  worst.depth, worst.angle);
    assert_true(worst.pixels > WIDTH * HEIGHT / 8);
    assert_true(worst.depth < 1e-3);
    assert_true(worst.angle < 0.1);
  }
  test_water_destroy(&water);
  harness_close(&harness);
}

static void test_tank(void **state) {
  (void)state;
  const RenderView level = {{0.5f, 0.25f, 2.1f}, {0.52f, 0.22f, 0}, 30};
  expect_flush("tank", &wall_tank, wall_meet_tank, &level);
  const RenderView above = {{0.1f, 0.9f, 1.9f}, {0.5f, 0.2f, 0.2f}, 30};
  expect_flush("tank from above", &wall_tank, wall_meet_tank, &above);
}

static void test_glass(void **state) {
  (void)state;
  const RenderView level = {{0.35f, 0.25f, 2.1f}, {0.35f, 0.22f, 0}, 25};
  expect_flush("glass", &wall_glass, wall_meet_glass, &level);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_tank), cmocka_unit_test(test_glass)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
