// The wall's share of the density sum (wall.h) laid out for wide floats: one place to read holds all that one
// interpolation needs.
#ifndef LIDO_SIM_WALL_TABLE_H
#define LIDO_SIM_WALL_TABLE_H

#include <stdalign.h>

#include "sim/wall.h"

typedef struct SimWallTable {
  float inverse_step; ///< 1/m
  /// At distance k steps: share and what it grows by until k + 1, slope and what it grows by; all 0 from SIM_WALL_STEPS on.
  alignas(64) float entry[4 * (SIM_WALL_STEPS + 1)];
  /// Of SimWall.moment: at k, what it grows by until k + 1, 0, 0.
  alignas(64) float moment[4 * (SIM_WALL_MOMENTS + 1)];
} SimWallTable;

void sim_wall_table_make(SimWallTable *table, const SimWall *wall);

#endif
