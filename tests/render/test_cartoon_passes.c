// Passes of the style "cartoon" against their slow twins: outlines, both filters, normals, thickness.
#include "tests/render/drawn.h"
#include "tests/render/reference/cartoon.h"
#include "tests/render/reference/smooth.h"
#include "tests/render/water.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 160
#define HEIGHT 120
#define RADIUS 0.02f
#define SPACING (2 * RADIUS)
#define DEGREES (180 / 3.14159265358979323846)

// ---- What is looked at -----------------------------------------------------------------------------------------------

typedef struct Subject {
  const char *name;
  const SimFrame *frame;
  RenderView view;
} Subject;

enum { SUBJECTS = 4 };
typedef struct Water {
  Harness harness;
  TestWater pool;
  DrawnWater *made[SUBJECTS - 1];
  Subject subject[SUBJECTS];
} Water;

static const SimContainer tank = {{0, 0, 0}, {0.6f, 0.6f, 0.4f}, SIM_CONTAINER_BOX};

static int open_water(void **state) {
  Water *w = calloc(1, sizeof *w);
  assert_non_null(w);
  const float middle[3] = {0, 0, 0}, front[3] = {-0.15f, 0.05f, 0.45f};
  w->harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  w->pool = test_water_settled(&tank, RADIUS, 0.2f);
  for (int k = 0; k < SUBJECTS - 1; ++k) w->made[k] = drawn_create(RADIUS);
  drawn_add_block(w->made[0], middle, 12, 8, 10, 0.3f);
  drawn_add_ball(w->made[1], middle, 0.22f);
  drawn_add_block(w->made[2], middle, 16, 12, 2, 0.15f);
  drawn_add_block(w->made[2], front, 6, 5, 2, 0.15f);
  const Subject subjects[SUBJECTS] = {{"settled pool", &w->pool.frame, {{0.75f, 0.5f, 1.1f}, {0.3f, 0.12f, 0.2f}, 34}},
                                      {"disordered block", &w->made[0]->frame, {{0.7f, 0.6f, 1.1f}, {0, 0, 0}, 34}},
                                      {"ball", &w->made[1]->frame, {{0.1f, 0.4f, 1.2f}, {0, 0, 0}, 34}},
                                      {"two sheets", &w->made[2]->frame, {{0.2f, 0.3f, 1.5f}, {0, 0, 0.1f}, 34}}};
  for (int k = 0; k < SUBJECTS; ++k) w->subject[k] = subjects[k];
  *state = w;
  return 0;
}

static int close_water(void **state) {
  Water *w = *state;
  harness_close(&w->harness);
  test_water_destroy(&w->pool);
  for (int k = 0; k < SUBJECTS - 1; ++k) free(w->made[k]);
  free(w);
  return 0;
}

// ---- Comparing -------------------------------------------------------------------------------------------------------

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

typedef struct Difference {
  size_t both, one; // pixels with water in both maps, in one of them
  double most, share_99, share_999,
      moved; // radii of depth: largest, that of 99 and 99.9 % of the pixels; median by which the
             // pass moves the surface
} Difference;

// Inverse depths; pixels where `doubtful` is set do not count.
static Difference compare(const double *got, const double *want, const double *before, const bool *doubtful,
                          size_t pixels) {
  double *off = malloc(2 * pixels * sizeof *off), *moved = off + pixels;
  Difference d = {0};
  for (size_t i = 0; i < pixels; ++i) {
    if (doubtful != NULL && doubtful[i]) continue;
    d.one += (got[i] > 0) != (want[i] > 0);
    if (!(got[i] > 0 && want[i] > 0)) continue;
    moved[d.both] = before[i] > 0 ? fabs(1 / before[i] - 1 / want[i]) / (double)RADIUS : 0;
    off[d.both++] = fabs(1 / got[i] - 1 / want[i]) / (double)RADIUS;
  }
  assert_true(d.both > pixels / 12);
  qsort(off, d.both, sizeof *off, ascending);
  qsort(moved, d.both, sizeof *moved, ascending);
  d.most = off[d.both - 1];
  d.share_99 = off[d.both * 99 / 100];
  d.share_999 = off[(size_t)(0.999 * (double)(d.both - 1))];
  d.moved = moved[d.both / 2];
  free(off);
  return d;
}

static RenderSettings settings_at(int32_t scale) {
  RenderSettings settings = drawn_settings();
  settings.cartoon.half_resolution = scale == 2;
  return settings;
}

// 1 / depth of the smoothed body.
static double *inverse_map(Water *w, const Subject *s, int32_t scale, const RenderSettings *settings) {
  double *map = drawn_map(&w->harness, "smooth_depth", scale, s->frame, &s->view, settings);
  for (int i = 0; i < WIDTH * HEIGHT / (scale * scale); ++i) map[i] = map[i] > 0 ? 1 / map[i] : 0;
  return map;
}

// What the filters start from.
static double *tidy_map(Water *w, const Subject *s, int32_t scale) {
  RenderSettings settings = settings_at(scale);
  settings.cartoon.smoothing = RENDER_CARTOON_NONE;
  return inverse_map(w, s, scale, &settings);
}

// ---- Outlines --------------------------------------------------------------------------------------------------------

static void expect_tidy(Water *w, const Subject *s, int32_t scale) {
  RenderSettings settings = settings_at(scale);
  settings.cartoon.smoothing = RENDER_CARTOON_NONE;
  const size_t pixels = WIDTH * HEIGHT / (size_t)(scale * scale);
  const Lens lens = drawn_lens(&w->harness, &s->view, scale);
  const CartoonTidy tidy = {.sigma = 0.9 * (double)RADIUS, .gap = 3 * (double)RADIUS};
  double *raw = drawn_map(&w->harness, "raw_depth", scale, s->frame, &s->view, &settings), *got = tidy_map(w, s, scale);
  double *cover = drawn_map(&w->harness, "cover", scale, s->frame, &s->view, &settings);
  double *want = malloc(2 * pixels * sizeof *want), *share = want + pixels, off = 0;
  bool *doubtful = malloc(pixels);
  cartoon_tidy(&lens, &tidy, raw, want, share, doubtful);
  size_t unsure = 0, changed = 0;
  for (size_t i = 0; i < pixels; ++i) {
    unsure += doubtful[i];
    changed += (raw[i] > 0) != (want[i] > 0) || fabs(raw[i] - want[i]) > 1e-6 * raw[i];
    if (!doubtful[i]) off = fmax(off, fabs(cover[i] - share[i]));
  }
  const Difference d = compare(got, want, raw, doubtful, pixels);
  print_message(
      "outlines of %-16s 1/%d: %5zu pixels, %zu unlike, %zu doubtful, %zu changed: off by %.2g r, cover by %.2g\n",
      s->name, scale, d.both, d.one, unsure, changed, d.most, off);
  assert_int_equal(d.one, 0);
  assert_true(d.most < 1e-4);
  assert_true(off < 1e-4);
  assert_true(unsure < pixels / 100);
  assert_true(changed >= 10);
  free(raw);
  free(got);
  free(cover);
  free(want);
  free(doubtful);
}

static void test_outlines(void **state) {
  Water *w = *state;
  for (int k = 0; k < SUBJECTS; ++k) {
    for (int32_t scale = 1; scale <= 2; ++scale) expect_tidy(w, &w->subject[k], scale);
  }
}

// ---- The bilateral filter --------------------------------------------------------------------------------------------

typedef struct Filtered {
  double *inverse, *slope;
  int passes;
} Filtered;

static void filter(const Lens *lens, CartoonBilateral p, bool separated, Filtered *f) {
  for (int along = 0; along < (separated ? 2 : 1); ++along) {
    p.kernel = !separated ? CARTOON_FULL : along == 0 ? CARTOON_ROWS : CARTOON_COLUMNS;
    cartoon_bilateral(lens, &p, f->inverse, f->slope);
    ++f->passes;
  }
}

// The adaptive kernel: narrow, then wide, then ever narrower until taps are no longer apart where the water is nearest.
static void filter_adaptively(const Lens *lens, CartoonBilateral p, bool separated, double reach, double nearest,
                              Filtered *f) {
  p.taps = 5;
  const double apart = 1.5 * p.taps * lens_pixel(lens) * nearest;
  p.reach = 0.3 * reach;
  filter(lens, p, separated, f);
  p.wider = 0;
  for (p.reach = reach;; p.reach *= 0.3) {
    filter(lens, p, separated, f);
    p.averaged = true;
    if (p.reach <= apart) return;
  }
}

// What the renderer makes of a tidy map.
static Filtered filter_as(const Lens *lens, const RenderCartoon *c, double nearest, const double *before) {
  const size_t pixels = (size_t)lens->width * (size_t)lens->height;
  Filtered f = {malloc(pixels * sizeof(double)), calloc(2 * pixels, sizeof(double)), 0};
  memcpy(f.inverse, before, pixels * sizeof(double));
  const CartoonBilateral p = {
      .half = c->kernel / 2, .taps = 32, .range = (double)(c->range * RADIUS), .fitted = c->fitted, .wider = 2.5};
  if (c->kernel > 0)
    filter(lens, p, c->separated, &f);
  else
    filter_adaptively(lens, p, c->separated, (double)(c->reach * RADIUS), nearest, &f);
  return f;
}

static double angle_between(const float a[3], const double b[3]) {
  double squares = 0;
  for (int k = 0; k < 3; ++k) squares += pow((double)a[k] - b[k], 2);
  return 2 * asin(fmin(sqrt(squares) / 2, 1)) * DEGREES;
}

// Degrees up to which 99.9 % of the normals by slopes lie.
static double normals_off(Water *w, const Subject *s, int32_t scale, const RenderSettings *settings,
                          const Filtered *f) {
  const Pinhole pinhole = water_pinhole(&s->view, WIDTH / scale, HEIGHT / scale);
  const int32_t width = WIDTH / scale, pixels = width * HEIGHT / scale;
  float *got = harness_layer(&w->harness, "smooth_normal", 3, s->frame, &s->view, settings);
  float *want = malloc(3 * (size_t)pixels * sizeof *want);
  double *off = malloc((size_t)pixels * sizeof *off);
  size_t count = 0;
  cartoon_normals(&pinhole.lens, f->inverse, f->slope, want);
  for (int32_t i = 0; i < pixels; ++i) {
    const float *n = got + 3 * (scale * (i / width) * WIDTH + scale * (i % width));
    const double world[3] = {(double)n[0], (double)n[1], (double)n[2]};
    double turned[3];
    pinhole_to_view(&pinhole, world, turned);
    if (f->inverse[i] > 0) off[count++] = angle_between(want + 3 * i, turned);
  }
  qsort(off, count, sizeof *off, ascending);
  const double share = off[(size_t)(0.999 * (double)(count - 1))];
  free(got);
  free(want);
  free(off);
  return share;
}

// Depth of the middle of the nearest sphere that may be in the picture, of all particles and their images in the walls.
static double nearest_of(const Subject *s);

static void expect_filtered(Water *w, const Subject *s, int32_t scale, const RenderCartoon *cartoon) {
  RenderSettings settings = settings_at(scale);
  const bool half = settings.cartoon.half_resolution;
  settings.cartoon = *cartoon;
  settings.cartoon.half_resolution = half;
  const Lens lens = drawn_lens(&w->harness, &s->view, scale);
  const size_t pixels = WIDTH * HEIGHT / (size_t)(scale * scale);
  double *before = tidy_map(w, s, scale), *got = inverse_map(w, s, scale, &settings);
  Filtered want = filter_as(&lens, cartoon, nearest_of(s), before);
  const Difference d = compare(got, want.inverse, before, NULL, pixels);
  const double angle = cartoon->fitted ? normals_off(w, s, scale, &settings, &want) : 0;
  print_message("%-16s 1/%d, %-9s %-6s kernel %2d, %d passes: %5zu pixels moved by %.2g r; off by %.2g r, at most by "
                "%.2g r, %.2g degrees\n",
                s->name, scale, cartoon->separated ? "separated" : "full", cartoon->fitted ? "fitted" : "mean",
                (int)cartoon->kernel, want.passes, d.both, d.moved, d.share_999, d.most, angle);
  assert_int_equal(d.one, 0);
  assert_true(d.share_999 < 2e-4);
  assert_true(d.most < 0.05); // a tap half way between two pixels may fall on the other one
  assert_true(d.moved > 500 * d.share_999);
  assert_true(angle < 0.01);
  free(before);
  free(got);
  free(want.inverse);
  free(want.slope);
}

static void test_bilateral(void **state) {
  Water *w = *state;
  static const int32_t kernels[] = {0, 10, 20, 30};
  RenderCartoon cartoon = drawn_settings().cartoon;
  for (int k = 0; k < SUBJECTS; ++k) {
    for (int choice = 0; choice < 16; ++choice) {
      cartoon.separated = choice & 1;
      cartoon.fitted = choice & 2;
      cartoon.kernel = kernels[choice / 4];
      expect_filtered(w, &w->subject[k], cartoon.kernel == 30 ? 2 : 1 + (k + choice / 4) % 2, &cartoon);
    }
  }
}

// ---- Curvature flow --------------------------------------------------------------------------------------------------

// The mirror image of a particle in the walls of `axes` (a bit for each); false: it has none, too far from one of them.
static bool image_of(const SimFrame *frame, const float p[3], int axes, double image[3]) {
  for (int k = 0; k < 3; ++k) {
    const double low = (double)(p[k] - frame->container.min[k]), high = (double)(frame->container.max[k] - p[k]);
    image[k] = (double)p[k];
    if (!(axes >> k & 1)) continue;
    const bool lower = k == 1 || low < high;
    if (!frame->has_container || (lower ? low : high) >= 4 * (double)RADIUS) return false;
    image[k] += 2 * (lower ? -low : high);
  }
  return true;
}

static double nearest_of(const Subject *s) {
  const Pinhole pinhole = water_pinhole(&s->view, WIDTH, HEIGHT);
  const double reach = 1.5 * (double)RADIUS;
  double nearest = INFINITY;
  for (int32_t i = 0; i < 8 * s->frame->count; ++i) {
    double from[3], p[3];
    if (!s->frame->near_surface[i / 8] || s->frame->particle_class[i / 8] == SIM_SPLASH) continue;
    if (!image_of(s->frame, s->frame->position + 3 * (i / 8), i % 8, from)) continue;
    for (int k = 0; k < 3; ++k) from[k] -= pinhole.eye[k];
    pinhole_to_view(&pinhole, from, p);
    if (fabs(p[0]) < -p[2] * pinhole.lens.tan_x + reach && fabs(p[1]) < -p[2] * pinhole.lens.tan_y + reach)
      nearest = fmin(nearest, -p[2]);
  }
  return nearest;
}

// As many steps as blur by a third of the reach, where the water is nearest.
static int flow_steps(const Subject *s, const Lens *lens, double reach, double step) {
  const double sigma = reach * (double)RADIUS / (lens_pixel(lens) * nearest_of(s)) / 3;
  return (int)ceil(sigma * sigma / (2 * step));
}

static void expect_flow(Water *w, const Subject *s, int32_t scale, float reach) {
  RenderSettings settings = settings_at(scale);
  settings.cartoon.smoothing = RENDER_CARTOON_CURVATURE;
  settings.cartoon.reach = reach;
  const size_t pixels = WIDTH * HEIGHT / (size_t)(scale * scale);
  const Lens lens = drawn_lens(&w->harness, &s->view, scale);
  const CartoonFlow flow = {.step = 0.2, .gap = 3 * (double)RADIUS};
  double *before = tidy_map(w, s, scale), *got = inverse_map(w, s, scale, &settings);
  double *want = malloc(2 * pixels * sizeof *want), *other = want + pixels;
  memcpy(want, before, pixels * sizeof *want);
  const int steps = flow_steps(s, &lens, (double)reach, flow.step);
  for (int i = 0; i < steps; ++i) {
    cartoon_flow(&lens, &flow, want, other);
    memcpy(want, other, pixels * sizeof *want);
  }
  const Difference d = compare(got, want, before, NULL, pixels);
  print_message("curvature flow, %-16s 1/%d: %3d steps, moved by %.2g r; off by %.2g r, at most by %.2g r\n", s->name,
                scale, steps, d.moved, d.share_999, d.most);
  assert_true(steps > 1 && steps < 200);
  assert_int_equal(d.one, 0);
  // Where a step in depth is almost a border, rounding decides whether it is one, and the steps carry that on.
  assert_true(d.share_99 < 3e-4);
  assert_true(d.most < 0.1);
  assert_true(d.moved > 300 * d.share_99);
  free(before);
  free(got);
  free(want);
}

static void test_curvature_flow(void **state) {
  Water *w = *state;
  for (int k = 0; k < SUBJECTS; ++k) {
    expect_flow(w, &w->subject[k], 1, 4);
    expect_flow(w, &w->subject[k], 2, 8);
  }
}

// ---- Normals ---------------------------------------------------------------------------------------------------------

static void expect_normals(Water *w, const Subject *s, const RenderSettings *settings) {
  const Pinhole pinhole = water_pinhole(&s->view, WIDTH, HEIGHT);
  float *depth = harness_layer(&w->harness, "smooth_depth", 1, s->frame, &s->view, settings);
  float *got = harness_layer(&w->harness, "smooth_normal", 3, s->frame, &s->view, settings);
  float *want = malloc(3 * WIDTH * HEIGHT * sizeof *want);
  smooth_normals(&pinhole.lens, (double)RADIUS, depth, want);
  double worst = 0;
  int pixels = 0, other_side = 0;
  for (int i = 0; i < WIDTH * HEIGHT; ++i) {
    const double world[3] = {(double)got[3 * i], (double)got[3 * i + 1], (double)got[3 * i + 2]};
    double turned[3];
    pinhole_to_view(&pinhole, world, turned);
    const double angle = angle_between(want + 3 * i, turned);
    pixels += depth[i] > 0;
    if (angle > 1)
      ++other_side;
    else
      worst = fmax(worst, angle);
  }
  print_message("normals of %-16s: %d pixels, %.2g degrees, %d from the other side\n", s->name, pixels, worst,
                other_side);
  assert_true(pixels > WIDTH * HEIGHT / 12);
  assert_true(worst < 0.05);
  // Where three pixels bend by a radius, rounding decides whether the middle one takes both sides or one.
  assert_true(other_side <= pixels / 1000);
  free(depth);
  free(got);
  free(want);
}

static void test_normals(void **state) {
  Water *w = *state;
  RenderSettings settings = settings_at(1);
  settings.cartoon.fitted = false;
  for (int k = 0; k < SUBJECTS; ++k) expect_normals(w, &w->subject[k], &settings);
  settings.cartoon.smoothing = RENDER_CARTOON_NONE;
  for (int k = 0; k < SUBJECTS; ++k) expect_normals(w, &w->subject[k], &settings);
}

// ---- Thickness -------------------------------------------------------------------------------------------------------

static void expect_thickness(Water *w, const Subject *s, const SimFrame *frame) {
  const int32_t width = WIDTH / 2, height = HEIGHT / 2;
  const size_t pixels = (size_t)width * (size_t)height;
  RenderSettings settings = settings_at(1);
  settings.floor = RENDER_FLOOR_CHECKER;
  settings.floor_level = 0.05f; // through the water
  double *got = drawn_map(&w->harness, "thickness", 2, frame, &s->view, &settings);
  float *background = harness_layer(&w->harness, "background_depth", 1, frame, &s->view, &settings);
  float *behind = malloc(pixels * sizeof *behind);
  for (size_t i = 0; i < pixels; ++i) {
    // Counted from the bottom it is the upper one of the right two pixels.
    behind[i] = background[2 * (i / (size_t)width) * WIDTH + 2 * (i % (size_t)width) + 1];
  }
  double *want = malloc(2 * pixels * sizeof *want), *slack = want + pixels, worst = 0, most = 0;
  const Pinhole pinhole = water_pinhole(&s->view, width, height);
  cartoon_thickness(&pinhole, frame, behind, want, slack);
  size_t wet = 0;
  for (size_t i = 0; i < pixels; ++i) {
    worst = fmax(worst, (fabs(got[i] - want[i]) - slack[i]) / (double)RADIUS);
    most = fmax(most, want[i] / (double)RADIUS);
    wet += want[i] > 0;
  }
  print_message("metres of water, %-16s: %zu pixels, up to %.1f r, off by %.2g r\n", s->name, wet, most, worst);
  assert_true(wet > pixels / 12 && most > 3);
  assert_true(worst < 1e-3);
  free(got);
  free(background);
  free(behind);
  free(want);
}

static void test_thickness(void **state) {
  Water *w = *state;
  for (int k = 0; k < SUBJECTS; ++k) expect_thickness(w, &w->subject[k], w->subject[k].frame);
  // Particles with a radius of their own, and drops, which are not of the body.
  DrawnWater *block = w->made[0];
  for (int32_t i = 0; i < block->frame.count; ++i) {
    block->radius[i] = RADIUS * (0.7f + 0.1f * (float)(i % 7));
    if (i % 5 == 0) block->particle_class[i] = SIM_SPLASH;
  }
  SimFrame own = block->frame;
  own.radius = block->radius;
  expect_thickness(w, &w->subject[1], &own);
  for (int32_t i = 0; i < block->frame.count; ++i) block->particle_class[i] = SIM_AGGREGATED;
}

// A layer of water of a known thickness, seen at right angles: a lattice adds up to it.
static void test_thickness_of_a_layer(void **state) {
  Water *w = *state;
  DrawnWater *layer = drawn_create(RADIUS);
  drawn_add_block(layer, (const float[3]){0, 0, 0}, 40, 30, 5, 0);
  const RenderView view = harness_view(0, 0, 25, 0, 0, 0, 1.1f);
  const RenderSettings settings = settings_at(1);
  double *got = drawn_map(&w->harness, "thickness", 2, &layer->frame, &view, &settings), least = INFINITY, most = 0;
  for (int y = HEIGHT / 4 - 5; y < HEIGHT / 4 + 5; ++y) {
    for (int x = WIDTH / 4 - 5; x < WIDTH / 4 + 5; ++x) {
      least = fmin(least, got[y * WIDTH / 2 + x] / (double)(5 * SPACING));
      most = fmax(most, got[y * WIDTH / 2 + x] / (double)(5 * SPACING));
    }
  }
  print_message("a layer of five spacings: from %.4f to %.4f of its thickness\n", least, most);
  assert_true(least > 0.965 && most < 1.035);
  free(got);
  free(layer);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_outlines), cmocka_unit_test(test_bilateral), cmocka_unit_test(test_curvature_flow),
      cmocka_unit_test(test_normals),  cmocka_unit_test(test_thickness), cmocka_unit_test(test_thickness_of_a_layer)};
  return cmocka_run_group_tests(tests, open_water, close_water);
}
