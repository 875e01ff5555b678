// A place on a line for every pixel beside one. A silhouette's belongs to the pixels on either side; it lies on the line
// that runs evenly through the staircase of pixels (Reshetov, "Morphological Antialiasing", 2009).
// Result: the way from the pixel to the place, pixels; the inverse depth there, negative for a crease, 0 for no place; the
// angle of the way out of the nearer thing.
#include "frame.glsl"
#include "screen.glsl"

#ifdef FRAGMENT_STAGE
layout(binding = 0) uniform sampler2D surface;
layout(binding = 1) uniform sampler2D cracks; // of outline_cracks.glsl
layout(location = 0) out vec4 result;

const int LONGEST = 10; // pixels of a stair that are followed to either side

vec4 cracks_at(ivec2 at) {
  bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(lens.zw)));
  return inside ? texelFetch(cracks, at, 0) : vec4(0.0);
}

// Inverse depth of the neighbour along `way` where that stands before the pixel, else 0.
float nearer_along(ivec2 at, ivec2 way) {
  bool ahead = way.x + way.y > 0;
  vec4 crack = cracks_at(ahead ? at : at + way);
  float silhouette = way.x != 0 ? crack.x : crack.y;
  return max(ahead ? -silhouette : silhouette, 0.0);
}

// Length of the stair to one side, and how it ends: 1 the nearer thing grows there, -1 it shrinks, 0 neither.
ivec2 stair(ivec2 at, ivec2 way, ivec2 aside) {
  for (int k = 1; k <= LONGEST; ++k) {
    ivec2 next = at + k * aside;
    if (nearer_along(next, way) > 0.0) continue;
    bool grows = nearer_along(next - aside, aside) > 0.0, shrinks = nearer_along(next + way, -aside) > 0.0;
    return ivec2(k, grows ? 1 : shrinks ? -1 : 0);
  }
  return ivec2(LONGEST + 1, 0);
}

// From the pixel's middle to the silhouette along `way`: half a pixel where it is straight.
float distance_along(ivec2 at, ivec2 way) {
  ivec2 up = stair(at, way, abs(way.yx)), down = stair(at, way, -abs(way.yx));
  float middle = 0.5 * float(up.x + down.x - 1);
  vec2 share = max(1.0 - (vec2(up.x, down.x) - 0.5) / middle, 0.0);
  return 0.5 - 0.5 * dot(vec2(up.y, down.y), share);
}

// Along an axis: how far the nearest silhouette is, on which side (1, -1), the inverse depth of what is nearer, and the way
// out of it (1, -1, 0). `side` 1: of what stands before the pixel; -1: of what the pixel itself is on.
vec4 nearest_along(ivec2 at, ivec2 axis, float side) {
  bool before = side > 0.0;
  float ahead = before ? nearer_along(at, axis) : nearer_along(at + axis, -axis);
  float behind = before ? nearer_along(at, -axis) : nearer_along(at - axis, axis);
  float to_ahead = FAR, to_behind = FAR;
  if (ahead > 0.0) to_ahead = before ? distance_along(at, axis) : 1.0 - distance_along(at + axis, -axis);
  if (behind > 0.0) to_behind = before ? distance_along(at, -axis) : 1.0 - distance_along(at - axis, axis);
  float outwards = side * (sign(behind) - sign(ahead));
  return vec4(min(to_ahead, to_behind), to_ahead < to_behind ? 1.0 : -1.0, max(ahead, behind), outwards);
}

vec4 silhouette_seed(ivec2 at, float side) {
  vec4 x = nearest_along(at, ivec2(1, 0), side), y = nearest_along(at, ivec2(0, 1), side);
  // Where the line crosses both axes, its nearest place to the pixel's middle.
  vec2 along = vec2(x.x, y.x), foot = x.x < y.x ? vec2(x.x, 0.0) : vec2(0.0, y.x);
  if (max(x.x, y.x) < FAR) foot = along * along.yx * along.yx / max(dot(along, along), 1e-12);
  return vec4(foot * vec2(x.y, y.y), max(x.z, y.z), atan(y.w, x.w));
}

// The nearest crease whose place lies in this pixel's half of a crack.
vec4 crease_seed(ivec2 at) {
  vec4 here = cracks_at(at);
  vec4 places = vec4(here.z, here.w, cracks_at(at - ivec2(1, 0)).z, cracks_at(at - ivec2(0, 1)).w);
  vec4 ways = mix(vec4(FAR), abs(places - vec4(1.0, 1.0, 2.0, 2.0)), greaterThan(places, vec4(0.0)));
  float depth = texelFetch(surface, at, 0).a, way = min(min(ways.x, ways.y), min(ways.z, ways.w));
  if (way > 0.501 || depth <= 0.0) return vec4(0.0);
  vec2 to = way == ways.x ? vec2(way, 0) : way == ways.y ? vec2(0, way) : way == ways.z ? vec2(-way, 0) : vec2(0, -way);
  return vec4(to, -1.0 / depth, 0.0);
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 seed = silhouette_seed(at, 1.0);
  if (seed.z == 0.0) seed = silhouette_seed(at, -1.0);
  result = seed.z > 0.0 ? seed : crease_seed(at);
}
#endif
