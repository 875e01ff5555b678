// Near-surface flags: nothing that can be seen is hidden, and what is deep inside is not drawn.
//
// The twin of the flags shoots rays from outside at spheres of the size in which particles are drawn (1.25 r): the
// sphere that is hit first must be flagged; in torn water one ray in a thousand may look down a crack.
#include "sim_test.h"

#include "reference/reference.h"

static void direction_of(uint64_t *seed, double direction[3]) {
  double length2;
  do {
    length2 = 0;
    for (int k = 0; k < 3; k++) {
      direction[k] = 2 * test_random(seed) - 1;
      length2 += direction[k] * direction[k];
    }
  } while (length2 > 1 || length2 < 1e-3);
  for (int k = 0; k < 3; k++) direction[k] /= sqrt(length2);
}

static void check_rays(const SimFrame *frame, int rays, uint64_t seed) {
  int seen = 0, missed = 0;
  for (int n = 0; n < rays; n++) {
    double target[3], direction[3], origin[3];
    direction_of(&seed, direction);
    for (int k = 0; k < 3; k++) {
      double low = (double)frame->bounds_min[k], high = (double)frame->bounds_max[k];
      target[k] = low + (high - low) * test_random(&seed);
      origin[k] = target[k] - 10 * direction[k];
    }
    int32_t hit =
        reference_first_hit(frame->position, frame->count, origin, direction, 1.25 * (double)frame->particle_radius);
    if (hit < 0) continue;
    seen++;
    missed += !frame->near_surface[hit];
  }
  assert_true(seen > rays / 4);
  if (missed > 0) fail_msg("%d of %d rays see a particle that is not flagged", missed, seen);
}

static int flagged(const SimFrame *frame) {
  int count = 0;
  for (int32_t i = 0; i < frame->count; i++) {
    assert_true(frame->near_surface[i] <= 1);
    count += frame->near_surface[i];
  }
  return count;
}

static const SimFrame *frame_of(const float *position, int32_t count, SimFrameBuffer *buffer) {
  SimError error = {""};
  SimParticleSet set = {.count = count, .position = position, .particle_radius = 0.025f};
  const SimFrame *frame = sim_frame_from_particles(&set, SIM_NEED_SURFACE, 2, buffer, &error);
  if (!frame) fail_msg("%s", error.message);
  return frame;
}

// A cube of 16³: two layers are flagged for certain, three at most.
static void a_lattice_shows_its_outer_layers(void **state) {
  (void)state;
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  float *cube = test_lattice(16, 16, 16, 0.05, 0, 1);
  const SimFrame *frame = frame_of(cube, 4096, buffer);
  int count = flagged(frame);
  if (count < 4096 - 14 * 14 * 14 || count > 4096 - 10 * 10 * 10) fail_msg("%d flagged", count);
  for (int32_t i = 0; i < frame->count; i++) {
    double edge = 1;
    for (int k = 0; k < 3; k++)
      edge = fmin(edge, fmin((double)frame->position[3 * i + k], 0.8 - (double)frame->position[3 * i + k]));
    if (edge < 0.1) assert_int_equal(frame->near_surface[i], 1);
    if (edge > 0.15) assert_int_equal(frame->near_surface[i], 0);
  }
  check_rays(frame, 4000, 3);
  sim_frame_buffer_destroy(buffer);
  free(cube);
}

static void a_disordered_block_hides_nothing(void **state) {
  (void)state;
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  for (uint64_t seed = 1; seed <= 3; seed++) {
    float *cube = test_lattice(14, 14, 14, 0.05, 0.15, seed);
    check_rays(frame_of(cube, 14 * 14 * 14, buffer), 4000, seed);
    free(cube);
  }
  sim_frame_buffer_destroy(buffer);
}

// Real water: a splashing dam break and a pool that has come to rest.
static void water_hides_nothing(void **state) {
  (void)state;
  SimBlockDef block;
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  SimWorldDef def = test_def((const float[3]){1.6f, 1, 0.5f}, &block, (const float[3]){0.6f, 0.7f, 0.5f});
  SimWorld *world = test_create(&def);
  for (int f = 0; f < 3; f++) {
    test_advance(world, 20);
    check_rays(test_frame(world, SIM_NEED_SURFACE, buffer), 20000, (uint64_t)f);
  }
  sim_world_destroy(world);
  def = test_def((const float[3]){1, 1, 0.8f}, &block, (const float[3]){1, 0.8f, 0.8f});
  def.jitter = 0.1f;
  world = test_create(&def);
  test_advance(world, 180);
  const SimFrame *frame = test_frame(world, SIM_NEED_SURFACE, buffer);
  check_rays(frame, 5000, 9);
  double share = (double)flagged(frame) / frame->count; // two layers of 20 × 16 × 16 are 49 %, three 66 %
  if (share > 0.66) fail_msg("%.0f %% flagged", 100 * share);
  sim_world_destroy(world);
  sim_frame_buffer_destroy(buffer);
}

static void sparse_particles_are_all_flagged(void **state) {
  (void)state;
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  float *sheet = test_lattice(20, 1, 20, 0.05, 0.1, 1), *line = test_lattice(50, 1, 1, 0.05, 0, 1);
  assert_int_equal(flagged(frame_of(sheet, 400, buffer)), 400);
  assert_int_equal(flagged(frame_of(line, 50, buffer)), 50);
  assert_int_equal(flagged(frame_of(line, 1, buffer)), 1);
  assert_int_equal(flagged(frame_of(line, 0, buffer)), 0);
  free(sheet);
  free(line);
  float one_place[60] = {0};
  assert_int_equal(flagged(frame_of(one_place, 20, buffer)), 20);
  sim_frame_buffer_destroy(buffer);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_lattice_shows_its_outer_layers),
      cmocka_unit_test(a_disordered_block_hides_nothing),
      cmocka_unit_test(water_hides_nothing),
      cmocka_unit_test(sparse_particles_are_all_flagged),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
