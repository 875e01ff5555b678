// A scene: what a JSON file in configs/ says, checked and with every default filled in.
//
// The structs are made from the field table in scene_fields.h, and member names are the JSON keys:
// scene.simulation.duration, scene.container.min, scene.fluid[i].block.velocity, scene.events[i].push.origin …
// docs/scene.md says what they mean.
//
//   Scene scene;
//   if (!scene_load(&scene, "dam_break", NULL, 0, &error)) return false;
//   SimWorld *world = scene_world_create(&scene, 0, &error);
//   …
//   scene_free(&scene);
#ifndef LIDO_APP_SCENE_H
#define LIDO_APP_SCENE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "app/app.h"
#include "app/scene_fields.h"
#include "render/render.h"
#include "sim/sim.h"

#define SCENE_TEXT_SIZE 128

/// An item of a list, by its name or by its place.
typedef struct SceneReference {
  int32_t index;              ///< its place, found by the name where there is one; −1: none
  char name[SCENE_TEXT_SIZE]; ///< empty: by its place
} SceneReference;

/// The scene that opens when none is named.
#define SCENE_DEFAULT "dam_break"

// ---- Structs, from the table ----------------------------------------------------------------------------------------

#define SCENE_MEMBER_NUMBER(key) float key;
#define SCENE_MEMBER_REAL(key) double key;
#define SCENE_MEMBER_INTEGER(key) int32_t key;
#define SCENE_MEMBER_SEED(key) uint64_t key;
#define SCENE_MEMBER_SWITCH(key) bool key;
#define SCENE_MEMBER_TEXT(key) char key[SCENE_TEXT_SIZE];
#define SCENE_MEMBER_CHOICE(key) int32_t key;
#define SCENE_MEMBER_STYLE(key) char key[SCENE_TEXT_SIZE];
#define SCENE_MEMBER_VECTOR(key) float key[3];
#define SCENE_MEMBER_DIRECTION(key) float key[3];
#define SCENE_MEMBER_OPTIONAL(key) float key;
#define SCENE_MEMBER_OPTIONAL_REAL(key) double key;
#define SCENE_MEMBER_OPTIONAL_PAIR(key) float key[2];
#define SCENE_MEMBER_OPTIONAL_VECTOR(key) float key[3];
#define SCENE_MEMBER_REFERENCE(key) SceneReference key;

#define SCENE_MEMBER(S, type, key, unit, range, fallback, doc) SCENE_MEMBER_##type(key)
#define SCENE_MEMBER_OBJECT(S, Struct, key, doc) Struct key;
#define SCENE_MEMBER_LIST(S, Struct, key, limit, doc) \
  Struct *key; \
  int32_t key##_count;
#define SCENE_MEMBER_VARIANT(S, NAME, key, Struct, doc) Struct key;

#define SCENE_STRUCT(S, TABLE) \
  typedef struct S { \
    TABLE(SCENE_MEMBER, SCENE_MEMBER_OBJECT, SCENE_MEMBER_LIST, SCENE_MEMBER_VARIANT, S) \
  } S;
SCENE_STRUCTS(SCENE_STRUCT)

// What the numbers of choices mean: places in the range of the table.
typedef enum SceneSolver { SOLVER_PBF, SOLVER_SPH } SceneSolver;
typedef enum SceneContainerShape { CONTAINER_BOX, CONTAINER_GLASS } SceneContainerShape;
typedef enum SceneFluidType { FLUID_BLOCK, FLUID_DROP, FLUID_EMITTER, FLUID_RIPPLE } SceneFluidType;
typedef enum SceneEmitterShape { EMITTER_DISC, EMITTER_RECTANGLE } SceneEmitterShape;
typedef enum SceneObstacleType {
  OBSTACLE_BOX,
  OBSTACLE_SPHERE,
  OBSTACLE_CYLINDER,
  OBSTACLE_CAPSULE,
  OBSTACLE_STAIRS,
  OBSTACLE_MESH
} SceneObstacleType;
typedef enum SceneMotion { MOTION_STATIC, MOTION_SCRIPTED, MOTION_DRAGGABLE, MOTION_FLOATING } SceneMotion;
typedef enum SceneEventType {
  EVENT_PUSH,
  EVENT_POUR,
  EVENT_TILT,
  EVENT_STYLE,
  EVENT_CAMERA,
  EVENT_DRAG,
  EVENT_EMITTER
} SceneEventType;

/// What scene_world_def points to: made when the scene is loaded, valid until scene_free.
typedef struct SceneDefs {
  int32_t block_count, drop_count, emitter_count;
  SimBlockDef *blocks;       ///< (block_count)
  SimDropDef *drops;         ///< (drop_count)
  SimEmitterDef *emitters;   ///< (emitter_count)
  SimSinkDef *sinks;         ///< (sinks_count)
  SimWaveDef *waves;         ///< (waves_count of the ripple), NULL: there is no ripple
  SimObstacleDef *obstacles; ///< (obstacles_count)
  SimPoseKey **keys;         ///< (obstacles_count), each (keys_count) of its obstacle
  SimMesh *meshes;           ///< (obstacles_count), empty where the obstacle is none
} SceneDefs;

typedef struct Scene {
  SCENE_TOP(SCENE_MEMBER, SCENE_MEMBER_OBJECT, SCENE_MEMBER_LIST, SCENE_MEMBER_VARIANT, Scene)

  char *path; // of the file, as it was found, for messages
  SceneDefs defs;
} Scene;

// ---- Loading --------------------------------------------------------------------------------------------------------

/// Read the scene file `path` (found as by scene_find) and the meshes that it names, change it by the "key.path=value"
/// strings `sets`, check it and fill in defaults. Events come out sorted by time, the directions of pushes as unit
/// vectors, the camera with numbers, names with the places that they stand for.
/// false and *error (APP_BAD_INPUT; APP_FAILED when memory runs out): the message names file, line, key path and cause.
/// The scene is then empty; scene_free is allowed, not needed.
bool scene_load(Scene *scene, const char *path, const char *const *sets, int set_count, AppError *error);

/// The same from `size` bytes of text; `name` stands for the file in messages, and meshes are looked for beside it.
bool scene_load_text(Scene *scene, const char *name, const char *text, size_t size, const char *const *sets,
                     int set_count, AppError *error);
void scene_free(Scene *scene);

/// Where the scene `name` lies: as given; else with .json; else among the shipped scenes, wherever the program is
/// started from ("dam_break", "dam_break.json" and "configs/dam_break.json" all work). false: nowhere.
bool scene_find(const char *name, char *path, size_t size);

/// The folder of shipped scenes (relative to the program, installed or in its build folder). false: there is none.
bool scene_folder(char *path, size_t size);

// ---- Use ------------------------------------------------------------------------------------------------------------

/// Pointers in it point into the scene.
SimWorldDef scene_world_def(const Scene *scene);
/// A world of the scene. threads 0: as many as there are cores. NULL and *error (APP_BAD_INPUT): it cannot be made.
SimWorld *scene_world_create(const Scene *scene, int threads, AppError *error);
/// Tell on stderr, in one line, how many particles a new world has left out, if any.
void scene_tell_left_out(const Scene *scene, const SimCounts *counts);

RenderSettings scene_render_settings(const Scene *scene);
RenderView scene_view(const Scene *scene);

/// Number of particles that the fluid holds at the start, before those in obstacles or outside the container are left
/// out: exact for blocks, by the volume for drops.
int64_t scene_particle_count(const Scene *scene);

/// Which of the world's emitters the fluid item `fluid` is; −1: it is none.
int32_t scene_emitter_index(const Scene *scene, int32_t fluid);

/// The ripple that is the scene's water; NULL: the water is made of particles.
const SceneRipple *scene_ripple(const Scene *scene);

/// Unit quaternion (x, y, z, w) of a turn about x, then y, then z, in degrees.
void scene_quaternion(const float degrees[3], float quaternion[4]);

// ---- Text made from the table: each is to be freed, NULL when memory runs out ---------------------------------------

char *scene_print(const Scene *scene);  ///< JSON with every value; loads again to the same scene
char *scene_schema(void);               ///< JSON Schema (draft 7) of scene files: configs/scene.schema.json
char *scene_reference(void);            ///< Markdown tables of every key: docs/scene.md

#endif
