// The height field's map against its slow twin, and what must stay as it is: level and slanted water.
#include "tests/render/fields.h"

#include <math.h>
#include <stdlib.h>

#define SPACING 0.04f

// ---- The slow twin ---------------------------------------------------------------------------------------------------

static int mirrored(int i, int count) {
  const int period = count > 1 ? 2 * (count - 1) : 1;
  i = abs(i) % period;
  return (i < period - i ? i : period - i) % count;
}

static double node(const TestField *f, int i, int k) {
  return (double)f->heights[mirrored(k, f->field.size[1]) * f->field.size[0] + mirrored(i, f->field.size[0])];
}

static double weight(double x, double sigma) {
  const double wide = sigma + 0.5;
  return exp(-x * x / (2 * sigma * sigma)) + 1e-3 * exp(-x * x / (2 * wide * wide));
}

// The plane through the nodes around (x, z), in spacings, that fits best: its height there. *wet: there are any.
static double fitted(const TestField *f, double x, double z, double sigma, bool *wet) {
  const int reach = (int)ceil(3 * (sigma + 0.5));
  double a[3][4] = {{0}}, low = 1e30, high = -1e30;
  for (int k = (int)floor(z) - reach; k <= (int)floor(z) + reach + 1; ++k) {
    for (int i = (int)floor(x) - reach; i <= (int)floor(x) + reach + 1; ++i) {
      const double h = node(f, i, k), w = weight(i - x, sigma) * weight(k - z, sigma);
      const double row[4] = {1, i - x, k - z, h};
      if (isnan(h)) continue;
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) a[r][c] += w * row[r] * row[c];
      }
      low = fmin(low, h);
      high = fmax(high, h);
    }
  }
  *wet = a[0][0] > 0;
  if (!*wet) return 0;
  const double s = a[0][0], mx = a[0][1] / s, mz = a[0][2] / s;
  const double ridge = 1e-6 * (a[1][1] / s - mx * mx + a[2][2] / s - mz * mz) + 1e-7 * (mx * mx + mz * mz) + 1e-9;
  const double xx = a[1][1] / s - mx * mx + ridge, xz = a[1][2] / s - mx * mz, zz = a[2][2] / s - mz * mz + ridge;
  const double xh = (a[1][3] - a[0][3] * mx) / s, zh = (a[2][3] - a[0][3] * mz) / s, det = xx * zz - xz * xz;
  const double height = a[0][3] / s - (zz * xh - xz * zh) / det * mx - (xx * zh - xz * xh) / det * mz;
  return fmin(fmax(height, low - (high - low) / 2), high + (high - low) / 2);
}

static double share(const TestField *f, double x, double z) {
  const int i = (int)floor(x), k = (int)floor(z);
  const double fx = x - i, fz = z - k;
  double sum = 0;
  for (int c = 0; c < 4; ++c) {
    const double w = (c & 1 ? fx : 1 - fx) * (c & 2 ? fz : 1 - fz);
    sum += isnan(node(f, i + (c & 1), k + (c >> 1))) ? 0 : w;
  }
  return sum;
}

// Height and slopes where there is water; what the surface is taken for elsewhere is in reach of it.
static void expect_texel(const FieldBench *b, const float *got, double share_there, const double surface[3],
                         double worst[3]) {
  worst[1] = fmax(worst[1], fabs((double)got[1] - share_there));
  if (share_there > 0) {
    worst[0] = fmax(worst[0], fabs((double)got[0] - surface[0]));
    for (int c = 0; c < 2; ++c) worst[2] = fmax(worst[2], fabs((double)got[2 + c] - surface[1 + c]));
  }
  const float margin = 0.5f * (b->map.highest - b->map.lowest) + 1e-6f;
  assert_true(got[0] >= b->map.lowest - margin && got[0] <= b->map.highest + margin);
}

static double *twin_heights(const FieldBench *b, const TestField *f, int fineness, double sigma) {
  double *twin = malloc(sizeof *twin * (size_t)b->map.size[0] * (size_t)b->map.size[1]);
  for (int32_t k = 0; k < b->map.size[1]; ++k) {
    for (int32_t i = 0; i < b->map.size[0]; ++i) {
      bool wet;
      const double h = fitted(f, (double)i / fineness, (double)k / fineness, sigma, &wet);
      twin[k * b->map.size[0] + i] = wet ? h : 0.5 * ((double)b->map.lowest + (double)b->map.highest);
    }
  }
  return twin;
}

static void expect_twin(FieldBench *b, const TestField *f, float smoothing) {
  float *surface = field_bench_surface(b, f, smoothing);
  const int fineness = (int)lroundf(f->field.spacing / b->map.spacing);
  const int32_t width = b->map.size[0], height = b->map.size[1];
  double *twin = twin_heights(b, f, fineness, fmax((double)smoothing, 0.2)), worst[3] = {0};
  const double step = 2 * (double)b->map.spacing;
  for (int32_t k = 0; k < height; ++k) {
    const double *row = twin + k * width, *before = twin + mirrored(k - 1, height) * width;
    const double *after = twin + mirrored(k + 1, height) * width;
    for (int32_t i = 0; i < width; ++i) {
      const double want[3] = {row[i], (row[mirrored(i + 1, width)] - row[mirrored(i - 1, width)]) / step,
                              (after[i] - before[i]) / step};
      expect_texel(b, surface + 4 * (k * width + i), share(f, (double)i / fineness, (double)k / fineness), want, worst);
    }
  }
  print_message("%d x %d nodes, smoothing %.1f: height off by %.2g m, share %.2g, slope %.2g\n", f->field.size[0],
                f->field.size[1], (double)smoothing, worst[0], worst[1], worst[2]);
  assert_true(worst[0] < 2e-4 && worst[1] < 1e-6 && worst[2] < 1e-2);
  free(twin);
  free(surface);
}

static double waves(double x, double z, const void *context) {
  const double *dry = context;
  if (dry != NULL && hypot(x - dry[0], z - dry[1]) < dry[2]) return NAN;
  return 0.4 + 0.05 * sin(9 * x + 1) * cos(7 * z) + 0.1 * x;
}

static void test_twin(void **state) {
  const float smoothings[] = {0, 0.5f, 1, 3};
  const double dry[3] = {0.5, 0.3, 0.2};
  for (int i = 0; i < 4; ++i) {
    TestField f = test_field_create(31, 22, SPACING, -0.2f, 0.1f, waves, i % 2 == 1 ? dry : NULL);
    expect_twin(*state, &f, smoothings[i]);
    test_field_destroy(&f);
  }
}

// A node here and there has no water, and some stand alone.
static double holes(double x, double z, const void *context) {
  const int i = (int)lround(x / (double)SPACING), k = (int)lround(z / (double)SPACING);
  return (i * 7 + k * 13) % 5 < *(const int *)context ? NAN : waves(x, z, NULL);
}

static void test_holes(void **state) {
  for (int dry = 1; dry < 5; ++dry) {
    TestField f = test_field_create(20, 15, SPACING, 0, 0, holes, &dry);
    expect_twin(*state, &f, 1);
    test_field_destroy(&f);
  }
}

// ---- What stays as it is ---------------------------------------------------------------------------------------------

typedef struct Plane {
  double height, slope[2], dry_before; // dry_before: no water where x is less
} Plane;

static double plane_height(double x, double z, const void *context) {
  const Plane *p = context;
  return x < p->dry_before ? NAN : p->height + p->slope[0] * x + p->slope[1] * z;
}

// Worst differences from the plane of height and slopes, away from the outermost nodes by `margin` spacings, and where there
// is water.
static void expect_plane(FieldBench *b, Plane plane, float smoothing, int margin) {
  TestField f = test_field_create(40, 30, SPACING, 0, 0, plane_height, &plane);
  float *surface = field_bench_surface(b, &f, smoothing);
  double worst[2] = {0};
  for (int32_t k = 2 * margin; k < b->map.size[1] - 2 * margin; ++k) {
    for (int32_t i = 2 * margin; i < b->map.size[0] - 2 * margin; ++i) {
      const float *got = surface + 4 * (k * b->map.size[0] + i);
      const double x = i * (double)b->map.spacing, z = k * (double)b->map.spacing;
      if (got[1] == 0) continue;
      const double want = plane.height + plane.slope[0] * x + plane.slope[1] * z;
      worst[0] = fmax(worst[0], fabs((double)got[0] - want));
      worst[1] = fmax(worst[1], fmax(fabs((double)got[2] - plane.slope[0]), fabs((double)got[3] - plane.slope[1])));
    }
  }
  print_message("plane (%g, %g), dry before %g m, smoothing %.1f: height off by %.2g m, slope by %.2g\n",
                plane.slope[0], plane.slope[1], plane.dry_before, (double)smoothing, worst[0], worst[1]);
  assert_true(worst[0] < 1e-5 && worst[1] < 5e-4);
  free(surface);
  test_field_destroy(&f);
}

static void test_planes(void **state) {
  const float smoothings[] = {0, 1, 2};
  for (int i = 0; i < 3; ++i) {
    const int margin = 1 + (int)ceilf(3 * (fmaxf(smoothings[i], 0.2f) + 0.5f));
    expect_plane(*state, (Plane){0.5, {0, 0}, -1}, smoothings[i], 0);
    expect_plane(*state, (Plane){0.5, {0, 0}, 0.6}, smoothings[i], 0);
    expect_plane(*state, (Plane){0.5, {0.3, -0.2}, -1}, smoothings[i], margin);
    expect_plane(*state, (Plane){0.5, {0.3, -0.2}, 0.6}, smoothings[i], margin);
  }
}

// Water flat on a wall: there the slope across it is none.
static void test_border(void **state) {
  FieldBench *b = *state;
  TestField f = test_field_create(31, 22, SPACING, -0.2f, 0.1f, waves, NULL);
  float *surface = field_bench_surface(b, &f, 1);
  const int32_t width = b->map.size[0], height = b->map.size[1];
  for (int32_t k = 0; k < height; ++k) {
    assert_true(fabsf(surface[4 * k * width + 2]) < 1e-6f && fabsf(surface[4 * (k * width + width - 1) + 2]) < 1e-6f);
  }
  for (int32_t i = 0; i < width; ++i) {
    assert_true(fabsf(surface[4 * i + 3]) < 1e-6f && fabsf(surface[4 * ((height - 1) * width + i) + 3]) < 1e-6f);
  }
  free(surface);
  test_field_destroy(&f);
}

// ---- Degenerate fields -----------------------------------------------------------------------------------------------

static double nothing(double x, double z, const void *context) {
  return x + z > 1e9 ? 0 : *(const double *)context;
}

static void test_no_field(void **state) {
  FieldBench *b = *state;
  const TestField none = {.heights = NULL};
  assert_null(field_bench_surface(b, &none, 1));
  assert_true(b->map.lowest > b->map.highest);
  const RenderHeightBlock block = render_height_block(&b->map);
  for (int i = 0; i < 4; ++i) assert_true(block.place[i] == 0 && isfinite(block.range[i]));
}

static void test_no_water(void **state) {
  FieldBench *b = *state;
  const double values[] = {NAN, INFINITY, -INFINITY, 1e7};
  for (int i = 0; i < 4; ++i) {
    TestField f = test_field_create(9, 5, SPACING, 0, 0, nothing, &values[i]);
    float *surface = field_bench_surface(b, &f, 1);
    assert_true(b->map.lowest > b->map.highest);
    for (int32_t k = 0; k < 17 * 9; ++k) {
      for (int c = 0; c < 4; ++c) assert_true(surface[4 * k + c] == 0);
    }
    free(surface);
    test_field_destroy(&f);
  }
}

static void test_few_nodes(void **state) {
  const int32_t sizes[][2] = {{1, 1}, {2, 1}, {1, 2}, {2, 2}, {3, 2}, {1, 50}};
  for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
    TestField f = test_field_create(sizes[i][0], sizes[i][1], SPACING, 0.1f, 0.2f, waves, NULL);
    expect_twin(*state, &f, 0);
    expect_twin(*state, &f, 2);
    test_field_destroy(&f);
  }
}

static double one_node(double x, double z, const void *context) {
  return hypot(x - 0.4, z - 0.2) < 1e-3 ? *(const double *)context : NAN;
}

static void test_one_wet_node(void **state) {
  const double height = 0.7;
  TestField f = test_field_create(21, 11, SPACING, 0, 0, one_node, &height);
  expect_twin(*state, &f, 1);
  test_field_destroy(&f);
}

// Longer than a texture, and more nodes than a block holds: some are left out, and none is looked for where it is not.
static void test_huge_fields(void **state) {
  FieldBench *b = *state;
  const Plane plane = {0.5, {0.01, 0}, -1};
  const int32_t sizes[][3] = {{1000, 700, 1}, {40000, 2, 3}, {2, 40000, 3}, {300, 300, 2}};
  for (int i = 0; i < 4; ++i) {
    TestField f = test_field_create(sizes[i][0], sizes[i][1], 0.01f, 0, 0, plane_height, &plane);
    if (i == 3) gpu_limit_blocks(4 * 150 * 160);
    float *surface = field_bench_surface(b, &f, 0);
    gpu_limit_blocks(0);
    assert_int_equal(b->map.size[0], i == 3 ? 299 : (sizes[i][0] - 1) / sizes[i][2] + 1);
    assert_int_equal(b->map.size[1], i == 3 ? 299 : (sizes[i][1] - 1) / sizes[i][2] + 1);
    const int32_t at = b->map.size[0] / 2;
    assert_true(fabs((double)surface[4 * at] - (0.5 + 0.01 * at * (double)b->map.spacing)) < 1e-3);
    free(surface);
    test_field_destroy(&f);
  }
}

// The texture coordinates of the block hit the middles of texels.
static void test_place(void **state) {
  FieldBench *b = *state;
  TestField f = test_field_create(31, 22, SPACING, -0.2f, 0.1f, waves, NULL);
  free(field_bench_surface(b, &f, 1));
  const RenderHeightBlock block = render_height_block(&b->map);
  for (int k = 0; k < 2; ++k) {
    const float x = f.field.origin[k] + 5 * SPACING,
                texel = (x * block.place[k] + block.place[2 + k]) * (float)b->map.size[k];
    assert_true(fabsf(texel - 10.5f) < 1e-4f);
  }
  test_field_destroy(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_no_field),     cmocka_unit_test(test_no_water),    cmocka_unit_test(test_few_nodes),
      cmocka_unit_test(test_one_wet_node), cmocka_unit_test(test_huge_fields), cmocka_unit_test(test_planes),
      cmocka_unit_test(test_border),       cmocka_unit_test(test_place),       cmocka_unit_test(test_holes),
      cmocka_unit_test(test_twin),
  };
  return cmocka_run_group_tests(tests, field_bench_open, field_bench_close);
}
