// Where lines run: the cracks between a pixel and its neighbours to the right and above. Everything is decided by the inverse
// of the depth, which is affine on planes: what is before and behind a crack is continued as a plane up to it.
// Result: for both cracks, first whether it is a silhouette: the inverse depth of what is nearer, positive when that is this
// pixel, negative when it is the neighbour, 0: none. Then whether it is a crease: 1 + its place, from this pixel's middle (0)
// to the neighbour's (1); 0: none.
#include "frame.glsl"
#include "screen.glsl"

#ifdef FRAGMENT_STAGE
layout(binding = 0) uniform sampler2D surface;
layout(location = 0) out vec4 result;
#include "outline_surface.glsl"

float inverse_depth(ivec2 at) {
  float depth = texelFetch(surface, clamp(at, ivec2(0), ivec2(lens.zw) - 1), 0).a;
  return depth > 0.0 ? 1.0 / depth : 0.0;
}

// Normal of the plane with this inverse depth at a pixel and these changes of it from pixel to pixel, in view space.
vec3 plane_normal(ivec2 at, float inverse, vec2 change) {
  vec2 place = ((vec2(at) + 0.5) / lens.zw * 2.0 - 1.0) * lens.xy;
  vec2 slope = change * lens.zw / (2.0 * lens.xy);
  return normalize(vec3(slope, dot(slope, place) - inverse));
}

// Change of the inverse depth across a crack's direction, towards the side where the surface goes on most evenly.
float change_aside(ivec2 at, ivec2 aside, float inverse) {
  float up = inverse_depth(at + aside) - inverse, up2 = inverse_depth(at + 2 * aside) - inverse - up;
  float down = inverse - inverse_depth(at - aside), down2 = inverse - down - inverse_depth(at - 2 * aside);
  return abs(up2 - up) < abs(down2 - down) ? up : down;
}

vec3 normal_of_side(ivec2 at, ivec2 along, float inverse, float change) {
  float aside = change_aside(at, along.yx, inverse);
  return plane_normal(at, inverse, along.x == 1 ? vec2(change, aside) : vec2(aside, change));
}

#ifdef NORMALS
vec3 known_normal(ivec2 at) {
  return texelFetch(surface, at, 0).rgb;
}

// Change, from pixel to pixel, of the inverse depth of a plane with a normal in world axes.
float slope_along(ivec2 at, ivec2 along, float inverse, vec3 normal) {
  vec3 n = mat3(world_to_view) * normal;
  vec2 place = ((vec2(at) + 0.5) / lens.zw * 2.0 - 1.0) * lens.xy;
  return inverse * dot(n.xy, vec2(along) * 2.0 * lens.xy / lens.zw) / min(dot(n, vec3(place, -1.0)), -1e-6);
}
#endif

// The crack between b and c; a and d are the pixels before and behind. Is b nearer than the plane through c and d?
bool stands_before(float a, float b, float c, float d, float pixel) {
  float by = b - (2.0 * c - d), beyond = (2.0 * b - a) - c;
  if (c <= 0.0) return b > 0.0 && 2.0 * b - a > 0.5 * b; // before the sky, unless the floor's plane ends here
  if (d <= 0.0) return false; // what a single pixel before the sky is a part of cannot be told
  bool apart = beyond > 0.3 * by; // otherwise both planes meet within the crack
  bool wide = by > WIDE_GAP * pixel * b && b - c > 0.5 * by; // otherwise the step is in the next crack
  return b > 0.0 && by > GAP * pixel * b && (wide || apart);
}

// The crack between `at` and at + along: silhouette, crease.
vec2 crack(ivec2 at, ivec2 along) {
  float pixel = 2.0 * lens.y / lens.w;
  ivec2 last = at + 3 * along, first = at - 2 * along;
  if (any(lessThan(first, ivec2(0))) || any(greaterThanEqual(last, ivec2(lens.zw)))) return vec2(0.0);
  float z = inverse_depth(first), a = inverse_depth(at - along), b = inverse_depth(at);
  float c = inverse_depth(at + along), d = inverse_depth(at + 2 * along), e = inverse_depth(last);
  if (stands_before(a, b, c, d, pixel)) return vec2(b, 0.0);
  if (stands_before(d, c, b, a, pixel)) return vec2(-c, 0.0);

#ifdef NORMALS
  vec3 known_b = known_normal(at), known_c = known_normal(at + along);
  // Where water begins or ends on a solid neither stands before the other: the line lies on the solid, a hair before which
  // the water is taken to be.
  float touching = 1.0 + 16.0 * pixel;
  if (known_b != vec3(0.0) && known_c == vec3(0.0)) return vec2(b * touching, 0.0);
  if (known_c != vec3(0.0) && known_b == vec3(0.0)) return vec2(-c * touching, 0.0);
  if (known_b != vec3(0.0) && known_c != vec3(0.0)) {
    float beside = min(dot(known_normal(at - along), known_b), dot(known_c, known_normal(at + 2 * along)));
    float slope_b = slope_along(at, along, b, known_b), slope_c = slope_along(at + along, along, c, known_c);
    // Where the planes of those normals meet, if that is within the crack.
    float turn = slope_b - slope_c, meet = (c - slope_c - b) / (turn == 0.0 ? 1.0 : turn);
    meet = abs(meet - 0.5) < 0.49 ? meet : 0.5;
    return vec2(0.0, dot(known_b, known_c) < drawn_ink.a && beside > drawn_ink.a ? 1.0 + meet : 0.0);
  }
#endif
  // Both planes meet within the crack; they are seen beside it, and go on as planes, or end, on either side.
  bool seen = !stands_before(z, a, b, c, pixel) && !stands_before(c, b, a, z, pixel) && !stands_before(b, c, d, e, pixel) &&
              !stands_before(e, d, c, b, pixel);
  float bend_b = a - 2.0 * b + c, bend_c = b - 2.0 * c + d, bend = bend_b + bend_c;
  float before = abs(z - 2.0 * a + b), behind = abs(c - 2.0 * d + e), wide = WIDE_GAP * pixel * min(b, c);
  bool planes = (before < 0.25 * abs(bend) || before > wide) && (behind < 0.25 * abs(bend) || behind > wide);
  float place = bend_c / (bend == 0.0 ? 1.0 : bend);
  if (min(min(a, b), min(c, d)) <= 0.0 || abs(place - 0.5) > 0.55) return vec2(0.0);
  if (!seen || !planes || abs(bend) < least_bend(max(b, c))) return vec2(0.0);
  vec3 left = normal_of_side(at, along, b, b - a), right = normal_of_side(at + along, along, c, d - c);
  return vec2(0.0, dot(left, right) < drawn_ink.a ? 1.0 + clamp(place, 0.0, 1.0) : 0.0);
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec2 right = crack(at, ivec2(1, 0)), above = crack(at, ivec2(0, 1));
  result = vec4(right.x, above.x, right.y, above.y);
}
#endif
