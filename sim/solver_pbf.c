// Position based fluids: see solver_pbf.h; the sweeps are in wide/pbf.c.
#include "sim/solver_pbf.h"

#include <math.h>
#include <string.h>

#include "sim/parallel.h"
#include "sim/tension.h"
#include "sim/world.h"

// The longest adaptive substep: gravity alone moves a particle from rest by this share of a spacing. Beyond about 0.015 the
// iterations no longer follow and a pool at rest simmers.
#define REST_MOVE 0.01f
// And the speed √(p/ρ) moves it by at most this share. Under pressure, particles that are pushed out of their places are pushed
// back or on by λ times the kernel's second derivative, an oscillator with a frequency of some √(p/ρ)/spacing. A pool of 30
// layers (0.48) has 7e-5 gH left after 5 s, one of 34 (0.54) boils.
#define STIFF_MOVE 0.48f
// Lists are built anew when a particle has moved by this share of the support since. A pair that comes into reach
// meanwhile is missed until the next substep. In the first second of a dam break 0.2 costs a fifth more sorts and searches, and
// anything from 0.3 to 1.5 gives the same density error, 0.6 to 0.8 % as chance will have it.
#define STALE 0.5f
// The radius of the spectrum that the Chebyshev iteration is made for.
#define SPECTRUM 0.7f

static SimStep make_step(SimWorld *world, float dt) {
  SimStep step = sim_step_make(world, dt);
  float strength = world->cubic.lattice_gradient;
  step.omega = world->cubic.omega;
  step.relaxation = world->def.relaxation * strength;
  step.tensile = world->def.tensile / strength;
  step.warm = dt * dt;
  return step;
}

// A sweep that moves particles from the places in `from` to those in `to`. Returns the longest move, m; infinite if a position
// is not finite.
static double move(const SimStep *step, SimReduceKernel *sweep, float *from, float *to) {
  double longest = 0;
  sim_particles_pad(step->particles, from);
  sim_parallel_max(step->threads, step->particles->count, 1, sweep, step, &longest);
  sim_particles_pad(step->particles, to);
  return sqrt(longest);
}

static bool check_move(SimWorld *world, double moved, SimError *error) {
  if (isfinite(moved)) return true;
  const float *x = world->particles.first;
  int32_t i = 0;
  while (i < world->particles.count - 1 && isfinite(x[4 * (size_t)i] + x[4 * (size_t)i + 1] + x[4 * (size_t)i + 2])) i++;
  return sim_fail(error, "%s: particle %u has no finite position at %.6g s", sim_stage_name(SIM_STAGE_correct),
                  world->particles.now.id[i], world->time);
}

static void to_axes_kernel(int32_t begin, int32_t end, const void *context) {
  const SimParticles *p = context;
  float *axes[3];
  sim_particles_second_as_axes(p, axes);
  for (int32_t i = begin; i < end; i++)
    for (int k = 0; k < 3; k++) axes[k][i] = p->first[4 * (size_t)i + k];
}

static bool renew_lists(SimWorld *world, double *since, SimError *error) {
  sim_parallel_for(world->threads, world->particles.count, to_axes_kernel, &world->particles);
  return sim_step_neighbours(world, SIM_STAGE_sort, SIM_STAGE_neighbours, since, error);
}

static void start_to_second_kernel(int32_t begin, int32_t end, const void *context) {
  const SimParticles *p = context;
  for (int32_t i = begin; i < end; i++)
    for (int k = 0; k < 4; k++) p->second[4 * (size_t)i + k] = k < 3 ? p->now.position[k][i] : 0;
}

// What the state brings along: its compression, its unevenness, and the pressure that it was left with. Leaves the corrected
// places in `first`.
static bool warm_start(SimWorld *world, const SimStep *step, double *moved, double *since, SimError *error) {
  SimParticles *p = step->particles;
  SimStep start = *step; // compression that comes from the bodies' moves is new
  start.boundary = step->start;
  start.reaction = NULL;
  sim_parallel_for(step->threads, p->count, step->wide->pbf_inherit, &start);
  sim_particles_pad_zero(p, p->solid);
  *moved = move(step, step->wide->pbf_start, p->first, p->second);
  float *corrected = p->second;
  p->second = p->first;
  p->first = corrected;
  sim_step_collect(step);
  sim_step_lap(world, SIM_STAGE_warm_start, since);
  return check_move(world, *moved, error);
}

// ω_k after ω_(k−1), which is 0 before the first step.
static float next_over(float last) {
  if (last == 0) return 1;
  return 1 / (1 - SPECTRUM * SPECTRUM * last / (last == 1 ? 2 : 4));
}

// The density iterations. λ is never computed from stale neighbours.
static bool solve_density(SimWorld *world, SimStep *step, double *since, SimError *error) {
  SimParticles *p = &world->particles;
  double stale = (double)(STALE * world->cubic.h), moved;
  if (!warm_start(world, step, &moved, since, error)) return false;
  for (int32_t k = 0; k < world->def.iterations; k++) {
    if (moved > stale) {
      if (!renew_lists(world, since, error)) return false;
      moved = 0;
      step->over = 0; // `second` no longer holds what the last iteration changed
    }
    step->over = next_over(step->over);
    step->stabilise = k > 0 && k == world->def.iterations - 1;
    if (step->stabilise) step->reaction = NULL; // no velocity changes, so bodies get nothing
    sim_parallel_for(step->threads, p->count, step->wide->pbf_density, step);
    sim_step_lap(world, SIM_STAGE_density, since);
    double way = move(step, step->wide->pbf_correct, p->second, p->first);
    sim_step_collect(step);
    sim_step_lap(world, SIM_STAGE_correct, since);
    if (!check_move(world, way, error)) return false;
    moved += way;
  }
  return true;
}

typedef struct ScaleContext {
  float *value, factor;
} ScaleContext;

static void scale_kernel(int32_t begin, int32_t end, const void *context) {
  const ScaleContext *c = context;
  for (int32_t i = begin; i < end; i++) c->value[i] *= c->factor;
}

static bool substep(SimWorld *world, float dt, SimError *error) {
  double since = sim_milliseconds();
  SimStep step = make_step(world, dt);

  sim_step_predict(&step);
  if (!sim_step_check(world, SIM_STAGE_predict, error)) return false;
  sim_step_lap(world, SIM_STAGE_predict, &since);

  if (!sim_step_neighbours(world, SIM_STAGE_sort, SIM_STAGE_neighbours, &since, error)) return false;
  world->profile.neighbour_pairs += world->neighbours.pairs;

  sim_parallel_for(step.threads, world->particles.count, start_to_second_kernel, &world->particles);
  sim_particles_pad(&world->particles, world->particles.second);
  sim_step_tension(&step, &world->def, world->particles.second);
  sim_step_lap(world, SIM_STAGE_tension, &since);

  if (!solve_density(world, &step, &since, error)) return false;
  ScaleContext scale = {world->particles.now.pressure, step.inverse_dt * step.inverse_dt};
  sim_parallel_for(step.threads, world->particles.count, scale_kernel, &scale);
  if (!sim_step_check(world, SIM_STAGE_velocity, error)) return false;
  sim_step_lap(world, SIM_STAGE_velocity, &since);

  sim_step_finish(world, &step, &since);
  sim_step_commit(world);
  return true;
}

static void pressure_kernel(int32_t begin, int32_t end, const void *context, double *partial) {
  const float *pressure = context;
  for (int32_t i = begin; i < end; i++) {
    partial[0] -= (double)pressure[i];
    partial[1] += pressure[i] < 0;
  }
}

// m²/s², p/ρ at the bottom: twice the mean of the water under pressure. Not the largest one: where water hits a wall that is far
// higher for a moment, in few particles.
static double bottom_pressure(const SimWorld *world) {
  double sums[2];
  sim_parallel_sum(world->threads, world->particles.count, 2, pressure_kernel, world->particles.now.pressure, sums);
  return sums[1] > 0 ? 2 * sums[0] / sums[1] : 0;
}

static double longest(const SimWorld *world) {
  double pull = (double)sim_pull(world), pressure = bottom_pressure(world), spacing = (double)world->cubic.spacing;
  double rest = pull > 0 ? sqrt((double)REST_MOVE * spacing / pull) : 1.0 / 60;
  double stiff = pressure > 0 ? (double)STIFF_MOVE * spacing / sqrt(pressure) : rest;
  return fmin(fmin(rest, stiff), sim_tension_longest(world));
}

const SimMethod sim_method_pbf = {.name = "pbf", .substep = substep, .longest = longest};
