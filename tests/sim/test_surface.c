// Classification and anisotropy against their slow twins and on shapes whose answer is known.
#include "sim_test.h"

#include "reference/reference.h"
#include "sim/surface.h"

static const char *const names[4] = {"avx512", "avx2", "sse2", "scalar"};

// The ellipsoid of a covariance for a particle of radius 1 from eigenvalues and eigenvectors in double precision.
static void expected_ellipsoid(const float covariance[6], double ellipsoid[6]) {
  double value[3], v[3][3], volume = 1, largest;
  reference_eigen(covariance, value, v);
  largest = value[0];
  for (int k = 0; k < 3; k++) volume *= value[k] = largest > 0 ? fmax(value[k] / largest, 0.25) : 1;
  for (int k = 0; k < 3; k++) value[k] = fmin(value[k] / cbrt(volume), 1.2);
  const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
  for (int e = 0; e < 6; e++) {
    ellipsoid[e] = 0;
    for (int k = 0; k < 3; k++) ellipsoid[e] += value[k] * v[k][row[e]] * v[k][column[e]];
  }
}

// All of them at once, by every instruction set; the largest error of an element, the radius being 1.
static double check_ellipsoids(const float (*covariance)[6], int count) {
  size_t room = ((size_t)count + 2 * SIM_CHUNK) * 6;
  float *first = NULL;
  double worst = 0;
  for (int n = 0; n < 4; n++) {
    if (!sim_wide_named(names[n])) continue;
    float *all = calloc(room, sizeof *all);
    for (int i = 0; i < count; i++)
      for (int e = 0; e < 6; e++) all[(i / SIM_CHUNK * 6 + e) * SIM_CHUNK + i % SIM_CHUNK] = covariance[i][e];
    sim_surface_ellipsoids(sim_wide_named(names[n]), count, 1, all, 1);
    if (first && memcmp(first, all, sizeof(float) * 6 * (size_t)count)) fail_msg("%s differs", names[n]);
    for (int i = 0; i < count && !first; i++) {
      double expected[6];
      expected_ellipsoid(covariance[i], expected);
      for (int e = 0; e < 6; e++) {
        double error = fabs((double)all[6 * i + e] - expected[e]);
        worst = error > worst ? error : worst;
        if (!(error < 4e-6))
          fail_msg("covariance (%g %g %g %g %g %g), element %d: %.8f, twin %.8f", (double)covariance[i][0],
                   (double)covariance[i][1], (double)covariance[i][2], (double)covariance[i][3],
                   (double)covariance[i][4], (double)covariance[i][5], e, (double)all[6 * i + e], expected[e]);
      }
    }
    if (first)
      free(all);
    else
      first = all;
  }
  free(first);
  return worst;
}

static void ellipsoids_match_their_twins(void **state) {
  (void)state;
  enum { COUNT = 20005 };
  float(*covariance)[6] = malloc(sizeof *covariance * COUNT);
  uint64_t seed = 1;
  for (int n = 0; n < COUNT; n++) {
    double size = pow(10, 20 * test_random(&seed) - 12), r[3][3];
    for (int i = 0; i < 3; i++)
      for (int k = 0; k < 3; k++) r[i][k] = 2 * test_random(&seed) - 1;
    if (n % 5 == 1) r[0][1] = r[0][2] = r[1][0] = r[1][2] = r[2][0] = r[2][1] = 0;                    // diagonal
    if (n % 5 == 2) r[0][0] = r[1][1], r[0][1] = r[1][0] = r[0][2] = r[1][2] = r[2][0] = r[2][1] = 0; // two equal
    if (n % 5 == 3) r[0][1] = r[1][1] = r[2][1] = r[0][2] = r[1][2] = r[2][2] = 0; // rank one: two are zero
    if (n % 5 == 4)                                                                // almost a sphere
      for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) r[i][k] = (i == k) + r[i][k] * pow(10, -n % 9);
    const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
    for (int e = 0; e < 6; e++) {
      double sum = 0;
      for (int k = 0; k < 3; k++) sum += r[row[e]][k] * r[column[e]][k];
      covariance[n][e] = (float)(size * sum);
    }
  }
  double worst = check_ellipsoids((const float(*)[6])covariance, COUNT);
  print_message("largest error of an ellipsoid: %.2g radii\n", worst);
  free(covariance);
}

static void ellipsoids_of_degenerate_covariances(void **state) {
  (void)state;
  const float cases[8][6] = {
      {0, 0, 0, 0, 0, 0}, {1, 1, 1, 0, 0, 0},      {1, 1, 1, 1e-7f, 0, 0},        {1, 2, 2, 0, 0, 0},
      {2, 2, 1, 0, 0, 0}, {1e-30f, 0, 0, 0, 0, 0}, {1e20f, 1e20f, 1, 0, 0, 1e9f}, {1, 1, 1, 1, 1, 1}};
  for (int count = 0; count <= 8; count++) check_ellipsoids(cases, count);
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
    bool sphere = frame->particle_class[i] == SIM_SPLASH || neighbours < 13;
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
    double value[3], v[3][3];
    reference_eigen(t, value, v);
    assert_true(value[0] <= 1.2 * 0.05 * 1.0001 && value[2] > 0);
    if (frame->id[i] >= POOL) {
      assert_int_equal(frame->particle_class[i], SIM_SPLASH);
      assert_true(t[0] == 0.05f && t[1] == 0.05f && t[2] == 0.05f && t[3] == 0 && frame->smoothed[3 * i + 1] == x[1]);
      continue;
    }
    assert_int_equal(frame->particle_class[i], SIM_AGGREGATED);
    if (x[0] < 0.3f || x[0] > 0.9f || x[2] < 0.3f || x[2] > 0.9f) continue;
    if (x[1] > 0.2f && x[1] < 0.3f) {
      inside++;
      assert_true(value[0] / value[2] < 1.05 && fabsf(frame->smoothed[3 * i + 1] - x[1]) < 1e-5f);
    }
    if (x[1] > 0.5f) {
      surface++;
      assert_true(value[0] / value[2] > 1.5 && fabs(v[2][1]) > 0.999);
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
      cmocka_unit_test(ellipsoids_match_their_twins),
      cmocka_unit_test(ellipsoids_of_degenerate_covariances),
      cmocka_unit_test(anisotropy_and_density_match_the_twins),
      cmocka_unit_test(known_shapes),
      cmocka_unit_test(all_in_one_place_is_finite),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
