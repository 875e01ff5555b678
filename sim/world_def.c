// The Def of a world: defaults and limits.
#include <math.h>
#include <stdio.h>

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
         in_range("relaxation", def->relaxation, 1e-3f, 10, error) &&
         in_range("tensile", def->tensile, 0, 0.1f, error) && in_range("jitter", def->jitter, 0, 0.5f, error) &&
         finite_vector("gravity", def->gravity, 1e4f, error);
}

static bool check_container(const SimWorldDef *def, SimError *error) {
  float spacing = 2 * def->particle_radius;
  const SimContainer *box = &def->container;
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

static bool check_obstacle(const SimObstacle *obstacle, int32_t index, SimError *error) {
  char name[64];
  snprintf(name, sizeof name, "obstacles[%d]", index);
  if ((int)obstacle->shape < SIM_BOX || obstacle->shape > SIM_CYLINDER)
    return sim_fail(error, "%s: unknown shape %d", name, (int)obstacle->shape);
  if (!finite_vector(name, obstacle->position, 1e6f, error) || !finite_vector(name, obstacle->rotation, 1e6f, error))
    return false;
  int sizes = obstacle->shape == SIM_BOX ? 3 : obstacle->shape == SIM_SPHERE ? 1 : 2;
  for (int k = 0; k < sizes; k++)
    if (!(obstacle->size[k] > 0 && obstacle->size[k] <= 1e6f))
      return sim_fail(error, "%s: size must be in (0, 1e6] m, got %g", name, (double)obstacle->size[k]);
  const float *q = obstacle->rotation;
  if (!(fabsf(q[0]) + fabsf(q[1]) + fabsf(q[2]) + fabsf(q[3]) > 1e-6f) || !isfinite(q[3]))
    return sim_fail(error, "%s: rotation must be a quaternion that is not zero", name);
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
    if (!check_obstacle(&def->obstacles[b].body, b, error)) return false;
  return true;
}
