// Cases with a known answer, from experiments and from theory, for every solver and at any resolution. A test chooses the
// resolution and holds the figures against its gates.
#ifndef LIDO_TEST_SIM_VALIDATION_H
#define LIDO_TEST_SIM_VALIDATION_H

#include "sim_test.h"

/// How a collapsing column (base a, height 2a) compares with Martin & Moyce, An Experimental Study of the Collapse of Liquid
/// Columns on a Rigid Horizontal Plane, 1952, n² = 2.
typedef struct ColumnCollapse {
  double front_rms, front_largest; ///< relative error of the front Z, with the time shift that suits best
  double shift;                    ///< that shift of T, within ±0.2
  double height_largest;           ///< largest |error| of the height H at the wall
  double ritter_excess;            ///< the most by which Z exceeded 1 + 2T; not positive when never faster than Ritter
} ColumnCollapse;

/// `across` particles in the base, `deep` particles across the channel; a in m.
ColumnCollapse validate_column_collapse(SimSolver solver, double a, int across, int deep);

/// A sloshing tank.
typedef struct StandingWave {
  double period; ///< over that of linear theory, ω² = g k tanh(k depth), k = π/length: the mean over some periods
  double kept;   ///< of the swing's height after half a period, the mean likewise
} StandingWave;

/// The first mode in a tank of length 2·depth with `layers` particles of depth; `amplitude` in depths, `jitter` in spacings.
StandingWave validate_standing_wave(SimSolver solver, int layers, double amplitude, double jitter);

#endif
