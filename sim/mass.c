// Mass properties of solid bodies.
//
// Meshes after Mirtich, Fast and Accurate Computation of Polyhedral Mass Properties, 1996, in the tetrahedral form of
// Tonon, Explicit Exact Formulas for the 3-D Tetrahedron Inertia Tensor, 2004: by the divergence theorem the volume is the
// sum over the triangles (a, b, c) of the signed tetrahedra with the origin, V = a·(b × c)/6, and so are all moments:
//
//   ∫ x dV = V (a + b + c)/4
//   ∫ x_i x_j dV = V/20 (Σ_v v_i Σ_v v_j + Σ_v v_i v_j),   v = a, b, c
//
// Exact for any closed mesh whose triangles point outwards, wherever the origin is.
#include "sim/mass.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

/// Volume, first and second moments about the origin of the body's axes.
typedef struct Moments {
  double volume, first[3];
  double second[6]; ///< ∫ xx, yy, zz, xy, xz, yz dV
} Moments;

static const int pair_of[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

static void add_box(Moments *m, const double centre[3], const double size[3]) {
  double volume = size[0] * size[1] * size[2];
  m->volume += volume;
  for (int k = 0; k < 3; k++) m->first[k] += volume * centre[k];
  for (int p = 0; p < 6; p++) {
    int i = pair_of[p][0], j = pair_of[p][1];
    m->second[p] += volume * (centre[i] * centre[j] + (i == j ? size[i] * size[i] / 12 : 0));
  }
}

static void add_tetrahedron(Moments *m, const float *a, const float *b, const float *c) {
  double v[3][3], sum[3];
  for (int k = 0; k < 3; k++) {
    v[0][k] = (double)a[k], v[1][k] = (double)b[k], v[2][k] = (double)c[k];
    sum[k] = v[0][k] + v[1][k] + v[2][k];
  }
  double volume =
      (v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) + v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
       v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0])) /
      6;
  m->volume += volume;
  for (int k = 0; k < 3; k++) m->first[k] += volume * sum[k] / 4;
  for (int p = 0; p < 6; p++) {
    int i = pair_of[p][0], j = pair_of[p][1];
    double products = sum[i] * sum[j];
    for (int corner = 0; corner < 3; corner++) products += v[corner][i] * v[corner][j];
    m->second[p] += volume * products / 20;
  }
}

// A cylinder along y without its caps.
static void add_cylinder(Moments *m, double radius, double height) {
  double volume = PI * radius * radius * height;
  m->volume += volume;
  m->second[0] += volume * radius * radius / 4;
  m->second[1] += volume * height * height / 12;
  m->second[2] += volume * radius * radius / 4;
}

// Two half balls whose flat sides are `height` apart; the centre of mass of a half ball is 3/8 r from its flat side.
static void add_caps(Moments *m, double radius, double height) {
  double volume = 4 * PI / 3 * radius * radius * radius, own = radius * radius / 5, half = height / 2;
  m->volume += volume;
  m->second[0] += volume * own;
  m->second[1] += volume * (own + half * half + 2 * half * 3 / 8 * radius);
  m->second[2] += volume * own;
}

// Step k is a column from the bottom up to (k + 1)/steps of the height.
static void add_stairs(Moments *m, const SimObstacle *stairs) {
  double length = (double)stairs->size[0], height = (double)stairs->size[1], n = stairs->steps;
  for (int32_t k = 0; k < stairs->steps; k++) {
    const double size[3] = {length / n, height * (k + 1) / n, (double)stairs->size[2]};
    const double centre[3] = {-length / 2 + (k + 0.5) * length / n, (size[1] - height) / 2, 0};
    add_box(m, centre, size);
  }
}

static Moments moments_of(const SimObstacle *o) {
  Moments m = {0};
  double radius = (double)o->size[0] / 2, height = (double)o->size[1];
  switch (o->shape) {
  case SIM_BOX:
    add_box(&m, (const double[3]){0}, (const double[3]){(double)o->size[0], (double)o->size[1], (double)o->size[2]});
    break;
  case SIM_SPHERE:
    add_caps(&m, radius, 0);
    break;
  case SIM_CYLINDER:
    add_cylinder(&m, radius, height);
    break;
  case SIM_CAPSULE:
    add_cylinder(&m, radius, height - 2 * radius);
    add_caps(&m, radius, height - 2 * radius);
    break;
  case SIM_STAIRS:
    add_stairs(&m, o);
    break;
  case SIM_MESH:
    for (int32_t t = 0; t < o->mesh->triangle_count; t++) {
      const int32_t *corner = o->mesh->triangle + 3 * (size_t)t;
      const float *vertex = o->mesh->vertex;
      add_tetrahedron(&m, vertex + 3 * (size_t)corner[0], vertex + 3 * (size_t)corner[1],
                      vertex + 3 * (size_t)corner[2]);
    }
    break;
  }
  return m;
}

SimMass sim_mass_make(const SimObstacle *obstacle, double density) {
  Moments m = moments_of(obstacle);
  SimMass mass = {.mass = density * m.volume};
  if (!(m.volume > 0)) return mass;
  for (int k = 0; k < 3; k++) mass.centre[k] = m.first[k] / m.volume;
  double second[6], trace = 0;
  for (int p = 0; p < 6; p++) {
    int i = pair_of[p][0], j = pair_of[p][1];
    second[p] = density * (m.second[p] - m.volume * mass.centre[i] * mass.centre[j]);
    if (i == j) trace += second[p];
  }
  for (int p = 0; p < 6; p++) mass.inertia[p] = p < 3 ? trace - second[p] : -second[p];
  return mass;
}
