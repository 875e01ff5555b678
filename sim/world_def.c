// The Def of a world: defaults and limits.
#include <math.h>
#include <stdio.h>

#include "sim/mesh_topology.h"
#include "sim/ripple.h"
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
                       .cfl = 1.1f,
                       .iterations = 4,
                       .viscosity = 0.04f,
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
         in_range("kinematic_viscosity", def->kinematic_viscosity, 0, 10, error) &&
         in_range("surface_tension", def->surface_tension, 0, 10, error) &&
         in_range("vorticity", def->vorticity, 0, 1, error) &&
         in_range("colour_diffusion", def->colour_diffusion, 0, 10, error) &&
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

// Vectors of an object, each with its name and limit, up to one without a name.
typedef struct Vector {
  const char *name;
  const float *value;
  float limit;
} Vector;

static bool finite_vectors(const char *object, const Vector *vectors, SimError *error) {
  char field[128];
  for (; vectors->name; vectors++) {
    snprintf(field, sizeof field, "%s.%s", object, vectors->name);
    if (!finite_vector(field, vectors->value, vectors->limit, error)) return false;
  }
  return true;
}

static bool growing(const char *name, const float low[3], const float high[3], SimError *error) {
  for (int k = 0; k < 3; k++)
    if (!(low[k] < high[k]))
      return sim_fail(error, "%s: min must be below max along axis %d, got %g and %g", name, k, (double)low[k],
                      (double)high[k]);
  return true;
}

bool sim_block_check(const SimBlockDef *block, const char *name, SimError *error) {
  const Vector vectors[] = {{"min", block->min, 1e6f},
                            {"max", block->max, 1e6f},
                            {"velocity", block->velocity, 1e4f},
                            {"colour", block->colour, 1e3f},
                            {0}};
  return finite_vectors(name, vectors, error) && growing(name, block->min, block->max, error);
}

static bool positive(const char *object, const char *name, float value, SimError *error) {
  if (value > 0 && value <= 1e6f) return true;
  return sim_fail(error, "%s.%s must be in (0, 1e6] m, got %g", object, name, (double)value);
}

bool sim_drop_check(const SimDropDef *drop, const char *name, SimError *error) {
  const Vector vectors[] = {
      {"centre", drop->centre, 1e6f}, {"velocity", drop->velocity, 1e4f}, {"colour", drop->colour, 1e3f}, {0}};
  return finite_vectors(name, vectors, error) && positive(name, "radius", drop->radius, error);
}

static bool check_opening(const SimEmitterDef *emitter, const char *name, float spacing, SimError *error) {
  if (emitter->shape != SIM_EMITTER_DISC && emitter->shape != SIM_EMITTER_RECTANGLE)
    return sim_fail(error, "%s.shape: unknown shape %d", name, (int)emitter->shape);
  int sizes = emitter->shape == SIM_EMITTER_DISC ? 1 : 2;
  for (int k = 0; k < sizes; k++)
    if (!positive(name, "size", emitter->size[k], error)) return false;
  double places = sim_emitter_places(emitter, spacing);
  if (places > SIM_MAX_LAYER)
    return sim_fail(error, "%s.size: a layer has %.0f particles, at most %d", name, places, SIM_MAX_LAYER);
  return true;
}

static bool check_emitter(const SimWorldDef *def, const SimEmitterDef *emitter, const char *name, SimError *error) {
  const Vector vectors[] = {{"position", emitter->position, 1e6f},
                            {"rotation", emitter->rotation, 1e6f},
                            {"rotation", emitter->rotation + 1, 1e6f},
                            {"colour", emitter->colour, 1e3f},
                            {0}};
  if (!check_opening(emitter, name, 2 * def->particle_radius, error) || !finite_vectors(name, vectors, error))
    return false;
  const float *q = emitter->rotation;
  if (!(fabsf(q[0]) + fabsf(q[1]) + fabsf(q[2]) + fabsf(q[3]) > 1e-6f))
    return sim_fail(error, "%s.rotation must be a quaternion that is not zero", name);
  if (!(emitter->speed >= 0.01f && emitter->speed <= 100))
    return sim_fail(error, "%s.speed must be in [0.01, 100] m/s, got %g", name, (double)emitter->speed);
  if (!isfinite(emitter->start)) return sim_fail(error, "%s.start must be finite, got %g", name, emitter->start);
  if (!(emitter->stop >= emitter->start))
    return sim_fail(error, "%s.stop must not be before its start, %g s, got %g", name, emitter->start, emitter->stop);
  if (emitter->obstacle < -1 || emitter->obstacle >= def->obstacle_count)
    return sim_fail(error, "%s.obstacle must be in [-1, %d], got %d", name, def->obstacle_count - 1, emitter->obstacle);
  return true;
}

static bool check_sink(const SimSinkDef *sink, const char *name, SimError *error) {
  const Vector vectors[] = {{"min", sink->min, 1e6f}, {"max", sink->max, 1e6f}, {0}};
  return finite_vectors(name, vectors, error) && growing(name, sink->min, sink->max, error);
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

static bool check_count(const char *name, int32_t count, const void *array, SimError *error) {
  if (count >= 0 && count <= MAX_OBJECTS && (count == 0 || array)) return true;
  return sim_fail(error, "%s: count must be in [0, %d], got %d%s", name, MAX_OBJECTS, count,
                  array ? "" : " and no array");
}

static bool check_counts(const SimWorldDef *def, SimError *error) {
  if (def->max_particles < 0 || def->max_particles > SIM_MAX_PARTICLES)
    return sim_fail(error, "max_particles must be in [0, %d], got %d", SIM_MAX_PARTICLES, def->max_particles);
  return check_count("blocks", def->block_count, def->blocks, error) &&
         check_count("drops", def->drop_count, def->drops, error) &&
         check_count("emitters", def->emitter_count, def->emitters, error) &&
         check_count("sinks", def->sink_count, def->sinks, error) &&
         check_count("obstacles", def->obstacle_count, def->obstacles, error);
}

static bool check_sources(const SimWorldDef *def, SimError *error) {
  char name[64];
  for (int32_t b = 0; b < def->block_count; b++) {
    snprintf(name, sizeof name, "blocks[%d]", b);
    if (!sim_block_check(&def->blocks[b], name, error)) return false;
  }
  for (int32_t d = 0; d < def->drop_count; d++) {
    snprintf(name, sizeof name, "drops[%d]", d);
    if (!sim_drop_check(&def->drops[d], name, error)) return false;
  }
  for (int32_t e = 0; e < def->emitter_count; e++) {
    snprintf(name, sizeof name, "emitters[%d]", e);
    if (!check_emitter(def, &def->emitters[e], name, error)) return false;
  }
  for (int32_t s = 0; s < def->sink_count; s++) {
    snprintf(name, sizeof name, "sinks[%d]", s);
    if (!check_sink(&def->sinks[s], name, error)) return false;
  }
  return true;
}

bool sim_def_check(const SimWorldDef *def, SimError *error) {
  if (!def || def->cookie != SIM_DEF_COOKIE) return sim_fail(error, "the Def was not made by sim_default_world_def");
  if (!sim_method(def->solver)) return sim_fail(error, "unknown solver %d", (int)def->solver);
  if (!check_numbers(def, error) || !check_container(def, error) || !check_counts(def, error)) return false;
  if (!check_sources(def, error) || !sim_ripple_check(def, error)) return false;
  for (int32_t b = 0; b < def->obstacle_count; b++)
    if (!check_obstacle(&def->obstacles[b], b, error)) return false;
  if (!check_meshes(def, error)) return false;
  for (int32_t b = 0; b < def->obstacle_count; b++)
    if (!sim_motion_check(&def->obstacles[b], b, error)) return false;
  return true;
}
