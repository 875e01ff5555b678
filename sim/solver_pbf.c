// Position based fluids: see solver_pbf.h.
#include "sim/solver_pbf.h"

#include <math.h>
#include <string.h>

#include "sim/parallel.h"

// ---- Predict ---------------------------------------------------------------------------------------------------------

// A push is full on its ray and falls off smoothly (1 − smoothstep) to nothing at its radius.
static void add_push(const SimPush *push, const float point[3], float acceleration[3]) {
  float d[3], along = 0, distance2 = 0;
  for (int k = 0; k < 3; k++) {
    d[k] = point[k] - push->origin[k];
    along += d[k] * push->direction[k];
  }
  for (int k = 0; k < 3; k++) distance2 += d[k] * d[k];
  float t = (distance2 - along * along) / (push->radius * push->radius);
  if (!(t < 1)) return;
  t = t > 0 ? sqrtf(t) : 0;
  float share = 1 - t * t * (3 - 2 * t);
  for (int k = 0; k < 3; k++) acceleration[k] += share * push->acceleration[k];
}

// How much of a move b by the clamp becomes velocity, v + kept b/dt. A particle that is stopped, or taken along by a body,
// gets all of it. One that is squeezed out from between a body and a wall goes a way that has nothing to do with dt; as a
// velocity that would be without bound where dt is small, and shorten dt further. So the clamp makes no particle faster than
// it was or, if that is more, than step->clamp_speed.
static float clamp_kept(const SimStep *step, const float v[3], const float free[3], const float to[3]) {
  float vv = 0, vb = 0, bb = 0;
  for (int k = 0; k < 3; k++) {
    float b = (to[k] - free[k]) * step->inverse_dt;
    vv += v[k] * v[k];
    vb += v[k] * b;
    bb += b * b;
  }
  float most = fmaxf(vv, step->clamp_speed * step->clamp_speed);
  if (!(vv + 2 * vb + bb > most)) return 1;
  return fminf(1, fmaxf(0, (sqrtf(fmaxf(0, vb * vb + bb * (most - vv))) - vb) / bb)); // |v + kept b|² = most
}

static void predict_kernel(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  SimSorted *now = &step->particles->now;
  for (int32_t i = begin; i < end; i++) {
    float from[3], to[3], acceleration[3] = {step->gravity[0], step->gravity[1], step->gravity[2]};
    for (int k = 0; k < 3; k++) from[k] = now->position[k][i];
    for (int32_t p = 0; p < step->push_count; p++) add_push(&step->pushes[p], from, acceleration);
    for (int k = 0; k < 3; k++) {
      float v = now->velocity[k][i] + step->dt * acceleration[k];
      now->next_velocity[k][i] = v;
      to[k] = from[k] + step->dt * v;
    }
    const float free[3] = {to[0], to[1], to[2]};
    int32_t clamped = sim_boundary_clamp(step->boundary, NULL, from, to);
    const float v[3] = {now->next_velocity[0][i], now->next_velocity[1][i], now->next_velocity[2][i]};
    float kept = clamp_kept(step, v, free, to);
    if (step->reaction) sim_reaction_predicted(step->reaction, i, clamped, kept, free, to);
    for (int k = 0; k < 3; k++) {
      now->predicted[k][i] = to[k];
      if (to[k] != free[k]) now->next_velocity[k][i] += kept * (to[k] - free[k]) * step->inverse_dt;
    }
  }
}

void sim_pbf_predict(const SimStep *step) {
  sim_parallel_for(step->threads, step->particles->count, predict_kernel, step);
}

// ---- Pairs -----------------------------------------------------------------------------------------------------------

// A neighbour list is worked off in pieces of up to PIECE: first the differences are gathered, then the kernel is
// evaluated in a loop without branches that the compiler turns into vector instructions, then the sums are taken in
// LANES interleaved parts. The order of all additions is fixed, whatever the instruction set. What is left of a piece up
// to a multiple of LANES is filled with pairs that are too far apart to count.
#define PIECE 64
#define LANES 4

typedef struct Pairs {
  int32_t count; ///< a multiple of LANES
  float dx[PIECE], dy[PIECE], dz[PIECE];
} Pairs;

static void gather_pairs(Pairs *pairs, float *const position[3], int32_t i, const uint32_t *index, int32_t count,
                         float far) {
  const float *x = position[0], *y = position[1], *z = position[2];
  float px = x[i], py = y[i], pz = z[i];
  for (int32_t k = 0; k < count; k++) {
    uint32_t j = index[k];
    pairs->dx[k] = px - x[j];
    pairs->dy[k] = py - y[j];
    pairs->dz[k] = pz - z[j];
  }
  pairs->count = (count + LANES - 1) / LANES * LANES;
  for (int32_t k = count; k < pairs->count; k++) {
    pairs->dx[k] = far;
    pairs->dy[k] = pairs->dz[k] = 0;
  }
}

static float lane_sum(const float lane[LANES]) {
  return (lane[0] + lane[1]) + (lane[2] + lane[3]);
}

// ---- Density and λ ---------------------------------------------------------------------------------------------------

static void boundary_kernel(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  SimParticles *p = step->particles;
  for (int32_t i = begin; i < end; i++) {
    float point[3] = {p->now.predicted[0][i], p->now.predicted[1][i], p->now.predicted[2][i]};
    SimSolid solid;
    sim_boundary_solid(step->boundary, NULL, point, &solid);
    if (step->reaction) sim_reaction_solid(step->reaction, i, &solid);
    p->solid[i] = solid.share;
    for (int k = 0; k < 3; k++) p->solid_gradient[k][i] = solid.gradient[k];
  }
}

void sim_pbf_boundary(const SimStep *step) {
  sim_parallel_for(step->threads, step->particles->count, boundary_kernel, step);
}

/// Sums over the neighbours of one particle, in LANES parts.
typedef struct DensitySums {
  float density[LANES], squares[LANES];
  float gradient[3][LANES];  ///< Σ V ∇W
  float repulsion[3][LANES]; ///< Σ s_corr V ∇W
} DensitySums;

static void add_density(DensitySums *sums, const Pairs *pairs, const SimStep *step, float *over_r) {
  const SimCubic cubic = step->cubic;
  float w[PIECE], g[PIECE], s[PIECE];
  float inverse_reference = 1 / sim_cubic_value(&cubic, 0.2f * cubic.h), tensile = step->tensile;
  float tiny = 1e-6f * cubic.spacing; // two particles in one place push each other nowhere; they do not divide by zero
  for (int32_t k = 0; k < pairs->count; k++) {
    float dx = pairs->dx[k], dy = pairs->dy[k], dz = pairs->dz[k];
    float r = sqrtf(dx * dx + dy * dy + dz * dz);
    w[k] = sim_cubic_value(&cubic, r);
    g[k] = sim_cubic_gradient(&cubic, r);
    over_r[k] = g[k] / (r > tiny ? r : tiny);
    float ratio = w[k] * inverse_reference;
    s[k] = -tensile * (ratio * ratio) * (ratio * ratio) * over_r[k];
  }
  for (int32_t k = 0; k < pairs->count; k += LANES)
    for (int lane = 0; lane < LANES; lane++) {
      int32_t at = k + lane;
      sums->density[lane] += w[at];
      sums->squares[lane] += g[at] * g[at];
      sums->gradient[0][lane] += over_r[at] * pairs->dx[at];
      sums->gradient[1][lane] += over_r[at] * pairs->dy[at];
      sums->gradient[2][lane] += over_r[at] * pairs->dz[at];
      sums->repulsion[0][lane] += s[at] * pairs->dx[at];
      sums->repulsion[1][lane] += s[at] * pairs->dy[at];
      sums->repulsion[2][lane] += s[at] * pairs->dz[at];
    }
}

// λ = −ω C / (Σ_k |∇_k C|² + ε), Eq. 11. The gradient with respect to i itself includes the walls; walls do not move, so
// they have no gradient of their own.
static void finish_density(const SimStep *step, int32_t i, const DensitySums *sums) {
  SimParticles *p = step->particles;
  float density = step->cubic.value_scale + p->solid[i] + lane_sum(sums->density), own = 0, c = density - 1;
  for (int k = 0; k < 3; k++) {
    float gradient = p->solid_gradient[k][i] + lane_sum(sums->gradient[k]);
    own += gradient * gradient;
    p->repulsion[k][i] = lane_sum(sums->repulsion[k]);
  }
  p->density[i] = density;
  p->asymmetry[i] = sqrtf(own) * step->cubic.spacing;
  p->lambda[i] = c > 0 ? -step->omega * c / (lane_sum(sums->squares) + own + step->relaxation) : 0;
}

static void density_kernel(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  const SimNeighbours *lists = step->neighbours;
  Pairs pairs;
  float over_r[PIECE];
  for (int32_t i = begin; i < end; i++) {
    DensitySums sums = {{0}, {0}, {{0}}, {{0}}};
    for (uint32_t k = lists->start[i]; k < lists->end[i]; k += PIECE) {
      uint32_t count = lists->end[i] - k < PIECE ? lists->end[i] - k : PIECE;
      gather_pairs(&pairs, step->particles->now.predicted, i, lists->index + k, (int32_t)count, 2 * step->cubic.h);
      add_density(&sums, &pairs, step, over_r);
      memcpy(lists->gradient + k, over_r, count * sizeof(float));
    }
    finish_density(step, i, &sums);
  }
}

void sim_pbf_density(const SimStep *step) {
  sim_parallel_for(step->threads, step->particles->count, density_kernel, step);
}

// ---- Correction ------------------------------------------------------------------------------------------------------

static void add_weighted(const Pairs *pairs, const float weight[PIECE], float sum[3][LANES]) {
  for (int32_t k = 0; k < pairs->count; k += LANES)
    for (int lane = 0; lane < LANES; lane++) {
      sum[0][lane] += weight[k + lane] * pairs->dx[k + lane];
      sum[1][lane] += weight[k + lane] * pairs->dy[k + lane];
      sum[2][lane] += weight[k + lane] * pairs->dz[k + lane];
    }
}

// Δp_i = Σ_j (λ_i + λ_j + s_corr) ∇W, Eq. 14, s_corr = −k (W(r)/W(Δq))⁴, Δq = 0.2 h, Eq. 13 (summed up with the density).
//
// A wall has no λ of its own: its term is λ_i ∇f only, the gradient of what the wall adds to C_i. Mirroring the
// particle's pressure (2 λ_i) would not be the gradient of any constraint; it drives water round and round along walls.
static void correction(const SimStep *step, int32_t i, float move[3]) {
  const SimParticles *p = step->particles;
  const SimNeighbours *lists = step->neighbours;
  Pairs pairs;
  float sum[3][LANES] = {{0}}, factor[PIECE] = {0}, own = p->lambda[i];
  for (uint32_t k = lists->start[i]; k < lists->end[i]; k += PIECE) {
    uint32_t count = lists->end[i] - k < PIECE ? lists->end[i] - k : PIECE;
    gather_pairs(&pairs, p->now.predicted, i, lists->index + k, (int32_t)count, 0);
    for (uint32_t a = 0; a < count; a++) factor[a] = (own + p->lambda[lists->index[k + a]]) * lists->gradient[k + a];
    for (int32_t a = (int32_t)count; a < pairs.count; a++) factor[a] = 0;
    add_weighted(&pairs, factor, sum);
  }
  for (int k = 0; k < 3; k++) move[k] = lane_sum(sum[k]) + p->repulsion[k][i] + own * p->solid_gradient[k][i];
}

// A correction changes the velocity by Δp/dt, and where the clamp had a say, by what was really moved. Taking Δp itself
// instead of the difference of rounded positions keeps the sum over all particles, the momentum, to the last digits.
static void correct_kernel(int32_t begin, int32_t end, const void *context, double *longest) {
  const SimStep *step = context;
  SimParticles *p = step->particles;
  for (int32_t i = begin; i < end; i++) {
    float from[3], free[3], to[3], move[3], v[3], d2 = 0;
    correction(step, i, move);
    for (int k = 0; k < 3; k++) {
      from[k] = p->now.position[k][i];
      to[k] = free[k] = p->now.predicted[k][i] + move[k];
      v[k] = p->now.next_velocity[k][i] + move[k] * step->inverse_dt;
    }
    int32_t clamped = sim_boundary_clamp(step->boundary, NULL, from, to);
    float kept = clamp_kept(step, v, free, to);
    if (step->reaction) sim_reaction_corrected(step->reaction, i, p->lambda[i], clamped, kept, free, to);
    for (int k = 0; k < 3; k++) {
      p->now.next_velocity[k][i] = v[k] + kept * (to[k] - free[k]) * step->inverse_dt;
      if (to[k] != free[k]) move[k] = to[k] - p->now.predicted[k][i];
      d2 += move[k] * move[k];
      p->scratch[k][i] = to[k];
    }
    if (!((double)d2 <= longest[0])) longest[0] = isnan(d2) ? INFINITY : (double)d2;
  }
}

static void swap3(float *a[3], float *b[3]) {
  for (int k = 0; k < 3; k++) {
    float *t = a[k];
    a[k] = b[k];
    b[k] = t;
  }
}

double sim_pbf_correct(const SimStep *step) {
  SimParticles *p = step->particles;
  double longest = 0;
  sim_parallel_max(step->threads, p->count, 1, correct_kernel, step, &longest);
  swap3(p->now.predicted, p->scratch);
  return sqrt(longest);
}

// ---- Viscosity -------------------------------------------------------------------------------------------------------

static void viscosity_kernel(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  const SimCubic cubic = step->cubic;
  const SimNeighbours *lists = step->neighbours;
  SimParticles *p = step->particles;
  float *const *v = p->now.next_velocity;
  Pairs pairs, velocities;
  float w[PIECE];
  for (int32_t i = begin; i < end; i++) {
    float sum[3][LANES] = {{0}};
    for (uint32_t k = lists->start[i]; k < lists->end[i]; k += PIECE) {
      uint32_t count = lists->end[i] - k < PIECE ? lists->end[i] - k : PIECE;
      gather_pairs(&pairs, p->now.predicted, i, lists->index + k, (int32_t)count, 2 * cubic.h);
      gather_pairs(&velocities, v, i, lists->index + k, (int32_t)count, 0);
      for (int32_t a = 0; a < pairs.count; a++) {
        float dx = pairs.dx[a], dy = pairs.dy[a], dz = pairs.dz[a];
        w[a] = sim_cubic_value(&cubic, sqrtf(dx * dx + dy * dy + dz * dz));
      }
      add_weighted(&velocities, w, sum);
    }
    for (int a = 0; a < 3; a++) p->scratch[a][i] = v[a][i] - step->viscosity * lane_sum(sum[a]);
  }
}

void sim_pbf_viscosity(const SimStep *step) {
  if (step->viscosity <= 0) return;
  sim_parallel_for(step->threads, step->particles->count, viscosity_kernel, step);
  swap3(step->particles->now.next_velocity, step->particles->scratch);
}
