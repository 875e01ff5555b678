// The edges of the container as thin bright lines, antialiased by coverage. An edge is in front of the water when one of
// its walls turns its outside to the eye, else behind it; FRONT chooses. The open top has no wall.
#include "frame.glsl"

#ifdef VERTEX_STAGE
noperspective out vec2 across; // distance from the line's middle, half its width; pixels
noperspective out float tone;

// Walls: 0 −x, 1 +x, 2 −z, 3 +z. Edges 0–3 at the bottom, 4–7 at the top, 8–11 upright.
const ivec2 WALLS[12] = ivec2[12](ivec2(0, 0), ivec2(1, 1), ivec2(2, 2), ivec2(3, 3), ivec2(0, 0), ivec2(1, 1),
                                  ivec2(2, 2), ivec2(3, 3), ivec2(0, 2), ivec2(1, 2), ivec2(0, 3), ivec2(1, 3));
const ivec2 ENDS[12] = ivec2[12](ivec2(0, 4), ivec2(1, 5), ivec2(0, 1), ivec2(4, 5), ivec2(2, 6), ivec2(3, 7),
                                 ivec2(2, 3), ivec2(6, 7), ivec2(0, 2), ivec2(1, 3), ivec2(4, 6), ivec2(5, 7));

bool faces_eye(int wall) {
  int axis = wall < 2 ? 0 : 2;
  return (wall & 1) == 0 ? eye[axis] < container_min[axis] : eye[axis] > container_max[axis];
}

vec3 corner(int i) {
  return mix(container_min.xyz, container_max.xyz, vec3(i & 1, (i >> 1) & 1, (i >> 2) & 1));
}

void main() {
  int edge = gl_VertexID / 6, v = gl_VertexID % 6;
  bool front = faces_eye(WALLS[edge].x) || faces_eye(WALLS[edge].y);
#ifdef FRONT
  bool wanted = front;
#else
  bool wanted = !front;
#endif
  vec3 a = to_view(corner(ENDS[edge].x)), b = to_view(corner(ENDS[edge].y));
  // Cut the line off a little in front of the eye.
  float near = max(eye.w, 0.01 * container_max.w);
  if (!wanted || (-a.z < near && -b.z < near)) {
    gl_Position = vec4(2.0, 2.0, 0.0, 1.0);
    return;
  }
  if (-a.z < near) a = mix(a, b, (-near - a.z) / (b.z - a.z));
  if (-b.z < near) b = mix(b, a, (-near - b.z) / (a.z - b.z));
  vec4 pa = project(a), pb = project(b);
  vec2 sa = pa.xy / pa.w * lens.zw * 0.5, sb = pb.xy / pb.w * lens.zw * 0.5;
  vec2 along = distance(sa, sb) > 1e-3 ? normalize(sb - sa) : vec2(1.0, 0.0);
  bool at_b = v == 1 || v == 2 || v == 4;
  float side = v == 0 || v == 1 || v == 3 ? -1.0 : 1.0;
  vec4 p = at_b ? pb : pa;
  float half_width = clamp(0.0016 * container_max.w / p.w / lens.y * 0.5 * lens.w, 0.7, 8.0);
  across = vec2(side * (half_width + 1.0), half_width);
  tone = edge < 4 ? 0.55 : 1.0;
  vec2 place = (at_b ? sb : sa) + across.x * vec2(-along.y, along.x) + (at_b ? along : -along) * 0.5 * half_width;
  // A little nearer than it is, so that the floor under it does not cut the line in half.
  gl_Position = vec4(place / (lens.zw * 0.5), 1.005 * p.z / p.w, 1.0);
}
#endif

#ifdef FRAGMENT_STAGE
#include "sky.glsl"
noperspective in vec2 across;
noperspective in float tone;
layout(location = 0) out vec4 result; // premultiplied

void main() {
  float coverage = clamp(across.y + 0.5 - abs(across.x), 0.0, 1.0);
  // Glass gathers light along its middle and is sea green at its rims.
  float rim = min(abs(across.x) / across.y, 1.0);
  vec3 bright = sky_average(vec3(0.0, 1.0, 0.0)) + sun_colour.rgb * 0.3;
  vec3 light = mix(bright, vec3(0.10, 0.24, 0.24), rim * rim);
  float alpha = coverage * 0.85 * tone;
  result = vec4(light * alpha, alpha);
}
#endif
