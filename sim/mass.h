// Mass, centre of mass and inertia of solid bodies of one density.
#ifndef LIDO_SIM_MASS_H
#define LIDO_SIM_MASS_H

#include "sim/frame.h"

typedef struct SimMass {
  double mass;       ///< kg
  double centre[3];  ///< m, the centre of mass in the body's own axes
  double inertia[6]; ///< kg m², about the centre of mass in the body's own axes: xx, yy, zz, xy, xz, yz
} SimMass;

/// `density` in kg/m³. A mesh that holds no volume (open, or inside out) gives a mass that is not positive.
SimMass sim_mass_make(const SimObstacle *obstacle, double density);

#endif
