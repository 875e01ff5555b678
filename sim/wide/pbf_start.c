// What a substep of position based fluids starts from, as two sweeps: the compression, the unevenness and the pressure that
// its first state brings along, and the motion that this pressure gives. See "Warm start" and "Shear" in solver_pbf.h.
#include "sim/wide/kernels.h"
#include "sim/wide/pbf_move.h"
#include "sim/wide/shear.h"
#include "sim/wide/spline.h"

/// Sums over the neighbours of the particles of one chunk.
typedef struct StartSums {
  SimF density;
  Tensor moment;
} StartSums;

static inline StartSums sum_start(const SimStep *step, const SimF own[4], const uint32_t *index, uint32_t slots) {
  const Spline s = spline_make(&step->cubic);
  StartSums sums = {s.zero, tensor_zero()};
  for (uint32_t k = 0; k < slots; k++, index += SIM_CHUNK) {
    SimF other[4], w, over_r;
    sim_gather4(step->particles->second, index, other);
    SimF dx = own[0] - other[0], dy = own[1] - other[1], dz = own[2] - other[2];
    spline(&s, dx * dx + dy * dy + dz * dz, &w, &over_r);
    sums.density = sums.density + w;
    tensor_add(&sums.moment, over_r, dx, dy, dz);
  }
  return sums;
}

// Of the state at the start of the substep (in `second`): the compression into `density`, the λ that the last substep's
// pressure stands for into `pressure` and beside the predicted positions in `first`, and λ E into `solid`, which has no other
// use yet. The lists are those of the predicted positions; what they miss lies at the rim of the support, where W is next to
// nothing.
void WIDE(sim_pbf_inherit)(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  const SimNeighbours *lists = step->neighbours;
  SimParticles *p = step->particles;
  SimF value = sim_f(2 * step->cubic.value_scale);
  for (int32_t i = begin; i < end; i += SIM_LANES) {
    const int32_t chunk = i / SIM_CHUNK;
    SimF own[4], place[4], solid[4], lambda = sim_load(p->now.pressure + i) * sim_f(step->warm);
    sim_load4(p->second + 4 * (size_t)i, own);
    sim_load4(p->first + 4 * (size_t)i, place);
    WIDE(sim_wall_solid_here)(step, i, own, solid);
    StartSums sums = sum_start(step, own, lists->index + (size_t)lists->start[chunk] * SIM_CHUNK + i % SIM_CHUNK,
                               lists->length[chunk]);
    SimF density = sim_f(step->cubic.value_scale) + solid[3] + value * sums.density;
    sim_store(p->density + i, sim_max(density - sim_f(1), sim_f(0)));
    sim_store(p->now.pressure + i, lambda);
    sim_store4(p->first + 4 * (size_t)i, place[0], place[1], place[2], lambda);
    shear_store(step, i, &sums.moment, solid, lambda);
  }
}

// The first correction: from the predicted positions with λ in `first` to new ones in `second`.
void WIDE(sim_pbf_start)(int32_t begin, int32_t end, const void *context, double *longest) {
  const SimStep *step = context;
  SimParticles *p = step->particles;
  SimF slope = sim_f(6 * step->cubic.gradient_scale);
  PbfMoved moved = pbf_moved_none();
  for (int32_t i = begin; i < end; i += SIM_LANES) {
    SimF own[4], move[3], solid[4];
    sim_load4(p->first + 4 * (size_t)i, own);
    shear_sum(step, p->first, i, own, move);
    for (int k = 0; k < 3; k++) move[k] = slope * move[k];
    WIDE(sim_wall_solid_here)(step, i, own, solid);
    pbf_move(step, i, own, solid, move, p->second, &moved);
  }
  pbf_moved_longest(&moved, longest);
}
