// Distances and paths to a closed triangle mesh.
//
// The triangles are sorted along a Morton curve (Morton, A Computer Oriented Geodetic Data Base, 1966) through their
// centres, and a complete binary tree of boxes is put over them, in the manner of Lauterbach et al., Fast BVH
// Construction on GPUs, 2009, but with its cuts in the middle of the sorted row: then it needs no pointers.
//
// Sign: Bærentzen and Aanæs, Signed Distance Computation Using the Angle Weighted Pseudonormal, 2005. The nearest
// surface point lies on a face, an edge or a vertex. The point is inside where its offset from there points against the
// normal of that feature: the triangle's, the sum of the two at the edge, the sum weighted by angles around the vertex.
// This is exact for a closed mesh that does not cut itself. Where two parts of a mesh overlap, the nearer sheet
// decides, so the walls inside the other part count as walls.
#include "sim/mesh_tree.h"

#include <math.h>
#include <string.h>

#include "sim/memory.h"
#include "sim/mesh_topology.h"
#include "sim/wall.h"

// Most triangles of a leaf.
#define LEAF 4
#define STACK 64
#define MORTON_BITS 10

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double c[3]) {
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

// ---- Construction ----------------------------------------------------------------------------------------------------

static uint32_t spread_bits(uint32_t x) {
  x = (x | (x << 16)) & 0x030000ffu;
  x = (x | (x << 8)) & 0x0300f00fu;
  x = (x | (x << 4)) & 0x030c30c3u;
  return (x | (x << 2)) & 0x09249249u;
}

static void morton_codes(const SimMesh *mesh, uint32_t *code) {
  float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (int32_t n = 0; n < 3 * mesh->triangle_count; n++) // vertices that no triangle uses do not count
    for (int k = 0; k < 3; k++) {
      low[k] = sim_smaller(low[k], mesh->vertex[3 * mesh->triangle[n] + k]);
      high[k] = sim_larger(high[k], mesh->vertex[3 * mesh->triangle[n] + k]);
    }
  float size = sim_larger(sim_larger(high[0] - low[0], high[1] - low[1]), high[2] - low[2]);
  for (int32_t t = 0; t < mesh->triangle_count; t++) {
    code[t] = 0;
    for (int k = 0; k < 3; k++) {
      float centre = 0;
      for (int j = 0; j < 3; j++) centre += (mesh->vertex[3 * mesh->triangle[3 * t + j] + k] - low[k]) / 3;
      float cell = centre / size * (1 << MORTON_BITS);
      uint32_t whole = cell < (1 << MORTON_BITS) - 1 ? (uint32_t)cell : (1 << MORTON_BITS) - 1;
      code[t] |= spread_bits(whole) << k;
    }
  }
}

// Stable radix sort of 0 … count − 1 by code, ten bits a time.
static bool sort_by_code(const uint32_t *code, int32_t count, int32_t *order) {
  int32_t *other = sim_allocate((size_t)count * sizeof *other);
  if (!other) return false;
  for (int32_t n = 0; n < count; n++) other[n] = n;
  int32_t *from = other, *to = order;
  for (int shift = 0; shift < 3 * MORTON_BITS; shift += MORTON_BITS) {
    int32_t start[(1 << MORTON_BITS) + 1] = {0};
    for (int32_t n = 0; n < count; n++) start[((code[n] >> shift) & ((1 << MORTON_BITS) - 1)) + 1]++;
    for (int32_t d = 0; d < 1 << MORTON_BITS; d++) start[d + 1] += start[d];
    for (int32_t n = 0; n < count; n++) to[start[(code[from[n]] >> shift) & ((1 << MORTON_BITS) - 1)]++] = from[n];
    int32_t *t = from;
    from = to;
    to = t;
  }
  if (from != order) memcpy(order, from, (size_t)count * sizeof *order);
  sim_release(other);
  return true;
}

static void corners_of(const SimMesh *mesh, int32_t t, double corner[3][3]) {
  for (int j = 0; j < 3; j++)
    for (int k = 0; k < 3; k++) corner[j][k] = (double)mesh->vertex[3 * mesh->triangle[3 * t + j] + k];
}

static void make_normals(SimMeshTree *tree, const SimMesh *mesh) {
  for (int32_t t = 0; t < mesh->triangle_count; t++) {
    double c[3][3], edge[3][3], n[3];
    corners_of(mesh, t, c);
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++) edge[j][k] = c[(j + 1) % 3][k] - c[j][k];
    cross(edge[0], edge[1], n);
    double length = sqrt(dot(n, n));
    if (!(length > 0)) continue;
    for (int k = 0; k < 3; k++) tree->normal[t][k] = (float)(n[k] / length);
    for (int j = 0; j < 3; j++) {
      const double *a = edge[j], *b = edge[(j + 2) % 3]; // leaving and reaching corner j
      double side[3];
      cross(a, b, side);
      double angle = atan2(sqrt(dot(side, side)), -dot(a, b));
      float *sum = tree->vertex_normal[mesh->triangle[3 * t + j]];
      for (int k = 0; k < 3; k++) sum[k] += (float)(angle * n[k] / length);
    }
  }
}

static void merge(float box[6], const float other[6]) {
  for (int k = 0; k < 3; k++) {
    box[k] = sim_smaller(box[k], other[k]);
    box[3 + k] = sim_larger(box[3 + k], other[3 + k]);
  }
}

static void range_of(const SimMeshTree *tree, int32_t leaf, int32_t *begin, int32_t *end) {
  *begin = (int32_t)((int64_t)leaf * tree->triangle_count / tree->leaves);
  *end = (int32_t)((int64_t)(leaf + 1) * tree->triangle_count / tree->leaves);
}

static void make_boxes(SimMeshTree *tree) {
  const float empty[6] = {INFINITY, INFINITY, INFINITY, -INFINITY, -INFINITY, -INFINITY};
  for (int32_t node = 2 * tree->leaves - 2; node >= 0; node--) {
    float *box = tree->box[node];
    memcpy(box, empty, sizeof empty);
    if (node < tree->leaves - 1) {
      merge(box, tree->box[2 * node + 1]);
      merge(box, tree->box[2 * node + 2]);
      continue;
    }
    int32_t begin, end;
    range_of(tree, node - (tree->leaves - 1), &begin, &end);
    for (int32_t n = begin; n < end; n++)
      for (int j = 0; j < 3; j++) {
        const float *c = tree->corner[n] + 3 * j;
        merge(box, (const float[6]){c[0], c[1], c[2], c[0], c[1], c[2]});
      }
  }
}

bool sim_mesh_tree_make(SimMeshTree *tree, const SimMesh *mesh) {
  size_t n = (size_t)mesh->triangle_count;
  *tree = (SimMeshTree){.triangle_count = mesh->triangle_count, .leaves = 1};
  while (tree->leaves * LEAF < mesh->triangle_count) tree->leaves *= 2;
  uint32_t *code = sim_allocate(n * sizeof *code);
  int32_t edge[2];
  bool made = code && (tree->order = sim_allocate(n * sizeof *tree->order)) &&
              (tree->corner = sim_allocate(n * sizeof *tree->corner)) &&
              (tree->normal = sim_allocate(n * sizeof *tree->normal)) &&
              (tree->vertex_normal = sim_allocate((size_t)mesh->vertex_count * sizeof *tree->vertex_normal)) &&
              (tree->triangle = sim_allocate(3 * n * sizeof *tree->triangle)) &&
              (tree->neighbour = sim_allocate(3 * n * sizeof *tree->neighbour)) &&
              (tree->box = sim_allocate((2 * (size_t)tree->leaves - 1) * sizeof *tree->box));
  if (made) {
    memcpy(tree->triangle, mesh->triangle, 3 * n * sizeof *tree->triangle);
    morton_codes(mesh, code);
    made = sim_mesh_neighbours(mesh, tree->neighbour, edge) == SIM_MESH_CLOSED &&
           sort_by_code(code, mesh->triangle_count, tree->order);
  }
  sim_release(code);
  if (!made) return false;
  for (int32_t t = 0; t < mesh->triangle_count; t++)
    for (int j = 0; j < 3; j++)
      memcpy(tree->corner[t] + 3 * j, mesh->vertex + 3 * mesh->triangle[3 * tree->order[t] + j], 3 * sizeof(float));
  make_normals(tree, mesh);
  make_boxes(tree);
  return true;
}

void sim_mesh_tree_free(SimMeshTree *tree) {
  sim_release(tree->order);
  sim_release(tree->corner);
  sim_release(tree->normal);
  sim_release(tree->vertex_normal);
  sim_release(tree->triangle);
  sim_release(tree->neighbour);
  sim_release(tree->box);
  *tree = (SimMeshTree){0};
}

// ---- The nearest point -----------------------------------------------------------------------------------------------

// Part of a triangle: corner 0, 1, 2; edge 3, 4, 5 from corner 0, 1, 2 to the next; the face.
enum { EDGE = 3, FACE = 6 };

typedef struct Nearest {
  double squared;
  int32_t place; ///< in order
  int part;
  double offset[3]; ///< m, from the nearest point to the query
} Nearest;

static void keep_nearer(Nearest *nearest, int32_t place, int part, const double offset[3]) {
  double squared = dot(offset, offset);
  if (!(squared < nearest->squared)) return;
  *nearest = (Nearest){squared, place, part, {offset[0], offset[1], offset[2]}};
}

static void try_edge(Nearest *nearest, int32_t place, int j, const double a[3], const double b[3], const double p[3]) {
  double ab[3], ap[3], offset[3];
  for (int k = 0; k < 3; k++) ab[k] = b[k] - a[k], ap[k] = p[k] - a[k];
  double along = dot(ab, ap), length = dot(ab, ab);
  int part = along <= 0 ? j : along >= length ? (j + 1) % 3 : EDGE + j;
  double t = along <= 0 ? 0 : along >= length ? 1 : along / length;
  for (int k = 0; k < 3; k++) offset[k] = ap[k] - t * ab[k];
  keep_nearer(nearest, place, part, offset);
}

// The foot of the perpendicular if it lies in the triangle, else the nearest point of the three edges.
static void try_triangle(const SimMeshTree *tree, int32_t place, const double p[3], Nearest *nearest) {
  double c[3][3], ab[3], ac[3], ap[3], n[3], t[3];
  for (int j = 0; j < 3; j++)
    for (int k = 0; k < 3; k++) c[j][k] = (double)tree->corner[place][3 * j + k];
  for (int k = 0; k < 3; k++) ab[k] = c[1][k] - c[0][k], ac[k] = c[2][k] - c[0][k], ap[k] = p[k] - c[0][k];
  cross(ab, ac, n);
  double area2 = dot(n, n), above = dot(ap, n);
  if (above * above > nearest->squared * area2) return; // its plane is too far away already
  cross(ap, ac, t);
  double v = dot(t, n);
  cross(ab, ap, t);
  double w = dot(t, n);
  if (v >= 0 && w >= 0 && v + w <= area2 && area2 > 0) {
    double height = above / area2, offset[3];
    for (int k = 0; k < 3; k++) offset[k] = height * n[k];
    keep_nearer(nearest, place, FACE, offset);
    return;
  }
  for (int j = 0; j < 3; j++) try_edge(nearest, place, j, c[j], c[(j + 1) % 3], p);
}

static float box_distance2(const float box[6], const float p[3]) {
  float sum = 0;
  for (int k = 0; k < 3; k++) {
    float outside = sim_larger(0, sim_larger(box[k] - p[k], p[k] - box[3 + k]));
    sum += outside * outside;
  }
  return sum;
}

static void search(const SimMeshTree *tree, const float point[3], const double p[3], Nearest *nearest) {
  int32_t stack[STACK], depth = 0;
  float distance[STACK];
  stack[depth] = 0, distance[depth++] = 0;
  while (depth > 0) {
    int32_t node = stack[--depth];
    // A box is rounded by less than this share; better one box too many than the nearest one missed.
    if ((double)distance[depth] * (1 - 1e-5) >= nearest->squared) continue;
    if (node >= tree->leaves - 1) {
      int32_t begin, end;
      range_of(tree, node - (tree->leaves - 1), &begin, &end);
      for (int32_t n = begin; n < end; n++) try_triangle(tree, n, p, nearest);
      continue;
    }
    int32_t left = 2 * node + 1, right = left + 1;
    float a = box_distance2(tree->box[left], point), b = box_distance2(tree->box[right], point);
    bool left_first = a <= b;
    stack[depth] = left_first ? right : left, distance[depth++] = left_first ? b : a;
    stack[depth] = left_first ? left : right, distance[depth++] = left_first ? a : b;
  }
}

static void pseudonormal(const SimMeshTree *tree, const Nearest *nearest, double normal[3]) {
  int32_t t = tree->order[nearest->place];
  const float *n = tree->normal[t], *other = NULL;
  if (nearest->part < EDGE)
    n = tree->vertex_normal[tree->triangle[3 * t + nearest->part]];
  else if (nearest->part < FACE)
    other = tree->normal[tree->neighbour[3 * t + nearest->part - EDGE]];
  for (int k = 0; k < 3; k++) normal[k] = (double)n[k] + (other ? (double)other[k] : 0);
}

float sim_mesh_tree_distance(const SimMeshTree *tree, const float point[3], int32_t *hint, float normal[3]) {
  Nearest nearest = {.squared = INFINITY};
  const double p[3] = {(double)point[0], (double)point[1], (double)point[2]};
  try_triangle(tree, *hint, p, &nearest);
  search(tree, point, p, &nearest);
  *hint = nearest.place;
  double n[3], distance = sqrt(nearest.squared);
  pseudonormal(tree, &nearest, n);
  bool inside = dot(nearest.offset, n) < 0;
  // On the surface itself the offset has no direction; its own normal has.
  bool on_surface = distance < 1e-9;
  double length = on_surface ? sqrt(dot(n, n)) : inside ? -distance : distance;
  for (int k = 0; k < 3; k++)
    normal[k] = length == 0 ? k == 1 : (float)((on_surface ? n[k] : nearest.offset[k]) / length);
  return (float)(inside ? -distance : distance);
}

// ---- The first triangle on a path ------------------------------------------------------------------------------------

// Whether the segment from + t·way, t in [0, most], passes the box widened by `slack`.
static bool meets_box(const float box[6], const double from[3], const double inverse[3], double most, double slack) {
  double begin = 0, end = most;
  for (int k = 0; k < 3; k++) {
    double a = ((double)box[k] - slack - from[k]) * inverse[k], b = ((double)box[3 + k] + slack - from[k]) * inverse[k];
    double enter = a < b ? a : b, leave = a < b ? b : a;
    if (enter > begin) begin = enter;
    if (leave < end) end = leave;
  }
  return begin <= end;
}

// After Möller and Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, 1997. Triangles are taken a little larger
// than they are, so that no path slips through between two of them.
static bool enters(const SimMeshTree *tree, int32_t place, const double from[3], const double way[3], double *t) {
  const double margin = 1e-6;
  double a[3], ab[3], ac[3], s[3], h[3], q[3];
  const float *c = tree->corner[place];
  for (int k = 0; k < 3; k++) {
    a[k] = (double)c[k];
    ab[k] = (double)c[3 + k] - a[k];
    ac[k] = (double)c[6 + k] - a[k];
    s[k] = from[k] - a[k];
  }
  cross(way, ac, h);
  double det = dot(ab, h); // positive where the path runs against the normal
  if (!(det > 0)) return false;
  double u = dot(s, h) / det;
  if (u < -margin || u > 1 + margin) return false;
  cross(s, ab, q);
  double v = dot(way, q) / det;
  if (v < -margin || u + v > 1 + margin) return false;
  double at = dot(ac, q) / det;
  if (!(at >= 0 && at <= *t)) return false;
  *t = at;
  return true;
}

bool sim_mesh_tree_hit(const SimMeshTree *tree, const float from[3], const float to[3], float *t, float normal[3]) {
  double p[3], way[3], inverse[3], nearest = 1;
  for (int k = 0; k < 3; k++) {
    p[k] = (double)from[k];
    way[k] = (double)to[k] - p[k];
    inverse[k] = 1 / (fabs(way[k]) > 1e-30 ? way[k] : 1e-30);
  }
  const float *all = tree->box[0];
  double slack = 1e-6 * fmax(fmax((double)(all[3] - all[0]), (double)(all[4] - all[1])), (double)(all[5] - all[2]));
  int32_t stack[STACK], depth = 0, found = -1;
  stack[depth++] = 0;
  while (depth > 0) {
    int32_t node = stack[--depth];
    if (!meets_box(tree->box[node], p, inverse, nearest, slack)) continue;
    if (node < tree->leaves - 1) {
      stack[depth++] = 2 * node + 2;
      stack[depth++] = 2 * node + 1;
      continue;
    }
    int32_t begin, end;
    range_of(tree, node - (tree->leaves - 1), &begin, &end);
    for (int32_t n = begin; n < end; n++)
      if (enters(tree, n, p, way, &nearest)) found = n;
  }
  if (found < 0) return false;
  *t = (float)nearest;
  memcpy(normal, tree->normal[tree->order[found]], 3 * sizeof(float));
  return true;
}
