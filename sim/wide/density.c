// Densities of particles straight from the grid, for sets so large that neighbour lists (surface.c) have no room: a few
// bytes a particle instead of more than a hundred. Each lane is a particle; particles next to each other in a row of cells
// have nearly the same candidates, so all lanes run over the same ones and what is out of reach adds nothing.
//
// The sums run in the order of the lists over the same terms, so the sweep over lists gives the same bytes.
#include "sim/surface.h"
#include "sim/wide/kernels.h"

#define WIDEST 4 // cells along a row whose particles share their candidates

/// Particles first … end − 1 of a row of cells, at most SIM_LANES, and the cells in which their candidates lie.
typedef struct Group {
  int32_t first, end;
  int32_t left, right, y, z; ///< cells; y and z of the particles' own
} Group;

// The first particles from `first` on; `cell` is the cell of the first of them.
static Group next_group(const SimGrid *grid, int32_t first, int32_t end, int32_t cell) {
  int32_t x = cell % grid->size[0], row = cell / grid->size[0], last = x + WIDEST - 1;
  if (last > grid->size[0] - 1) last = grid->size[0] - 1;
  int32_t in_reach = grid->cell_start[(int64_t)row * grid->size[0] + last + 1];
  if (end > first + SIM_LANES) end = first + SIM_LANES;
  Group group = {
      first, end < in_reach ? end : in_reach, x > 0 ? x - 1 : 0, last, row % grid->size[1], row / grid->size[1]};
  while (last > x && grid->cell_start[(int64_t)row * grid->size[0] + last] >= group.end) last--;
  group.right = last < grid->size[0] - 1 ? last + 1 : last;
  return group;
}

static inline SimF term(const SimDensityContext *c, const SimF own[3], int32_t j) {
  SimF zero = sim_f(0), d[3];
  for (int k = 0; k < 3; k++) d[k] = sim_f(c->position[3 * (int64_t)j + k]) - own[k];
  SimF q = sim_sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) * sim_f(c->cubic.inverse_h);
  SimF a = sim_max(sim_f(1) - q, zero), b = sim_max(sim_f(0.5f) - q, zero);
  return a * a * a - sim_f(4) * (b * b * b);
}

// The same for a candidate that is one of the group: it does not count for itself.
static SimF term_of_other(const SimDensityContext *c, const Group *group, const SimF own[3], int32_t j) {
  float itself[SIM_LANES] = {0};
  itself[j - group->first] = 1;
  return sim_select_less(sim_f(0.5f), sim_load(itself), sim_f(0), term(c, own, j));
}

static SimF sum_row(const SimDensityContext *c, const Group *group, const SimF own[3], SimRange range, SimF sum) {
  int32_t j = range.begin;
  // The group's own particles stand together, in its own row only; a range lies before them, behind them or around them.
  for (; j < range.end && j < group->first; j++) sum = sum + term(c, own, j);
  for (; j < range.end && j < group->end; j++) sum = sum + term_of_other(c, group, own, j);
  for (; j < range.end; j++) sum = sum + term(c, own, j);
  return sum;
}

static void write_group(const SimDensityContext *c, const Group *group) {
  const SimGrid *grid = c->grid;
  float lane[3][SIM_LANES] = {{0}}, density[SIM_LANES];
  for (int32_t i = group->first; i < group->end; i++)
    for (int k = 0; k < 3; k++) lane[k][i - group->first] = c->position[3 * (int64_t)i + k];
  SimF own[3], sum = sim_f(0);
  for (int k = 0; k < 3; k++) own[k] = sim_load(lane[k]);
  for (int32_t z = group->z > 0 ? group->z - 1 : 0; z <= group->z + 1 && z < grid->size[2]; z++)
    for (int32_t y = group->y > 0 ? group->y - 1 : 0; y <= group->y + 1 && y < grid->size[1]; y++) {
      const int32_t *row = grid->cell_start + ((int64_t)z * grid->size[1] + y) * grid->size[0];
      sum = sum_row(c, group, own, (SimRange){row[group->left], row[group->right + 1]}, sum);
    }
  sim_store(density, sim_f(c->cubic.value_scale) + sim_f(2 * c->cubic.value_scale) * sum);
  for (int32_t i = group->first; i < group->end; i++) c->density[i] = density[i - group->first];
}

void WIDE(sim_surface_density)(int32_t begin, int32_t end, const void *context) {
  const SimDensityContext *c = context;
  int32_t cell = sim_grid_cell_of(c->grid, begin);
  for (int32_t first = begin; first < end;) {
    while (c->grid->cell_start[cell + 1] <= first) cell++;
    Group group = next_group(c->grid, first, end, cell);
    write_group(c, &group);
    first = group.end;
  }
}
