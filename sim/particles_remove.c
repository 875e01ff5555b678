// Taking particles away: a stable compaction, so that what stays keeps its order and nothing depends on threads.
//
// Few particles go at a time, so what stays between two of them is a long run: each array is moved run by run, at the
// speed of a copy, and what lies before the first one is not touched.
#include <string.h>

#include "sim/particles.h"

// Close the gaps of one array of 32-bit words. Returns how many are left.
static int32_t compact(uint32_t *array, int32_t first, int32_t count, const uint8_t *gone) {
  int32_t kept = first;
  for (int32_t i = first; i < count;) {
    int32_t begin = i;
    while (i < count && !gone[i]) i++;
    memmove(array + kept, array + begin, (size_t)(i - begin) * sizeof *array);
    kept += i - begin;
    while (i < count && gone[i]) i++;
  }
  return kept;
}

void sim_particles_remove(SimParticles *particles, const uint8_t *gone) {
  int32_t first = 0, kept = 0;
  while (first < particles->count && !gone[first]) first++;
  if (first == particles->count) return;
  void **list[SIM_SORTED_ARRAYS];
  int32_t arrays = sim_particles_list(&particles->now, particles->coloured, list);
  for (int32_t a = 0; a < arrays; a++) kept = compact(*list[a], first, particles->count, gone);
  particles->count = kept;
  particles->shuffled = true;
}
