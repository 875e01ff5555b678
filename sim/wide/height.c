// Heights of the free surface: see surface_heightfield.c for the method.
//
// A column keeps the particles within reach of its axis, collected from the highest layer of cells downwards as far as a
// sample needs them, so that φ is one short sum. Particles of a heap that do not fit are summed straight from the grid.
//
// A wall of the container is a mirror: a column within reach of it also collects the particles around its mirror images
// (SimHeightContext), and the floor's mirror image is a second sample of the same column below the floor. So water is
// as high beside a wall as in the middle, however shallow. What obstacles displace lowers the iso-value (displaced).
//
// Sums run over SIM_CHUNK partial sums that are added in one fixed order, on every instruction set.
//
// The crossing is found by the Illinois method (Dowell & Jarratt, A Modified Regula Falsi Method for Computing the Root
// of an Equation, 1971), which keeps a bracket and converges faster than any bisection.
#include "sim/surface.h"
#include "sim/wide/kernels.h"

#define REFINEMENTS 6
#define ROOM 512 // particles of a column

// Mirror images of a column along one axis, itself among them. More than two only where walls are nearer to each other than
// twice the reach.
#define IMAGES 6

typedef struct Image {
  float x, z;              ///< m
  int32_t low[2], high[2]; ///< cells in reach along x and z
} Image;

typedef struct Column {
  const SimHeightContext *context;
  const SimNear *near; ///< bodies that may be in reach; NULL: none
  Image image[IMAGES * IMAGES];
  int32_t images;
  float iso;     ///< where nothing is displaced
  bool rim;      ///< beside the wall of a glass
  int32_t layer; ///< cells from here on upwards have been collected
  int32_t count;
  bool full;                                           ///< there was no room: the lists are of no use
  float y[ROOM + SIM_CHUNK], reach2[ROOM + SIM_CHUNK]; ///< m; m², what is left of the radius at the axis
} Column;

static void add_image(Column *column, float x, float z) {
  const SimGrid *grid = column->context->surface->grid;
  const double centre[2] = {(double)x, (double)z}, reach = (double)column->context->radius * 1.00001;
  Image *image = &column->image[column->images++];
  image->x = x, image->z = z;
  for (int k = 0; k < 2; k++) {
    image->low[k] = sim_grid_index(grid, 2 * k, centre[k] - reach);
    image->high[k] = sim_grid_index(grid, 2 * k, centre[k] + reach);
  }
}

// The images of x between two mirrors that are in reach of what lies between them; x itself first. Returns their number.
static int mirror(float x, float low, float high, float reach, float image[IMAGES]) {
  float width = high - low;
  int count = 1;
  image[0] = x = x < low ? 2 * low - x : x > high ? 2 * high - x : x;
  for (int k = -1; k <= 1; k++) {
    const float at[2] = {2 * low - x + 2 * width * (float)k, x + 2 * width * (float)k};
    for (int side = 0; side < (k == 0 ? 1 : 2); side++)
      if (at[side] > low - reach && at[side] < high + reach && count < IMAGES) image[count++] = at[side];
  }
  return count;
}

static void mirror_in_box(Column *column, float x, float z) {
  const SimHeightContext *c = column->context;
  float across[IMAGES], along[IMAGES];
  int n = mirror(x, c->walls->min[0], c->walls->max[0], c->radius, across);
  int m = mirror(z, c->walls->min[2], c->walls->max[2], c->radius, along);
  for (int k = 0; k < m; k++)
    for (int i = 0; i < n; i++) add_image(column, across[i], along[k]);
}

// A glass is a mirror along its radius. Its wall bends away from the plane that touches it, on both sides by t²/2R at the
// distance t beside the point, where t² is h²/5 on average: so much is missing between water and image. How much φ lies
// there, in a layer at the distance d, is 8/(3π h) (1 − d²/h²)^(3/2) of all. Where the water is deep enough, what is missing
// is measured instead (iso_at).
static void mirror_in_glass(Column *column, float x, float z) {
  const SimHeightContext *c = column->context;
  const float *axis = c->axis;
  float dx = x - axis[0], dz = z - axis[1], r = sqrtf(dx * dx + dz * dz), fold = 2 * c->glass - r;
  if (r > c->glass && fold > 0) { // the node beyond the wall shows what its image does
    dx *= fold / r, dz *= fold / r;
    float inner = fold;
    fold = r, r = inner;
  }
  add_image(column, axis[0] + dx, axis[1] + dz);
  float left = 1 - (c->glass - r) * (c->glass - r) / (c->radius * c->radius);
  if (left <= 0 || r <= 0) return;
  add_image(column, axis[0] + dx * (fold / r), axis[1] + dz * (fold / r));
  column->rim = true;
  column->iso *= 1 - 0.17f * sim_smaller(c->radius / c->glass, 1) * left * sqrtf(left);
}

static void open_column(Column *column, const SimHeightContext *c, const SimNear *near, float x, float z) {
  column->context = c;
  column->near = near;
  column->iso = c->iso;
  column->layer = c->surface->grid->size[1];
  column->images = column->count = 0;
  column->full = column->rim = false;
  if (!c->walls)
    add_image(column, x, z);
  else if (c->glass > 0)
    mirror_in_glass(column, x, z);
  else
    mirror_in_box(column, x, z);
}

// The particles of a layer's row z are those from begin to end.
static SimRange row_of(const Column *column, const Image *image, int32_t layer, int32_t z) {
  const SimGrid *grid = column->context->surface->grid;
  const int32_t *row = grid->cell_start + ((int64_t)z * grid->size[1] + layer) * grid->size[0];
  return (SimRange){row[image->low[0]], row[image->high[0] + 1]};
}

static void collect_row(Column *column, const Image *image, SimRange range) {
  const SimHeightContext *c = column->context;
  const float *x = c->surface->position[0], *y = c->surface->position[1], *z = c->surface->position[2];
  SimF px = sim_f(image->x), pz = sim_f(image->z), r2 = sim_f(c->radius * c->radius);
  for (int32_t j = range.begin; j < range.end; j += SIM_LANES) {
    SimF dx = sim_load(x + j) - px, dz = sim_load(z + j) - pz;
    float left[SIM_LANES];
    sim_store(left, r2 - dx * dx - dz * dz);
    for (int k = 0; k < SIM_LANES && j + k < range.end; k++) {
      column->y[column->count] = y[j + k]; // overwritten unless it is counted
      column->reach2[column->count] = left[k];
      column->count += left[k] > 0;
    }
    column->full = column->full || column->count > ROOM - SIM_CHUNK; // after any number of lanes the same
    if (column->full) return;
  }
}

// Forget what lies so high above `top` that no sample will reach it again.
static void forget_above(Column *column, float top) {
  int32_t kept = 0;
  for (int32_t j = 0; j < column->count; j++) {
    if (column->y[j] - column->context->radius > top) continue;
    column->y[kept] = column->y[j];
    column->reach2[kept++] = column->reach2[j];
  }
  column->count = kept;
}

static void collect_layer(Column *column, float top) {
  column->layer--;
  if (column->count > ROOM / 2) forget_above(column, top);
  for (int32_t n = 0; n < column->images; n++) {
    const Image *image = &column->image[n];
    for (int32_t k = image->low[1]; k <= image->high[1] && !column->full; k++)
      collect_row(column, image, row_of(column, image, column->layer, k));
  }
  for (int32_t k = column->count; k < column->count + SIM_CHUNK && !column->full; k++)
    column->y[k] = column->reach2[k] = 0; // add nothing
}

/// m: whatever has not been collected lies below this.
static double collected_down_to(const Column *column) {
  const SimGrid *grid = column->context->surface->grid;
  return column->layer == 0 ? -INFINITY
                            : (double)grid->origin[1] + ((double)column->layer + 1e-3) * (double)grid->cell_size;
}

// φ from the grid around one image, for heaps.
static float potential_of_heap(const Column *column, const Image *image, float height) {
  const SimHeightContext *c = column->context;
  const SimGrid *grid = c->surface->grid;
  const float *const *p = (const float *const *)c->surface->position;
  float sum = 0, r2 = c->radius * c->radius;
  int32_t low = sim_grid_index(grid, 1, (double)height - 1.00001 * (double)c->radius),
          high = sim_grid_index(grid, 1, (double)height + 1.00001 * (double)c->radius);
  for (int32_t layer = low; layer <= high; layer++)
    for (int32_t k = image->low[1]; k <= image->high[1]; k++) {
      SimRange range = row_of(column, image, layer, k);
      for (int32_t j = range.begin; j < range.end; j++) {
        float dx = p[0][j] - image->x, dy = p[1][j] - height, dz = p[2][j] - image->z;
        float left = r2 - dx * dx - dz * dz - dy * dy;
        if (left > 0) sum += sqrtf(left);
      }
    }
  return sum / c->radius;
}

// φ from the particles that have been collected.
static float potential_of_list(const Column *column, float height) {
  SimF sums[SIM_CHUNK / SIM_LANES], at = sim_f(height), zero = sim_f(0);
  for (int p = 0; p < SIM_CHUNK / SIM_LANES; p++) sums[p] = zero;
  for (int32_t j = 0; j < column->count; j += SIM_CHUNK)
    for (int p = 0; p < SIM_CHUNK / SIM_LANES; p++) {
      SimF dy = sim_load(column->y + j + p * SIM_LANES) - at;
      SimF left = sim_load(column->reach2 + j + p * SIM_LANES) - dy * dy;
      sums[p] = sums[p] + sim_sqrt(sim_max(left, zero));
    }
  float lane[SIM_CHUNK];
  for (int p = 0; p < SIM_CHUNK / SIM_LANES; p++) sim_store(lane + p * SIM_LANES, sums[p]);
  for (int half = SIM_CHUNK / 2; half > 0; half /= 2)
    for (int k = 0; k < half; k++) lane[k] += lane[k + half];
  return lane[0] / column->context->radius;
}

static float potential_at(const Column *column, float height) {
  float sum = 0;
  if (!column->full) return potential_of_list(column, height);
  for (int32_t n = 0; n < column->images; n++) sum += potential_of_heap(column, &column->image[n], height);
  return sum;
}

static float potential(Column *column, float height, float top) {
  const SimHeightContext *c = column->context;
  while (!column->full && collected_down_to(column) > (double)height - (double)c->radius) collect_layer(column, top);
  float sum = potential_at(column, height);
  // What is reflected by the floor lies nowhere higher than what is not, so it changes nothing where φ begins.
  return c->walls && height - c->floor < c->radius ? sum + potential_at(column, 2 * c->floor - height) : sum;
}

// The share of φ's water that bodies displace at a point. `below`: of the half ball below it, since the water ends there; a
// gradient downwards says that the solid lies in that half altogether, one upwards that it lies in the other one.
static float displaced_at(const Column *column, const float point[3], bool below) {
  const SimBoundary *solids = column->context->solids;
  float sum = 0;
  bool all = column->near->count < 0;
  int32_t count = all ? solids->body_count : column->near->count;
  for (int32_t n = 0; n < count; n++) {
    const SimBody *body = &solids->bodies[all ? n : column->near->body[n]];
    float dx = point[0] - body->position[0], dy = point[1] - body->position[1], dz = point[2] - body->position[2];
    float reach = body->bound + solids->wall.reach;
    if (!(dx * dx + dy * dy + dz * dz < reach * reach)) continue;
    float g[3], share = sim_body_solid(body, &solids->wall, point, g);
    float length = sqrtf(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    sum += below && length > 0 ? share * (1 - g[1] / length) : share;
  }
  return sum;
}

/// Nothing displaces more than this: closer to a solid, and inside, surface_height_fill.c takes over.
#define MOST_DISPLACED 0.5f

// The share of φ that there is beside the wall of a glass, where a lattice that is cut round leaves gaps: that of the whole φ of
// a point farther below by the radius, altogether under water. 1 where the water is not that deep.
static float measured(Column *column, float height, float top) {
  const SimHeightContext *c = column->context;
  if (height - c->floor < c->radius) return 1;
  return potential(column, height - c->radius, top) / (2 * c->iso);
}

// The iso-value at a height; no sample will be above `top`.
static float iso_at(Column *column, float height, float top) {
  float iso = column->iso, displaced = 0;
  if (column->rim) iso = sim_smaller(iso, column->context->iso * measured(column, height, top));
  for (int32_t n = 0; column->near && n < column->images; n++)
    displaced += displaced_at(column, (const float[3]){column->image[n].x, height, column->image[n].z}, true);
  iso = sim_smaller(iso, column->context->iso * (1 - displaced));
  return sim_larger(iso, column->context->iso * (1 - MOST_DISPLACED));
}

// The highest place at or below `below` that a particle of height y reaches, `reach2` being left of its radius.
static double reached(double y, double reach2, double below) {
  double half = sqrt(reach2);
  return y - half < below ? fmin(y + half, below) : -INFINITY;
}

static double heap_reaches(const Column *column, const Image *image, double below) {
  const SimHeightContext *c = column->context;
  const float *const *p = (const float *const *)c->surface->position;
  double best = -INFINITY, r2 = (double)c->radius * (double)c->radius;
  for (int32_t layer = 0; layer < c->surface->grid->size[1]; layer++)
    for (int32_t k = image->low[1]; k <= image->high[1]; k++) {
      SimRange range = row_of(column, image, layer, k);
      for (int32_t j = range.begin; j < range.end; j++) {
        double dx = (double)p[0][j] - (double)image->x, dz = (double)p[2][j] - (double)image->z;
        double left = r2 - dx * dx - dz * dz;
        if (left > 0) best = fmax(best, reached((double)p[1][j], left, below));
      }
    }
  return best;
}

// The highest place at or below `below` in the column where φ is not zero; −INFINITY when there is none.
static double highest_below(Column *column, double below) {
  double best = -INFINITY, radius = (double)column->context->radius;
  for (;;) {
    for (int32_t j = 0; j < column->count; j++)
      best = fmax(best, reached((double)column->y[j], (double)column->reach2[j], below));
    // What has not been collected yet reaches no higher than this.
    if (column->full || best >= collected_down_to(column) + radius || column->layer == 0) break;
    collect_layer(column, (float)below);
  }
  for (int32_t n = 0; column->full && n < column->images; n++)
    best = fmax(best, heap_reaches(column, &column->image[n], below));
  return best;
}

// Where φ is the iso-value between two heights, the water's end (`low`, below the other one or above it) and the air's; `at_low` (not
// negative) and `at_high` (negative) are what φ is above it there.
static float crossing(Column *column, float low, float high, float at_low, float at_high) {
  float top = sim_larger(low, high);
  int side = 0; // of the end that was moved last
  for (int n = 0; n < REFINEMENTS; n++) {
    float middle = low + (high - low) * (at_low / (at_low - at_high));
    float at = potential(column, middle, top) - iso_at(column, middle, top);
    if (at >= 0) {
      if (side > 0) at_high *= 0.5f;
      low = middle, at_low = at, side = 1;
    } else {
      if (side < 0) at_low *= 0.5f;
      high = middle, at_high = at, side = -1;
    }
  }
  return low + (high - low) * (at_low / (at_low - at_high));
}

// Samples lie at multiples of the step over the floor, numbered from there.
static float sample_height(const Column *column, double k) {
  return (float)((double)column->context->floor + (double)column->context->step * k);
}

// What φ is above the iso-value in a sample, exact where it is not negative; what is more than that is not asked of bodies.
static float sample(Column *column, double k, float *value) {
  float height = sample_height(column, k), top = sample_height(column, k + 1);
  *value = potential(column, height, top);
  float least = (1 - MOST_DISPLACED) * column->context->iso;
  return *value < least ? *value - least : *value - iso_at(column, height, top);
}

// The next sample below one where φ is zero that may be none of its own: stretches without water are skipped, however tall.
static double skip(Column *column, double k) {
  double base = (double)column->context->floor, step = (double)column->context->step;
  return fmin(k, floor((highest_below(column, base + step * k) - base) / step) + 1);
}

// The water's surface at or below the sample *k, above which φ is `above`; *k becomes that of its first sample with water, negative
// where there is none.
static float surface_below(Column *column, double *k, float above) {
  for (; *k >= 0; --*k) {
    float value, over = sample(column, *k, &value), high = sample_height(column, *k + 1);
    if (over >= 0) return crossing(column, sample_height(column, *k), high, over, above - iso_at(column, high, high));
    if (value == 0) *k = skip(column, *k);
    above = value;
  }
  return column->context->floor;
}

// The lower end of the water that has the sample *k; *k becomes that of the first sample without, negative where there is none.
static float end_below(Column *column, double *k) {
  float value, over = sample(column, *k, &value);
  for (--*k; *k >= 0; --*k) {
    float under = sample(column, *k, &value), high = sample_height(column, *k + 1), low = sample_height(column, *k);
    if (value < (1 - MOST_DISPLACED) * column->context->iso) under = value - iso_at(column, low, high);
    if (under < 0) return crossing(column, high, low, over, under);
    over = under;
  }
  return column->context->floor;
}

// Is there a sample of air between two that no body is near?
static bool open_air(const Column *column, double low, double high) {
  if (!column->near) return low <= high;
  for (double k = high; k >= low; k--) {
    float displaced = 0;
    for (int32_t n = 0; n < column->images; n++)
      displaced += displaced_at(
          column, (const float[3]){column->image[n].x, sample_height(column, k), column->image[n].z}, false);
    if (displaced == 0) return true;
  }
  return false;
}

// The second layer of a column whose first sample with water is k: where obstacles fill the gap or it is narrow, what is below
// belongs to the first one.
static void second_layer(Column *column, double k, float *underside, float *second) {
  const SimHeightContext *c = column->context;
  *underside = *second = c->floor;
  while (k >= 0) {
    float end = end_below(column, &k), value;
    if (k < 0) return;
    double first = k;
    sample(column, k, &value);
    k--;
    float next = surface_below(column, &k, value);
    if (end - next < c->surface->spacing || !open_air(column, k + 1, first)) continue;
    *underside = end, *second = next;
    return;
  }
}

// The layers of a node's column.
static void fill_node(Column *column, int32_t node) {
  const SimHeightContext *c = column->context;
  double top = (double)c->surface->bounds_max[1] + (double)c->radius;
  double k = ceil((top - (double)c->floor) / (double)c->step);
  c->height[node] = surface_below(column, &k, 0);
  if (c->underside) second_layer(column, k, &c->underside[node], &c->second[node]);
}

// The bodies in reach of the columns of some nodes.
static bool select_near(const SimHeightContext *c, int32_t begin, int32_t end, SimNear *near) {
  const SimHeightField *f = c->field;
  if (!c->solids) return false;
  int32_t first = begin / f->size[0], last = (end - 1) / f->size[0];
  float left = f->origin[0], right = left + f->spacing * (float)(f->size[0] - 1);
  if (first == last)
    left += f->spacing * (float)(begin % f->size[0]),
        right = f->origin[0] + f->spacing * (float)((end - 1) % f->size[0]);
  const float low[3] = {left, c->floor, f->origin[1] + f->spacing * (float)first},
              high[3] = {right, c->surface->bounds_max[1] + c->radius, f->origin[1] + f->spacing * (float)last};
  return sim_boundary_select(c->solids, low, high, 0, near) && near->count != 0;
}

void WIDE(sim_surface_heights)(int32_t begin, int32_t end, const void *context) {
  const SimHeightContext *c = context;
  const SimHeightField *f = c->field;
  Column column;
  SimNear near;
  bool any = select_near(c, begin, end, &near);
  for (int32_t node = begin; node < end; node++) {
    float x = f->origin[0] + f->spacing * (float)(node % f->size[0]);
    float z = f->origin[1] + f->spacing * (float)(node / f->size[0]);
    c->height[node] = c->floor;
    if (c->underside) c->underside[node] = c->second[node] = c->floor;
    if (!sim_height_beyond(c, x, z)) {
      open_column(&column, c, any ? &near : NULL, x, z);
      fill_node(&column, node);
    }
  }
}
