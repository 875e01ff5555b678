// The ink of outlines: every pixel looks for the place on a line that covers most of it, first along its row (ROWS), then
// along its column for what the rows have found.
#include "frame.glsl"
#include "screen.glsl"

#ifdef FRAGMENT_STAGE
layout(binding = 0) uniform sampler2D surface;
layout(binding = 1) uniform sampler2D places; // of outline_seeds.glsl, or of the rows
layout(location = 0) out vec4 result;

#ifdef ROWS
const ivec2 ALONG = ivec2(1, 0);
#else
const ivec2 ALONG = ivec2(0, 1);
#endif

// Rows choose for the columns' pixels, which are up or down where a silhouette's line lies: those at its border count.
vec2 to_pixels_meant(vec4 place) {
#ifdef ROWS
  return place.z > 0.0 ? vec2(0.0, max(drawn_levels.w - 1.0, 0.0) * sin(place.w)) : vec2(0.0);
#else
  return vec2(0.0);
#endif
}

bool on_its_side(vec4 place) {
  return dot(-place.xy, vec2(cos(place.w), sin(place.w))) > -1e-3;
}

// How far inside the line's border the pixel's middle is, pixels; `place` is seen from there. A silhouette's line reaches
// half a pixel into the nearer thing, to cover the stairs of its border; a crease's lies on both sides of it.
float inside_line(vec4 place) {
  float width = max(drawn_levels.w, 1.0);
  float reach = place.z < 0.0 ? 0.5 * width : on_its_side(place) ? width - 0.5 : 0.5;
  return place.z == 0.0 ? -FAR : reach - length(place.xy - to_pixels_meant(place));
}

// Lines lie on what is behind, never on something nearer.
bool may_lie(vec4 place, float inverse, float pixel) {
  return place.z < 0.0 ? inverse < -place.z * (1.0 + 16.0 * pixel)
                       : inverse < place.z * (1.0 - 2.0 * pixel) && on_its_side(place);
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), size = ivec2(lens.zw);
  float depth = texelFetch(surface, at, 0).a, inverse = depth > 0.0 ? 1.0 / depth : 0.0, pixel = 2.0 * lens.y / lens.w;
  int reach = int(ceil(drawn_levels.w + 0.5));
  vec4 best = texelFetch(places, at, 0);
  float most = inside_line(best);
  for (int k = -reach; k <= reach; ++k) {
    ivec2 there = at + k * ALONG;
    vec4 place = texelFetch(places, clamp(there, ivec2(0), size - 1), 0);
    place.xy += vec2(k * ALONG);
    float inside = all(greaterThanEqual(there, ivec2(0))) && all(lessThan(there, size)) ? inside_line(place) : -FAR;
    if (inside > most && may_lie(place, inverse, pixel)) {
      best = place;
      most = inside;
    }
  }
#ifdef ROWS
  result = best;
#else
  float ink = clamp(most + 0.5, 0.0, 1.0) * min(drawn_levels.w, 1.0);
  result = vec4(drawn_ink.rgb * ink, ink);
#endif
}
#endif
