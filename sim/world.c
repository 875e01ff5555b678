// A world: creation, the step as a list of timed stages, and what the caller does to it.
#include "sim/world.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "sim/memory.h"
#include "sim/parallel.h"

// Neighbour lists reach this much beyond the support, as a share of it.
#define LIST_MARGIN 0.05f
// The longest adaptive substep: gravity alone moves a particle from rest by this share of a spacing. It bounds how far a
// column of water is compressed when the iterations meet it: by about depth/spacing · this / (4 · iterations).
#define REST_MOVE 0.004f

bool sim_fail(SimError *error, const char *format, ...) {
  if (error) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(error->message, sizeof error->message, format, arguments);
    va_end(arguments);
  }
  return false;
}

double sim_milliseconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

const char *sim_stage_name(SimStage stage) {
#define SIM_STAGE_NAME(name) #name,
  static const char *const names[] = {SIM_STAGES(SIM_STAGE_NAME)};
#undef SIM_STAGE_NAME
  return (int)stage >= 0 && stage < SIM_STAGE_COUNT ? names[stage] : NULL;
}

// ---- Creation --------------------------------------------------------------------------------------------------------

static bool copy_array(void **copy, const void *source, int32_t count, size_t element) {
  if (count == 0) return true;
  *copy = sim_allocate((size_t)count * element);
  if (*copy) memcpy(*copy, source, (size_t)count * element);
  return *copy != NULL;
}

// Obstacles that name the same mesh share one copy and one grid.
static bool copy_meshes(SimWorld *world, const SimWorldDef *def) {
  for (int32_t b = 0; b < def->obstacle_count; b++) {
    const SimObstacle *obstacle = &def->obstacles[b].body;
    if (obstacle->shape != SIM_MESH) continue;
    for (int32_t other = 0; other < b && !world->meshes[b]; other++)
      if (world->meshes[other] && def->obstacles[other].body.mesh == obstacle->mesh)
        world->meshes[b] = world->meshes[other];
    if (!world->meshes[b])
      world->meshes[b] = sim_mesh_distance_create(obstacle->mesh, &world->boundary.wall, world->threads);
    if (!world->meshes[b]) return false;
  }
  return true;
}

static void free_meshes(SimWorld *world) {
  for (int32_t b = 0; world->meshes && b < world->def.obstacle_count; b++) {
    SimMeshDistance *mesh = world->meshes[b];
    for (int32_t other = b; other < world->def.obstacle_count; other++)
      if (world->meshes[other] == mesh) world->meshes[other] = NULL;
    sim_mesh_distance_destroy(mesh);
  }
  sim_release(world->meshes);
}

static bool copy_def(SimWorld *world, const SimWorldDef *def) {
  world->def = *def;
  if (!copy_array((void **)&world->blocks, def->blocks, def->block_count, sizeof(SimBlockDef)) ||
      !copy_array((void **)&world->obstacle_defs, def->obstacles, def->obstacle_count, sizeof(SimObstacleDef)) ||
      !(world->obstacles = sim_allocate((size_t)def->obstacle_count * sizeof(SimObstacle))) ||
      !(world->bodies = sim_allocate((size_t)def->obstacle_count * sizeof(SimBody))) ||
      !(world->meshes = sim_allocate((size_t)def->obstacle_count * sizeof(SimMeshDistance *))) ||
      !copy_meshes(world, def))
    return false;
  world->def.blocks = world->blocks;
  world->def.obstacles = world->obstacle_defs;
  for (int32_t b = 0; b < def->obstacle_count; b++) {
    SimObstacle *obstacle = &world->obstacle_defs[b].body;
    obstacle->mesh = world->meshes[b] ? &world->meshes[b]->mesh : NULL;
    world->obstacles[b] = *obstacle;
    world->bodies[b] = sim_body_make(obstacle, world->meshes[b]);
    world->bodies[b].friction = def->obstacles[b].friction;
  }
  return true;
}

static float length3(const float v[3]) {
  return sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

void sim_world_raise_speed_limit(SimWorld *world) {
  float size[3], pull = length3(world->gravity);
  for (int k = 0; k < 3; k++) size[k] = world->def.container.max[k] - world->def.container.min[k];
  for (int32_t p = 0; p < world->push_count; p++) pull += length3(world->pushes[p].acceleration);
  float diagonal = length3(size), limit = fmaxf(100 * diagonal, 50 * sqrtf(2 * pull * diagonal));
  world->speed_limit = fmaxf(world->speed_limit, limit);
}

// Everything back to the start; the particles are those of the blocks.
static bool start(SimWorld *world, SimError *error) {
  world->particles.count = 0;
  world->coloured = false;
  memcpy(world->gravity, world->def.gravity, sizeof world->gravity);
  world->push_count = 0;
  world->time = 0;
  world->advances = 0;
  world->settled = world->failed = false;
  world->counts = (SimCounts){0};
  world->speed_limit = 0;
  sim_world_raise_speed_limit(world);
  if (!sim_motion_reset(world)) return sim_fail(error, "out of memory");
  for (int32_t b = 0; b < world->def.block_count; b++)
    if (sim_fill_block(world, &world->blocks[b], true, error) < 0) return false;
  return sim_world_settle(world, error);
}

SimWorld *sim_world_create(const SimWorldDef *def, SimError *error) {
  if (!sim_def_check(def, error)) return NULL;
  SimWorld *world = sim_allocate(sizeof *world);
  if (!world) {
    sim_fail(error, "out of memory");
    return NULL;
  }
  world->threads = sim_parallel_threads(def->threads);
  world->cubic = sim_cubic_make(2 * def->particle_radius, def->support);
  sim_wall_make(&world->boundary.wall, &world->cubic);
  if (!copy_def(world, def)) {
    sim_fail(error, "out of memory");
    sim_world_destroy(world);
    return NULL;
  }
  world->boundary.container = def->container;
  world->boundary.friction = def->container_friction;
  world->boundary.clearance = def->particle_radius;
  world->boundary.body_count = def->obstacle_count;
  world->boundary.bodies = world->bodies;
  bool ok = sim_motion_create(world) || sim_fail(error, "out of memory");
  if (!ok || !start(world, error)) {
    sim_world_destroy(world);
    return NULL;
  }
  sim_world_clear_profile(world);
  return world;
}

void sim_world_destroy(SimWorld *world) {
  if (!world) return;
  sim_particles_free(&world->particles);
  sim_grid_free(&world->sort);
  sim_grid_free(&world->fill_sort);
  sim_neighbours_free(&world->neighbours);
  for (int k = 0; k < 3; k++) sim_release(world->fill_position[k]);
  sim_motion_destroy(world);
  sim_release(world->colour);
  sim_release(world->blocks);
  sim_release(world->obstacles);
  sim_release(world->obstacle_defs);
  sim_release(world->bodies);
  free_meshes(world);
  sim_release(world);
}

void sim_world_reset(SimWorld *world) {
  // Memory was there for this at creation. If it should be gone now, the world is marked as failed and says so.
  SimError error;
  if (!start(world, &error)) {
    world->failed = true;
    world->failure = error;
  }
}

// ---- The step --------------------------------------------------------------------------------------------------------

static void lap(SimWorld *world, SimStage stage, double *since) {
  double now = sim_milliseconds();
  world->profile.milliseconds[stage] += now - *since;
  *since = now;
}

static SimStep make_step(SimWorld *world, float dt) {
  float strength = world->cubic.lattice_gradient;
  SimStep step = {.threads = world->threads,
                  .dt = dt,
                  .inverse_dt = dt > 0 ? 1 / dt : 0,
                  .cubic = world->cubic,
                  .omega = world->cubic.omega,
                  .relaxation = world->def.relaxation * strength,
                  .tensile = world->def.tensile / strength,
                  .viscosity = world->def.viscosity,
                  .push_count = world->push_count,
                  .pushes = world->pushes,
                  .boundary = &world->boundary,
                  .particles = &world->particles,
                  .neighbours = &world->neighbours,
                  .clamp_speed = world->motion.clamp_speed,
                  .reaction = world->motion.rigid ? &world->motion.reaction : NULL};
  memcpy(step.gravity, world->gravity, sizeof step.gravity);
  return step;
}

// Sort by the given positions and build the lists from the (then sorted) predicted ones.
static bool find_neighbours(SimWorld *world, float *const by[3], SimStage sort_stage, SimStage list_stage,
                            double *since, SimError *error) {
  float radius = world->cubic.h * (1 + LIST_MARGIN);
  SimParticles *particles = &world->particles;
  if (!sim_particles_sort(particles, &world->sort, by, radius, world->threads)) return sim_fail(error, "out of memory");
  lap(world, sort_stage, since);
  SimNeighbourResult result = sim_neighbours_build(&world->neighbours, &world->sort.grid, particles->now.predicted,
                                                   particles->count, radius, world->threads);
  lap(world, list_stage, since);
  if (result == SIM_NEIGHBOURS_NO_MEMORY) return sim_fail(error, "out of memory");
  if (result == SIM_NEIGHBOURS_CROWDED)
    return sim_fail(error, "neighbours: the particles are crowded into one place, %lld pairs",
                    (long long)world->neighbours.pairs);
  return true;
}

static void speed_kernel(int32_t begin, int32_t end, const void *context, double *fastest) {
  float *const *v = context;
  for (int32_t i = begin; i < end; i++) {
    float v2 = v[0][i] * v[0][i] + v[1][i] * v[1][i] + v[2][i] * v[2][i];
    if (!((double)v2 <= fastest[0])) fastest[0] = isnan(v2) ? INFINITY : (double)v2;
  }
}

static float largest_speed(const SimWorld *world, float *const velocity[3]) {
  double fastest = 0;
  sim_parallel_max(world->threads, world->particles.count, 1, speed_kernel, velocity, &fastest);
  return (float)sqrt(fastest);
}

// Whether the velocities can be followed; otherwise name the first particle for which they cannot.
static bool check(SimWorld *world, SimStage stage, SimError *error) {
  float *const *v = world->particles.now.next_velocity;
  if (largest_speed(world, v) <= world->speed_limit) return true;
  for (int32_t i = 0; i < world->particles.count; i++) {
    float speed = length3((float[3]){v[0][i], v[1][i], v[2][i]});
    if (speed <= world->speed_limit) continue;
    if (!isfinite(speed))
      return sim_fail(error, "%s: particle %u has no finite velocity at %.6g s", sim_stage_name(stage),
                      world->particles.now.id[i], world->time);
    return sim_fail(error, "%s: particle %u exploded to %.3g m/s (limit %.3g) at %.6g s", sim_stage_name(stage),
                    world->particles.now.id[i], (double)speed, (double)world->speed_limit, world->time);
  }
  return sim_fail(error, "%s: invalid velocities", sim_stage_name(stage));
}

static bool check_move(SimWorld *world, double moved, SimError *error) {
  if (isfinite(moved)) return true;
  float *const *x = world->particles.now.predicted;
  int32_t i = 0;
  while (i < world->particles.count - 1 && isfinite(x[0][i] + x[1][i] + x[2][i])) i++;
  return sim_fail(error, "%s: particle %u has no finite position at %.6g s", sim_stage_name(SIM_STAGE_correct),
                  world->particles.now.id[i], world->time);
}

// What the sweep over the particles that has just ended gave to floating bodies.
static void collect_reaction(SimWorld *world, const SimStep *step, bool last) {
  float *const *x = world->particles.now.predicted;
  if (step->reaction)
    sim_reaction_collect(step->reaction, world->threads, world->particles.count, x[0], x[1], x[2], 1, step->inverse_dt,
                         last);
}

// The density iterations. λ is never computed from stale neighbours: when the particles have used up the lists' margin,
// the lists are built anew.
static bool solve_density(SimWorld *world, SimStep *step, double *since, SimError *error) {
  float margin = 0.5f * LIST_MARGIN * world->cubic.h;
  double moved = 0;
  for (int32_t k = 0; k < world->def.iterations; k++) {
    if (moved > (double)margin) {
      if (!find_neighbours(world, world->particles.now.predicted, SIM_STAGE_sort, SIM_STAGE_neighbours, since, error))
        return false;
      moved = 0;
    }
    sim_pbf_boundary(step);
    lap(world, SIM_STAGE_boundary, since);
    sim_pbf_density(step);
    lap(world, SIM_STAGE_density, since);
    double move = sim_pbf_correct(step);
    collect_reaction(world, step, k == world->def.iterations - 1);
    lap(world, SIM_STAGE_correct, since);
    if (!check_move(world, move, error)) return false;
    moved += move;
  }
  return true;
}

static void commit(SimWorld *world, double end) {
  SimSorted *now = &world->particles.now;
  for (int k = 0; k < 3; k++) {
    float *position = now->position[k], *velocity = now->velocity[k];
    now->position[k] = now->predicted[k];
    now->predicted[k] = position;
    now->velocity[k] = now->next_velocity[k];
    now->next_velocity[k] = velocity;
  }
  world->settled = false;
  world->time = end;
  world->counts.substeps++;
  world->profile.substeps++;
}

static bool substep(SimWorld *world, double end, SimError *error) {
  double since = sim_milliseconds();
  if (!sim_motion_begin(world, end)) return sim_fail(error, "out of memory");
  SimStep step = make_step(world, (float)(end - world->time));
  world->settled = false;

  sim_pbf_predict(&step);
  collect_reaction(world, &step, false);
  if (!check(world, SIM_STAGE_predict, error)) return false;
  lap(world, SIM_STAGE_predict, &since);

  if (!find_neighbours(world, world->particles.now.predicted, SIM_STAGE_sort, SIM_STAGE_neighbours, &since, error))
    return false;
  world->profile.neighbour_pairs += world->neighbours.pairs;
  if (!solve_density(world, &step, &since, error)) return false;

  if (!check(world, SIM_STAGE_velocity, error)) return false;
  lap(world, SIM_STAGE_velocity, &since);

  sim_pbf_viscosity(&step);
  lap(world, SIM_STAGE_viscosity, &since);

  if (!sim_motion_end(world, end, error)) return false;
  commit(world, end);
  sim_motion_commit(world);
  return true;
}

// The longest substep allowed now: the CFL condition on the fastest particle (including what it will gain), the bound
// from rest, the Def's time step.
static double longest_substep(const SimWorld *world) {
  double spacing = (double)world->cubic.spacing, pull = (double)length3(world->gravity);
  for (int32_t p = 0; p < world->push_count; p++) pull += (double)length3(world->pushes[p].acceleration);
  double longest = pull > 0 ? sqrt((double)REST_MOVE * spacing / pull) : 1.0 / 60;
  if (world->def.time_step > 0 && (double)world->def.time_step < longest) longest = (double)world->def.time_step;
  double speed = (double)largest_speed(world, world->particles.now.velocity) + pull * longest;
  double cfl = speed > 0 ? (double)world->def.cfl * spacing / speed : longest;
  return sim_motion_longest(world, fmin(longest, cfl));
}

bool sim_world_advance(SimWorld *world, double duration, SimError *error) {
  if (world->failed) {
    if (error) *error = world->failure;
    return false;
  }
  if (!(duration > 0) || !isfinite(duration)) return sim_fail(error, "duration must be positive, got %g s", duration);
  sim_world_raise_speed_limit(world);
  double end = world->time + duration;
  for (double rest = duration; rest > 0 && !world->failed;) {
    double substeps = ceil(rest / longest_substep(world) - 1e-6);
    double dt = substeps > 1 ? rest / substeps : rest;
    world->failed = !substep(world, substeps > 1 ? end - (rest - dt) : end, &world->failure);
    if (world->failed) sim_motion_cancel(world);
    rest = substeps > 1 ? rest - dt : 0;
  }
  world->push_count = 0;
  // Always settled between calls, whether or not anyone looks: settling sorts, and the order decides how sums round.
  world->failed = world->failed || !sim_world_settle(world, &world->failure);
  if (!world->failed) {
    world->time = end;
    world->advances++;
  }
  if (world->failed && error) *error = world->failure;
  return !world->failed;
}

bool sim_world_settle(SimWorld *world, SimError *error) {
  if (world->settled) return true;
  double since = sim_milliseconds();
  SimSorted *now = &world->particles.now;
  for (int k = 0; k < 3 && world->particles.count > 0; k++)
    memcpy(now->predicted[k], now->position[k], sizeof(float) * (size_t)world->particles.count);
  if (!find_neighbours(world, now->position, SIM_STAGE_frame, SIM_STAGE_frame, &since, error)) return false;
  SimStep step = make_step(world, 0);
  step.reaction = NULL; // looking at the water pushes nobody
  sim_pbf_boundary(&step);
  sim_pbf_density(&step);
  lap(world, SIM_STAGE_frame, &since);
  world->settled = true;
  return true;
}

// ---- What the caller does to a world ---------------------------------------------------------------------------------

static bool finite3(const float v[3]) {
  return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

bool sim_world_push(SimWorld *world, const SimPush *push) {
  if (world->push_count >= SIM_MAX_PUSHES || !finite3(push->origin) || !finite3(push->direction) ||
      !finite3(push->acceleration) || !isfinite(push->radius) || !(push->radius > 0))
    return false;
  float length = length3(push->direction);
  if (!isfinite(length) || !(length > 0)) return false;
  SimPush *kept = &world->pushes[world->push_count++];
  *kept = *push;
  for (int k = 0; k < 3; k++) kept->direction[k] /= length;
  return true;
}

bool sim_world_set_gravity(SimWorld *world, const float gravity[3]) {
  if (!finite3(gravity)) return false;
  memcpy(world->gravity, gravity, sizeof world->gravity);
  return true;
}

SimCounts sim_world_counts(const SimWorld *world) {
  SimCounts counts = world->counts;
  counts.particles = world->particles.count;
  return counts;
}

const SimProfile *sim_world_profile(const SimWorld *world) {
  return &world->profile;
}

void sim_world_clear_profile(SimWorld *world) {
  world->profile = (SimProfile){0};
}
