#include "app/pipeline.h"

#include <assert.h>
#include <errno.h>
#include <pthread.h>
#include <stdlib.h>
#include <time.h>

typedef enum WorkerState { WORKER_IDLE, WORKER_BUSY, WORKER_DONE, WORKER_QUIT } WorkerState;

struct Pipeline {
  PipelineJob *job;
  void *user;
  pthread_t thread;
  pthread_mutex_t mutex;
  pthread_cond_t changed; // state, in either direction: the two sides never wait at the same time
  WorkerState state;      // guarded by the mutex
  bool busy;              // the caller's own note of what it has started
  int front;              // written by the caller while the worker is idle
};

static void *work(void *argument) {
  Pipeline *pipeline = argument;
  pthread_mutex_lock(&pipeline->mutex);
  while (pipeline->state != WORKER_QUIT) {
    if (pipeline->state != WORKER_BUSY) {
      pthread_cond_wait(&pipeline->changed, &pipeline->mutex);
      continue;
    }
    int slot = 1 - pipeline->front;
    pthread_mutex_unlock(&pipeline->mutex);
    pipeline->job(pipeline->user, slot);
    pthread_mutex_lock(&pipeline->mutex);
    pipeline->state = WORKER_DONE;
    pthread_cond_signal(&pipeline->changed);
  }
  pthread_mutex_unlock(&pipeline->mutex);
  return NULL;
}

// The mutex and a condition whose waits are measured on a clock that nobody sets.
static bool make_locks(Pipeline *pipeline) {
  pthread_condattr_t attributes;
  if (pthread_mutex_init(&pipeline->mutex, NULL)) return false;
  if (!pthread_condattr_init(&attributes)) {
    bool made =
        !pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC) && !pthread_cond_init(&pipeline->changed, &attributes);
    pthread_condattr_destroy(&attributes);
    if (made) return true;
  }
  pthread_mutex_destroy(&pipeline->mutex);
  return false;
}

Pipeline *pipeline_create(PipelineJob *job, void *user) {
  Pipeline *pipeline = calloc(1, sizeof *pipeline);
  if (!pipeline) return NULL;
  pipeline->job = job;
  pipeline->user = user;
  if (!make_locks(pipeline)) {
    free(pipeline);
    return NULL;
  }
  if (!pthread_create(&pipeline->thread, NULL, work, pipeline)) return pipeline;
  pthread_cond_destroy(&pipeline->changed);
  pthread_mutex_destroy(&pipeline->mutex);
  free(pipeline);
  return NULL;
}

static void set_state(Pipeline *pipeline, WorkerState state) {
  pthread_mutex_lock(&pipeline->mutex);
  pipeline->state = state;
  pthread_cond_signal(&pipeline->changed);
  pthread_mutex_unlock(&pipeline->mutex);
}

void pipeline_destroy(Pipeline *pipeline) {
  if (!pipeline) return;
  while (pipeline->busy) pipeline_finished(pipeline, 1);
  set_state(pipeline, WORKER_QUIT);
  pthread_join(pipeline->thread, NULL);
  pthread_cond_destroy(&pipeline->changed);
  pthread_mutex_destroy(&pipeline->mutex);
  free(pipeline);
}

void pipeline_start(Pipeline *pipeline) {
  assert(!pipeline->busy);
  pipeline->busy = true;
  set_state(pipeline, WORKER_BUSY);
}

bool pipeline_busy(const Pipeline *pipeline) {
  return pipeline->busy;
}

static struct timespec deadline(double seconds) {
  struct timespec at;
  clock_gettime(CLOCK_MONOTONIC, &at);
  double whole = (double)(long long)seconds;
  at.tv_sec += (time_t)whole;
  at.tv_nsec += (long)((seconds - whole) * 1e9);
  if (at.tv_nsec >= 1000000000L) {
    at.tv_sec++;
    at.tv_nsec -= 1000000000L;
  }
  return at;
}

bool pipeline_finished(Pipeline *pipeline, double seconds) {
  if (!pipeline->busy) return false;
  pthread_mutex_lock(&pipeline->mutex);
  if (seconds > 0) {
    struct timespec at = deadline(seconds);
    int result = 0;
    while (pipeline->state != WORKER_DONE && result != ETIMEDOUT)
      result = pthread_cond_timedwait(&pipeline->changed, &pipeline->mutex, &at);
  }
  bool done = pipeline->state == WORKER_DONE;
  if (done) pipeline->state = WORKER_IDLE;
  pthread_mutex_unlock(&pipeline->mutex);
  if (done) pipeline->busy = false;
  return done;
}

int pipeline_front(const Pipeline *pipeline) {
  return pipeline->front;
}

void pipeline_swap(Pipeline *pipeline) {
  assert(!pipeline->busy);
  pipeline->front = 1 - pipeline->front;
}
