// What the simulation reads of a scene, in the simulator's own structs: numbers of choices become the simulator's,
// degrees and directions quaternions, files meshes.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/mesh_file.h"
#include "app/scene_parse.h"

#define PI 3.14159265358979323846

static const SimSolver solvers[] = {[SOLVER_PBF] = SIM_SOLVER_PBF, [SOLVER_SPH] = SIM_SOLVER_SPH};
static const SimContainerShape container_shapes[] = {
    [CONTAINER_BOX] = SIM_CONTAINER_BOX, [CONTAINER_GLASS] = SIM_CONTAINER_GLASS};
static const SimEmitterShape emitter_shapes[] = {
    [EMITTER_DISC] = SIM_EMITTER_DISC, [EMITTER_RECTANGLE] = SIM_EMITTER_RECTANGLE};
static const SimMotion motions[] = {[MOTION_STATIC] = SIM_STATIC,
                                    [MOTION_SCRIPTED] = SIM_SCRIPTED,
                                    [MOTION_DRAGGABLE] = SIM_DRAGGABLE,
                                    [MOTION_FLOATING] = SIM_FLOATING};

static void copy3(float to[3], const float from[3]) {
  memcpy(to, from, 3 * sizeof *to);
}

// ---- Turns ----------------------------------------------------------------------------------------------------------

void scene_quaternion(const float degrees[3], float quaternion[4]) {
  double c[3], s[3];
  for (int i = 0; i < 3; i++) {
    double half = (double)degrees[i] * PI / 360;
    c[i] = cos(half);
    s[i] = sin(half);
  }
  quaternion[0] = (float)(s[0] * c[1] * c[2] - c[0] * s[1] * s[2]);
  quaternion[1] = (float)(c[0] * s[1] * c[2] + s[0] * c[1] * s[2]);
  quaternion[2] = (float)(c[0] * c[1] * s[2] - s[0] * s[1] * c[2]);
  quaternion[3] = (float)(c[0] * c[1] * c[2] + s[0] * s[1] * s[2]);
}

static void cross(const double a[3], const double b[3], double out[3]) {
  for (int i = 0; i < 3; i++) out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static double normalise(double v[3]) {
  double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  for (int i = 0; i < 3 && length > 0; i++) v[i] /= length;
  return length;
}

/// The quaternion that turns the axes x, y, z onto the columns of the rotation `m`; by the largest of its components,
/// so that nothing cancels (Shepperd, Quaternion from rotation matrix, 1978).
static void quaternion_from_axes(double m[3][3], float quaternion[4]) {
  double trace = m[0][0] + m[1][1] + m[2][2], q[4];
  int i = m[1][1] > m[0][0] ? 1 : 0;
  if (m[2][2] > m[i][i]) i = 2;
  if (trace >= m[i][i]) {
    q[3] = 0.5 * sqrt(1 + trace);
    for (int k = 0; k < 3; k++) {
      int a = (k + 1) % 3, b = (k + 2) % 3;
      q[k] = (m[b][a] - m[a][b]) / (4 * q[3]);
    }
  } else {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    q[i] = 0.5 * sqrt(1 + m[i][i] - m[j][j] - m[k][k]);
    q[j] = (m[i][j] + m[j][i]) / (4 * q[i]);
    q[k] = (m[i][k] + m[k][i]) / (4 * q[i]);
    q[3] = (m[k][j] - m[j][k]) / (4 * q[i]);
  }
  for (int k = 0; k < 4; k++) quaternion[k] = (float)q[k];
}

/// +x turns to `direction`, +y as near to `up` as that allows. Where `up` is along `direction`, x stands in for it, and
/// where that is too, y.
static void turn_opening(const float direction[3], const float up[3], float quaternion[4]) {
  static const double stand_in[2][3] = {{1, 0, 0}, {0, 1, 0}};
  double x[3], y[3], z[3], m[3][3];
  for (int i = 0; i < 3; i++) {
    x[i] = direction[i];
    y[i] = up[i];
  }
  normalise(x);
  normalise(y);
  cross(x, y, z);
  for (int i = 0; normalise(z) < 1e-4 && i < 2; i++) cross(x, stand_in[i], z);
  normalise(z);
  cross(z, x, y);
  for (int i = 0; i < 3; i++) {
    m[i][0] = x[i];
    m[i][1] = y[i];
    m[i][2] = z[i];
  }
  quaternion_from_axes(m, quaternion);
}

// ---- Water ----------------------------------------------------------------------------------------------------------

static SimBlockDef make_block(const SceneBlock *block) {
  SimBlockDef def = {0};
  copy3(def.min, block->min);
  copy3(def.max, block->max);
  copy3(def.velocity, block->velocity);
  copy3(def.colour, block->colour);
  return def;
}

static SimDropDef make_drop(const SceneDrop *drop) {
  SimDropDef def = {.radius = drop->radius};
  copy3(def.centre, drop->centre);
  copy3(def.velocity, drop->velocity);
  copy3(def.colour, drop->colour);
  return def;
}

static SimEmitterDef make_emitter(const SceneEmitter *emitter) {
  bool disc = emitter->shape == EMITTER_DISC;
  SimEmitterDef def = {.shape = emitter_shapes[emitter->shape],
                       .size = {disc ? emitter->diameter : emitter->size[0], disc ? 0 : emitter->size[1]},
                       .speed = emitter->speed,
                       .start = emitter->start,
                       .stop = isnan(emitter->stop) ? INFINITY : emitter->stop,
                       .obstacle = emitter->obstacle.index};
  copy3(def.position, emitter->position);
  copy3(def.colour, emitter->colour);
  turn_opening(emitter->direction, emitter->up, def.rotation);
  return def;
}

const SceneRipple *scene_ripple(const Scene *scene) {
  return scene->fluid_count == 1 && scene->fluid[0].type == FLUID_RIPPLE ? &scene->fluid[0].ripple : NULL;
}

static bool make_waves(Scene *scene) {
  const SceneRipple *ripple = scene_ripple(scene);
  if (!ripple) return true;
  SimWaveDef *waves = scene->defs.waves = calloc((size_t)ripple->waves_count + 1, sizeof *waves);
  for (int i = 0; waves && i < ripple->waves_count; i++) {
    const SceneWave *wave = &ripple->waves[i];
    waves[i] = (SimWaveDef){.amplitude = wave->amplitude,
                            .wavelength = wave->wavelength,
                            .direction = {wave->direction[0], wave->direction[2]},
                            .phase = (float)((double)wave->phase * PI / 180),
                            .standing = wave->standing};
  }
  return waves != NULL;
}

static bool make_water(Scene *scene) {
  SceneDefs *defs = &scene->defs;
  size_t room = (size_t)scene->fluid_count + 1;
  defs->blocks = calloc(room, sizeof *defs->blocks);
  defs->drops = calloc(room, sizeof *defs->drops);
  defs->emitters = calloc(room, sizeof *defs->emitters);
  defs->sinks = calloc((size_t)scene->sinks_count + 1, sizeof *defs->sinks);
  if (!defs->blocks || !defs->drops || !defs->emitters || !defs->sinks) return false;
  for (int i = 0; i < scene->fluid_count; i++) {
    const SceneFluid *fluid = &scene->fluid[i];
    if (fluid->type == FLUID_BLOCK) defs->blocks[defs->block_count++] = make_block(&fluid->block);
    if (fluid->type == FLUID_DROP) defs->drops[defs->drop_count++] = make_drop(&fluid->drop);
    if (fluid->type == FLUID_EMITTER) defs->emitters[defs->emitter_count++] = make_emitter(&fluid->emitter);
  }
  for (int i = 0; i < scene->sinks_count; i++) {
    copy3(defs->sinks[i].min, scene->sinks[i].min);
    copy3(defs->sinks[i].max, scene->sinks[i].max);
  }
  return make_waves(scene);
}

int32_t scene_emitter_index(const Scene *scene, int32_t fluid) {
  if (fluid < 0 || fluid >= scene->fluid_count || scene->fluid[fluid].type != FLUID_EMITTER) return -1;
  int32_t index = 0;
  for (int32_t i = 0; i < fluid; i++) index += scene->fluid[i].type == FLUID_EMITTER;
  return index;
}

// ---- Obstacles ------------------------------------------------------------------------------------------------------

static void set_size(SimObstacle *body, float x, float y, float z) {
  body->size[0] = x;
  body->size[1] = y;
  body->size[2] = z;
}

static void make_shape(const SceneObstacle *obstacle, const SimMesh *mesh, SimObstacle *body) {
  switch ((SceneObstacleType)obstacle->type) {
  case OBSTACLE_BOX:
    body->shape = SIM_BOX;
    copy3(body->size, obstacle->box.size);
    break;
  case OBSTACLE_SPHERE:
    body->shape = SIM_SPHERE;
    set_size(body, 2 * obstacle->sphere.radius, 2 * obstacle->sphere.radius, 2 * obstacle->sphere.radius);
    break;
  case OBSTACLE_CYLINDER:
    body->shape = SIM_CYLINDER;
    set_size(body, 2 * obstacle->cylinder.radius, obstacle->cylinder.height, 2 * obstacle->cylinder.radius);
    break;
  case OBSTACLE_CAPSULE:
    body->shape = SIM_CAPSULE;
    set_size(body, 2 * obstacle->capsule.radius, obstacle->capsule.height, 2 * obstacle->capsule.radius);
    break;
  case OBSTACLE_STAIRS:
    body->shape = SIM_STAIRS;
    copy3(body->size, obstacle->stairs.size);
    body->steps = obstacle->stairs.steps;
    break;
  case OBSTACLE_MESH:
    body->shape = SIM_MESH;
    body->mesh = mesh;
    break;
  }
}

static void make_obstacle(const SceneObstacle *obstacle, const SimMesh *mesh, SimPoseKey *keys, SimObstacleDef *def) {
  *def = sim_default_obstacle_def();
  make_shape(obstacle, mesh, &def->body);
  copy3(def->body.position, obstacle->position);
  copy3(def->body.colour, obstacle->colour);
  scene_quaternion(obstacle->rotation, def->body.rotation);
  def->motion = motions[obstacle->motion];
  def->friction = obstacle->friction;
  for (int i = 0; i < obstacle->keys_count; i++) {
    keys[i].time = obstacle->keys[i].time;
    copy3(keys[i].position, obstacle->keys[i].position);
    scene_quaternion(obstacle->keys[i].rotation, keys[i].rotation);
  }
  def->key_count = obstacle->keys_count;
  def->keys = obstacle->keys_count > 0 ? keys : NULL;
  def->repeat = obstacle->repeat;
  copy3(def->stroke, obstacle->stroke);
  def->period = obstacle->period;
  def->start = obstacle->start;
  def->max_speed = obstacle->max_speed;
  def->density = obstacle->density;
}

/// The file that an obstacle names, beside the scene's.
static bool read_mesh(const SceneSource *source, const struct cJSON *root, int index, const SceneMesh *mesh,
                      SimMesh *read) {
  char path[4096], cause[MESH_FILE_CAUSE_SIZE], keys[40], printable[160];
  const char *slash = mesh->file[0] == '/' ? NULL : strrchr(source->name, '/');
  int folder = slash ? (int)(slash - source->name) + 1 : 0;
  snprintf(keys, sizeof keys, "obstacles.%d.file", index);
  text_printable(printable, sizeof printable, mesh->file, sizeof mesh->file);
  if (snprintf(path, sizeof path, "%.*s%s", folder, source->name, mesh->file) >= (int)sizeof path)
    return scene_fail_at(source, root, keys, "%s: the path is too long", printable);
  bool memory = true;
  if (mesh_file_read(path, (double)mesh->scale, mesh->centre, read, cause, &memory)) return true;
  if (!memory) return app_fail(source->error, APP_FAILED, "%s: out of memory", printable);
  return scene_fail_at(source, root, keys, "%s: %s", printable, cause);
}

static bool make_obstacles(const SceneSource *source, const struct cJSON *root, Scene *scene) {
  SceneDefs *defs = &scene->defs;
  size_t room = (size_t)scene->obstacles_count + 1;
  defs->obstacles = calloc(room, sizeof *defs->obstacles);
  defs->keys = calloc(room, sizeof *defs->keys);
  defs->meshes = calloc(room, sizeof *defs->meshes);
  if (!defs->obstacles || !defs->keys || !defs->meshes) return app_fail(source->error, APP_FAILED, "out of memory");
  for (int i = 0; i < scene->obstacles_count; i++) {
    const SceneObstacle *obstacle = &scene->obstacles[i];
    defs->keys[i] = calloc((size_t)obstacle->keys_count + 1, sizeof **defs->keys);
    if (!defs->keys[i]) return app_fail(source->error, APP_FAILED, "out of memory");
    if (obstacle->type == OBSTACLE_MESH && !read_mesh(source, root, i, &obstacle->mesh, &defs->meshes[i])) return false;
    make_obstacle(obstacle, &defs->meshes[i], defs->keys[i], &defs->obstacles[i]);
  }
  return true;
}

bool scene_defs_make(const SceneSource *source, const struct cJSON *root, Scene *scene) {
  if (!make_water(scene)) return app_fail(source->error, APP_FAILED, "out of memory");
  return make_obstacles(source, root, scene);
}

void scene_defs_free(Scene *scene) {
  SceneDefs *defs = &scene->defs;
  for (int i = 0; defs->keys && i < scene->obstacles_count; i++) free(defs->keys[i]);
  for (int i = 0; defs->meshes && i < scene->obstacles_count; i++) mesh_file_free(&defs->meshes[i]);
  free(defs->blocks);
  free(defs->drops);
  free(defs->emitters);
  free(defs->sinks);
  free(defs->waves);
  free(defs->obstacles);
  free(defs->keys);
  free(defs->meshes);
  *defs = (SceneDefs){0};
}

// ---- The world ------------------------------------------------------------------------------------------------------

SimWorldDef scene_world_def(const Scene *scene) {
  const SceneSimulation *simulation = &scene->simulation;
  const SceneDefs *defs = &scene->defs;
  SimWorldDef def = sim_default_world_def();
  def.solver = solvers[simulation->solver];
  def.particle_radius = simulation->particle_radius;
  def.rest_density = simulation->rest_density;
  def.support = simulation->support;
  copy3(def.gravity, simulation->gravity);
  def.time_step = simulation->time_step;
  def.cfl = simulation->cfl;
  def.iterations = simulation->iterations;
  def.viscosity = simulation->viscosity;
  def.kinematic_viscosity = simulation->kinematic_viscosity;
  def.surface_tension = simulation->surface_tension;
  def.vorticity = simulation->vorticity;
  def.relaxation = simulation->relaxation;
  def.tensile = simulation->tensile;
  copy3(def.container.min, scene->container.min);
  copy3(def.container.max, scene->container.max);
  def.container.shape = container_shapes[scene->container.shape];
  def.container_friction = scene->container.friction;
  def.block_count = defs->block_count;
  def.blocks = defs->blocks;
  def.drop_count = defs->drop_count;
  def.drops = defs->drops;
  def.emitter_count = defs->emitter_count;
  def.emitters = defs->emitters;
  def.sink_count = scene->sinks_count;
  def.sinks = defs->sinks;
  const SceneRipple *ripple = scene_ripple(scene);
  if (ripple) {
    def.ripple = true;
    def.ripple_level = ripple->level;
    def.wave_count = ripple->waves_count;
    def.waves = defs->waves;
  }
  def.max_particles = simulation->max_particles;
  def.reuse = simulation->reuse;
  def.colour_diffusion = simulation->colour_diffusion;
  def.obstacle_count = scene->obstacles_count;
  def.obstacles = defs->obstacles;
  def.seed = simulation->seed;
  def.jitter = simulation->jitter;
  return def;
}

SimWorld *scene_world_create(const Scene *scene, int threads, AppError *error) {
  SimWorldDef def = scene_world_def(scene);
  def.threads = threads;
  SimError reason;
  SimWorld *world = sim_world_create(&def, &reason);
  if (!world) app_fail(error, APP_BAD_INPUT, "%s: %s", scene->path, reason.message);
  return world;
}

void scene_tell_left_out(const Scene *scene, const SimCounts *counts) {
  char path[200];
  if (counts->left_out <= 0) return;
  fprintf(stderr, "lido: %s: %d particle%s at the start left out, in an obstacle or outside the container\n",
          text_printable(path, sizeof path, scene->path, 180), (int)counts->left_out, counts->left_out == 1 ? "" : "s");
}
