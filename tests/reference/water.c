#include "tests/reference/water.h"

#include <embree3/rtcore.h>
#include <stdlib.h>
#include <string.h>

#define FARTHEST 1e6f  // m, as in the renderer
#define GRID_STEP 0.75 // of the mesh, in radii

typedef struct Sphere {
  Vec centre;
  double radius;
} Sphere;

struct Water {
  RTCDevice device;
  RTCScene scene;
  Sphere *sphere; // geometry SPHERES, (sphere_count)
  int32_t sphere_count;
  Surface surface; // geometry MESH
};
enum { SPHERES = 0, MESH = 1 };

/// One question to Embree, whose own rays are single floats: the callbacks work on these doubles.
typedef struct Query {
  struct RTCIntersectContext context; // first, so that one is the other
  const Water *water;
  const WaterRay *ray;
  double from; // m: what lies before it has been crossed
  double t;    // m, of the nearest sphere so far
} Query;

// ---- Spheres ---------------------------------------------------------------------------------------------------------

// Embree's rays are off by the rounding of their floats, so the boxes have that much room.
static void sphere_bounds(const struct RTCBoundsFunctionArguments *args) {
  const Sphere *s = &((const Water *)args->geometryUserPtr)->sphere[args->primID];
  const double room = s->radius * 1.0001 + 1e-6 * (fabs(s->centre.x) + fabs(s->centre.y) + fabs(s->centre.z));
  args->bounds_o->lower_x = (float)(s->centre.x - room);
  args->bounds_o->lower_y = (float)(s->centre.y - room);
  args->bounds_o->lower_z = (float)(s->centre.z - room);
  args->bounds_o->upper_x = (float)(s->centre.x + room);
  args->bounds_o->upper_y = (float)(s->centre.y + room);
  args->bounds_o->upper_z = (float)(s->centre.z + room);
}

// Entry and exit; false when the ray misses.
static bool meet_sphere(const Sphere *s, const WaterRay *ray, double t[2]) {
  const Vec to_centre = vec_sub(s->centre, ray->origin);
  const double middle = vec_dot(to_centre, ray->direction);
  const Vec foot = vec_along(to_centre, -middle, ray->direction);
  const double h2 = s->radius * s->radius - vec_dot(foot, foot);
  if (!(h2 > 0)) return false;
  t[0] = middle - sqrt(h2);
  t[1] = middle + sqrt(h2);
  return true;
}

// On its way from a sphere a ray can only meet the same one at the root that it does not start at.
static void sphere_intersect(const struct RTCIntersectFunctionNArguments *args) {
  if (args->valid[0] == 0) return;
  Query *query = (Query *)args->context;
  struct RTCRayHit *rayhit = (struct RTCRayHit *)args->rayhit;
  double t[2];
  if (!meet_sphere(&query->water->sphere[args->primID], query->ray, t)) return;
  const bool again = query->ray->geometry == SPHERES && query->ray->primitive == args->primID;
  const bool from_exit = again && fabs(t[1] - query->from) < fabs(t[0] - query->from);
  const int first = again || t[0] <= query->from;
  if (from_exit || t[first] <= query->from || t[first] >= (double)rayhit->ray.tfar) return;
  query->t = t[first];
  rayhit->ray.tfar = (float)t[first];
  rayhit->hit.geomID = args->geomID;
  rayhit->hit.primID = args->primID;
  rayhit->hit.u = (float)first; // 1: it is an exit
}

static bool take_sphere(Water *water, const SimFrame *frame, int32_t i) {
  const float *p = frame->position + 3 * (size_t)i;
  const float radius = frame->radius != NULL ? frame->radius[i] : frame->particle_radius;
  for (int k = 0; k < 3; ++k) {
    if (!(fabsf(p[k]) < FARTHEST)) return false;
  }
  if (!(radius > 0 && radius < FARTHEST)) return false;
  water->sphere[water->sphere_count++] = (Sphere){vec_of(p), (double)radius};
  return true;
}

static bool add_spheres(Water *water, const SimFrame *frame) {
  water->sphere = calloc((size_t)frame->count + 1, sizeof *water->sphere);
  if (water->sphere == NULL) return false;
  for (int32_t i = 0; i < frame->count; ++i) {
    if (frame->particle_class == NULL || frame->particle_class[i] == SIM_SPLASH) take_sphere(water, frame, i);
  }
  if (water->sphere_count == 0) return true;
  RTCGeometry geometry = rtcNewGeometry(water->device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, (unsigned)water->sphere_count);
  rtcSetGeometryUserData(geometry, water);
  rtcSetGeometryBoundsFunction(geometry, sphere_bounds, NULL);
  rtcSetGeometryIntersectFunction(geometry, sphere_intersect);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(water->scene, geometry, SPHERES);
  rtcReleaseGeometry(geometry);
  return true;
}

// ---- The mesh --------------------------------------------------------------------------------------------------------

// The triangle that the ray starts on. With one ray at a time a hit of N is a hit.
static void skip_start(const struct RTCFilterFunctionNArguments *args) {
  const WaterRay *ray = ((const Query *)args->context)->ray;
  if (ray->geometry == MESH && ray->primitive == ((const struct RTCHit *)args->hit)->primID) args->valid[0] = 0;
}

static bool fill_mesh(const Surface *s, RTCGeometry geometry) {
  float *vertex = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                          (size_t)s->vertex_count);
  unsigned *index = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned),
                                            (size_t)s->triangle_count);
  if (vertex == NULL || index == NULL) return false;
  for (int32_t i = 0; i < s->vertex_count; ++i) {
    *vertex++ = (float)s->vertex[i].x;
    *vertex++ = (float)s->vertex[i].y;
    *vertex++ = (float)s->vertex[i].z;
  }
  for (size_t i = 0; i < 3 * (size_t)s->triangle_count; ++i) index[i] = (unsigned)s->triangle[i];
  return true;
}

static bool add_mesh(Water *water, const SimFrame *frame, const Environment *environment) {
  if (frame->particle_class == NULL) return true;
  if (frame->ellipsoid == NULL || frame->smoothed == NULL)
    return memchr(frame->particle_class, SIM_AGGREGATED, (size_t)frame->count) == NULL;
  Field field;
  const bool made = field_create(&field, frame, environment) &&
                    surface_create(&water->surface, &field, GRID_STEP * (double)frame->particle_radius);
  field_destroy(&field);
  if (!made || water->surface.triangle_count == 0) return made;
  RTCGeometry geometry = rtcNewGeometry(water->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const bool filled = fill_mesh(&water->surface, geometry);
  rtcSetGeometryIntersectFilterFunction(geometry, skip_start);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(water->scene, geometry, MESH);
  rtcReleaseGeometry(geometry);
  return filled;
}

const Surface *water_surface(const Water *water) {
  return &water->surface;
}

Water *water_create(const SimFrame *frame, const Environment *environment) {
  Water *water = calloc(1, sizeof *water);
  if (water == NULL) return NULL;
  water->device = rtcNewDevice("threads=1,set_affinity=0");
  water->scene = water->device != NULL ? rtcNewScene(water->device) : NULL;
  if (water->scene == NULL || !add_spheres(water, frame) || !add_mesh(water, frame, environment)) {
    water_destroy(water);
    return NULL;
  }
  rtcSetSceneFlags(water->scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(water->scene, RTC_BUILD_QUALITY_HIGH);
  rtcCommitScene(water->scene);
  return water;
}

void water_destroy(Water *water) {
  if (water == NULL) return;
  if (water->scene != NULL) rtcReleaseScene(water->scene);
  if (water->device != NULL) rtcReleaseDevice(water->device);
  surface_destroy(&water->surface);
  free(water->sphere);
  free(water);
}

// ---- What a ray is inside of -----------------------------------------------------------------------------------------

bool water_wet(const Medium *medium) {
  return medium->mesh || medium->count > 0;
}

static void enter_sphere(Medium *medium, uint32_t sphere) {
  for (int i = 0; i < medium->count; ++i) {
    if (medium->sphere[i] == sphere) return;
  }
  if (medium->count < WATER_MAX_OVERLAP) medium->sphere[medium->count++] = sphere;
}

static void leave_sphere(Medium *medium, uint32_t sphere) {
  for (int i = 0; i < medium->count; ++i) {
    if (medium->sphere[i] == sphere) medium->sphere[i] = medium->sphere[--medium->count];
  }
}

static Vec corner(const Surface *s, const Vec *of, uint32_t triangle, int k) {
  return of[s->triangle[3 * (size_t)triangle + (size_t)k]];
}

static Vec flat_normal(const Surface *s, uint32_t triangle) {
  const Vec a = corner(s, s->vertex, triangle, 0);
  const Vec n = vec_cross(vec_sub(corner(s, s->vertex, triangle, 1), a), vec_sub(corner(s, s->vertex, triangle, 2), a));
  return vec_unit(n);
}

/// One crossing of one body.
typedef struct Crossing {
  double t;
  bool entry;
  uint32_t geometry, primitive;
  float u, v;
} Crossing;

static bool next_crossing(const Water *water, const WaterRay *ray, double from, double limit, Crossing *crossing) {
  Query query = {.water = water, .ray = ray, .from = from};
  rtcInitIntersectContext(&query.context);
  struct RTCRayHit h = {.ray = {.org_x = (float)ray->origin.x,
                                .org_y = (float)ray->origin.y,
                                .org_z = (float)ray->origin.z,
                                .dir_x = (float)ray->direction.x,
                                .dir_y = (float)ray->direction.y,
                                .dir_z = (float)ray->direction.z,
                                .tnear = (float)from,
                                .tfar = (float)limit,
                                .mask = UINT32_MAX},
                        .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
  rtcIntersect1(water->scene, &query.context, &h);
  if (h.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  *crossing = (Crossing){query.t, h.hit.u == 0, h.hit.geomID, h.hit.primID, h.hit.u, h.hit.v};
  if (h.hit.geomID == SPHERES) return true;
  // Once more in doubles, with the plane of the triangle.
  const Surface *s = &water->surface;
  const Vec normal = flat_normal(s, h.hit.primID);
  const double closing = vec_dot(normal, ray->direction);
  crossing->entry = closing < 0;
  crossing->t = vec_dot(normal, vec_sub(corner(s, s->vertex, h.hit.primID, 0), ray->origin)) / closing;
  if (!(fabs(crossing->t - (double)h.ray.tfar) < 1e-4)) crossing->t = (double)h.ray.tfar; // seen edge-on
  return true;
}

static void step_over(WaterRay *ray, Medium *behind, const Crossing *c) {
  if (c->geometry == MESH) {
    // The mesh is closed, so what side it is met from says where the ray has been.
    ray->medium.mesh = !c->entry;
    behind->mesh = c->entry;
  } else if (c->entry) {
    enter_sphere(behind, c->primitive);
  } else {
    enter_sphere(&ray->medium, c->primitive);
    leave_sphere(behind, c->primitive);
  }
}

static WaterHit hit_of(const Water *water, const WaterRay *ray, const Medium *behind, const Crossing *c) {
  WaterHit hit = {.t = c->t, .behind = *behind, .geometry = c->geometry, .primitive = c->primitive};
  hit.point = vec_along(ray->origin, c->t, ray->direction);
  if (c->geometry == SPHERES) {
    hit.normal = hit.flat = vec_unit(vec_sub(hit.point, water->sphere[c->primitive].centre));
    return hit;
  }
  const Surface *s = &water->surface;
  const double u = (double)c->u, v = (double)c->v;
  const Vec a = corner(s, s->normal, c->primitive, 0), b = corner(s, s->normal, c->primitive, 1);
  hit.flat = flat_normal(s, c->primitive);
  hit.normal = vec_unit(vec_along(vec_along(vec_scale(1 - u - v, a), u, b), v, corner(s, s->normal, c->primitive, 2)));
  // Seen from the wrong side of the smooth normal, the triangle's own is better.
  if (vec_dot(hit.normal, ray->direction) * vec_dot(hit.flat, ray->direction) <= 0) hit.normal = hit.flat;
  return hit;
}

bool water_meet(const Water *water, WaterRay *ray, double limit, WaterHit *hit) {
  Crossing crossing;
  double from = 0;
  while (next_crossing(water, ray, from, limit, &crossing)) {
    Medium behind = ray->medium;
    step_over(ray, &behind, &crossing);
    if (water_wet(&ray->medium) != water_wet(&behind)) {
      *hit = hit_of(water, ray, &behind, &crossing);
      return true;
    }
    ray->medium = behind;
    ray->geometry = crossing.geometry;
    ray->primitive = crossing.primitive;
    // Strictly further, or two triangles at their common edge would take turns.
    from = fmax(crossing.t, (double)nextafterf((float)from, INFINITY));
  }
  return false;
}

// A ray upwards, a little askew; the first side of the mesh that it meets, and every sphere that holds the point.
Medium water_medium_at(const Water *water, Vec point) {
  Medium medium = {0};
  WaterRay ray = {point, vec_unit((Vec){0.013, 1, 0.017}), {0}, WATER_NOWHERE, WATER_NOWHERE};
  double from = 0;
  Crossing crossing;
  while (next_crossing(water, &ray, from, INFINITY, &crossing)) {
    if (crossing.geometry == MESH) {
      medium.mesh = !crossing.entry;
      break;
    }
    ray.geometry = SPHERES;
    ray.primitive = crossing.primitive;
    from = crossing.t;
  }
  for (int32_t i = 0; i < water->sphere_count; ++i) {
    const Vec d = vec_sub(point, water->sphere[i].centre);
    if (vec_dot(d, d) < water->sphere[i].radius * water->sphere[i].radius) enter_sphere(&medium, (uint32_t)i);
  }
  return medium;
}
