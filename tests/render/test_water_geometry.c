// Distances from bodies, and where light leaves plane water. On the processor alone.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

#include "render/water_objects.h"

#define INDEX 1.333f

static void expect_point(const float p[3], double x, double y, double z, double tolerance) {
  assert_float_equal(p[0], x, tolerance);
  assert_float_equal(p[1], y, tolerance);
  assert_float_equal(p[2], z, tolerance);
}

// ---- Distances -------------------------------------------------------------------------------------------------------

// Whether a point, in a body's own axes, is in it.
static bool inside(const SimObstacle *o, const double p[3]) {
  const double x = p[0], y = p[1], z = p[2], half[3] = {o->size[0] / 2.0, o->size[1] / 2.0, o->size[2] / 2.0};
  const double straight = half[1] - half[0], beyond = fmax(fabs(y) - straight, 0);
  const double step = floor((x + half[0]) / o->size[0] * o->steps);
  switch (o->shape) {
  case SIM_SPHERE:
    return x * x + y * y + z * z < half[0] * half[0];
  case SIM_CYLINDER:
    return x * x + z * z < half[0] * half[0] && fabs(y) < half[1];
  case SIM_CAPSULE:
    return x * x + beyond * beyond + z * z < half[0] * half[0];
  case SIM_STAIRS:
    return fabs(x) < half[0] && fabs(z) < half[2] && y > -half[1] && y < ((step + 1) / o->steps * 2 - 1) * half[1];
  default:
    return fabs(x) < half[0] && fabs(y) < half[1] && fabs(z) < half[2];
  }
}

// Distance to the nearest place at which being inside changes, among those on a fine lattice around the point.
static double searched_distance(const SimObstacle *o, const double p[3], double step) {
  const bool here = inside(o, p);
  const int reach = 40;
  double nearest = INFINITY;
  for (int k = -reach; k <= reach; ++k) {
    for (int j = -reach; j <= reach; ++j) {
      for (int i = -reach; i <= reach; ++i) {
        const double distance = step * sqrt((double)(i * i + j * j + k * k));
        if (distance >= nearest) continue;
        const double q[3] = {p[0] + step * i, p[1] + step * j, p[2] + step * k};
        if (inside(o, q) != here) nearest = distance;
      }
    }
  }
  return here ? -nearest : nearest;
}

// The cell of a lattice is the error of the search.
static void test_distances(void **state) {
  (void)state;
  const double step = 0.02, points[][3] = {{0, 0, 0},          {0.3, 0.2, -0.1},  {0.55, 0.1, 0.05}, {0.1, 0.7, 0.2},
                                           {-0.4, -0.3, 0.3},  {0.2, -0.75, 0.1}, {-0.7, 0.5, 0.0},  {0.6, 0.6, 0.35},
                                           {-0.2, 0.25, -0.1}, {0.45, 0.45, 0.1}, {-0.5, -0.2, 0.1}, {0.1, 0.3, 0.5}};
  for (int shape = SIM_BOX; shape <= SIM_STAIRS; ++shape) {
    const SimObstacle o = {.shape = (SimShape)shape, .size = {0.8f, 1.1f, 0.6f}, .rotation = {0, 0, 0, 1}, .steps = 4};
    for (size_t i = 0; i < sizeof points / sizeof points[0]; ++i) {
      const float p[3] = {(float)points[i][0], (float)points[i][1], (float)points[i][2]};
      const double distance = (double)render_obstacle_distance(&o, p), truth = searched_distance(&o, points[i], step);
      // Within stairs it is that from the deepest step's own sides: not more than the truth.
      const double slack = shape == SIM_STAIRS && truth < 0 ? 0.3 : 0;
      if (!(distance < truth + 1.8 * step + slack && distance > truth - 1.8 * step)) {
        fail_msg("shape %d, point %zu: %g instead of %g", shape, i, distance, truth);
      }
    }
  }
}

// Against all steps instead of the few that can be nearest.
static void test_many_steps(void **state) {
  (void)state;
  const SimObstacle flight = {.shape = SIM_STAIRS, .size = {3, 1, 1}, .rotation = {0, 0, 0, 1}, .steps = 50};
  for (int i = 0; i < 2000; ++i) {
    const float p[3] = {-2 + 0.002f * (float)i, 0.9f * sinf(0.37f * (float)i), 0.7f * sinf(0.11f * (float)i)};
    float nearest = INFINITY;
    for (int k = 0; k < 50; ++k) {
      const float begin = -1.5f + 0.06f * (float)k, top = -0.5f + 0.02f * (float)(k + 1);
      const SimObstacle box = {.shape = SIM_BOX,
                               .size = {1.5f - begin, top + 0.5f, 1},
                               .position = {(begin + 1.5f) / 2, (top - 0.5f) / 2, 0},
                               .rotation = {0, 0, 0, 1}};
      nearest = fminf(nearest, render_obstacle_distance(&box, p));
    }
    if (nearest > 0) assert_float_equal(render_obstacle_distance(&flight, p), nearest, 1e-5);
  }
}

// ---- Where light leaves the water ------------------------------------------------------------------------------------

// Fermat: the optical path through a point so far along the way between the feet.
static double path_through(double share, double eye, double depth, double apart) {
  const double x = share * apart, rest = apart - x;
  return sqrt(x * x + eye * eye) + (double)INDEX * sqrt(rest * rest + depth * depth);
}

static double shortest_path(double eye, double depth, double apart) {
  double low = 0, high = 1;
  const double golden = (sqrt(5) - 1) / 2;
  for (int i = 0; i < 200; ++i) {
    const double a = high - golden * (high - low), b = low + golden * (high - low);
    if (path_through(a, eye, depth, apart) < path_through(b, eye, depth, apart)) {
      high = b;
    } else {
      low = a;
    }
  }
  return (low + high) / 2;
}

static void test_refraction_point(void **state) {
  (void)state;
  const float plane[4] = {0, 1, 0, -0.5f};
  const double heights[] = {1e-4, 0.01, 0.3, 1, 20}, depths[] = {1e-4, 0.05, 0.5, 3}, gaps[] = {0, 1e-3, 0.2, 1, 30};
  for (size_t i = 0; i < 5; ++i) {
    for (size_t j = 0; j < 4; ++j) {
      for (size_t k = 0; k < 5; ++k) {
        const float eye[3] = {1, 0.5f + (float)heights[i], 1},
                    below[3] = {1 + (float)gaps[k], 0.5f - (float)depths[j], 1};
        float point[3];
        render_refraction_point(plane, eye, below, INDEX, point);
        // The path is flat at its minimum, and float has seven digits: so it is the path that is compared too.
        const double e = (double)eye[1] - 0.5, d = 0.5 - (double)below[1], apart = (double)below[0] - 1;
        const double share = shortest_path(e, d, apart);
        assert_float_equal(point[0], 1 + share * apart, 2e-6 * (1 + apart) + 2e-8 * apart);
        assert_float_equal(point[1], 0.5, 1e-6);
        assert_float_equal(point[2], 1, 1e-6);
      }
    }
  }
}

// Snell's law in a tilted plane.
static void test_refraction_point_tilted(void **state) {
  (void)state;
  const double n[3] = {0.3, sqrt(1 - 0.09 - 0.04), -0.2};
  const float plane[4] = {(float)n[0], (float)n[1], (float)n[2], -0.4f}, eye[3] = {2, 1.5f, -1},
              below[3] = {-1, 0.1f, 0.7f};
  float p[3];
  render_refraction_point(plane, eye, below, INDEX, p);
  double in[3], out[3], cross[2] = {0, 0}, length[2] = {0, 0}, height = -0.4;
  for (int k = 0; k < 3; ++k) {
    in[k] = (double)p[k] - (double)eye[k];
    out[k] = (double)below[k] - (double)p[k];
    length[0] += in[k] * in[k];
    length[1] += out[k] * out[k];
    height += n[k] * (double)p[k];
  }
  for (int k = 0; k < 3; ++k) {
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    cross[0] += pow(in[a] * n[b] - in[b] * n[a], 2);
    cross[1] += pow(out[a] * n[b] - out[b] * n[a], 2);
  }
  assert_float_equal(height, 0, 1e-6);
  assert_float_equal(sqrt(cross[0] / length[0]), (double)INDEX * sqrt(cross[1] / length[1]), 1e-5);
}

static void test_refraction_point_limits(void **state) {
  (void)state;
  const float plane[4] = {0, 1, 0, 0};
  const float eye[3] = {0, 1, 0}, grazing[3] = {0, 0, 0}, under[3] = {0, -1, 0};
  const float below[3] = {2, -1, 0}, on[3] = {2, 0, 0}, over[3] = {2, 1, 0}, far[3] = {0, 1e-3f, 0};
  float p[3];
  render_refraction_point(plane, eye, below, 1, p); // no refraction: the straight line
  expect_point(p, 1, 0, 0, 1e-6);
  render_refraction_point(plane, eye, on, INDEX, p); // a point on the plane is where it is
  expect_point(p, 2, 0, 0, 1e-6);
  render_refraction_point(plane, under, over, INDEX, p); // an eye in the water: the straight line
  expect_point(p, 1, 0, 0, 1e-6);
  render_refraction_point(plane, under, below, INDEX, p); // or the foot
  expect_point(p, 2, 0, 0, 1e-6);
  render_refraction_point(plane, under, under, INDEX, p);
  expect_point(p, 0, 0, 0, 1e-6);
  // Grazing light comes from under the critical angle: tan = 1 / √(index² − 1).
  const double reach = 1 / sqrt((double)INDEX * (double)INDEX - 1);
  render_refraction_point(plane, grazing, below, INDEX, p);
  expect_point(p, 2 - reach, 0, 0, 1e-5);
  render_refraction_point(plane, far, below, INDEX, p);
  expect_point(p, 2 - reach, 0, 0, 1e-3);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_distances),
      cmocka_unit_test(test_many_steps),
      cmocka_unit_test(test_refraction_point),
      cmocka_unit_test(test_refraction_point_tilted),
      cmocka_unit_test(test_refraction_point_limits),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
