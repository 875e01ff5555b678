// Impulses on floating bodies: see reaction.h. The idea that a boundary gets the opposite of what it does to the fluid is
// that of Akinci et al., Versatile Rigid-Fluid Coupling for Incompressible SPH, 2012 (Section 3.3).
#include "sim/reaction.h"

#include <math.h>
#include <string.h>

#include "sim/memory.h"
#include "sim/parallel.h"

bool sim_reaction_create(SimReaction *reaction, const SimBoundary *boundary, const SimRigid *rigid,
                         double particle_mass) {
  float slope;
  reaction->boundary = boundary;
  reaction->rigid = rigid;
  reaction->particle_mass = particle_mass;
  reaction->walls = *boundary;
  reaction->walls.body_count = 0;
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

void sim_reaction_clear(SimReaction *reaction) {
  memset(reaction->given, 0, (size_t)sim_rigid_floating(reaction->rigid) * sizeof(SimGiven));
}

// ---- Notes -----------------------------------------------------------------------------------------------------------

// The floating body against which the clamp left a particle, −1: none. Where several bodies touch, the nearest one.
static int32_t clamped_by(const SimBoundary *boundary, const float point[3]) {
  int32_t nearest = -1;
  float least = 1.01f * boundary->clearance;
  for (int32_t b = 0; b < boundary->body_count; b++) {
    const SimBody *body = &boundary->bodies[b];
    float normal[3], d2 = 0, reach = body->bound + least;
    for (int k = 0; k < 3; k++) d2 += (point[k] - body->position[k]) * (point[k] - body->position[k]);
    if (!(d2 < reach * reach)) continue;
    float gap = sim_body_distance(body, point, normal);
    if (gap < least) least = gap, nearest = b;
  }
  return nearest >= 0 && boundary->bodies[nearest].floats ? nearest : -1;
}

// What the clamp moved beyond what the container's walls alone would have.
static int32_t clamp_share(const SimReaction *reaction, const float free[3], const float to[3], float shift[3]) {
  if (memcmp(free, to, 3 * sizeof(float)) == 0) return -1;
  int32_t body = clamped_by(reaction->boundary, to);
  if (body < 0) return -1;
  float walls[3] = {free[0], free[1], free[2]};
  sim_boundary_clamp(&reaction->walls, free, walls);
  for (int k = 0; k < 3; k++) shift[k] += to[k] - walls[k];
  return body;
}

static void note(SimReaction *reaction, int32_t i, const float shift[3]) {
  for (int k = 0; k < 3; k++) reaction->shift[k][i] = shift[k];
}

void sim_reaction_predicted(SimReaction *reaction, int32_t i, const float free[3], const float to[3]) {
  float shift[3] = {0, 0, 0};
  reaction->body[i] = clamp_share(reaction, free, to, shift);
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

void sim_reaction_corrected(SimReaction *reaction, int32_t i, float lambda, const float free[3], const float to[3]) {
  float shift[3] = {0, 0, 0};
  if (reaction->body[i] >= 0)
    for (int k = 0; k < 3; k++) shift[k] = lambda * reaction->gradient[k][i];
  int32_t body = clamp_share(reaction, free, to, shift);
  if (reaction->body[i] < 0) reaction->body[i] = body;
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

// The particle belongs to the layer of water that cannot but follow the surface's moves along its normal n: it adds
// m w (n, r × n)(n, r × n)ᵀ, w falling from 1 at the first layer's place to 0 out of reach.
static void add_layer(const SimReaction *reaction, SimGiven *given, int32_t i, const double arm[3]) {
  double g[3], length = 0, row[6];
  for (int k = 0; k < 3; k++) g[k] = (double)reaction->gradient[k][i];
  length = sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
  if (!(length > 0)) return;
  double weight = reaction->particle_mass * fmin(1, length * (double)reaction->inverse_slope);
  for (int k = 0; k < 3; k++) row[k] = g[k] / length;
  for (int k = 0; k < 3; k++) {
    int a = (k + 1) % 3, b = (k + 2) % 3;
    row[3 + k] = arm[a] * row[b] - arm[b] * row[a];
  }
  for (int r = 0, at = 0; r < 6; r++)
    for (int c = 0; c <= r; c++) given->layer[at++] += weight * row[r] * row[c];
}

void sim_reaction_collect(SimReaction *reaction, int32_t threads, int32_t count, const float *x, const float *y,
                          const float *z, int32_t stride, float inverse_dt, bool last) {
  sim_parallel_for(threads, count, noted_kernel, reaction);
  double scale = -reaction->particle_mass * (double)inverse_dt;
  for (int32_t block = 0; block * (int64_t)SIM_BLOCK < count; block++) {
    if (!reaction->noted[block]) continue;
    int64_t begin = block * (int64_t)SIM_BLOCK, end = begin + SIM_BLOCK < count ? begin + SIM_BLOCK : count;
    for (int32_t i = (int32_t)begin; i < end; i++) {
      if (reaction->body[i] < 0) continue;
      int32_t slot = sim_rigid_slot(reaction->rigid, reaction->body[i]);
      const double *centre = sim_rigid_centre(reaction->rigid, slot);
      const int64_t at = (int64_t)i * stride;
      const double arm[3] = {(double)x[at] - centre[0], (double)y[at] - centre[1], (double)z[at] - centre[2]};
      double push[3];
      for (int k = 0; k < 3; k++) push[k] = scale * (double)reaction->shift[k][i];
      add_push(&reaction->given[slot], arm, push);
      if (last) add_layer(reaction, &reaction->given[slot], i, arm);
    }
  }
}
