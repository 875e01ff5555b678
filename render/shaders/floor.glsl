// The floor: a plane without end.
#include "frame.glsl"

#ifdef VERTEX_STAGE
// Four triangles from the point of the plane nearest to the eye to points at infinity. They only choose the pixels, so
// that none above the horizon is worked on; the fragment stage meets its ray with the plane exactly.
void main() {
  const vec2 WAYS[4] = vec2[4](vec2(1, 0), vec2(0, 1), vec2(-1, 0), vec2(0, -1));
  int i = gl_VertexID % 3;
  vec2 way = WAYS[(gl_VertexID / 3 + i / 2) % 4];
  vec3 p = mat3(world_to_view) * (i == 0 ? vec3(0.0, floor_plane.x - eye.y, 0.0) : vec3(way.x, 0.0, way.y));
  gl_Position = project(p);
  if (i != 0) gl_Position.z = 0.0;
}
#endif

#ifdef FRAGMENT_STAGE
#include "sky.glsl"
#include "sun.glsl"
#include "floor_light.glsl"

layout(location = 0) out vec4 result; // linear light; depth along the view axis

void main() {
  vec3 ray = to_world(view_ray(gl_FragCoord.xy / lens.zw * 2.0 - 1.0));
  float t = (floor_plane.x - eye.y) / ray.y;
  if (!(t > eye.w && t < FAR)) discard; // at the horizon
  result = vec4(floor_light(eye.xyz + ray * t, normalize(ray), 2.0 * lens.y / lens.w * t), t);
  gl_FragDepth = depth_of(t);
}
#endif
