// Outlines of hand-made maps of depth: where they lie, how wide they are, and what has none; and against their slow twin.
#include "tests/render/harness.h"

#include <cglm/cglm.h>
#include <epoxy/gl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/outlines.h"
#include "tests/render/reference/outlines.h"

#define WIDTH 240
#define HEIGHT 160
#define PIXELS ((size_t)WIDTH * HEIGHT)

static const Lens lens = {WIDTH, HEIGHT, 0.3 * 1.5, 0.3};

// ---- The passes alone ------------------------------------------------------------------------------------------------

typedef struct Bench {
  Context *context;
  Gpu gpu;
  RenderPicture picture;
  RenderOutlines outlines;
  GpuTexture surface, drawing;
  GpuTarget target;
} Bench;

static int open_bench(void **state) {
  Bench *b = calloc(1, sizeof *b);
  AppError app_error = {0};
  RenderError error = {0};
  b->context = context_create_headless(CONTEXT_AUTO, &app_error);
  if (b->context == NULL) fail_msg("%s", app_error.message);
  assert_true(gpu_create(&b->gpu, &error));
  b->picture = (RenderPicture){.gpu = &b->gpu, .width = WIDTH, .height = HEIGHT};
  const GpuTextureDesc surface = {"surface", WIDTH, HEIGHT, GPU_RGBA32F, false};
  const GpuTextureDesc drawing = {"drawing", WIDTH, HEIGHT, GPU_RGBA32F, false};
  assert_true(gpu_texture_create(&b->surface, &surface, &error));
  assert_true(gpu_texture_create(&b->drawing, &drawing, &error));
  assert_true(gpu_target_create(&b->target, &(GpuTargetDesc){.label = "drawing", .colour = {&b->drawing}}, &error));
  assert_true(render_outlines_resize(&b->outlines, &b->picture, &error));
  *state = b;
  return 0;
}

static int close_bench(void **state) {
  Bench *b = *state;
  render_outlines_destroy(&b->outlines);
  gpu_texture_destroy(&b->surface);
  gpu_texture_destroy(&b->drawing);
  gpu_target_destroy(&b->target);
  gpu_buffer_destroy(&b->picture.uniforms);
  assert_int_equal(b->gpu.error_count, 0);
  gpu_destroy(&b->gpu);
  context_destroy(b->context);
  free(b);
  return 0;
}

static void write_frame(Bench *b, OutlineShape shape) {
  RenderError error = {0};
  RenderFrameBlock *block = &b->picture.block;
  *block = (RenderFrameBlock){.eye[3] = RENDER_NEAR};
  glm_mat4_identity((vec4 *)block->world_to_view);
  const float lens4[4] = {(float)lens.tan_x, (float)lens.tan_y, WIDTH, HEIGHT};
  memcpy(block->lens, lens4, sizeof lens4);
  block->drawn_levels[3] = (float)shape.width;
  block->drawn_ink[3] = (float)shape.crease_cosine;
  assert_true(gpu_buffer_write(&b->picture.uniforms, "frame block", block, sizeof *block, &error));
}

// Black lines on white paper whose alpha is 7: how much of every pixel is inked, (HEIGHT, WIDTH), rows from the bottom.
static double *draw(Bench *b, const float *surface, bool normals, OutlineShape shape) {
  RenderError error = {0};
  write_frame(b, shape);
  glTextureSubImage2D(b->surface.id, 0, 0, 0, WIDTH, HEIGHT, GL_RGBA, GL_FLOAT, surface);
  gpu_clear_colour(&b->target, 0, (const float[4]){1, 1, 1, 7});
  if (!render_outlines_draw(&b->outlines, &b->picture, (RenderOutlined){&b->surface, normals}, &b->target, &error)) {
    fail_msg("%s", error.message);
  }
  float *values = malloc(4 * PIXELS * sizeof *values);
  double *ink = malloc(PIXELS * sizeof *ink);
  gpu_texture_read(&b->drawing, values);
  for (size_t i = 0; i < PIXELS; ++i) {
    ink[i] = 1 - (double)values[4 * i];
    assert_true(values[4 * i + 3] == 7);
  }
  free(values);
  return ink;
}

// ---- Scenes ----------------------------------------------------------------------------------------------------------

typedef struct Scene {
  double floor;     // m below the eye; 0: none
  double pitch;     // the gaze's slope, downwards
  double ball[4];   // centre in level axes (right, up, backwards), radius, m; 0: none
  double box[2][3]; // low and high corner
} Scene;

static double meet_ball(const double ball[4], const double d[3]) {
  const double dd = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], b = ball[0] * d[0] + ball[1] * d[1] + ball[2] * d[2];
  const double c = ball[0] * ball[0] + ball[1] * ball[1] + ball[2] * ball[2] - ball[3] * ball[3];
  return b * b > dd * c ? (b - sqrt(b * b - dd * c)) / dd : 0;
}

static double meet_box(const double box[2][3], const double d[3]) {
  double enter = 0, leave = 1e30;
  for (int k = 0; k < 3; ++k) {
    enter = fmax(enter, fmin(box[0][k] / d[k], box[1][k] / d[k]));
    leave = fmin(leave, fmax(box[0][k] / d[k], box[1][k] / d[k]));
  }
  return enter < leave ? enter : 0;
}

// Depth along the ray that goes through a place in the picture, pixels from the bottom left; 0: the sky.
static double depth_at(const Scene *scene, double x, double y) {
  const double right = lens.tan_x * (2 * x / WIDTH - 1), up = lens.tan_y * (2 * y / HEIGHT - 1);
  const double length = sqrt(1 + scene->pitch * scene->pitch), c = 1 / length, s = scene->pitch / length;
  const double d[3] = {right, up * c - s, -(c + up * s)};
  double best = scene->floor > 0 && d[1] < 0 ? -scene->floor / d[1] : 0;
  const double ts[2] = {scene->ball[3] > 0 ? meet_ball(scene->ball, d) : 0,
                        scene->box[1][1] > scene->box[0][1] ? meet_box(scene->box, d) : 0};
  for (int i = 0; i < 2; ++i) {
    if (ts[i] > 0 && (best == 0 || ts[i] < best)) best = ts[i];
  }
  return best;
}

static void make_depths(const Scene *scene, float *depth) {
  for (int32_t y = 0; y < HEIGHT; ++y) {
    for (int32_t x = 0; x < WIDTH; ++x) depth[y * WIDTH + x] = (float)depth_at(scene, x + 0.5, y + 0.5);
  }
}

static double *draw_scene(Bench *b, const Scene *scene, OutlineShape shape) {
  float *depth = malloc(PIXELS * sizeof *depth), *surface = calloc(4 * PIXELS, sizeof *surface);
  make_depths(scene, depth);
  for (size_t i = 0; i < PIXELS; ++i) surface[4 * i + 3] = depth[i];
  double *ink = draw(b, surface, false, shape);
  free(depth);
  free(surface);
  return ink;
}

#define CREASE 0.766 // cosine of 40°

static const Scene ball_over_floor = {.floor = 1.5, .pitch = 0.2, .ball = {0.03, -0.6, -4, 0.5}};
static const Scene box_on_floor = {.floor = 1.5, .pitch = 0.25, .box = {{0.8, -1.5, -7.2}, {1.6, -0.8, -4.2}}};

// ---- Measuring -------------------------------------------------------------------------------------------------------

// Between four pixels; places are pixels from the bottom left corner.
static double ink_at(const double *ink, double x, double y) {
  const double px = fmin(fmax(x - 0.5, 0), WIDTH - 1.001), py = fmin(fmax(y - 0.5, 0), HEIGHT - 1.001);
  const int32_t i = (int32_t)px, k = (int32_t)py;
  const double fx = px - i, fy = py - k, *here = &ink[k * WIDTH + i];
  return (1 - fy) * ((1 - fx) * here[0] + fx * here[1]) + fy * ((1 - fx) * here[WIDTH] + fx * here[WIDTH + 1]);
}

// Place of a point of level axes in the picture.
static void project(const Scene *scene, const double p[3], double pixel[2]) {
  const double length = sqrt(1 + scene->pitch * scene->pitch), c = 1 / length, s = scene->pitch / length;
  const double depth = -p[2] * c - p[1] * s, up = p[1] * c - p[2] * s;
  pixel[0] = (p[0] / depth / lens.tan_x + 1) / 2 * WIDTH;
  pixel[1] = (up / depth / lens.tan_y + 1) / 2 * HEIGHT;
}

static double sum_of(const double *ink) {
  double sum = 0;
  for (size_t i = 0; i < PIXELS; ++i) sum += ink[i];
  return sum;
}

// ---- Tests -----------------------------------------------------------------------------------------------------------

// From the middle of the ball outwards: pixels of ink within its silhouette and beyond.
static void across_silhouette(const double *ink, double angle, double *within, double *beyond) {
  Scene ball = ball_over_floor;
  ball.floor = 0;
  double middle[2];
  project(&ball, ball.ball, middle);
  *within = *beyond = 0;
  const double step = 0.05;
  for (double r = 0; r < 60; r += step) {
    const double x = middle[0] + r * cos(angle), y = middle[1] + r * sin(angle);
    *(depth_at(&ball, x, y) > 0 ? within : beyond) += step * ink_at(ink, x, y);
  }
}

// A ball has a silhouette and nothing else: as wide as asked all around, on the outside but for half a pixel.
static void test_ball(void **state) {
  static const double widths[] = {1, 2, 3.5, 6};
  for (size_t i = 0; i < sizeof widths / sizeof widths[0]; ++i) {
    double *ink = draw_scene(*state, &ball_over_floor, (OutlineShape){widths[i], CREASE});
    double thinnest = 1e9, widest = 0, deepest = 0, depths = 0;
    int count = 0;
    for (double angle = 0; angle < 6.28; angle += 0.05, ++count) {
      double within, beyond;
      across_silhouette(ink, angle, &within, &beyond);
      thinnest = fmin(thinnest, within + beyond);
      widest = fmax(widest, within + beyond);
      deepest = fmax(deepest, within);
      depths += within;
    }
    printf("width %g: %.2f to %.2f, within %.2f, at most %.2f\n", widths[i], thinnest, widest, depths / count, deepest);
    assert_true(thinnest > widths[i] - 0.5 && widest < widths[i] + 0.5);
    assert_true(depths < 0.75 * count && deepest < 1.2); // read between pixels, a step blurs by a half
    free(ink);
  }
}

// Thinner than a pixel: fainter, in proportion. No width: no line.
static void test_faint_lines(void **state) {
  double *one = draw_scene(*state, &ball_over_floor, (OutlineShape){1, CREASE});
  double *half = draw_scene(*state, &ball_over_floor, (OutlineShape){0.5, CREASE});
  double *none = draw_scene(*state, &ball_over_floor, (OutlineShape){0, CREASE});
  assert_true(sum_of(one) > 100);
  assert_true(fabs(sum_of(half) - 0.5 * sum_of(one)) < 1e-3 * sum_of(one));
  assert_true(sum_of(none) == 0);
  free(one);
  free(half);
  free(none);
}

// The least ink along an edge between two corners of the box, the last tenth at both ends left out.
static double least_ink_along(const double *ink, const int from[3], const int to[3]) {
  double least = 1;
  for (double share = 0.1; share < 0.91; share += 0.01) {
    double p[3], pixel[2];
    for (int k = 0; k < 3; ++k) {
      p[k] = (1 - share) * box_on_floor.box[from[k]][k] + share * box_on_floor.box[to[k]][k];
    }
    project(&box_on_floor, p, pixel);
    least = fmin(least, ink_at(ink, pixel[0], pixel[1]));
  }
  return least;
}

// The box shows its front, its top and its left side: three creases meet at the nearest upper corner; its feet on the floor
// are creases as well, and nothing is on its faces.
static void test_box(void **state) {
  static const int ends[5][2][3] = {{{0, 1, 1}, {1, 1, 1}},
                                    {{0, 1, 1}, {0, 0, 1}},
                                    {{0, 1, 1}, {0, 1, 0}},
                                    {{0, 0, 1}, {1, 0, 1}},
                                    {{0, 0, 1}, {0, 0, 0}}};
  double *ink = draw_scene(*state, &box_on_floor, (OutlineShape){2, CREASE});
  for (int i = 0; i < 5; ++i) {
    const double least = least_ink_along(ink, ends[i][0], ends[i][1]);
    printf("edge %d: %.2f\n", i, least);
    assert_true(least > 0.5);
  }
  for (double u = 0.15; u < 0.9; u += 0.05) {
    for (double v = 0.15; v < 0.9; v += 0.05) {
      const double(*box)[3] = box_on_floor.box;
      const double front[3] = {box[0][0] + u * (box[1][0] - box[0][0]), box[0][1] + v * (box[1][1] - box[0][1]),
                               box[1][2]};
      double pixel[2];
      project(&box_on_floor, front, pixel);
      assert_true(ink_at(ink, pixel[0], pixel[1]) == 0);
    }
  }
  free(ink);
}

// Neither a floor up to its horizon nor the sky alone, from low and from high, has a line.
static void test_floor_and_sky(void **state) {
  for (int i = 0; i < 12; ++i) {
    const Scene scene = {.floor = i == 0 ? 0 : 0.02 * pow(2.3, i), .pitch = 0.037 * i - 0.1};
    for (double width = 1; width < 16; width += 6) {
      double *ink = draw_scene(*state, &scene, (OutlineShape){width, CREASE});
      if (sum_of(ink) > 0)
        fail_msg("floor %g below, pitch %g: %g pixels of ink", scene.floor, scene.pitch, sum_of(ink));
      free(ink);
    }
  }
}

// A wall without end across the whole picture, slanted: its borders are the picture's, which are no lines.
static void test_borders(void **state) {
  const Scene wall = {.box = {{-90, -90, -12}, {90, 90, -4}}, .pitch = 0.3};
  double *ink = draw_scene(*state, &wall, (OutlineShape){4, CREASE});
  assert_true(sum_of(ink) == 0);
  free(ink);
}

// Where normals are given, they tell creases: here of a wall that is flat by its depth.
static void test_given_normals(void **state) {
  float *surface = calloc(4 * PIXELS, sizeof *surface);
  for (size_t i = 0; i < PIXELS; ++i) {
    const float turn = i % WIDTH < WIDTH / 2 ? 0 : 1; // radians
    const float texel[4] = {sinf(turn), 0, cosf(turn), 3};
    memcpy(surface + 4 * i, texel, sizeof texel);
  }
  double *with = draw(*state, surface, true, (OutlineShape){2, CREASE});
  double *without = draw(*state, surface, false, (OutlineShape){2, CREASE});
  double *smooth = draw(*state, surface, true, (OutlineShape){2, 0.5});
  assert_true(ink_at(with, WIDTH / 2, HEIGHT / 2) > 0.9);
  assert_true(fabs(sum_of(with) - 2 * HEIGHT) < 1);
  assert_true(sum_of(without) == 0 && sum_of(smooth) == 0);
  free(with);
  free(without);
  free(smooth);
  free(surface);
}

static void compare_with_twin(Bench *b, const Scene *scene, double width) {
  const OutlineShape shape = {width, CREASE};
  float *depth = malloc(PIXELS * sizeof *depth);
  make_depths(scene, depth);
  double *ink = draw_scene(b, scene, shape), *twin = outlines_drawn(&lens, depth, shape);
  double worst = 0, sum = 0;
  int differ = 0;
  for (size_t i = 0; i < PIXELS; ++i) {
    worst = fmax(worst, fabs(ink[i] - twin[i]));
    sum += fabs(ink[i] - twin[i]);
    differ += fabs(ink[i] - twin[i]) > 0.1;
  }
  printf("width %g: %.4f of the ink differs; %d pixels by more than 0.1, the worst by %.2f\n", width,
         sum / sum_of(twin), differ, worst);
  assert_true(sum_of(twin) > 100);
  assert_true(sum <= 0.02 * sum_of(twin) && differ <= 0.06 * sum_of(twin)); // rows choose once for all of a column
  free(depth);
  free(ink);
  free(twin);
}

static void test_twin(void **state) {
  static const double widths[] = {1, 2.5, 7};
  for (int i = 0; i < 3; ++i) {
    compare_with_twin(*state, &ball_over_floor, widths[i]);
    compare_with_twin(*state, &box_on_floor, widths[i]);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_ball),          cmocka_unit_test(test_faint_lines), cmocka_unit_test(test_box),
      cmocka_unit_test(test_floor_and_sky), cmocka_unit_test(test_borders),     cmocka_unit_test(test_given_normals),
      cmocka_unit_test(test_twin),
  };
  return cmocka_run_group_tests_name("outlines", tests, open_bench, close_bench);
}
