#include "tests/reference/field.h"

#include <stdlib.h>
#include <string.h>

// Half a spacing above the highest layer of a level lattice, where its level is, the field is 0.3027, and in one radius it
// falls by 0.88, so that a hundredth more or less moves the level by 0.011 radii. It is less than ½ because the ellipsoids
// of that layer are flat.
#define FIELD_ISO 0.3027
const double field_iso = FIELD_ISO;

// P at the distance of one radius from the only particle, times V/h³: what a particle alone adds at its own surface.
#define ALONE_AT_RADIUS (0.71875 / 3.14159265358979323846)
#define ALONE_AT_CENTRE (1 / 3.14159265358979323846)
#define CROWDED 0.6 // from here on a particle has enough neighbours

#define MAX_CELLS (1 << 27)
#define FARTHEST 1e6 // m, as in the renderer

// ---- From the frame --------------------------------------------------------------------------------------------------

static bool finite_vec(const float v[3]) {
  return fabsf(v[0]) < (float)FARTHEST && fabsf(v[1]) < (float)FARTHEST && fabsf(v[2]) < (float)FARTHEST;
}

// The inverse of 4 T. false: T has none.
static bool invert(const float m[6], double inverse[6]) {
  const double xx = (double)m[0], yy = (double)m[1], zz = (double)m[2];
  const double xy = (double)m[3], xz = (double)m[4], yz = (double)m[5];
  const double a = yy * zz - yz * yz, b = xz * yz - xy * zz, c = xy * yz - xz * yy;
  const double det = xx * a + xy * b + xz * c;
  if (!(det > 0 && isfinite(det))) return false;
  const double s = 0.25 / det;
  const double rows[6] = {a, xx * zz - xz * xz, xx * yy - xy * xy, b, c, xy * xz - xx * yz};
  for (int k = 0; k < 6; ++k) inverse[k] = s * rows[k];
  return true;
}

// The largest sum of magnitudes in a row of T: at least its longest semi-axis, and equal to it for a ball.
static double longest_axis(const float m[6]) {
  double a[6];
  for (int k = 0; k < 6; ++k) a[k] = fabs((double)m[k]);
  return fmax(a[0] + a[3] + a[4], fmax(a[3] + a[1] + a[5], a[4] + a[5] + a[2]));
}

static bool take_particle(FieldParticle *to, const SimFrame *frame, int32_t i) {
  const float *t = frame->ellipsoid + 6 * (size_t)i;
  if (!finite_vec(frame->position + 3 * (size_t)i) || !invert(t, to->inverse)) return false;
  to->centre = vec_of(frame->position + 3 * (size_t)i);
  to->reach = 4 * longest_axis(t);
  to->weight = 1;
  return true;
}

static void take_particles(Field *field, const SimFrame *frame) {
  field->min = (Vec){INFINITY, INFINITY, INFINITY};
  field->max = (Vec){-INFINITY, -INFINITY, -INFINITY};
  for (int32_t i = 0; i < frame->count; ++i) {
    FieldParticle *p = &field->particle[field->count];
    if (frame->particle_class[i] != SIM_AGGREGATED || !take_particle(p, frame, i)) continue;
    ++field->count;
    field->reach = fmax(field->reach, p->reach);
    field->min =
        (Vec){fmin(field->min.x, p->centre.x), fmin(field->min.y, p->centre.y), fmin(field->min.z, p->centre.z)};
    field->max =
        (Vec){fmax(field->max.x, p->centre.x), fmax(field->max.y, p->centre.y), fmax(field->max.z, p->centre.z)};
  }
}

// ---- Cells -----------------------------------------------------------------------------------------------------------

static int32_t cell_along(double x, double min, double cell, int32_t size) {
  const double c = floor((x - min) / cell);
  return c < 0 ? 0 : c >= size ? size - 1 : (int32_t)c;
}

static size_t cell_of(const Field *f, Vec p) {
  const size_t x = (size_t)cell_along(p.x, f->min.x, f->cell, f->size[0]);
  const size_t y = (size_t)cell_along(p.y, f->min.y, f->cell, f->size[1]);
  const size_t z = (size_t)cell_along(p.z, f->min.z, f->cell, f->size[2]);
  return (z * (size_t)f->size[1] + y) * (size_t)f->size[0] + x;
}

static bool size_cells(Field *f) {
  f->cell = f->reach / 2;
  const Vec extent = vec_sub(f->max, f->min);
  const double sides[3] = {floor(extent.x / f->cell) + 1, floor(extent.y / f->cell) + 1, floor(extent.z / f->cell) + 1};
  if (!(sides[0] * sides[1] * sides[2] < MAX_CELLS)) return false;
  for (int k = 0; k < 3; ++k) f->size[k] = (int32_t)sides[k];
  return true;
}

// Counting sort of the particles by cell.
static bool sort_particles(Field *f) {
  if (!size_cells(f)) return false;
  const size_t cells = (size_t)f->size[0] * (size_t)f->size[1] * (size_t)f->size[2];
  FieldParticle *sorted = calloc((size_t)f->count, sizeof *sorted);
  f->start = calloc(cells + 2, sizeof *f->start);
  if (sorted == NULL || f->start == NULL) {
    free(sorted);
    return false;
  }
  for (int32_t i = 0; i < f->count; ++i) ++f->start[cell_of(f, f->particle[i].centre) + 2];
  for (size_t c = 2; c < cells + 2; ++c) f->start[c] += f->start[c - 1];
  for (int32_t i = 0; i < f->count; ++i) sorted[f->start[cell_of(f, f->particle[i].centre) + 1]++] = f->particle[i];
  free(f->particle);
  f->particle = sorted;
  return true;
}

// ---- The sum ---------------------------------------------------------------------------------------------------------

static double spline(double q) {
  if (q >= 1) return 0;
  const double a = 1 - q, b = 0.5 - q;
  return 2 * a * a * a - (q < 0.5 ? 8 * b * b * b : 0);
}

static double kernel(const FieldParticle *p, Vec at) {
  const Vec d = vec_sub(at, p->centre);
  if (vec_dot(d, d) >= p->reach * p->reach) return 0;
  const double *g = p->inverse;
  const Vec q = {g[0] * d.x + g[3] * d.y + g[4] * d.z, g[3] * d.x + g[1] * d.y + g[5] * d.z,
                 g[4] * d.x + g[5] * d.y + g[2] * d.z};
  return p->weight * spline(vec_length(q));
}

static void cells_around(const Field *f, double x, double min, int axis, int32_t range[2]) {
  const double low = floor((x - f->reach - min) / f->cell), high = floor((x + f->reach - min) / f->cell);
  range[0] = low < 0 ? 0 : low > f->size[axis] ? f->size[axis] : (int32_t)low;
  range[1] = high < 0 ? -1 : high >= f->size[axis] ? f->size[axis] - 1 : (int32_t)high;
}

// Σ over the particles; V_j |det G_j| times the spline's factor 8/π is 1/π, since det T = r³ and V = 8 r³.
static double sum(const Field *f, Vec p) {
  int32_t x[2], y[2], z[2];
  double total = 0;
  cells_around(f, p.x, f->min.x, 0, x);
  cells_around(f, p.y, f->min.y, 1, y);
  cells_around(f, p.z, f->min.z, 2, z);
  if (x[0] > x[1]) return 0;
  for (int32_t k = z[0]; k <= z[1]; ++k) {
    for (int32_t j = y[0]; j <= y[1]; ++j) {
      const size_t row = ((size_t)k * (size_t)f->size[1] + (size_t)j) * (size_t)f->size[0];
      const int32_t end = f->start[row + (size_t)x[1] + 1];
      for (int32_t i = f->start[row + (size_t)x[0]]; i < end; ++i) total += kernel(&f->particle[i], p);
    }
  }
  return total * ALONE_AT_CENTRE;
}

// The iso-surface of a particle without neighbours would hardly be there; with this weight it is a ball of the particle's
// radius. Particles that have neighbours enough keep the weight 1.
static void weigh_lonely(Field *f) {
  double *weight = calloc((size_t)f->count, sizeof *weight);
  if (weight == NULL) return;
  const double most = FIELD_ISO / ALONE_AT_RADIUS;
#pragma omp parallel for schedule(dynamic, 256)
  for (int32_t i = 0; i < f->count; ++i) {
    const double lonely = (CROWDED - sum(f, f->particle[i].centre)) / (CROWDED - ALONE_AT_CENTRE);
    weight[i] = 1 + (most - 1) * fmin(1, fmax(0, lonely));
  }
  for (int32_t i = 0; i < f->count; ++i) f->particle[i].weight = weight[i];
  free(weight);
}

bool field_create(Field *field, const SimFrame *frame, const Environment *environment) {
  *field = (Field){.radius = (double)frame->particle_radius, .environment = environment};
  field->particle = calloc((size_t)frame->count + 1, sizeof *field->particle);
  if (field->particle == NULL) return false;
  take_particles(field, frame);
  if (field->count == 0) return true;
  if (!sort_particles(field)) return false;
  weigh_lonely(field);
  return true;
}

void field_destroy(Field *field) {
  free(field->particle);
  free(field->start);
  *field = (Field){0};
}

// ---- Walls -----------------------------------------------------------------------------------------------------------

// Solids and the floor hold no particles, so the sum falls off before it reaches them, and the iso-surface would leave a
// film of air. So a point closer to them than one radius, or inside them by up to two spacings, takes the value of the
// point that is moved out to one radius along the distance's gradient (several times, where two walls meet), as if the
// water went on behind the wall. A ray in the water then always meets the wall before it meets the iso-surface behind it.
static double distance(const Environment *e, Vec p, Vec *outward) {
  double d = solids_distance(&e->solids, p, outward);
  if (e->has_floor && p.y - e->floor_level < d) {
    d = p.y - e->floor_level;
    *outward = (Vec){0, 1, 0};
  }
  return d;
}

static Vec move_out(const Field *f, Vec p) {
  for (int i = 0; i < 8; ++i) {
    Vec outward;
    const double d = distance(f->environment, p, &outward);
    if (d >= f->radius * 0.999) break;
    p = vec_along(p, f->radius - d, outward);
  }
  return p;
}

double field_value(const Field *f, Vec p) {
  Vec outward;
  const double d = distance(f->environment, p, &outward);
  if (d < -4 * f->radius) return 0;
  return sum(f, d < f->radius ? move_out(f, p) : p);
}

// Deep in a solid no ray comes by, and any vector will do.
Vec field_normal(const Field *f, Vec p) {
  Vec outward;
  if (distance(f->environment, p, &outward) < -2 * f->radius) return (Vec){0, 1, 0};
  const double h = 0.05 * f->radius;
  const Vec rise = {
      field_value(f, (Vec){p.x + h, p.y, p.z}) - field_value(f, (Vec){p.x - h, p.y, p.z}),
      field_value(f, (Vec){p.x, p.y + h, p.z}) - field_value(f, (Vec){p.x, p.y - h, p.z}),
      field_value(f, (Vec){p.x, p.y, p.z + h}) - field_value(f, (Vec){p.x, p.y, p.z - h}),
  };
  const double length = vec_length(rise);
  return length > 0 ? vec_scale(-1 / length, rise) : (Vec){0, 1, 0};
}
