// The waterline of bodies in the style "heightfield" has no break (Cords 2007, Figure 10): what is seen above the water and
// through it meets within 1.5 pixels, on level water, on waves, and with "long" on 20 frames of the scene table_pool.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/source.h"
#include "tests/render/waterline.h"

#define SCALE 2 // the pictures are so many times as large as those of 640 × 480 whose pixels count
#define WIDTH (640 * SCALE)
#define HEIGHT (480 * SCALE)
#define MOST_BREAK 1.5 // pixels
#define PI 3.14159265358979323846

// ---- The measure -----------------------------------------------------------------------------------------------------

// A body of 40 pixels that goes in at row 200, on to row 300; what is seen through the water is `shift` to the right, leans by
// `slope` and begins `seam` rows later.
static WaterlineBreaks breaks_of(int shift, double slope, int seam) {
  uint8_t *rgb = calloc(3, (size_t)WIDTH * HEIGHT);
  float *water = calloc((size_t)WIDTH * HEIGHT, sizeof *water);
  assert_non_null(rgb);
  assert_non_null(water);
  for (int y = 100; y < 300; ++y) {
    const double moved = y < 200 ? 0 : shift + slope * (y - 199.5);
    for (int x = 0; x < WIDTH; ++x) {
      const bool inside = x + 0.5 > 300 + moved && x + 0.5 < 340 + moved;
      uint8_t *p = rgb + 3 * ((size_t)y * WIDTH + (size_t)x);
      memset(p, 50, 3);
      if (inside && (y < 200 || y >= 200 + seam)) p[0] = 220;
      water[y * WIDTH + x] = y < 200 && inside ? 0 : 2;
    }
  }
  const WaterlinePicture picture = {WIDTH, HEIGHT, rgb, water};
  const WaterlineBreaks breaks = waterline_measure(&picture, 1);
  assert_int_equal(waterline_measure(&picture, 2).joins, 0);
  free(rgb);
  free(water);
  return breaks;
}

static void test_measure(void **state) {
  (void)state;
  const int shifts[] = {0, 1, 2, 5, -3, -12};
  for (int i = 0; i < 6; ++i) {
    const WaterlineBreaks breaks = breaks_of(shifts[i], 0, 0);
    assert_int_equal(breaks.joins, 2);
    assert_float_equal(breaks.gap, (double)abs(shifts[i]) / SCALE, 1e-6);
    assert_true(breaks.seam == 0 || abs(shifts[i]) > 1); // there the last columns show the floor
  }
  // A body that bends at the waterline has no break.
  const double slopes[] = {0.3, -0.5, 0.9};
  for (int i = 0; i < 3; ++i) {
    assert_true(breaks_of(0, slopes[i], 0).gap < 0.3);
    assert_float_equal(breaks_of(4, slopes[i], 0).gap, 4.0 / SCALE, 0.3);
  }
  assert_float_equal(breaks_of(0, 0, 3).seam, 3.0 / SCALE, 1e-6);
}

// ---- Waves made by hand ----------------------------------------------------------------------------------------------

enum { NODES = 101 };
#define SPACING 0.04f

typedef struct Wave {
  const char *name;
  double height, length; // m
} Wave;
static const Wave level = {"level", 0, 1}, waves[] = {{"long waves", 0.05, 1.6}, {"short waves", 0.02, 0.5}};

typedef struct Picture {
  TestFrame *frame;
  float height[NODES * NODES];
} Picture;

static Picture *picture_create(Wave wave, double phase) {
  Picture *s = calloc(1, sizeof *s);
  assert_non_null(s);
  s->frame = test_frame_create(1, SPACING / 2);
  SimFrame *frame = &s->frame->frame;
  frame->container = (SimContainer){.min = {0, 0, 0}, .max = {4, 1.2f, 4}};
  memcpy(frame->bounds_max, frame->container.max, sizeof frame->bounds_max);
  for (int k = 0; k < NODES; ++k) {
    for (int i = 0; i < NODES; ++i) {
      const double x = (double)SPACING * i, z = (double)SPACING * k, turn = 2 * PI / wave.length;
      s->height[k * NODES + i] = (float)(0.5 + wave.height * sin(turn * (0.8 * x + 0.6 * z) + phase));
    }
  }
  frame->height_field = (SimHeightField){{NODES, NODES}, {0, 0}, SPACING, s->height, NULL};
  // Boxes square to the pool and not, and round bodies.
  const SimShape shapes[4] = {SIM_BOX, SIM_BOX, SIM_CYLINDER, SIM_CYLINDER};
  const float places[4][2] = {{1.2f, 2.1f}, {1.8f, 2.6f}, {2.3f, 2}, {2.9f, 2.5f}};
  for (int i = 0; i < 4; ++i) {
    SimObstacle *o = &s->frame->obstacles[frame->obstacle_count++];
    *o = (SimObstacle){.shape = shapes[i],
                       .size = {0.14f, 1, 0.14f},
                       .position = {places[i][0], 0.5f, places[i][1]},
                       .rotation = {0, i == 1 ? 0.259f : 0, 0, i == 1 ? 0.966f : 1}};
    waterline_paint(o, i + 1);
  }
  return s;
}

static void picture_destroy(Picture *s) {
  test_frame_destroy(s->frame);
  free(s);
}

static WaterlineBreaks breaks_on(Harness *harness, Wave wave, int phases, const RenderSettings *settings) {
  WaterlineBreaks all = {0};
  const RenderView views[2] = {harness_view(2, 1.9f, 5.2f, 2, 0.5f, 2.2f, 34),
                               harness_view(2.8f, 2.6f, 4.6f, 2, 0.5f, 2.2f, 34)};
  for (int i = 0; i < phases; ++i) {
    Picture *s = picture_create(wave, 2 * PI * i / phases);
    const WaterlineBreaks breaks = waterline_of_frame(harness, &s->frame->frame, &views[i % 2], settings);
    all.joins += breaks.joins;
    all.gap = fmax(all.gap, breaks.gap);
    all.seam = fmax(all.seam, breaks.seam);
    picture_destroy(s);
  }
  print_message("%s: %d sides, gaps up to %.2f px, seams up to %.1f px\n", wave.name, all.joins, all.gap, all.seam);
  return all;
}

static void expect_unbroken(WaterlineBreaks breaks, int joins) {
  assert_true(breaks.joins >= joins);
  assert_true(breaks.gap <= MOST_BREAK);
  assert_true(breaks.seam <= MOST_BREAK);
}

static void test_level(void **state) {
  const RenderSettings settings = waterline_settings();
  expect_unbroken(breaks_on(*state, level, 2, &settings), 14);
}

static void test_waves(void **state) {
  const RenderSettings settings = waterline_settings();
  for (int i = 0; i < 2; ++i) expect_unbroken(breaks_on(*state, waves[i], 4, &settings), 28);
}

// As in the paper, where rays are looked up by their direction alone, it is the pull to the planes that mends the waterline.
static void test_pull_mends(void **state) {
  RenderSettings settings = waterline_settings();
  settings.heightfield.access = RENDER_ACCESS_DIRECTION;
  expect_unbroken(breaks_on(*state, waves[1], 4, &settings), 28);
  settings.heightfield.pull_reach = 0;
  const WaterlineBreaks breaks = breaks_on(*state, waves[1], 4, &settings);
  assert_true(breaks.gap > 3 * MOST_BREAK);
}

static int open_harness(void **state) {
  return harness_open_group(state, WIDTH, HEIGHT);
}

// ---- The scene -------------------------------------------------------------------------------------------------------

enum { FIRST = 40, FRAMES = 20, STEP = 5 };

// Legs in hues of their own, all else grey.
static SimFrame paint(const SimFrame *frame, SimObstacle *obstacles, int most) {
  SimFrame painted = *frame;
  assert_in_range(frame->obstacle_count, 5, most);
  for (int i = 0; i < frame->obstacle_count; ++i) {
    obstacles[i] = frame->obstacles[i];
    waterline_paint(&obstacles[i], i < 4 ? i + 1 : 0);
  }
  painted.obstacles = obstacles;
  return painted;
}

static void test_table_pool(void **state) {
  char frames[32], *arguments[] = {"lido", "render", "configs/table_pool.json", "--frames", frames, "-o", "-"};
  snprintf(frames, sizeof frames, "%d:%d", FIRST, FIRST + FRAMES * STEP);
  Options options;
  AppError error = {0};
  if (!options_parse(&options, 7, arguments, &error)) fail_msg("%s", error.message);
  Source *source = source_open(&options, &error);
  if (source == NULL) fail_msg("%s", error.message);
  const RenderSettings settings = waterline_settings();
  const RenderView beside = harness_view(2.7f, 1.7f, 4, 1.15f, 0.45f, 0.85f, 36); // where no leg hides another
  WaterlineBreaks worst = {0};
  int count = 0;
  for (; count < FRAMES * STEP && source_next(source, &error) == SOURCE_FRAME; ++count) {
    if (count % STEP != 0) continue;
    SimObstacle obstacles[32];
    const SimFrame *frame = source_frame(source, render_style_needs("heightfield", NULL), &error);
    assert_non_null(frame);
    const SimFrame painted = paint(frame, obstacles, 32);
    for (int k = 0; k < 2; ++k) {
      const RenderView *view = k == 0 ? source_view(source) : &beside;
      const WaterlineBreaks breaks = waterline_of_frame(*state, &painted, view, &settings);
      print_message("frame %d: %d sides, gap %.2f px, seam %.1f px\n", FIRST + count, breaks.joins, breaks.gap,
                    breaks.seam);
      assert_true(breaks.joins >= (k == 0 ? 3 : 7));
      worst.gap = fmax(worst.gap, breaks.gap);
      worst.seam = fmax(worst.seam, breaks.seam);
    }
  }
  assert_int_equal(count, FRAMES * STEP);
  assert_true(worst.gap <= MOST_BREAK);
  assert_true(worst.seam <= MOST_BREAK);
  source_close(source);
  options_free(&options);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_measure),
      cmocka_unit_test(test_level),
      cmocka_unit_test(test_waves),
      cmocka_unit_test(test_pull_mends),
  };
  const struct CMUnitTest long_tests[] = {cmocka_unit_test(test_table_pool)};
  if (argc > 1 && strcmp(argv[1], "long") == 0) {
    return cmocka_run_group_tests(long_tests, open_harness, harness_close_group);
  }
  return cmocka_run_group_tests(tests, open_harness, harness_close_group);
}
