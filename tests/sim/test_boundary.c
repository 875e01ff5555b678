// Walls and obstacles: their share of the density sum, its gradient, distances, and the clamp.
#include "sim_test.h"

#include "sim/boundary.h"

static float share_at(const SimBoundary *boundary, const float point[3], float gradient[3]) {
  SimSolid solid;
  sim_boundary_solid(boundary, NULL, point, &solid);
  memcpy(gradient, solid.gradient, sizeof solid.gradient);
  return solid.share;
}

static SimBoundary box(float size, SimBody *bodies, int32_t count) {
  SimCubic cubic = sim_cubic_make(0.05f, 2);
  SimBoundary boundary = {
      .container = {{0, 0, 0}, {size, size, size}}, .clearance = 0.025f, .body_count = count, .bodies = bodies};
  sim_wall_make(&boundary.wall, &cubic);
  return boundary;
}

// V Σ W over the lattice points with non-negative indices along the first `walls` axes, seen from the corner point: what
// is left of the lattice in a half-space, an edge, a corner.
static double lattice_left(int walls) {
  SimCubic cubic = sim_cubic_make(0.05f, 2);
  double sum = 0;
  for (int z = walls > 2 ? 0 : -2; z <= 2; z++)
    for (int y = walls > 1 ? 0 : -2; y <= 2; y++)
      for (int x = walls > 0 ? 0 : -2; x <= 2; x++)
        sum += (double)sim_cubic_value(&cubic, 0.05f * (float)sqrt(x * x + y * y + z * z));
  return sum;
}

static void walls_complete_the_lattice(void **state) {
  (void)state;
  SimBoundary boundary = box(1, NULL, 0);
  const float points[4][3] = {
      {0.5f, 0.5f, 0.5f}, {0.025f, 0.5f, 0.5f}, {0.025f, 0.975f, 0.5f}, {0.025f, 0.975f, 0.025f}};
  const double tolerance[4] = {1e-6, 1e-4, 0.004, 0.01};
  for (int walls = 0; walls <= 3; walls++) {
    float gradient[3];
    double density = lattice_left(walls) + (double)share_at(&boundary, points[walls], gradient);
    if (fabs(density - 1) > tolerance[walls]) fail_msg("%d walls: density %.5f", walls, density);
  }
}

// Along a wall −V Σ x_t ∂W/∂x_t over the half lattice is f, across it f and the moment that the table holds for that f.
static void moments_complete_the_lattice(void **state) {
  (void)state;
  SimBoundary boundary = box(1, NULL, 0);
  SimCubic cubic = sim_cubic_make(0.05f, 2);
  for (double s = 0.3 * 0.05; s < 1.3 * 0.05; s += 0.1 * 0.05) {
    double along = 0, across = 0;
    float slope, f = sim_wall_share(&boundary.wall, (float)s, &slope), place = f * SIM_WALL_MOMENTS;
    for (int z = 0; z <= 2; z++)
      for (int y = -2; y <= 2; y++)
        for (int x = -2; x <= 2; x++) {
          double d[3] = {0.05 * x, 0.05 * y, s + 0.05 * (z + 0.5)}, r = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
          double g = -(double)sim_cubic_gradient(&cubic, (float)r) / r;
          along += g * d[0] * d[0];
          across += g * d[2] * d[2];
        }
    const float *moment = boundary.wall.moment + (int)place;
    double found = (double)(moment[0] + (place - (float)(int)place) * (moment[1] - moment[0]));
    if (fabs(along - (double)f) > 0.01) fail_msg("at %g m: along %.4f, share %.4f", s, along, (double)f);
    if (fabs(across - (double)f - found) > 0.02) fail_msg("at %g m: across %.4f, found %.4f", s, across - (double)f, found);
  }
}

static void check_gradient(const SimBoundary *boundary, const float point[3]) {
  float gradient[3], ignored[3];
  float e = 1e-3f * 0.05f;
  share_at(boundary, point, gradient);
  for (int k = 0; k < 3; k++) {
    float a[3], b[3];
    memcpy(a, point, sizeof a);
    memcpy(b, point, sizeof b);
    a[k] -= e, b[k] += e;
    double quotient =
        ((double)share_at(boundary, b, ignored) - (double)share_at(boundary, a, ignored)) /
        (double)(b[k] - a[k]);
    if (fabs(quotient - (double)gradient[k]) > 0.15)
      fail_msg("gradient %d at (%g, %g, %g): %g, difference quotient %g", k, (double)point[0], (double)point[1],
               (double)point[2], (double)gradient[k], quotient);
  }
}

static SimBody make_body(SimShape shape, float a, float b, float c) {
  SimObstacle obstacle = {shape, {a, b, c}, {0.5f, 0.45f, 0.55f}, {0.3f, -0.2f, 0.1f, 0.9f}, {0, 0, 0}};
  return sim_body_make(&obstacle, NULL);
}

static void gradients_match_difference_quotients(void **state) {
  (void)state;
  SimBody bodies[3] = {make_body(SIM_BOX, 0.3f, 0.2f, 0.25f), make_body(SIM_SPHERE, 0.4f, 0, 0),
                       make_body(SIM_CYLINDER, 0.3f, 0.35f, 0)};
  for (int shape = 0; shape < 4; shape++) {
    SimBoundary boundary = box(1, &bodies[shape % 3], shape < 3);
    uint64_t seed = 1;
    for (int n = 0, near = 0; near < 300 && n < 200000; n++) {
      float normal[3], point[3];
      for (int k = 0; k < 3; k++) point[k] = 0.025f + 0.95f * (float)test_random(&seed);
      if (shape < 3) {
        float gap = sim_body_distance(&bodies[shape], point, normal);
        if (gap < 0.02f || gap > 0.1f) continue;
      }
      near++;
      check_gradient(&boundary, point);
    }
  }
}

// The distance must be that of the nearest surface point: moving back along the normal lands on the surface, and its
// gradient is the normal.
static void distances_are_exact(void **state) {
  (void)state;
  SimBody bodies[3] = {make_body(SIM_BOX, 0.3f, 0.2f, 0.25f), make_body(SIM_SPHERE, 0.4f, 0, 0),
                       make_body(SIM_CYLINDER, 0.3f, 0.35f, 0)};
  uint64_t seed = 2;
  for (int n = 0; n < 3000; n++) {
    const SimBody *body = &bodies[n % 3];
    float point[3], normal[3], ignored[3], on[3];
    for (int k = 0; k < 3; k++) point[k] = (float)test_random(&seed);
    float gap = sim_body_distance(body, point, normal);
    float length = sqrtf(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    assert_true(fabsf(length - 1) < 1e-5f);
    for (int k = 0; k < 3; k++) on[k] = point[k] - gap * normal[k];
    assert_true(fabsf(sim_body_distance(body, on, ignored)) < 1e-5f);
  }
}

static void a_sphere_has_its_distance(void **state) {
  (void)state;
  SimBody sphere = make_body(SIM_SPHERE, 0.4f, 0, 0);
  float normal[3];
  assert_true(fabsf(sim_body_distance(&sphere, (float[3]){0.5f, 0.95f, 0.55f}, normal) - 0.3f) < 1e-6f);
  assert_true(fabsf(normal[1] - 1) < 1e-6f);
  float gap = sim_body_distance(&sphere, (float[3]){0.5f, 0.45f, 0.55f}, normal); // its centre
  assert_true(gap == -0.2f && isfinite(normal[0]));
}

static void clamp_keeps_everything_inside(void **state) {
  (void)state;
  SimBody sphere = make_body(SIM_SPHERE, 0.4f, 0, 0);
  SimBoundary boundary = box(1, &sphere, 1);
  uint64_t seed = 3;
  for (int n = 0; n < 5000; n++) {
    float from[3], to[3], normal[3];
    do
      for (int k = 0; k < 3; k++) from[k] = 0.025f + 0.95f * (float)test_random(&seed);
    while (!sim_boundary_free(&boundary, from));
    for (int k = 0; k < 3; k++) to[k] = (float)(8 * test_random(&seed) - 4);
    sim_boundary_clamp(&boundary, NULL, from, to);
    for (int k = 0; k < 3; k++) assert_true(to[k] >= 0.0249f && to[k] <= 0.9751f);
    assert_true(sim_body_distance(&sphere, to, normal) > 0.9f * 0.025f);
  }
}

// A sheet far thinner than a particle, and a move straight through it, many spacings long.
static void thin_obstacles_are_not_jumped(void **state) {
  (void)state;
  SimObstacle sheet = {SIM_BOX, {0.001f, 4, 4}, {0.5f, 0.5f, 0.5f}, {0, 0, 0, 1}, {0, 0, 0}};
  SimBody body = sim_body_make(&sheet, NULL);
  SimBoundary boundary = box(1, &body, 1);
  for (int n = 0; n < 100; n++) {
    float from[3] = {0.47f - 0.004f * (float)n, 0.5f, 0.5f}, to[3] = {0.9f, 0.5f + 0.004f * (float)n, 0.5f};
    sim_boundary_clamp(&boundary, NULL, from, to);
    assert_true(to[0] < 0.5f);
  }
}

// Between an obstacle and a wall that are closer than a particle is wide, a particle stays where it was.
static void a_wedge_holds(void **state) {
  (void)state;
  SimObstacle block = {SIM_BOX, {0.4f, 0.4f, 0.4f}, {0.5f, 0.21f, 0.5f}, {0, 0, 0, 1}, {0, 0, 0}};
  SimBody body = sim_body_make(&block, NULL);
  SimBoundary boundary = box(1, &body, 1);
  float from[3] = {0.27f, 0.025f, 0.5f}, to[3] = {0.5f, 0.004f, 0.5f}, normal[3];
  sim_boundary_clamp(&boundary, NULL, from, to);
  assert_true(sim_body_distance(&body, to, normal) >= 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(walls_complete_the_lattice),
      cmocka_unit_test(moments_complete_the_lattice),
      cmocka_unit_test(gradients_match_difference_quotients),
      cmocka_unit_test(distances_are_exact),
      cmocka_unit_test(a_sphere_has_its_distance),
      cmocka_unit_test(clamp_keeps_everything_inside),
      cmocka_unit_test(thin_obstacles_are_not_jumped),
      cmocka_unit_test(a_wedge_holds),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
