// How many particles a world holds: adding them, sinks, the limit, and reuse at the limit.
#include <math.h>

#include "sim/memory.h"
#include "sim/parallel.h"
#include "sim/world.h"

const float sim_water_colour[3] = {0.05f, 0.30f, 0.45f};

int32_t sim_world_limit(const SimWorld *world) {
  return world->def.max_particles > 0 ? world->def.max_particles : SIM_MAX_PARTICLES;
}

void sim_world_add(SimWorld *world, const float point[3], const float velocity[3], const float colour[3]) {
  bool plain = colour[0] == 0 && colour[1] == 0 && colour[2] == 0;
  sim_particles_add(&world->particles, world->next_id++, point, velocity, plain ? sim_water_colour : colour);
}

static bool reserve_gone(SimWorld *world, SimError *error) {
  return sim_reserve((void **)&world->gone, (size_t)world->particles.capacity, 1) || sim_fail(error, "out of memory");
}

// What emitters may come to need: as much as the limit allows or as fits into the container, if less.
bool sim_world_reserve(SimWorld *world, SimError *error) {
  if (world->def.emitter_count == 0 || world->def.max_particles == 0) return true;
  double fits = 1;
  for (int k = 0; k < 3; k++)
    fits *= ((double)world->def.container.max[k] - (double)world->def.container.min[k]) / (double)world->cubic.spacing;
  if (!sim_particles_reserve(&world->particles, (int32_t)fmin(1.1 * fits + 1, sim_world_limit(world))))
    return sim_fail(error, "out of memory");
  return reserve_gone(world, error);
}

// ---- Sinks -----------------------------------------------------------------------------------------------------------

static void sink_kernel(int32_t begin, int32_t end, const void *context, double *swallowed) {
  const SimWorld *world = context;
  float *const *x = world->particles.now.position;
  for (int32_t i = begin; i < end; i++) {
    bool gone = false;
    for (int32_t s = 0; s < world->def.sink_count && !gone; s++) {
      const SimSinkDef *sink = &world->sinks[s];
      gone = x[0][i] >= sink->min[0] && x[0][i] <= sink->max[0] && x[1][i] >= sink->min[1] && x[1][i] <= sink->max[1] &&
             x[2][i] >= sink->min[2] && x[2][i] <= sink->max[2];
    }
    world->gone[i] = gone;
    swallowed[0] += gone;
  }
}

bool sim_swallow(SimWorld *world, SimError *error) {
  if (world->def.sink_count == 0) return true;
  if (!reserve_gone(world, error)) return false;
  double swallowed = 0;
  sim_parallel_sum(world->threads, world->particles.count, 1, sink_kernel, world, &swallowed);
  if (swallowed > 0) sim_particles_remove(&world->particles, world->gone);
  world->counts.swallowed += (int64_t)swallowed;
  return true;
}

// ---- Reuse -----------------------------------------------------------------------------------------------------------

// The k-th smallest of the ids from `first` on (k from 1, no more than there are): radix selection, the highest byte first.
static uint32_t select_id(const uint32_t *id, int32_t count, uint32_t first, int32_t k) {
  uint32_t prefix = 0, mask = 0;
  for (int shift = 24; shift >= 0; shift -= 8) {
    int32_t histogram[256] = {0}, below = 0;
    uint32_t byte = 0;
    for (int32_t i = 0; i < count; i++)
      if (id[i] >= first && (id[i] & mask) == prefix) histogram[id[i] >> shift & 255]++;
    while (below + histogram[byte] < k) below += histogram[byte++];
    k -= below;
    prefix |= byte << shift;
    mask |= 255u << shift;
  }
  return prefix;
}

// Take away the `wanted` particles that were emitted first, or as many as there are. Returns how many, −1 and *error.
static int32_t take_oldest(SimWorld *world, int32_t wanted, SimError *error) {
  const uint32_t *id = world->particles.now.id, first = world->start_count;
  int32_t count = world->particles.count, emitted = 0;
  for (int32_t i = 0; i < count; i++) emitted += id[i] >= first;
  if (wanted > emitted) wanted = emitted;
  if (wanted == 0) return 0;
  if (!reserve_gone(world, error)) return -1;
  uint32_t last = select_id(id, count, first, wanted);
  for (int32_t i = 0; i < count; i++) world->gone[i] = id[i] >= first && id[i] <= last;
  sim_particles_remove(&world->particles, world->gone);
  world->counts.reused += wanted;
  world->settled = false;
  return wanted;
}

int32_t sim_world_make_way(SimWorld *world, int32_t wanted, SimError *error) {
  int32_t limit = sim_world_limit(world), room = limit - world->particles.count;
  if (wanted > room && world->def.reuse) {
    int32_t taken = take_oldest(world, wanted - room, error);
    if (taken < 0) return -1;
    room += taken;
  }
  if (wanted > room) wanted = room;
  int32_t capacity = world->particles.count + wanted, held = world->particles.capacity;
  // Emitters and pouring add a little many times: grow by half.
  if (capacity > held && world->particles.count > 0 && capacity < held * 1.5)
    capacity = (int32_t)fmin(held * 1.5, limit);
  if (!sim_particles_reserve(&world->particles, capacity)) return sim_fail(error, "out of memory"), -1;
  return wanted;
}
