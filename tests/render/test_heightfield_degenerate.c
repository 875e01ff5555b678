// The style "heightfield" on frames that nobody checked: it draws, no layer holds what is not a number, GL says nothing.
#include "tests/render/degenerate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 41, ROWS = 21, NODES = COLUMNS * ROWS };
#define SPACING 0.025f
#define LEVEL 0.3f

typedef struct Tank {
  TestFrame *frame;
  float height[NODES];
} Tank;

// Level water in the tank.
static Tank *tank_create(void) {
  Tank *s = calloc(1, sizeof *s);
  assert_non_null(s);
  s->frame = test_frame_create(64, DEGENERATE_RADIUS);
  s->frame->frame.container = degenerate_tank;
  memcpy(s->frame->frame.bounds_max, degenerate_tank.max, sizeof degenerate_tank.max);
  for (int i = 0; i < NODES; ++i) s->height[i] = LEVEL;
  s->frame->frame.height_field = (SimHeightField){{COLUMNS, ROWS}, {0, 0}, SPACING, s->height, NULL};
  return s;
}

static void tank_destroy(Tank *s) {
  test_frame_destroy(s->frame);
  free(s);
}

static SimObstacle *add_box(Tank *s, float x, float size) {
  SimObstacle *o = &s->frame->obstacles[s->frame->frame.obstacle_count++];
  *o = (SimObstacle){.shape = SIM_BOX,
                     .size = {size, 0.5f, size},
                     .position = {x, 0.25f, 0.25f},
                     .rotation = {0, 0, 0, 1},
                     .colour = {0.8f, 0.5f, 0.2f},
                     .steps = 3};
  return o;
}

static RenderSettings settings_of_style(void) {
  RenderSettings settings = render_default_settings();
  settings.style = "heightfield";
  return settings;
}

static void expect_clean(Harness *harness, const char *what, const Tank *s, const RenderView *view) {
  const RenderSettings settings = settings_of_style();
  degenerate_expect_clean(harness, what, &s->frame->frame, view, &settings);
}

static void test_fields(void **state) {
  Harness *harness = *state;
  Tank *s = tank_create();
  SimHeightField *field = &s->frame->frame.height_field;
  add_box(s, 0.5f, 0.1f);
  const int32_t sizes[][2] = {{COLUMNS, ROWS}, {0, 0}, {1, 1}, {2, 1}, {1, 2}, {2, 2}, {3, 3}};
  for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
    char what[32];
    snprintf(what, sizeof what, "%d × %d nodes", (int)sizes[i][0], (int)sizes[i][1]);
    memcpy(field->size, sizes[i], sizeof sizes[i]);
    expect_clean(harness, what, s, &degenerate_view);
  }
  tank_destroy(s);
}

static void test_heights(void **state) {
  Harness *harness = *state;
  Tank *s = tank_create();
  add_box(s, 0.5f, 0.1f);
  for (int i = 0; i < DEGENERATE_PLACES; ++i) {
    char what[48];
    for (int node = 0; node < NODES; node += 7) s->height[node] = degenerate_places[i];
    snprintf(what, sizeof what, "some heights of %g", (double)degenerate_places[i]);
    expect_clean(harness, what, s, &degenerate_view);
    for (int node = 0; node < NODES; ++node) s->height[node] = degenerate_places[i];
    snprintf(what, sizeof what, "all heights of %g", (double)degenerate_places[i]);
    expect_clean(harness, what, s, &degenerate_view);
    for (int node = 0; node < NODES; ++node) s->height[node] = LEVEL;
  }
  for (int node = 0; node < NODES; ++node) s->height[node] = node % 2 == 0 ? 0.9f : 0.01f;
  expect_clean(harness, "needles", s, &degenerate_view);
  tank_destroy(s);
}

static void test_eyes(void **state) {
  Harness *harness = *state;
  Tank *s = tank_create();
  add_box(s, 0.5f, 0.1f);
  for (int i = 0; i < DEGENERATE_EYES; ++i) {
    char what[32];
    snprintf(what, sizeof what, "eye %d", i);
    expect_clean(harness, what, s, &degenerate_eyes[i]);
  }
  const RenderView odd[] = {harness_view(0.2f, LEVEL, 0.4f, 0.8f, LEVEL, 0.2f, 40), // on the surface
                            harness_view(0.5f, 0.2f, 0.25f, 0.8f, 0.2f, 0.2f, 40),  // in the box
                            harness_view(0.5f, 2, 0.25f, 0.5f, 0, 0.25f, 40)};      // straight down
  for (int i = 0; i < 3; ++i) expect_clean(harness, "odd eye", s, &odd[i]);
  tank_destroy(s);
}

static void test_containers(void **state) {
  Harness *harness = *state;
  Tank *s = tank_create();
  add_box(s, 0.5f, 0.1f);
  for (int i = 0; i < DEGENERATE_CONTAINERS; ++i) {
    char what[32];
    snprintf(what, sizeof what, "container %d", i);
    s->frame->frame.container = degenerate_containers[i];
    expect_clean(harness, what, s, &degenerate_view);
  }
  s->frame->frame.container = degenerate_tank;
  s->frame->frame.container.shape = SIM_CONTAINER_GLASS;
  expect_clean(harness, "glass", s, &degenerate_view);
  s->frame->frame.has_container = false;
  expect_clean(harness, "no container", s, &degenerate_view);
  tank_destroy(s);
}

static void test_objects(void **state) {
  Harness *harness = *state;
  Tank *s = tank_create();
  for (int i = 0; i < DEGENERATE_PLACES; ++i) {
    s->frame->frame.obstacle_count = 0;
    add_box(s, degenerate_places[i], 0.1f);
    add_box(s, 0.5f, degenerate_places[i]);
    add_box(s, 0.3f, 0.1f)->rotation[1] = degenerate_places[i];
    expect_clean(harness, "absurd objects", s, &degenerate_view);
  }
  s->frame->frame.obstacle_count = 0;
  for (int i = 0; i < 6; ++i) add_box(s, 0.5f, 0.1f)->shape = (SimShape)i; // of all shapes, in one place
  expect_clean(harness, "objects in one place", s, &degenerate_view);
  SimObstacle many[100];
  for (int i = 0; i < 100; ++i) {
    many[i] = s->frame->obstacles[0];
    many[i].position[0] = 0.1f * (float)(i % 10) + 0.05f;
    many[i].position[2] = 0.05f * (float)(i / 10) + 0.025f;
    many[i].size[0] = many[i].size[2] = 0.02f;
  }
  s->frame->frame.obstacles = many;
  s->frame->frame.obstacle_count = 100;
  expect_clean(harness, "a hundred objects", s, &degenerate_view);
  tank_destroy(s);
}

static void test_particles(void **state) {
  Harness *harness = *state;
  Tank *s = tank_create();
  uint8_t classes[64] = {0};
  for (int i = 0; i < DEGENERATE_PLACES; ++i) {
    test_frame_add(s->frame, degenerate_places[i], 0.6f, 0.2f);
    test_frame_add(s->frame, 0.5f, degenerate_places[i], 0.2f);
    test_frame_add(s->frame, 0.5f, 0.6f, 0.2f);
  }
  s->frame->frame.particle_class = classes;
  expect_clean(harness, "absurd drops", s, &degenerate_view);
  s->frame->frame.height_field.size[0] = s->frame->frame.height_field.size[1] = 0;
  expect_clean(harness, "drops and no field", s, &degenerate_view);
  tank_destroy(s);
}

static void test_sizes(void **state) {
  (void)state;
  for (int i = 0; i < DEGENERATE_SIZES; ++i) {
    Harness harness = harness_open(CONTEXT_AUTO, degenerate_sizes[i][0], degenerate_sizes[i][1]);
    Tank *s = tank_create();
    add_box(s, 0.5f, 0.1f);
    expect_clean(&harness, "size", s, &degenerate_view);
    tank_destroy(s);
    harness_close(&harness);
  }
}

static int open_group(void **state) {
  return harness_open_group(state, 120, 90);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_fields),     cmocka_unit_test(test_heights), cmocka_unit_test(test_eyes),
      cmocka_unit_test(test_containers), cmocka_unit_test(test_objects), cmocka_unit_test(test_particles),
  };
  const struct CMUnitTest sizes[] = {cmocka_unit_test(test_sizes)};
  const int failed = cmocka_run_group_tests(tests, open_group, harness_close_group);
  return failed + cmocka_run_group_tests(sizes, NULL, NULL);
}
