// Frames that nobody checked: whatever is in them, the picture is clean and GL has nothing to say.
#include "tests/render/harness.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 96
#define HEIGHT 64

static const RenderView front = {{1.5f, 1, 4}, {1.5f, 0.5f, 0.5f}, 38};

static uint8_t *draw_default(Harness *harness, const TestFrame *t, const RenderView *view) {
  const RenderSettings settings = render_default_settings();
  uint8_t *rgb = harness_draw(harness, &t->frame, view, &settings);
  assert_int_equal(render_gl_error_count(harness->render), 0);
  return rgb;
}

// A depth or normal that is not a number would be seen here: no layer may hold one.
static void assert_layers_finite(Harness *harness, const TestFrame *t, const RenderView *view) {
  const RenderSettings settings = render_default_settings();
  for (int32_t i = 0; i < render_layer_count("points"); ++i) {
    assert_true(render_show_layer(harness->render, render_layer_name("points", i)));
    free(harness_draw(harness, &t->frame, view, &settings));
    int32_t channels;
    assert_true(render_read_layer(harness->render, NULL, &channels));
    const size_t count = (size_t)channels * WIDTH * HEIGHT;
    float *values = malloc(count * sizeof *values);
    assert_true(render_read_layer(harness->render, values, &channels));
    for (size_t k = 0; k < count; ++k) {
      if (!isfinite(values[k])) fail_msg("layer %s holds %g", render_layer_name("points", i), (double)values[k]);
    }
    free(values);
  }
  assert_true(render_show_layer(harness->render, NULL));
}

// A pixel of NaN comes out black; nothing in the default scene is.
static int black_pixels(const uint8_t *rgb) {
  int black = 0;
  for (int i = 0; i < WIDTH * HEIGHT; ++i) black += rgb[3 * i] < 8 && rgb[3 * i + 1] < 8 && rgb[3 * i + 2] < 8;
  return black;
}

static void expect_refusal(Harness *harness, const SimFrame *frame, const RenderView *view,
                           const RenderSettings *settings, const char *mention) {
  RenderError error = {0};
  assert_false(render_draw(harness->render, frame, view, settings, &error));
  if (strstr(error.message, mention) == NULL) fail_msg("\"%s\" does not mention \"%s\"", error.message, mention);
}

static void test_empty_frame_is_the_background(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  TestFrame *t = test_frame_create(4, 0.1f);
  RenderSettings settings = render_default_settings();
  settings.tone_map = RENDER_TONE_NONE;
  settings.container_visible = false;
  uint8_t *empty = harness_draw(&harness, &t->frame, &front, &settings);
  float *background = harness_layer(&harness, "background", 3, &t->frame, &front, &settings);
  for (int i = 0; i < 3 * WIDTH * HEIGHT; ++i) {
    const float clamped = fminf(fmaxf(background[i], 0), 1);
    assert_true(fabsf((float)empty[i] - 255 * clamped) < 1.1f);
  }
  // Particles that are all invalid are none.
  test_frame_add(t, NAN, 0, 0);
  test_frame_add(t, 0, INFINITY, 0);
  test_frame_add(t, 0, 0, -1e30f);
  uint8_t *invalid = harness_draw(&harness, &t->frame, &front, &settings);
  assert_memory_equal(empty, invalid, 3 * WIDTH * HEIGHT);
  free(empty);
  free(background);
  free(invalid);
  test_frame_destroy(t);
  harness_close(&harness);
}

static void test_invalid_particles_are_skipped(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  TestFrame *clean = test_frame_create(40, 0.1f), *dirty = test_frame_create(80, 0.1f);
  const float bad[] = {NAN, INFINITY, -INFINITY, FLT_MAX, -FLT_MAX, 2e6f};
  for (int i = 0; i < 36; ++i) {
    const float x = 0.5f + 0.05f * (float)i, y = 0.3f + 0.1f * (float)(i % 4);
    test_frame_add(clean, x, y, 0.5f);
    test_frame_add(dirty, x, y, 0.5f);
    const float b = bad[i % 6];
    test_frame_add(dirty, i % 3 == 0 ? b : 1, i % 3 == 1 ? b : 1, i % 3 == 2 ? b : 1);
  }
  uint8_t *a = draw_default(&harness, clean, &front), *b = draw_default(&harness, dirty, &front);
  assert_memory_equal(a, b, 3 * WIDTH * HEIGHT);
  free(a);
  free(b);
  test_frame_destroy(clean);
  test_frame_destroy(dirty);
  harness_close(&harness);
}

static void test_bad_attributes_do_no_harm(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  TestFrame *t = test_frame_create(8, 0.1f);
  float radius[8], colour[24];
  const float bad[8] = {NAN, INFINITY, -1, 0, FLT_MAX, FLT_MIN, 1e-20f, 0.1f};
  for (int i = 0; i < 8; ++i) {
    test_frame_add(t, 0.4f + 0.3f * (float)i, 0.5f, 0.5f);
    radius[i] = bad[i];
    t->density[i] = bad[7 - i];
    for (int k = 0; k < 3; ++k) {
      colour[3 * i + k] = bad[(i + k) % 8];
      t->velocity[3 * i + k] = bad[(i + 2 * k) % 8];
    }
  }
  t->frame.radius = radius;
  t->frame.colour = colour;
  free(draw_default(&harness, t, &front));
  assert_layers_finite(&harness, t, &front);
  // And without any of the arrays that may be missing.
  t->frame.radius = NULL;
  t->frame.colour = NULL;
  t->frame.velocity = NULL;
  t->frame.density = NULL;
  t->frame.id = NULL;
  free(draw_default(&harness, t, &front));
  t->frame.particle_radius = NAN;
  free(draw_default(&harness, t, &front));
  test_frame_destroy(t);
  harness_close(&harness);
}

static void test_camera_in_the_water(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  TestFrame *t = test_frame_pool();
  const RenderView views[] = {
      {{1.5f, 0.1f, 0.5f}, {2.5f, 0.15f, 0.5f}, 70},                                    // deep inside
      {{t->position[0], t->position[1], t->position[2]}, {1, 0.2f, 0.5f}, 100},         // at the centre of a particle
      {{t->position[0] + 0.0218f, t->position[1], t->position[2]}, {-5, 1, 0.5f}, 160}, // just under its skin
      {{1.5f, 0.5f, -3}, {1.5f, 0.5f, -9}, 38},                                         // the water behind the eye
      {{1.5f, 5, 0.5f}, {1.5f, 0, 0.5f}, 38},                                           // straight down
      {{1.5f, -2, 0.5f}, {1.5f, 0, 0.5f}, 38},                                          // straight up, under the floor
      {{1.5f, 0, 3}, {1.5f, 0, 0.5f}, 38},                                              // within the floor's plane
  };
  for (size_t i = 0; i < sizeof views / sizeof views[0]; ++i) {
    uint8_t *rgb = draw_default(&harness, t, &views[i]);
    assert_int_equal(black_pixels(rgb), 0);
    free(rgb);
    assert_layers_finite(&harness, t, &views[i]);
  }
  test_frame_destroy(t);
  harness_close(&harness);
}

static void test_extreme_sizes_of_things(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  const float scales[] = {1e-3f, 1e-2f, 1e2f, 1e4f};
  for (size_t s = 0; s < sizeof scales / sizeof scales[0]; ++s) {
    TestFrame *t = test_frame_create(32, 0.1f * scales[s]);
    for (int i = 0; i < 30; ++i) {
      test_frame_add(t, (0.5f + 0.07f * (float)i) * scales[s], 0.4f * scales[s], 0.5f * scales[s]);
    }
    for (int k = 0; k < 3; ++k) t->frame.container.max[k] *= scales[s];
    RenderView view = front;
    for (int k = 0; k < 3; ++k) {
      view.eye[k] *= scales[s];
      view.target[k] *= scales[s];
    }
    uint8_t *rgb = draw_default(&harness, t, &view);
    assert_int_equal(black_pixels(rgb), 0);
    assert_layers_finite(&harness, t, &view);
    free(rgb);
    test_frame_destroy(t);
  }
  harness_close(&harness);
}

static void test_absurd_containers_and_obstacles(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  TestFrame *t = test_frame_create(2, 0.1f);
  test_frame_add(t, 1, 0.5f, 0.5f);
  const SimContainer containers[] = {{{NAN, 0, 0}, {3, 1, 1}},        {{0, 0, 0}, {INFINITY, 1, 1}},
                                     {{0, 0, 0}, {0, 0, 0}},          {{3, 3, 3}, {0, 0, 0}},
                                     {{-1e30f, 0, 0}, {1e30f, 1, 1}}, {{0, 0, 0}, {1e-30f, 1e-30f, 1e-30f}}};
  for (size_t i = 0; i < sizeof containers / sizeof containers[0]; ++i) {
    t->frame.container = containers[i];
    free(draw_default(&harness, t, &front));
    assert_layers_finite(&harness, t, &front);
  }
  t->frame.container = (SimContainer){{0, 0, 0}, {3, 1.6f, 1}};
  const SimObstacle absurd[] = {
      {SIM_BOX, {NAN, 1, 1}, {1, 1, 1}, {0, 0, 0, 1}, {1, 1, 1}},
      {SIM_BOX, {1, 1, 1}, {INFINITY, 1, 1}, {0, 0, 0, 1}, {1, 1, 1}},
      {SIM_SPHERE, {-1, 0, 0}, {1, 1, 1}, {0, 0, 0, 1}, {1, 1, 1}},
      {SIM_CYLINDER, {0, 0, 0}, {1, 1, 1}, {0, 0, 0, 1}, {1, 1, 1}},
      {SIM_BOX, {1, 1, 1}, {1, 1, 1}, {0, 0, 0, 0}, {1, 1, 1}},
      {SIM_BOX, {1, 1, 1}, {1, 1, 1}, {NAN, 0, 0, 1}, {1, 1, 1}},
      {SIM_CAPSULE, {0, 1, 0}, {1, 1, 1}, {0, 0, 0, 1}, {1, 1, 1}},
      {SIM_CAPSULE, {1, NAN, 0}, {1, 1, 1}, {0, 0, 0, 1}, {1, 1, 1}, 0, NULL},
      {SIM_STAIRS, {1, 1, 1}, {1, 1, 1}, {0, 0, 0, 1}, {1, 1, 1}, 0, NULL},
      {SIM_STAIRS, {1, 1, 1}, {1, 1, 1}, {0, 0, 0, 1}, {1, 1, 1}, 1001, NULL},
      {SIM_STAIRS, {1, 1, 1}, {1, 1, 1}, {0, 0, 0, 1}, {1, 1, 1}, -5, NULL},
      {SIM_STAIRS, {1, 0, 1}, {1, 1, 1}, {0, 0, 0, 1}, {1, 1, 1}, 5, NULL},
      {(SimShape)-1, {1, 1, 1}, {1, 1, 1}, {0, 0, 0, 1}, {1, 1, 1}},
      {(SimShape)77, {1, 1, 1}, {1, 1, 1}, {0, 0, 0, 1}, {1, 1, 1}},
  };
  uint8_t *without = draw_default(&harness, t, &front);
  t->frame.obstacle_count = (int32_t)(sizeof absurd / sizeof absurd[0]);
  t->frame.obstacles = absurd;
  uint8_t *with = draw_default(&harness, t, &front);
  assert_memory_equal(without, with, 3 * WIDTH * HEIGHT);
  free(without);
  free(with);
  // The eye inside a body: it is not there.
  SimMesh *ring = test_mesh_torus(1, 0.5f, 24, 12);
  const SimObstacle around[] = {
      {SIM_SPHERE, {2, 0, 0}, {1.5f, 1, 4}, {0, 0, 0, 1}, {0, 0, 0}, 0, NULL},
      {SIM_CAPSULE, {2, 5, 0}, {1.5f, 1, 4}, {0, 0, 0, 1}, {0, 0, 0}, 0, NULL},
      {SIM_STAIRS, {2, 1, 2}, {1.5f, 1.3f, 4}, {0, 0, 0, 1}, {0, 0, 0}, 4, NULL},
      {SIM_MESH, {0}, {1.5f, 1, 5}, {0, 0, 0, 1}, {0, 0, 0}, 0, ring},
  };
  t->frame.obstacle_count = 1;
  for (size_t i = 0; i < sizeof around / sizeof around[0]; ++i) {
    t->frame.obstacles = &around[i];
    uint8_t *inside = draw_default(&harness, t, &front);
    if (black_pixels(inside) > 0) fail_msg("body %zu is seen from within", i);
    free(inside);
  }
  test_mesh_destroy(ring);
  test_frame_destroy(t);
  harness_close(&harness);
}

// A glass of no size, of no number, or around the eye, and a container of a shape that is none.
static void test_absurd_glasses(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  TestFrame *t = test_frame_create(2, 0.1f);
  test_frame_add(t, 1, 0.5f, 0.5f);
  const SimContainer glasses[] = {{{NAN, 0, 0}, {3, 1, 1}},        {{0, 0, 0}, {INFINITY, 1, 1}},
                                  {{0, 0, 0}, {0, 0, 0}},          {{3, 3, 3}, {0, 0, 0}},
                                  {{-1e30f, 0, 0}, {1e30f, 1, 1}}, {{0, 0, 0}, {1e-30f, 1e-30f, 1e-30f}},
                                  {{0, 0, 0}, {3, 0, 1}},          {{-20, -20, -20}, {20, 20, 20}},
                                  {{1, 0, 3.5f}, {2, 1, 4.5f}},    {{1.4f, 0.9f, 3.9f}, {1.6f, 1.1f, 4.1f}},
                                  {{1.5f, 0, 2}, {2.5f, 1, 6}}};
  for (size_t i = 0; i < sizeof glasses / sizeof glasses[0]; ++i) {
    t->frame.container = glasses[i];
    t->frame.container.shape = SIM_CONTAINER_GLASS;
    uint8_t *rgb = draw_default(&harness, t, &front);
    assert_int_equal(black_pixels(rgb), 0);
    free(rgb);
    assert_layers_finite(&harness, t, &front);
  }
  t->frame.container = (SimContainer){{0, 0, 0}, {3, 1.6f, 1}, (SimContainerShape)9};
  uint8_t *unknown = draw_default(&harness, t, &front);
  RenderSettings settings = render_default_settings();
  settings.container_visible = false;
  uint8_t *hidden = harness_draw(&harness, &t->frame, &front, &settings);
  assert_memory_equal(unknown, hidden, 3 * WIDTH * HEIGHT);
  free(unknown);
  free(hidden);
  test_frame_destroy(t);
  harness_close(&harness);
}

// ---- Meshes ----------------------------------------------------------------------------------------------------------

// Triangles that make no sense are left out, and so is a mesh of nothing else.
static void test_absurd_meshes(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  TestFrame *t = test_frame_create(2, 0.1f);
  test_frame_add(t, 1, 0.5f, 0.5f);
  uint8_t *without = draw_default(&harness, t, &front);
  const float vertex[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, NAN, 0, 0, 0, INFINITY, 0, 2e6f, 0, 0, 0.5f, 0.5f, 0};
  const int32_t bad[] = {0, 1,         3,         0, 4, 1, 5, 0, 1, 0, 1, 7, 0, -1,
                         2, INT32_MIN, INT32_MAX, 0, 1, 1, 2, 0, 0, 0, 1, 6, 2};
  const int32_t one_good[] = {0, 1, 9, 0, 1, 2, 3, 4, 5};
  const SimMesh absurd[] = {
      {7, 9, vertex, bad},  {0, 9, vertex, bad}, {7, 0, vertex, bad},  {-3, 9, vertex, bad},
      {7, -1, vertex, bad}, {7, 9, NULL, bad},   {7, 9, vertex, NULL}, {INT32_MIN, INT32_MIN, vertex, bad},
      {7, 1, vertex, bad},
  };
  SimObstacle bodies[sizeof absurd / sizeof absurd[0] + 1];
  const int32_t count = (int32_t)(sizeof bodies / sizeof bodies[0]);
  for (int32_t i = 0; i < count; ++i) {
    bodies[i] =
        (SimObstacle){SIM_MESH, {0}, {1, 0.5f, 1}, {0, 0, 0, 1}, {1, 0, 0}, 0, i + 1 < count ? &absurd[i] : NULL};
  }
  t->frame.obstacle_count = count;
  t->frame.obstacles = bodies;
  uint8_t *with = draw_default(&harness, t, &front);
  assert_memory_equal(without, with, 3 * WIDTH * HEIGHT);
  // Of one good triangle among bad ones, that one is drawn.
  const SimMesh good = {7, 3, vertex, one_good};
  bodies[0].mesh = &good;
  uint8_t *one = draw_default(&harness, t, &front);
  assert_memory_not_equal(without, one, 3 * WIDTH * HEIGHT);
  assert_layers_finite(&harness, t, &front);
  free(without);
  free(with);
  free(one);
  test_frame_destroy(t);
  harness_close(&harness);
}

// Many faces around one vertex take no time to speak of; too many faces are refused in one sentence.
static void test_large_meshes(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  TestFrame *t = test_frame_create(1, 0.1f);
  const int32_t rim = 100000;
  SimMesh *cone = test_mesh_create(rim + 1, rim);
  float *vertex = (float *)(uintptr_t)cone->vertex;
  int32_t *triangle = (int32_t *)(uintptr_t)cone->triangle;
  vertex[3 * rim + 1] = 0.8f;
  for (int32_t i = 0; i < rim; ++i) {
    const float a = 6.2831853f * (float)i / (float)rim;
    vertex[3 * i] = 0.4f * cosf(a);
    vertex[3 * i + 2] = 0.4f * sinf(a);
    triangle[3 * i] = i;
    triangle[3 * i + 1] = rim;
    triangle[3 * i + 2] = (i + 1) % rim;
  }
  const SimObstacle body = {SIM_MESH, {0}, {1.5f, 0, 0.5f}, {0, 0, 0, 1}, {0.9f, 0.1f, 0.1f}, 0, cone};
  t->frame.obstacle_count = 1;
  t->frame.obstacles = &body;
  uint8_t *rgb = draw_default(&harness, t, &front);
  int red = 0;
  for (int i = 0; i < WIDTH * HEIGHT; ++i) red += rgb[3 * i] > 2 * rgb[3 * i + 1];
  assert_true(red > 100);
  free(rgb);
  SimMesh *huge = test_mesh_create(3, 1000001);
  const SimObstacle too_large = {SIM_MESH, {0}, {1.5f, 0, 0.5f}, {0, 0, 0, 1}, {0.9f, 0.1f, 0.1f}, 0, huge};
  t->frame.obstacles = &too_large;
  const RenderSettings settings = render_default_settings();
  expect_refusal(&harness, &t->frame, &front, &settings, "1000001 triangles is too large");
  // And nothing is lost by it.
  t->frame.obstacles = &body;
  free(draw_default(&harness, t, &front));
  test_mesh_destroy(cone);
  test_mesh_destroy(huge);
  test_frame_destroy(t);
  harness_close(&harness);
}

static void test_bad_settings_and_views_are_refused(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  TestFrame *t = test_frame_create(1, 0.1f);
  const RenderSettings good = render_default_settings();
  RenderSettings s = {0};
  expect_refusal(&harness, &t->frame, &front, &s, "render_default_settings");
  s = good, s.style = "watercolour";
  expect_refusal(&harness, &t->frame, &front, &s, "unknown style \"watercolour\"");
  s = good, s.style = NULL;
  expect_refusal(&harness, &t->frame, &front, &s, "unknown style");
  s = good, s.tile_size = 0;
  expect_refusal(&harness, &t->frame, &front, &s, "tile size");
  s = good, s.exposure = NAN;
  expect_refusal(&harness, &t->frame, &front, &s, "exposure");
  s = good, memset(s.sun_direction, 0, sizeof s.sun_direction);
  expect_refusal(&harness, &t->frame, &front, &s, "sun");
  s = good, s.absorption[1] = -1;
  expect_refusal(&harness, &t->frame, &front, &s, "absorption");
  s = good, s.refractive_index = 0.5f;
  expect_refusal(&harness, &t->frame, &front, &s, "refractive index");
  s = good, s.sky = (RenderSky)9;
  expect_refusal(&harness, &t->frame, &front, &s, "sky");
  RenderView view = front;
  memcpy(view.target, view.eye, sizeof view.eye);
  expect_refusal(&harness, &t->frame, &view, &good, "same point");
  view = front, view.vertical_fov = 170;
  expect_refusal(&harness, &t->frame, &view, &good, "field of view");
  view = front, view.eye[1] = NAN;
  expect_refusal(&harness, &t->frame, &view, &good, "finite");
  t->frame.count = 3;
  t->frame.position = NULL;
  expect_refusal(&harness, &t->frame, &front, &good, "positions");
  test_frame_destroy(t);
  harness_close(&harness);
}

static void test_tiny_and_odd_pictures(void **state) {
  (void)state;
  const int32_t sizes[][2] = {{1, 1}, {1, 7}, {7, 1}, {3, 2}, {33, 31}};
  TestFrame *t = test_frame_create(2, 0.1f);
  test_frame_add(t, 1.5f, 0.5f, 0.5f);
  for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
    Harness harness = harness_open(CONTEXT_AUTO, sizes[i][0], sizes[i][1]);
    free(draw_default(&harness, t, &front));
    harness_close(&harness);
  }
  test_frame_destroy(t);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_empty_frame_is_the_background),
      cmocka_unit_test(test_invalid_particles_are_skipped),
      cmocka_unit_test(test_bad_attributes_do_no_harm),
      cmocka_unit_test(test_camera_in_the_water),
      cmocka_unit_test(test_extreme_sizes_of_things),
      cmocka_unit_test(test_absurd_containers_and_obstacles),
      cmocka_unit_test(test_absurd_glasses),
      cmocka_unit_test(test_absurd_meshes),
      cmocka_unit_test(test_large_meshes),
      cmocka_unit_test(test_bad_settings_and_views_are_refused),
      cmocka_unit_test(test_tiny_and_odd_pictures),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
