// The timeline against computed truth: how the water moves, when values change, and that any way of cutting time into
// steps makes each event happen exactly once.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "app/events.h"

// A cube of water floating without gravity in the middle of a large tank, and a list of events.
#define SCENE(events)                                                                                                  \
  "{\"version\": 1, \"simulation\": {\"particle_radius\": 0.025, \"gravity\": [0, 0, 0], \"viscosity\": 0},"           \
  " \"container\": {\"min\": [0, 0, 0], \"max\": [4, 4, 4]},"                                                          \
  " \"camera\": {\"eye\": [0, 1, 5], \"target\": [0, 1, 0], \"fov\": 40},"                                             \
  " \"fluid\": [{\"type\": \"block\", \"min\": [1.8, 1.8, 1.8], \"max\": [2.2, 2.2, 2.2]}],"                           \
  " \"events\": [" events "]}"

static void assert_near(double got, double want, double tolerance) {
  if (!(fabs(got - want) <= tolerance)) fail_msg("got %.9g, want %.9g within %g", got, want, tolerance);
}

static Scene load(const char *text) {
  Scene scene;
  AppError error;
  if (!scene_load_text(&scene, "test", text, strlen(text), NULL, 0, &error)) fail_msg("%s", error.message);
  return scene;
}

static SimWorld *make_world(const Scene *scene) {
  SimWorldDef def = scene_world_def(scene);
  def.threads = 1;
  SimError error;
  SimWorld *world = sim_world_create(&def, &error);
  if (!world) fail_msg("%s", error.message);
  return world;
}

static void apply(const Scene *scene, double time, double step, SimWorld *world) {
  AppError error;
  if (!events_apply(scene, time, step, world, NULL, NULL, &error)) fail_msg("%s", error.message);
}

static void advance(SimWorld *world, double step) {
  SimError error;
  if (!sim_world_advance(world, step, &error)) fail_msg("%s", error.message);
}

// Momentum over mass: the velocity of the centre of mass, whatever the pressure inside does.
static void mean_velocity(const Scene *scene, SimWorld *world, double velocity[3]) {
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  SimError error;
  const SimFrame *frame = sim_world_frame(world, SIM_NEED_NOTHING, buffer, &error);
  assert_non_null(frame);
  velocity[0] = velocity[1] = velocity[2] = 0;
  for (int i = 0; i < frame->count; i++)
    for (int k = 0; k < 3; k++) velocity[k] += frame->velocity[3 * i + k] / (double)frame->count;
  sim_frame_buffer_destroy(buffer);
  (void)scene;
}

// ---- Push -----------------------------------------------------------------------------------------------------------

static void a_push_accelerates_its_way(void **state) {
  (void)state;
  // The ray goes through the cube's middle along z; at 100 times the cube's size its fall-off is flat.
  Scene scene = load(SCENE("{\"type\": \"push\", \"time\": 0.05, \"duration\": 0.1, \"origin\": [2, 2, 5],"
                           " \"direction\": [0, 0, -1], \"radius\": 40, \"acceleration\": [3, 4, 0]}"));
  const double steps[] = {0.01, 0.05, 0.2}; // the last one covers more than the push
  for (size_t s = 0; s < sizeof steps / sizeof steps[0]; s++) {
    SimWorld *world = make_world(&scene);
    for (int n = 0; n * steps[s] < 0.19; n++) {
      apply(&scene, n * steps[s], steps[s], world);
      advance(world, steps[s]);
    }
    double velocity[3];
    mean_velocity(&scene, world, velocity);
    assert_near(velocity[0], 0.3, 0.003);
    assert_near(velocity[1], 0.4, 0.004);
    assert_near(velocity[2], 0, 1e-4);
    sim_world_destroy(world);
  }
  scene_free(&scene);
}

static void water_away_from_the_ray_stays(void **state) {
  (void)state;
  Scene scene = load(SCENE("{\"type\": \"push\", \"duration\": 1, \"origin\": [1, 1, 5], \"direction\": [0, 0, -1],"
                           " \"radius\": 0.5, \"acceleration\": [50, 0, 0]}"));
  SimWorld *world = make_world(&scene);
  apply(&scene, 0, 0.02, world);
  advance(world, 0.02);
  double velocity[3];
  mean_velocity(&scene, world, velocity);
  assert_near(velocity[0], 0, 1e-4);
  sim_world_destroy(world);
  scene_free(&scene);
}

static void too_many_pushes_are_an_error(void **state) {
  (void)state;
  char text[8192] = "";
  size_t used = 0;
  used +=
      (size_t)snprintf(text, sizeof text,
                       "{\"version\": 1, \"simulation\": {\"particle_radius\": 0.05}, \"fluid\": [{\"min\": [0, 0, 0],"
                       " \"max\": [0.3, 0.3, 0.3]}], \"events\": [");
  for (int i = 0; i <= SIM_MAX_PUSHES; i++)
    used += (size_t)snprintf(text + used, sizeof text - used,
                             "%s{\"type\": \"push\", \"duration\": 1, \"origin\": [0, 0, 1], \"direction\": [0, 0, -1],"
                             " \"acceleration\": [1, 0, 0]}",
                             i ? ", " : "");
  snprintf(text + used, sizeof text - used, "]}");
  Scene scene = load(text);
  SimWorld *world = make_world(&scene);
  AppError error = {0};
  assert_false(events_apply(&scene, 0, 0.1, world, NULL, NULL, &error));
  assert_int_equal(error.code, APP_FAILED);
  assert_non_null(strstr(error.message, "events[16]"));
  sim_world_destroy(world);
  scene_free(&scene);
}

// ---- Pour -----------------------------------------------------------------------------------------------------------

#define POUR(time)                                                                                                     \
  "{\"type\": \"pour\", \"time\": " time                                                                               \
  ", \"min\": [0.5, 0.5, 0.5], \"max\": [0.7, 0.6, 0.6], \"velocity\": [1, 0, 0]}"

static void a_pour_adds_particles_once(void **state) {
  (void)state;
  Scene scene = load(SCENE(POUR("0.1")));
  SimWorld *world = make_world(&scene);
  int32_t before = sim_world_counts(world).particles;
  for (int n = 0; n < 5; n++) {
    apply(&scene, n * 0.05, 0.05, world);
    int32_t added = sim_world_counts(world).particles - before;
    if (n < 2) assert_int_equal(added, 0);
    if (n >= 2) assert_int_equal(added, 4 * 2 * 2);
    advance(world, 0.05);
  }
  sim_world_destroy(world);
  scene_free(&scene);
}

static void the_same_event_twice_pours_twice(void **state) {
  (void)state;
  Scene scene = load(SCENE(POUR("0") ", " POUR("0.5")));
  SimWorld *world = make_world(&scene);
  int32_t before = sim_world_counts(world).particles;
  for (int n = 0; n < 10; n++) {
    apply(&scene, n * 0.1, 0.1, world);
    advance(world, 0.1); // the first lot flies on at 1 m/s and leaves the place
  }
  assert_int_equal(sim_world_counts(world).particles - before, 2 * 16);
  sim_world_destroy(world);
  scene_free(&scene);
}

// ---- Any cut of time triggers each event once ------------------------------------------------------------------------
// The step itself is seen by styles: the first one that shows the new style. That nothing happens twice or never is seen
// by pours, counted.

static uint32_t random_bits(uint32_t *seed) {
  *seed = *seed * 1664525u + 1013904223u;
  return *seed >> 8;
}

// The step of a cut into n·step in which style event `style` first shows; it must hold the event's time.
static int first_step(const Scene *scene, const char *style, double step, int steps) {
  for (int n = 0; n < steps; n++) {
    RenderSettings settings = {.style = "none"};
    events_apply(scene, n * step, step, NULL, &settings, NULL, NULL);
    if (!strcmp(settings.style, style)) return n;
  }
  return -1;
}

static void events_on_a_border_belong_to_the_step_that_begins_there(void **state) {
  (void)state;
  const double rates[] = {24, 25, 30, 48, 49, 50, 60, 90, 120, 144, 240, 29.97, 59.94, 1000.0 / 3};
  for (size_t r = 0; r < sizeof rates / sizeof rates[0]; r++) {
    for (int n = 0; n < 2000; n += 37) {
      char text[1024];
      snprintf(text, sizeof text,
               "{\"version\": 1, \"events\": [{\"type\": \"style\", \"name\": \"points\", \"time\": %.17g}]}",
               n / rates[r]);
      Scene scene = load(text);
      assert_int_equal(first_step(&scene, "points", 1 / rates[r], 2001), n);
      scene_free(&scene);
    }
  }
}

static void any_cut_of_time_pours_each_once(void **state) {
  (void)state;
  char text[16384];
  size_t used = (size_t)snprintf(text, sizeof text,
                                 "{\"version\": 1, \"simulation\": {\"particle_radius\": 0.05, \"gravity\": [0, 0, 0]},"
                                 " \"container\": {\"min\": [0, 0, 0], \"max\": [10, 10, 10]}, \"events\": [");
  enum { POURS = 40 };
  for (int i = 0; i < POURS; i++)
    used +=
        (size_t)snprintf(text + used, sizeof text - used,
                         "%s{\"type\": \"pour\", \"time\": %.17g, \"min\": [%d, %d, 1], \"max\": [%d.1, %d.1, 1.1]}",
                         i ? ", " : "", i % 2 ? i * 0.05 : i / 24.0 * 1.2, 1 + i % 8, 1 + i / 8, 1 + i % 8, 1 + i / 8);
  snprintf(text + used, sizeof text - used, "]}");
  Scene scene = load(text);
  uint32_t seed = 7;
  for (int cut = 0; cut < 30; cut++) {
    SimWorld *world = make_world(&scene);
    assert_int_equal(sim_world_counts(world).particles, 0);
    int poured = 0;
    double time = 0, step = cut < 10 ? 1 / (20.0 + 7 * cut) : 0;
    for (int n = 0; time < 2.5; n++) {
      if (cut >= 10) step = n % 3 ? random_bits(&seed) / 16777216.0 * 0.1 + 1e-4 : 0.05;
      apply(&scene, time, step, world);
      poured += sim_world_counts(world).particles;
      sim_world_reset(world); // empty again, so that pouring twice into one place counts twice
      if (cut < 10)
        time = (n + 1) * step;
      else
        time += step;
    }
    assert_int_equal(poured, POURS);
    sim_world_destroy(world);
  }
  scene_free(&scene);
}

// ---- Tilt -----------------------------------------------------------------------------------------------------------

#define TILTS                                                                                                          \
  "{\"type\": \"tilt\", \"time\": 1, \"duration\": 2, \"gravity\": [4, -8, 0]},"                                       \
  "{\"type\": \"tilt\", \"time\": 2, \"duration\": 1, \"gravity\": [0, 0, 6]},"                                        \
  "{\"type\": \"tilt\", \"time\": 5, \"gravity\": [0, -1, 0]}"

static void a_tilt_reaches_its_gravity_linearly(void **state) {
  (void)state;
  Scene scene = load(SCENE(TILTS));
  const struct {
    double time;
    float want[3];
  } truth[] = {
      {0, {0, 0, 0}},    {1, {0, 0, 0}},    {1.25, {0.5f, -1, 0}},
      {1.5, {1, -2, 0}}, {2, {2, -4, 0}}, // the second one takes over where the first has come to
      {2.5, {1, -2, 3}}, {3, {0, 0, 6}},    {4, {0, 0, 6}},
      {5, {0, -1, 0}},   {100, {0, -1, 0}},
  };
  for (size_t i = 0; i < sizeof truth / sizeof truth[0]; i++) {
    float gravity[3];
    events_gravity(&scene, truth[i].time, gravity);
    for (int k = 0; k < 3; k++) assert_near(gravity[k], truth[i].want[k], 1e-5);
  }
  scene_free(&scene);
}

static void tilted_water_falls_as_it_must(void **state) {
  (void)state;
  Scene scene = load(SCENE("{\"type\": \"tilt\", \"time\": 0.1, \"duration\": 0.2, \"gravity\": [3, -6, 0]}"));
  SimWorld *world = make_world(&scene);
  for (int n = 0; n < 8; n++) {
    apply(&scene, n * 0.05, 0.05, world);
    advance(world, 0.05);
  }
  // The integral of gravity: a ramp of 0.2 s, then 0.1 s of the whole.
  double velocity[3];
  mean_velocity(&scene, world, velocity);
  assert_near(velocity[0], 3 * 0.2, 0.01);
  assert_near(velocity[1], -6 * 0.2, 0.02);
  assert_near(velocity[2], 0, 1e-3);
  sim_world_destroy(world);
  scene_free(&scene);
}

static void before_the_first_tilt_gravity_is_left_alone(void **state) {
  (void)state;
  Scene scene = load(SCENE(TILTS));
  SimWorld *world = make_world(&scene);
  const float other[3] = {0, 5, 0};
  assert_true(sim_world_set_gravity(world, other));
  apply(&scene, 0, 0.02, world);
  advance(world, 0.02);
  double velocity[3];
  mean_velocity(&scene, world, velocity);
  assert_near(velocity[1], 0.1, 1e-3);
  sim_world_destroy(world);
  scene_free(&scene);
}

static void a_shake_is_made_of_tilts(void **state) {
  (void)state;
  // To the right, to the left, and upright again: level in between and at the end, the same strength at the turns.
  Scene scene = load("{\"version\": 1, \"container\": {\"shape\": \"glass\"}, \"events\": ["
                     "{\"type\": \"tilt\", \"time\": 1, \"duration\": 0.25, \"gravity\": [3, -9.34, 0]},"
                     "{\"type\": \"tilt\", \"time\": 1.25, \"duration\": 0.5, \"gravity\": [-3, -9.34, 0]},"
                     "{\"type\": \"tilt\", \"time\": 1.75, \"duration\": 0.25, \"gravity\": [0, -9.81, 0]}]}");
  const struct {
    double time, x, y;
  } truth[] = {{0.5, 0, -9.81},   {1.125, 1.5, -9.575}, {1.25, 3, -9.34}, {1.5, 0, -9.34},
               {1.75, -3, -9.34}, {2, 0, -9.81},        {60, 0, -9.81}};
  for (size_t i = 0; i < sizeof truth / sizeof *truth; i++) {
    float gravity[3];
    events_gravity(&scene, truth[i].time, gravity);
    assert_near(gravity[0], truth[i].x, 1e-5);
    assert_near(gravity[1], truth[i].y, 1e-5);
    assert_near(gravity[2], 0, 1e-6);
  }
  scene_free(&scene);
}

// ---- Drag -------------------------------------------------------------------------------------------------------------

#define BALLS                                                                                                          \
  "\"obstacles\": [{\"type\": \"sphere\", \"radius\": 0.1, \"position\": [0.5, 0.5, 0.5]},"                            \
  "{\"type\": \"sphere\", \"name\": \"ball\", \"radius\": 0.1, \"position\": [1, 0.5, 0.5], \"motion\": "              \
  "\"draggable\","                                                                                                     \
  " \"max_speed\": 100}]"
#define DRAGS                                                                                                          \
  "{\"version\": 1, " BALLS ", \"events\": ["                                                                          \
  "{\"type\": \"drag\", \"obstacle\": \"ball\", \"time\": 1, \"duration\": 2, \"position\": [2, 0.5, 0.5]},"           \
  "{\"type\": \"drag\", \"obstacle\": 1, \"time\": 2, \"duration\": 1, \"position\": [1.5, 1, 0.5], \"rotation\": "    \
  "[0, 90, "                                                                                                           \
  "0]},"                                                                                                               \
  "{\"type\": \"drag\", \"obstacle\": 1, \"time\": 4, \"position\": [0.25, 0.25, 0.25], \"rotation\": [0, 0, 0]}]}"

static void a_drag_moves_evenly_from_where_the_last_one_came_to(void **state) {
  (void)state;
  Scene scene = load(DRAGS);
  const struct {
    double time;
    float want[3], degrees; // about y
  } truth[] = {{0, {1, 0.5f, 0.5f}, 0},    {1, {1, 0.5f, 0.5f}, 0},        {1.5, {1.25f, 0.5f, 0.5f}, 0},
               {2, {1.5f, 0.5f, 0.5f}, 0}, {2.5, {1.5f, 0.75f, 0.5f}, 45}, {3, {1.5f, 1, 0.5f}, 90},
               {3.9, {1.5f, 1, 0.5f}, 90}, {4, {0.25f, 0.25f, 0.25f}, 0},  {50, {0.25f, 0.25f, 0.25f}, 0}};
  for (size_t i = 0; i < sizeof truth / sizeof *truth; i++) {
    float position[3], rotation[4];
    events_drag(&scene, 1, truth[i].time, position, rotation);
    for (int k = 0; k < 3; k++) assert_near(position[k], truth[i].want[k], 1e-6);
    double half = truth[i].degrees * 3.14159265358979 / 360;
    assert_near(rotation[1], sin(half), 1e-6);
    assert_near(rotation[3], cos(half), 1e-6);
  }
  scene_free(&scene);
}

static void body_position(SimWorld *world, int body, float position[3]) {
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  SimError error;
  const SimFrame *frame = sim_world_frame(world, SIM_NEED_NOTHING, buffer, &error);
  assert_non_null(frame);
  memcpy(position, frame->obstacles[body].position, 3 * sizeof *position);
  sim_frame_buffer_destroy(buffer);
}

static void a_dragged_body_is_where_it_is_wanted(void **state) {
  (void)state;
  Scene scene = load(DRAGS);
  SimWorld *world = make_world(&scene);
  for (int n = 0; n < 90; n++) { // frames of 1/20 s, up to 4.5 s
    float want[3], turn[4], is[3];
    events_drag(&scene, 1, n / 20.0 - 1e-9, want, turn); // a jump takes place in the frame that follows
    body_position(world, 1, is);
    for (int k = 0; k < 3; k++) assert_near(is[k], want[k], 1e-3);
    body_position(world, 0, is);
    assert_near(is[0], 0.5, 0);
    apply(&scene, n / 20.0, 1 / 20.0, world);
    advance(world, 1 / 20.0);
  }
  sim_world_destroy(world);
  scene_free(&scene);
}

static void after_a_drag_the_hand_has_the_body(void **state) {
  (void)state;
  Scene scene = load("{\"version\": 1, " BALLS ", \"events\": [{\"type\": \"drag\", \"obstacle\": 1, \"time\": 0.1,"
                     " \"duration\": 0.2, \"position\": [1.2, 0.5, 0.5]}]}");
  SimWorld *world = make_world(&scene);
  const float elsewhere[3] = {2, 0.75f, 0.25f};
  float is[3];
  for (int n = 0; n < 20; n++) {
    apply(&scene, n * 0.05, 0.05, world);
    if (n == 10) assert_true(sim_world_drag(world, 1, elsewhere, NULL));
    advance(world, 0.05);
  }
  body_position(world, 1, is);
  for (int k = 0; k < 3; k++) assert_near(is[k], elsewhere[k], 1e-3);
  sim_world_destroy(world);
  scene_free(&scene);
}

// ---- Emitter ------------------------------------------------------------------------------------------------------------

static void emitters_run_while_they_are_on(void **state) {
  (void)state;
  Scene scene =
      load("{\"version\": 1, \"simulation\": {\"particle_radius\": 0.025, \"gravity\": [0, 0, 0]}, \"fluid\": ["
           "{\"type\": \"block\", \"min\": [0, 0, 0], \"max\": [0.1, 0.1, 0.1]},"
           "{\"type\": \"emitter\", \"name\": \"tap\", \"diameter\": 0.2, \"position\": [0.5, 1, 0.5],"
           " \"direction\": [1, 0, 0], \"speed\": 1}],"
           " \"events\": [{\"type\": \"emitter\", \"emitter\": \"tap\", \"time\": 0.2, \"on\": false},"
           " {\"type\": \"emitter\", \"emitter\": 1, \"time\": 0.6, \"on\": true}]}");
  SimWorld *world = make_world(&scene);
  int64_t emitted[21];
  for (int n = 0; n < 20; n++) {
    emitted[n] = sim_world_counts(world).emitted;
    apply(&scene, n * 0.05, 0.05, world);
    advance(world, 0.05);
  }
  emitted[20] = sim_world_counts(world).emitted;
  assert_true(emitted[4] > 0);
  assert_int_equal(emitted[12], emitted[4]); // shut from 0.2 s to 0.6 s
  assert_true(emitted[20] > emitted[12]);
  sim_world_destroy(world);
  scene_free(&scene);
}

// ---- Style and camera -------------------------------------------------------------------------------------------------

static void the_style_changes_at_its_time(void **state) {
  (void)state;
  Scene scene = load(SCENE("{\"type\": \"style\", \"time\": 0.5, \"name\": \"points\"}"));
  for (int n = 0; n < 100; n++) {
    RenderSettings settings = {.style = "before"};
    events_apply(&scene, n / 60.0, 1 / 60.0, NULL, &settings, NULL, NULL);
    assert_string_equal(settings.style, n < 30 ? "before" : "points");
  }
  scene_free(&scene);
}

#define MOVES                                                                                                          \
  "{\"type\": \"camera\", \"time\": 1, \"duration\": 2, \"eye\": [4, 3, 5], \"target\": [0, 1, 2], \"fov\": 60},"      \
  "{\"type\": \"camera\", \"time\": 4, \"eye\": [9, 9, 9], \"target\": [1, 1, 1]}"

static void the_camera_moves_smoothly(void **state) {
  (void)state;
  Scene scene = load(SCENE(MOVES));
  const double step = 1 / 60.0;
  RenderView view = {.eye = {-1, -2, -3}, .vertical_fov = 12}, before = view;
  events_apply(&scene, 0.5, step, NULL, NULL, &view, NULL);
  assert_memory_equal(&view, &before, sizeof view); // nothing has begun: as given
  const struct {
    double time;
    float eye[3], target_z, fov;
  } truth[] = {
      {1, {0, 1, 5}, 0, 40},
      {1.5, {4 * 0.15625f, 1 + 2 * 0.15625f, 5}, 2 * 0.15625f, 40 + 20 * 0.15625f}, // smoothstep(¼) = 5/32
      {2, {2, 2, 5}, 1, 50},
      {3, {4, 3, 5}, 2, 60},
      {3.5, {4, 3, 5}, 2, 60},
      {4, {9, 9, 9}, 1, 40}, // no fov of its own: the scene's
      {50, {9, 9, 9}, 1, 40},
  };
  for (size_t i = 0; i < sizeof truth / sizeof truth[0]; i++) {
    // Whatever the view was: nothing is remembered.
    view = before;
    events_apply(&scene, truth[i].time, step, NULL, NULL, &view, NULL);
    for (int k = 0; k < 3; k++) assert_near(view.eye[k], truth[i].eye[k], 1e-5);
    assert_near(view.target[2], truth[i].target_z, 1e-5);
    assert_near(view.vertical_fov, truth[i].fov, 1e-4);
  }
  scene_free(&scene);
}

// ---- A part of a film equals the same frames of the whole -----------------------------------------------------------------

static void nothing_is_remembered(void **state) {
  (void)state;
  Scene scene = load(SCENE(MOVES ", " TILTS ", {\"type\": \"style\", \"time\": 2, \"name\": \"points\"}"));
  RenderSettings whole = {.style = "none"};
  RenderView whole_view = scene_view(&scene);
  for (int n = 0; n < 300; n++) {
    RenderSettings alone = {.style = "none"};
    RenderView alone_view = scene_view(&scene);
    events_apply(&scene, n / 50.0, 1 / 50.0, NULL, &whole, &whole_view, NULL);
    events_apply(&scene, n / 50.0, 1 / 50.0, NULL, &alone, &alone_view, NULL);
    assert_string_equal(whole.style, alone.style);
    assert_memory_equal(&whole_view, &alone_view, sizeof whole_view);
  }
  scene_free(&scene);
}

static void no_events_change_nothing(void **state) {
  (void)state;
  Scene scene = load(SCENE(""));
  SimWorld *world = make_world(&scene);
  RenderSettings settings = {.style = "mine"};
  RenderView view = {.eye = {1, 2, 3}}, before = view;
  AppError error;
  assert_true(events_apply(&scene, 1, 0.1, world, &settings, &view, &error));
  assert_true(events_apply(&scene, 1, 0.1, NULL, NULL, NULL, &error));
  assert_string_equal(settings.style, "mine");
  assert_memory_equal(&view, &before, sizeof view);
  sim_world_destroy(world);
  scene_free(&scene);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_push_accelerates_its_way),
      cmocka_unit_test(water_away_from_the_ray_stays),
      cmocka_unit_test(too_many_pushes_are_an_error),
      cmocka_unit_test(a_pour_adds_particles_once),
      cmocka_unit_test(the_same_event_twice_pours_twice),
      cmocka_unit_test(events_on_a_border_belong_to_the_step_that_begins_there),
      cmocka_unit_test(any_cut_of_time_pours_each_once),
      cmocka_unit_test(a_tilt_reaches_its_gravity_linearly),
      cmocka_unit_test(tilted_water_falls_as_it_must),
      cmocka_unit_test(before_the_first_tilt_gravity_is_left_alone),
      cmocka_unit_test(a_shake_is_made_of_tilts),
      cmocka_unit_test(a_drag_moves_evenly_from_where_the_last_one_came_to),
      cmocka_unit_test(a_dragged_body_is_where_it_is_wanted),
      cmocka_unit_test(after_a_drag_the_hand_has_the_body),
      cmocka_unit_test(emitters_run_while_they_are_on),
      cmocka_unit_test(the_style_changes_at_its_time),
      cmocka_unit_test(the_camera_moves_smoothly),
      cmocka_unit_test(nothing_is_remembered),
      cmocka_unit_test(no_events_change_nothing),
  };
  return cmocka_run_group_tests_name("app_events", tests, NULL, NULL);
}
