// The second layer of the height field: water that hangs over air, against the slow formula and where it is known.
#include "sim_test.h"

#include "reference/reference.h"

#define REACH 2.625 // h of Eq. 5, in spacings
#define ISO 22.0393 // φ at the surface of a level lattice: see the_iso_value

static SimFrameBuffer *buffer;

static int make_buffer(void **state) {
  (void)state;
  buffer = sim_frame_buffer_create();
  return buffer == NULL;
}

static int free_buffer(void **state) {
  (void)state;
  sim_frame_buffer_destroy(buffer);
  return 0;
}

// Water in a container of 2 m × 1.2 m × 0.8 m with whatever stands in it, before it moves.
static const SimHeightField *field_of(const SimBlockDef *blocks, int count, const SimObstacleDef *obstacle) {
  SimBlockDef unused;
  SimWorldDef def = test_def((const float[3]){2, 1.2f, 0.8f}, &unused, (const float[3]){1, 1, 1});
  def.block_count = count, def.blocks = blocks;
  def.obstacle_count = obstacle != NULL, def.obstacles = obstacle;
  SimWorld *world = test_create(&def);
  const SimHeightField *field = &test_frame(world, SIM_NEED_SECOND_LAYER, buffer)->height_field;
  sim_world_destroy(world); // a frame outlives its world
  return field;
}

static float x_of(const SimHeightField *f, int node) {
  return f->origin[0] + f->spacing * (float)(node % f->size[0]);
}

// m, of a node where the lattices' edges are far enough; a quarter of a spacing at most is what they may be off by (0.05 m)
static void expect(const SimHeightField *f, int node, float height, float underside, float second) {
  const float tolerance = 0.1f * 0.05f;
  if (fabsf(f->height[node] - height) > tolerance || fabsf(f->underside[node] - underside) > tolerance ||
      fabsf(f->second[node] - second) > tolerance)
    fail_msg("at x = %g: %g, %g, %g instead of %g, %g, %g", (double)x_of(f, node), (double)f->height[node],
             (double)f->underside[node], (double)f->second[node], (double)height, (double)underside, (double)second);
}

// A slab of water in the air, over a pool and over the dry floor.
static void a_slab_over_a_pool(void **state) {
  (void)state;
  const SimBlockDef blocks[2] = {{{0, 0, 0}, {2, 0.3f, 0.8f}}, {{0, 0.6f, 0}, {1, 0.9f, 0.8f}}};
  const SimHeightField *f = field_of(blocks, 2, NULL);
  for (int node = 0; node < f->size[0] * f->size[1]; node++) {
    if (x_of(f, node) < 0.85f) expect(f, node, 0.9f, 0.6f, 0.3f);
    if (x_of(f, node) > 1.15f) expect(f, node, 0.3f, 0, 0);
  }
  f = field_of(blocks + 1, 1, NULL);
  for (int node = 0; node < f->size[0] * f->size[1]; node++) {
    if (x_of(f, node) < 0.85f) expect(f, node, 0.9f, 0.6f, 0);
    if (x_of(f, node) > 1.15f) expect(f, node, 0, 0, 0);
  }
}

// Of three layers the upper two are told; the third one is under the second, which counts as water down to the floor.
static void a_third_layer_is_not_told(void **state) {
  (void)state;
  const SimBlockDef blocks[3] = {
      {{0, 0, 0}, {2, 0.2f, 0.8f}}, {{0, 0.4f, 0}, {2, 0.6f, 0.8f}}, {{0, 0.8f, 0}, {2, 1, 0.8f}}};
  const SimHeightField *f = field_of(blocks, 3, NULL);
  for (int node = 0; node < f->size[0] * f->size[1]; node++) expect(f, node, 1, 0.8f, 0.6f);
}

// A crack that is no wider than particles are apart is none.
static void a_crack_is_closed(void **state) {
  (void)state;
  const SimBlockDef blocks[2] = {{{0, 0, 0}, {2, 0.3f, 0.8f}}, {{0, 0.35f, 0}, {2, 0.6f, 0.8f}}};
  const SimHeightField *f = field_of(blocks, 2, NULL);
  for (int node = 0; node < f->size[0] * f->size[1]; node++) expect(f, node, 0.6f, 0, 0);
}

static void obstacles_are_no_air(void **state) {
  (void)state;
  SimObstacleDef obstacle = sim_default_obstacle_def();
  const SimBlockDef pool = {{0, 0, 0}, {2, 0.6f, 0.8f}};
  const SimObstacle bodies[] = {
      {SIM_BOX, {0.5f, 0.2f, 0.4f}, {1, 0.25f, 0.4f}, {0, 0, 0, 1}},
      {SIM_SPHERE, {0.35f, 0, 0}, {0.83f, 0.31f, 0.42f}, {0, 0, 0, 1}},
      {SIM_BOX, {0.4f, 1, 0.3f}, {1, 0.5f, 0.4f}, {0, 0, 0, 1}},
      {SIM_BOX, {0.8f, 0.1f, 0.1f}, {1, 0.3f, 0.4f}, {0.3f, 0, 0.3f, 0.9f}},
  };
  for (size_t k = 0; k < sizeof bodies / sizeof *bodies; k++) {
    obstacle.body = bodies[k];
    const SimHeightField *f = field_of(&pool, 1, &obstacle);
    for (int node = 0; node < f->size[0] * f->size[1]; node++)
      if (f->underside[node] != 0 || f->second[node] != 0)
        fail_msg("body %zu: underside %g at x = %g", k, (double)f->underside[node], (double)x_of(f, node));
  }
}

// Water on a table top over a pool: its lower end is the table, the second layer the pool.
static void a_wet_table_over_a_pool(void **state) {
  (void)state;
  SimObstacleDef table = sim_default_obstacle_def();
  table.body = (SimObstacle){SIM_BOX, {1, 0.1f, 0.8f}, {0.5f, 0.65f, 0.4f}, {0, 0, 0, 1}};
  const SimBlockDef blocks[2] = {{{0, 0, 0}, {2, 0.2f, 0.8f}}, {{0, 0.7f, 0}, {1, 0.9f, 0.8f}}};
  const SimHeightField *f = field_of(blocks, 2, &table);
  for (int node = 0; node < f->size[0] * f->size[1]; node++) {
    const float x = x_of(f, node);
    if (x > 1.15f) expect(f, node, 0.2f, 0, 0);
    if (x > 0.85f) continue;
    assert_true(fabsf(f->height[node] - 0.9f) < 0.005f && fabsf(f->second[node] - 0.2f) < 0.005f);
    if (!(f->underside[node] > 0.6f && f->underside[node] < 0.725f)) fail_msg("%g", (double)f->underside[node]);
  }
}

// ---- The slow twin ------------------------------------------------------------------------------------------------------------

typedef struct Water {
  const float *position;
  int count;
  double x, z;
} Water;

static double over(const Water *w, double y) {
  return reference_potential(w->position, w->count, (double[3]){w->x, y, w->z}, REACH * 0.1) - ISO;
}

static void the_iso_value(void **state) {
  (void)state;
  float *lattice = test_lattice(9, 5, 9, 1, 0, 1);
  double sum = 0;
  for (int a = 0; a < 16; a++)
    for (int b = 0; b < 16; b++)
      sum += reference_potential(lattice, 405, (double[3]){4 + (a + 0.5) / 16, 5, 4 + (b + 0.5) / 16}, REACH) / 256;
  free(lattice);
  if (fabs(sum - ISO) > 0.01) fail_msg("%.4f", sum);
}

// A wave that breaks: a slope with a lip that reaches over its foot. Where the layers of a column are told, water begins and ends
// there; where none is told, no gap of air above the floor is wider than a spacing.
static void layers_match_the_formula(void **state) {
  (void)state;
  enum { NX = 24, NY = 14, NZ = 8 };
  float *all = test_lattice(NX, NY, NZ, 0.1, 0.2, 5);
  int count = 0;
  for (int i = 0; i < NX * NY * NZ; i++) {
    const float x = all[3 * i], y = all[3 * i + 1];
    const bool tube =
        (x - 1.3f) * (x - 1.3f) + (y - 0.7f) * (y - 0.7f) < 0.35f * 0.35f || (x > 1.3f && y > 0.4f && y < 0.9f);
    if (y > 0.4f && (tube || x > 1.75f)) continue;
    memmove(all + 3 * count++, all + 3 * i, 3 * sizeof *all);
  }
  SimError error = {""};
  const SimParticleSet set = {.count = count, .position = all, .particle_radius = 0.05f};
  const SimFrame *frame = sim_frame_from_particles(&set, SIM_NEED_SECOND_LAYER, 2, buffer, &error);
  if (!frame) fail_msg("%s", error.message);
  const SimHeightField *f = &frame->height_field;
  const double floor = (double)frame->bounds_min[1];
  int hanging = 0;
  for (int node = 0; node < f->size[0] * f->size[1]; node++) {
    const Water w = {all, count, (double)x_of(f, node),
                     (double)(f->origin[1] + f->spacing * (float)(node / f->size[0]))};
    const double height = (double)f->height[node], underside = (double)f->underside[node],
                 second = (double)f->second[node];
    if (!(height > floor)) continue;
    const double end = underside > floor ? underside : floor;
    double gap = 0; // m, the longest dry stretch in what counts as water
    for (double y = height - 0.03, dry = 0; y > end + 0.03; y -= 0.005) {
      dry = over(&w, y) < -0.25 ? dry + 0.005 : 0;
      gap = fmax(gap, dry);
    }
    if (gap > 0.11) fail_msg("node %d: %g m of air between %g and %g", node, gap, height, end);
    if (!(underside > floor)) {
      assert_true(second == floor);
      continue;
    }
    hanging++;
    assert_true(fabs(over(&w, underside)) < 0.05 && height > underside && underside - second >= 0.1 - 1e-6);
    assert_true(second == floor || fabs(over(&w, second)) < 0.05);
    for (double y = underside - 0.025; y > second + 0.025; y -= 0.005)
      if (over(&w, y) > 0.25) fail_msg("node %d: water in the gap at %g", node, y);
  }
  print_message("%d of %d nodes hang over\n", hanging, f->size[0] * f->size[1]);
  assert_true(hanging > 40);
  free(all);
}

static void only_where_asked_for(void **state) {
  (void)state;
  const float two[6] = {0, 0, 0, 1, 0.5f, 1};
  SimError error;
  const SimParticleSet set = {.count = 2, .position = two, .particle_radius = 0.05f};
  const SimHeightField *f = &sim_frame_from_particles(&set, SIM_NEED_HEIGHT_FIELD, 1, buffer, &error)->height_field;
  assert_true(f->height && !f->underside && !f->second);
  f = &sim_frame_from_particles(&set, SIM_NEED_SECOND_LAYER, 1, buffer, &error)->height_field;
  for (int node = 0; node < f->size[0] * f->size[1]; node++)
    assert_true(f->underside[node] == f->height[node] && f->second[node] == f->height[node]); // dry: the floor
  // Waves without particles.
  const SimWaveDef wave = {.amplitude = 0.05f, .wavelength = 0.5f, .direction = {1, 0}};
  SimBlockDef unused;
  SimWorldDef def = test_def((const float[3]){2, 1.2f, 0.8f}, &unused, (const float[3]){1, 1, 1});
  def.ripple = true, def.ripple_level = 0.5f, def.wave_count = 1, def.waves = &wave, def.block_count = 0;
  SimWorld *world = test_create(&def);
  f = &test_frame(world, SIM_NEED_ALL, buffer)->height_field;
  for (int node = 0; node < f->size[0] * f->size[1]; node++)
    assert_true(f->height[node] > 0.4f && f->underside[node] == 0 && f->second[node] == 0);
  sim_world_destroy(world);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_slab_over_a_pool),       cmocka_unit_test(a_third_layer_is_not_told),
      cmocka_unit_test(a_crack_is_closed),        cmocka_unit_test(obstacles_are_no_air),
      cmocka_unit_test(a_wet_table_over_a_pool),  cmocka_unit_test(the_iso_value),
      cmocka_unit_test(layers_match_the_formula), cmocka_unit_test(only_where_asked_for),
  };
  return cmocka_run_group_tests(tests, make_buffer, free_buffer);
}
