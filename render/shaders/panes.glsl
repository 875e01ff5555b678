// The walls of the container that face the eye: glass, of which nothing is seen but a faint image of the sky and, on a
// round wall, upright gleams of the sun.
#include "frame.glsl"

#ifdef VERTEX_STAGE
out vec3 at;       // on the wall, m
out vec3 normal;   // outward

const vec2 CORNERS[6] = vec2[6](vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 0), vec2(1, 1), vec2(0, 1));

#ifdef GLASS
#include "glass.glsl"
const int PIECES = 96;

void main() {
  Glass glass = glass_of_container();
  vec2 corner = CORNERS[gl_VertexID % 6];
  float angle = mix(glass.front.x, glass.front.y, (float(gl_VertexID / 6) + corner.x) / float(PIECES));
  at = on_wall(glass, angle, mix(container_min.y, container_max.y, corner.y));
  normal = vec3(cos(angle), 0.0, sin(angle));
  gl_Position = project(to_view(at));
}
#else
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
#endif

#ifdef FRAGMENT_STAGE
#include "sky.glsl"
in vec3 at;
in vec3 normal;
layout(location = 0) out vec4 result; // premultiplied

#ifdef DRAWN
// Glass as it is drawn: two flat slanted gleams across an upper corner, or upright ones on a round wall.
const float GLEAM = 0.12;

float band(float x, float from, float to) {
  float soft = fwidth(x);
  return clamp((x - from) / soft + 0.5, 0.0, 1.0) * clamp((to - x) / soft + 0.5, 0.0, 1.0);
}

void main() {
#ifdef GLASS
  vec3 v = normalize(eye.xyz - at);
  float aside = normal.x * v.z - normal.z * v.x, height = (at.y - container_min.y) / (container_max.y - container_min.y);
  float gleam = (band(aside, 0.52, 0.66) + band(aside, 0.72, 0.76)) * band(height, 0.12, 0.86);
#else
  vec3 from_corner = at - vec3(container_min.x, container_max.y, container_min.z);
  float x = (from_corner.x + from_corner.z - from_corner.y) / (container_max.y - container_min.y);
  float gleam = band(x, 0.42, 0.62) + band(x, 0.70, 0.76);
#endif
  result = vec4(mix(drawn_sky[2].rgb, vec3(1.0), 0.5), 1.0) * (GLEAM * gleam);
}
#else
void main() {
  vec3 v = normalize(eye.xyz - at), n = normalize(normal);
  // Two surfaces of glass, n = 1.5.
  float facing = clamp(dot(v, n), 0.0, 1.0);
  float mirror = 0.025 + 0.4 * pow(1.0 - facing, 5.0);
  vec3 light = sky(reflect(-v, n)) * mirror;
#ifdef GLASS
  // Near its outlines light comes a longer way through the wall, which is then sea green.
  float tint = 1.0 - exp(-0.035 / max(facing, 0.04));
  light += vec3(0.16, 0.34, 0.33) * tint;
  mirror += tint;
  // An upright wall mirrors the sun downwards, past an eye above; what gleams is the roundness of its two surfaces, all
  // along the line where, seen from above, it would mirror the sun. Of each surface a streak, fading towards the foot.
  vec2 half_way = normalize(normalize(v.xz) + normalize(sun_direction.xz + vec2(1e-6, 0.0)));
  float aside = half_way.x * n.z - half_way.y * n.x; // sine of the angle from that line
  float height = clamp((at.y - container_min.y) / (container_max.y - container_min.y), 0.0, 1.0);
  float streak = exp(-aside * aside * 9000.0) + 0.35 * exp(-(aside - 0.09) * (aside - 0.09) * 2500.0);
  light += sun_colour.rgb * 0.11 * streak * smoothstep(0.0, 0.35, height) * smoothstep(1.0, 0.93, height);
#endif
  result = vec4(light, mirror);
}
#endif
#endif
