// Water without particles: its surface is a sum of waves. Cords, Refraction of Water Surface Intersecting Objects in Interactive
// Environments, 2007, shows the method on such a surface (Fig. 4 and 5b: simple superposition of dynamic wave functions).
#ifndef LIDO_SIM_RIPPLE_H
#define LIDO_SIM_RIPPLE_H

#include "sim/sim.h"

/// One wave at a moment: A cos(k·x + angle).
typedef struct SimRippleWave {
  double amplitude; ///< m, A; of a standing wave what is left of it now
  double k[2];      ///< rad/m, along x and z
  double angle;     ///< rad
} SimRippleWave;

/// The water at a moment.
typedef struct SimRipple {
  double level; ///< m
  int32_t wave_count;
  SimRippleWave wave[SIM_MAX_WAVES];
} SimRipple;

/// rad/s: ω² = g k tanh(k d), the dispersion of small waves on water of depth d.
double sim_wave_frequency(double wavelength, double gravity, double depth);

/// Whether the Def's ripple is possible, and the rest of it for a ripple; otherwise *error names field, range and value.
bool sim_ripple_check(const SimWorldDef *def, SimError *error);

/// The Def's waves at a time, s.
void sim_ripple_at(const SimWorldDef *def, double time, SimRipple *ripple);

/// m, between the nodes that show its waves.
float sim_ripple_spacing(const SimWorldDef *def);

/// Heights and normals of nodes, exact but for rounding. `normal` is (size[1], size[0], 3). Nodes that lie well outside a glass have
/// none: `floor` and upright. `container` may be NULL.
void sim_ripple_heights(const SimRipple *ripple, const SimContainer *container, const SimHeightField *field, float floor,
                        int32_t threads, float *height, float *normal);

#endif
