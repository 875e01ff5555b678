// Smoothed particle hydrodynamics: see solver_sph.h; the sweeps are in wide/sph.c.
#include "sim/solver_sph.h"

#include <math.h>

#include "sim/parallel.h"
#include "sim/tension.h"
#include "sim/world.h"

// The speed of sound: c² is this many times the head, so the density error is at most about its inverse.
#define STIFFNESS 100.0
// Spacings that sound may travel in a substep.
#define COURANT 0.4
// Bulk viscosity in units of speed of sound times spacing.
#define BULK 0.5f
// α of the artificial viscosity.
#define ARTIFICIAL 0.02f
// Lists are built anew when a particle may have moved by this share of the support since. A pair that comes into reach
// meanwhile is missed, by both alike; at most it would have added (2 · 0.05)² of W' to a force, 3 % of what a pair can.
#define STALE 0.05f
// How much the speed of sound may change in one substep.
#define RISE 1.01
#define FALL 0.998
// What it must be at least, as a share of what is wanted: when gravity or a push sets in, when water is poured.
#define LEAST 0.5

// ---- Speed of sound --------------------------------------------------------------------------------------------------

enum { HIGHEST, HEAD, HEADS };

// Potential, negative, and total head of the particles, m²/s².
static void head_kernel(int32_t begin, int32_t end, const void *context, double *most) {
  const SimWorld *world = context;
  const SimSorted *now = &world->particles.now;
  for (int32_t i = begin; i < end; i++) {
    double height = 0, v2 = 0;
    for (int k = 0; k < 3; k++) {
      height += (double)world->gravity[k] * (double)now->position[k][i];
      v2 += (double)now->velocity[k][i] * (double)now->velocity[k][i];
    }
    if (height > most[HIGHEST]) most[HIGHEST] = height;
    if (0.5 * v2 - height > most[HEAD]) most[HEAD] = 0.5 * v2 - height;
  }
}

static double sound_wanted(const SimWorld *world) {
  double most[HEADS] = {-INFINITY, -INFINITY}, head, spacing = (double)world->cubic.spacing;
  sim_parallel_max(world->threads, world->particles.count, HEADS, head_kernel, world, most);
  head = most[HIGHEST] + most[HEAD];
  for (int32_t k = 0; k < world->push_count; k++) {
    const float *a = world->pushes[k].acceleration;
    head += (double)sqrtf(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) * (double)world->pushes[k].radius;
  }
  if (!(head < INFINITY)) head = 0;
  // Cohesion presses water together about as much as a drop of two spacings is by its surface.
  head += (double)world->def.surface_tension / ((double)world->def.rest_density * spacing);
  // Where nothing moves and nothing pulls, any speed will do.
  return fmax(sqrt(STIFFNESS * fmax(head, 0)), 10 * spacing);
}

static double sound_now(const SimWorld *world) {
  double wanted = sound_wanted(world);
  if (!(world->sound > 0)) return wanted;
  return fmax(fmin(fmax(wanted, FALL * world->sound), RISE * world->sound), LEAST * wanted);
}

// ---- Lists -----------------------------------------------------------------------------------------------------------

static void to_first_kernel(int32_t begin, int32_t end, const void *context) {
  const SimParticles *p = context;
  float *axes[3];
  sim_particles_second_as_axes(p, axes);
  for (int32_t i = begin; i < end; i++)
    for (int k = 0; k < 4; k++) p->first[4 * (size_t)i + k] = k < 3 ? axes[k][i] : 0;
}

// Lists of the predicted positions: new ones, or those of before where no particle can have moved far.
static bool lists(SimWorld *world, double move, double *since, SimError *error) {
  world->moved += move;
  if (!(world->moved <= (double)(STALE * world->cubic.h)) || world->particles.shuffled)
    return sim_step_neighbours(world, SIM_STAGE_sort, SIM_STAGE_neighbours, since, error);
  sim_parallel_for(world->threads, world->particles.count, to_first_kernel, &world->particles);
  sim_particles_pad(&world->particles, world->particles.first);
  sim_step_lap(world, SIM_STAGE_sort, since);
  return true;
}

// ---- The substep -----------------------------------------------------------------------------------------------------

static void velocity_to_work_kernel(int32_t begin, int32_t end, const void *context) {
  const SimParticles *p = context;
  for (int32_t i = begin; i < end; i++)
    for (int k = 0; k < 4; k++) p->work[4 * (size_t)i + k] = k < 3 ? p->now.next_velocity[k][i] : 0;
}

static bool substep(SimWorld *world, float dt, SimError *error) {
  double since = sim_milliseconds();
  world->sound = sound_now(world);
  SimStep step = sim_step_make(world, dt);
  step.stiffness = (float)(world->sound * world->sound);
  float spread = (float)world->sound * world->cubic.spacing;
  step.bulk = BULK * spread;
  step.viscosity += ARTIFICIAL / 10 * spread;

  sim_step_predict(&step);
  if (!sim_step_check(world, SIM_STAGE_predict, error)) return false;
  sim_step_lap(world, SIM_STAGE_predict, &since);

  float speed = sim_largest_speed(world, world->particles.now.next_velocity);
  double move = (double)dt * (double)(speed + (world->motion.movers ? world->motion.clamp_speed : 0));
  if (!lists(world, move, &since, error)) return false;
  world->profile.neighbour_pairs += world->neighbours.pairs;

  SimParticles *p = step.particles;
  sim_step_tension(&step, &world->def, p->first);
  sim_step_lap(world, SIM_STAGE_tension, &since);

  sim_parallel_for(step.threads, p->count, velocity_to_work_kernel, p);
  sim_particles_pad_zero(p, p->work);
  sim_parallel_for(step.threads, p->count, step.wide->sph_density, &step);
  sim_particles_pad(p, p->second);
  sim_particles_pad_zero(p, p->solid);
  sim_step_lap(world, SIM_STAGE_density, &since);
  sim_parallel_for(step.threads, p->count, step.wide->sph_force, &step);
  sim_step_collect(&step);
  sim_step_lap(world, SIM_STAGE_correct, &since);
  if (!sim_step_check(world, SIM_STAGE_velocity, error)) return false;
  sim_step_lap(world, SIM_STAGE_velocity, &since);

  sim_step_finish(world, &step, &since);
  sim_step_commit(world);
  return true;
}

static double longest(const SimWorld *world) {
  return fmin(COURANT * (double)world->cubic.spacing / sound_now(world), sim_tension_longest(world));
}

const SimMethod sim_method_sph = {.name = "sph", .substep = substep, .longest = longest};
