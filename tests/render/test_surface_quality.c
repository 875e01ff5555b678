// How true the water's surface is: the renderer's front map of pools in a tank, against the surface that the particles sample.
//
//   render_surface_quality                the test
//   render_surface_quality MARGIN [WIDTH HEIGHT]   a table of all pools, with pixels nearer than MARGIN radii to the
//                                         pool's outline left out (default 1024 x 768)
#include "tests/render/water.h"

#include <math.h>
#include <stdlib.h>

#include "tests/render/quality.h"

static SplatMap draw_front(Harness *harness, const QualityPool *pool, double shift) {
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  SimFrame frame = *quality_frame(pool, shift, buffer);
  frame.has_container = true;
  // The tank moves with the water: no particle of a simulation lies behind a wall.
  frame.container = (SimContainer){{(float)shift, 0, 0},
                                   {(float)(pool->size[0] + shift), 2 * (float)pool->level, (float)pool->size[2]}};
  RenderSettings settings = render_default_settings();
  settings.style = "refraction";
  RenderView view = {.vertical_fov = pool->fov};
  for (int k = 0; k < 3; ++k) {
    view.eye[k] = pool->eye[k];
    view.target[k] = pool->target[k];
  }
  WaterMaps maps = water_maps_draw(harness, &frame, &view, &settings);
  splat_map_destroy(&maps.side[1]);
  sim_frame_buffer_destroy(buffer);
  return maps.side[0];
}

static QualityFigures measure(const QualityPool *pool, int32_t width, int32_t height, double margin) {
  Harness harness = harness_open(CONTEXT_AUTO, width, height);
  QualityTruth truth = quality_truth_create(pool, width, height, margin);
  SplatMap still = draw_front(&harness, pool, 0), shifted = draw_front(&harness, pool, pool->radius / 2);
  const QualityFigures f = quality_compare(&truth, &still, &shifted);
  print_message("%-10s %4d x %-4d %2g r: mean %.2f p95 %.2f flicker %.3f degrees, bias %.3f rough %.3f r, lost %.5f\n",
                pool->name, width, height, margin, f.mean, f.p95, f.flicker, f.bias, f.rough, f.lost);
  splat_map_destroy(&still);
  splat_map_destroy(&shifted);
  quality_truth_destroy(&truth);
  harness_close(&harness);
  return f;
}

static void test_flat(void **state) {
  (void)state;
  const QualityFigures f = measure(&quality_pools[0], 640, 480, 3);
  assert_true(f.mean <= 0.6);
  assert_true(f.flicker <= 0.25);
  assert_true(fabs(f.bias) <= 0.1);
  assert_true(f.lost < 0.001);
}

static void test_waves(void **state) {
  (void)state;
  const QualityFigures f = measure(&quality_pools[5], 640, 480, 3);
  assert_true(f.mean <= 2.0);
  assert_true(f.p95 <= 4.1);
  assert_true(f.flicker <= 0.25);
  assert_true(fabs(f.bias) <= 0.1);
  assert_true(f.lost < 0.001);
}

int main(int argc, char **argv) {
  if (argc > 1) {
    for (int k = 0; k < QUALITY_POOLS; ++k) {
      measure(&quality_pools[k], argc > 3 ? atoi(argv[2]) : 1024, argc > 3 ? atoi(argv[3]) : 768, atof(argv[1]));
    }
    return 0;
  }
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_flat), cmocka_unit_test(test_waves)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
