// The simulation behind a window, against the same simulation run step by step. Meant for ThreadSanitizer too: frames
// are read here while the worker writes the next one.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "app/events.h"
#include "app/live.h"

#define FPS 60.0

static const char falling[] =
    "{\"version\": 1, \"simulation\": {\"particle_radius\": 0.04}, \"container\": {\"max\": [1.2, 1, 0.6]},"
    " \"fluid\": [{\"min\": [0, 0, 0], \"max\": [0.4, 0.6, 0.6]}],"
    " \"events\": [{\"type\": \"pour\", \"time\": 0.1, \"min\": [0.8, 0.6, 0.2], \"max\": [1, 0.8, 0.4]}]}";

static Scene load(const char *text) {
  Scene scene;
  AppError error;
  if (!scene_load_text(&scene, "test", text, strlen(text), NULL, 0, &error)) fail_msg("%s", error.message);
  return scene;
}

static Live *open_live(const Scene *scene, unsigned needs) {
  AppError error;
  Live *live = live_create(scene, FPS, 2, needs, &error);
  if (!live) fail_msg("%s", error.message);
  return live;
}

static LiveEvent wait_for(Live *live) {
  LiveEvent event = LIVE_NOTHING;
  while (live_busy(live) && event == LIVE_NOTHING) event = live_poll(live, 1);
  return event;
}

static uint64_t hash_frame(const SimFrame *frame) {
  uint64_t hash = 1469598103934665603u; // FNV-1a
  const unsigned char *bytes = (const unsigned char *)frame->position;
  for (size_t i = 0; i < (size_t)frame->count * 3 * sizeof(float); i++) hash = (hash ^ bytes[i]) * 1099511628211u;
  return hash;
}

// The truth: one thread, one buffer, frame after frame.
static void run_plainly(const Scene *scene, int frames, uint64_t hashes[]) {
  SimWorldDef def = scene_world_def(scene);
  SimError reason;
  AppError error;
  SimWorld *world = sim_world_create(&def, &reason);
  assert_non_null(world);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  for (int n = 0; n < frames; n++) {
    hashes[n] = hash_frame(sim_world_frame(world, SIM_NEED_NOTHING, buffer, &reason));
    assert_true(events_apply(scene, n * (1 / FPS), 1 / FPS, world, NULL, NULL, &error));
    assert_true(sim_world_advance(world, 1 / FPS, &reason));
  }
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
}

static void frames_equal_those_of_a_plain_run(void **state) {
  (void)state;
  enum { FRAMES = 20 };
  Scene scene = load(falling);
  uint64_t hashes[FRAMES];
  run_plainly(&scene, FRAMES, hashes);
  Live *live = open_live(&scene, SIM_NEED_NOTHING);
  LiveInput input = {.needs = SIM_NEED_NOTHING};
  int32_t before = live_frame(live)->counts.particles;
  for (int n = 0; n < FRAMES; n++) {
    const LiveFrame *shown = live_frame(live);
    assert_int_equal(shown->frame.index, n);
    assert_true(fabs(shown->frame.time - n / FPS) < 1e-9);
    live_advance(live, &input);
    // While the worker writes the other slot, the shown frame must not change.
    do assert_true(hash_frame(&shown->frame) == hashes[n]);
    while (live_poll(live, 0) == LIVE_NOTHING);
  }
  assert_int_equal(live_frame(live)->counts.particles - before, 2 * 2 * 2); // the pour
  live_destroy(live);
  scene_free(&scene);
}

static void a_reset_starts_the_same_again(void **state) {
  (void)state;
  Scene scene = load(falling);
  Live *live = open_live(&scene, SIM_NEED_NOTHING);
  uint64_t first[10];
  for (int round = 0; round < 2; round++) {
    for (int n = 0; n < 10; n++) {
      uint64_t hash = hash_frame(&live_frame(live)->frame);
      if (round == 0) first[n] = hash;
      assert_true(hash == first[n]);
      assert_int_equal(live_frame(live)->frame.index, n);
      live_advance(live, &(LiveInput){.needs = SIM_NEED_NOTHING});
      assert_int_equal(wait_for(live), LIVE_NEW_FRAME);
    }
    live_reset(live, SIM_NEED_NOTHING);
    assert_int_equal(wait_for(live), LIVE_NEW_FRAME);
  }
  live_destroy(live);
  scene_free(&scene);
}

static void a_refresh_adds_what_a_style_needs(void **state) {
  (void)state;
  Scene scene = load(falling);
  Live *live = open_live(&scene, SIM_NEED_NOTHING);
  live_advance(live, &(LiveInput){.needs = SIM_NEED_NOTHING});
  wait_for(live);
  uint64_t hash = hash_frame(&live_frame(live)->frame);
  assert_null(live_frame(live)->frame.ellipsoid);
  live_refresh(live, SIM_NEED_ANISOTROPY | SIM_NEED_CLASS);
  assert_int_equal(wait_for(live), LIVE_NEW_FRAME);
  const LiveFrame *frame = live_frame(live);
  assert_non_null(frame->frame.ellipsoid);
  assert_non_null(frame->frame.particle_class);
  assert_int_equal(frame->needs, SIM_NEED_ANISOTROPY | SIM_NEED_CLASS);
  assert_int_equal(frame->frame.index, 1);
  assert_true(hash_frame(&frame->frame) == hash);
  live_destroy(live);
  scene_free(&scene);
}

static void pushes_and_gravity_reach_the_water(void **state) {
  (void)state;
  Scene scene = load(falling);
  double speed[2][3];
  for (int pushed = 0; pushed < 2; pushed++) {
    Live *live = open_live(&scene, SIM_NEED_NOTHING);
    LiveInput input = {.push_count = pushed, .set_gravity = true, .gravity = {0, 0, -2}};
    input.pushes[0] =
        (SimPush){.origin = {0.2f, 0.3f, 5}, .direction = {0, 0, -1}, .radius = 2, .acceleration = {9, 0, 0}};
    live_advance(live, &input);
    assert_int_equal(wait_for(live), LIVE_NEW_FRAME);
    SimMeasures measures = sim_world_measures(live_world(live));
    for (int k = 0; k < 3; k++) speed[pushed][k] = measures.momentum[k];
    live_destroy(live);
  }
  assert_true(speed[1][0] > speed[0][0] + 0.5 * fabs(speed[0][0]));
  assert_true(speed[1][0] > 0);
  scene_free(&scene);
}

static void a_drag_reaches_its_body(void **state) {
  (void)state;
  Scene scene =
      load("{\"version\": 1, \"obstacles\": [{\"type\": \"box\", \"size\": [0.1, 0.1, 0.1], \"position\": [1, 1, 0.5]},"
           "{\"type\": \"box\", \"size\": [0.1, 0.1, 0.1], \"position\": [1, 0.5, 0.5], \"motion\": \"draggable\","
           " \"max_speed\": 6}]}");
  Live *live = open_live(&scene, SIM_NEED_NOTHING);
  LiveInput input = {.drag = true, .body = 1, .position = {1.5f, 0.5f, 0.5f}};
  // 6 m/s is 0.1 m a frame: after five frames it is there, and stays without being told again.
  for (int n = 1; n <= 8; n++) {
    live_advance(live, &input);
    assert_int_equal(wait_for(live), LIVE_NEW_FRAME);
    const SimObstacle *bodies = live_frame(live)->frame.obstacles;
    assert_true(fabs(bodies[1].position[0] - (1 + 0.1 * fmin(n, 5))) < 0.011);
    assert_true(bodies[0].position[0] == 1);
    input = (LiveInput){0};
  }
  live_destroy(live);
  scene_free(&scene);
}

// One push more than a world takes, from 0.05 s (frame 3) on.
static Scene scene_that_fails(void) {
  static char text[8192];
  size_t used = (size_t)snprintf(text, sizeof text,
                                 "{\"version\": 1, \"simulation\": {\"particle_radius\": 0.05}, \"fluid\":"
                                 " [{\"min\": [0, 0, 0], \"max\": [0.3, 0.3, 0.3]}], \"events\": [");
  for (int i = 0; i <= SIM_MAX_PUSHES; i++)
    used += (size_t)snprintf(text + used, sizeof text - used,
                             "%s{\"type\": \"push\", \"time\": 0.05, \"duration\": 1, \"origin\": [0, 0, 1],"
                             " \"direction\": [0, 0, -1], \"acceleration\": [1, 0, 0]}",
                             i ? ", " : "");
  snprintf(text + used, sizeof text - used, "]}");
  return load(text);
}

static void a_failure_keeps_the_last_good_frame(void **state) {
  (void)state;
  Scene scene = scene_that_fails();
  Live *live = open_live(&scene, SIM_NEED_NOTHING);
  for (int round = 0; round < 2; round++) {
    for (int n = 0; n < 3; n++) {
      live_advance(live, &(LiveInput){.needs = SIM_NEED_NOTHING});
      assert_int_equal(wait_for(live), LIVE_NEW_FRAME);
    }
    uint64_t hash = hash_frame(&live_frame(live)->frame);
    assert_null(live_failure(live));
    live_advance(live, &(LiveInput){.needs = SIM_NEED_NOTHING});
    assert_int_equal(wait_for(live), LIVE_FAILURE);
    assert_non_null(strstr(live_failure(live), "events[16]"));
    assert_int_equal(live_frame(live)->frame.index, 3);
    assert_true(hash_frame(&live_frame(live)->frame) == hash);
    // Another style may still be shown of it; that does not mend it.
    live_refresh(live, SIM_NEED_CLASS);
    assert_int_equal(wait_for(live), LIVE_NEW_FRAME);
    assert_non_null(live_failure(live));
    live_reset(live, SIM_NEED_NOTHING);
    assert_int_equal(wait_for(live), LIVE_NEW_FRAME);
    assert_null(live_failure(live));
    assert_int_equal(live_frame(live)->frame.index, 0);
  }
  live_destroy(live);
  scene_free(&scene);
}

static void ending_in_the_middle_of_a_job_leaves_nothing(void **state) {
  (void)state;
  Scene scene = load(falling);
  size_t before = sim_bytes_in_use();
  Live *live = open_live(&scene, SIM_NEED_NOTHING);
  live_advance(live, &(LiveInput){.needs = SIM_NEED_ALL});
  live_destroy(live);
  assert_int_equal(sim_bytes_in_use(), before);
  live_destroy(NULL);
  scene_free(&scene);
}

static void a_world_that_cannot_be_made_is_told(void **state) {
  (void)state;
  Scene scene = load(falling);
  scene.simulation.particle_radius = NAN; // past the scene's own checks
  AppError error = {0};
  assert_null(live_create(&scene, FPS, 1, SIM_NEED_NOTHING, &error));
  assert_int_equal(error.code, APP_BAD_INPUT);
  assert_true(error.message[0] != '\0');
  scene_free(&scene);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(frames_equal_those_of_a_plain_run),
      cmocka_unit_test(a_reset_starts_the_same_again),
      cmocka_unit_test(a_refresh_adds_what_a_style_needs),
      cmocka_unit_test(pushes_and_gravity_reach_the_water),
      cmocka_unit_test(a_drag_reaches_its_body),
      cmocka_unit_test(a_failure_keeps_the_last_good_frame),
      cmocka_unit_test(ending_in_the_middle_of_a_job_leaves_nothing),
      cmocka_unit_test(a_world_that_cannot_be_made_is_told),
  };
  return cmocka_run_group_tests_name("app_live", tests, NULL, NULL);
}
