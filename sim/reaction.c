// Impulses on floating bodies: see reaction.h. The idea that a boundary gets the opposite of what it does to the fluid is
// that of Akinci et al., Versatile Rigid-Fluid Coupling for Incompressible SPH, 2012 (Section 3.3).
#include "sim/reaction.h"

#include <math.h>
#include <string.h>

#include "sim/memory.h"
#include "sim/parallel.h"
#include "sim/wide/wide.h"

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
  sim_release(reaction->notes);
  sim_release(reaction->noted);
  sim_release(reaction->given);
}

bool sim_reaction_reserve(SimReaction *reaction, int32_t count) {
  size_t n = (size_t)count + 1;
  return sim_reserve((void **)&reaction->notes, n, sizeof(SimNote)) &&
         sim_reserve((void **)&reaction->noted, n / SIM_CHUNK + 1, 1);
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

// Where what the body does is noted: its own place, or a free one; where two others stand already, with the second.
static int slot_of(const SimNote *note, int32_t body) {
  int slot = 0;
  while (slot < SIM_FLOATERS - 1 && note->body[slot] >= 0 && note->body[slot] != body) slot++;
  return slot;
}

static void note_clamp(const SimReaction *reaction, SimNote *note, int32_t clamped, float kept, const float free[3],
                       const float to[3], float wedge) {
  if (clamped < 0) return;
  int slot = slot_of(note, clamped);
  if (note->body[slot] < 0) note->body[slot] = clamped;
  add_clamp(reaction, clamped, kept, free, to, wedge, note->shift[slot]);
}

static const SimNote nothing = {.body = {-1, -1}};

void sim_reaction_none(SimReaction *reaction, int32_t begin, int32_t end) {
  for (int32_t i = begin; i < end; i++) reaction->notes[i] = nothing;
}

void sim_reaction_predicted(SimReaction *reaction, int32_t i, int32_t clamped, float kept, const float free[3],
                            const float to[3]) {
  reaction->notes[i] = nothing;
  note_clamp(reaction, &reaction->notes[i], clamped, kept, free, to, reaction->most);
}

void sim_reaction_solid(SimReaction *reaction, int32_t i, const SimSolid *solid) {
  SimNote *note = &reaction->notes[i];
  *note = nothing;
  memcpy(note->body, solid->body, sizeof note->body);
  memcpy(note->gradient, solid->body_gradient, sizeof note->gradient);
}

void sim_reaction_corrected(SimReaction *reaction, int32_t i, const SimAnswer *answer, int32_t clamped, float kept,
                            const float free[3], const float to[3]) {
  SimNote *note = &reaction->notes[i];
  const float *whole = answer->gradient;
  float square = whole[0] * whole[0] + whole[1] * whole[1] + whole[2] * whole[2];
  for (int slot = 0; slot < SIM_FLOATERS; slot++) {
    const float *own = note->gradient[slot];
    float part = square > 0 ? (own[0] * whole[0] + own[1] * whole[1] + own[2] * whole[2]) / square : 0;
    for (int k = 0; k < 3; k++) note->shift[slot][k] = answer->pressure * own[k] + part * answer->aside[k];
  }
  note_clamp(reaction, note, clamped, kept, free, to, 0);
}

// ---- Sums ------------------------------------------------------------------------------------------------------------

static bool any_note(const SimReaction *reaction, int32_t begin, int32_t end) {
  bool any = false;
  for (int32_t i = begin; i < end; i++) any = any || reaction->notes[i].body[0] >= 0;
  return any;
}

typedef struct NotedContext {
  SimReaction *reaction;
  const uint8_t *near;
} NotedContext;

static int32_t chunk_end(int32_t begin, int32_t end) {
  return end - begin < SIM_CHUNK ? end : begin + SIM_CHUNK;
}

static void noted_kernel(int32_t begin, int32_t end, const void *context) {
  const NotedContext *c = context;
  for (int32_t first = begin; first < end; first += SIM_CHUNK)
    c->reaction->noted[first / SIM_CHUNK] =
        (!c->near || c->near[first / SIM_CHUNK] & SIM_NEAR_BODY) && any_note(c->reaction, first, chunk_end(first, end));
}

static void add_push(SimGiven *given, const double arm[3], const double push[3]) {
  for (int k = 0; k < 3; k++) {
    int a = (k + 1) % 3, b = (k + 2) % 3;
    given->linear[k] += push[k];
    given->angular[k] += arm[a] * push[b] - arm[b] * push[a];
  }
}

// From the centre of mass of a floating body, (3), to particle i. Returns the body's slot.
static int32_t arm_of(const SimReaction *reaction, int32_t body, const SimPlaces *places, int32_t i, double arm[3]) {
  int32_t slot = sim_rigid_slot(reaction->rigid, body);
  const double *centre = sim_rigid_centre(reaction->rigid, slot);
  for (int k = 0; k < 3; k++) arm[k] = (double)places->x[k][(int64_t)i * places->stride] - centre[k];
  return slot;
}

static void add_note(SimReaction *reaction, int32_t i, const SimPlaces *places, double scale) {
  const SimNote *note = &reaction->notes[i];
  for (int s = 0; s < SIM_FLOATERS && note->body[s] >= 0; s++) {
    double arm[3], push[3];
    SimGiven *given = &reaction->given[arm_of(reaction, note->body[s], places, i, arm)];
    for (int k = 0; k < 3; k++) push[k] = scale * (double)note->shift[s][k];
    add_push(given, arm, push);
  }
}

void sim_reaction_collect(SimReaction *reaction, int32_t threads, int32_t count, const uint8_t *near,
                          const SimPlaces *places, float inverse_dt) {
  const NotedContext context = {reaction, near};
  sim_parallel_for(threads, count, noted_kernel, &context);
  double scale = -reaction->particle_mass * (double)inverse_dt;
  for (int32_t first = 0; first < count; first += SIM_CHUNK)
    for (int32_t i = first; reaction->noted[first / SIM_CHUNK] && i < chunk_end(first, count); i++)
      add_note(reaction, i, places, scale);
}

// ---- The layer -------------------------------------------------------------------------------------------------------

/// What the kernels of the layer share.
typedef struct LayerContext {
  const SimReaction *reaction;
  const SimParticles *particles;
  SimPlaces places;
} LayerContext;

static LayerContext layer_context(const SimReaction *reaction, const SimParticles *particles) {
  float *const *x = particles->now.position;
  return (LayerContext){reaction, particles, {{x[0], x[1], x[2]}, 1}};
}

static void weigh_chunk(const LayerContext *c, int32_t begin, int32_t end) {
  const SimSorted *now = &c->particles->now;
  const SimBoundary *boundary = c->reaction->boundary;
  float low[3], high[3];
  SimNear near;
  for (int k = 0; k < 3; k++) {
    low[k] = INFINITY, high[k] = -INFINITY;
    for (int32_t i = begin; i < end; i++) {
      low[k] = fminf(low[k], now->position[k][i]);
      high[k] = fmaxf(high[k], now->position[k][i]);
    }
  }
  bool any = sim_boundary_select(boundary, low, high, 0, &near);
  for (int32_t i = begin; i < end; i++) {
    SimNote *note = &c->reaction->notes[i];
    *note = nothing;
    if (!any || !(now->pressure[i] < 0)) continue;
    const float point[3] = {now->position[0][i], now->position[1][i], now->position[2][i]};
    SimSolid solid;
    sim_boundary_solid(boundary, &near, point, &solid);
    memcpy(note->body, solid.body, sizeof note->body);
    memcpy(note->gradient, solid.body_gradient, sizeof note->gradient);
  }
}

static void weigh_kernel(int32_t begin, int32_t end, const void *context) {
  const LayerContext *c = context;
  for (int32_t first = begin; first < end; first += SIM_CHUNK) {
    bool near = c->particles->near[first / SIM_CHUNK] & SIM_NEAR_BODY;
    if (near) weigh_chunk(c, first, chunk_end(first, end));
    c->reaction->noted[first / SIM_CHUNK] = near && any_note(c->reaction, first, chunk_end(first, end));
  }
}

// A particle of the layer cannot but follow the surface's moves along its normal n: as a row, n and r × n. Its weight falls
// from LAYERS at the first layer's place to 0 out of reach: the water behind it follows too, but is out of reach. Cubes of
// 20 kg/m³ let go deep under water explode where the first layer counts once; where it counts twice most do not, and those
// of 40 are well behaved.
#define LAYERS 2.0

static double layer_row(const SimReaction *reaction, const float gradient[3], const double arm[3], double row[6]) {
  double g[3], length = 0;
  for (int k = 0; k < 3; k++) {
    g[k] = (double)gradient[k];
    length += g[k] * g[k];
  }
  length = sqrt(length);
  if (!(length > 0)) return 0;
  for (int k = 0; k < 3; k++) row[k] = g[k] / length;
  for (int k = 0; k < 3; k++) {
    int a = (k + 1) % 3, b = (k + 2) % 3;
    row[3 + k] = arm[a] * row[b] - arm[b] * row[a];
  }
  return LAYERS * fmin(1, length * (double)reaction->inverse_slope);
}

static void add_layer(SimReaction *reaction, int32_t i, const SimPlaces *places) {
  const SimNote *note = &reaction->notes[i];
  for (int s = 0; s < SIM_FLOATERS && note->body[s] >= 0; s++) {
    double arm[3], row[6];
    SimGiven *given = &reaction->given[arm_of(reaction, note->body[s], places, i, arm)];
    double weight = reaction->particle_mass * layer_row(reaction, note->gradient[s], arm, row);
    if (weight == 0) continue;
    for (int r = 0, at = 0; r < 6; r++)
      for (int c = 0; c <= r; c++) given->layer[at++] += weight * row[r] * row[c];
  }
}

void sim_reaction_layer(SimReaction *reaction, int32_t threads, const SimParticles *particles) {
  const LayerContext context = layer_context(reaction, particles);
  int32_t count = particles->count;
  sim_parallel_for(threads, count, weigh_kernel, &context);
  for (int32_t first = 0; first < count; first += SIM_CHUNK)
    for (int32_t i = first; reaction->noted[first / SIM_CHUNK] && i < chunk_end(first, count); i++)
      add_layer(reaction, i, &context.places);
}

static void follow(const LayerContext *c, int32_t i) {
  const SimNote *note = &c->reaction->notes[i];
  for (int s = 0; s < SIM_FLOATERS && note->body[s] >= 0; s++) {
    double arm[3], row[6], along = 0;
    const double *change = c->reaction->given[arm_of(c->reaction, note->body[s], &c->places, i, arm)].change;
    double weight = layer_row(c->reaction, note->gradient[s], arm, row);
    if (weight == 0) continue;
    for (int k = 0; k < 6; k++) along += weight * row[k] * change[k];
    for (int k = 0; k < 3; k++) c->particles->now.velocity[k][i] += (float)(along * row[k]);
  }
}

static void follow_kernel(int32_t begin, int32_t end, const void *context) {
  const LayerContext *c = context;
  for (int32_t first = begin; first < end; first += SIM_CHUNK)
    for (int32_t i = first; c->reaction->noted[first / SIM_CHUNK] && i < chunk_end(first, end); i++) follow(c, i);
}

void sim_reaction_follow(const SimReaction *reaction, int32_t threads, const SimParticles *particles) {
  const LayerContext context = layer_context(reaction, particles);
  sim_parallel_for(threads, particles->count, follow_kernel, &context);
}
