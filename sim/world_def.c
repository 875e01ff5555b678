// The Def of a world: defaults and limits.
#include <math.h>
#include <stdio.h>

#include "sim/mesh_topology.h"
#include "sim/world.h"

SimObstacleDef sim_default_obstacle_def(void) {
  return (SimObstacleDef){.body = {.shape = SIM_BOX, .size = {1, 1, 1}, .rotation = {0, 0, 0, 1}, .steps = 1},
                          .motion = SIM_STATIC,
                          .period = 1,
                          .max_speed = 1,
                          .density = 500};
}

SimWorldDef sim_default_world_def(void) {
  return (SimWorldDef){.cookie = SIM_DEF_COOKIE,
                       .solver = SIM_SOLVER_PBF,
                       .particle_radius = 0.0175f,
                       .rest_density = 1000,
                       .support = 2,
                       .gravity = {0, -9.81f, 0},
                       .time_step = 0,
                       .cfl = 0.8f,
                       .iterations = 4,
                       .viscosity = 0.01f,
                       .relaxation = 0.1f,
                       .tensile = 0,
                       .container = {{0, 0, 0}, {3, 1.6f, 1}, SIM_CONTAINER_BOX},
                       .kinematic_viscosity = 1e-6f,
                       .seed = 1};
}

// Largest absolute coordinate, in spacings: beyond it single precision no longer resolves a particle's moves.
#define MAX_COORDINATE 1e5f
#define MAX_OBJECTS 65536

static bool in_range(const char *name, float value, float low, float high, SimError *error) {
  if (value >= low && value <= high) return true;
  return sim_fail(error, "%s must be in [%g, %g], got %g", name, (double)low, (double)high, (double)value);
}

static bool finite_vector(const char *name, const float v[3], float limit, SimError *error) {
  for (int k = 0; k < 3; k++)
    if (!(fabsf(v[k]) <= limit))
      return sim_fail(error, "%s: component %d must be finite and at most %g in size, got %g", name, k, (double)limit,
                      (double)v[k]);
  return true;
}

static bool check_numbers(const SimWorldDef *def, SimError *error) {
  if (def->iterations < 1 || def->iterations > 100)
    return sim_fail(error, "iterations must be in [1, 100], got %d", def->iterations);
  if (def->threads < 0 || def->threads > 256)
    return sim_fail(error, "threads must be in [0, 256], got %d", def->threads);
  return in_range("particle_radius", def->particle_radius, 1e-4f, 1, error) &&
         in_range("rest_density", def->rest_density, 1, 1e5f, error) &&
         in_range("support", def->support, 1.5f, 3, error) && in_range("time_step", def->time_step, 0, 10, error) &&
         in_range("cfl", def->cfl, 0.05f, 2, error) && in_range("viscosity", def->viscosity, 0, 0.5f, error) &&
         in_range("kinematic_viscosity", def->kinematic_viscosity, 0, 10, error) &&
         in_range("surface_tension", def->surface_tension, 0, 10, error) &&
         in_range("vorticity", def->vorticity, 0, 1, error) &&
         in_range("colour_diffusion", def->colour_diffusion, 0, 10, error) &&
         in_range("relaxation", def->relaxation, 1e-3f, 10, error) &&
         in_range("tensile", def->tensile, 0, 0.1f, error) && in_range("jitter", def->jitter, 0, 0.5f, error) &&
         in_range("container_friction", def->container_friction, 0, 1, error) &&
         finite_vector("gravity", def->gravity, 1e4f, error);
}

static bool check_container(const SimWorldDef *def, SimError *error) {
  float spacing = 2 * def->particle_radius;
  const SimContainer *box = &def->container;
  if (box->shape != SIM_CONTAINER_BOX && box->shape != SIM_CONTAINER_GLASS)
    return sim_fail(error, "container: unknown shape %d", (int)box->shape);
  if (!finite_vector("container.min", box->min, MAX_COORDINATE * spacing, error) ||
      !finite_vector("container.max", box->max, MAX_COORDINATE * spacing, error))
    return false;
  for (int k = 0; k < 3; k++)
    if (!(box->max[k] - box->min[k] >= spacing))
      return sim_fail(error, "container must be at least one spacing (%g m) wide along axis %d, got %g m",
                      (double)spacing, k, (double)(box->max[k] - box->min[k]));
  return true;
}

bool sim_block_check(const SimBlockDef *block, const char *name, SimError *error) {
  char field[64];
  const char *const names[4] = {"min", "max", "velocity", "colour"};
  const float *const values[4] = {block->min, block->max, block->velocity, block->colour};
  const float limits[4] = {1e6f, 1e6f, 1e4f, 1e3f};
  for (int k = 0; k < 4; k++) {
    snprintf(field, sizeof field, "%s.%s", name, names[k]);
    if (!finite_vector(field, values[k], limits[k], error)) return false;
  }
  for (int k = 0; k < 3; k++)
    if (!(block->min[k] < block->max[k]))
      return sim_fail(error, "%s: min must be below max along axis %d, got %g and %g", name, k, (double)block->min[k],
                      (double)block->max[k]);
  return true;
}

static bool check_size(const SimObstacle *obstacle, const char *name, SimError *error) {
  static const int sizes[SIM_SHAPE_COUNT] = {
      [SIM_BOX] = 3, [SIM_SPHERE] = 1, [SIM_CYLINDER] = 2, [SIM_CAPSULE] = 2, [SIM_STAIRS] = 3, [SIM_MESH] = 0};
  for (int k = 0; k < sizes[obstacle->shape]; k++)
    if (!(obstacle->size[k] > 0 && obstacle->size[k] <= 1e6f))
      return sim_fail(error, "%s: size must be in (0, 1e6] m, got %g", name, (double)obstacle->size[k]);
  if (obstacle->shape == SIM_CAPSULE && !(obstacle->size[1] >= obstacle->size[0]))
    return sim_fail(error, "%s: a capsule must be at least as high as it is wide, %g m, got %g m", name,
                    (double)obstacle->size[0], (double)obstacle->size[1]);
  if (obstacle->shape == SIM_STAIRS && (obstacle->steps < 1 || obstacle->steps > 1000))
    return sim_fail(error, "%s: steps must be in [1, 1000], got %d", name, obstacle->steps);
  return true;
}

static bool check_obstacle(const SimObstacleDef *def, int32_t index, SimError *error) {
  char name[64], field[80];
  const SimObstacle *obstacle = &def->body;
  snprintf(name, sizeof name, "obstacles[%d]", index);
  if ((int)obstacle->shape < 0 || obstacle->shape >= SIM_SHAPE_COUNT)
    return sim_fail(error, "%s: unknown shape %d", name, (int)obstacle->shape);
  if (!finite_vector(name, obstacle->position, 1e6f, error) || !finite_vector(name, obstacle->rotation, 1e6f, error))
    return false;
  if (!check_size(obstacle, name, error)) return false;
  const float *q = obstacle->rotation;
  if (!(fabsf(q[0]) + fabsf(q[1]) + fabsf(q[2]) + fabsf(q[3]) > 1e-6f) || !isfinite(q[3]))
    return sim_fail(error, "%s: rotation must be a quaternion that is not zero", name);
  snprintf(field, sizeof field, "%s.friction", name);
  return in_range(field, def->friction, 0, 1, error);
}

// Obstacles that name the same mesh are checked once.
static bool check_meshes(const SimWorldDef *def, SimError *error) {
  for (int32_t b = 0; b < def->obstacle_count; b++) {
    char name[64];
    bool seen = false;
    const SimObstacle *obstacle = &def->obstacles[b].body;
    if (obstacle->shape != SIM_MESH) continue;
    snprintf(name, sizeof name, "obstacles[%d]", b);
    if (!obstacle->mesh) return sim_fail(error, "%s: a mesh without triangles", name);
    for (int32_t other = 0; other < b && !seen; other++)
      seen = def->obstacles[other].body.shape == SIM_MESH && def->obstacles[other].body.mesh == obstacle->mesh;
    if (!seen && !sim_mesh_check(obstacle->mesh, name, error)) return false;
  }
  return true;
}

bool sim_def_check(const SimWorldDef *def, SimError *error) {
  char name[64];
  if (!def || def->cookie != SIM_DEF_COOKIE) return sim_fail(error, "the Def was not made by sim_default_world_def");
  if (!sim_method(def->solver)) return sim_fail(error, "unknown solver %d", (int)def->solver);
  if (!check_numbers(def, error) || !check_container(def, error)) return false;
  if (def->block_count < 0 || def->block_count > MAX_OBJECTS || (def->block_count > 0 && !def->blocks))
    return sim_fail(error, "blocks: count must be in [0, %d], got %d", MAX_OBJECTS, def->block_count);
  if (def->obstacle_count < 0 || def->obstacle_count > MAX_OBJECTS || (def->obstacle_count > 0 && !def->obstacles))
    return sim_fail(error, "obstacles: count must be in [0, %d], got %d", MAX_OBJECTS, def->obstacle_count);
  for (int32_t b = 0; b < def->block_count; b++) {
    snprintf(name, sizeof name, "blocks[%d]", b);
    if (!sim_block_check(&def->blocks[b], name, error)) return false;
  }
  for (int32_t b = 0; b < def->obstacle_count; b++)
    if (!check_obstacle(&def->obstacles[b], b, error)) return false;
  return check_meshes(def, error);
}
