// Floating bodies: rigid bodies that gravity, the water, the container's walls and other bodies move.
#ifndef LIDO_SIM_RIGID_H
#define LIDO_SIM_RIGID_H

#include "sim/mass.h"
#include "sim/obstacles.h"
#include "sim/sim.h"

typedef struct SimRigid SimRigid;

/// What the water gave to one floating body in a substep, about its centre of mass.
typedef struct SimGiven {
  double linear[3];  ///< N s
  double angular[3]; ///< N m s
  double
      layer[21]; ///< kg, kg m, kg m²: the mass matrix (lower triangle, rows first) of the water next to the body, for
                 ///< the body's velocity and spin
  double change[6]; ///< m/s, rad/s: what body and layer together got of it, by sim_rigid_step
} SimGiven;

/// A set of `count` obstacles, `defs`, which must stay; those that do not float are what floating ones run into. NULL: no
/// memory. Needs sim_rigid_reset.
SimRigid *sim_rigid_create(const SimContainer *container, const SimObstacleDef *defs, int32_t count, double spacing);
void sim_rigid_destroy(SimRigid *rigid); ///< NULL is allowed
/// All bodies at their start, at rest. false: no memory.
bool sim_rigid_reset(SimRigid *rigid);

int32_t sim_rigid_floating(const SimRigid *rigid);            ///< number of floating bodies
int32_t sim_rigid_slot(const SimRigid *rigid, int32_t index); ///< of a floating obstacle among them

/// The pose that a floating obstacle's present velocity leads to in dt; its centre of mass there is sim_rigid_centre.
void sim_rigid_predict(SimRigid *rigid, int32_t index, double dt, double position[3], double rotation[4]);
/// m, centre of mass of a floating body (by slot) at its last predicted pose, (3).
const double *sim_rigid_centre(const SimRigid *rigid, int32_t slot);
/// m/s, bound on the speed of points up to `reach` from a floating obstacle's position; NaN if it is not finite.
double sim_rigid_speed(const SimRigid *rigid, int32_t index, double reach);

/// Move the floating bodies by dt. `given` by slot; `bodies` (count) say how the other obstacles move in this substep.
/// false: no memory.
bool sim_rigid_step(SimRigid *rigid, double dt, const float gravity[3], SimGiven *given, const SimBody *bodies);

/// Sums over the floating bodies: kg m/s; J, kinetic and potential, −m g·(x − origin).
void sim_rigid_measures(const SimRigid *rigid, const float gravity[3], const float origin[3], double momentum[3],
                        double *energy);

#endif
