// Eigensolver, classification and anisotropy against their slow twins and on shapes whose answer is known.
#include "sim_test.h"

#include "reference/reference.h"
#include "sim/surface.h"

static void check_eigen(const float m[6]) {
  float value[3], v[3][3];
  double expected[3], ignored[3][3], scale = 1e-30;
  sim_eigen_symmetric(m, value, v);
  reference_eigen(m, expected, ignored);
  for (int k = 0; k < 6; k++) scale = fmax(scale, fabs((double)m[k]));
  const float a[3][3] = {{m[0], m[3], m[4]}, {m[3], m[1], m[5]}, {m[4], m[5], m[2]}};
  for (int k = 0; k < 3; k++) {
    if (fabs((double)value[k] - expected[k]) > 2e-6 * scale)
      fail_msg("eigenvalue %d of (%g %g %g %g %g %g): %g, twin %g", k, (double)m[0], (double)m[1], (double)m[2],
               (double)m[3], (double)m[4], (double)m[5], (double)value[k], expected[k]);
    double length = 0, along = 0;
    for (int i = 0; i < 3; i++) {
      double residual = -(double)value[k] * (double)v[k][i];
      for (int j = 0; j < 3; j++) residual += (double)a[i][j] * (double)v[k][j];
      assert_true(fabs(residual) < 1e-5 * scale);
      length += (double)v[k][i] * (double)v[k][i];
      along += (double)v[k][i] * (double)v[(k + 1) % 3][i];
    }
    assert_true(fabs(length - 1) < 1e-5 && fabs(along) < 1e-5);
  }
}

static void eigensolver_matches_jacobi(void **state) {
  (void)state;
  uint64_t seed = 1;
  for (int n = 0; n < 20000; n++) {
    float m[6];
    double size = pow(10, 12 * test_random(&seed) - 8);
    for (int k = 0; k < 6; k++) m[k] = (float)(size * (2 * test_random(&seed) - 1));
    if (n % 4 == 1) m[3] = m[4] = m[5] = 0;                 // diagonal
    if (n % 4 == 2) m[1] = m[0], m[3] = 0, m[4] = m[5] = 0; // two equal
    if (n % 4 == 3)                                         // rank one: two zero
      m[3] = m[0] * m[1] / (float)size, m[4] = m[0] * m[2] / (float)size, m[5] = m[1] * m[2] / (float)size,
      m[0] *= m[0] / (float)size, m[1] *= m[1] / (float)size, m[2] *= m[2] / (float)size;
    check_eigen(m);
  }
}

static void eigensolver_on_degenerate_matrices(void **state) {
  (void)state;
  const float cases[8][6] = {
      {0, 0, 0, 0, 0, 0}, {1, 1, 1, 0, 0, 0},      {1, 1, 1, 1e-7f, 0, 0},         {1, 2, 2, 0, 0, 0},
      {2, 2, 1, 0, 0, 0}, {1e-20f, 0, 0, 0, 0, 0}, {1e20f, 1e20f, 1, 0, 0, 1e19f}, {1, 1, 1, 1, 1, 1}};
  for (int c = 0; c < 8; c++) check_eigen(cases[c]);
  float value[3], v[3][3];
  sim_eigen_symmetric((const float[6]){NAN, 1, 1, 0, 0, 0}, value, v);
  for (int k = 0; k < 3; k++) assert_true(isfinite(value[k]) && isfinite(v[k][0]));
}

static const SimFrame *frame_of(const float *position, int32_t count, float radius, SimFrameBuffer *buffer) {
  SimError error = {""};
  SimParticleSet set = {.count = count, .position = position, .particle_radius = radius};
  const SimFrame *frame = sim_frame_from_particles(&set, SIM_NEED_ALL, 2, buffer, &error);
  if (!frame) fail_msg("%s", error.message);
  return frame;
}

// A jittered blob, a sheet, a few drops: every particle against the twin.
static void anisotropy_and_density_match_the_twins(void **state) {
  (void)state;
  enum { BLOB = 10 * 8 * 9, SHEET = 15 * 1 * 15, COUNT = BLOB + SHEET + 3 };
  float *blob = test_lattice(10, 8, 9, 0.1, 0.3, 5), *sheet = test_lattice(15, 1, 15, 0.1, 0.1, 6);
  float *all = malloc(sizeof(float) * 3 * COUNT);
  memcpy(all, blob, sizeof(float) * 3 * BLOB);
  memcpy(all + 3 * BLOB, sheet, sizeof(float) * 3 * SHEET);
  for (int i = BLOB; i < BLOB + SHEET; i++) all[3 * i + 1] += 2;
  for (int i = 0; i < 9; i++) all[3 * (BLOB + SHEET) + i] = 3 + 0.9f * (float)i;
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  const SimFrame *frame = frame_of(all, COUNT, 0.05f, buffer);
  int ellipsoids = 0;
  for (int32_t i = 0; i < COUNT; i++) {
    int32_t id = (int32_t)frame->id[i];
    double density = 1000 * reference_density(all, COUNT, id, 0.1), centre[3], expected[6];
    assert_true(fabs((double)frame->density[i] - density) < 0.01);
    if (fabs(density - 550) > 0.1)
      assert_int_equal(frame->particle_class[i], density < 550 ? SIM_SPLASH : SIM_AGGREGATED);
    int neighbours = reference_anisotropy(all, COUNT, id, 0.1, centre, expected);
    bool sphere = frame->particle_class[i] == SIM_SPLASH || neighbours < 25;
    ellipsoids += !sphere;
    for (int k = 0; k < 3; k++) {
      double wanted = sphere ? (double)all[3 * id + k] : centre[k];
      assert_true(fabs((double)frame->smoothed[3 * i + k] - wanted) < 2e-6);
    }
    for (int k = 0; k < 6; k++) {
      double wanted = sphere ? (k < 3 ? 0.05 : 0) : expected[k];
      if (fabs((double)frame->ellipsoid[6 * i + k] - wanted) > 2e-5)
        fail_msg("particle %d, element %d: %g, twin %g", id, k, (double)frame->ellipsoid[6 * i + k], wanted);
    }
  }
  assert_true(ellipsoids > BLOB / 2 && ellipsoids < COUNT);
  sim_frame_buffer_destroy(buffer);
  free(all);
  free(blob);
  free(sheet);
}

// A drop alone, a pair: splashes, spheres of radius r in place. The inside of a pool: aggregated, spheres. Its surface:
// aggregated, flat: the short axis is upright. No axis is longer than 1.2 r.
static void known_shapes(void **state) {
  (void)state;
  enum { POOL = 12 * 6 * 12, COUNT = POOL + 3 };
  float *pool = test_lattice(12, 6, 12, 0.1, 0, 1);
  float *all = malloc(sizeof(float) * 3 * COUNT);
  memcpy(all, pool, sizeof(float) * 3 * POOL);
  const float drops[9] = {0.5f, 1.5f, 0.5f, 0.1f, 1.4f, 0.2f, 0.15f, 1.45f, 0.2f};
  memcpy(all + 3 * POOL, drops, sizeof drops);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  const SimFrame *frame = frame_of(all, COUNT, 0.05f, buffer);
  int inside = 0, surface = 0;
  for (int32_t i = 0; i < COUNT; i++) {
    const float *x = frame->position + 3 * i, *t = frame->ellipsoid + 6 * i;
    float value[3], v[3][3];
    sim_eigen_symmetric(t, value, v);
    assert_true(value[0] <= 1.2f * 0.05f * 1.0001f && value[2] > 0);
    if (frame->id[i] >= POOL) {
      assert_int_equal(frame->particle_class[i], SIM_SPLASH);
      assert_true(value[0] == 0.05f && value[2] == 0.05f && frame->smoothed[3 * i + 1] == x[1]);
      continue;
    }
    assert_int_equal(frame->particle_class[i], SIM_AGGREGATED);
    if (x[0] < 0.3f || x[0] > 0.9f || x[2] < 0.3f || x[2] > 0.9f) continue;
    if (x[1] > 0.2f && x[1] < 0.3f) {
      inside++;
      assert_true(value[0] / value[2] < 1.05f && fabsf(frame->smoothed[3 * i + 1] - x[1]) < 1e-5f);
    }
    if (x[1] > 0.5f) {
      surface++;
      assert_true(value[0] / value[2] > 1.5f && fabsf(v[2][1]) > 0.999f);
      assert_true(frame->smoothed[3 * i + 1] < x[1]);
    }
  }
  assert_true(inside == 36 && surface == 36);
  sim_frame_buffer_destroy(buffer);
  free(all);
  free(pool);
}

static void all_in_one_place_is_finite(void **state) {
  (void)state;
  float position[300];
  for (int k = 0; k < 300; k++) position[k] = 0.3f;
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  const SimFrame *frame = frame_of(position, 100, 0.05f, buffer);
  for (int k = 0; k < 600; k++) assert_true(isfinite(frame->ellipsoid[k]));
  for (int k = 0; k < 300; k++) assert_true(fabsf(frame->smoothed[k] - 0.3f) < 1e-6f);
  assert_true(frame->ellipsoid[0] == 0.05f);
  sim_frame_buffer_destroy(buffer);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(eigensolver_matches_jacobi),
      cmocka_unit_test(eigensolver_on_degenerate_matrices),
      cmocka_unit_test(anisotropy_and_density_match_the_twins),
      cmocka_unit_test(known_shapes),
      cmocka_unit_test(all_in_one_place_is_finite),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
