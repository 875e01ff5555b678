#include "meshes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static TestMesh make(int32_t vertices, int32_t triangles) {
  TestMesh mesh = {malloc((size_t)vertices * 3 * sizeof(float)), malloc((size_t)triangles * 3 * sizeof(int32_t)), {0}};
  if (!mesh.vertex || !mesh.triangle) abort();
  mesh.view = (SimMesh){0, 0, mesh.vertex, mesh.triangle};
  return mesh;
}

static int32_t add_vertex(TestMesh *mesh, float x, float y, float z) {
  float *v = mesh->vertex + 3 * mesh->view.vertex_count;
  v[0] = x, v[1] = y, v[2] = z;
  return mesh->view.vertex_count++;
}

static void add_triangle(TestMesh *mesh, int32_t a, int32_t b, int32_t c) {
  int32_t *t = mesh->triangle + 3 * mesh->view.triangle_count++;
  t[0] = a, t[1] = b, t[2] = c;
}

static void add_quad(TestMesh *mesh, int32_t a, int32_t b, int32_t c, int32_t d) {
  add_triangle(mesh, a, b, c);
  add_triangle(mesh, a, c, d);
}

void test_mesh_free(TestMesh *mesh) {
  free(mesh->vertex);
  free(mesh->triangle);
}

TestMesh test_mesh_tetrahedron(float size) {
  TestMesh mesh = make(4, 4);
  for (int k = 0; k < 4; k++)
    add_vertex(&mesh, k & 1 ? size : -size, k & 2 ? size : -size, (k == 0 || k == 3) ? -size : size);
  add_triangle(&mesh, 0, 1, 2);
  add_triangle(&mesh, 0, 3, 1);
  add_triangle(&mesh, 0, 2, 3);
  add_triangle(&mesh, 1, 3, 2);
  return mesh;
}

TestMesh test_mesh_box(const float half[3]) {
  return test_mesh_stairs(half, 1);
}

// Per edge k of the profile three points: on the floor, where the riser begins, where it ends; each in front (z < 0) and
// behind.
TestMesh test_mesh_stairs(const float half[3], int32_t steps) {
  TestMesh mesh = make(6 * (steps + 1), 12 * steps + 12);
  int32_t(*foot)[2] = malloc(sizeof *foot * (size_t)(steps + 1)), (*low)[2] = malloc(sizeof *low * (size_t)(steps + 1)),
  (*high)[2] = malloc(sizeof *high * (size_t)(steps + 1));
  if (!foot || !low || !high) abort();
  for (int32_t k = 0; k <= steps; k++)
    for (int side = 0; side < 2; side++) {
      float z = side ? half[2] : -half[2], x = -half[0] + 2 * half[0] * (float)k / (float)steps;
      foot[k][side] = add_vertex(&mesh, x, -half[1], z);
      low[k][side] = k == 0 ? foot[k][side] : add_vertex(&mesh, x, -half[1] + 2 * half[1] * (float)k / (float)steps, z);
      high[k][side] =
          k == steps ? low[k][side] : add_vertex(&mesh, x, -half[1] + 2 * half[1] * (float)(k + 1) / (float)steps, z);
    }
  for (int32_t k = 0; k < steps; k++) {
    for (int side = 0; side < 2; side++) {
      const int32_t corner[5] = {foot[k + 1][side], low[k + 1][side], high[k][side], low[k][side], foot[k][side]};
      for (int n = 1; n < (k == 0 ? 3 : 4); n++) // on the first step, riser and floor begin in one point
        if (side)
          add_triangle(&mesh, corner[0], corner[n], corner[n + 1]);
        else
          add_triangle(&mesh, corner[0], corner[n + 1], corner[n]);
    }
    add_quad(&mesh, foot[k][0], foot[k + 1][0], foot[k + 1][1], foot[k][1]); // underside
    add_quad(&mesh, low[k][0], low[k][1], high[k][1], high[k][0]);           // riser
    add_quad(&mesh, high[k][0], high[k][1], low[k + 1][1], low[k + 1][0]);   // tread
  }
  add_quad(&mesh, foot[steps][0], low[steps][0], low[steps][1], foot[steps][1]); // back
  free(foot);
  free(low);
  free(high);
  return mesh;
}

static void add_part_of_ball(TestMesh *mesh, int32_t a, int32_t b, int32_t c, float radius, int rounds, int32_t *middle,
                             int32_t most) {
  if (rounds == 0) {
    add_triangle(mesh, a, b, c);
    return;
  }
  const int32_t corner[3] = {a, b, c};
  int32_t m[3];
  for (int j = 0; j < 3; j++) {
    // The middle of an edge is made once: it is remembered under the numbers of both ends.
    int32_t p = corner[j], q = corner[(j + 1) % 3],
            *known = &middle[(size_t)(p < q ? p : q) * (size_t)most + (p < q ? q : p)];
    if (*known == 0) {
      const float *v = mesh->vertex + 3 * p, *w = mesh->vertex + 3 * q;
      float x = v[0] + w[0], y = v[1] + w[1], z = v[2] + w[2], length = sqrtf(x * x + y * y + z * z) / radius;
      *known = add_vertex(mesh, x / length, y / length, z / length);
    }
    m[j] = *known;
  }
  add_part_of_ball(mesh, a, m[0], m[2], radius, rounds - 1, middle, most);
  add_part_of_ball(mesh, m[0], b, m[1], radius, rounds - 1, middle, most);
  add_part_of_ball(mesh, m[2], m[1], c, radius, rounds - 1, middle, most);
  add_part_of_ball(mesh, m[0], m[1], m[2], radius, rounds - 1, middle, most);
}

TestMesh test_mesh_ball(float radius, int rounds) {
  int32_t triangles = 8 << (2 * rounds), vertices = triangles / 2 + 2;
  TestMesh mesh = make(vertices, triangles);
  int32_t *middle = calloc((size_t)vertices * (size_t)vertices, sizeof *middle);
  if (!middle) abort();
  for (int k = 0; k < 6; k++) {
    float v[3] = {0, 0, 0};
    v[k / 2] = k % 2 ? radius : -radius;
    add_vertex(&mesh, v[0], v[1], v[2]);
  }
  for (int k = 0; k < 8; k++) {
    int32_t x = k & 1, y = 2 + (k >> 1 & 1), z = 4 + (k >> 2 & 1);
    bool odd = ((k & 1) + (k >> 1 & 1) + (k >> 2 & 1)) % 2 != 0;
    if (odd)
      add_part_of_ball(&mesh, x, y, z, radius, rounds, middle, vertices);
    else
      add_part_of_ball(&mesh, x, z, y, radius, rounds, middle, vertices);
  }
  free(middle);
  return mesh;
}

TestMesh test_mesh_ring(float large, float small, int around, int along) {
  TestMesh mesh = make(around * along, 2 * around * along);
  const float turn = 6.2831853f;
  for (int i = 0; i < along; i++)
    for (int j = 0; j < around; j++) {
      float a = turn * (float)i / (float)along, b = turn * (float)j / (float)around, r = large + small * cosf(b);
      add_vertex(&mesh, r * cosf(a), small * sinf(b), r * sinf(a));
    }
  for (int i = 0; i < along; i++)
    for (int j = 0; j < around; j++) {
      int next = (i + 1) % along * around, here = i * around, up = (j + 1) % around;
      add_quad(&mesh, here + j, here + up, next + up, next + j);
    }
  return mesh;
}

// ---- Slow twins ------------------------------------------------------------------------------------------------------

static double segment_distance(const double a[3], const double b[3], const double p[3]) {
  double along = 0, length = 0, sum = 0;
  for (int k = 0; k < 3; k++) along += (p[k] - a[k]) * (b[k] - a[k]), length += (b[k] - a[k]) * (b[k] - a[k]);
  double t = length > 0 ? fmin(fmax(along / length, 0), 1) : 0;
  for (int k = 0; k < 3; k++) sum += pow(p[k] - a[k] - t * (b[k] - a[k]), 2);
  return sqrt(sum);
}

// Where the gradient of |a + u ab + v ac − p|² is zero, or on an edge.
static double triangle_distance(double c[3][3], const double p[3]) {
  double e[3][3] = {{0}}, m[3] = {0}, r[2] = {0}, best = INFINITY, sum = 0;
  for (int k = 0; k < 3; k++) {
    e[0][k] = c[1][k] - c[0][k], e[1][k] = c[2][k] - c[0][k], e[2][k] = p[k] - c[0][k];
    m[0] += e[0][k] * e[0][k], m[1] += e[0][k] * e[1][k], m[2] += e[1][k] * e[1][k];
    r[0] += e[0][k] * e[2][k], r[1] += e[1][k] * e[2][k];
  }
  double det = m[0] * m[2] - m[1] * m[1], u = (r[0] * m[2] - r[1] * m[1]) / det, v = (r[1] * m[0] - r[0] * m[1]) / det;
  if (det > 0 && u >= 0 && v >= 0 && u + v <= 1) {
    for (int k = 0; k < 3; k++) sum += pow(e[2][k] - u * e[0][k] - v * e[1][k], 2);
    return sqrt(sum);
  }
  for (int j = 0; j < 3; j++) best = fmin(best, segment_distance(c[j], c[(j + 1) % 3], p));
  return best;
}

static void corners(const SimMesh *mesh, int32_t t, double c[3][3]) {
  for (int j = 0; j < 3; j++)
    for (int k = 0; k < 3; k++) c[j][k] = (double)mesh->vertex[3 * mesh->triangle[3 * t + j] + k];
}

double reference_mesh_distance(const SimMesh *mesh, const double point[3]) {
  double best = INFINITY, c[3][3];
  for (int32_t t = 0; t < mesh->triangle_count; t++) {
    corners(mesh, t, c);
    best = fmin(best, triangle_distance(c, point));
  }
  return best;
}

bool reference_mesh_inside(const SimMesh *mesh, const double point[3]) {
  double sum = 0, c[3][3];
  for (int32_t t = 0; t < mesh->triangle_count; t++) {
    double l[3], d[3] = {0, 0, 0};
    corners(mesh, t, c);
    for (int j = 0; j < 3; j++) {
      for (int k = 0; k < 3; k++) c[j][k] -= point[k];
      l[j] = sqrt(c[j][0] * c[j][0] + c[j][1] * c[j][1] + c[j][2] * c[j][2]);
    }
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++) d[j] += c[j][k] * c[(j + 1) % 3][k];
    double volume = c[0][0] * (c[1][1] * c[2][2] - c[1][2] * c[2][1]) +
                    c[0][1] * (c[1][2] * c[2][0] - c[1][0] * c[2][2]) +
                    c[0][2] * (c[1][0] * c[2][1] - c[1][1] * c[2][0]);
    sum += 2 * atan2(volume, l[0] * l[1] * l[2] + d[0] * l[2] + d[1] * l[0] + d[2] * l[1]);
  }
  return sum > 6.2831853;
}
