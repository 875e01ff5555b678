// Counted, aligned memory: every block that the simulator holds comes from here.
//
// Threads: all functions may be called from any thread.
#ifndef LIDO_SIM_MEMORY_H
#define LIDO_SIM_MEMORY_H

#include <stdbool.h>
#include <stddef.h>

/// Alignment of every block, a cache line.
#define SIM_ALIGNMENT 64

/// A block of at least `bytes` zeroed bytes, aligned to SIM_ALIGNMENT; NULL when there is no memory.
void *sim_allocate(size_t bytes);
/// Give a block back; NULL is allowed.
void sim_release(void *block);

/// Make *array (NULL or a block) hold at least count elements of the given size. The contents are lost when it has to
/// grow, and it grows by half so that a slowly growing need allocates seldom. false when there is no memory: then *array
/// is as it was.
bool sim_reserve(void **array, size_t count, size_t element);
/// The same, keeping the contents.
bool sim_reserve_keep(void **array, size_t count, size_t element);

/// For tests: allocations that would lift the bytes in use above `bytes` fail. 0: no limit (the default).
void sim_memory_limit(size_t bytes);

#endif
