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

// A substep is at most this much longer than the one before, and the first one this much shorter than the longest: the
// pressure that the solver starts from has to be built up first, and water that falls meanwhile is compressed.
#define GROWTH 1.5
#define FIRST 0.1

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
      !copy_array((void **)&world->drops, def->drops, def->drop_count, sizeof(SimDropDef)) ||
      !copy_array((void **)&world->emitter_defs, def->emitters, def->emitter_count, sizeof(SimEmitterDef)) ||
      !copy_array((void **)&world->sinks, def->sinks, def->sink_count, sizeof(SimSinkDef)) ||
      !copy_array((void **)&world->waves, def->waves, def->wave_count, sizeof(SimWaveDef)) ||
      !copy_array((void **)&world->obstacle_defs, def->obstacles, def->obstacle_count, sizeof(SimObstacleDef)) ||
      !(world->obstacles = sim_allocate((size_t)def->obstacle_count * sizeof(SimObstacle))) ||
      !(world->bodies = sim_allocate((size_t)def->obstacle_count * sizeof(SimBody))) ||
      !(world->meshes = sim_allocate((size_t)def->obstacle_count * sizeof(SimMeshDistance *))) ||
      !copy_meshes(world, def))
    return false;
  world->def.blocks = world->blocks;
  world->def.drops = world->drops;
  world->def.emitters = world->emitter_defs;
  world->def.sinks = world->sinks;
  world->def.waves = world->waves;
  world->def.obstacles = world->obstacle_defs;
  for (int32_t b = 0; b < def->obstacle_count; b++) {
    SimObstacle *obstacle = &world->obstacle_defs[b].body;
    obstacle->mesh = world->meshes[b] ? &world->meshes[b]->mesh : NULL;
    world->obstacles[b] = *obstacle;
    world->bodies[b] = sim_body_make(obstacle, world->meshes[b]);
    world->bodies[b].friction = def->obstacles[b].friction;
    world->bodies[b].beyond = def->obstacles[b].motion == SIM_STATIC &&
                              sim_boundary_beyond(&def->container, &world->bodies[b], 1e-3f * def->particle_radius);
  }
  return true;
}

static float length3(const float v[3]) {
  return sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

float sim_pull(const SimWorld *world) {
  float pull = length3(world->gravity);
  for (int32_t p = 0; p < world->push_count; p++) pull += length3(world->pushes[p].acceleration);
  return pull;
}

void sim_world_raise_speed_limit(SimWorld *world) {
  float size[3], pull = sim_pull(world);
  for (int k = 0; k < 3; k++) size[k] = world->def.container.max[k] - world->def.container.min[k];
  float diagonal = length3(size), limit = fmaxf(100 * diagonal, 50 * sqrtf(2 * pull * diagonal));
  world->speed_limit = fmaxf(world->speed_limit, limit);
}

static bool is_coloured(const float colour[3]) {
  return colour[0] != 0 || colour[1] != 0 || colour[2] != 0;
}

static bool any_colour(const SimWorldDef *def) {
  bool any = false;
  for (int32_t b = 0; b < def->block_count; b++) any = any || is_coloured(def->blocks[b].colour);
  for (int32_t d = 0; d < def->drop_count; d++) any = any || is_coloured(def->drops[d].colour);
  for (int32_t e = 0; e < def->emitter_count; e++) any = any || is_coloured(def->emitters[e].colour);
  return any;
}

// Everything back to the start; the particles are those of the blocks and drops.
static bool start(SimWorld *world, SimError *error) {
  world->particles.count = 0;
  world->particles.coloured = false;
  world->next_id = world->start_count = 0;
  memcpy(world->gravity, world->def.gravity, sizeof world->gravity);
  world->push_count = 0;
  world->time = world->last_dt = world->sound = 0;
  world->advances = 0;
  world->settled = world->failed = false;
  world->counts = (SimCounts){0};
  world->speed_limit = 0;
  sim_world_raise_speed_limit(world);
  for (int32_t e = 0; e < world->def.emitter_count; e++)
    world->speed_limit = fmaxf(world->speed_limit, 10 * world->emitter_defs[e].speed);
  sim_emitters_reset(&world->emitters);
  if (!sim_particles_reserve(&world->particles, 0)) return sim_fail(error, "out of memory");
  if (!sim_world_reserve(world, error)) return false;
  if (any_colour(&world->def) && !sim_particles_colour(&world->particles, sim_water_colour))
    return sim_fail(error, "out of memory");
  if (!sim_motion_reset(world)) return sim_fail(error, "out of memory");
  for (int32_t b = 0; b < world->def.block_count; b++)
    if (sim_fill_block(world, &world->blocks[b], true, error) < 0) return false;
  for (int32_t d = 0; d < world->def.drop_count; d++)
    if (sim_fill_drop(world, &world->drops[d], true, error) < 0) return false;
  sim_fill_jitter(world);
  world->start_count = world->next_id;
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
  world->wide = sim_wide();
  world->method = sim_method(def->solver);
  world->cubic = sim_cubic_make(2 * def->particle_radius, def->support);
  sim_wall_make(&world->boundary.wall, &world->cubic);
  sim_wall_table_make(&world->wall, &world->boundary.wall);
  if (!copy_def(world, def)) {
    sim_fail(error, "out of memory");
    sim_world_destroy(world);
    return NULL;
  }
  world->particles.with_work = def->solver == SIM_SOLVER_SPH || def->surface_tension > 0 || def->vorticity > 0;
  world->boundary.container = def->container;
  world->boundary.friction = def->container_friction;
  world->boundary.clearance = def->particle_radius;
  world->boundary.body_count = def->obstacle_count;
  world->boundary.bodies = world->bodies;
  bool ok = sim_emitters_make(&world->emitters, world->emitter_defs, def->emitter_count, world->cubic.spacing,
                              world->cubic.h) &&
            sim_motion_create(world);
  if (!ok) sim_fail(error, "out of memory");
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
  sim_emitters_free(&world->emitters);
  sim_release(world->gone);
  sim_motion_destroy(world);
  sim_release(world->blocks);
  sim_release(world->drops);
  sim_release(world->emitter_defs);
  sim_release(world->sinks);
  sim_release(world->waves);
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

// The longest substep allowed now: the CFL condition on the fastest particle (including what it will gain), the
// method's own bound, the Def's time step.
static double longest_substep(const SimWorld *world) {
  double spacing = (double)world->cubic.spacing, pull = (double)sim_pull(world), longest = world->method->longest(world);
  longest = fmin(longest, world->last_dt > 0 ? GROWTH * world->last_dt : FIRST * longest);
  if (world->def.time_step > 0) longest = fmin(longest, (double)world->def.time_step);
  double speed = (double)fmaxf(sim_cfl_speed(world), sim_emit_speed(world, longest)) + pull * longest;
  double cfl = speed > 0 ? (double)world->def.cfl * spacing / speed : longest;
  return sim_motion_longest(world, fmin(longest, cfl));
}

// One substep until the time `end`: of bodies and water, then of what comes and goes.
static bool substep(SimWorld *world, double end, SimError *error) {
  if (!sim_motion_begin(world, end)) return sim_fail(error, "out of memory");
  if (!world->method->substep(world, (float)(end - world->time), error) || !sim_motion_end(world, end, error)) {
    sim_motion_cancel(world);
    return false;
  }
  sim_motion_commit(world);
  world->time = end;
  return sim_swallow(world, error) && sim_emit(world, error);
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
    world->last_dt = dt;
    rest = substeps > 1 ? rest - dt : 0;
  }
  world->push_count = 0;
  // Always settled between calls, whether or not anyone looks: settling sorts, and the order decides how sums round.
  world->failed = world->failed || !sim_world_settle(world, &world->failure);
  if (!world->failed) world->advances++;
  if (world->failed && error) *error = world->failure;
  return !world->failed;
}

static void state_to_axes_kernel(int32_t begin, int32_t end, const void *context) {
  const SimParticles *p = context;
  float *axes[3];
  sim_particles_second_as_axes(p, axes);
  for (int k = 0; k < 3; k++) memcpy(axes[k] + begin, p->now.position[k] + begin, sizeof(float) * (size_t)(end - begin));
}

bool sim_world_settle(SimWorld *world, SimError *error) {
  if (world->settled) return true;
  double since = sim_milliseconds();
  SimParticles *p = &world->particles;
  sim_parallel_for(world->threads, p->count, state_to_axes_kernel, p);
  if (!sim_step_neighbours(world, SIM_STAGE_frame, SIM_STAGE_frame, &since, error)) return false;
  SimStep step = sim_step_make(world, 0);
  step.measure = true;
  sim_parallel_for(step.threads, p->count, step.wide->pbf_density, &step);
  sim_step_lap(world, SIM_STAGE_frame, &since);
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
