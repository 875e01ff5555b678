// Filling a block or a ball with a cubic lattice of particles, at the start and while the world runs.
#include <math.h>
#include <string.h>

#include "sim/memory.h"
#include "sim/world.h"

// A lattice point nearer than this to a particle, in spacings, stays empty.
#define TOO_NEAR 0.9f

typedef struct Lattice {
  int32_t size[3];
  float origin[3]; ///< m, the first point
  float step[3];   ///< m
  double radius2;  ///< spacings², of the ball around its middle that cuts it, or infinite
} Lattice;

// A block's lattice may be stretched or squeezed by this share along an axis to fill it from side to side: less than what would
// make particles each other's TOO_NEAR.
#define STRETCH 0.095

// How far an axis that would take `fit` points is stretched by `count` of them, of which the outer ones lie half a spacing inside;
// a hundredth of a spacing is forgiven for rounding.
static double stretch_of(double fit, double count) {
  return fabs(fit - count) <= 0.01 ? 0 : count < 2 ? INFINITY : (fit - 1) / (count - 1) - 1;
}

// The numbers of points that an axis may have, whole spacings if no other comes near enough. Returns how many, at most 4.
static int axis_choices(double fit, double choice[4]) {
  double whole = floor(fit + 0.01);
  int count = 0;
  for (double n = fmax(whole - 1, 1); n <= whole + 2; n++)
    if (fabs(stretch_of(fit, n)) <= STRETCH) choice[count++] = n;
  if (count == 0) choice[count++] = fmax(whole, 1);
  return count;
}

// Of all choices one whose number of particles is near to the block's volume, so that the water's level is right also where the
// spacing does not divide the block; of those that are about as near, the most even one. Returns the number of particles.
static double block_counts(const SimBlockDef *block, float spacing, double counts[3]) {
  double choice[3][4], fit[3], wanted = 1, best = INFINITY, points = 1;
  int choices[3];
  for (int k = 0; k < 3; k++) {
    fit[k] = ((double)block->max[k] - (double)block->min[k]) / (double)spacing;
    choices[k] = axis_choices(fit[k], choice[k]);
    wanted *= fit[k];
  }
  for (int z = 0; z < choices[2]; z++)
    for (int y = 0; y < choices[1]; y++)
      for (int x = 0; x < choices[0]; x++) {
        const double n[3] = {choice[0][x], choice[1][y], choice[2][z]};
        double uneven = 0;
        for (int k = 0; k < 3; k++) uneven += stretch_of(fit[k], n[k]) * stretch_of(fit[k], n[k]);
        double cost = uneven > 0 ? fabs(n[0] * n[1] * n[2] / wanted - 1) + 0.1 * uneven : 0;
        if (cost >= best) continue;
        best = cost;
        memcpy(counts, n, sizeof n);
        points = n[0] * n[1] * n[2];
      }
  return points;
}

static double block_lattice(const SimBlockDef *block, float spacing, Lattice *lattice) {
  double counts[3] = {1, 1, 1}, points = block_counts(block, spacing, counts);
  lattice->radius2 = INFINITY;
  for (int k = 0; k < 3; k++) {
    double length = (double)block->max[k] - (double)block->min[k], fit = length / (double)spacing;
    double stretch = stretch_of(fit, counts[k]);
    lattice->size[k] = counts[k] > 1e9 ? 1000000000 : (int32_t)counts[k];
    lattice->step[k] = stretch == 0 || fabs(stretch) > STRETCH ? spacing : spacing * (float)(1 + stretch);
    lattice->origin[k] = fit < 1 ? (float)(block->min[k] + length / 2) : block->min[k] + spacing / 2;
  }
  return points;
}

double sim_block_particles(const SimBlockDef *block, float particle_radius) {
  double counts[3];
  return block_counts(block, 2 * particle_radius, counts);
}

// Points of a ball, in spacings, on a lattice whose middle is a point (gap = 0) or midway between two (½) along each axis.
static double ball_points(double radius, const double gap[3]) {
  double points = 0, y_reach = floor(radius + gap[1]) - gap[1], z_reach = floor(radius + gap[2]) - gap[2];
  for (double z = -z_reach; z <= z_reach; z++)
    for (double y = -y_reach; y <= y_reach; y++) {
      double rest = radius * radius - y * y - z * z;
      if (rest >= 0) points += 2 * (floor(sqrt(rest) + gap[0]) - gap[0]) + 1;
    }
  return points;
}

// Points come and go in whole shells as the radius grows. So of the lattices that are symmetric about the centre, and of
// cuts up to a fifth of a spacing away from the radius, the one is taken that is nearest in volume.
static double drop_lattice(const SimDropDef *drop, float spacing, Lattice *lattice) {
  const double radius = (double)drop->radius / (double)spacing, volume = 4.18879020478639 * radius * radius * radius;
  double best = 1, best_cut = 0.1, best_gap[3] = {0, 0, 0};
  if (volume > SIM_MAX_PARTICLES) return volume;
  for (int k = 0; k < 36; k++) {
    // The nearest cuts first; a hair more, so that no point lies on the cut.
    double cut = radius * 1.000001 + 0.05 * ((k / 4 + 1) / 2) * (k / 4 % 2 ? 1 : -1);
    const double gap[3] = {k % 4 > 0 ? 0.5 : 0, k % 4 > 1 ? 0.5 : 0, k % 4 > 2 ? 0.5 : 0};
    double points = cut > 0 ? ball_points(cut, gap) : 0;
    if (points == 0 || fabs(points - volume) >= fabs(best - volume)) continue;
    best = points, best_cut = cut;
    memcpy(best_gap, gap, sizeof gap);
  }
  lattice->radius2 = best_cut * best_cut;
  for (int k = 0; k < 3; k++) {
    lattice->size[k] = (int32_t)(2 * (floor(best_cut + best_gap[k]) - best_gap[k])) + 1;
    lattice->step[k] = spacing;
    lattice->origin[k] = drop->centre[k] - 0.5f * spacing * (float)(lattice->size[k] - 1);
  }
  return best;
}

static bool lattice_has(const Lattice *lattice, const int32_t at[3]) {
  double distance2 = 0;
  for (int k = 0; k < 3; k++) {
    double x = at[k] - 0.5 * (lattice->size[k] - 1);
    distance2 += x * x;
  }
  return distance2 <= lattice->radius2;
}

// Counter-based random numbers (splitmix64: Steele, Lea, Flood, 2014): the value depends on seed, particle and axis only.
static float random_share(uint64_t seed, uint64_t particle, uint64_t axis) {
  uint64_t x = seed * 0x9e3779b97f4a7c15u + particle * 4 + axis + 1;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  x ^= x >> 31;
  return (float)(x >> 40) / 16777216.0f * 2 - 1;
}

// A sorted copy of the particles that are there already, to measure distances to.
static bool sort_present(SimWorld *world, SimError *error) {
  int32_t count = world->particles.count;
  void *target[3];
  const void *source[3];
  SimPositions places = sim_positions(world->particles.now.position);
  if (!sim_grid_sort(&world->fill_sort, places, count, sim_cells(world->cubic.spacing), world->threads))
    return sim_fail(error, "out of memory");
  for (int k = 0; k < 3; k++) {
    if (!sim_reserve((void **)&world->fill_position[k], (size_t)count, sizeof(float)))
      return sim_fail(error, "out of memory");
    target[k] = world->fill_position[k];
    source[k] = world->particles.now.position[k];
  }
  sim_grid_gather(&world->fill_sort, count, world->threads, 3, source, target);
  return true;
}

static bool occupied(const SimWorld *world, const float point[3]) {
  float radius = TOO_NEAR * world->cubic.spacing;
  SimRange ranges[SIM_MAX_RANGES];
  int32_t n = sim_grid_ranges(&world->fill_sort.grid, point, radius, ranges);
  float *const *x = world->fill_position;
  for (int32_t r = 0; r < n; r++)
    for (int32_t j = ranges[r].begin; j < ranges[r].end; j++) {
      float dx = x[0][j] - point[0], dy = x[1][j] - point[1], dz = x[2][j] - point[2];
      if (dx * dx + dy * dy + dz * dz < radius * radius) return true;
    }
  return false;
}

/// What is being filled.
typedef struct Fill {
  Lattice lattice;
  double points; ///< of the lattice, more than fit into an int32_t perhaps
  const float *velocity, *colour;
  bool start;
  bool among; ///< there are particles already
} Fill;

static bool is_free(const SimWorld *world, const Fill *fill, const float point[3]) {
  return sim_boundary_free(&world->boundary, point) && !(fill->among && occupied(world, point));
}


// A free place may touch a wall a little: move it clear.
static void add(SimWorld *world, const Fill *fill, float point[3]) {
  const float from[3] = {point[0], point[1], point[2]};
  sim_boundary_clamp(&world->boundary, NULL, from, point);
  sim_world_add(world, point, fill->velocity, fill->colour);
}

// Go through the lattice and add a particle at each free point, at most `room` of them. Returns the number of free points.
static int32_t go_through(SimWorld *world, const Fill *fill, int32_t room) {
  const Lattice *lattice = &fill->lattice;
  int32_t found = 0;
  for (int32_t z = 0; z < lattice->size[2]; z++)
    for (int32_t y = 0; y < lattice->size[1]; y++)
      for (int32_t x = 0; x < lattice->size[0]; x++) {
        const int32_t at[3] = {x, y, z};
        float point[3];
        if (!lattice_has(lattice, at)) continue;
        for (int k = 0; k < 3; k++) point[k] = lattice->origin[k] + lattice->step[k] * (float)at[k];
        if (is_free(world, fill, point) && found++ < room) add(world, fill, point);
      }
  return found;
}

static void raise_limits(SimWorld *world, const Fill *fill) {
  const float *v = fill->velocity;
  float speed = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  if (10 * speed > world->speed_limit) world->speed_limit = 10 * speed;
}

static bool take_colour(SimWorld *world, const float colour[3], SimError *error) {
  if (colour[0] == 0 && colour[1] == 0 && colour[2] == 0) return true;
  return sim_particles_colour(&world->particles, sim_water_colour) || sim_fail(error, "out of memory");
}

static int32_t run(SimWorld *world, Fill *fill, SimError *error) {
  if (fill->points > SIM_MAX_PARTICLES)
    return sim_fail(error, "too many particles: %.0f, at most %d", fill->points, SIM_MAX_PARTICLES), -1;
  int32_t wanted = (int32_t)fill->points;
  fill->among = world->particles.count > 0;
  if (!take_colour(world, fill->colour, error) || !sort_present(world, error)) return -1;
  // Particles that make way for others: no more than find a place.
  if (world->def.reuse && wanted > sim_world_limit(world) - world->particles.count) wanted = go_through(world, fill, 0);
  int32_t room = sim_world_make_way(world, wanted, error);
  if (room < 0) return -1;
  int32_t found = go_through(world, fill, room), added = found < room ? found : room;
  if (fill->start && found > room)
    return sim_fail(error, "too many particles at the start: more than %d", sim_world_limit(world)), -1;
  raise_limits(world, fill);
  if (fill->start)
    world->counts.left_out += (int32_t)fill->points - added;
  else
    world->counts.emitted += added;
  if (added > 0) world->settled = false;
  return added;
}

int32_t sim_fill_block(SimWorld *world, const SimBlockDef *block, bool start, SimError *error) {
  Fill fill = {.velocity = block->velocity, .colour = block->colour, .start = start};
  fill.points = block_lattice(block, world->cubic.spacing, &fill.lattice);
  return run(world, &fill, error);
}

int32_t sim_fill_drop(SimWorld *world, const SimDropDef *drop, bool start, SimError *error) {
  Fill fill = {.velocity = drop->velocity, .colour = drop->colour, .start = start};
  fill.points = drop_lattice(drop, world->cubic.spacing, &fill.lattice);
  return run(world, &fill, error);
}

void sim_fill_jitter(SimWorld *world) {
  float *const *x = world->particles.now.position, jitter = world->def.jitter * world->cubic.spacing;
  for (int32_t i = 0; i < world->particles.count && jitter > 0; i++) {
    float from[3], point[3];
    for (int k = 0; k < 3; k++) {
      from[k] = x[k][i];
      point[k] = from[k] + jitter * random_share(world->def.seed, (uint64_t)i, (uint64_t)k);
    }
    sim_boundary_clamp(&world->boundary, NULL, from, point);
    for (int k = 0; k < 3; k++) x[k][i] = point[k];
  }
}

static bool may_add(const SimWorld *world, SimError *error) {
  if (world->failed && error) *error = world->failure;
  if (!world->failed && world->def.ripple) return sim_fail(error, "a ripple has no particles, none can be added");
  return !world->failed;
}

int32_t sim_world_pour(SimWorld *world, const SimBlockDef *block, SimError *error) {
  if (!may_add(world, error) || !sim_block_check(block, "block", error)) return -1;
  int32_t added = sim_fill_block(world, block, false, error);
  return sim_world_settle(world, error) ? added : -1;
}

int32_t sim_world_drop(SimWorld *world, const SimDropDef *drop, SimError *error) {
  if (!may_add(world, error) || !sim_drop_check(drop, "drop", error)) return -1;
  int32_t added = sim_fill_drop(world, drop, false, error);
  return sim_world_settle(world, error) ? added : -1;
}
