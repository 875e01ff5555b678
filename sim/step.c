// The stages that every method is made of: see solver.h.
#include <math.h>
#include <string.h>

#include "sim/parallel.h"
#include "sim/world.h"

void sim_step_lap(SimWorld *world, SimStage stage, double *since) {
  double now = sim_milliseconds();
  world->profile.milliseconds[stage] += now - *since;
  *since = now;
}

// XSPH's c stands for a time of 0.1 √(d/g): see diffusion.c.
static float viscosity_share(const SimWorld *world, float dt) {
  const float *g = world->gravity;
  float pull = sqrtf(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
  float steps = pull > 0 ? 10 * dt * sqrtf(pull / world->cubic.spacing) : 1;
  return world->def.viscosity * fminf(steps, 1);
}

// κ − 1 at a support of two spacings, see "Walls" in solver_pbf.h.
#define WALL_ANSWER 0.7f

static float wall_answer(const SimWorld *world) {
  float share = fminf(1, 2 / world->def.support);
  return 1 + WALL_ANSWER * share * share * share;
}

SimStep sim_step_make(SimWorld *world, float dt) {
  SimStep step = {.wide = world->wide,
                  .threads = world->threads,
                  .dt = dt,
                  .inverse_dt = dt > 0 ? 1 / dt : 0,
                  .cubic = world->cubic,
                  .push_count = world->push_count,
                  .pushes = world->pushes,
                  .boundary = &world->boundary,
                  .start = world->motion.movers ? &world->motion.start : &world->boundary,
                  .wall = &world->wall,
                  .particles = &world->particles,
                  .neighbours = &world->neighbours,
                  .clamp_speed = world->motion.clamp_speed,
                  .reaction = world->motion.rigid && dt > 0 ? &world->motion.reaction : NULL,
                  .wall_answer = wall_answer(world),
                  .viscosity_share = viscosity_share(world, dt),
                  .viscosity = world->def.kinematic_viscosity,
                  .colour_diffusion = world->def.colour_diffusion,
                  .confinement = world->def.vorticity};
  memcpy(step.gravity, world->gravity, sizeof step.gravity);
  return step;
}

// ---- Boxes -----------------------------------------------------------------------------------------------------------

/// A box around points.
typedef struct Box {
  float low[3], high[3];
} Box;

static Box box_empty(void) {
  return (Box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}

// Side by side in as many lanes as any processor has, because a compiler may not reorder comparisons by itself.
#define LANES 16

static void box_add(Box *box, int axis, const float *value, int32_t count) {
  float low = box->low[axis], high = box->high[axis];
  int32_t i = 0;
  if (count >= 4 * LANES) {
    float lows[LANES], highs[LANES];
    for (int l = 0; l < LANES; l++) lows[l] = highs[l] = value[l];
    for (i = LANES; i + LANES <= count; i += LANES)
      for (int l = 0; l < LANES; l++) {
        lows[l] = value[i + l] < lows[l] ? value[i + l] : lows[l];
        highs[l] = value[i + l] > highs[l] ? value[i + l] : highs[l];
      }
    for (int l = 0; l < LANES; l++) {
      low = lows[l] < low ? lows[l] : low;
      high = highs[l] > high ? highs[l] : high;
    }
  }
  for (; i < count; i++) {
    low = value[i] < low ? value[i] : low;
    high = value[i] > high ? value[i] : high;
  }
  box->low[axis] = low;
  box->high[axis] = high;
}

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

// The pushes' part of the velocities.
static void push(const SimStep *step, int32_t begin, int32_t end) {
  SimSorted *now = &step->particles->now;
  for (int32_t i = begin; i < end; i++) {
    const float from[3] = {now->position[0][i], now->position[1][i], now->position[2][i]};
    float acceleration[3] = {0, 0, 0};
    for (int32_t p = 0; p < step->push_count; p++) add_push(&step->pushes[p], from, acceleration);
    for (int k = 0; k < 3; k++) now->next_velocity[k][i] += step->dt * acceleration[k];
  }
}

// The pressure from which on a particle counts as held: that of water a quarter of a spacing deep.
#define HELD 0.25f

// Where the particles would go if nothing were in the way, into the axes. Free flight is a parabola, so a particle under no
// pressure goes its way with the mean of both velocities; one that something holds goes with the new one, which is what the
// pressure takes back. Between them it is a matter of degree, or else a breath of pressure would part neighbours that fall
// together. *box is the box around all these ways.
static void fly(const SimStep *step, int32_t begin, int32_t end, float *const axes[3], Box *box) {
  SimSorted *now = &step->particles->now;
  float pull = 0;
  for (int k = 0; k < 3; k++) {
    const float *restrict v = now->velocity[k];
    float *restrict next = now->next_velocity[k], gain = step->dt * step->gravity[k];
    for (int32_t i = begin; i < end; i++) next[i] = v[i] + gain;
    pull += step->gravity[k] * step->gravity[k];
  }
  if (step->push_count > 0) push(step, begin, end);
  float held = -1 / (HELD * sqrtf(pull) * step->cubic.spacing + 1e-20f);
  for (int k = 0; k < 3; k++) {
    const float *restrict x = now->position[k], *restrict before = now->velocity[k], *restrict after = now->next_velocity[k],
                *restrict pressure = now->pressure;
    float *restrict to = axes[k], dt = step->dt;
    for (int32_t i = begin; i < end; i++) {
      float free = 1 - held * pressure[i]; // pressure is negative
      to[i] = x[i] + dt * (after[i] + (free > 0 ? 0.5f * free : 0) * (before[i] - after[i]));
    }
    box_add(box, k, x + begin, end - begin);
    box_add(box, k, to + begin, end - begin);
  }
}

// A particle that is stopped, or taken along by a body, gets all of it. One that is squeezed out from between a body and a
// wall goes a way that has nothing to do with dt; as a velocity that would be without bound where dt is small, and shorten dt
// further. So the clamp makes no particle faster than it was or, if that is more, than step->clamp_speed.
float sim_step_clamp_share(const SimStep *step, const float v[3], const float free[3], const float to[3]) {
  float vv = 0, vb = 0, bb = 0;
  for (int k = 0; k < 3; k++) {
    float b = (to[k] - free[k]) * step->inverse_dt;
    vv += v[k] * v[k];
    vb += v[k] * b;
    bb += b * b;
  }
  float most = fmaxf(vv, step->clamp_speed * step->clamp_speed);
  if (!(vv + 2 * vb + bb > most)) return 1;
  return fminf(1, fmaxf(0, (sqrtf(fmaxf(0, vb * vb + bb * (most - vv))) - vb) / bb)); // |v + share b|² = most
}

static void predict_kernel(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  SimSorted *now = &step->particles->now;
  Box box = box_empty();
  SimNear near;
  float *axes[3];
  sim_particles_second_as_axes(step->particles, axes);
  fly(step, begin, end, axes, &box);
  if (!sim_boundary_select(step->boundary, box.low, box.high, 0, &near)) {
    if (step->reaction) sim_reaction_none(step->reaction, begin, end);
    return;
  }
  for (int32_t i = begin; i < end; i++) {
    float from[3], free[3], to[3], v[3];
    for (int k = 0; k < 3; k++) {
      from[k] = now->position[k][i];
      to[k] = free[k] = axes[k][i];
      v[k] = now->next_velocity[k][i];
    }
    int32_t clamped = sim_boundary_clamp(step->boundary, &near, from, to);
    if (clamped < 0 && to[0] == free[0] && to[1] == free[1] && to[2] == free[2]) {
      if (step->reaction) sim_reaction_none(step->reaction, i, i + 1);
      continue;
    }
    float share = sim_step_clamp_share(step, v, free, to);
    if (step->reaction) sim_reaction_predicted(step->reaction, i, clamped, share, free, to);
    for (int k = 0; k < 3; k++) {
      if (to[k] != free[k]) now->next_velocity[k][i] += share * (to[k] - free[k]) * step->inverse_dt;
      axes[k][i] = to[k];
    }
  }
}

void sim_step_predict(const SimStep *step) {
  SimParticles *p = step->particles;
  float *axes[3];
  sim_parallel_for(step->threads, p->count, predict_kernel, step);
  sim_particles_second_as_axes(p, axes);
  const SimPlaces places = {{axes[0], axes[1], axes[2]}, 1};
  if (step->reaction) sim_reaction_collect(step->reaction, step->threads, p->count, NULL, &places, step->inverse_dt);
}

void sim_step_collect(const SimStep *step) {
  SimParticles *p = step->particles;
  const SimPlaces places = {{p->first, p->first + 1, p->first + 2}, 4};
  if (step->reaction) sim_reaction_collect(step->reaction, step->threads, p->count, p->near, &places, step->inverse_dt);
}

// ---- Neighbours ------------------------------------------------------------------------------------------------------

static bool narrow_container(const SimBoundary *boundary) {
  const SimContainer *box = &boundary->container;
  bool narrow = box->shape != SIM_CONTAINER_BOX;
  for (int k = 0; k < 3; k++) narrow = narrow || box->max[k] - box->min[k] < 2 * boundary->wall.reach;
  return narrow;
}

// What is in reach of each chunk, also after the moves that lists survive. A NaN is in reach of everything.
static void near_kernel(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  const SimBoundary *boundary = step->boundary;
  SimParticles *p = step->particles;
  bool narrow = narrow_container(boundary);
  for (int32_t first = begin; first < end; first += SIM_CHUNK) {
    int32_t count = end - first < SIM_CHUNK ? end - first : SIM_CHUNK;
    Box box = box_empty();
    SimNear near;
    float *axes[3];
    sim_particles_second_as_axes(p, axes);
    for (int k = 0; k < 3; k++) {
      box_add(&box, k, p->now.position[k] + first, count);
      box_add(&box, k, axes[k] + first, count);
    }
    uint8_t found = 0;
    if (sim_boundary_select(boundary, box.low, box.high, 0.5f * step->cubic.h, &near))
      found = near.count != 0 || narrow ? SIM_NEAR_BODY : SIM_NEAR_WALL;
    p->near[first / SIM_CHUNK] = found;
  }
}

bool sim_step_neighbours(SimWorld *world, SimStage sort_stage, SimStage list_stage, double *since, SimError *error) {
  SimParticles *particles = &world->particles;
  float radius = world->cubic.h, *axes[3];
  world->moved = 0;
  if (!sim_particles_sort(particles, &world->sort, radius, world->threads)) return sim_fail(error, "out of memory");
  SimStep step = sim_step_make(world, 0);
  sim_parallel_for(world->threads, particles->count, near_kernel, &step);
  sim_step_lap(world, sort_stage, since);
  sim_particles_second_as_axes(particles, axes);
  SimNeighbourResult result = sim_neighbours_build(&world->neighbours, world->wide, &world->sort.grid, axes,
                                                   particles->count, radius, world->threads);
  sim_step_lap(world, list_stage, since);
  if (result == SIM_NEIGHBOURS_NO_MEMORY) return sim_fail(error, "out of memory");
  if (result == SIM_NEIGHBOURS_CROWDED)
    return sim_fail(error, "neighbours: the particles are crowded into one place, %lld pairs",
                    (long long)world->neighbours.pairs);
  return true;
}

// ---- After the pressure -----------------------------------------------------------------------------------------------

void sim_step_finish(SimWorld *world, const SimStep *from, double *since) {
  SimStep all = *from;
  const SimStep *step = &all;
  all.reaction = world->motion.rigid ? &world->motion.reaction : NULL;
  sim_step_vorticity(step);
  sim_step_lap(world, SIM_STAGE_vorticity, since);
  sim_step_viscosity(step);
  sim_step_friction(step);
  sim_step_lap(world, SIM_STAGE_viscosity, since);
  sim_step_mix(step);
  sim_step_lap(world, SIM_STAGE_mix, since);
}

// ---- Check and commit ------------------------------------------------------------------------------------------------

// A maximum may drop a NaN; a sum keeps it.
static void speed_kernel(int32_t begin, int32_t end, const void *context, double *fastest) {
  float *const *v = context, most[LANES] = {0}, all[LANES] = {0};
  for (int32_t first = begin; first < end; first += LANES)
    for (int l = 0; l < LANES; l++) {
      int32_t i = first + l < end ? first + l : end - 1;
      float v2 = v[0][i] * v[0][i] + v[1][i] * v[1][i] + v[2][i] * v[2][i];
      most[l] = v2 > most[l] ? v2 : most[l];
      all[l] += v2;
    }
  for (int l = 0; l < LANES; l++) {
    if ((double)most[l] > fastest[0]) fastest[0] = (double)most[l];
    if (isnan(all[l])) fastest[0] = INFINITY;
  }
}

// A particle under no pressure flies: nothing but walls and bodies can be in its way, and the clamp follows all of it. So
// it may go this much farther than one that moves in the water; else a few drops of spray decide how long the steps are.
#define FREE_FLIGHT 1.5f

typedef struct CflContext {
  float *const *velocity;
  const float *pressure;
} CflContext;

static void cfl_kernel(int32_t begin, int32_t end, const void *context, double *fastest) {
  const CflContext *c = context;
  float *const *v = c->velocity, most[LANES] = {0}, free_flight = 1 / (FREE_FLIGHT * FREE_FLIGHT);
  for (int32_t first = begin; first < end; first += LANES)
    for (int l = 0; l < LANES; l++) {
      int32_t i = first + l < end ? first + l : end - 1;
      float v2 = v[0][i] * v[0][i] + v[1][i] * v[1][i] + v[2][i] * v[2][i];
      v2 = c->pressure[i] < 0 ? v2 : free_flight * v2;
      most[l] = v2 > most[l] ? v2 : most[l];
    }
  for (int l = 0; l < LANES; l++)
    if ((double)most[l] > fastest[0]) fastest[0] = (double)most[l];
}

float sim_cfl_speed(const SimWorld *world) {
  double fastest = 0;
  CflContext context = {world->particles.now.velocity, world->particles.now.pressure};
  sim_parallel_max(world->threads, world->particles.count, 1, cfl_kernel, &context, &fastest);
  return (float)sqrt(fastest);
}

float sim_largest_speed(const SimWorld *world, float *const velocity[3]) {
  double fastest = 0;
  sim_parallel_max(world->threads, world->particles.count, 1, speed_kernel, velocity, &fastest);
  return (float)sqrt(fastest);
}

bool sim_step_check(SimWorld *world, SimStage stage, SimError *error) {
  float *const *v = world->particles.now.next_velocity;
  if (sim_largest_speed(world, v) <= world->speed_limit) return true;
  for (int32_t i = 0; i < world->particles.count; i++) {
    float speed = sqrtf(v[0][i] * v[0][i] + v[1][i] * v[1][i] + v[2][i] * v[2][i]);
    if (speed <= world->speed_limit) continue;
    if (!isfinite(speed))
      return sim_fail(error, "%s: particle %u has no finite velocity at %.6g s", sim_stage_name(stage),
                      world->particles.now.id[i], world->time);
    return sim_fail(error, "%s: particle %u exploded to %.3g m/s (limit %.3g) at %.6g s", sim_stage_name(stage),
                    world->particles.now.id[i], (double)speed, (double)world->speed_limit, world->time);
  }
  return sim_fail(error, "%s: invalid velocities", sim_stage_name(stage));
}

static void commit_kernel(int32_t begin, int32_t end, const void *context) {
  const SimParticles *p = context;
  for (int32_t i = begin; i < end; i++)
    for (int k = 0; k < 3; k++) p->now.position[k][i] = p->first[4 * (size_t)i + k];
}

void sim_step_commit(SimWorld *world) {
  SimSorted *now = &world->particles.now;
  sim_parallel_for(world->threads, world->particles.count, commit_kernel, &world->particles);
  for (int k = 0; k < 3; k++) {
    float *velocity = now->velocity[k];
    now->velocity[k] = now->next_velocity[k];
    now->next_velocity[k] = velocity;
  }
  world->settled = false;
  world->counts.substeps++;
  world->profile.substeps++;
}
