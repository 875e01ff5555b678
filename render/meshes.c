// Triangle meshes on the GPU. A mesh stays there as long as pictures go on showing it: it is known again by its content,
// byte for byte, not by its address, which may meanwhile belong to another.
//
// Normals at the corners: where two faces that share a vertex meet at a small angle, the surface is taken to be smooth
// and the corner gets their mean, weighted by the angle of each at the vertex (Thürmer & Wüthrich, "Computing vertex
// normals from polygonal facets", Journal of Graphics Tools 3(1), 1998); across a sharper crease, and where triangles do
// not share vertices, faces stay flat. Limit: around a vertex of very many faces all are flat, which bounds the work.
#include "render/picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MAX_TRIANGLES 1000000 // 72 MB of corners, within what every driver of OpenGL 4.5 takes as one buffer
#define MAX_VERTICES (3 * MAX_TRIANGLES)
#define SMOOTH_COSINE 0.766 // faces that meet at less than 40 degrees are one smooth surface
#define MAX_FAN 256         // faces around a vertex that are compared with each other
#define CORNER_FLOATS 6     // position, normal

// ---- Normals ---------------------------------------------------------------------------------------------------------

// The triangles that can be drawn and what is known of them; the arrays live as long as a mesh is being taken in.
typedef struct Faces {
  int32_t count;
  const float *vertex; // m, (vertices, 3)
  int32_t *corner;     // (count, 3), indices of vertices
  double (*normal)[3]; // unit, (count)
  float *angle;        // radians, (count, 3), of the face at the corner
  int32_t *fan_start;  // (vertices + 1)
  int32_t *fan;        // (3 count), the faces around vertex v: fan_start[v] … fan_start[v + 1] − 1
} Faces;

static bool faces_create(Faces *faces, const SimMesh *mesh) {
  const size_t triangles = (size_t)mesh->triangle_count, vertices = (size_t)mesh->vertex_count;
  *faces = (Faces){
      .vertex = mesh->vertex,
      .corner = malloc(3 * triangles * sizeof *faces->corner),
      .normal = malloc(triangles * sizeof *faces->normal),
      .angle = malloc(3 * triangles * sizeof *faces->angle),
      .fan_start = calloc(vertices + 1, sizeof *faces->fan_start),
      .fan = malloc(3 * triangles * sizeof *faces->fan),
  };
  return faces->corner != NULL && faces->normal != NULL && faces->angle != NULL && faces->fan_start != NULL &&
         faces->fan != NULL;
}

static void faces_destroy(Faces *faces) {
  free(faces->corner);
  free(faces->normal);
  free(faces->angle);
  free(faces->fan_start);
  free(faces->fan);
}

static double length_of(const double v[3]) {
  return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Unit vector from one vertex to another; false when they are in one place.
static bool direction(double out[3], const float *from, const float *to) {
  for (int k = 0; k < 3; ++k) out[k] = (double)to[k] - (double)from[k];
  const double length = length_of(out);
  for (int k = 0; k < 3; ++k) out[k] /= length;
  return length > 0;
}

// Are the corners vertices at sensible places that span an area? Then the face is added.
static void add_face(Faces *faces, const int32_t corner[3], int32_t vertex_count) {
  const float *at[3];
  double edge[3][3];
  for (int c = 0; c < 3; ++c) {
    if (corner[c] < 0 || corner[c] >= vertex_count) return;
    at[c] = faces->vertex + 3 * (size_t)corner[c];
    for (int k = 0; k < 3; ++k) {
      if (!(fabsf(at[c][k]) < RENDER_FARTHEST)) return;
    }
  }
  for (int c = 0; c < 3; ++c) {
    if (!direction(edge[c], at[c], at[(c + 1) % 3])) return;
  }
  double *n = faces->normal[faces->count];
  for (int k = 0; k < 3; ++k) {
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    n[k] = edge[0][a] * edge[1][b] - edge[0][b] * edge[1][a];
  }
  const double length = length_of(n);
  if (!(length > 1e-9)) return;
  for (int k = 0; k < 3; ++k) n[k] /= length;
  for (int c = 0; c < 3; ++c) {
    const double cosine = -dot(edge[c], edge[(c + 2) % 3]);
    faces->angle[3 * (size_t)faces->count + (size_t)c] = (float)acos(fmin(fmax(cosine, -1), 1));
    faces->corner[3 * (size_t)faces->count + (size_t)c] = corner[c];
  }
  ++faces->count;
}

// Counting sort of the faces by vertex.
static void list_fans(Faces *faces, int32_t vertex_count) {
  int32_t *start = faces->fan_start;
  const size_t corners = 3 * (size_t)faces->count;
  for (size_t i = 0; i < corners; ++i) ++start[faces->corner[i]];
  for (int32_t v = 1; v <= vertex_count; ++v) start[v] += start[v - 1];
  for (size_t i = corners; i-- > 0;) faces->fan[--start[faces->corner[i]]] = (int32_t)(i / 3);
}

static float angle_at(const Faces *faces, int32_t face, int32_t vertex) {
  const int32_t *corner = faces->corner + 3 * (size_t)face;
  const int c = corner[0] == vertex ? 0 : corner[1] == vertex ? 1 : 2;
  return faces->angle[3 * (size_t)face + (size_t)c];
}

static void corner_normal(const Faces *faces, int32_t face, int32_t vertex, float out[3]) {
  const double *own = faces->normal[face];
  const int32_t begin = faces->fan_start[vertex], end = faces->fan_start[vertex + 1];
  double sum[3] = {0};
  for (int32_t i = begin; i < end && end - begin <= MAX_FAN; ++i) {
    const double *other = faces->normal[faces->fan[i]];
    if (dot(own, other) < SMOOTH_COSINE) continue;
    const double weight = (double)angle_at(faces, faces->fan[i], vertex);
    for (int k = 0; k < 3; ++k) sum[k] += weight * other[k];
  }
  const double length = length_of(sum);
  for (int k = 0; k < 3; ++k) out[k] = (float)(length > 0 ? sum[k] / length : own[k]);
}

// ---- Taking a mesh in ------------------------------------------------------------------------------------------------

static void take_corners(RenderMesh *mesh, const Faces *faces, float *corners) {
  double reach2 = 0;
  for (int32_t i = 0; i < 3 * faces->count; ++i) {
    const int32_t vertex = faces->corner[i];
    const float *p = faces->vertex + 3 * (size_t)vertex;
    float *out = corners + CORNER_FLOATS * (size_t)i;
    memcpy(out, p, 3 * sizeof *p);
    corner_normal(faces, i / 3, vertex, out + 3);
    const double from_origin[3] = {(double)p[0], (double)p[1], (double)p[2]};
    reach2 = fmax(reach2, dot(from_origin, from_origin));
    for (int k = 0; k < 3; ++k) mesh->half[k] = fmaxf(mesh->half[k], (float)fabs(from_origin[k]));
  }
  mesh->corner_count = 3 * faces->count;
  mesh->reach = (float)sqrt(reach2);
}

// Output: the mesh's corners on the GPU; none when no triangle of it can be drawn.
static bool take(RenderMesh *mesh, const SimMesh *from, RenderError *error) {
  Faces faces;
  float *corners = NULL;
  bool ok = faces_create(&faces, from);
  if (ok) {
    for (int32_t i = 0; i < from->triangle_count; ++i) {
      add_face(&faces, from->triangle + 3 * (size_t)i, from->vertex_count);
    }
    list_fans(&faces, from->vertex_count);
    corners = malloc((3 * (size_t)faces.count + 1) * CORNER_FLOATS * sizeof *corners);
    ok = corners != NULL;
  }
  if (ok) {
    take_corners(mesh, &faces, corners);
    const size_t size = (size_t)mesh->corner_count * CORNER_FLOATS * sizeof *corners;
    ok = size == 0 || gpu_buffer_write(&mesh->corners, "mesh", corners, size, error);
  } else {
    gpu_fail(error, "out of memory for a mesh of %d triangles", from->triangle_count);
  }
  free(corners);
  faces_destroy(&faces);
  return ok;
}

// ---- Knowing it again ------------------------------------------------------------------------------------------------

static size_t vertex_bytes(int32_t count) {
  return 3 * (size_t)count * sizeof(float);
}

static size_t triangle_bytes(int32_t count) {
  return 3 * (size_t)count * sizeof(int32_t);
}

static bool same_content(const RenderMesh *mesh, const SimMesh *other) {
  return mesh->vertex_count == other->vertex_count && mesh->triangle_count == other->triangle_count &&
         memcmp(mesh->content, other->vertex, vertex_bytes(other->vertex_count)) == 0 &&
         memcmp(mesh->content + vertex_bytes(other->vertex_count), other->triangle,
                triangle_bytes(other->triangle_count)) == 0;
}

static void mesh_destroy(RenderMesh *mesh) {
  gpu_buffer_destroy(&mesh->corners);
  free(mesh->content);
  *mesh = (RenderMesh){0};
}

static bool add_mesh(RenderMeshes *meshes, const SimMesh *from, RenderError *error) {
  RenderMesh *grown = realloc(meshes->meshes, ((size_t)meshes->count + 1) * sizeof *grown);
  if (grown == NULL) return gpu_fail(error, "out of memory for %d meshes", meshes->count + 1);
  meshes->meshes = grown;
  RenderMesh *mesh = &grown[meshes->count];
  const size_t vertices = vertex_bytes(from->vertex_count), triangles = triangle_bytes(from->triangle_count);
  *mesh = (RenderMesh){
      .vertex_count = from->vertex_count,
      .triangle_count = from->triangle_count,
      .content = malloc(vertices + triangles),
  };
  if (mesh->content == NULL) {
    return gpu_fail(error, "out of memory for a mesh of %d triangles", from->triangle_count);
  }
  memcpy(mesh->content, from->vertex, vertices);
  memcpy(mesh->content + vertices, from->triangle, triangles);
  if (!take(mesh, from, error)) {
    mesh_destroy(mesh);
    return false;
  }
  ++meshes->count;
  return true;
}

bool render_meshes_take(RenderMeshes *meshes, const SimMesh *mesh, int32_t *index, RenderError *error) {
  *index = -1;
  if (mesh == NULL || mesh->vertex == NULL || mesh->triangle == NULL) return true;
  if (mesh->vertex_count <= 0 || mesh->triangle_count <= 0) return true;
  if (mesh->triangle_count > MAX_TRIANGLES || mesh->vertex_count > MAX_VERTICES) {
    return gpu_fail(error, "a mesh of %d vertices and %d triangles is too large to draw: at most %d and %d",
                    mesh->vertex_count, mesh->triangle_count, MAX_VERTICES, MAX_TRIANGLES);
  }
  int32_t i = 0;
  while (i < meshes->count && !same_content(&meshes->meshes[i], mesh)) ++i;
  if (i == meshes->count && !add_mesh(meshes, mesh, error)) return false;
  meshes->meshes[i].shown = true;
  if (meshes->meshes[i].corner_count > 0) *index = i;
  return true;
}

void render_meshes_forget(RenderMeshes *meshes) {
  int32_t kept = 0;
  for (int32_t i = 0; i < meshes->count; ++i) {
    RenderMesh mesh = meshes->meshes[i];
    if (mesh.shown) {
      mesh.shown = false;
      meshes->meshes[kept++] = mesh;
    } else {
      mesh_destroy(&mesh);
    }
  }
  meshes->count = kept;
}

void render_meshes_destroy(RenderMeshes *meshes) {
  for (int32_t i = 0; i < meshes->count; ++i) mesh_destroy(&meshes->meshes[i]);
  free(meshes->meshes);
  *meshes = (RenderMeshes){0};
}
