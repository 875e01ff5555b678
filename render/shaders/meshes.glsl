// Bodies made of triangles: their corners are drawn as they are. SUN: heights as seen from the sun; IN_WATER: of what lies
// below the level of the water. There the far side of a mesh that stands in the surface may be seen from within.
#include "frame.glsl"
#include "body.glsl"

layout(std140, binding = 1) uniform Which {
  ivec4 which;          // index of the body; –
};

#ifdef VERTEX_STAGE
layout(std430, binding = 1) readonly buffer Corners {
  float corners[];      // position (m) and unit normal of each corner, in the body's own axes
};
#ifdef SUN
noperspective out float height;
#ifdef IN_WATER
noperspective out float over_level;
#endif
#else
out vec3 normal;
#endif

void main() {
  Body body = bodies[which.x];
  int i = 6 * gl_VertexID;
  vec3 p = body.position.xyz + rotate(body.rotation, vec3(corners[i], corners[i + 1], corners[i + 2]));
#ifdef SUN
  vec2 uv = vec2(dot(p, sun_u.xyz) + sun_u.w, dot(p, sun_v.xyz) + sun_v.w);
  height = dot(p, sun_direction.xyz);
#ifdef IN_WATER
  over_level = p.y - sun_map.w;
#endif
  gl_Position = vec4(uv * 2.0 - 1.0, 0.0, 1.0);
#else
  normal = rotate(body.rotation, vec3(corners[i + 3], corners[i + 4], corners[i + 5]));
  gl_Position = project(to_view(p));
#endif
}
#endif

#ifdef FRAGMENT_STAGE
layout(location = 0) out vec4 result;

#ifdef SUN
noperspective in float height;
#ifdef IN_WATER
noperspective in float over_level;
#endif

void main() {
#ifdef IN_WATER
  if (over_level > 0.0) discard;
#endif
  result = vec4(height);
}
#else
#include "solid_light.glsl"
in vec3 normal;

void main() {
  float t = 1.0 / gl_FragCoord.w;
  if (t < eye.w) discard;
  vec3 p = eye.xyz + to_world(view_ray(gl_FragCoord.xy / lens.zw * 2.0 - 1.0)) * t;
  result = vec4(bodies[which.x].colour.rgb * solid_light(p, normalize(normal)), t);
}
#endif
#endif
