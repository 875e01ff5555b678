// The style "refraction" against computed truth, in the pinned environment: balls of water and a drop before a pool
// against the reference ray tracer, flat water against slab.c. Errors are in 1/255, of a pixel the mean of its three
// channels, without two pixels at the rim.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sim/sim.h"
#include "tests/reference/reference.h"
#include "tests/render/harness.h"
#include "tests/render/slab.h"

#define PI 3.14159265358979323846
#define WIDTH 320
#define HEIGHT 240
#define PIXELS (WIDTH * HEIGHT)
#define RIM 2

// What is asked for, in 1/255.
#define MEDIAN 2.0
#define NEARLY_ALL 8.0

static Harness harness;

static int open_harness(void **state) {
  (void)state;
  harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  return 0;
}

static int close_harness(void **state) {
  (void)state;
  harness_close(&harness);
  return 0;
}

// ---- Water -----------------------------------------------------------------------------------------------------------

typedef struct Water {
  TestFrame *particles;
  float *radius;
  uint8_t *classes;
  SimFrameBuffer *buffer;
  SimFrame frame; // after water_ready
  RenderSettings settings;
  RenderView view;
} Water;

static Water water_create(int32_t capacity, double particle_radius) {
  Water water = {.particles = test_frame_create(capacity, (float)particle_radius),
                 .radius = calloc((size_t)capacity, sizeof(float)),
                 .classes = calloc((size_t)capacity, 1),
                 .buffer = sim_frame_buffer_create(),
                 .settings = harness_pinned_settings()};
  water.settings.style = "refraction";
  return water;
}

static void water_add(Water *water, const double p[3], SimClass class, double radius) {
  const int32_t i = water->particles->frame.count;
  water->radius[i] = (float)radius;
  water->classes[i] = (uint8_t) class;
  test_frame_add(water->particles, (float)p[0], (float)p[1], (float)p[2]);
}

static void water_ready(Water *water, const SimContainer *container) {
  const SimParticleSet set = {.count = water->particles->frame.count,
                              .position = water->particles->position,
                              .particle_radius = water->particles->frame.particle_radius,
                              .radius = water->radius,
                              .particle_class = water->classes,
                              .container = container};
  SimError error;
  const SimFrame *frame = sim_frame_from_particles(&set, SIM_NEED_ALL, 1, water->buffer, &error);
  if (frame == NULL) fail_msg("%s", error.message);
  water->frame = *frame;
}

static void water_destroy(Water *water) {
  sim_frame_buffer_destroy(water->buffer);
  test_frame_destroy(water->particles);
  free(water->radius);
  free(water->classes);
}

// ---- Errors ----------------------------------------------------------------------------------------------------------

typedef struct Errors {
  double mean, median, high; // high: the 95th percentile
  int pixels;
} Errors;

static int by_size(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static Errors errors_of(const uint8_t *rgb, const float *truth, const uint8_t *mask) {
  static double error[PIXELS];
  Errors errors = {0};
  for (int i = 0; i < PIXELS; ++i) {
    if (!mask[i]) continue;
    double sum = 0;
    for (int k = 3 * i; k < 3 * i + 3; ++k) sum += fabs(rgb[k] - 255 * fmin(fmax((double)truth[k], 0), 1));
    error[errors.pixels++] = sum / 3;
    errors.mean += sum / 3;
  }
  if (errors.pixels == 0) fail_msg("no pixel to compare");
  qsort(error, (size_t)errors.pixels, sizeof *error, by_size);
  errors.mean /= errors.pixels;
  errors.median = error[errors.pixels / 2];
  errors.high = error[errors.pixels * 95 / 100];
  return errors;
}

static void tell(const char *what, Errors e) {
  print_message("%-44s mean %6.2f  median %6.2f  95 %% %6.2f  of %5d pixels\n", what, e.mean, e.median, e.high,
                e.pixels);
}

static void check(const char *what, Errors e) {
  tell(what, e);
  if (e.median > MEDIAN || e.high > NEARLY_ALL) fail_msg("%s: median %.2f, 95 %% %.2f", what, e.median, e.high);
}

// Leave out pixels within RIM of one that is not of the same kind; kind 0 is left out.
static void inner_pixels(const int32_t *kind, uint8_t *mask) {
  for (int y = 0; y < HEIGHT; ++y) {
    for (int x = 0; x < WIDTH; ++x) {
      bool same = kind[y * WIDTH + x] != 0;
      for (int v = y - RIM; v <= y + RIM; ++v) {
        for (int u = x - RIM; u <= x + RIM; ++u) {
          if (u < 0 || v < 0 || u >= WIDTH || v >= HEIGHT) continue;
          same = same && kind[v * WIDTH + u] == kind[y * WIDTH + x];
        }
      }
      mask[y * WIDTH + x] = same;
    }
  }
}

static Errors draw_errors(const Water *water, const float *truth, const uint8_t *mask) {
  uint8_t *rgb = harness_draw(&harness, &water->frame, &water->view, &water->settings);
  const Errors errors = errors_of(rgb, truth, mask);
  free(rgb);
  return errors;
}

// ---- Against the reference -------------------------------------------------------------------------------------------

typedef struct Traced {
  float light[3 * PIXELS];
  float chain[3 * PIXELS]; // four refractions, as in the paper
  uint8_t covered[PIXELS], inner[PIXELS];
} Traced;

static Traced *trace(const Water *water) {
  Traced *traced = malloc(sizeof *traced);
  assert_non_null(traced);
  Reference *reference = reference_create(&water->frame, &water->settings);
  assert_non_null(reference);
  reference_trace(reference, &water->view, WIDTH, HEIGHT, 0, traced->light);
  reference_trace_chain(reference, &water->view, WIDTH, HEIGHT, 4, traced->chain);
  reference_cover(reference, &water->view, WIDTH, HEIGHT, traced->covered);
  reference_destroy(reference);
  static int32_t kind[PIXELS];
  for (int i = 0; i < PIXELS; ++i) kind[i] = traced->covered[i];
  inner_pixels(kind, traced->inner);
  return traced;
}

// ---- Balls -----------------------------------------------------------------------------------------------------------

typedef struct Balls {
  const char *what;
  int count;
  double centre[3][3], radius[3];
  float eye[3], target[3];
  bool clear; // nothing is absorbed
} Balls;

static const Balls one_ball = {"one ball", 1, {{0.1, 0.6, 0.05}}, {0.3}, {0, 0.8f, 2}, {0.1f, 0.6f, 0}, true};
static const Balls in_line = {
    "two balls in line", 2, {{0, 0.62, 0}, {0.05, 0.5, -0.8}}, {0.25, 0.25}, {-0.1f, 0.75f, 1.6f}, {0, 0.6f, 0}, false};
static const Balls half_hidden = {"two balls, one half hidden",
                                  2,
                                  {{-0.1, 0.62, 0}, {0.22, 0.5, -0.5}},
                                  {0.2, 0.25},
                                  {-0.1f, 0.75f, 1.6f},
                                  {0.05f, 0.55f, 0},
                                  false};
static const Balls overlapping = {"two balls that overlap",
                                  2,
                                  {{-0.12, 0.6, 0.1}, {0.14, 0.65, -0.05}},
                                  {0.25, 0.22},
                                  {0.2f, 0.9f, 2},
                                  {0, 0.6f, 0},
                                  false};

static Water balls_create(const Balls *balls) {
  Water water = water_create(balls->count, balls->radius[0]);
  for (int i = 0; i < balls->count; ++i) water_add(&water, balls->centre[i], SIM_SPLASH, balls->radius[i]);
  water_ready(&water, NULL);
  water.settings.tile_size = 0.25f;
  if (balls->clear) memset(water.settings.absorption, 0, sizeof water.settings.absorption);
  memcpy(water.view.eye, balls->eye, sizeof balls->eye);
  memcpy(water.view.target, balls->target, sizeof balls->target);
  water.view.vertical_fov = 38;
  return water;
}

static void check_balls(const Balls *balls) {
  Water water = balls_create(balls);
  Traced *traced = trace(&water);
  tell("  against the chain of four", draw_errors(&water, traced->chain, traced->inner));
  check(balls->what, draw_errors(&water, traced->light, traced->inner));
  free(traced);
  water_destroy(&water);
}

static void test_one_ball(void **state) {
  (void)state;
  check_balls(&one_ball);
}

static void test_one_ball_that_absorbs(void **state) {
  (void)state;
  Balls balls = one_ball;
  balls.what = "one ball, absorbing";
  balls.clear = false;
  check_balls(&balls);
}

static void test_ball_off_centre(void **state) {
  (void)state;
  check_balls(&(Balls){
      "one ball near the picture's corner", 1, {{-0.6, 0.9, 0.1}}, {0.25}, {0, 0.9f, 2}, {0.1f, 0.6f, 0}, false});
}

static void test_ball_from_above(void **state) {
  (void)state;
  check_balls(
      &(Balls){"one ball seen from above", 1, {{0.02, 0.5, 0.01}}, {0.3}, {0.3f, 2.2f, 0.4f}, {0, 0.4f, 0}, false});
}

static void test_balls_in_line(void **state) {
  (void)state;
  check_balls(&in_line);
}

static void test_balls_that_overlap(void **state) {
  (void)state;
  check_balls(&overlapping);
}

static void test_more_refractions_are_better(void **state) {
  (void)state;
  static const int32_t counts[] = {1, 2, 4};
  Water water = balls_create(&half_hidden);
  Traced *traced = trace(&water);
  double last = INFINITY;
  for (int i = 0; i < 3; ++i) {
    char what[64];
    snprintf(what, sizeof what, "one ball half behind another, count %d", counts[i]);
    water.settings.refraction.count = counts[i];
    const Errors errors = draw_errors(&water, traced->light, traced->inner);
    tell(what, errors);
    assert_true(errors.mean < 0.6 * last);
    last = errors.mean;
  }
  free(traced);
  water_destroy(&water);
}

// ---- Flat water ------------------------------------------------------------------------------------------------------

// A lattice of particles from the floor to a level half a spacing above its highest centres.
typedef struct Layer {
  int size[3]; // particles
  double radius, tile;
  bool contained;
} Layer;

static void add_lattice(Water *water, const Layer *layer) {
  const double d = 2 * layer->radius;
  for (int k = 0; k < layer->size[2]; ++k) {
    for (int j = 0; j < layer->size[1]; ++j) {
      for (int i = 0; i < layer->size[0]; ++i) {
        const double p[3] = {(i + 0.5) * d, (j + 0.5) * d, (k + 0.5) * d};
        water_add(water, p, SIM_AGGREGATED, layer->radius);
      }
    }
  }
}

static Water layer_create(const Layer *layer, int32_t room) {
  Water water = water_create(layer->size[0] * layer->size[1] * layer->size[2] + room, layer->radius);
  add_lattice(&water, layer);
  water.settings.tile_size = (float)layer->tile;
  return water;
}

static void layer_ready(Water *water, const Layer *layer) {
  const double d = 2 * layer->radius;
  const SimContainer container = {
      {0, 0, 0}, {(float)(d * layer->size[0]), (float)(d * layer->size[1] + 0.5), (float)(d * layer->size[2])}};
  water_ready(water, layer->contained ? &container : NULL);
}

// The truth of all pixels whose path comes no nearer to the sides than `margin`, and which these are.
static void slab_truth(const Water *water, const Layer *layer, double margin, int only, float *truth, uint8_t *mask) {
  const double d = 2 * layer->radius;
  const Slab slab = {{0, 0, 0}, {d * layer->size[0], d * layer->size[1], d * layer->size[2]}, &water->settings};
  static int32_t way[PIXELS];
  for (int i = 0; i < PIXELS; ++i) {
    const Ray ray = harness_ray(&water->view, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
    const SlabPixel pixel = slab_look(&slab, &ray);
    for (int k = 0; k < 3; ++k) truth[3 * i + k] = (float)pixel.light[k];
    way[i] = pixel.margin >= margin && (only == 0 || pixel.way == only) ? pixel.way : 0;
  }
  inner_pixels(way, mask);
}

// `way`: only pixels whose path has met these surfaces; 0: all.
static void check_layer(const char *what, const Layer *layer, const RenderView *view, double margin, int way) {
  static float truth[3 * PIXELS];
  static uint8_t mask[PIXELS];
  Water water = layer_create(layer, 0);
  layer_ready(&water, layer);
  water.view = *view;
  slab_truth(&water, layer, margin, way, truth, mask);
  check(what, draw_errors(&water, truth, mask));
  water_destroy(&water);
}

static const Layer wide = {{70, 4, 70}, 0.02, 0.5, false};

// The eye looks at the middle of the layer, at this angle from the vertical.
static RenderView slanted(const Layer *layer, double degrees) {
  const double a = degrees * PI / 180, far = 2, d = 2 * layer->radius;
  const double x = d * layer->size[0] / 2, y = d * layer->size[1], z = d * layer->size[2] / 2;
  return harness_view((float)(x + 0.3 * far * sin(a)), (float)(y + far * cos(a)), (float)(z + 0.954 * far * sin(a)),
                      (float)x, (float)y, (float)z, 24);
}

static void check_layer_from_above(bool contained) {
  // Of the level's error a flat view shows more than a steep one: 0.1 r moves the floor by 0.01, 0.04 and 0.18 r.
  static const int angles[] = {20, 45, 70};
  static const double tiles[] = {0.05, 0.15, 0.5};
  for (int i = 0; i < 3; ++i) {
    Layer layer = wide;
    layer.contained = contained;
    layer.tile = tiles[i];
    const RenderView view = slanted(&layer, angles[i]);
    char what[64];
    snprintf(what, sizeof what, "%s, %d degrees from above", contained ? "pool" : "layer", angles[i]);
    check_layer(what, &layer, &view, 4 * layer.radius, 0);
  }
}

static void test_layer(void **state) {
  (void)state;
  check_layer_from_above(false);
}

static void test_pool_from_above(void **state) {
  (void)state;
  check_layer_from_above(true);
}

static void test_pool_through_its_side(void **state) {
  (void)state;
  const Layer layer = {{50, 16, 40}, 0.02, 0.3, true};
  const RenderView side = harness_view(0.9f, 0.75f, 3.6f, 1, 0.33f, 1.6f, 12);
  const RenderView corner = harness_view(2.6f, 1.1f, 3.1f, 1.6f, 0.4f, 1.3f, 24);
  check_layer("pool, through its side", &layer, &side, 0, 0);
  check_layer("pool, over a corner", &layer, &corner, 0, 0);
  // Rays that the far end mirrors, as nothing gets through there.
  const Layer tank = {{100, 24, 30}, 0.02, 0.5, true};
  const RenderView along = harness_view(2.2f, 1.1f, 3.6f, 3.4f, 0.4f, 1.0f, 30);
  check_layer("tank, towards its far end", &tank, &along, 0, 0);
}

// ---- From within -----------------------------------------------------------------------------------------------------

static void test_total_reflection(void **state) {
  (void)state;
  const Layer layer = {{75, 15, 50}, 0.02, 0.5, true};
  const RenderView view = harness_view(0.4f, 0.2f, 1.3f, 1.1f, 0.61f, 0.9f, 34);
  const int top_then_floor = 8 * (SLAB_FLOOR + 1) + SLAB_TOP + 1;
  check_layer("below the surface, beyond the critical angle", &layer, &view, 0, top_then_floor);
}

// Where a surface is torn, single pixels see other things than those around them.
enum { WINDOW = 5, WINDOW_PIXELS = WINDOW * WINDOW };

static int neighbour(int x, int y, int k) {
  return (y + k / WINDOW - WINDOW / 2) * WIDTH + x + k % WINDOW - WINDOW / 2;
}

// How far a pixel is from the median of its neighbourhood, the mean of its channels.
static double from_median(const double *rgb, int x, int y) {
  double sum = 0;
  for (int channel = 0; channel < 3; ++channel) {
    double around[WINDOW_PIXELS];
    for (int k = 0; k < WINDOW_PIXELS; ++k) around[k] = rgb[3 * neighbour(x, y, k) + channel];
    qsort(around, WINDOW_PIXELS, sizeof *around, by_size);
    sum += fabs(rgb[3 * (y * WIDTH + x) + channel] - around[WINDOW_PIXELS / 2]);
  }
  return sum / 3;
}

// How many pixels of the neighbourhood look like the middle one, which is one of them.
static int of_its_kind(const double *rgb, int x, int y) {
  int count = 0;
  for (int k = 0; k < WINDOW_PIXELS; ++k) {
    double sum = 0;
    for (int channel = 0; channel < 3; ++channel)
      sum += fabs(rgb[3 * neighbour(x, y, k) + channel] - rgb[3 * (y * WIDTH + x) + channel]);
    count += sum / 3 < 6;
  }
  return count;
}

// `kin`: only those of which a neighbourhood has no more.
static int count_specks(const double *rgb, int kin) {
  int specks = 0;
  for (int y = WINDOW / 2; y < HEIGHT - WINDOW / 2; ++y)
    for (int x = WINDOW / 2; x < WIDTH - WINDOW / 2; ++x)
      specks += from_median(rgb, x, y) > 12 && of_its_kind(rgb, x, y) <= kin;
  return specks;
}

static int specks_of_picture(const Water *water, int kin) {
  static double light[3 * PIXELS];
  uint8_t *rgb = harness_draw(&harness, &water->frame, &water->view, &water->settings);
  for (int i = 0; i < 3 * PIXELS; ++i) light[i] = rgb[i];
  free(rgb);
  return count_specks(light, kin);
}

// Along a tank, and up to its surface.
static const RenderView in_tank[2] = {{{0.3f, 0.15f, 0.5f}, {2, 0.3f, 0.55f}, 50},
                                      {{0.6f, 0.12f, 0.7f}, {1, 0.4f, 0.5f}, 60}};

// Of flat water there is a truth, with few edges where there is no floor.
static void test_no_specks_in_a_flat_pool(void **state) {
  (void)state;
  static double light[3 * PIXELS];
  const Layer layer = {{60, 11, 30}, 0.0175, 0.5, true};
  const double d = 2 * layer.radius;
  Water water = layer_create(&layer, 0);
  layer_ready(&water, &layer);
  water.settings.floor = RENDER_FLOOR_NONE;
  const Slab slab = {{0, 0, 0}, {d * layer.size[0], d * layer.size[1], d * layer.size[2]}, &water.settings};
  int specks[2], of_truth[2];
  for (int v = 0; v < 2; ++v) {
    water.view = in_tank[v];
    for (int i = 0; i < PIXELS; ++i) {
      const Ray ray = harness_ray(&water.view, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
      const SlabPixel pixel = slab_look(&slab, &ray);
      for (int k = 0; k < 3; ++k) light[3 * i + k] = 255 * fmin(fmax(pixel.light[k], 0), 1);
    }
    of_truth[v] = count_specks(light, WINDOW_PIXELS);
    specks[v] = specks_of_picture(&water, WINDOW_PIXELS);
    print_message("flat pool, %s: %d specks, in truth %d\n", v == 0 ? "along" : "up", specks[v], of_truth[v]);
  }
  water_destroy(&water);
  for (int v = 0; v < 2; ++v) assert_true(specks[v] <= of_truth[v] + PIXELS / 1000);
}

// A pool with waves in a tank, over no floor.
static Water wavy_pool(void) {
  const double radius = 0.0175, d = 2 * radius;
  const SimContainer tank = {{0, 0, 0}, {2.1f, 1, 1.05f}, SIM_CONTAINER_BOX};
  Water water = water_create(60 * 30 * 16, radius);
  for (double z = radius; z < 1.05; z += d) {
    for (double x = radius; x < 2.1; x += d) {
      const double top = 0.4 + 0.05 * sin(4.2 * x + 0.6) * cos(2.1 * z) + 0.02 * sin(9 * x + 5 * z);
      for (double y = top - radius; y > 0; y -= d) {
        const double wave[3] = {sin(91 * y + 37 * z), sin(57 * x + 83 * z), sin(71 * x + 47 * y)};
        water_add(&water, (double[]){x + 0.2 * d * wave[0], y + 0.2 * d * wave[1], z + 0.2 * d * wave[2]},
                  SIM_AGGREGATED, radius);
      }
    }
  }
  water_ready(&water, &tank);
  water.settings.floor = RENDER_FLOOR_NONE;
  return water;
}

// The mesh of the reference is bumpy, and mirrored again and again its picture is all specks. But a smooth surface has no
// edges as short as to be seen in three pixels.
static void test_no_specks_under_waves(void **state) {
  (void)state;
  Water water = wavy_pool();
  int specks[2];
  for (int v = 0; v < 2; ++v) {
    water.view = in_tank[v];
    specks[v] = specks_of_picture(&water, 3);
    print_message("waves, %s: %d lonely specks\n", v == 0 ? "along" : "up", specks[v]);
  }
  water_destroy(&water);
  for (int v = 0; v < 2; ++v) assert_true(specks[v] <= PIXELS / 1000);
}

// ---- A drop before a pool --------------------------------------------------------------------------------------------

// A drop closely above a pool that fills the picture.
static const float drop_centre[3] = {1, 0.42f, 1.2f};
#define DROP_RADIUS 0.12

static Water drop_before_pool(void) {
  const Layer layer = {{50, 6, 50}, 0.02, 0.4, true};
  Water water = layer_create(&layer, 1);
  water_add(&water, (double[]){(double)drop_centre[0], (double)drop_centre[1], (double)drop_centre[2]}, SIM_SPLASH,
            DROP_RADIUS);
  layer_ready(&water, &layer);
  water.view = harness_view(1.1f, 1.2f, 2, 1, 0.35f, 1.15f, 38);
  return water;
}

// 1 where the eye sees the drop; returns how many pixels that are.
static int find_drop(const Water *water, int32_t *on_drop) {
  int count = 0;
  for (int i = 0; i < PIXELS; ++i) {
    const Ray ray = harness_ray(&water->view, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
    double t[2], margin;
    on_drop[i] = harness_ray_sphere(&ray, drop_centre, DROP_RADIUS, t, &margin);
    count += on_drop[i];
  }
  return count;
}

// Problem 1 of the paper: on one map with the pool's the drop has no back of its own.
static void test_drop_before_pool(void **state) {
  (void)state;
  static int32_t on_drop[PIXELS];
  static uint8_t mask[PIXELS];
  Water water = drop_before_pool();
  find_drop(&water, on_drop);
  inner_pixels(on_drop, mask);
  Traced *traced = trace(&water);
  tell("  against the chain of four", draw_errors(&water, traced->chain, mask));
  const Errors apart = draw_errors(&water, traced->light, mask);
  water.settings.refraction.splashes_apart = false;
  const Errors together = draw_errors(&water, traced->light, mask);
  tell("the same, splashes not apart", together);
  check("a drop before a pool", apart);
  assert_true(together.mean > 5 * apart.mean);
  free(traced);
  water_destroy(&water);
}

// ---- Figures ---------------------------------------------------------------------------------------------------------

enum { ORDERS = 6 };
static const char *const orders[ORDERS] = {"splash",     "splash_splash",     "splash_aggregated",
                                           "aggregated", "aggregated_splash", "aggregated_aggregated"};

// The shares of the last picture, in the order of `orders`; returns their sum.
static double shares_of(const Water *water, double share[ORDERS]) {
  free(harness_draw(&harness, &water->frame, &water->view, &water->settings));
  RenderFigure figures[ORDERS];
  double sum = 0;
  assert_int_equal(render_figures(harness.render, figures, ORDERS), ORDERS);
  for (int k = 0; k < ORDERS; ++k) {
    assert_string_equal(figures[k].name, orders[k]);
    assert_true(figures[k].value >= 0 && figures[k].value <= 1);
    share[k] = figures[k].value;
    sum += share[k];
  }
  return sum;
}

// How many of a layer's pixels have the value.
static int count_equal(const float *layer, float value) {
  int count = 0;
  for (int i = 0; i < PIXELS; ++i) count += layer[i] == value;
  return count;
}

// A drop above a pool that fills the picture: rays go through the drop and then the pool, through the drop into the open,
// or through the pool alone, and nothing else is there.
static void test_figures(void **state) {
  (void)state;
  static int32_t on_drop[PIXELS];
  double share[ORDERS];
  Water water = drop_before_pool();
  const int of_drop = find_drop(&water, on_drop);
  assert_float_equal(shares_of(&water, share), 1, 1e-9);
  float *order = harness_layer(&harness, "order", 1, &water.frame, &water.view, &water.settings);
  const int dry = count_equal(order, 0);
  for (int k = 0; k < ORDERS; ++k) {
    print_message("%-22s %7.4f\n", orders[k], share[k]);
    assert_float_equal(share[k], (double)count_equal(order, (float)(k + 1)) / (PIXELS - dry), 1e-9);
  }
  free(order);
  assert_float_equal(share[0] + share[2], (double)of_drop / (PIXELS - dry), 1e-4);
  assert_true(share[2] > 5 * share[0]); // downwards from nearly everywhere
  assert_true(share[1] == 0 && share[4] == 0 && share[5] == 0);
  // Of one kind only.
  water.settings.refraction.splashes_apart = false;
  assert_float_equal(shares_of(&water, share), 1, 1e-9);
  assert_true(share[3] + share[5] == 1);
  water_destroy(&water);
}

static void test_figures_without_water(void **state) {
  (void)state;
  double share[ORDERS];
  Water water = drop_before_pool();
  water.view = harness_view(0, 1, 3, 0, 1.5f, 5, 38); // away from it
  assert_true(shares_of(&water, share) == 0);
  water.frame.count = 0;
  assert_true(shares_of(&water, share) == 0);
  water_destroy(&water);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_one_ball),
      cmocka_unit_test(test_one_ball_that_absorbs),
      cmocka_unit_test(test_ball_off_centre),
      cmocka_unit_test(test_ball_from_above),
      cmocka_unit_test(test_balls_in_line),
      cmocka_unit_test(test_balls_that_overlap),
      cmocka_unit_test(test_more_refractions_are_better),
      cmocka_unit_test(test_layer),
      cmocka_unit_test(test_pool_from_above),
      cmocka_unit_test(test_pool_through_its_side),
      cmocka_unit_test(test_total_reflection),
      cmocka_unit_test(test_no_specks_in_a_flat_pool),
      cmocka_unit_test(test_no_specks_under_waves),
      cmocka_unit_test(test_drop_before_pool),
      cmocka_unit_test(test_figures),
      cmocka_unit_test(test_figures_without_water),
  };
  return cmocka_run_group_tests(tests, open_harness, close_harness);
}
