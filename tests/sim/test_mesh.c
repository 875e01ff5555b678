// Closed triangle meshes: what is refused, distances and paths against brute force, shares against boxes.
#include "sim_test.h"

#include "reference/meshes.h"
#include "sim/memory.h"
#include "sim/mesh_distance.h"
#include "sim/mesh_topology.h"
#include "sim/obstacles.h"

#define SPACING 0.05f

static SimWall wall_of(float spacing) {
  SimCubic cubic = sim_cubic_make(spacing, 2);
  SimWall wall;
  sim_wall_make(&wall, &cubic);
  return wall;
}

static SimMeshDistance *field_of(const TestMesh *mesh, float spacing) {
  SimWall wall = wall_of(spacing);
  SimError error;
  if (!sim_mesh_check(&mesh->view, "mesh", &error)) fail_msg("%s", error.message);
  SimMeshDistance *field = sim_mesh_distance_create(&mesh->view, &wall, 2);
  assert_non_null(field);
  return field;
}

static void refused(const SimMesh *mesh, const char *expected) {
  SimError error;
  assert_false(sim_mesh_check(mesh, "obstacles[3]", &error));
  if (strncmp(error.message, "obstacles[3]: ", 14) != 0 || !strstr(error.message, expected))
    fail_msg("message \"%s\" lacks \"%s\"", error.message, expected);
}

static void bad_meshes_are_refused(void **state) {
  (void)state;
  TestMesh box = test_mesh_box((const float[3]){0.1f, 0.1f, 0.1f});
  SimMesh mesh = box.view;
  SimError error;
  assert_true(sim_mesh_check(&mesh, "m", &error));
  mesh.triangle_count--;
  refused(&mesh, "not closed");
  mesh.triangle_count = 3;
  refused(&mesh, "triangles, got 3");
  mesh = box.view, mesh.triangle_count = 4000001;
  refused(&mesh, "triangles, got 4000001");
  mesh = box.view, mesh.vertex_count = -1;
  refused(&mesh, "vertices, got -1");
  mesh = box.view, mesh.vertex = NULL;
  refused(&mesh, "vertices");
  float kept = box.vertex[4];
  box.vertex[4] = NAN;
  refused(&box.view, "vertex 1");
  box.vertex[4] = -INFINITY;
  refused(&box.view, "vertex 1");
  box.vertex[4] = kept;
  int32_t *t = box.triangle + 6, first = t[0], second = t[1];
  t[0] = 8;
  refused(&box.view, "triangle 2: there is no vertex 8");
  t[0] = -1;
  refused(&box.view, "triangle 2: there is no vertex -1");
  t[0] = second;
  refused(&box.view, "triangle 2 uses a vertex twice");
  t[0] = second, t[1] = first;
  refused(&box.view, "opposite senses");
  t[0] = first, t[1] = second;
  for (int32_t n = 0; n < box.view.triangle_count; n++) {
    int32_t a = box.triangle[3 * n];
    box.triangle[3 * n] = box.triangle[3 * n + 1], box.triangle[3 * n + 1] = a;
  }
  refused(&box.view, "seen from outside");
  test_mesh_free(&box);
}

static void an_edge_of_four_triangles_is_refused(void **state) {
  (void)state;
  // Two tetrahedra with a common edge.
  const float vertex[6][3] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 0, 1}, {-1, 0, 0}, {-1, 0, -1}};
  const int32_t triangle[8][3] = {{0, 1, 2}, {0, 2, 3}, {1, 3, 2}, {0, 3, 1},
                                  {0, 1, 4}, {0, 4, 5}, {1, 5, 4}, {0, 5, 1}};
  SimMesh mesh = {6, 8, vertex[0], triangle[0]};
  refused(&mesh, "more than two triangles at the edge of vertices 0 and 1");
}

static void volumes_are_those_of_solids(void **state) {
  (void)state;
  TestMesh box = test_mesh_box((const float[3]){0.1f, 0.2f, 0.3f}),
           flight = test_mesh_stairs((const float[3]){1, 1, 1}, 4), ball = test_mesh_ball(1, 4),
           four = test_mesh_tetrahedron(0.5f);
  assert_true(fabs(sim_mesh_volume(&box.view) - 0.048) < 1e-6);
  assert_true(fabs(sim_mesh_volume(&flight.view) - 8 * 0.625) < 1e-5);
  assert_true(fabs(sim_mesh_volume(&ball.view) - 4.18879) < 0.05);
  assert_true(fabs(sim_mesh_volume(&four.view) - 1.0 / 3) < 1e-6);
  test_mesh_free(&box);
  test_mesh_free(&flight);
  test_mesh_free(&ball);
  test_mesh_free(&four);
}

#define MESHES 6
static void make_meshes(TestMesh meshes[MESHES]) {
  meshes[0] = test_mesh_tetrahedron(0.2f);
  meshes[1] = test_mesh_box((const float[3]){0.2f, 0.003f, 0.15f}); // a plate far thinner than a cell
  meshes[2] = test_mesh_stairs((const float[3]){0.3f, 0.2f, 0.1f}, 5);
  meshes[3] = test_mesh_ball(0.25f, 3);
  meshes[4] = test_mesh_ring(0.2f, 0.06f, 12, 40);
  meshes[5] = test_mesh_box((const float[3]){0.3f, 0.0005f, 0.0005f}); // a needle
}

static void random_near(uint64_t *seed, const SimMeshDistance *field, float around, float point[3]) {
  for (int k = 0; k < 3; k++)
    point[k] = field->low[k] - around + (field->high[k] - field->low[k] + 2 * around) * (float)test_random(seed);
}

// The tree is exact; the grid is exact near the surface and interpolates elsewhere; beyond it is never too large.
static void distances_are_those_of_all_triangles(void **state) {
  (void)state;
  TestMesh meshes[MESHES];
  make_meshes(meshes);
  uint64_t seed = 1;
  for (int m = 0; m < MESHES; m++) {
    SimMeshDistance *field = field_of(&meshes[m], SPACING);
    double worst = 0;
    for (int n = 0; n < 1500; n++) {
      float point[3], normal[3];
      int32_t hint = (int32_t)(test_random(&seed) * field->mesh.triangle_count);
      random_near(&seed, field, n % 3 ? 0.02f : 0.2f, point);
      const double p[3] = {(double)point[0], (double)point[1], (double)point[2]};
      double truth = reference_mesh_distance(&field->mesh, p) * (reference_mesh_inside(&field->mesh, p) ? -1 : 1);
      double exact = (double)sim_mesh_tree_distance(&field->tree, point, &hint, normal);
      if (fabs(exact - truth) > 1e-6) fail_msg("mesh %d: distance %.7f, is %.7f", m, exact, truth);
      assert_true(fabsf(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2] - 1) < 1e-5f);
      double looked_up = (double)sim_mesh_distance(field, point, normal);
      assert_true(fabsf(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2] - 1) < 1e-5f);
      assert_true(looked_up * truth >= 0);
      if (truth < (double)(1.2f * SPACING)) worst = fmax(worst, fabs(looked_up - truth));
      assert_true(looked_up < truth + (double)(0.1f * SPACING));
    }
    print_message("mesh %d: looked up within %.4f spacings\n", m, worst / (double)SPACING);
    assert_true(worst < (double)(0.1f * SPACING));
    sim_mesh_distance_destroy(field);
    test_mesh_free(&meshes[m]);
  }
}

// The normal leads away from the nearest surface point.
static void normals_lead_to_the_surface(void **state) {
  (void)state;
  TestMesh ring = test_mesh_ring(0.2f, 0.06f, 12, 40);
  SimMeshDistance *field = field_of(&ring, SPACING);
  uint64_t seed = 2;
  for (int n = 0; n < 2000; n++) {
    float point[3], normal[3], ignored[3], on[3];
    int32_t hint = 0;
    random_near(&seed, field, 0.1f, point);
    float gap = sim_mesh_tree_distance(&field->tree, point, &hint, normal);
    for (int k = 0; k < 3; k++) on[k] = point[k] - gap * normal[k];
    assert_true(fabsf(sim_mesh_tree_distance(&field->tree, on, &hint, ignored)) < 1e-6f);
  }
  sim_mesh_distance_destroy(field);
  test_mesh_free(&ring);
}

// The vertices and the middles of edges lie on the surface: no NaN, and unit normals that do not lead inwards.
static void points_on_the_surface_have_normals(void **state) {
  (void)state;
  TestMesh meshes[MESHES];
  make_meshes(meshes);
  for (int m = 0; m < MESHES; m++) {
    SimMeshDistance *field = field_of(&meshes[m], SPACING);
    for (int32_t e = 0; e < 3 * field->mesh.triangle_count; e++) {
      const float *a = field->mesh.vertex + 3 * field->mesh.triangle[e],
                  *b = field->mesh.vertex + 3 * field->mesh.triangle[e % 3 == 2 ? e - 2 : e + 1];
      for (int half = 0; half < 2; half++) {
        float point[3], normal[3], out[3], ignored[3], gap;
        for (int k = 0; k < 3; k++) point[k] = half ? 0.5f * (a[k] + b[k]) : a[k];
        gap = sim_mesh_distance(field, point, normal);
        assert_true(fabsf(gap) < 1e-6f);
        assert_true(fabsf(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2] - 1) < 1e-5f);
        if (gap != 0) continue;
        for (int k = 0; k < 3; k++) out[k] = point[k] + 1e-4f * normal[k];
        gap = sim_mesh_distance(field, out, ignored);
        if (!(gap > -1e-6f)) // 0 in an inner corner, up along the other face
          fail_msg("mesh %d: (%g, %g, %g) + (%g, %g, %g): %g", m, (double)point[0], (double)point[1], (double)point[2],
                   (double)normal[0], (double)normal[1], (double)normal[2], (double)gap);
      }
    }
    sim_mesh_distance_destroy(field);
    test_mesh_free(&meshes[m]);
  }
}

static int crossings(const SimMesh *mesh, const float from[3], const float to[3]) {
  int changes = 0;
  bool inside = false;
  for (int n = 0; n <= 400; n++) {
    double p[3];
    for (int k = 0; k < 3; k++) p[k] = (double)from[k] + ((double)to[k] - (double)from[k]) * n / 400;
    bool now = reference_mesh_inside(mesh, p);
    if (n > 0 && now != inside) changes++;
    inside = now;
  }
  return changes;
}

// A path from outside that is inside somewhere must be noticed, and where it is noticed the surface is.
static void paths_meet_the_surface(void **state) {
  (void)state;
  TestMesh meshes[MESHES];
  make_meshes(meshes);
  uint64_t seed = 3;
  for (int m = 0; m < MESHES - 1; m++) {
    SimMeshDistance *field = field_of(&meshes[m], SPACING);
    for (int n = 0, tried = 0; tried < 150 && n < 10000; n++) {
      float from[3], to[3], t = -1, normal[3], on[3], ignored[3];
      int32_t hint = 0;
      random_near(&seed, field, 0.1f, from);
      random_near(&seed, field, 0.1f, to);
      if (sim_mesh_tree_distance(&field->tree, from, &hint, ignored) < 0) continue;
      tried++;
      bool hit = sim_mesh_tree_hit(&field->tree, from, to, &t, normal);
      if (!hit) {
        if (crossings(&field->mesh, from, to) != 0) fail_msg("mesh %d: a path slips through", m);
        continue;
      }
      for (int k = 0; k < 3; k++) on[k] = from[k] + t * (to[k] - from[k]);
      assert_true(fabsf(sim_mesh_tree_distance(&field->tree, on, &hint, ignored)) < 1e-5f);
      for (int k = 0; k < 3; k++) on[k] = from[k] + 0.99f * t * (to[k] - from[k]);
      assert_true(crossings(&field->mesh, from, on) == 0);
    }
    sim_mesh_distance_destroy(field);
    test_mesh_free(&meshes[m]);
  }
  test_mesh_free(&meshes[MESHES - 1]);
}

// Straight through every edge and every vertex of a ball: nothing slips through between two triangles.
static void no_path_slips_through_an_edge(void **state) {
  (void)state;
  TestMesh ball = test_mesh_ball(0.25f, 3);
  SimMeshDistance *field = field_of(&ball, SPACING);
  for (int32_t e = 0; e < 3 * field->mesh.triangle_count; e++) {
    const float *a = field->mesh.vertex + 3 * field->mesh.triangle[e],
                *b = field->mesh.vertex + 3 * field->mesh.triangle[e % 3 == 2 ? e - 2 : e + 1];
    float from[3], to[3] = {0, 0, 0}, t, normal[3];
    for (int k = 0; k < 3; k++) from[k] = a[k] + b[k];
    assert_true(sim_mesh_tree_hit(&field->tree, from, to, &t, normal));
    for (int k = 0; k < 3; k++) from[k] = 2 * a[k];
    assert_true(sim_mesh_tree_hit(&field->tree, from, to, &t, normal));
  }
  sim_mesh_distance_destroy(field);
  test_mesh_free(&ball);
}

static SimBody body_of(SimShape shape, const float size[3], int32_t steps, const SimMeshDistance *mesh) {
  SimObstacle obstacle = {.shape = shape, .rotation = {0, 0, 0, 1}, .steps = steps};
  memcpy(obstacle.size, size, sizeof obstacle.size);
  return sim_body_make(&obstacle, mesh);
}

// The mesh of a box or a flight of stairs has the share of the shape itself, also where it is thinner than a particle.
static void shares_are_those_of_the_shape(void **state) {
  (void)state;
  const struct {
    SimShape shape;
    float size[3];
    int32_t steps;
    double bound;
  } cases[4] = {{SIM_BOX, {0.4f, 0.3f, 0.35f}, 1, 0.015},
                {SIM_BOX, {0.4f, 0.02f, 0.35f}, 1, 0.015},
                {SIM_BOX, {0.4f, 0.001f, 0.35f}, 1, 0.02},
                {SIM_STAIRS, {0.6f, 0.4f, 0.3f}, 4, 0.015}};
  SimWall wall = wall_of(SPACING);
  uint64_t seed = 4;
  for (int c = 0; c < 4; c++) {
    float half[3];
    for (int k = 0; k < 3; k++) half[k] = cases[c].size[k] / 2;
    TestMesh mesh = test_mesh_stairs(half, cases[c].steps);
    SimMeshDistance *field = field_of(&mesh, SPACING);
    SimBody body = body_of(cases[c].shape, cases[c].size, cases[c].steps, NULL);
    double worst = 0;
    for (int n = 0; n < 20000; n++) {
      float point[3], g[3], normal[3];
      random_near(&seed, field, 0.1f, point);
      if (sim_body_distance(&body, point, normal) < 0.3f * SPACING) continue;
      worst =
          fmax(worst, fabs((double)sim_mesh_solid(field, point, g) - (double)sim_body_solid(&body, &wall, point, g)));
    }
    print_message("shape %d: share within %.4f\n", c, worst);
    assert_true(worst < cases[c].bound);
    sim_mesh_distance_destroy(field);
    test_mesh_free(&mesh);
  }
}

static void a_mesh_that_is_too_large_for_the_grid_still_holds(void **state) {
  (void)state;
  TestMesh box = test_mesh_box((const float[3]){1, 1, 1});
  SimMeshDistance *field = field_of(&box, 0.004f);
  assert_true(field->cell > 0.01f); // three spacings
  assert_true((double)field->size[0] * field->size[1] * field->size[2] <= 4e6);
  float normal[3], g[3];
  assert_true(fabsf(sim_mesh_distance(field, (const float[3]){1.002f, 0.3f, 0.2f}, normal) - 0.002f) < 1e-6f);
  assert_true(fabsf(normal[0] - 1) < 1e-6f);
  float share = sim_mesh_solid(field, (const float[3]){0.5f, 0.3f, 0.2f}, g);
  assert_true(fabsf(share - 1) < 1e-5f);
  sim_mesh_distance_destroy(field);
  test_mesh_free(&box);
}

static uint64_t hash_of(const SimMeshDistance *field) {
  uint64_t hash = 14695981039346656037u;
  size_t count = (size_t)field->size[0] * (size_t)field->size[1] * (size_t)field->size[2];
  for (int which = 0; which < 2; which++) {
    const unsigned char *byte = (const unsigned char *)(which ? field->distance : field->share);
    for (size_t n = 0; n < count * sizeof(float); n++) hash = (hash ^ byte[n]) * 1099511628211u;
  }
  return hash;
}

static void threads_do_not_matter(void **state) {
  (void)state;
  TestMesh ball = test_mesh_ball(0.1f, 3);
  SimWall wall = wall_of(SPACING);
  uint64_t expected = 0;
  const int threads[4] = {1, 2, 3, 8};
  for (int n = 0; n < 4; n++) {
    SimMeshDistance *field = sim_mesh_distance_create(&ball.view, &wall, threads[n]);
    uint64_t hash = hash_of(field);
    if (n == 0) expected = hash;
    assert_true(hash == expected);
    sim_mesh_distance_destroy(field);
  }
  test_mesh_free(&ball);
}

static void memory_runs_out_cleanly(void **state) {
  (void)state;
  TestMesh ball = test_mesh_ball(0.1f, 3);
  SimWall wall = wall_of(SPACING);
  size_t before = sim_bytes_in_use();
  SimError error;
  bool made = false;
  for (size_t more = 1000; !made && more < 100000000; more += more / 3) {
    sim_memory_limit(before + more);
    SimMeshDistance *field = sim_mesh_distance_create(&ball.view, &wall, 2);
    made = field != NULL;
    sim_mesh_distance_destroy(field);
    sim_mesh_check(&ball.view, "m", &error);
    assert_true(sim_bytes_in_use() == before);
  }
  sim_memory_limit(0);
  assert_true(made);
  test_mesh_free(&ball);
}

// The world has its own copies; obstacles of one mesh share them, and everything is given back.
static void a_world_copies_its_meshes(void **state) {
  (void)state;
  size_t before = sim_bytes_in_use();
  TestMesh ball = test_mesh_ball(0.1f, 2);
  SimBlockDef block;
  SimWorldDef def = test_def((const float[3]){1, 0.5f, 0.5f}, &block, (const float[3]){1, 0.3f, 0.5f});
  SimObstacleDef solids[2] = {sim_default_obstacle_def(), sim_default_obstacle_def()};
  for (int b = 0; b < 2; b++) {
    solids[b].body.shape = SIM_MESH;
    solids[b].body.mesh = &ball.view;
    for (int k = 0; k < 3; k++) solids[b].body.position[k] = k == 0 ? 0.25f + 0.5f * (float)b : 0.2f;
  }
  def.obstacle_count = 2, def.obstacles = solids;
  SimWorld *world = test_create(&def);
  memset(ball.vertex, 0xff, (size_t)ball.view.vertex_count * 3 * sizeof(float));
  test_mesh_free(&ball);
  memset(solids, 0xff, sizeof solids);
  assert_true(sim_world_counts(world).left_out > 10);
  test_advance(world, 10);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  const SimFrame *frame = test_frame(world, 0, buffer);
  test_inside_container(frame);
  assert_true(frame->obstacles[0].mesh && frame->obstacles[0].mesh == frame->obstacles[1].mesh);
  assert_int_equal(frame->obstacles[0].mesh->vertex_count, 66);
  for (int32_t i = 0; i < frame->count; i++)
    for (int b = 0; b < 2; b++) {
      float d2 = 0;
      for (int k = 0; k < 3; k++) {
        float d = frame->position[3 * i + k] - frame->obstacles[b].position[k];
        d2 += d * d;
      }
      assert_true(sqrtf(d2) > 0.09f); // the faces of this ball lie a little inside it
    }
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
  assert_true(sim_bytes_in_use() == before);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bad_meshes_are_refused),
      cmocka_unit_test(an_edge_of_four_triangles_is_refused),
      cmocka_unit_test(volumes_are_those_of_solids),
      cmocka_unit_test(distances_are_those_of_all_triangles),
      cmocka_unit_test(normals_lead_to_the_surface),
      cmocka_unit_test(points_on_the_surface_have_normals),
      cmocka_unit_test(paths_meet_the_surface),
      cmocka_unit_test(no_path_slips_through_an_edge),
      cmocka_unit_test(shares_are_those_of_the_shape),
      cmocka_unit_test(a_mesh_that_is_too_large_for_the_grid_still_holds),
      cmocka_unit_test(threads_do_not_matter),
      cmocka_unit_test(memory_runs_out_cleanly),
      cmocka_unit_test(a_world_copies_its_meshes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
