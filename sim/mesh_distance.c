// A mesh on a grid.
//
// Distance: from the triangles at every node near the surface (mesh_tree.h), looked up trilinearly. Close to the
// surface, where edges and sheets thinner than a cell would be lost between nodes, the tree is asked instead, so a mesh
// never leaks, however coarse the grid had to become. Far from it, where the share has come to 0 or 1, nodes hold a
// bound: walking along a row, a distance D says that the next nodes are at least D − cell, D − 2 cells … away, so none
// of them is asked until the bound comes down to the band.
//
// Share of the density sum: the convolution of the solid with the kernel, as in Koschier and Bender, Density Maps for
// Improved SPH Boundary Handling, 2017. The kernel nearly factors (wall.h), so it is done along one axis after the
// other: a node's cell that is filled to the part o adds o times a product of slabs, as sim_body_solid has it for a
// box. The part o comes from the distances at the centres of the cell's eight parts, each a ramp as wide as the part. A
// sheet of no thickness counts as an eighth of a cell.
//
// Limits: a cell is a quarter of a spacing unless the grid would have more than NODES nodes, at 8 bytes each; a mesh
// longer than about 35 spacings in all three directions gets coarser cells, and features smaller than a cell then count
// in the mean only.
#include "sim/mesh_distance.h"

#include <math.h>
#include <string.h>

#include "sim/memory.h"
#include "sim/parallel.h"

#define NODES 4000000.0
#define CELLS_PER_SPACING 4
// Taps of the convolution on one side; coarser cells need fewer.
#define TAPS 16

static size_t node_count(const SimMeshDistance *field) {
  return (size_t)field->size[0] * (size_t)field->size[1] * (size_t)field->size[2];
}

static void node_position(const SimMeshDistance *field, int32_t x, int32_t y, int32_t z, float point[3]) {
  const int32_t node[3] = {x, y, z};
  for (int k = 0; k < 3; k++) point[k] = field->origin[k] + field->cell * (float)node[k];
}

static size_t node_index(const SimMeshDistance *field, int32_t x, int32_t y, int32_t z) {
  return ((size_t)z * (size_t)field->size[1] + (size_t)y) * (size_t)field->size[0] + (size_t)x;
}

// ---- Construction ----------------------------------------------------------------------------------------------------

// The finest grid that is allowed, reaching two cells farther than the share does.
static void choose_grid(SimMeshDistance *field, const SimWall *wall) {
  double cell = (double)wall->spacing / CELLS_PER_SPACING, nodes;
  for (;; cell *= 1.05) {
    nodes = 1;
    for (int k = 0; k < 3; k++) {
      double length = (double)field->high[k] - (double)field->low[k] + 2 * (double)wall->reach;
      nodes *= ceil(length / cell) + 5;
    }
    if (nodes <= NODES) break;
  }
  field->cell = (float)cell;
  field->inverse_cell = (float)(1 / cell);
  for (int k = 0; k < 3; k++) {
    double length = (double)field->high[k] - (double)field->low[k] + 2 * (double)wall->reach;
    field->size[k] = (int32_t)ceil(length / cell) + 5;
    field->origin[k] =
        (float)(0.5 * ((double)field->low[k] + (double)field->high[k]) - 0.5 * cell * (field->size[k] - 1));
  }
}

static void distance_kernel(int32_t begin, int32_t end, const void *context) {
  const SimMeshDistance *field = context;
  for (int32_t z = begin; z < end; z++) {
    int32_t hint = 0;
    float last = 0;
    for (int32_t y = 0; y < field->size[1]; y++)
      for (int32_t n = 0; n < field->size[0]; n++) {
        // There and back again, so that the next node is always beside the last one.
        int32_t x = y % 2 ? field->size[0] - 1 - n : n;
        float point[3], normal[3], bound = fabsf(last) - 1.0001f * field->cell;
        if (bound > field->band)
          last = copysignf(bound, last);
        else {
          node_position(field, x, y, z, point);
          last = sim_mesh_tree_distance(&field->tree, point, &hint, normal);
        }
        field->distance[node_index(field, x, y, z)] = last;
      }
  }
}

// How much of a node's cell is solid.
static float filled(const SimMeshDistance *field, int32_t x, int32_t y, int32_t z, int32_t *hint) {
  float distance = field->distance[node_index(field, x, y, z)], part = field->cell / 2, sum = 0;
  if (fabsf(distance) > 0.87f * field->cell + part) return distance < 0;
  float centre[3], normal[3];
  node_position(field, x, y, z, centre);
  for (int n = 0; n < 8; n++) {
    const float point[3] = {centre[0] + (n & 1 ? part : -part) / 2, centre[1] + (n & 2 ? part : -part) / 2,
                            centre[2] + (n & 4 ? part : -part) / 2};
    float ramp = 0.5f - sim_mesh_tree_distance(&field->tree, point, hint, normal) / part;
    sum += ramp < 0 ? 0 : ramp > 1 ? 1 : ramp;
  }
  return sum / 8;
}

static void filled_kernel(int32_t begin, int32_t end, const void *context) {
  const SimMeshDistance *field = context;
  for (int32_t z = begin; z < end; z++) {
    int32_t hint = 0;
    for (int32_t y = 0; y < field->size[1]; y++)
      for (int32_t x = 0; x < field->size[0]; x++)
        field->share[node_index(field, x, y, z)] = filled(field, x, y, z, &hint);
  }
}

typedef struct Convolution {
  const SimMeshDistance *field;
  const float *from;
  float *to;
  int axis;
  int32_t taps;           ///< on one side
  float weight[TAPS + 1]; ///< of the cells 0, ±1, ±2 …
} Convolution;

// Beyond the grid there is nothing solid: it reaches farther than the kernel.
static void convolve_kernel(int32_t begin, int32_t end, const void *context) {
  const Convolution *c = context;
  const int32_t *size = c->field->size;
  const size_t stride[3] = {1, (size_t)size[0], (size_t)size[0] * (size_t)size[1]};
  for (int32_t z = begin; z < end; z++)
    for (int32_t y = 0; y < size[1]; y++)
      for (int32_t x = 0; x < size[0]; x++) {
        const int32_t at[3] = {x, y, z};
        size_t node = node_index(c->field, x, y, z);
        int32_t here = at[c->axis], last = size[c->axis] - 1;
        float sum = c->weight[0] * c->from[node];
        for (int32_t n = 1; n <= c->taps; n++) {
          float below = here >= n ? c->from[node - (size_t)n * stride[c->axis]] : 0;
          float above = here + n <= last ? c->from[node + (size_t)n * stride[c->axis]] : 0;
          sum += c->weight[n] * (below + above);
        }
        c->to[node] = sum;
      }
}

// Slabs as thick as a cell, n cells away. Cells filled in part, the same all over, and the interpolation between nodes
// blur the share, on the average by as much as a variance of (1 + 1 + 2)/12 cells² along each axis; so much less is the
// kernel's, w − δ²w/6. The weights still add up to one.
static void convolution_weights(Convolution *c, const SimWall *wall, float cell) {
  float slope, slab[TAPS + 2], sum = 0;
  for (int32_t n = 0; n <= TAPS + 1; n++) slab[n] = sim_wall_slab(wall, (float)n * cell, cell / 2, &slope);
  for (int32_t n = 0; n <= TAPS; n++) {
    c->weight[n] = sim_larger(0, slab[n] - (slab[n + 1] - 2 * slab[n] + slab[n > 0 ? n - 1 : 1]) / 6);
    sum += n > 0 ? 2 * c->weight[n] : c->weight[n];
    if (c->weight[n] > 0) c->taps = n;
  }
  for (int32_t n = 0; n <= TAPS; n++) c->weight[n] /= sum;
}

static bool make_share(SimMeshDistance *field, const SimWall *wall, int32_t threads) {
  float *other = sim_allocate(node_count(field) * sizeof *other);
  if (!other) return false;
  sim_parallel_tasks(threads, field->size[2], filled_kernel, field);
  Convolution c = {.field = field, .from = field->share, .to = other};
  convolution_weights(&c, wall, field->cell);
  for (c.axis = 0; c.axis < 3; c.axis++) {
    sim_parallel_tasks(threads, field->size[2], convolve_kernel, &c);
    c.to = c.axis == 0 ? field->share : other;
    c.from = c.axis == 0 ? other : field->share;
  }
  sim_release(field->share); // three passes: the last one wrote to `other`
  field->share = other;
  return true;
}

static bool copy_mesh(SimMesh *copy, const SimMesh *mesh) {
  size_t vertices = 3 * (size_t)mesh->vertex_count, corners = 3 * (size_t)mesh->triangle_count;
  float *vertex = sim_allocate(vertices * sizeof *vertex);
  int32_t *triangle = sim_allocate(corners * sizeof *triangle);
  *copy = (SimMesh){mesh->vertex_count, mesh->triangle_count, vertex, triangle};
  if (!vertex || !triangle) return false;
  memcpy(vertex, mesh->vertex, vertices * sizeof *vertex);
  memcpy(triangle, mesh->triangle, corners * sizeof *triangle);
  return true;
}

static float farthest_corner(const SimMesh *mesh) {
  float most = 0;
  for (int32_t n = 0; n < 3 * mesh->triangle_count; n++) {
    const float *v = mesh->vertex + 3 * mesh->triangle[n];
    most = sim_larger(most, v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  }
  return sqrtf(most) * 1.00001f;
}

static bool make(SimMeshDistance *field, const SimMesh *mesh, const SimWall *wall, int32_t threads) {
  if (!copy_mesh(&field->mesh, mesh) || !sim_mesh_tree_make(&field->tree, &field->mesh)) return false;
  for (int k = 0; k < 3; k++) field->low[k] = field->tree.box[0][k], field->high[k] = field->tree.box[0][3 + k];
  field->bound = farthest_corner(&field->mesh);
  choose_grid(field, wall);
  field->band = wall->reach + 4 * field->cell;
  field->distance = sim_allocate(node_count(field) * sizeof *field->distance);
  field->share = sim_allocate(node_count(field) * sizeof *field->share);
  if (!field->distance || !field->share) return false;
  sim_parallel_tasks(threads, field->size[2], distance_kernel, field);
  return make_share(field, wall, threads);
}

SimMeshDistance *sim_mesh_distance_create(const SimMesh *mesh, const SimWall *wall, int32_t threads) {
  SimMeshDistance *field = sim_allocate(sizeof *field);
  if (!field || make(field, mesh, wall, threads)) return field;
  sim_mesh_distance_destroy(field);
  return NULL;
}

void sim_mesh_distance_destroy(SimMeshDistance *field) {
  if (!field) return;
  sim_release((void *)field->mesh.vertex);
  sim_release((void *)field->mesh.triangle);
  sim_mesh_tree_free(&field->tree);
  sim_release(field->distance);
  sim_release(field->share);
  sim_release(field);
}

// ---- Looking up ------------------------------------------------------------------------------------------------------

// Trilinear interpolation and its gradient; false outside the grid.
static bool look_up(const SimMeshDistance *field, const float *values, const float point[3], float *value,
                    float gradient[3]) {
  int32_t at[3];
  float u[3];
  for (int k = 0; k < 3; k++) {
    float t = (point[k] - field->origin[k]) * field->inverse_cell;
    if (!(t >= 0 && t < (float)(field->size[k] - 1))) return false;
    at[k] = (int32_t)t;
    u[k] = t - (float)at[k];
  }
  size_t row = (size_t)field->size[0], slice = row * (size_t)field->size[1];
  const float *v = values + node_index(field, at[0], at[1], at[2]);
  float x[4], dx[4]; // along x on the four edges of the cell, then along y, then along z
  const float *edge[4] = {v, v + row, v + slice, v + slice + row};
  for (int n = 0; n < 4; n++) {
    dx[n] = edge[n][1] - edge[n][0];
    x[n] = edge[n][0] + u[0] * dx[n];
  }
  float near = x[0] + u[1] * (x[1] - x[0]), far = x[2] + u[1] * (x[3] - x[2]);
  float near_x = dx[0] + u[1] * (dx[1] - dx[0]), far_x = dx[2] + u[1] * (dx[3] - dx[2]);
  *value = near + u[2] * (far - near);
  gradient[0] = (near_x + u[2] * (far_x - near_x)) * field->inverse_cell;
  gradient[1] = (x[1] - x[0] + u[2] * (x[3] - x[2] - x[1] + x[0])) * field->inverse_cell;
  gradient[2] = (far - near) * field->inverse_cell;
  return true;
}

static float beyond_grid(const SimMeshDistance *field, const float point[3], float normal[3]) {
  float squared = 0;
  for (int k = 0; k < 3; k++) {
    float nearest = sim_smaller(sim_larger(point[k], field->low[k]), field->high[k]);
    normal[k] = point[k] - nearest;
    squared += normal[k] * normal[k];
  }
  float distance = sqrtf(squared);
  for (int k = 0; k < 3; k++) normal[k] = distance > 0 ? normal[k] / distance : k == 1;
  return distance;
}

float sim_mesh_distance(const SimMeshDistance *field, const float point[3], float normal[3]) {
  float value, g[3];
  if (!look_up(field, field->distance, point, &value, g)) return beyond_grid(field, point, normal);
  float steepness = sqrtf(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]), sure = field->band - 2 * field->cell;
  bool interpolated = fabsf(value) >= SIM_MESH_EXACT * field->cell && fabsf(value) <= sure && steepness > 0.5f;
  // Far outside a bound will do; from deep inside only the true way out leads out.
  if (interpolated || value > sure) {
    for (int k = 0; k < 3; k++) normal[k] = steepness > 0 ? g[k] / steepness : k == 1;
    return value;
  }
  int32_t hint = 0;
  return sim_mesh_tree_distance(&field->tree, point, &hint, normal);
}

float sim_mesh_solid(const SimMeshDistance *field, const float point[3], float gradient[3]) {
  float share;
  if (look_up(field, field->share, point, &share, gradient)) return share;
  gradient[0] = gradient[1] = gradient[2] = 0;
  return 0;
}
