// Inside of a world: what world.c (the step), world_def.c (limits of a Def), world_fill.c (blocks and pouring) and
// frame.c share.
#ifndef LIDO_SIM_WORLD_H
#define LIDO_SIM_WORLD_H

#include "sim/motion.h"
#include "sim/solver_pbf.h"

#define SIM_DEF_COOKIE 0x4c69646fu

struct SimWorld {
  SimWorldDef def;             ///< with its own copies of blocks and obstacles
  SimBlockDef *blocks;
  SimObstacleDef *obstacle_defs;
  SimObstacle *obstacles;      ///< with their present poses
  SimBody *bodies;
  SimMeshDistance **meshes;    ///< (obstacle_count), of the obstacles that are meshes; equal ones share one
  SimMotionState motion;
  int32_t threads;

  SimCubic cubic;
  SimBoundary boundary;
  SimParticles particles;
  float *colour;               ///< (capacity, 3) by id; only read where coloured is set
  bool coloured;               ///< some block brought a colour
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

/// Fill a block with particles. Adds to counts.left_out if `start`. Returns the number added, −1 and *error.
int32_t sim_fill_block(SimWorld *world, const SimBlockDef *block, bool start, SimError *error);

/// Sort by the present positions and compute grid, lists and density of the present state, if not done already. Every
/// call of the interface leaves a world settled (unless it failed), so looking at it never changes what comes next.
bool sim_world_settle(SimWorld *world, SimError *error);

/// Largest speed at which the step still follows the water.
void sim_world_raise_speed_limit(SimWorld *world);

#endif
