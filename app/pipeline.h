// Two places at work side by side: one thread produces frame n + 1 into one slot while the caller draws frame n from
// the other. It knows nothing of water or windows, so it is tested with a made-up producer.
//
// Who may touch what: between pipeline_start and the pipeline_finished that returns true, everything that the job
// touches (the world, the input handed to it, the back slot) belongs to the worker thread, and the front slot belongs
// to the caller. At all other times everything belongs to the caller. Both hand-overs go through one mutex, so whatever
// one side wrote before it is seen by the other side after it; no other synchronisation is needed.
#ifndef LIDO_APP_PIPELINE_H
#define LIDO_APP_PIPELINE_H

#include <stdbool.h>

/// Runs on the worker thread, once per pipeline_start; `slot` (0 or 1) is the back slot.
typedef void PipelineJob(void *user, int slot);

typedef struct Pipeline Pipeline;

/// Starts the worker thread, which sleeps until there is work. NULL when there is no memory or no thread.
Pipeline *pipeline_create(PipelineJob *job, void *user);

/// Waits for the job at hand, ends the thread. NULL is allowed.
void pipeline_destroy(Pipeline *pipeline);

/// Let the worker fill the back slot. Only while idle.
void pipeline_start(Pipeline *pipeline);

/// True between pipeline_start and the pipeline_finished that returns true.
bool pipeline_busy(const Pipeline *pipeline);

/// True, once per start, when the job is done: from then on the caller owns everything again. Waits at most `seconds`
/// (0: does not wait). False while the job runs, and when none was started.
bool pipeline_finished(Pipeline *pipeline, double seconds);

/// The slot that the caller draws from, 0 at first. The back slot is the other one.
int pipeline_front(const Pipeline *pipeline);

/// Make the back slot the front slot, because what the job wrote is good to be shown. Only while idle.
void pipeline_swap(Pipeline *pipeline);

#endif
