// Impulses on floating bodies: see reaction.h. The idea that a boundary gets the opposite of what it does to the fluid is
// that of Akinci et al., Versatile Rigid-Fluid Coupling for Incompressible SPH, 2012 (Section 3.3).
#include "sim/reaction.h"

#include <math.h>
#include <string.h>

#include "sim/memory.h"
#include "sim/parallel.h"

/// The clamp leaves a particle that is free to go at one clearance, to some thousandths.
#define WEDGED 0.98f

bool sim_reaction_create(SimReaction *reaction, const SimBoundary *boundary, const SimRigid *rigid,
                         double particle_mass) {
  float slope;
  reaction->boundary = boundary;
  reaction->rigid = rigid;
  reaction->particle_mass = particle_mass;
  sim_wall_share(&boundary->wall, boundary->clearance, &slope);
  reaction->inverse_slope = -1 / slope;
  reaction->given = sim_allocate((size_t)sim_rigid_floating(rigid) * sizeof(SimGiven));
  return reaction->given != NULL;
}

void sim_reaction_destroy(SimReaction *reaction) {
  sim_release(reaction->body);
  sim_release(reaction->noted);
  sim_release(reaction->given);
  for (int k = 0; k < 3; k++) {
    sim_release(reaction->gradient[k]);
    sim_release(reaction->shift[k]);
  }
}

bool sim_reaction_reserve(SimReaction *reaction, int32_t count) {
  size_t n = (size_t)count + 1;
  bool ok = sim_reserve((void **)&reaction->body, n, sizeof(int32_t)) &&
            sim_reserve((void **)&reaction->noted, n / SIM_BLOCK + 1, 1);
  for (int k = 0; ok && k < 3; k++)
    ok = sim_reserve((void **)&reaction->gradient[k], n, sizeof(float)) &&
         sim_reserve((void **)&reaction->shift[k], n, sizeof(float));
  return ok;
}

float sim_reaction_recovery(float spacing) {
  return sqrtf(9.81f * spacing);
}

void sim_reaction_clear(SimReaction *reaction, float dt) {
  reaction->most = dt * sim_reaction_recovery(2 * reaction->boundary->clearance);
  memset(reaction->given, 0, (size_t)sim_rigid_floating(reaction->rigid) * sizeof(SimGiven));
}

// ---- Notes -----------------------------------------------------------------------------------------------------------

// What the clamp moved beyond what the container's walls alone would have. A particle that is wedged between a body and a
// wall cannot go where the body wants it: the wall holds it. The body feels that all the same, once a substep, by up to
// `wedge` (m; otherwise 0); else it would sink into a wetted floor as if nothing were there.
static void add_clamp(const SimReaction *reaction, int32_t body, float kept, const float free[3], const float to[3],
                      float wedge, float shift[3]) {
  float walls[3] = {free[0], free[1], free[2]}, normal[3] = {0, 0, 0}, missing = 0;
  float clearance = reaction->boundary->clearance;
  sim_boundary_into_container(reaction->boundary, clearance, walls);
  if (wedge > 0) {
    float gap = sim_body_distance(&reaction->boundary->bodies[body], to, normal);
    missing = gap < WEDGED * clearance ? fminf(clearance - gap, wedge) : 0;
  }
  for (int k = 0; k < 3; k++) shift[k] += kept * (to[k] - walls[k]) + missing * normal[k];
}

static void note(SimReaction *reaction, int32_t i, const float shift[3]) {
  for (int k = 0; k < 3; k++) reaction->shift[k][i] = shift[k];
}

void sim_reaction_predicted(SimReaction *reaction, int32_t i, int32_t clamped, float kept, const float free[3],
                            const float to[3]) {
  float shift[3] = {0, 0, 0};
  if (clamped >= 0) add_clamp(reaction, clamped, kept, free, to, reaction->most, shift);
  reaction->body[i] = clamped;
  for (int k = 0; k < 3; k++) reaction->gradient[k][i] = 0;
  note(reaction, i, shift);
}

void sim_reaction_solid(SimReaction *reaction, int32_t i, const SimSolid *solid) {
  reaction->body[i] = solid->body;
  for (int k = 0; k < 3; k++) {
    reaction->gradient[k][i] = solid->body_gradient[k];
    reaction->shift[k][i] = 0;
  }
}

void sim_reaction_corrected(SimReaction *reaction, int32_t i, float lambda, int32_t clamped, float kept,
                            const float free[3], const float to[3]) {
  float shift[3] = {0, 0, 0};
  if (reaction->body[i] >= 0)
    for (int k = 0; k < 3; k++) shift[k] = lambda * reaction->gradient[k][i];
  if (clamped >= 0) add_clamp(reaction, clamped, kept, free, to, 0, shift);
  if (reaction->body[i] < 0) reaction->body[i] = clamped;
  note(reaction, i, shift);
}

void sim_reaction_rubbed(SimReaction *reaction, int32_t i, const float shift[3]) {
  for (int k = 0; k < 3; k++) reaction->shift[k][i] += shift[k];
}

// ---- Sums ------------------------------------------------------------------------------------------------------------

static void noted_kernel(int32_t begin, int32_t end, const void *context) {
  const SimReaction *reaction = context;
  for (int32_t i = begin; i < end; i++)
    if (i % SIM_BLOCK == 0 || i == begin) {
      int32_t stop = i - i % SIM_BLOCK + SIM_BLOCK, any = 0;
      for (int32_t j = i; j < end && j < stop; j++) any |= reaction->body[j] >= 0;
      reaction->noted[i / SIM_BLOCK] = (uint8_t)any;
    }
}

static void add_push(SimGiven *given, const double arm[3], const double push[3]) {
  for (int k = 0; k < 3; k++) {
    int a = (k + 1) % 3, b = (k + 2) % 3;
    given->linear[k] += push[k];
    given->angular[k] += arm[a] * push[b] - arm[b] * push[a];
  }
}

// A particle that is pressed by the body belongs to the layer of water that cannot but follow the surface's moves along its
// normal n: as a row, n and r × n. Its weight falls from 1 at the first layer's place to 0 out of reach.
static double layer_row(const SimReaction *reaction, int32_t i, const double arm[3], double row[6]) {
  double g[3], length = 0;
  bool pressed = false;
  for (int k = 0; k < 3; k++) {
    g[k] = (double)reaction->gradient[k][i];
    length += g[k] * g[k];
    pressed = pressed || reaction->shift[k][i] != 0;
  }
  length = sqrt(length);
  if (!pressed || !(length > 0)) return 0;
  for (int k = 0; k < 3; k++) row[k] = g[k] / length;
  for (int k = 0; k < 3; k++) {
    int a = (k + 1) % 3, b = (k + 2) % 3;
    row[3 + k] = arm[a] * row[b] - arm[b] * row[a];
  }
  return fmin(1, length * (double)reaction->inverse_slope);
}

static void add_layer(const SimReaction *reaction, SimGiven *given, int32_t i, const double arm[3]) {
  double row[6], weight = reaction->particle_mass * layer_row(reaction, i, arm, row);
  if (weight == 0) return;
  for (int r = 0, at = 0; r < 6; r++)
    for (int c = 0; c <= r; c++) given->layer[at++] += weight * row[r] * row[c];
}

/// Where the particles are, for the sums and for sim_reaction_follow.
typedef struct Places {
  const SimReaction *reaction;
  const float *x[3];
  int32_t stride;
  float *const *velocity;
} Places;

static int32_t arm_of(const Places *places, int32_t i, double arm[3]) {
  int32_t slot = sim_rigid_slot(places->reaction->rigid, places->reaction->body[i]);
  const double *centre = sim_rigid_centre(places->reaction->rigid, slot);
  for (int k = 0; k < 3; k++) arm[k] = (double)places->x[k][(int64_t)i * places->stride] - centre[k];
  return slot;
}

void sim_reaction_collect(SimReaction *reaction, int32_t threads, int32_t count, const float *x, const float *y,
                          const float *z, int32_t stride, float inverse_dt, bool last) {
  const Places places = {reaction, {x, y, z}, stride, NULL};
  double scale = -reaction->particle_mass * (double)inverse_dt, arm[3], push[3];
  sim_parallel_for(threads, count, noted_kernel, reaction);
  for (int32_t block = 0; block * (int64_t)SIM_BLOCK < count; block++) {
    if (!reaction->noted[block]) continue;
    int32_t begin = block * SIM_BLOCK, end = count - begin < SIM_BLOCK ? count : begin + SIM_BLOCK;
    for (int32_t i = begin; i < end; i++) {
      if (reaction->body[i] < 0) continue;
      SimGiven *given = &reaction->given[arm_of(&places, i, arm)];
      for (int k = 0; k < 3; k++) push[k] = scale * (double)reaction->shift[k][i];
      add_push(given, arm, push);
      if (last) add_layer(reaction, given, i, arm);
    }
  }
}

static void follow_kernel(int32_t begin, int32_t end, const void *context) {
  const Places *places = context;
  double arm[3], row[6];
  for (int32_t i = begin; i < end; i++) {
    if (places->reaction->body[i] < 0) continue;
    const double *change = places->reaction->given[arm_of(places, i, arm)].change;
    double along = 0, weight = layer_row(places->reaction, i, arm, row);
    if (weight == 0) continue;
    for (int k = 0; k < 6; k++) along += weight * row[k] * change[k];
    for (int k = 0; k < 3; k++) places->velocity[k][i] += (float)(along * row[k]);
  }
}

void sim_reaction_follow(const SimReaction *reaction, int32_t threads, int32_t count, const float *x, const float *y,
                         const float *z, int32_t stride, float *const velocity[3]) {
  const Places places = {reaction, {x, y, z}, stride, velocity};
  sim_parallel_for(threads, count, follow_kernel, &places);
}
