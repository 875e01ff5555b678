// A scene: what a JSON file in configs/ says, checked and with every default filled in.
//
// The structs are made from the field table in scene_fields.h, and member names are the JSON keys:
// scene.simulation.duration, scene.container.min, scene.fluid[i].block.velocity, scene.events[i].push.origin …
// docs/scene.md says what they mean.
//
//   Scene scene;
//   if (!scene_load(&scene, "dam_break", NULL, 0, &error)) return false;
//   SimWorldDef def = scene_world_def(&scene);
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
#define SCENE_MEMBER_OPTIONAL_VECTOR(key) float key[3];

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

/// scene.events[i].type
typedef enum SceneEventType { EVENT_PUSH, EVENT_POUR, EVENT_TILT, EVENT_STYLE, EVENT_CAMERA } SceneEventType;

typedef struct Scene {
  SCENE_TOP(SCENE_MEMBER, SCENE_MEMBER_OBJECT, SCENE_MEMBER_LIST, SCENE_MEMBER_VARIANT, Scene)

  char *path; // of the file, as it was found, for messages

  // Made from the above when the scene is loaded, for scene_world_def.
  SimBlockDef *blocks;  // (fluid_count)
  SimObstacleDef *solids; // (obstacles_count)
} Scene;

// ---- Loading --------------------------------------------------------------------------------------------------------

/// Read the scene file `path` (found as by scene_find), change it by the "key.path=value" strings `sets`, check it and
/// fill in defaults. Events come out sorted by time, the directions of pushes as unit vectors, the camera with numbers.
/// false and *error (APP_BAD_INPUT; APP_FAILED when memory runs out): the message names file, line, key path and cause.
/// The scene is then empty; scene_free is allowed, not needed.
bool scene_load(Scene *scene, const char *path, const char *const *sets, int set_count, AppError *error);

/// The same from `size` bytes of text; `name` stands for the file in messages.
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
RenderSettings scene_render_settings(const Scene *scene);
RenderView scene_view(const Scene *scene);

/// Number of particles that the fluid blocks hold before those in obstacles or outside the container are left out.
int64_t scene_particle_count(const Scene *scene);

// ---- Text made from the table: each is to be freed, NULL when memory runs out ---------------------------------------

char *scene_print(const Scene *scene);  ///< JSON with every value; loads again to the same scene
char *scene_schema(void);               ///< JSON Schema (draft 7) of scene files: configs/scene.schema.json
char *scene_reference(void);            ///< Markdown tables of every key: docs/scene.md

#endif
