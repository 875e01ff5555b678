#include "tests/render/reference/iso.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define STEP 0.025 // spacings
#define HALVINGS 40

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(double out[3], const double a[3], const double b[3]) {
  for (int k = 0; k < 3; ++k) out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static bool normalize(double v[3]) {
  const double length = sqrt(dot(v, v));
  if (length < 1e-12) return false;
  for (int k = 0; k < 3; ++k) v[k] /= length;
  return true;
}

static double distance(const double a[3], const double b[3]) {
  const double v[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  return sqrt(dot(v, v));
}

// ---- Particles and their mirror images -------------------------------------------------------------------------------

// Where a coordinate's image behind the wall of a side is (−1: low, 1: high, 0: the particle itself); NAN: too far away.
static double mirrored(const SimContainer *box, int axis, int side, double x, double reach) {
  if (side == 0) return x;
  const double wall = (double)(side < 0 ? box->min[axis] : box->max[axis]);
  return fabs(x - wall) < reach ? 2 * wall - x : NAN;
}

static void add(IsoWater *water, const SimFrame *frame, int32_t i, const double p[3]) {
  double *sphere = water->sphere + 4 * (size_t)water->count, *colour = water->colour + 3 * (size_t)water->count;
  memcpy(sphere, p, 3 * sizeof *p);
  sphere[3] = (double)(frame->radius != NULL ? frame->radius[i] : frame->particle_radius);
  for (size_t k = 0; k < 3; ++k) colour[k] = frame->colour != NULL ? (double)frame->colour[3 * (size_t)i + k] : 1;
  ++water->count;
}

static void add_with_images(IsoWater *water, const SimFrame *frame, int32_t i) {
  const double reach = fmax(water->support, water->reach);
  const float *at = frame->position + 3 * (size_t)i;
  const int walls = frame->has_container ? 1 : 0;
  for (int a = -walls; a <= walls; ++a) {
    for (int b = -walls; b <= 0; ++b) { // the top is open
      for (int c = -walls; c <= walls; ++c) {
        const double p[3] = {mirrored(&frame->container, 0, a, (double)at[0], reach),
                             mirrored(&frame->container, 1, b, (double)at[1], reach),
                             mirrored(&frame->container, 2, c, (double)at[2], reach)};
        if (!isnan(p[0] + p[1] + p[2])) add(water, frame, i, p);
      }
    }
  }
}

IsoWater iso_water_create(const SimFrame *frame, const RenderRaycast *settings) {
  const double r = (double)frame->particle_radius;
  const size_t most = 18 * (size_t)frame->count + 1;
  IsoWater water = {.settings = *settings,
                    .support = (double)settings->support * r,
                    .reach = (double)settings->normal_reach * r,
                    .spacing = 2 * r,
                    .sphere = malloc(4 * most * sizeof(double)),
                    .colour = malloc(3 * most * sizeof(double))};
  for (int32_t i = 0; i < frame->count; ++i) add_with_images(&water, frame, i);
  return water;
}

void iso_water_destroy(IsoWater *water) {
  free(water->sphere);
  free(water->colour);
  *water = (IsoWater){0};
}

// ---- The field and its surface ---------------------------------------------------------------------------------------

// Cubic spline (Monaghan 1992): normalised to 1 over space, 0 from r = h on.
static double spline(double r, double h) {
  const double q = r / h, scale = 8 / (PI * h * h * h), rest = 1 - q;
  if (q >= 1) return 0;
  return scale * (q <= 0.5 ? 6 * q * q * q - 6 * q * q + 1 : 2 * rest * rest * rest);
}

static double share(const IsoWater *water, const double sphere[4], const double p[3]) {
  const double r = distance(p, sphere), edge = 2 * sphere[3];
  return r >= water->support ? 0 : edge * edge * edge * spline(r, water->support);
}

static double field_of(const IsoWater *water, const double *sphere, int32_t count, const double p[3]) {
  double sum = 0;
  for (int32_t i = 0; i < count; ++i) sum += share(water, sphere + 4 * (size_t)i, p);
  return sum;
}

double iso_field(const IsoWater *water, const double p[3]) {
  return field_of(water, water->sphere, water->count, p);
}

// A ray with the particles that it can meet, which are all that the field on it depends on.
typedef struct Path {
  const IsoWater *water;
  const double *origin, *direction;
  double *sphere;
  int32_t count;
  double begin, end; // where the field can be other than 0
} Path;

static Path path_of(const IsoWater *water, const double origin[3], const double direction[3]) {
  Path path = {water, origin,   direction, malloc(4 * sizeof(double) * (size_t)(water->count + 1)),
               0,     INFINITY, -INFINITY};
  const double dd = dot(direction, direction);
  for (int32_t i = 0; i < water->count; ++i) {
    const double *sphere = water->sphere + 4 * (size_t)i;
    const double to[3] = {sphere[0] - origin[0], sphere[1] - origin[1], sphere[2] - origin[2]};
    const double middle = dot(to, direction) / dd, apart = dot(to, to) - middle * middle * dd;
    const double half = sqrt((water->support * water->support - apart) / dd);
    if (isnan(half)) continue;
    memcpy(path.sphere + 4 * (size_t)path.count++, sphere, 4 * sizeof *sphere);
    path.begin = fmin(path.begin, middle - half);
    path.end = fmax(path.end, middle + half);
  }
  return path;
}

static bool in_water(const Path *path, double t) {
  double p[3];
  for (int k = 0; k < 3; ++k) p[k] = path->origin[k] + t * path->direction[k];
  return field_of(path->water, path->sphere, path->count, p) > (double)path->water->settings.iso;
}

static double bisect(const Path *path, double low, double high, bool inside) {
  for (int i = 0; i < HALVINGS; ++i) {
    const double middle = 0.5 * (low + high);
    if (in_water(path, middle) == inside)
      low = middle;
    else
      high = middle;
  }
  return 0.5 * (low + high);
}

double iso_crossing(const IsoWater *water, const double origin[3], const double direction[3], double from, double to) {
  Path path = path_of(water, origin, direction);
  const double step = STEP * water->spacing / sqrt(dot(direction, direction));
  const double begin = fmax(from, path.begin), end = fmin(to, path.end + step);
  const bool inside = in_water(&path, begin);
  double found = 0;
  for (double t = begin; t < end && found == 0; t += step) {
    const double next = fmin(t + step, end);
    if (in_water(&path, next) != inside) found = bisect(&path, t, next, inside) * (inside ? -1 : 1);
  }
  free(path.sphere);
  return found;
}

// ---- Normals ---------------------------------------------------------------------------------------------------------

bool iso_gradient_normal(const IsoWater *water, const double p[3], double normal[3]) {
  const double big_r = water->reach;
  double gradient[3] = {0};
  for (int32_t i = 0; i < water->count; ++i) {
    const double *sphere = water->sphere + 4 * (size_t)i, r = distance(p, sphere);
    if (r >= big_r || r == 0) continue;
    const double slope = -45 / (PI * pow(big_r, 6)) * pow(big_r - r, 2); // spiky (Müller et al. 2003)
    for (int k = 0; k < 3; ++k) gradient[k] += slope * (p[k] - sphere[k]) / r;
  }
  for (int k = 0; k < 3; ++k) normal[k] = -gradient[k] * pow(big_r, 4); // out of the water, free of the unit
  return normalize(normal);
}

// Eqs. 3 and 4, in units of R². false: there is no particle.
static bool covariance(const IsoWater *water, const double p[3], double c[3][3]) {
  const double big_r = water->reach;
  double sum = 0, mean[3] = {0};
  memset(c, 0, 9 * sizeof(double));
  for (int pass = 0; pass < 2; ++pass) {
    for (int32_t i = 0; i < water->count; ++i) {
      const double *sphere = water->sphere + 4 * (size_t)i, w = 1 - pow(distance(p, sphere) / big_r, 3);
      if (w <= 0) continue;
      for (int a = 0; a < 3; ++a) {
        if (pass == 0) mean[a] += w * sphere[a];
        for (int b = 0; pass == 1 && b < 3; ++b) c[a][b] += w * (sphere[a] - mean[a]) * (sphere[b] - mean[b]);
      }
      if (pass == 0) sum += w;
    }
    for (int a = 0; a < 3 && pass == 0; ++a) mean[a] /= sum;
  }
  for (int k = 0; k < 9; ++k) c[k / 3][k % 3] /= sum * big_r * big_r;
  return sum > 0;
}

// Eigenvalues of a symmetric matrix as the roots of its characteristic polynomial, by angles (Smith, "Eigenvalues of a
// symmetric 3 × 3 matrix", 1961); the least first.
static void eigenvalues(double c[3][3], double value[3]) {
  const double mean = (c[0][0] + c[1][1] + c[2][2]) / 3;
  double b[3][3], squares = 0;
  for (int k = 0; k < 9; ++k) {
    b[k / 3][k % 3] = c[k / 3][k % 3] - (k % 4 == 0 ? mean : 0);
    squares += b[k / 3][k % 3] * b[k / 3][k % 3];
  }
  const double size = sqrt(squares / 6);
  double minor[3];
  cross(minor, b[1], b[2]);
  const double half = size > 0 ? dot(b[0], minor) / (2 * size * size * size) : 0;
  const double angle = acos(fmax(-1, fmin(1, half))) / 3;
  value[2] = mean + 2 * size * cos(angle);
  value[0] = mean + 2 * size * cos(angle + 2 * PI / 3);
  value[1] = 3 * mean - value[0] - value[2];
}

bool iso_pca_normal(const IsoWater *water, const double p[3], double normal[3]) {
  double c[3][3], value[3], basic[3], most = 0;
  if (!iso_gradient_normal(water, p, basic) || !covariance(water, p, c)) return false;
  eigenvalues(c, value);
  if (value[1] - value[0] <= 1e-4 * value[2] || value[2] <= 1e-5) return false;
  // Any two rows of C − λ span what is orthogonal to the axis: of their products, the longest.
  for (int k = 0; k < 3; ++k) c[k][k] -= value[0];
  for (int k = 0; k < 3; ++k) {
    double product[3];
    cross(product, c[k], c[(k + 1) % 3]);
    if (dot(product, product) <= most) continue;
    most = dot(product, product);
    memcpy(normal, product, sizeof product);
  }
  for (int k = 0; k < 3; ++k) normal[k] /= sqrt(most);
  const double sign = dot(normal, basic) < 0 ? -1 : 1;
  for (int k = 0; k < 3; ++k) normal[k] *= sign;
  return true;
}

bool iso_normal(const IsoWater *water, const double p[3], double normal[3]) {
  const RenderRaycast *s = &water->settings;
  double least[3], w = (double)s->blend_weight;
  if (!iso_gradient_normal(water, p, normal)) return false;
  if (s->normals == RENDER_NORMALS_GRADIENT || !iso_pca_normal(water, p, least)) return true;
  if (s->normals == RENDER_NORMALS_PCA)
    w = 1;
  else if (w < 0)
    w = fmin(1, exp((double)s->blend_d * (dot(normal, least) - (double)s->blend_k)));
  for (int k = 0; k < 3; ++k) normal[k] = (1 - w) * normal[k] + w * least[k];
  return normalize(normal);
}

// ---- Colours ---------------------------------------------------------------------------------------------------------

void iso_colour(const IsoWater *water, const double p[3], double colour[3]) {
  double sum = 0, mixed[3] = {0};
  for (int32_t i = 0; i < water->count; ++i) {
    const double w = share(water, water->sphere + 4 * (size_t)i, p);
    for (size_t k = 0; k < 3; ++k) mixed[k] += w * water->colour[3 * (size_t)i + k];
    sum += w;
  }
  for (int k = 0; k < 3; ++k) colour[k] = sum > 0 ? mixed[k] / sum : 0;
}
