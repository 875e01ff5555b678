// What a ray in the air sees of the scene around the water: bodies, floor and sky where they are, met by geometry. Include
// it after frame.glsl, with BODIES defined where there are any, the ends of each shape in `body_end`, and the picture of the
// background with its depth in `background`. MAPPED: bodies that belong to an object of the pool (pool.glsl) are left out; their
// object is in `object_of_body`.
#ifdef DRAWN
#include "drawn.glsl"
#endif
#include "sky.glsl"
#include "sun.glsl"
#include "floor_light.glsl"
#ifdef BODIES
#include "body.glsl"
#include "solids.glsl"
#include "solid_light.glsl"
#endif

const int NOTHING = 0, FLOOR = 1, BODY = 2, PICTURE = 3;

struct Meeting {
  float t;              // m along a unit direction; FAR: the sky
  int what;
  vec3 normal, colour;  // of a body; PICTURE: the light itself
};

#ifdef BODIES
#ifdef MAPPED
#define LEFT_OUT(body) (object_of_body[body] >= 0)
#else
#define LEFT_OUT(body) false
#endif

// All bodies of one shape, which lie side by side.
#define MEET_BODIES(begin, end, meet_shape) \
  for (int i = begin; i < end; ++i) { \
    if (LEFT_OUT(i)) continue; \
    Body body = bodies[i]; \
    vec4 back = vec4(-body.rotation.xyz, body.rotation.w); \
    vec3 normal; \
    vec2 t = meet_shape(body, rotate(back, origin - body.position.xyz), rotate(back, way), 0.0, normal); \
    if (t.x <= t.y && t.x > 0.0 && t.x < nearest.t) { \
      nearest = Meeting(t.x, BODY, rotate(body.rotation, normal), body.colour.rgb); \
    } \
  }
#endif

#if MESHES && defined(BODIES)
// Triangles are not met by geometry: where a ray passes the ball around a mesh, it is followed through the picture of the
// background, which shows the side of the mesh that the eye sees.
void meet_mesh(vec3 origin, vec3 way, vec4 around, inout Meeting nearest) {
  const int SAMPLES = 12;
  vec2 t = ball(origin - around.xyz, way, around.w);
  t = vec2(max(t.x, 0.0), min(t.y, nearest.t));
  float thickness = around.w * 0.5, step_on = (t.y - t.x) / float(SAMPLES);
  for (int i = 1; i <= SAMPLES && step_on > 0.0; ++i) {
    vec3 p = to_view(origin + way * (t.x + step_on * float(i)));
    vec2 pixel = (p.xy / (-p.z * lens.xy) * 0.5 + 0.5) * lens.zw;
    if (-p.z < eye.w || any(lessThan(pixel, vec2(0.0))) || any(greaterThanEqual(pixel, lens.zw))) continue;
    vec4 seen_there = texelFetch(background, ivec2(pixel), 0);
    vec3 there = eye.xyz + to_world(view_ray(pixel / lens.zw * 2.0 - 1.0)) * seen_there.a;
    bool of_mesh = seen_there.a > 0.0 && distance(there, around.xyz) < around.w;
    if (of_mesh && -p.z > seen_there.a && -p.z < seen_there.a + thickness) {
      nearest = Meeting(t.x + step_on * float(i), PICTURE, vec3(0.0), seen_there.rgb);
      return;
    }
  }
}
#endif

// The nearest solid from `origin` along the unit direction `way`, in world axes.
Meeting meet_scene(vec3 origin, vec3 way) {
  Meeting nearest = Meeting(FAR, NOTHING, vec3(0.0), vec3(0.0));
#ifndef FLOOR_NONE
  float t = (floor_plane.x - origin.y) / way.y;
  if (way.y < 0.0) nearest = Meeting(max(t, 0.0), FLOOR, vec3(0.0, 1.0, 0.0), vec3(0.0));
#endif
#ifdef BODIES
#if BOXES
  MEET_BODIES(0, body_end[0], meet_box)
#endif
#if BALLS
  MEET_BODIES(body_end[0], body_end[1], meet_sphere)
#endif
#if CYLINDERS
  MEET_BODIES(body_end[1], body_end[2], meet_cylinder)
#endif
#if CAPSULES
  MEET_BODIES(body_end[2], body_end[3], meet_capsule)
#endif
#if STAIRS
  MEET_BODIES(body_end[3], body_end[4], meet_stairs)
#endif
#if MESHES
  for (int i = body_end[4]; i < body_end[5]; ++i) {
    if (!LEFT_OUT(i)) meet_mesh(origin, way, vec4(bodies[i].position.xyz, bodies[i].half_size.x), nearest);
  }
#endif
#endif
  return nearest;
}

float pixel_at(float path) {
  return 2.0 * lens.y / lens.w * path; // metres across a pixel
}

// What it sends back along the ray; `across`: metres across the ray that a pixel covers there.
vec3 light_from(vec3 origin, vec3 way, Meeting meeting, float across) {
  vec3 light = sky(way);
  if (meeting.what == NOTHING) return light;
  vec3 p = origin + way * meeting.t;
#ifndef FLOOR_NONE
  if (meeting.what == FLOOR) light = floor_light(p, way, across);
#endif
#ifdef BODIES
  if (meeting.what == BODY) light = meeting.colour * solid_light(p, meeting.normal);
  if (meeting.what == PICTURE) light = meeting.colour;
#endif
  return light;
}

// The container's edges, as a ray sees them that leaves the container from within.
vec3 past_edges(vec3 origin, vec3 way, float end, float path, vec3 light) {
#if defined(BOX_EDGES)
  vec3 inverse_way = 1.0 / mix(way, vec3(1e-9), lessThan(abs(way), vec3(1e-9)));
  vec3 ends = max((container_min.xyz - origin) * inverse_way, (container_max.xyz - origin) * inverse_way);
  float t = min(ends.x, min(ends.y, ends.z));
  bool inside = all(greaterThan(origin, container_min.xyz - 1e-3)) && all(lessThan(origin, container_max.xyz + 1e-3));
  vec3 from = abs(min(origin + way * t - container_min.xyz, container_max.xyz - origin - way * t));
  float nearest = min(max(from.x, from.y), min(max(from.y, from.z), max(from.x, from.z)));
#ifdef DRAWN
  float pixel = pixel_at(path + t), half_width = DRAWN_EDGE * drawn_levels.w * pixel, opacity = 1.0;
  vec3 edge = drawn_ink.rgb;
#else
  float pixel = pixel_at(path + t), half_width = max(0.0016 * container_max.w * 0.5, 0.7 * pixel), opacity = 0.55;
  vec3 edge = sky_average(vec3(0.0, 1.0, 0.0)) + sun_colour.rgb * 0.3;
#endif
  // A curved or grazed surface shows more of the wall in a pixel: there the line is wider and fainter.
  float footprint = clamp(fwidth(nearest), pixel, 16.0 * pixel), half_shown = max(half_width, 0.7 * footprint);
  float coverage = inside && t <= end + 1e-3 ? clamp((half_shown - nearest) / footprint + 0.5, 0.0, 1.0) : 0.0;
  coverage *= half_width / half_shown;
  return mix(light, edge, coverage * opacity);
#else
  return light;
#endif
}
