// The edges of the container as thin bright lines, antialiased by coverage. What lies on a wall that turns its outside to
// the eye is in front of the water, the rest is behind it; FRONT chooses. The open top has no wall.
// A tank has twelve straight edges. A GLASS has a rim, which shows how thick the wall is, and a foot, each cut at the two
// places where the line of sight grazes the wall, and there two upright outlines.
// DRAWN: lines of ink, of the same width however far they are.
#include "frame.glsl"
#ifdef DRAWN
#include "drawn.glsl"
#endif

#ifdef VERTEX_STAGE
noperspective out vec2 across; // distance from the line's middle, half its width; pixels
noperspective out float tone;

// A piece of a line between two points, and the way the line goes on at both; in view space.
struct Piece {
  vec3 a, b, way_a, way_b;
  float tone;           // brightness
  float overlap;        // past its ends, in half widths
  float width;          // as a share of the scene's size
  bool wanted;
};

#ifdef GLASS
#include "glass.glsl"
const int PIECES = 96; // of an arc

// Rim, the rim's inside and foot, then the outlines.
Piece piece(int i) {
  Glass glass = glass_of_container();
#ifdef FRONT
  vec2 arc = glass.front;
#else
  vec2 arc = vec2(glass.front.y, glass.front.x + 2.0 * PI);
#endif
  Piece piece;
  bool upright = i >= 3 * PIECES;
  bool on_rim = i < 2 * PIECES, inside = on_rim && i >= PIECES;
  if (inside) glass.radius *= INSIDE;
  float share = float(i % PIECES) / float(PIECES), next = share + 1.0 / float(PIECES);
  float from = upright ? (i == 3 * PIECES ? arc.x : arc.y) : mix(arc.x, arc.y, share);
  float to = upright ? from : mix(arc.x, arc.y, next);
  piece.a = to_view(on_wall(glass, from, on_rim ? container_max.y : container_min.y));
  piece.b = to_view(on_wall(glass, to, on_rim || upright ? container_max.y : container_min.y));
  mat3 turn = mat3(world_to_view);
  piece.way_a = upright ? turn * vec3(0.0, 1.0, 0.0) : turn * vec3(-sin(from), 0.0, cos(from));
  piece.way_b = upright ? piece.way_a : turn * vec3(-sin(to), 0.0, cos(to));
  piece.tone = inside ? 0.7 : on_rim ? 1.0 : upright ? 0.9 : 0.7;
  piece.overlap = upright ? 0.5 : 0.0;
  piece.width = 0.0023;
  piece.wanted = arc.y > arc.x;
#ifndef FRONT
  piece.wanted = piece.wanted && !upright;
#endif
  return piece;
}
#else
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

Piece piece(int i) {
  bool front = faces_eye(WALLS[i].x) || faces_eye(WALLS[i].y);
  vec3 a = to_view(corner(ENDS[i].x)), b = to_view(corner(ENDS[i].y));
#ifdef FRONT
  return Piece(a, b, b - a, b - a, i < 4 ? 0.55 : 1.0, 0.5, 0.0016, front);
#else
  return Piece(a, b, b - a, b - a, i < 4 ? 0.55 : 1.0, 0.5, 0.0016, !front);
#endif
}
#endif

vec2 screen(vec3 p) {
  return -p.xy / (p.z * lens.xy) * lens.zw * 0.5;
}

// The way the line goes on the screen; where it comes straight at the eye, the way of the piece.
vec2 way_on_screen(vec3 p, vec3 way, vec2 otherwise) {
  vec2 w = (way.xy * -p.z + p.xy * way.z) / lens.xy * lens.zw;
  return length(w) > 1e-4 * length(way) * length(p) * lens.w ? normalize(w) : otherwise;
}

void main() {
  Piece line = piece(gl_VertexID / 6);
  int v = gl_VertexID % 6;
  // Cut the line off a little in front of the eye.
  float near = max(eye.w, 0.01 * container_max.w);
  if (!line.wanted || (-line.a.z < near && -line.b.z < near)) {
    gl_Position = vec4(2.0, 2.0, 0.0, 1.0);
    return;
  }
  if (-line.a.z < near) line.a = mix(line.a, line.b, (-near - line.a.z) / (line.b.z - line.a.z));
  if (-line.b.z < near) line.b = mix(line.b, line.a, (-near - line.b.z) / (line.a.z - line.b.z));
  vec2 sa = screen(line.a), sb = screen(line.b);
  vec2 straight = distance(sa, sb) > 1e-3 ? normalize(sb - sa) : vec2(1.0, 0.0);
  bool at_b = v == 1 || v == 2 || v == 4;
  float side = v == 0 || v == 1 || v == 3 ? -1.0 : 1.0;
  vec3 p = at_b ? line.b : line.a;
  vec2 along = way_on_screen(p, at_b ? line.way_b : line.way_a, straight);
#ifdef DRAWN
  float half_width = DRAWN_EDGE * drawn_levels.w;
#else
  float half_width = clamp(line.width * container_max.w / -p.z / lens.y * 0.5 * lens.w, 0.7, 8.0);
#endif
  across = vec2(side * (half_width + 1.0), half_width);
  tone = line.tone;
  vec2 past_end = (at_b ? along : -along) * line.overlap * half_width;
  vec2 place = (at_b ? sb : sa) + across.x * vec2(-along.y, along.x) + past_end;
  // A little nearer than it is, so that the floor under it does not cut the line in half.
  gl_Position = vec4(place / (lens.zw * 0.5), 1.005 * depth_of(-p.z), 1.0);
}
#endif

#ifdef FRAGMENT_STAGE
#include "sky.glsl"
noperspective in vec2 across;
noperspective in float tone;
layout(location = 0) out vec4 result; // premultiplied

void main() {
#ifdef DRAWN
  float coverage = line_coverage(abs(across.x), across.y);
  result = vec4(drawn_ink.rgb * coverage, coverage);
#else
  float coverage = clamp(across.y + 0.5 - abs(across.x), 0.0, 1.0);
  // Glass gathers light along its middle and is sea green at its rims.
  float rim = min(abs(across.x) / across.y, 1.0);
  vec3 bright = sky_average(vec3(0.0, 1.0, 0.0)) + sun_colour.rgb * 0.3;
  vec3 light = mix(bright, vec3(0.10, 0.24, 0.24), rim * rim);
  float alpha = coverage * 0.85 * tone;
  result = vec4(light * alpha, alpha);
#endif
}
#endif
