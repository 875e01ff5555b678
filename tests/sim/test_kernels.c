// Kernels: integral one, gradients, lattice sums, and the single-precision spline of the solver.
#include "sim_test.h"

#include "sim/kernels.h"

static void integrals_are_one(void **state) {
  (void)state;
  const double supports[] = {0.035, 0.1, 2};
  for (int s = 0; s < 3; s++)
    for (int n = 0; n < SIM_KERNEL_COUNT; n++) {
      double h = supports[s], sum = 0, step = h / 4000;
      for (int k = 0; k < 4000; k++) {
        double r = (k + 0.5) * step;
        sum += 4 * 3.14159265358979 * r * r * sim_kernels[n].value(r, h) * step;
      }
      if (fabs(sum - 1) > 1e-5) fail_msg("%s integrates to %.8f at h = %g", sim_kernels[n].name, sum, h);
    }
}

static void derivatives_match_difference_quotients(void **state) {
  (void)state;
  for (int n = 0; n < SIM_KERNEL_COUNT; n++) {
    double h = 0.07, e = 1e-6 * h, scale = fabs(sim_kernels[n].derivative(h / 3, h));
    for (int k = 1; k < 120; k++) {
      double r = 0.01 * k * h + 1e-4 * h;
      double quotient = (sim_kernels[n].value(r + e, h) - sim_kernels[n].value(r - e, h)) / (2 * e);
      double derivative = sim_kernels[n].derivative(r, h);
      assert_true(derivative <= 0);
      if (fabs(quotient - derivative) > 1e-5 * scale) fail_msg("%s at r/h = %g", sim_kernels[n].name, r / h);
    }
  }
}

static void kernels_vanish_outside(void **state) {
  (void)state;
  for (int n = 0; n < SIM_KERNEL_COUNT; n++) {
    assert_true(sim_kernels[n].value(1.0, 1.0) == 0 && sim_kernels[n].value(5.0, 1.0) == 0);
    assert_true(sim_kernels[n].derivative(5.0, 1.0) == 0);
    assert_true(isfinite(sim_kernels[n].value(0, 1.0)) && isfinite(sim_kernels[n].derivative(0, 1.0)));
  }
}

// Volume of a particle times Σ W on the lattice: published figures for h = 2 and 2.5 spacings.
static void lattice_sums(void **state) {
  (void)state;
  assert_true(fabs(sim_lattice_sum(sim_kernels[0].value, 1, 2) - 1.000) < 6e-4);
  assert_true(fabs(sim_lattice_sum(sim_kernels[0].value, 1, 2.5) - 0.997) < 2e-3);
  assert_true(fabs(sim_lattice_sum(sim_kernels[1].value, 1, 2) - 1.010) < 6e-4);
  assert_true(fabs(sim_lattice_sum(sim_kernels[2].value, 1, 2) - 1.24) < 6e-3);
  assert_true(fabs(sim_lattice_sum(sim_kernels[3].value, 1, 2) - 1.034) < 6e-4);
}

static void single_precision_spline_is_the_spline(void **state) {
  (void)state;
  SimCubic cubic = sim_cubic_make(0.035f, 2);
  double h = 0.07;
  for (int k = 0; k < 1000; k++) {
    double r = k * 0.0011 * h, volume = (double)cubic.volume;
    assert_true(fabs((double)sim_cubic_value(&cubic, (float)r) - volume * sim_kernel_cubic(r, h)) < 1e-6);
    double gradient = volume * sim_kernel_cubic_derivative(r, h);
    assert_true(fabs((double)sim_cubic_gradient(&cubic, (float)r) - gradient) < 1e-5 / h);
  }
}

// Calibrated so that the lattice at rest has exactly the rest density; S d² as published; ω as derived.
static void calibration(void **state) {
  (void)state;
  const float spacings[] = {2e-4f, 0.035f, 1.5f};
  for (int s = 0; s < 3; s++) {
    SimCubic cubic = sim_cubic_make(spacings[s], 2);
    double sum = 0;
    for (int k = 0; k < 125; k++) {
      double x = k % 5 - 2, y = k / 5 % 5 - 2, z = k / 25 - 2;
      sum += (double)sim_cubic_value(&cubic, spacings[s] * (float)sqrt(x * x + y * y + z * z));
    }
    assert_true(fabs(sum - 1) < 1e-5);
    double strength = (double)cubic.lattice_gradient * (double)spacings[s] * (double)spacings[s];
    assert_true(fabs(strength - 0.425) < 2e-3);
    assert_true(fabs((double)cubic.omega - 0.64) < 0.01);
  }
  SimCubic wide = sim_cubic_make(0.035f, 2.5f);
  assert_true(fabs((double)wide.lattice_gradient * 0.035 * 0.035 - 0.172) < 2e-3);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(integrals_are_one),
      cmocka_unit_test(derivatives_match_difference_quotients),
      cmocka_unit_test(kernels_vanish_outside),
      cmocka_unit_test(lattice_sums),
      cmocka_unit_test(single_precision_spline_is_the_spline),
      cmocka_unit_test(calibration),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
