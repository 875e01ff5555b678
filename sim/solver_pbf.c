// Position based fluids: see solver_pbf.h.
#include "sim/solver_pbf.h"

#include <math.h>

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
    sim_boundary_clamp(step->boundary, from, to);
    for (int k = 0; k < 3; k++) now->predicted[k][i] = to[k];
  }
}

void sim_pbf_predict(const SimStep *step) {
  sim_parallel_for(step->threads, step->particles->count, predict_kernel, step);
}

// ---- Density and λ ---------------------------------------------------------------------------------------------------

static void boundary_kernel(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  SimParticles *p = step->particles;
  for (int32_t i = begin; i < end; i++) {
    float gradient[3], point[3] = {p->now.predicted[0][i], p->now.predicted[1][i], p->now.predicted[2][i]};
    p->solid[i] = sim_boundary_solid(step->boundary, point, gradient);
    for (int k = 0; k < 3; k++) p->solid_gradient[k][i] = gradient[k];
  }
}

void sim_pbf_boundary(const SimStep *step) {
  sim_parallel_for(step->threads, step->particles->count, boundary_kernel, step);
}

// λ = −C / (Σ_k |∇_k C|² + ε), Eq. 11. The gradient with respect to i itself includes the walls; walls do not move, so
// they have no gradient of their own.
static void density_kernel(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  const SimCubic cubic = step->cubic;
  SimParticles *p = step->particles;
  const float *restrict x = p->now.predicted[0], *restrict y = p->now.predicted[1], *restrict z = p->now.predicted[2];
  const uint32_t *restrict start = step->neighbours->start, *restrict index = step->neighbours->index;
  float *restrict pair_gradient = step->neighbours->gradient;
  for (int32_t i = begin; i < end; i++) {
    float px = x[i], py = y[i], pz = z[i];
    float density = cubic.value_scale + p->solid[i], squares = 0;
    float gx = p->solid_gradient[0][i], gy = p->solid_gradient[1][i], gz = p->solid_gradient[2][i];
    for (uint32_t k = start[i]; k < start[i + 1]; k++) {
      uint32_t j = index[k];
      float dx = px - x[j], dy = py - y[j], dz = pz - z[j];
      float r = sqrtf(dx * dx + dy * dy + dz * dz);
      float g = sim_cubic_gradient(&cubic, r);
      float over_r = r > 0 ? g / r : 0;
      density += sim_cubic_value(&cubic, r);
      squares += g * g;
      gx += over_r * dx;
      gy += over_r * dy;
      gz += over_r * dz;
      pair_gradient[k] = over_r;
    }
    float own = gx * gx + gy * gy + gz * gz, c = density - 1;
    p->density[i] = density;
    p->asymmetry[i] = sqrtf(own) * cubic.spacing;
    p->lambda[i] = c > 0 ? -c / (squares + own + step->relaxation) : 0;
  }
}

void sim_pbf_density(const SimStep *step) {
  sim_parallel_for(step->threads, step->particles->count, density_kernel, step);
}

// ---- Correction ------------------------------------------------------------------------------------------------------

// Δp_i = Σ_j (λ_i + λ_j + s_corr) ∇W, Eq. 14, s_corr = −k (W(r)/W(Δq))⁴, Δq = 0.2 h, Eq. 13. A wall answers with the
// pressure of the particle itself (λ_wall = λ_i ≤ 0: it can push, never pull).
static void correct_kernel(int32_t begin, int32_t end, const void *context, double *longest) {
  const SimStep *step = context;
  const SimCubic cubic = step->cubic;
  SimParticles *p = step->particles;
  const float *restrict x = p->now.predicted[0], *restrict y = p->now.predicted[1], *restrict z = p->now.predicted[2];
  const float *restrict lambda = p->lambda, *restrict pair_gradient = step->neighbours->gradient;
  const uint32_t *restrict start = step->neighbours->start, *restrict index = step->neighbours->index;
  float inverse_reference = 1 / sim_cubic_value(&cubic, 0.2f * cubic.h);
  for (int32_t i = begin; i < end; i++) {
    float px = x[i], py = y[i], pz = z[i], own = lambda[i], mx = 0, my = 0, mz = 0;
    for (uint32_t k = start[i]; k < start[i + 1]; k++) {
      uint32_t j = index[k];
      float dx = px - x[j], dy = py - y[j], dz = pz - z[j];
      float w = sim_cubic_value(&cubic, sqrtf(dx * dx + dy * dy + dz * dz)) * inverse_reference;
      float factor = (own + lambda[j] - step->tensile * (w * w) * (w * w)) * pair_gradient[k];
      mx += factor * dx;
      my += factor * dy;
      mz += factor * dz;
    }
    float from[3] = {p->now.position[0][i], p->now.position[1][i], p->now.position[2][i]};
    float to[3] = {px + mx + 2 * own * p->solid_gradient[0][i], py + my + 2 * own * p->solid_gradient[1][i],
                   pz + mz + 2 * own * p->solid_gradient[2][i]};
    sim_boundary_clamp(step->boundary, from, to);
    for (int k = 0; k < 3; k++) p->scratch[k][i] = to[k];
    float d2 = (to[0] - px) * (to[0] - px) + (to[1] - py) * (to[1] - py) + (to[2] - pz) * (to[2] - pz);
    if (!(d2 <= (float)longest[0])) longest[0] = isnan(d2) ? INFINITY : d2;
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

// ---- Velocity --------------------------------------------------------------------------------------------------------

// x + dt v* is computed as in predict, so the difference is exactly zero where nothing was corrected: free fall keeps its
// momentum to the last bit of v*.
static void velocity_kernel(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  SimSorted *now = &step->particles->now;
  for (int k = 0; k < 3; k++)
    for (int32_t i = begin; i < end; i++) {
      float v = now->next_velocity[k][i], free_flight = now->position[k][i] + step->dt * v;
      now->next_velocity[k][i] = v + (now->predicted[k][i] - free_flight) * step->inverse_dt;
    }
}

void sim_pbf_velocity(const SimStep *step) {
  sim_parallel_for(step->threads, step->particles->count, velocity_kernel, step);
}

static void viscosity_kernel(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  const SimCubic cubic = step->cubic;
  SimParticles *p = step->particles;
  const float *restrict x = p->now.predicted[0], *restrict y = p->now.predicted[1], *restrict z = p->now.predicted[2];
  float *const *v = p->now.next_velocity;
  const uint32_t *restrict start = step->neighbours->start, *restrict index = step->neighbours->index;
  for (int32_t i = begin; i < end; i++) {
    float sum[3] = {0, 0, 0};
    for (uint32_t k = start[i]; k < start[i + 1]; k++) {
      uint32_t j = index[k];
      float dx = x[i] - x[j], dy = y[i] - y[j], dz = z[i] - z[j];
      float w = sim_cubic_value(&cubic, sqrtf(dx * dx + dy * dy + dz * dz));
      for (int a = 0; a < 3; a++) sum[a] += w * (v[a][j] - v[a][i]);
    }
    for (int a = 0; a < 3; a++) p->scratch[a][i] = v[a][i] + step->viscosity * sum[a];
  }
}

void sim_pbf_viscosity(const SimStep *step) {
  if (step->viscosity <= 0) return;
  sim_parallel_for(step->threads, step->particles->count, viscosity_kernel, step);
  swap3(step->particles->now.next_velocity, step->particles->scratch);
}
