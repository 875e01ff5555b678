// Objects in the maps of the style "heightfield": meshes look like the bodies whose shape they have, the trapezium is that of
// Figure 8, and every switch changes what it is for and nothing else.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render/water_objects.h"
#include "tests/render/pool_scene.h"

#define WIDTH 256
#define HEIGHT 192
#define PIXELS ((size_t)WIDTH * HEIGHT)
#define PI 3.14159265358979323846

static const PoolWave level = {0.5, 0, {0, 0}}, waves = {0.5, 0.008, {6, 9}};

static uint8_t *draw(Harness *harness, const PoolScene *s, const RenderView *view) {
  return harness_draw(harness, &s->frame->frame, view, &s->settings);
}

// ---- Meshes ----------------------------------------------------------------------------------------------------------

// A square grid on each side of a cube around the origin with edges of 2, each point then moved by `place`.
static SimMesh *mesh_of_cube(int32_t across, void (*place)(float p[3])) {
  const int32_t points = (across + 1) * (across + 1);
  SimMesh *mesh = test_mesh_create(6 * points, 12 * across * across);
  float *vertex = (float *)(uintptr_t)mesh->vertex;
  int32_t *triangle = (int32_t *)(uintptr_t)mesh->triangle;
  for (int32_t side = 0; side < 6; ++side) {
    const int32_t axis = side / 2;
    const float out = side % 2 == 0 ? 1 : -1;
    for (int32_t i = 0; i < points; ++i, vertex += 3) {
      vertex[axis] = out;
      vertex[(axis + 1) % 3] = out * (2 * (float)(i % (across + 1)) / (float)across - 1);
      vertex[(axis + 2) % 3] = 2 * (float)(i / (across + 1)) / (float)across - 1;
      place(vertex);
    }
    for (int32_t i = 0; i < across * across; ++i) {
      const int32_t a = side * points + i / across * (across + 1) + i % across, b = a + across + 1;
      const int32_t corners[6] = {a, a + 1, b + 1, a, b + 1, b};
      memcpy(triangle, corners, sizeof corners);
      triangle += 6;
    }
  }
  return mesh;
}

static void on_box(float p[3]) {
  p[0] *= 0.2f;
  p[1] *= 0.45f;
  p[2] *= 0.15f;
}

static void on_ball(float p[3]) {
  const float scale = 0.3f / sqrtf(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
  for (int k = 0; k < 3; ++k) p[k] *= scale;
}

// Where either is.
static PoolDifference of_bodies(const uint8_t *a, const uint8_t *b, const uint8_t *empty) {
  uint8_t *mask = calloc(PIXELS, 1);
  for (size_t i = 0; i < PIXELS; ++i) {
    mask[i] = memcmp(a + 3 * i, empty + 3 * i, 3) != 0 || memcmp(b + 3 * i, empty + 3 * i, 3) != 0;
  }
  const PoolDifference d = pool_difference_drawn(a, b, mask, PIXELS);
  free(mask);
  return d;
}

static void expect_like(Harness *harness, SimMesh *mesh, SimObstacle body, PoolWave wave, const char *what) {
  const RenderView view = pool_scene_view(35);
  PoolScene *s = pool_scene_create(wave);
  uint8_t *empty = draw(harness, s, &view);
  SimObstacle *o = pool_scene_add(s, body);
  uint8_t *exact = draw(harness, s, &view);
  s->frame->mesh = mesh;
  o->shape = SIM_MESH;
  o->mesh = mesh;
  uint8_t *drawn = draw(harness, s, &view);
  const PoolDifference d = of_bodies(drawn, exact, empty);
  print_message("%-30s: mean %.2f, median %.2f, 95 %% %.2f of 255 (%d pixels)\n", what, d.mean, d.median, d.most,
                (int)d.pixels);
  free(empty);
  free(exact);
  free(drawn);
  pool_scene_destroy(s);
}

static void test_meshes(void **state) {
  const SimObstacle box = {.shape = SIM_BOX,
                           .size = {0.4f, 0.9f, 0.3f},
                           .position = {0, 0.45f, 0},
                           .rotation = {0, 0.2588190f, 0, 0.9659258f},
                           .colour = {0.9f, 0.1f, 0.1f}};
  const SimObstacle ball = {.shape = SIM_SPHERE,
                            .size = {0.6f},
                            .position = {0, 0.45f, 0},
                            .rotation = {0, 0, 0, 1},
                            .colour = {0.1f, 0.8f, 0.2f}};
  expect_like(*state, mesh_of_cube(24, on_ball), ball, level, "ball");
  expect_like(*state, mesh_of_cube(24, on_ball), ball, waves, "ball on waves");
  expect_like(*state, mesh_of_cube(16, on_box), box, level, "box of 3072 triangles");
  expect_like(*state, mesh_of_cube(1, on_box), box, level, "box of 12 triangles");
}

static int open_harness(void **state) {
  return harness_open_group(state, WIDTH, HEIGHT);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_meshes),
  };
  return cmocka_run_group_tests(tests, open_harness, harness_close_group);
}
