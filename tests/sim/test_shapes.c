// Every shape and both containers: distances, shares against a lattice, and gradients.
#include "zoo.h"

// ---- Distances -------------------------------------------------------------------------------------------------------

// Stairs against the triangles of their surface, from one step to many, flat and steep.
static void stairs_have_the_distance_of_their_triangles(void **state) {
  (void)state;
  const int32_t steps[4] = {1, 2, 7, 40};
  uint64_t seed = 1;
  for (int n = 0; n < 8; n++) {
    const float half[3] = {n < 4 ? 0.4f : 0.15f, n < 4 ? 0.2f : 0.5f, 0.3f};
    TestMesh mesh = test_mesh_stairs(half, steps[n % 4]);
    SimObstacle obstacle = {.shape = SIM_STAIRS,
                            .size = {2 * half[0], 2 * half[1], 2 * half[2]},
                            .rotation = {0, 0, 0, 1},
                            .steps = steps[n % 4]};
    SimBody body = sim_body_make(&obstacle, NULL);
    for (int tries = 0; tries < 1000; tries++) {
      float point[3], normal[3], on[3], ignored[3];
      for (int k = 0; k < 3; k++) point[k] = 1.5f * half[k] * (float)(2 * test_random(&seed) - 1);
      const double p[3] = {(double)point[0], (double)point[1], (double)point[2]};
      double truth = reference_mesh_distance(&mesh.view, p) * (reference_mesh_inside(&mesh.view, p) ? -1 : 1);
      float gap = sim_body_distance(&body, point, normal);
      if (fabs((double)gap - truth) > 2e-6)
        fail_msg("%d steps: distance at (%g, %g, %g) %.7f, is %.7f", steps[n % 4], p[0], p[1], p[2], (double)gap,
                 truth);
      for (int k = 0; k < 3; k++) on[k] = point[k] - gap * normal[k];
      assert_true(fabsf(sim_body_distance(&body, on, ignored)) < 2e-6f);
    }
    test_mesh_free(&mesh);
  }
}

static void capsules_have_the_distance_of_their_axis(void **state) {
  (void)state;
  SimObstacle obstacle = {.shape = SIM_CAPSULE, .size = {0.2f, 0.5f}, .rotation = {0, 0, 0, 1}};
  SimBody body = sim_body_make(&obstacle, NULL);
  uint64_t seed = 2;
  for (int n = 0; n < 1000; n++) {
    float point[3], normal[3];
    for (int k = 0; k < 3; k++) point[k] = (float)(test_random(&seed) - 0.5);
    double least = INFINITY;
    for (int a = 0; a <= 1000; a++) {
      double y = -0.15 + 0.3 * a / 1000;
      least = fmin(least, sqrt((double)(point[0] * point[0] + point[2] * point[2]) + pow((double)point[1] - y, 2)));
    }
    assert_true(fabs((double)sim_body_distance(&body, point, normal) - (least - 0.1)) < 1e-5);
  }
}

// Points where directions vanish: centres, axes, corners, edges.
static void normals_are_unit_everywhere(void **state) {
  (void)state;
  Zoo zoo = zoo_make();
  for (int which = 0; which < ZOO; which++) {
    SimBody body = zoo_body(&zoo, which);
    for (int n = 0; n < 125; n++) {
      float p[3] = {(float)(n % 5 - 2) / 2, (float)(n / 5 % 5 - 2) / 2, (float)(n / 25 - 2) / 2}, normal[3], g[3];
      for (int k = 0; k < 3; k++) p[k] *= body.mesh ? body.mesh->high[k] : body.half[k];
      float gap = sim_body_local_distance(&body, p, normal);
      float length = sqrtf(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
      if (!isfinite(gap) || !(fabsf(length - 1) < 1e-5f))
        fail_msg("shape %d, point %d: normal %g", which, n, (double)length);
      float share = sim_body_solid(&body, &zoo.wall, p, g);
      assert_true(isfinite(share) && isfinite(g[0]) && isfinite(g[1]) && isfinite(g[2]));
    }
  }
  zoo_free(&zoo);
}

static void boxes_around_bodies_hold_them(void **state) {
  (void)state;
  Zoo zoo = zoo_make();
  uint64_t seed = 3;
  for (int which = 0; which < ZOO; which++) {
    SimBody body = zoo_body(&zoo, which);
    float low[3], high[3], found_low[3] = {9, 9, 9}, found_high[3] = {-9, -9, -9};
    sim_body_box(&body, low, high);
    for (int n = 0; n < 20000; n++) {
      float point[3], normal[3], d2 = 0;
      zoo_random_point(&seed, point);
      float gap = sim_body_distance(&body, point, normal);
      if (body.mesh && fabsf(gap) > 0.02f) continue; // interpolated
      for (int k = 0; k < 3; k++) {
        point[k] -= gap * normal[k];
        assert_true(point[k] >= low[k] - 1e-3f && point[k] <= high[k] + 1e-3f);
        d2 += (point[k] - body.position[k]) * (point[k] - body.position[k]);
        found_low[k] = fminf(found_low[k], point[k]);
        found_high[k] = fmaxf(found_high[k], point[k]);
      }
      assert_true(sqrtf(d2) <= body.bound + 1e-3f);
    }
    for (int k = 0; k < 3 && !body.mesh && which != SIM_STAIRS; k++) // and not much more
      if (!(found_low[k] < low[k] + 0.03f && found_high[k] > high[k] - 0.03f))
        fail_msg("shape %d, axis %d: %g to %g, found %g to %g", which, k, (double)low[k], (double)high[k],
                 (double)found_low[k], (double)found_high[k]);
  }
  zoo_free(&zoo);
}

// ---- Shares ----------------------------------------------------------------------------------------------------------

typedef bool Solid(const void *what, const float point[3]);

// V Σ W over the solid points of a lattice around the point, averaged over where the lattice lies.
static double lattice_share(Solid *solid, const void *what, const float point[3], uint64_t *seed) {
  SimCubic cubic = sim_cubic_make(SPACING, 2);
  double sum = 0;
  const int offsets = 512;
  for (int n = 0; n < offsets; n++) {
    // One of 8³ cells of the offset each, at random in it: far less noise than places at random in all of it.
    float offset[3] = {(float)(n % 8), (float)(n / 8 % 8), (float)(n / 64)};
    for (int k = 0; k < 3; k++) offset[k] = (offset[k] + (float)test_random(seed)) / 8;
    for (int i = 0; i < 125; i++) {
      const int at[3] = {i % 5 - 2, i / 5 % 5 - 2, i / 25 - 2};
      float p[3], r2 = 0;
      for (int k = 0; k < 3; k++) {
        float d = SPACING * ((float)at[k] + offset[k] - 0.5f);
        p[k] = point[k] + d, r2 += d * d;
      }
      if (r2 < 4 * SPACING * SPACING && solid(what, p)) sum += (double)sim_cubic_value(&cubic, sqrtf(r2));
    }
  }
  return sum / offsets;
}

static bool in_body(const void *what, const float point[3]) {
  float normal[3];
  return sim_body_distance(what, point, normal) < 0;
}

static bool out_of_container(const void *what, const float point[3]) {
  const SimContainer *c = what;
  if (point[1] < c->min[1] || point[1] > c->max[1]) return true;
  float x = point[0] - 0.5f * (c->min[0] + c->max[0]), z = point[2] - 0.5f * (c->min[2] + c->max[2]);
  float r = 0.5f * fminf(c->max[0] - c->min[0], c->max[2] - c->min[2]);
  return x * x + z * z > r * r;
}

// The same with the kernel that a half-space has, its part along each axis −f': what shapes make of f, without the
// layers of the lattice. Cells of a sixth of a spacing, each at a random place in itself.
static double kernel_share(const SimWall *wall, Solid *solid, const void *what, const float point[3], uint64_t *seed) {
  enum { CELLS = 20 };
  double sum = 0, all = 0;
  for (int i = 0; i < CELLS * CELLS * CELLS; i++) {
    const int at[3] = {i % CELLS, i / CELLS % CELLS, i / CELLS / CELLS};
    float p[3], weight = 1;
    for (int k = 0; k < 3; k++) {
      float slope, d = SPACING * 3.2f * (((float)at[k] + (float)test_random(seed)) / CELLS - 0.5f);
      sim_wall_share(wall, fabsf(d), &slope);
      weight *= slope;
      p[k] = point[k] + d;
    }
    all += (double)weight;
    if (solid(what, p)) sum += (double)weight;
  }
  return sum / all;
}

// At places that particles can take, every shape has the share of the kernel that lies in it.
static void shares_are_those_of_the_kernel(void **state) {
  (void)state;
  Zoo zoo = zoo_make();
  uint64_t seed = 4;
  for (int which = 0; which < ZOO; which++) {
    SimBody body = zoo_body(&zoo, which);
    double worst = 0, sum = 0;
    int count = 0;
    for (int n = 0; n < 1000000 && count < 60; n++) {
      float point[3], normal[3], g[3];
      zoo_random_point(&seed, point);
      float gap = sim_body_distance(&body, point, normal);
      if (gap < 0.9f * CLEARANCE || gap > 1.2f * SPACING) continue;
      double error =
          (double)sim_body_solid(&body, &zoo.wall, point, g) - kernel_share(&zoo.wall, in_body, &body, point, &seed);
      worst = fmax(worst, fabs(error));
      sum += error;
      count++;
    }
    print_message("shape %d: share off by %.4f on the average, %.4f at most\n", which, sum / count, worst);
    assert_true(worst < 0.025 && fabs(sum / count) < 0.01);
  }
  zoo_free(&zoo);
}

// And so has the glass, as long as it is much wider than the kernel: its curvature is taken to first order.
static void a_glass_has_the_share_of_what_is_outside(void **state) {
  (void)state;
  Zoo zoo = zoo_make();
  uint64_t seed = 5;
  const float diameters[4] = {1, 0.5f, 0.25f, 0.1f};
  for (int n = 0; n < 4; n++) {
    SimBoundary glass = zoo_tank(&zoo, SIM_CONTAINER_GLASS, NULL, 0);
    glass.container.max[0] = diameters[n]; // the shorter side
    double worst = 0;
    for (int tries = 0; tries < 100; tries++) {
      float point[3], from[3] = {0.5f * diameters[n], 0.5f, 0.5f};
      SimSolid solid;
      zoo_random_point(&seed, point);
      point[0] = from[0] + diameters[n] * (point[0] - 0.5f) * 1.1f,
      point[2] = 0.5f + diameters[n] * (point[2] - 0.5f) * 1.1f;
      sim_boundary_clamp(&glass, NULL, from, point);
      sim_boundary_solid(&glass, NULL, point, &solid);
      double share = kernel_share(&zoo.wall, out_of_container, &glass.container, point, &seed);
      worst = fmax(worst, fabs((double)solid.share - share));
    }
    print_message("glass %g spacings wide: share within %.4f\n", (double)(diameters[n] / SPACING), worst);
    assert_true(worst < (n < 3 ? 0.025 : 0.1));
  }
  zoo_free(&zoo);
}

static bool behind_plane(const void *what, const float point[3]) {
  return point[0] > *(const float *)what;
}

// What is missing of a lattice that is cut to a glass, wherever it lies, is more than at a flat wall; by as much the
// glass has a larger share. (The flat wall's own share is that of a lattice in line with it: 0.017 less than the
// average here.)
static void a_glass_bends_the_wall_of_a_lattice(void **state) {
  (void)state;
  Zoo zoo = zoo_make();
  uint64_t seed = 6;
  for (int n = 0; n < 9; n++) {
    float radius = n < 3 ? 0.5f : n < 6 ? 0.25f : 0.125f, s = CLEARANCE * (1 + 0.5f * (float)(n % 3)), slope;
    SimBoundary glass = zoo_tank(&zoo, SIM_CONTAINER_GLASS, NULL, 0);
    glass.container.max[0] = 2 * radius;
    const float point[3] = {2 * radius - s, 0.5f, 0.5f};
    SimSolid solid;
    sim_boundary_solid(&glass, NULL, point, &solid);
    double flat = lattice_share(behind_plane, &glass.container.max[0], point, &seed);
    double bent = lattice_share(out_of_container, &glass.container, point, &seed);
    double more = (double)solid.share - (double)sim_wall_share(&zoo.wall, s, &slope);
    print_message("%g spacings wide, %g away: %.4f more, the lattice %.4f\n", (double)(2 * radius / SPACING),
                  (double)(s / SPACING), more, bent - flat);
    assert_true(more > 0 && fabs(more - (bent - flat)) < 0.007);
  }
  zoo_free(&zoo);
}

static bool out_or_in_box(const void *what, const float point[3]) {
  for (int k = 0; k < 3; k++)
    if (point[k] < 0 || point[k] > 1) return true;
  return in_body(what, point);
}

// In the edge where a box stands on the floor, shares add up; where it is sunk into the floor, the floor's part of it
// does not count twice.
static void bodies_on_the_floor_are_not_counted_twice(void **state) {
  (void)state;
  Zoo zoo = zoo_make();
  uint64_t seed = 6;
  const float heights[3] = {0.15f, 0, -0.1f}; // of its middle: standing, half in the floor, nearly gone
  for (int n = 0; n < 3; n++) {
    SimObstacle obstacle = {
        .shape = SIM_BOX, .size = {0.3f, 0.3f, 0.3f}, .position = {0.5f, heights[n], 0.5f}, .rotation = {0, 0, 0, 1}};
    SimBody body = sim_body_make(&obstacle, NULL);
    SimBoundary boundary = zoo_tank(&zoo, SIM_CONTAINER_BOX, &body, 1);
    const float points[3][3] = {{0.325f, CLEARANCE, 0.5f}, {0.325f, 0.06f, 0.5f}, {0.325f, CLEARANCE, 0.325f}};
    for (int p = 0; p < 3; p++) {
      SimSolid solid;
      sim_boundary_solid(&boundary, NULL, points[p], &solid);
      double truth = kernel_share(&zoo.wall, out_or_in_box, &body, points[p], &seed);
      if (fabs((double)solid.share - truth) > 0.015)
        fail_msg("height %g, point %d: share %.4f, of the kernel %.4f", (double)heights[n], p, (double)solid.share,
                 truth);
    }
  }
  zoo_free(&zoo);
}

// The inner corner of a step is to the water what floor and wall are.
static void inner_corners_of_stairs_are_corners(void **state) {
  (void)state;
  Zoo zoo = zoo_make();
  SimObstacle obstacle = {.shape = SIM_STAIRS,
                          .size = {0.8f, 0.8f, 0.8f},
                          .position = {0.5f, 0.5f, 0.5f},
                          .rotation = {0, 0, 0, 1},
                          .steps = 4};
  SimBody body = sim_body_make(&obstacle, NULL);
  SimBoundary with = zoo_tank(&zoo, SIM_CONTAINER_BOX, &body, 1), empty = zoo_tank(&zoo, SIM_CONTAINER_BOX, NULL, 0);
  for (int n = 0; n < 9; n++) {
    // On the second tread (its top at 0.5), before the riser at x = 0.5.
    float x = 0.02f + 0.02f * (float)(n % 3), y = 0.02f + 0.02f * (float)(n / 3);
    SimSolid stairs, corner;
    sim_boundary_solid(&with, NULL, (const float[3]){0.5f - x, 0.5f + y, 0.5f}, &stairs);
    sim_boundary_solid(&empty, NULL, (const float[3]){1 - x, y, 0.5f}, &corner);
    assert_true(fabsf(stairs.share - corner.share) < 1e-4f);
    for (int k = 0; k < 3; k++) assert_true(fabsf(stairs.gradient[k] - corner.gradient[k]) < 1e-2f);
  }
  zoo_free(&zoo);
}

// ---- Gradients -------------------------------------------------------------------------------------------------------

// The gradient of the mesh's share jumps from cell to cell: between both sides' gradients everything is right.
static void check_gradient(const SimBoundary *boundary, const float point[3], const char *what) {
  float e = 1e-3f * SPACING;
  SimSolid here, below, above;
  sim_boundary_solid(boundary, NULL, point, &here);
  for (int k = 0; k < 3; k++) {
    float a[3], b[3];
    memcpy(a, point, sizeof a);
    memcpy(b, point, sizeof b);
    a[k] -= e, b[k] += e;
    sim_boundary_solid(boundary, NULL, a, &below);
    sim_boundary_solid(boundary, NULL, b, &above);
    float quotient = (above.share - below.share) / (b[k] - a[k]);
    float least = fminf(here.gradient[k], fminf(below.gradient[k], above.gradient[k])) - 0.15f,
          most = fmaxf(here.gradient[k], fmaxf(below.gradient[k], above.gradient[k])) + 0.15f;
    if (!(quotient >= least && quotient <= most))
      fail_msg("%s: gradient %d at (%g, %g, %g): %g, difference quotient %g", what, k, (double)point[0],
               (double)point[1], (double)point[2], (double)here.gradient[k], (double)quotient);
  }
}

static void gradients_are_those_of_the_shares(void **state) {
  (void)state;
  Zoo zoo = zoo_make();
  uint64_t seed = 7;
  for (int which = 0; which < 2 * ZOO; which++) {
    // A second body beside the first, both sunk into the floor: every product and every sum has its part.
    SimBody bodies[2] = {zoo_body(&zoo, which % ZOO), zoo_body(&zoo, SIM_BOX)};
    bodies[0].position[1] = 0.1f, bodies[1].position[1] = 0.02f, bodies[1].position[0] = 0.75f;
    SimBoundary boundary = zoo_tank(&zoo, which < ZOO ? SIM_CONTAINER_BOX : SIM_CONTAINER_GLASS, bodies, 2);
    char what[32];
    snprintf(what, sizeof what, "case %d", which);
    for (int n = 0, near = 0; near < 150 && n < 300000; n++) {
      float point[3], normal[3];
      zoo_random_point(&seed, point);
      point[1] *= 0.3f;
      if (!sim_boundary_free(&boundary, point)) continue;
      if (n % 4 && sim_body_distance(&bodies[0], point, normal) > 0.08f) continue;
      near++;
      check_gradient(&boundary, point, what);
    }
  }
  zoo_free(&zoo);
}

// What a floating body adds is what is missing without it.
static void a_floating_body_has_its_part(void **state) {
  (void)state;
  Zoo zoo = zoo_make();
  uint64_t seed = 8;
  SimBody bodies[3] = {zoo_body(&zoo, SIM_BOX), zoo_body(&zoo, SIM_SPHERE), zoo_body(&zoo, SIM_CAPSULE)};
  bodies[0].position[0] = 0.3f, bodies[1].position[0] = 0.68f, bodies[2].position[1] = 0.2f;
  bodies[1].floats = bodies[1].moves = bodies[2].floats = bodies[2].moves = true;
  bodies[1].friction = 0.5f, bodies[2].friction = 1;
  for (int k = 0; k < 3; k++) bodies[1].velocity[k] = (float)(k + 1), bodies[2].spin[k] = (float)(3 - k);
  SimBoundary boundary = zoo_tank(&zoo, SIM_CONTAINER_BOX, bodies, 3);
  int seen[3] = {0, 0, 0};
  for (int n = 0; n < 20000; n++) {
    float point[3], g[3], share[3];
    SimSolid solid, without;
    zoo_random_point(&seed, point);
    if (!sim_boundary_free(&boundary, point)) continue;
    sim_boundary_solid(&boundary, NULL, point, &solid);
    for (int b = 0; b < 3; b++) share[b] = sim_body_solid(&bodies[b], &zoo.wall, point, g);
    int32_t both = share[1] > 0 && share[2] > 0, expected = share[1] > 0 ? 1 : share[2] > 0 ? 2 : -1;
    if (both) expected = 1 + n % 2;
    assert_int_equal(solid.body[0], both ? 1 : expected);
    assert_int_equal(solid.body[1], both ? 2 : -1);
    float walls = 0, sum = share[0] + share[1] + share[2];
    SimBoundary empty = boundary;
    empty.body_count = 0;
    sim_boundary_solid(&empty, NULL, point, &without);
    walls = without.share, sum += walls;
    if (sum > 0) assert_true(fabsf(solid.friction - (0.25f * walls + 0.5f * share[1] + share[2]) / sum) < 1e-4f);
    for (int k = 0; k < 3; k++) {
      const float *w = bodies[2].spin, *x = bodies[2].position;
      float v = w[(k + 1) % 3] * (point[(k + 2) % 3] - x[(k + 2) % 3]) -
                w[(k + 2) % 3] * (point[(k + 1) % 3] - x[(k + 1) % 3]);
      float mean = sum > 0 ? (share[1] * (float)(k + 1) + share[2] * v) / sum : 0;
      assert_true(fabsf(solid.velocity[k] - mean) < 1e-3f);
    }
    if (expected < 0) continue;
    seen[expected]++;
    // The gradient as a body moves: its own part is minus what the share changes by when it is shifted.
    for (int k = 0; k < 3; k++) {
      float e = 5e-5f;
      SimSolid shifted[2];
      for (int side = 0; side < 2; side++) {
        SimBody kept = bodies[expected];
        bodies[expected].position[k] += side ? e : -e;
        // Alone with the shift: how far it reaches through faces stays as it was, no body touches one here.
        sim_boundary_solid(&boundary, NULL, point, &shifted[side]);
        bodies[expected] = kept;
      }
      float quotient = (shifted[1].share - shifted[0].share) / (2 * e);
      SimSolid alone;
      SimBoundary single = boundary;
      single.bodies = &bodies[expected], single.body_count = 1;
      sim_boundary_solid(&single, NULL, point, &alone);
      if (alone.share > 0 && walls == 0) assert_true(fabsf(quotient + solid.body_gradient[both && expected == 2][k]) < 0.15f);
    }
  }
  assert_true(seen[1] > 100 && seen[2] > 100);
  zoo_free(&zoo);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stairs_have_the_distance_of_their_triangles),
      cmocka_unit_test(capsules_have_the_distance_of_their_axis),
      cmocka_unit_test(normals_are_unit_everywhere),
      cmocka_unit_test(boxes_around_bodies_hold_them),
      cmocka_unit_test(shares_are_those_of_the_kernel),
      cmocka_unit_test(a_glass_has_the_share_of_what_is_outside),
      cmocka_unit_test(a_glass_bends_the_wall_of_a_lattice),
      cmocka_unit_test(bodies_on_the_floor_are_not_counted_twice),
      cmocka_unit_test(inner_corners_of_stairs_are_corners),
      cmocka_unit_test(gradients_are_those_of_the_shares),
      cmocka_unit_test(a_floating_body_has_its_part),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
