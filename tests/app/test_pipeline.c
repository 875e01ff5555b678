// The hand-over between the thread that simulates and the one that draws, with made-up work instead of water and GL.
// Meant to be run under ThreadSanitizer too: the job and the caller touch plain, unguarded memory on purpose.
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "app/pipeline.h"

enum { CELLS = 4096 };

// A stand-in for the world, the input of a frame, and the two frames.
typedef struct Work {
  int64_t world; // grows by `input` in every job
  int64_t input;
  int sleep_ms;
  int runs;
  struct {
    int64_t number, cells[CELLS];
  } frame[2];
} Work;

static void sleep_ms(int milliseconds) {
  struct timespec time = {milliseconds / 1000, milliseconds % 1000 * 1000000L};
  nanosleep(&time, NULL);
}

static void produce(void *user, int slot) {
  Work *work = user;
  work->world += work->input;
  work->runs++;
  work->frame[slot].number = work->world;
  for (int i = 0; i < CELLS; i++) work->frame[slot].cells[i] = work->world + i;
  if (work->sleep_ms) sleep_ms(work->sleep_ms);
}

static double now(void) {
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

// A whole frame that belongs together: what a drawer must always see.
static int64_t draw(const Work *work, int slot) {
  for (int i = 0; i < CELLS; i++) assert_int_equal(work->frame[slot].cells[i], work->frame[slot].number + i);
  return work->frame[slot].number;
}

static void every_frame_arrives_whole_and_in_order(void **state) {
  (void)state;
  static Work work;
  memset(&work, 0, sizeof work);
  for (int i = 0; i < CELLS; i++) work.frame[0].cells[i] = i;
  Pipeline *pipeline = pipeline_create(produce, &work);
  assert_non_null(pipeline);
  int64_t want = 0;
  int draws = 0;
  for (int frame = 0; frame < 2000; frame++) {
    work.input = frame % 7; // handed over between two jobs
    want += work.input;
    pipeline_start(pipeline);
    // Draw the front slot while the worker writes the back slot.
    int64_t shown = draw(&work, pipeline_front(pipeline));
    assert_int_equal(shown, want - work.input);
    while (!pipeline_finished(pipeline, frame % 3 ? 1 : 0)) draws++;
    pipeline_swap(pipeline);
    assert_int_equal(draw(&work, pipeline_front(pipeline)), want);
  }
  assert_int_equal(work.runs, 2000);
  pipeline_destroy(pipeline);
}

static void the_caller_stays_free_while_the_job_is_slow(void **state) {
  (void)state;
  static Work work;
  memset(&work, 0, sizeof work);
  work.sleep_ms = 200;
  Pipeline *pipeline = pipeline_create(produce, &work);
  double begin = now();
  pipeline_start(pipeline);
  assert_true(pipeline_busy(pipeline));
  assert_false(pipeline_finished(pipeline, 0));
  assert_false(pipeline_finished(pipeline, 0.02));
  assert_true(now() - begin < 0.15);
  assert_true(pipeline_busy(pipeline));
  while (!pipeline_finished(pipeline, 1)) {
  }
  assert_true(now() - begin >= 0.199);
  assert_false(pipeline_busy(pipeline));
  assert_false(pipeline_finished(pipeline, 1)); // once per start, and without waiting
  pipeline_destroy(pipeline);
}

static void a_rejected_frame_leaves_the_front_alone(void **state) {
  (void)state;
  static Work work;
  memset(&work, 0, sizeof work);
  work.input = 1;
  Pipeline *pipeline = pipeline_create(produce, &work);
  pipeline_start(pipeline);
  while (!pipeline_finished(pipeline, 1)) {
  }
  pipeline_swap(pipeline);
  int front = pipeline_front(pipeline);
  assert_int_equal(front, 1);
  for (int i = 0; i < 5; i++) { // results that are not taken: the same back slot is written again
    pipeline_start(pipeline);
    while (!pipeline_finished(pipeline, 1)) {
    }
    assert_int_equal(pipeline_front(pipeline), front);
    assert_int_equal(work.frame[front].number, 1);
    assert_int_equal(work.frame[1 - front].number, 2 + i);
  }
  pipeline_destroy(pipeline);
}

static void ending_waits_for_the_job_at_hand(void **state) {
  (void)state;
  static Work work;
  memset(&work, 0, sizeof work);
  work.input = 1;
  work.sleep_ms = 50;
  Pipeline *pipeline = pipeline_create(produce, &work);
  pipeline_start(pipeline);
  pipeline_destroy(pipeline);
  assert_int_equal(work.runs, 1);
  assert_int_equal(work.frame[1].number, 1);
}

static void ending_without_work_ends_at_once(void **state) {
  (void)state;
  for (int i = 0; i < 100; i++) {
    Work *none = NULL;
    pipeline_destroy(pipeline_create(produce, none));
  }
  pipeline_destroy(NULL);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_frame_arrives_whole_and_in_order),
      cmocka_unit_test(the_caller_stays_free_while_the_job_is_slow),
      cmocka_unit_test(a_rejected_frame_leaves_the_front_alone),
      cmocka_unit_test(ending_waits_for_the_job_at_hand),
      cmocka_unit_test(ending_without_work_ends_at_once),
  };
  return cmocka_run_group_tests_name("app_pipeline", tests, NULL, NULL);
}
