#include "sim/wide/walls.h"

#include "sim/wide/kernels.h"

// Free share and its derivative between the two walls of one axis, of which only the nearer one is in reach (see
// SIM_NEAR_WALL).
static inline SimF free_share(const SimStep *step, int axis, SimF x, SimF *slope) {
  const SimWallTable *wall = step->wall;
  SimF low = x - sim_f(step->boundary->container.min[axis]), high = sim_f(step->boundary->container.max[axis]) - x;
  SimF s = sim_max(sim_min(low, high), sim_f(0));
  SimF t = sim_min(s * sim_f(wall->inverse_step), sim_f(SIM_WALL_STEPS));
  float place[SIM_LANES];
  uint32_t entry[SIM_LANES];
  sim_store(place, t);
  for (int k = 0; k < SIM_LANES; k++) entry[k] = (uint32_t)(int32_t)place[k];
  for (int k = 0; k < SIM_LANES; k++) place[k] = (float)(int32_t)entry[k];
  SimF u = t - sim_load(place), e[4];
  sim_gather4(wall->entry, entry, e);
  SimF derivative = e[2] + u * e[3];
  *slope = sim_select_less(low, high, sim_f(0) - derivative, derivative);
  return sim_f(1) - (e[0] + u * e[1]);
}

static void box_solid(const SimStep *step, const SimF own[4], SimF solid[4]) {
  SimF share[3], slope[3], zero = sim_f(0);
  for (int k = 0; k < 3; k++) share[k] = free_share(step, k, own[k], &slope[k]);
  solid[0] = zero - slope[0] * share[1] * share[2];
  solid[1] = zero - share[0] * slope[1] * share[2];
  solid[2] = zero - share[0] * share[1] * slope[2];
  solid[3] = sim_f(1) - share[0] * share[1] * share[2];
}

// The bodies to look at between `from` and `to`; NULL, all of them, where there are so few that choosing is dearer.
#define FEW_BODIES 2
static const SimNear *choose(const SimBoundary *boundary, const SimF from[3], const SimF to[3], int32_t count,
                             SimNear *near) {
  if (boundary->body_count <= FEW_BODIES) return NULL;
  float low[3], high[3];
  for (int k = 0; k < 3; k++) {
    float a[SIM_LANES], b[SIM_LANES];
    sim_store(a, sim_min(from[k], to[k]));
    sim_store(b, sim_max(from[k], to[k]));
    low[k] = a[0], high[k] = b[0];
    for (int32_t lane = 1; lane < SIM_LANES && lane < count; lane++) {
      low[k] = a[lane] < low[k] ? a[lane] : low[k];
      high[k] = b[lane] > high[k] ? b[lane] : high[k];
    }
  }
  sim_boundary_select(boundary, low, high, 0, near);
  return near;
}

// Where a body closes in on a wall, what water is left between them has no room for its spacing, and from both sides the share
// grows to 1 each: a pressure without bound. More than this no share is that leaves a particle its room, four faces in a
// corner.
#define WEDGED 0.5f

static void bodies_solid(const SimStep *step, int32_t i, const SimF own[4], float *solid) {
  SimNear chosen;
  const SimNear *near = choose(step->boundary, own, own, step->particles->count - i, &chosen);
  float lane[3][SIM_LANES];
  for (int k = 0; k < 3; k++) sim_store(lane[k], own[k]);
  for (int32_t k = 0; k < SIM_LANES && i + k < step->particles->count; k++, solid += 4) {
    const float point[3] = {lane[0][k], lane[1][k], lane[2][k]};
    SimSolid found;
    sim_boundary_solid(step->boundary, near, point, &found);
    if (step->reaction) sim_reaction_solid(step->reaction, i + k, &found);
    for (int a = 0; a < 3; a++) solid[a] = found.gradient[a];
    solid[3] = found.share < WEDGED ? found.share : WEDGED;
  }
}

void WIDE(sim_wall_solid_here)(const SimStep *step, int32_t i, const SimF own[4], SimF solid[4]) {
  uint8_t near = step->particles->near[i / SIM_CHUNK];
  for (int k = 0; k < 4; k++) solid[k] = sim_f(0);
  if (near & SIM_NEAR_BODY) {
    float found[4 * SIM_LANES] = {0};
    bodies_solid(step, i, own, found);
    sim_load4(found, solid);
  } else if (near & SIM_NEAR_WALL)
    box_solid(step, own, solid);
}

void WIDE(sim_wall_solid)(const SimStep *step, int32_t i, const SimF own[4], SimF solid[4]) {
  WIDE(sim_wall_solid_here)(step, i, own, solid);
  if (step->particles->near[i / SIM_CHUNK])
    sim_store4(step->particles->solid + 4 * (size_t)i, solid[0], solid[1], solid[2], solid[3]);
}

// Of walls that face each other, with a gap of a layer or two between them, the gradients cancel and there is no "along": the less
// of a gradient a share comes with, the less is done. One wall has 1.6 to 4 shares a spacing, a corner of three has 1.6.
void WIDE(sim_wall_answer)(const SimStep *step, SimF pressure, const SimF solid[4], const SimF move[3],
                           SimWallAnswer *answer) {
  SimF share = sim_max(sim_min(solid[3], sim_f(0.45f)), sim_f(0)), missing = share / (sim_f(1) - share);
  SimF square = solid[0] * solid[0] + solid[1] * solid[1] + solid[2] * solid[2];
  SimF across = (solid[0] * move[0] + solid[1] * move[1] + solid[2] * move[2]) / sim_max(square, sim_f(1e-20f));
  SimF whole = sim_sqrt(square) * sim_f(step->cubic.spacing) / sim_max(share, sim_f(1e-6f));
  missing = missing * sim_max(sim_min(whole - sim_f(0.5f), sim_f(1)), sim_f(0));
  answer->pressure = pressure;
  answer->solid = solid;
  for (int k = 0; k < 3; k++) answer->aside[k] = missing * (move[k] - across * solid[k]);
}

/// An answer lane by lane.
typedef struct Lanes {
  float pressure[SIM_LANES], aside[3][SIM_LANES], solid[3][SIM_LANES];
} Lanes;

static void to_lanes(const SimWallAnswer *answer, Lanes *lanes) {
  sim_store(lanes->pressure, answer->pressure);
  for (int k = 0; k < 3; k++) {
    sim_store(lanes->aside[k], answer->aside[k]);
    sim_store(lanes->solid[k], answer->solid[k]);
  }
}

static SimAnswer answer_of(const Lanes *lanes, int32_t k) {
  return (SimAnswer){lanes->pressure[k],
                     {lanes->aside[0][k], lanes->aside[1][k], lanes->aside[2][k]},
                     {lanes->solid[0][k], lanes->solid[1][k], lanes->solid[2][k]}};
}

void WIDE(sim_wall_note)(const SimStep *step, int32_t i, const SimWallAnswer *answer) {
  static const float still[3] = {0, 0, 0};
  Lanes lanes;
  to_lanes(answer, &lanes);
  for (int32_t k = 0; k < SIM_LANES && i + k < step->particles->count; k++) {
    SimAnswer own = answer_of(&lanes, k);
    sim_reaction_corrected(step->reaction, i + k, &own, -1, 0, still, still);
  }
}

static void clamp_to_bodies(const SimStep *step, int32_t i, const SimWallAnswer *answer, SimF to[3], SimF gain[3]) {
  const SimParticles *p = step->particles;
  SimF start[3];
  SimNear chosen;
  float place[3][SIM_LANES], gained[3][SIM_LANES];
  Lanes lanes;
  to_lanes(answer, &lanes);
  for (int k = 0; k < 3; k++) start[k] = sim_load(p->now.position[k] + i);
  const SimNear *near = choose(step->boundary, start, to, p->count - i, &chosen);
  for (int k = 0; k < 3; k++) {
    sim_store(place[k], to[k]);
    sim_store(gained[k], gain[k]);
  }
  for (int32_t k = 0; k < SIM_LANES && i + k < p->count; k++) {
    float from[3], free[3], at[3], v[3];
    for (int a = 0; a < 3; a++) {
      from[a] = p->now.position[a][i + k];
      free[a] = at[a] = place[a][k];
    }
    int32_t clamped = sim_boundary_clamp(step->boundary, near, from, at);
    if (!step->reaction && at[0] == free[0] && at[1] == free[1] && at[2] == free[2]) continue;
    for (int a = 0; a < 3; a++) v[a] = p->now.next_velocity[a][i + k] + gained[a][k] * step->inverse_dt;
    float share = sim_step_clamp_share(step, v, free, at);
    if (step->reaction) {
      SimAnswer own = answer_of(&lanes, k);
      sim_reaction_corrected(step->reaction, i + k, &own, clamped, share, free, at);
    }
    for (int a = 0; a < 3; a++) {
      place[a][k] = at[a];
      if (at[a] != free[a]) gained[a][k] += share * (at[a] - free[a]);
    }
  }
  for (int k = 0; k < 3; k++) {
    to[k] = sim_load(place[k]);
    gain[k] = sim_load(gained[k]);
  }
}

void WIDE(sim_wall_clamp)(const SimStep *step, int32_t i, const SimWallAnswer *answer, const SimF own[3], SimF move[3],
                          SimF to[3], SimF gain[3]) {
  const SimBoundary *b = step->boundary;
  SimF free[3] = {to[0], to[1], to[2]};
  bool bodies = step->particles->near[i / SIM_CHUNK] & SIM_NEAR_BODY;
  // A NaN passes through and is caught by the world, not hidden: see sim_max and sim_min.
  if (bodies)
    clamp_to_bodies(step, i, answer, to, gain);
  else
    for (int k = 0; k < 3; k++)
      to[k] = sim_max(sim_f(b->container.min[k] + b->clearance),
                      sim_min(sim_f(b->container.max[k] - b->clearance), to[k]));
  for (int k = 0; k < 3; k++) {
    SimF left = to[k] - own[k];
    move[k] = sim_select_less(to[k], free[k], left, sim_select_less(free[k], to[k], left, move[k]));
    if (!bodies) gain[k] = gain[k] + (to[k] - free[k]);
  }
}
