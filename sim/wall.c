// The wall's share of the density sum, tabulated: see wall.h.
#include "sim/wall.h"

#include <math.h>

/// Sums over the half lattice whose first layer is half a spacing behind the surface.
typedef struct HalfLattice {
  double value, moment; ///< Σ W, −Σ x_n ∂W/∂x_n
} HalfLattice;

static HalfLattice half_lattice(double s, double spacing, double h) {
  int reach = (int)ceil(h / spacing);
  HalfLattice sum = {0, 0};
  for (int k = 0; k <= reach; k++)
    for (int j = -reach; j <= reach; j++)
      for (int i = -reach; i <= reach; i++) {
        double z = s + (k + 0.5) * spacing, r = sqrt(z * z + spacing * spacing * (i * i + j * j));
        sum.value += sim_kernel_cubic(r, h);
        sum.moment -= sim_kernel_cubic_derivative(r, h) * z * z / r;
      }
  return sum;
}

// V Σ W x² over the whole lattice.
static double second_moment(double spacing, double h, double volume) {
  int reach = (int)ceil(h / spacing);
  double sum = 0;
  for (int k = -reach; k <= reach; k++)
    for (int j = -reach; j <= reach; j++)
      for (int i = -reach; i <= reach; i++)
        sum += sim_kernel_cubic(spacing * sqrt(i * i + j * j + k * k), h) * spacing * spacing * i * i;
  return volume * sum;
}

// At the surface itself the half lattice gives not quite one half. It is blended so that f(0) = ½ and both sides meet;
// from a quarter of a spacing on it is untouched.
static double share_at(double s, double spacing, double h, double volume) {
  double t = s / (0.25 * spacing), share = volume * half_lattice(s, spacing, h).value;
  if (t >= 1) return share;
  double at_surface = 0.5 / (volume * half_lattice(0, spacing, h).value);
  return share * (at_surface + (1 - at_surface) * t * t * (3 - 2 * t));
}

// The shares fall with the distance, so the one pass over them finds where each of the moments belongs.
static void make_moments(SimWall *wall, const SimCubic *cubic) {
  int k = SIM_WALL_STEPS;
  for (int m = 0; m <= SIM_WALL_MOMENTS; m++) {
    double share = (double)m / SIM_WALL_MOMENTS, s = (double)k / (double)wall->inverse_step;
    while (k > 0 && (double)wall->share[k] < share) s = --k / (double)wall->inverse_step;
    double moment = (double)cubic->volume * half_lattice(s, (double)wall->spacing, (double)cubic->h).moment - share;
    wall->moment[m] = share > 0 && share < 0.5 ? (float)fmax(moment, 0) : 0;
  }
}

void sim_wall_make(SimWall *wall, const SimCubic *cubic) {
  double spacing = cubic->spacing, h = cubic->h, reach = h - spacing / 2, step = reach / SIM_WALL_STEPS;
  wall->reach = (float)reach;
  wall->inverse_step = (float)(1 / step);
  wall->spacing = (float)spacing;
  wall->spread = (float)second_moment(spacing, h, cubic->volume);
  for (int k = 0; k <= SIM_WALL_STEPS + 1; k++) {
    double s = k * step, e = step / 2;
    wall->share[k] = (float)share_at(s, spacing, h, cubic->volume);
    double above = share_at(s + e, spacing, h, cubic->volume),
           below = s < e ? 1 - share_at(e - s, spacing, h, cubic->volume) : share_at(s - e, spacing, h, cubic->volume);
    wall->slope[k] = (float)((above - below) / (2 * e));
  }
  make_moments(wall, cubic);
}
