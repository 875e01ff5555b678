// The default smoothing of depths: exact where it must be, and as good as was measured (smoothing_quality).
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/render/quality.h"

static void regression(const SmoothInput *input, const void *parameters, float *smoothed) {
  smooth_regression(input, parameters, smoothed);
}

static void plane_fit(const SmoothInput *input, const void *parameters, float *smoothed) {
  smooth_plane_fit(input, parameters, smoothed);
}

static void bilateral(const SmoothInput *input, const void *parameters, float *smoothed) {
  smooth_bilateral(input, parameters, smoothed);
}

// A plane stays a plane up to its boundary, and a step beyond the range stays a step. The rest is rounding: an inverse depth
// of ½ per metre has a float spacing of 6·10⁻⁸, which is 1.4·10⁻⁵ radii.
static void test_edges(void **state) {
  (void)state;
  const QualityEdges edges = quality_edges(regression, &smooth_regression_default);
  assert_true(edges.patch < 1e-3);
  assert_true(edges.step[2] < 1e-3);
  assert_true(edges.tilted < 1e-3);
}

// So does local plane fitting, but the bilateral filter, which averages depths, bends a tilted plane at its boundary (Imai et
// al. 2016, section 3.2).
static void test_tilted_patch(void **state) {
  (void)state;
  const QualityEdges fitted = quality_edges(plane_fit, &(SmoothPlaneFit){9, 0, 2, 5.3, false});
  const QualityEdges bent = quality_edges(bilateral, &(SmoothBilateral){21, 2, 2.6});
  print_message(
      "a plane tilted by 70 degrees is off by %.2g r after plane fitting, %.2g r after the bilateral filter\n",
      fitted.patch, bent.patch);
  assert_true(fitted.patch < 1e-3);
  assert_true(bent.patch > 0.2);
}

// A wide pool with waves at 640 × 480, a radius of 2.7 pixels. In a narrow one the outline, where particles without neighbours
// round the surface off over several radii, makes more of the picture.
static void test_waves(void **state) {
  (void)state;
  const QualityPool pool = {
      "wide", {2.56, 0, 2.56}, 0.02, 0.64, 1, 1, QUALITY_COLUMNS, {-0.75f, 2.6f, 5.3f}, {1.36f, 0.36f, 1.2f}, 38};
  QualityCase c = quality_case_create(&pool, 640, 480, 3);
  const QualityFigures f = quality_measure(&c, regression, &smooth_regression_default);
  quality_case_destroy(&c);
  print_message("mean %.3f p95 %.3f flicker %.3f degrees, bias %.4f radii, lost %.5f\n", f.mean, f.p95, f.flicker,
                f.bias, f.lost);
  assert_true(f.mean <= 2.0);
  assert_true(f.p95 <= 4.1);
  assert_true(f.bias >= -0.1 && f.bias <= 0.1);
  assert_true(f.lost < 0.001);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_edges), cmocka_unit_test(test_tilted_patch),
                                     cmocka_unit_test(test_waves)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
