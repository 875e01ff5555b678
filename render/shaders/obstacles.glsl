// Bodies of one SHAPE by ray casting: the box around each is drawn, and every pixel's ray is met with the shape inside.
// SUN: heights as seen from the sun; IN_WATER: of what lies below the level of the water. A program for each shape: a software
// rasteriser runs both sides of a branch.
#include "frame.glsl"
#include "body.glsl"

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
#include "solids.glsl"
flat in int index;

vec2 meet_world(vec3 origin, vec3 ray, float from, out vec3 normal) {
  Body body = bodies[index];
  vec4 back = vec4(-body.rotation.xyz, body.rotation.w);
  vec2 t = MEET(body, rotate(back, origin - body.position.xyz), rotate(back, ray), from, normal);
  normal = rotate(body.rotation, normal);
  return t;
}

layout(location = 0) out vec4 result;

#ifdef SUN
noperspective in vec3 start;

void main() {
  vec3 normal;
#ifdef IN_WATER
  float level = (sun_map.w - start.y) / sun_direction.y; // m towards the sun
  vec2 t = meet_world(start + sun_direction.xyz * level, -sun_direction.xyz, 0.0, normal);
  if (t.x > t.y || t.y < 0.0) discard;
  result = vec4(level - max(t.x, 0.0));
#else
  vec2 t = meet_world(start, -sun_direction.xyz, -FAR, normal);
  if (t.x > t.y) discard;
  result = vec4(-t.x);
#endif
}
#else
#include "solid_light.glsl"

void main() {
  vec3 ray = to_world(view_ray(gl_FragCoord.xy / lens.zw * 2.0 - 1.0));
  vec3 normal;
  vec2 t = meet_world(eye.xyz, ray, eye.w, normal);
  if (t.x > t.y || t.x < eye.w) discard; // missed, or the eye is inside
  result = vec4(bodies[index].colour.rgb * solid_light(eye.xyz + ray * t.x, normal), t.x);
  gl_FragDepth = depth_of(t.x);
}
#endif
#endif
