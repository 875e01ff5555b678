#include "sim/memory.h"

#include <stdatomic.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "sim/sim.h"

static atomic_size_t bytes_in_use;
static atomic_size_t allocations;
static atomic_size_t limit;

// The size of a block is kept in the cache line in front of it.
typedef union Header {
  size_t bytes;
  unsigned char pad[SIM_ALIGNMENT];
} Header;

static size_t block_bytes(const void *block) {
  return block ? ((const Header *)block)[-1].bytes : 0;
}

void *sim_allocate(size_t bytes) {
  if (bytes > SIZE_MAX / 2) return NULL;
  size_t rounded = (bytes + SIM_ALIGNMENT - 1) / SIM_ALIGNMENT * SIM_ALIGNMENT;
  size_t most = atomic_load(&limit);
  if (most && atomic_load(&bytes_in_use) + rounded > most) return NULL;
  Header *header = aligned_alloc(SIM_ALIGNMENT, sizeof(Header) + rounded);
  if (!header) return NULL;
  memset(header, 0, sizeof(Header) + rounded);
  header->bytes = rounded;
  atomic_fetch_add(&bytes_in_use, rounded);
  atomic_fetch_add(&allocations, 1);
  return header + 1;
}

void sim_release(void *block) {
  if (!block) return;
  Header *header = (Header *)block - 1;
  atomic_fetch_sub(&bytes_in_use, header->bytes);
  free(header);
}

static bool grow(void **array, size_t count, size_t element, bool keep) {
  if (count > SIZE_MAX / 4 / element) return false;
  size_t held = block_bytes(*array);
  if (*array && held >= count * element) return true;
  size_t wanted = count * element;
  if (*array && held + held / 2 > wanted) wanted = held + held / 2;
  void *block = sim_allocate(wanted);
  if (!block && wanted > count * element) block = sim_allocate(count * element);
  if (!block) return false;
  if (keep && *array) memcpy(block, *array, held);
  sim_release(*array);
  *array = block;
  return true;
}

bool sim_reserve(void **array, size_t count, size_t element) {
  return grow(array, count, element, false);
}

bool sim_reserve_keep(void **array, size_t count, size_t element) {
  return grow(array, count, element, true);
}

void sim_memory_limit(size_t bytes) {
  atomic_store(&limit, bytes);
}

size_t sim_bytes_in_use(void) {
  return atomic_load(&bytes_in_use);
}

size_t sim_allocation_count(void) {
  return atomic_load(&allocations);
}
