#include "sim/wall_table.h"

void sim_wall_table_make(SimWallTable *table, const SimWall *wall) {
  table->inverse_step = wall->inverse_step;
  for (int k = 0; k < SIM_WALL_STEPS; k++) {
    float *entry = table->entry + 4 * k;
    entry[0] = wall->share[k];
    entry[1] = wall->share[k + 1] - wall->share[k];
    entry[2] = wall->slope[k];
    entry[3] = wall->slope[k + 1] - wall->slope[k];
  }
  for (int k = 0; k < 4; k++) table->entry[4 * SIM_WALL_STEPS + k] = 0;
  for (int k = 0; k <= SIM_WALL_MOMENTS; k++) {
    float *moment = table->moment + 4 * k;
    moment[0] = wall->moment[k];
    moment[1] = k < SIM_WALL_MOMENTS ? wall->moment[k + 1] - wall->moment[k] : 0;
    moment[2] = moment[3] = 0;
  }
}
