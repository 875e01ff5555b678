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

// φ half a spacing above a level lattice, averaged over places: what the iso-value must be.
static double iso_value(void) {
  float *lattice = test_lattice(9, 4, 9, 1, 0, 1);
  double sum = 0;
  for (int a = 0; a < 16; a++)
    for (int b = 0; b < 16; b++)
      sum += reference_potential(lattice, 324, (double[3]){4 + (a + 0.5) / 16, 4, 4 + (b + 0.5) / 16}, 2) / 256;
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
      assert_true(fabs(reference_potential(pool, count, (double[3]){x, height, z}, 0.2) - iso) < 0.05);
      for (double y = height + 0.025; y < 1.5; y += 0.025)
        if (reference_potential(pool, count, (double[3]){x, y, z}, 0.2) > iso + 0.25)
          fail_msg("node (%d, %d): water above its height %g at %g", i, k, height, y);
    }
  assert_true(wet > field->size[0] * field->size[1] * 3 / 4);
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
  for (int k = 3; k < field->size[1] - 3; k++)
    for (int i = 3; i < field->size[0] - 3; i++) {
      int node = k * field->size[0] + i;
      assert_true(fabsf(field->height[node] - 0.5f) < 0.012f);
      assert_true(field->normal[3 * node + 1] > 0.98f);
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
  for (int k = 4; k < field->size[1] - 4; k++)
    for (int i = 5; i < field->size[0] - 5; i++, nodes++)
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
    double left = 0.04 - x * x - z * z;
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

static void dry_places(void **state) {
  (void)state;
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  const float two[6] = {0, 0, 0, 1, 0.5f, 1}; // drops are not part of the height field
  const SimFrame *frame = frame_of(two, 2, buffer);
  const SimHeightField *field = &frame->height_field;
  assert_int_equal(field->size[0], 11);
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
      cmocka_unit_test(heights_match_the_formula),
      cmocka_unit_test(a_level_pool_is_level),
      cmocka_unit_test(normals_follow_the_slope),
      cmocka_unit_test(a_heap_is_a_hill),
      cmocka_unit_test(dry_places),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
