#include "tests/reference/surface.h"

#include <stdlib.h>
#include <string.h>

#define MAX_NODES (1 << 28)

typedef struct Marcher {
  const Field *field;
  double step;
  Vec origin;        // m, of node (0, 0, 0)
  int32_t size[3];   // nodes
  float *value;      // (size[2], size[1], size[0])
  int32_t *crossing; // (2 layers, size[1], size[0], 7): the vertex on the edge from a node in direction 1 … 7, or −1
  Surface *surface;
  int32_t vertex_room, triangle_room;
} Marcher;

// ---- The grid --------------------------------------------------------------------------------------------------------

static Vec node_at(const Marcher *m, double x, double y, double z) {
  return (Vec){m->origin.x + x * m->step, m->origin.y + y * m->step, m->origin.z + z * m->step};
}

static size_t node_index(const Marcher *m, int32_t x, int32_t y, int32_t z) {
  return ((size_t)z * (size_t)m->size[1] + (size_t)y) * (size_t)m->size[0] + (size_t)x;
}

static bool make_grid(Marcher *m) {
  const double margin = m->field->reach + 2 * m->field->radius + m->step;
  const Vec extent = vec_sub(m->field->max, m->field->min);
  m->origin = vec_sub(m->field->min, (Vec){margin, margin, margin});
  const double sides[3] = {extent.x, extent.y, extent.z};
  double nodes = 1;
  for (int k = 0; k < 3; ++k) nodes *= ceil((sides[k] + 2 * margin) / m->step) + 1;
  if (!(nodes < MAX_NODES)) return false;
  for (int k = 0; k < 3; ++k) m->size[k] = (int32_t)(ceil((sides[k] + 2 * margin) / m->step) + 1);
  m->value = calloc((size_t)nodes, sizeof *m->value);
  const size_t edges = 14 * (size_t)m->size[0] * (size_t)m->size[1];
  m->crossing = malloc(edges * sizeof *m->crossing);
  if (m->crossing != NULL) memset(m->crossing, 0xff, edges * sizeof *m->crossing);
  return m->value != NULL && m->crossing != NULL;
}

// The outermost nodes stay 0, so that the surface is closed whatever the field does.
static void fill_grid(Marcher *m) {
#pragma omp parallel for schedule(dynamic)
  for (int32_t z = 1; z < m->size[2] - 1; ++z) {
    for (int32_t y = 1; y < m->size[1] - 1; ++y) {
      for (int32_t x = 1; x < m->size[0] - 1; ++x) {
        m->value[node_index(m, x, y, z)] = (float)field_value(m->field, node_at(m, x, y, z));
      }
    }
  }
}

// ---- Vertices --------------------------------------------------------------------------------------------------------

static bool grow(void **array, int32_t *room, int32_t count, size_t size) {
  if (count < *room) return true;
  const int32_t wanted = *room > 0 ? 2 * *room : 4096;
  void *grown = realloc(*array, (size_t)wanted * size);
  if (grown == NULL) return false;
  *array = grown;
  *room = wanted;
  return true;
}

// Where the field crosses the iso value between two points, by four steps of false position with the Illinois rule (an end
// that stays twice counts half), kept a little away from both ends so that no triangle shrinks to nothing.
static Vec cross_edge(const Field *field, Vec a, double at_a, Vec b, double at_b) {
  double end[2] = {0, 1}, at[2] = {at_a - field_iso, at_b - field_iso};
  double t = at[0] / (at[0] - at[1]);
  int moved = -1;
  for (int i = 0; i < 4; ++i) {
    const double v = field_value(field, vec_mix(a, b, t)) - field_iso;
    const int side = (v >= 0) == (at[1] >= 0);
    if (side == moved) at[1 - side] /= 2;
    end[side] = t;
    at[side] = v;
    moved = side;
    if (at[0] == at[1]) break;
    t = end[0] + (end[1] - end[0]) * at[0] / (at[0] - at[1]);
  }
  return vec_mix(a, b, fmin(0.999, fmax(0.001, t)));
}

static int32_t crossing_of(Marcher *m, const int32_t cube[3], int low, int high) {
  const int32_t x = cube[0] + (low & 1), y = cube[1] + (low >> 1 & 1), z = cube[2] + (low >> 2);
  const int way = low ^ high;
  const size_t layer = (size_t)(z & 1) * (size_t)m->size[1] * (size_t)m->size[0];
  int32_t *known = &m->crossing[7 * (layer + (size_t)y * (size_t)m->size[0] + (size_t)x) + (size_t)way - 1];
  if (*known >= 0) return *known;
  Surface *s = m->surface;
  if (!grow((void **)&s->vertex, &m->vertex_room, s->vertex_count, sizeof *s->vertex)) return -1;
  const int32_t to[3] = {x + (way & 1), y + (way >> 1 & 1), z + (way >> 2)};
  s->vertex[s->vertex_count] =
      cross_edge(m->field, node_at(m, x, y, z), (double)m->value[node_index(m, x, y, z)],
                 node_at(m, to[0], to[1], to[2]), (double)m->value[node_index(m, to[0], to[1], to[2])]);
  return *known = s->vertex_count++;
}

// ---- Tetrahedra ------------------------------------------------------------------------------------------------------

static bool add_triangle(Marcher *m, int32_t a, int32_t b, int32_t c) {
  Surface *s = m->surface;
  if (a < 0 || b < 0 || c < 0) return false;
  if (!grow((void **)&s->triangle, &m->triangle_room, s->triangle_count, 3 * sizeof *s->triangle)) return false;
  int32_t *triangle = s->triangle + 3 * (size_t)s->triangle_count++;
  triangle[0] = a;
  triangle[1] = b;
  triangle[2] = c;
  return true;
}

static int32_t between(Marcher *m, const int32_t cube[3], int a, int b) {
  return crossing_of(m, cube, a < b ? a : b, a < b ? b : a);
}

// `corner`: four corners of the cube with det(b − a, c − a, d − a) > 0, of which the first `inside` are inside (1 or 2),
// or, with `inside` 3, all but the first.
static bool cut(Marcher *m, const int32_t cube[3], const int corner[4], int inside) {
  const int a = corner[0], b = corner[1], c = corner[2], d = corner[3];
  if (inside == 2) {
    const int32_t ac = between(m, cube, a, c), ad = between(m, cube, a, d), bd = between(m, cube, b, d),
                  bc = between(m, cube, b, c);
    return add_triangle(m, ac, ad, bd) && add_triangle(m, ac, bd, bc);
  }
  const int32_t ab = between(m, cube, a, b), ac = between(m, cube, a, c), ad = between(m, cube, a, d);
  return inside == 1 ? add_triangle(m, ab, ac, ad) : add_triangle(m, ab, ad, ac);
}

// Sort the corners into those first that are fewer, with an even number of exchanges.
static bool march_tetrahedron(Marcher *m, const int32_t cube[3], const bool in[8], const int path[4], bool even) {
  int corner[4], count = 0, at = 0;
  for (int k = 0; k < 4; ++k) count += in[path[k]];
  if (count == 0 || count == 4) return true;
  const bool first = count < 3;
  for (int pass = 0; pass < 2; ++pass) {
    for (int k = 0; k < 4; ++k) {
      if ((in[path[k]] == first) == (pass == 0)) corner[at++] = k;
    }
  }
  for (int i = 0; i < 4; ++i) {
    for (int k = i + 1; k < 4; ++k) even ^= corner[i] > corner[k];
  }
  for (int k = 0; k < 4; ++k) corner[k] = path[corner[k]];
  if (!even) {
    const int last = corner[3];
    corner[3] = corner[2];
    corner[2] = last;
  }
  return cut(m, cube, corner, count);
}

// Corner bits: 1 is x, 2 is y, 4 is z. The six tetrahedra are the ways from corner 0 to corner 7 along the axes.
static bool march_cube(Marcher *m, const int32_t cube[3]) {
  static const int paths[6][4] = {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 4, 6, 7}};
  bool in[8];
  int count = 0;
  for (int k = 0; k < 8; ++k) {
    in[k] = (double)m->value[node_index(m, cube[0] + (k & 1), cube[1] + (k >> 1 & 1), cube[2] + (k >> 2))] >= field_iso;
    count += in[k];
  }
  if (count == 0 || count == 8) return true;
  for (int p = 0; p < 6; ++p) {
    if (!march_tetrahedron(m, cube, in, paths[p], p < 3)) return false;
  }
  return true;
}

static bool march(Marcher *m) {
  const size_t layer = 7 * (size_t)m->size[0] * (size_t)m->size[1];
  for (int32_t z = 0; z + 1 < m->size[2]; ++z) {
    // The upper layer's edges are new; the lower ones may have been met from below.
    memset(m->crossing + (size_t)((z + 1) & 1) * layer, 0xff, layer * sizeof *m->crossing);
    for (int32_t y = 0; y + 1 < m->size[1]; ++y) {
      for (int32_t x = 0; x + 1 < m->size[0]; ++x) {
        if (!march_cube(m, (int32_t[3]){x, y, z})) return false;
      }
    }
  }
  return true;
}

static bool make_normals(Surface *s, const Field *field) {
  s->normal = calloc((size_t)s->vertex_count + 1, sizeof *s->normal);
  if (s->normal == NULL) return false;
#pragma omp parallel for schedule(dynamic, 256)
  for (int32_t i = 0; i < s->vertex_count; ++i) s->normal[i] = field_normal(field, s->vertex[i]);
  return true;
}

bool surface_create(Surface *surface, const Field *field, double step) {
  *surface = (Surface){0};
  if (field->count == 0) return true;
  Marcher m = {.field = field, .step = step, .surface = surface};
  bool made = make_grid(&m);
  if (made) {
    fill_grid(&m);
    made = march(&m) && make_normals(surface, field);
  }
  free(m.value);
  free(m.crossing);
  return made;
}

void surface_destroy(Surface *surface) {
  free(surface->vertex);
  free(surface->normal);
  free(surface->triangle);
  *surface = (Surface){0};
}

double surface_volume(const Surface *s) {
  double six = 0;
  for (int32_t i = 0; i < s->triangle_count; ++i) {
    const int32_t *t = s->triangle + 3 * (size_t)i;
    six += vec_dot(s->vertex[t[0]], vec_cross(s->vertex[t[1]], s->vertex[t[2]]));
  }
  return six / 6;
}
