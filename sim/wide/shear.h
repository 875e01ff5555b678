// A liquid at rest bears no shear: the part of a particle's stress that is not the same in all directions, taken away.
// See "Shear" in solver_pbf.h for what it is good for.
//
// What particle i adds to the stress of the water is its λ times M_i = Σ_j (x_i − x_j) ⊗ V ∇W, about −1. Where the neighbours
// lie unevenly M has a deviatoric part, and the water answers a slow shear like a crystal or a glass. With the tensor
// λ (1 + E), E = e + e², e = −dev(M)/m, m = tr(M)/3, in place of λ the stress is λ m to the second order of e. It is the
// corrected gradient of Bonet & Lok, Variational and momentum preservation aspects of Smooth Particle Hydrodynamic
// formulations, 1999 (section 3.4: it keeps linear and angular momentum), but for its trace and for the inverse, which a
// particle with few neighbours does not have.
//
// A wall counts in M like water at rest would: f along it, and more across it (SimWall.moment).
#ifndef LIDO_SIM_WIDE_SHEAR_H
#define LIDO_SIM_WIDE_SHEAR_H

#include "sim/solver.h"
#include "sim/wide/simd.h"
#include "sim/wide/spline.h"

/// A symmetric tensor: xx, yy, zz, xy, xz, yz.
typedef struct Tensor {
  SimF xx, yy, zz, xy, xz, yz;
} Tensor;

static inline Tensor tensor_zero(void) {
  SimF zero = sim_f(0);
  return (Tensor){zero, zero, zero, zero, zero, zero};
}

/// Adds factor d ⊗ d.
static inline void tensor_add(Tensor *t, SimF factor, SimF dx, SimF dy, SimF dz) {
  SimF fx = factor * dx, fy = factor * dy;
  t->xx = t->xx + fx * dx;
  t->xy = t->xy + fx * dy;
  t->xz = t->xz + fx * dz;
  t->yy = t->yy + fy * dy;
  t->yz = t->yz + fy * dz;
  t->zz = t->zz + factor * dz * dz;
}

// What the walls add to M, −f 1 − N n ⊗ n with n along ∇f. `solid`: gradient and share.
static inline void shear_walls(const SimWallTable *wall, const SimF solid[4], Tensor *m) {
  SimF t = sim_max(sim_min(solid[3], sim_f(1)), sim_f(0)) * sim_f(SIM_WALL_MOMENTS), e[4];
  float place[SIM_LANES];
  uint32_t entry[SIM_LANES];
  sim_store(place, t);
  for (int k = 0; k < SIM_LANES; k++) {
    entry[k] = (uint32_t)(int32_t)place[k];
    place[k] = (float)(int32_t)entry[k];
  }
  sim_gather4(wall->moment, entry, e);
  SimF square = solid[0] * solid[0] + solid[1] * solid[1] + solid[2] * solid[2];
  SimF across = (e[0] + (t - sim_load(place)) * e[1]) / sim_max(square, sim_f(1e-20f));
  tensor_add(m, sim_f(0) - across, solid[0], solid[1], solid[2]);
  m->xx = m->xx - solid[3];
  m->yy = m->yy - solid[3];
  m->zz = m->zz - solid[3];
}

// In water that moves calmly E stays below this. In an impact, where neighbours come from all sides, it would not, and the work
// that it does is taken from nowhere: a block dropped from 3 m then has up to 1.025 of its energy.
#define SHEAR_MOST 0.15f

static inline SimF shear_bound(SimF a) {
  return sim_max(sim_min(a, sim_f(SHEAR_MOST)), sim_f(-SHEAR_MOST));
}

// At a wall the pressure changes within the wall's own reach, and what E takes from the layer it gives to the next: in full, it
// keeps narrow pools simmering (2e-4 gH in 12 × 8 spacings; 5e-5 with this). E falls to nothing where f is 0.4.
#define SHEAR_WALL 2.5f

/// λ E of M where the walls' share is f. Where less than half of the neighbours are there, in spray, nothing; in full from three
/// quarters on.
static inline Tensor shear_of(const Tensor *m, SimF share, SimF lambda) {
  SimF mean = (m->xx + m->yy + m->zz) * sim_f(1.0f / 3);
  SimF whole = sim_max(sim_min(sim_f(-4) * mean - sim_f(2), sim_f(1)), sim_f(0));
  whole = whole * sim_max(sim_f(1) - sim_f(SHEAR_WALL) * share, sim_f(0));
  SimF scale = sim_f(0) - whole / sim_min(mean, sim_f(-0.25f));
  Tensor e = {scale * (m->xx - mean), scale * (m->yy - mean), scale * (m->zz - mean),
              scale * m->xy,          scale * m->xz,          scale * m->yz};
  SimF xx = e.xx * e.xx + e.xy * e.xy + e.xz * e.xz, yy = e.xy * e.xy + e.yy * e.yy + e.yz * e.yz,
       zz = e.xz * e.xz + e.yz * e.yz + e.zz * e.zz, xy = e.xx * e.xy + e.xy * e.yy + e.xz * e.yz,
       xz = e.xx * e.xz + e.xy * e.yz + e.xz * e.zz, yz = e.xy * e.xz + e.yy * e.yz + e.yz * e.zz;
  return (Tensor){lambda * shear_bound(e.xx + xx), lambda * shear_bound(e.yy + yy), lambda * shear_bound(e.zz + zz),
                  lambda * shear_bound(e.xy + xy), lambda * shear_bound(e.xz + xz), lambda * shear_bound(e.yz + yz)};
}

/// Into `solid`, whose gradient has no other use until the next sweep over the walls: λ E of the particles from i on, two numbers
/// to a word, so that a neighbour's tensor is one load like its position, and the walls' share. `sum`: M but for its factor and for the walls.
static inline void shear_store(const SimStep *step, int32_t i, const Tensor *sum, const SimF solid[4], SimF lambda) {
  SimF slope = sim_f(6 * step->cubic.gradient_scale);
  Tensor m = {slope * sum->xx, slope * sum->yy, slope * sum->zz, slope * sum->xy, slope * sum->xz, slope * sum->yz};
  if (step->particles->near[i / SIM_CHUNK]) shear_walls(step->wall, solid, &m);
  Tensor t = shear_of(&m, solid[3], lambda);
  sim_store4(step->particles->solid + 4 * (size_t)i, sim_halves(t.xx, t.yy), sim_halves(t.zz, t.xy), sim_halves(t.xz, t.yz),
             solid[3]);
}

static inline Tensor shear_unpack(const SimF word[4]) {
  return (Tensor){sim_upper_half(word[0]), sim_lower_half(word[0]), sim_upper_half(word[1]),
                  sim_lower_half(word[1]), sim_upper_half(word[2]), sim_lower_half(word[2])};
}

/// Σ_j (λ_i (1 + E_i) + λ_j (1 + E_j)) ∇W but for its factor 6 s/h, of the positions and λ in `four`. The particle that fills up
/// lists has no tensor (sim_particles_pad_zero).
static inline void shear_sum(const SimStep *step, const float *four, int32_t i, const SimF own[4], SimF sum[3]) {
  const Spline s = spline_make(&step->cubic);
  const SimNeighbours *lists = step->neighbours;
  const float *solid = step->particles->solid;
  const int32_t chunk = i / SIM_CHUNK;
  const uint32_t *index = lists->index + (size_t)lists->start[chunk] * SIM_CHUNK + i % SIM_CHUNK, slots = lists->length[chunk];
  SimF word[4];
  sim_load4(solid + 4 * (size_t)i, word);
  Tensor own_shear = shear_unpack(word);
  for (int k = 0; k < 3; k++) sum[k] = s.zero;
  for (uint32_t k = 0; k < slots; k++, index += SIM_CHUNK) {
    SimF other[4], w, over_r;
    sim_gather4(four, index, other);
    sim_gather4(solid, index, word);
    Tensor shear = shear_unpack(word);
    SimF dx = own[0] - other[0], dy = own[1] - other[1], dz = own[2] - other[2];
    spline(&s, dx * dx + dy * dy + dz * dz, &w, &over_r);
    SimF lambda = own[3] + other[3];
    SimF xy = own_shear.xy + shear.xy, xz = own_shear.xz + shear.xz, yz = own_shear.yz + shear.yz;
    dx = dx * over_r, dy = dy * over_r, dz = dz * over_r;
    sum[0] = sum[0] + (lambda + own_shear.xx + shear.xx) * dx + xy * dy + xz * dz;
    sum[1] = sum[1] + xy * dx + (lambda + own_shear.yy + shear.yy) * dy + yz * dz;
    sum[2] = sum[2] + xz * dx + yz * dy + (lambda + own_shear.zz + shear.zz) * dz;
  }
}

#endif
