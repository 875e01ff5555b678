// Boxes, spheres and cylinders by ray casting: the box around each is drawn, and every pixel's ray is met with the
// shape inside. SUN: heights as seen from the sun.
#include "frame.glsl"

struct Body {
  vec4 position;        // m; shape: 0 box, 1 sphere, 2 cylinder along y
  vec4 half_size;       // m, along its own axes
  vec4 rotation;        // quaternion
  vec4 colour;
};
layout(std430, binding = 0) readonly buffer Bodies { Body bodies[]; };

vec3 rotate(vec4 q, vec3 v) {
  return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v);
}

#ifdef VERTEX_STAGE
flat out int index;
#ifdef SUN
noperspective out vec3 start; // on the plane through the origin across the sunlight
#endif

const int CORNERS[36] = int[36](0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1,
                                4, 5, 7, 4, 7, 6);

void main() {
  index = gl_VertexID / 36;
  int corner = CORNERS[gl_VertexID % 36];
  vec3 side = vec3(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1) * 2.0 - 1.0;
  Body body = bodies[index];
  // A hair larger, so that the last pixel of the shape is not lost to rounding.
  vec3 p = body.position.xyz + rotate(body.rotation, 1.001 * side * body.half_size.xyz);
#ifdef SUN
  vec2 uv = vec2(dot(p, sun_u.xyz) + sun_u.w, dot(p, sun_v.xyz) + sun_v.w);
  start = p - sun_direction.xyz * dot(p, sun_direction.xyz);
  gl_Position = vec4(uv * 2.0 - 1.0, 0.0, 1.0);
#else
  gl_Position = project(to_view(p));
#endif
}
#endif

#ifdef FRAGMENT_STAGE
flat in int index;

// The two planes at ±size across one axis: entry and exit of the ray from o along d.
vec2 slab(float o, float d, float size) {
  float a = (-size - o) / d, b = (size - o) / d;
  if (d == 0.0) return abs(o) < size ? vec2(-FAR, FAR) : vec2(FAR, -FAR);
  return vec2(min(a, b), max(a, b));
}

// A circle or sphere of radius r around the origin; the foot of the perpendicular keeps it precise.
vec2 ball(vec3 o, vec3 d, float r) {
  float dd = dot(d, d);
  if (dd == 0.0) return dot(o, o) < r * r ? vec2(-FAR, FAR) : vec2(FAR, -FAR);
  float middle = -dot(o, d) / dd;
  vec3 foot = o + d * middle;
  float h2 = (r * r - dot(foot, foot)) / dd;
  return h2 > 0.0 ? vec2(middle - sqrt(h2), middle + sqrt(h2)) : vec2(FAR, -FAR);
}

// Entry and exit of a ray in the body's own axes, and the outward normal at the entry.
vec2 meet(Body body, vec3 o, vec3 d, out vec3 normal) {
  vec3 size = body.half_size.xyz;
  vec2 y = slab(o.y, d.y, size.y);
  if (body.position.w == 1.0) {
    vec2 t = ball(o, d, size.x);
    normal = (o + d * t.x) / size.x;
    return t;
  }
  if (body.position.w == 2.0) {
    vec2 t = ball(vec3(o.x, 0.0, o.z), vec3(d.x, 0.0, d.z), size.x);
    vec3 p = o + d * t.x;
    normal = y.x > t.x ? vec3(0.0, -sign(d.y), 0.0) : vec3(p.x, 0.0, p.z) / size.x;
    return vec2(max(t.x, y.x), min(t.y, y.y));
  }
  vec2 x = slab(o.x, d.x, size.x), z = slab(o.z, d.z, size.z);
  float enter = max(x.x, max(y.x, z.x));
  normal = enter == x.x ? vec3(-sign(d.x), 0, 0) : enter == y.x ? vec3(0, -sign(d.y), 0) : vec3(0, 0, -sign(d.z));
  return vec2(enter, min(x.y, min(y.y, z.y)));
}

vec2 meet_world(vec3 origin, vec3 ray, out vec3 normal) {
  Body body = bodies[index];
  vec4 back = vec4(-body.rotation.xyz, body.rotation.w);
  vec2 t = meet(body, rotate(back, origin - body.position.xyz), rotate(back, ray), normal);
  normal = rotate(body.rotation, normal);
  return t;
}

layout(location = 0) out vec4 result;

#ifdef SUN
noperspective in vec3 start;

void main() {
  vec3 normal;
  vec2 t = meet_world(start, -sun_direction.xyz, normal);
  if (t.x > t.y) discard;
  result = vec4(-t.x);
}
#else
#include "sky.glsl"
#include "sun.glsl"

void main() {
  vec3 ray = to_world(view_ray(gl_FragCoord.xy / lens.zw * 2.0 - 1.0));
  vec3 normal;
  vec2 t = meet_world(eye.xyz, ray, normal);
  if (t.x > t.y || t.x < eye.w) discard; // missed, or the eye is inside
  vec3 p = eye.xyz + ray * t.x;
  float facing = max(dot(normal, sun_direction.xyz), 0.0);
  SunLight sunlit = sun_light(p);
  vec3 light = sun_colour.rgb * facing / PI * sunlit.direct * sunlit.focus + sky_average(normal) * sunlit.diffuse;
  result = vec4(bodies[index].colour.rgb * light, t.x);
  gl_FragDepth = depth_of(t.x);
}
#endif
#endif
