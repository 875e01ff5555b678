// The height field against the slow formula, and on water whose level is known.
#include "sim_test.h"

#include "reference/reference.h"

static const SimFrame *frame_of(const float *position, int32_t count, SimFrameBuffer *buffer) {
  SimError error = {""};
  SimParticleSet set = {.count = count, .position = position, .particle_radius = 0.05f};
  const SimFrame *frame = sim_frame_from_particles(&set, SIM_NEED_HEIGHT_FIELD, 2, buffer, &error);
  if (!frame) fail_msg("%s", error.message);
  return frame;
}

/// h of Eq. 5, in spacings.
#define REACH 2.625

// φ half a spacing above a level lattice, averaged over places: what the iso-value must be.
static double iso_value(void) {
  float *lattice = test_lattice(9, 5, 9, 1, 0, 1);
  double sum = 0;
  for (int a = 0; a < 16; a++)
    for (int b = 0; b < 16; b++)
      sum += reference_potential(lattice, 405, (double[3]){4 + (a + 0.5) / 16, 5, 4 + (b + 0.5) / 16}, REACH) / 256;
  free(lattice);
  return sum;
}

static void heights_match_the_formula(void **state) {
  (void)state;
  float *pool = test_lattice(16, 6, 12, 0.1, 0.25, 3);
  int count = 16 * 6 * 12;
  for (int i = 0; i < count; i++) // a step, and a hill on top
    if (pool[3 * i] > 0.8f) pool[3 * i + 1] += 0.1f * sinf(3 * pool[3 * i + 2]) + 0.25f;
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  const SimFrame *frame = frame_of(pool, count, buffer);
  const SimHeightField *field = &frame->height_field;
  double iso = iso_value();
  int wet = 0;
  for (int k = 0; k < field->size[1]; k++)
    for (int i = 0; i < field->size[0]; i++) {
      double x = (double)field->origin[0] + i * (double)field->spacing;
      double z = (double)field->origin[1] + k * (double)field->spacing;
      double height = (double)field->height[k * field->size[0] + i];
      if (height <= (double)frame->bounds_min[1]) continue;
      wet++;
      // It is the iso-value there, and above it nothing reaches the iso-value (samples as fine as the search's).
      assert_true(fabs(reference_potential(pool, count, (double[3]){x, height, z}, REACH * 0.1) - iso) < 0.05);
      for (double y = height + 0.025; y < 1.5; y += 0.025)
        if (reference_potential(pool, count, (double[3]){x, y, z}, REACH * 0.1) > iso + 0.25)
          fail_msg("node (%d, %d): water above its height %g at %g", i, k, height, y);
    }
  assert_true(wet > 16 * 12 * 3 / 4); // the field is larger than the water by h
  sim_frame_buffer_destroy(buffer);
  free(pool);
}

// A level pool: its height is the lattice's upper end and the normals are upright.
static void a_level_pool_is_level(void **state) {
  (void)state;
  SimBlockDef block;
  SimWorldDef def = test_def((const float[3]){1, 1, 0.8f}, &block, (const float[3]){1, 0.5f, 0.8f});
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  const SimHeightField *field = &test_frame(world, SIM_NEED_HEIGHT_FIELD, buffer)->height_field;
  assert_int_equal(field->size[0], 21);
  assert_int_equal(field->size[1], 17);
  assert_true(field->origin[0] == 0 && fabsf(field->spacing - 0.05f) < 1e-6f);
  for (int node = 0; node < field->size[0] * field->size[1]; node++) { // up to the walls
    assert_true(fabsf(field->height[node] - 0.5f) < 0.002f);
    assert_true(field->normal[3 * node + 1] > 0.999f);
  }
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

// Water of 45° slope: the normal leans against the slope.
static void normals_follow_the_slope(void **state) {
  (void)state;
  enum { N = 20 };
  float *all = test_lattice(N, N, N, 0.1, 0, 1);
  int count = 0;
  for (int i = 0; i < N * N * N; i++) {
    if (all[3 * i + 1] > all[3 * i]) continue;
    memmove(all + 3 * count, all + 3 * i, 3 * sizeof(float));
    count++;
  }
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  const SimHeightField *field = &frame_of(all, count, buffer)->height_field;
  double mean[3] = {0, 0, 0};
  int nodes = 0;
  for (int k = 7; k < field->size[1] - 7; k++) // the field is larger than the water by h
    for (int i = 8; i < field->size[0] - 8; i++, nodes++)
      for (int a = 0; a < 3; a++) mean[a] += (double)field->normal[3 * (k * field->size[0] + i) + a];
  for (int a = 0; a < 3; a++) mean[a] /= nodes;
  assert_true(fabs(mean[0] + 0.7071) < 0.05 && fabs(mean[1] - 0.7071) < 0.05 && fabs(mean[2]) < 0.01);
  sim_frame_buffer_destroy(buffer);
  free(all);
}

// Two thousand particles in one place on a pool, more than a column holds side by side: a hill of radius h.
static void a_heap_is_a_hill(void **state) {
  (void)state;
  enum { POOL = 12 * 4 * 12, HEAP = 2000 };
  float *pool = test_lattice(12, 4, 12, 0.1, 0, 1), *all = malloc(sizeof(float) * 3 * (POOL + HEAP));
  memcpy(all, pool, sizeof(float) * 3 * POOL);
  for (int i = 0; i < 3 * HEAP; i++) all[3 * POOL + i] = i % 3 == 1 ? 0.45f : 0.65f;
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  const SimFrame *frame = frame_of(all, POOL + HEAP, buffer);
  const SimHeightField *field = &frame->height_field;
  int hill = 0;
  for (int node = 0; node < field->size[0] * field->size[1]; node++) {
    double x = (double)field->origin[0] + node % field->size[0] * (double)field->spacing - 0.65;
    double z = (double)field->origin[1] + node / field->size[0] * (double)field->spacing - 0.65;
    double left = 0.01 * REACH * REACH - x * x - z * z;
    if (left < 0.001) continue;
    hill++;
    if (fabs((double)field->height[node] - 0.45 - sqrt(left)) > 0.025)
      fail_msg("height %g over (%g, %g) from the heap", (double)field->height[node], x, z);
  }
  assert_true(hill > 6);
  sim_frame_buffer_destroy(buffer);
  free(all);
  free(pool);
}

// ---- Containers, by the volume under the surface and by its level ----------------------------------------------------------

// m, the height at a place, between nodes; `floor` where one of them is dry.
static double height_at(const SimHeightField *f, double x, double z, double floor) {
  double u = (x - (double)f->origin[0]) / (double)f->spacing, v = (z - (double)f->origin[1]) / (double)f->spacing,
         sum = 0;
  int i = (int)fmin(fmax(u, 0), f->size[0] - 2), k = (int)fmin(fmax(v, 0), f->size[1] - 2);
  for (int n = 0; n < 4; n++) {
    double height = (double)f->height[(k + n / 2) * f->size[0] + i + n % 2];
    if (height <= floor) return floor;
    sum += height * (n % 2 ? u - i : 1 - u + i) * (n / 2 ? v - k : 1 - v + k);
  }
  return sum;
}

typedef struct Figures {
  double lowest, highest; ///< spacings, over the level, of what is asked about
  double volume;          ///< m³, under the surface
} Figures;

// Of the surface over x in [0, x_end], z in [0, z_end], and of the volume over the whole container.
static Figures figures_of(const SimFrame *frame, double level, double x_end, double z_end) {
  const SimContainer *c = &frame->container;
  const double spacing = 2 * (double)frame->particle_radius, step = spacing / 4;
  double floor = (double)c->min[1], radius = (double)(c->max[0] - c->min[0]) / 2;
  Figures figures = {INFINITY, -INFINITY, 0};
  for (double z = (double)c->min[2] + step / 2; z < (double)c->max[2]; z += step)
    for (double x = (double)c->min[0] + step / 2; x < (double)c->max[0]; x += step) {
      if (c->shape == SIM_CONTAINER_GLASS && hypot(x - radius, z - radius) > radius) continue;
      double height = height_at(&frame->height_field, x, z, floor), over = (height - level) / spacing;
      figures.volume += (height - floor) * step * step;
      if (x > x_end || z > z_end) continue;
      figures.lowest = fmin(figures.lowest, over);
      figures.highest = fmax(figures.highest, over);
    }
  return figures;
}

// The lattice of the Def as it starts, or what has become of it after some frames.
static Figures figures_after(const SimWorldDef *def, int frames, double level, double x_end, double z_end) {
  SimWorld *world = test_create(def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  test_advance(world, frames);
  Figures figures = figures_of(test_frame(world, SIM_NEED_HEIGHT_FIELD, buffer), level, x_end, z_end);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
  return figures;
}

static void check_figures(const char *name, Figures f, double volume) {
  print_message("%s: from %+.3f to %+.3f spacings over the level, volume %+.2f %%\n", name, f.lowest, f.highest,
                100 * (f.volume / volume - 1));
  if (f.lowest < -0.1 || f.highest > 0.1) fail_msg("%s: not level", name);
  if (fabs(f.volume / volume - 1) > 0.03) fail_msg("%s: volume %g of %g", name, f.volume, volume);
}

static void lattice_blocks_are_level_and_whole(void **state) {
  (void)state;
  SimBlockDef block;
  SimWorldDef def = test_def((const float[3]){1, 1, 0.8f}, &block, (const float[3]){1, 0.5f, 0.8f});
  check_figures("a block over the whole floor", figures_after(&def, 0, 0.5, 1, 0.8), 0.4);
  block.max[1] = 0.1f;
  check_figures("two layers", figures_after(&def, 0, 0.1, 1, 0.8), 0.08);
  block.max[1] = 0.05f;
  check_figures("one layer", figures_after(&def, 0, 0.05, 1, 0.8),
                0.04 * (1 - 0.039)); // h sees three layers of a deep one
  // Nothing divides this one: the lattice is stretched, and no node but the first ones stands where it did.
  def = test_def((const float[3]){1.03f, 1, 0.77f}, &block, (const float[3]){1.03f, 0.5f, 0.77f});
  check_figures("a stretched block", figures_after(&def, 0, 0.5, 1.03, 0.77), 1.03 * 0.77 * 0.5);
  def = test_def((const float[3]){2, 1, 2}, &block, (const float[3]){1.5f, 0.5f, 1.6f});
  check_figures("a block in a corner", figures_after(&def, 0, 0.5, 1.4, 1.5), 1.5 * 1.6 * 0.5); // edges are round
  def = test_def((const float[3]){1, 1, 1}, &block, (const float[3]){1, 0.5f, 1});
  def.container.shape = SIM_CONTAINER_GLASS;
  check_figures("a glass", figures_after(&def, 0, 0.5, 1, 1), 3.14159265 * 0.125);
}

// Cutting a lattice round leaves less water than the level promises, until it has come to rest.
static void a_glass_at_rest_is_level_and_whole(void **state) {
  (void)state;
  SimBlockDef block;
  SimWorldDef def = test_def((const float[3]){1, 1, 1}, &block, (const float[3]){1, 0.5f, 1});
  def.container.shape = SIM_CONTAINER_GLASS;
  SimWorld *world = test_create(&def);
  double volume = sim_world_counts(world).particles * 0.05 * 0.05 * 0.05, level = volume / (3.14159265 * 0.25);
  sim_world_destroy(world);
  Figures f = figures_after(&def, 90, level, 1, 1);
  print_message("a glass at rest: from %+.3f to %+.3f spacings over the level, volume %+.2f %%\n", f.lowest, f.highest,
                100 * (f.volume / volume - 1));
  assert_true(f.lowest > -0.25 && f.highest < 0.25 && fabs(f.volume / volume - 1) < 0.03);
}

// Nodes stand on the walls, all around; a glass has its square, wherever it stands.
static void the_field_spans_the_container(void **state) {
  (void)state;
  SimBlockDef block;
  SimWorldDef def = test_def((const float[3]){1.2f, 1, 0.7f}, &block, (const float[3]){0.3f, 0.5f, 0.2f});
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  for (int glass = 0; glass < 2; glass++) {
    def.container.shape = glass ? SIM_CONTAINER_GLASS : SIM_CONTAINER_BOX;
    SimWorld *world = test_create(&def);
    const SimHeightField *f = &test_frame(world, SIM_NEED_HEIGHT_FIELD, buffer)->height_field;
    float low = glass ? 0.25f : 0, high = glass ? 0.95f : 1.2f;
    assert_true(fabsf(f->origin[0] - low) < 1e-5f && f->origin[1] == 0);
    assert_true(fabsf(f->origin[0] + f->spacing * (float)(f->size[0] - 1) - high) < 1e-5f);
    assert_true(fabsf(f->spacing * (float)(f->size[1] - 1) - 0.7f) < 1e-5f);
    assert_true(f->spacing <= 0.0501f && f->spacing >= 0.0374f);
    if (glass) assert_true(f->height[0] == 0); // a corner
    sim_world_destroy(world);
  }
  sim_frame_buffer_destroy(buffer);
}

// ---- Obstacles ---------------------------------------------------------------------------------------------------------------

// Whatever stands in level water, and wherever: neither hole nor dip, inside it neither.
static void water_is_level_around_obstacles(void **state) {
  (void)state;
  static const struct {
    const char *name;
    SimObstacle body;
  } cases[] = {
      {"a pillar on the lattice", {SIM_BOX, {0.4f, 1, 0.4f}, {1, 0.5f, 0.8f}, {0, 0, 0, 1}}},
      {"a pillar off it", {SIM_BOX, {0.43f, 1, 0.37f}, {1.017f, 0.5f, 0.81f}, {0, 0, 0, 1}}},
      {"a tilted box, its roof awash",
       {SIM_BOX, {0.43f, 0.8f, 0.37f}, {1.017f, 0.45f, 0.81f}, {0.1f, 0.2f, 0.1f, 0.9f}}},
      {"a box with water below", {SIM_BOX, {0.4f, 0.4f, 0.4f}, {1, 0.5f, 0.8f}, {0, 0, 0, 1}}},
      {"a box two spacings under", {SIM_BOX, {0.6f, 0.4f, 0.6f}, {1, 0.2f, 0.8f}, {0, 0, 0, 1}}},
      {"a table leg", {SIM_BOX, {0.06f, 1, 0.06f}, {1, 0.5f, 0.8f}, {0, 0, 0, 1}}},
      {"a table top just above", {SIM_BOX, {0.6f, 0.1f, 0.6f}, {1, 0.58f, 0.8f}, {0, 0, 0, 1}}},
      {"a cylinder", {SIM_CYLINDER, {0.3f, 1, 0}, {0.93f, 0.5f, 0.8f}, {0, 0, 0, 1}}},
      {"a cylinder half in the wall", {SIM_CYLINDER, {0.3f, 1, 0}, {0.1f, 0.5f, 0.8f}, {0, 0, 0, 1}}},
      {"a box in the corner", {SIM_BOX, {0.4f, 1, 0.4f}, {0.2f, 0.5f, 0.2f}, {0, 0, 0, 1}}},
      {"a ball, half under", {SIM_SPHERE, {0.5f, 0, 0}, {1, 0.5f, 0.8f}, {0, 0, 0, 1}}},
      {"a wall through the pool", {SIM_BOX, {0.06f, 1, 1.6f}, {1, 0.5f, 0.8f}, {0, 0, 0, 1}}},
  };
  SimBlockDef block;
  SimObstacleDef obstacle = sim_default_obstacle_def();
  SimWorldDef def = test_def((const float[3]){2, 1, 1.6f}, &block, (const float[3]){2, 0.5f, 1.6f});
  def.obstacle_count = 1;
  def.obstacles = &obstacle;
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    obstacle.body = cases[k].body;
    check_figures(cases[k].name, figures_after(&def, 0, 0.5, 2, 1.6), 1.6);
  }
}

// Water on both sides of a wall, at different levels: each keeps its own up to it. A dry pillar stays dry.
static void sides_of_a_wall_are_apart(void **state) {
  (void)state;
  SimBlockDef blocks[2] = {{{0, 0, 0}, {0.95f, 0.5f, 0.8f}}, {{1.05f, 0, 0}, {2, 0.2f, 0.8f}}}, unused;
  SimObstacleDef obstacle = sim_default_obstacle_def();
  SimWorldDef def = test_def((const float[3]){2, 1, 0.8f}, &unused, (const float[3]){1, 1, 1});
  obstacle.body = (SimObstacle){SIM_BOX, {0.1f, 1, 0.8f}, {1, 0.5f, 0.4f}, {0, 0, 0, 1}};
  def.obstacle_count = 1, def.obstacles = &obstacle;
  def.block_count = 2, def.blocks = blocks;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  const SimHeightField *f = &test_frame(world, SIM_NEED_HEIGHT_FIELD, buffer)->height_field;
  for (int k = 0; k < f->size[1]; k++)
    for (int i = 0; i < f->size[0]; i++) {
      float x = f->origin[0] + f->spacing * (float)i, height = f->height[k * f->size[0] + i];
      if (x < 0.94f && fabsf(height - 0.5f) > 0.005f) fail_msg("%g at x = %g", (double)height, (double)x);
      if (x > 1.06f && fabsf(height - 0.2f) > 0.005f) fail_msg("%g at x = %g", (double)height, (double)x);
    }
  sim_world_destroy(world);
  def.block_count = 0;
  world = test_create(&def);
  f = &test_frame(world, SIM_NEED_HEIGHT_FIELD, buffer)->height_field;
  for (int node = 0; node < f->size[0] * f->size[1]; node++) assert_true(f->height[node] == 0);
  sim_world_destroy(world);
  sim_frame_buffer_destroy(buffer);
}

static void dry_places(void **state) {
  (void)state;
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  const float two[6] = {0, 0, 0, 1, 0.5f, 1}; // drops are not part of the height field
  const SimFrame *frame = frame_of(two, 2, buffer);
  const SimHeightField *field = &frame->height_field;
  assert_int_equal(field->size[0], 17); // 1 m and h on both sides
  for (int k = 0; k < field->size[0] * field->size[1]; k++) {
    assert_true(field->height[k] == frame->bounds_min[1]);
    assert_true(field->normal[3 * k] == 0 && field->normal[3 * k + 1] == 1 && field->normal[3 * k + 2] == 0);
  }
  frame = frame_of(two, 0, buffer);
  assert_true(frame->height_field.size[0] >= 1 && isfinite(frame->height_field.height[0]));
  const float far[6] = {0, 0, 0, 1e9f, 1e9f, 1e9f}; // must neither take for ever nor fill the memory
  frame = frame_of(far, 2, buffer);
  assert_true((int64_t)frame->height_field.size[0] * frame->height_field.size[1] <= 1 << 20);
  sim_frame_buffer_destroy(buffer);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(heights_match_the_formula),          cmocka_unit_test(a_level_pool_is_level),
      cmocka_unit_test(normals_follow_the_slope),           cmocka_unit_test(a_heap_is_a_hill),
      cmocka_unit_test(lattice_blocks_are_level_and_whole), cmocka_unit_test(a_glass_at_rest_is_level_and_whole),
      cmocka_unit_test(the_field_spans_the_container),      cmocka_unit_test(water_is_level_around_obstacles),
      cmocka_unit_test(sides_of_a_wall_are_apart),          cmocka_unit_test(dry_places),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
