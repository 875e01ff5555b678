// The walls of the container that face the eye: glass, of which nothing is seen but a faint image of the sky.
#include "frame.glsl"

#ifdef VERTEX_STAGE
out vec3 at;            // on the wall, m
flat out vec3 normal;   // outward

const vec2 CORNERS[6] = vec2[6](vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 0), vec2(1, 1), vec2(0, 1));

void main() {
  int wall = gl_VertexID / 6;
  vec2 corner = CORNERS[gl_VertexID % 6];
  int axis = wall < 2 ? 0 : 2;
  float high = float(wall & 1);
  bool faces_eye = high > 0.0 ? eye[axis] > container_max[axis] : eye[axis] < container_min[axis];
  vec3 share = axis == 0 ? vec3(high, corner.y, corner.x) : vec3(corner.x, corner.y, high);
  at = mix(container_min.xyz, container_max.xyz, share);
  normal = vec3(0.0);
  normal[axis] = high * 2.0 - 1.0;
  gl_Position = faces_eye ? project(to_view(at)) : vec4(2.0, 2.0, 0.0, 1.0);
}
#endif

#ifdef FRAGMENT_STAGE
#include "sky.glsl"
in vec3 at;
flat in vec3 normal;
layout(location = 0) out vec4 result; // premultiplied

void main() {
  vec3 v = normalize(eye.xyz - at);
  // Two surfaces of glass, n = 1.5.
  float facing = clamp(dot(v, normal), 0.0, 1.0);
  float mirror = 0.025 + 0.4 * pow(1.0 - facing, 5.0);
  result = vec4(sky(reflect(-v, normal)) * mirror, mirror);
}
#endif
