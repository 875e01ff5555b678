// Inside of a world: what world.c (the step), world_def.c (limits of a Def), world_fill.c (blocks, drops and pouring),
// emitter.c, world_room.c (sinks, the limit) and frame.c share.
#ifndef LIDO_SIM_WORLD_H
#define LIDO_SIM_WORLD_H

#include "sim/emitter.h"
#include "sim/motion.h"
#include "sim/solver.h"

#define SIM_DEF_COOKIE 0x4c69646fu

struct SimWorld {
  SimWorldDef def;             ///< with its own copies of all arrays
  SimBlockDef *blocks;
  SimDropDef *drops;
  SimEmitterDef *emitter_defs;
  SimSinkDef *sinks;
  SimWaveDef *waves;
  SimObstacleDef *obstacle_defs;
  SimObstacle *obstacles;      ///< with their present poses
  SimBody *bodies;
  SimMeshDistance **meshes;    ///< (obstacle_count), of the obstacles that are meshes; equal ones share one
  SimMotionState motion;
  int32_t threads;
  const SimWide *wide;
  const SimMethod *method;
  double sound;                ///< m/s, speed of sound of sph in the last substep; 0: none yet
  double moved;                ///< m, the most that a particle can have moved since the lists were built; only sph asks
  double last_dt;              ///< s, of the last substep; 0: none yet

  SimCubic cubic;
  SimBoundary boundary;
  SimWallTable wall;
  SimParticles particles;
  uint32_t next_id;            ///< ids count up from 0; it would take 2³² particles to wrap round
  uint32_t start_count;        ///< the particles of the start have the ids below
  SimEmitters emitters;
  uint8_t *gone;               ///< (count), flags of sim_particles_remove
  SimCellSort sort, fill_sort; ///< of the substep; of world_fill
  SimNeighbours neighbours;
  float *fill_position[3];     ///< world_fill's sorted copy

  float gravity[3];
  SimPush pushes[SIM_MAX_PUSHES];
  int32_t push_count;
  double time;                 ///< s since the start
  int64_t advances;            ///< successful calls of sim_world_advance
  float speed_limit;           ///< m/s: faster is an explosion; nothing in this container can get there by itself
  bool settled;                ///< grid, lists and density are those of the present positions
  bool failed;
  SimError failure;
  SimCounts counts;
  SimProfile profile;
};

bool sim_fail(SimError *error, const char *format, ...) __attribute__((format(printf, 2, 3)));
double sim_milliseconds(void); ///< of a clock that never goes back

/// Whether every value of the Def is in range; otherwise *error names the field, the range and the value.
bool sim_def_check(const SimWorldDef *def, SimError *error);
/// The same for one block; `name` goes in front of the message.
bool sim_block_check(const SimBlockDef *block, const char *name, SimError *error);

/// The same for a drop.
bool sim_drop_check(const SimDropDef *drop, const char *name, SimError *error);

/// Fill a block or a drop with particles. Adds to counts.left_out if `start`, else to counts.emitted. Returns the number
/// added, −1 and *error.
int32_t sim_fill_block(SimWorld *world, const SimBlockDef *block, bool start, SimError *error);
int32_t sim_fill_drop(SimWorld *world, const SimDropDef *drop, bool start, SimError *error);
/// Displace every particle at random by up to the Def's jitter, once everything has been filled: a displaced particle would
/// otherwise take the place of one of the next block.
void sim_fill_jitter(SimWorld *world);

/// Linear colour of water that was given none.
extern const float sim_water_colour[3];
/// The most particles that the world may hold.
int32_t sim_world_limit(const SimWorld *world);
/// Memory ahead for what emitters will bring, where the Def says how much that is at most.
bool sim_world_reserve(SimWorld *world, SimError *error);
/// Make memory and room for `wanted` more particles, by taking away what was emitted first where the Def wants that.
/// Returns for how many there is room now, at most `wanted`; −1 and *error.
int32_t sim_world_make_way(SimWorld *world, int32_t wanted, SimError *error);
/// Add a particle with the next id. There must be room.
void sim_world_add(SimWorld *world, const float point[3], const float velocity[3], const float colour[3]);

/// At the end of a substep: take away what is in the sinks, then let out the layers that have become due.
bool sim_swallow(SimWorld *world, SimError *error);
bool sim_emit(SimWorld *world, SimError *error);
/// Largest speed of the water that emitters let out now or within the next `soon` seconds, m/s.
float sim_emit_speed(const SimWorld *world, double soon);

/// Sort by the present positions and compute grid, lists and density of the present state, if not done already. Every
/// call of the interface leaves a world settled (unless it failed), so looking at it never changes what comes next.
bool sim_world_settle(SimWorld *world, SimError *error);

/// m/s²: the most that gravity and pushes together can accelerate a particle now.
float sim_pull(const SimWorld *world);

/// Largest speed at which the step still follows the water.
void sim_world_raise_speed_limit(SimWorld *world);

#endif
