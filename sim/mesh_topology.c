// Closedness of a mesh. The 3 n directed edges are sorted by their two vertices with two counting sorts, first by the
// larger index, then by the smaller one, which keeps the order of the first: linear in time, whatever the mesh. Then the
// copies of an edge follow each other.
#include "sim/mesh_topology.h"

#include <math.h>

#include "sim/memory.h"
#include "sim/world.h"

// Largest coordinate, m.
#define MAX_COORDINATE 1e6f

static int32_t tail(const SimMesh *mesh, int32_t edge) {
  return mesh->triangle[edge];
}

static int32_t head(const SimMesh *mesh, int32_t edge) {
  return mesh->triangle[edge % 3 == 2 ? edge - 2 : edge + 1];
}

static int32_t lower_end(const SimMesh *mesh, int32_t edge) {
  int32_t a = tail(mesh, edge), b = head(mesh, edge);
  return a < b ? a : b;
}

static int32_t upper_end(const SimMesh *mesh, int32_t edge) {
  int32_t a = tail(mesh, edge), b = head(mesh, edge);
  return a < b ? b : a;
}

// Stable counting sort of the edges in `from` (NULL: 0, 1, 2 …) by a vertex.
static void sort_edges(const SimMesh *mesh, int32_t (*key)(const SimMesh *, int32_t), const int32_t *from, int32_t *to,
                       int32_t *start) {
  int32_t edges = 3 * mesh->triangle_count;
  for (int32_t v = 0; v <= mesh->vertex_count; v++) start[v] = 0;
  for (int32_t e = 0; e < edges; e++) start[key(mesh, e) + 1]++;
  for (int32_t v = 0; v < mesh->vertex_count; v++) start[v + 1] += start[v];
  for (int32_t n = 0; n < edges; n++) {
    int32_t e = from ? from[n] : n;
    to[start[key(mesh, e)]++] = e;
  }
}

static SimMeshFault pair_edges(const SimMesh *mesh, const int32_t *sorted, int32_t *neighbour, int32_t edge[2]) {
  int32_t edges = 3 * mesh->triangle_count;
  for (int32_t n = 0; n < edges;) {
    int32_t first = sorted[n], count = 1;
    edge[0] = lower_end(mesh, first), edge[1] = upper_end(mesh, first);
    while (n + count < edges && lower_end(mesh, sorted[n + count]) == edge[0] &&
           upper_end(mesh, sorted[n + count]) == edge[1])
      count++;
    if (count == 1) return SIM_MESH_OPEN;
    if (count > 2) return SIM_MESH_BRANCHES;
    int32_t second = sorted[n + 1];
    if (tail(mesh, first) == tail(mesh, second)) return SIM_MESH_TWISTED;
    neighbour[first] = second / 3;
    neighbour[second] = first / 3;
    n += 2;
  }
  return SIM_MESH_CLOSED;
}

SimMeshFault sim_mesh_neighbours(const SimMesh *mesh, int32_t *neighbour, int32_t edge[2]) {
  size_t edges = 3 * (size_t)mesh->triangle_count;
  int32_t *by_upper = sim_allocate(edges * sizeof *by_upper), *sorted = sim_allocate(edges * sizeof *sorted);
  int32_t *start = sim_allocate(((size_t)mesh->vertex_count + 1) * sizeof *start);
  SimMeshFault fault = SIM_MESH_NO_MEMORY;
  if (by_upper && sorted && start) {
    sort_edges(mesh, upper_end, NULL, by_upper, start);
    sort_edges(mesh, lower_end, by_upper, sorted, start);
    fault = pair_edges(mesh, sorted, neighbour, edge);
  }
  sim_release(by_upper);
  sim_release(sorted);
  sim_release(start);
  return fault;
}

double sim_mesh_volume(const SimMesh *mesh) {
  const float *o =
      mesh->vertex; // of tetrahedra with the first vertex, so that a place far from the origin costs no digits
  double sum = 0;
  for (int32_t t = 0; t < mesh->triangle_count; t++) {
    double e[3][3];
    for (int j = 0; j < 3; j++)
      for (int k = 0; k < 3; k++) e[j][k] = (double)mesh->vertex[3 * mesh->triangle[3 * t + j] + k] - (double)o[k];
    sum += e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) + e[0][1] * (e[1][2] * e[2][0] - e[1][0] * e[2][2]) +
           e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
  }
  return sum / 6;
}

static bool check_arrays(const SimMesh *mesh, const char *name, SimError *error) {
  if (mesh->vertex_count < 4 || mesh->vertex_count > SIM_MESH_MAX_VERTICES || !mesh->vertex)
    return sim_fail(error, "%s: mesh must have 4 to %d vertices, got %d", name, SIM_MESH_MAX_VERTICES,
                    mesh->vertex_count);
  if (mesh->triangle_count < 4 || mesh->triangle_count > SIM_MESH_MAX_TRIANGLES || !mesh->triangle)
    return sim_fail(error, "%s: mesh must have 4 to %d triangles, got %d", name, SIM_MESH_MAX_TRIANGLES,
                    mesh->triangle_count);
  for (int32_t v = 0; v < mesh->vertex_count; v++)
    for (int k = 0; k < 3; k++)
      if (!(fabsf(mesh->vertex[3 * v + k]) <= MAX_COORDINATE))
        return sim_fail(error, "%s: mesh vertex %d: coordinates must be finite and at most %g m in size, got %g", name,
                        v, (double)MAX_COORDINATE, (double)mesh->vertex[3 * v + k]);
  for (int32_t t = 0; t < mesh->triangle_count; t++) {
    const int32_t *corner = mesh->triangle + 3 * t;
    for (int j = 0; j < 3; j++)
      if (corner[j] < 0 || corner[j] >= mesh->vertex_count)
        return sim_fail(error, "%s: mesh triangle %d: there is no vertex %d", name, t, corner[j]);
    if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0])
      return sim_fail(error, "%s: mesh triangle %d uses a vertex twice", name, t);
  }
  return true;
}

bool sim_mesh_check(const SimMesh *mesh, const char *name, SimError *error) {
  if (!check_arrays(mesh, name, error)) return false;
  int32_t *neighbour = sim_allocate(3 * (size_t)mesh->triangle_count * sizeof *neighbour), edge[2];
  SimMeshFault fault = neighbour ? sim_mesh_neighbours(mesh, neighbour, edge) : SIM_MESH_NO_MEMORY;
  sim_release(neighbour);
  switch (fault) {
  case SIM_MESH_CLOSED:
    break;
  case SIM_MESH_OPEN:
    return sim_fail(error, "%s: mesh is not closed: only one triangle at the edge of vertices %d and %d", name, edge[0],
                    edge[1]);
  case SIM_MESH_BRANCHES:
    return sim_fail(error,
                    "%s: mesh is not the surface of a solid: more than two triangles at the edge of vertices %d "
                    "and %d",
                    name, edge[0], edge[1]);
  case SIM_MESH_TWISTED:
    return sim_fail(error, "%s: mesh triangles at the edge of vertices %d and %d turn in opposite senses", name,
                    edge[0], edge[1]);
  case SIM_MESH_NO_MEMORY:
    return sim_fail(error, "out of memory");
  }
  double volume = sim_mesh_volume(mesh);
  if (!(volume > 0))
    return sim_fail(error,
                    "%s: mesh must enclose a volume, its triangles turning counter-clockwise seen from outside; "
                    "its volume is %g m³",
                    name, volume);
  return true;
}
