// How obstacles move: scripted, draggable and floating bodies. One substep is
//
//   sim_motion_begin   old pose := pose; scripted and draggable bodies go to their pose at the substep's end, floating ones
//                      to the one that their present velocity leads to
//   … the water's substep against these poses; reaction.h gathers what it gives to floating bodies …
//   sim_motion_end     gravity, the water and contacts move the floating bodies (rigid.h), and the layer of water at them
//   sim_motion_commit  the world's obstacles (what frames show) follow; or sim_motion_cancel: back to the old poses
//
// Poses are kept in double precision here; the bodies of the boundary hold rounded copies.
#ifndef LIDO_SIM_MOTION_H
#define LIDO_SIM_MOTION_H

#include "sim/reaction.h"
#include "sim/rigid.h"
#include "sim/sim.h"

typedef struct SimPose {
  double position[3]; ///< m
  double rotation[4]; ///< unit quaternion
} SimPose;

typedef struct SimMover {
  SimPose now, old; ///< at the end and at the start of the substep
  SimPose target;   ///< of a draggable body
} SimMover;

typedef struct SimMotionState {
  SimMover *movers;  ///< (obstacle_count); NULL where no obstacle moves
  SimBoundary start; ///< the world's, with the bodies as they were at the start of the substep; unused where none moves
  SimBody *start_bodies; ///< (obstacle_count), of `start`
  SimPoseKey *keys;      ///< all scripts' keys, one after the other
  SimRigid *rigid;       ///< NULL where no obstacle floats
  float clamp_speed;     ///< m/s, in this substep: of the fastest point of a body, and of what leaves an overlap
  SimReaction reaction;  ///< unused where no obstacle floats
} SimMotionState;

/// Whether an obstacle's motion is possible; otherwise *error names obstacles[index], the field, the range and the value.
bool sim_motion_check(const SimObstacleDef *def, int32_t index, SimError *error);

/// The scripted pose at a time.
void sim_motion_scripted(const SimObstacleDef *def, double time, SimPose *pose);

/// Make ready, with copies of the keys. The world's obstacle_defs and bodies must be there. false: no memory.
bool sim_motion_create(SimWorld *world);
void sim_motion_destroy(SimWorld *world);
/// Everything to the start. false: no memory.
bool sim_motion_reset(SimWorld *world);

/// `longest` (s), or less where a moving body would go too far in it: no point of a body moves by more than half a spacing
/// or by `cfl` spacings a substep.
double sim_motion_longest(const SimWorld *world, double longest);

/// The start of a substep that lasts from the world's time until `end` (s). false: no memory.
bool sim_motion_begin(SimWorld *world, double end);
/// The water's substep is committed, and what it gave moves the floating bodies. false and *error: one is no longer finite.
bool sim_motion_end(SimWorld *world, double end, SimError *error);
void sim_motion_commit(SimWorld *world);
void sim_motion_cancel(SimWorld *world);

#endif
