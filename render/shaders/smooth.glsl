// Antialiased edges and dither, which FLAT colours do without: the last pass. Where brightness changes sharply, the picture is
// blended along the edge (after Lottes, "FXAA", 2009: direction from the four diagonal neighbours, two and four taps along it).
#include "frame.glsl"
#include "screen.glsl"

#ifdef FRAGMENT_STAGE
#include "curve.glsl"
layout(binding = 0) uniform sampler2D toned;
layout(location = 0) out vec4 result;

float luma(vec3 c) {
  return dot(c, vec3(0.299, 0.587, 0.114));
}

vec3 antialiased(ivec2 pixel) {
  ivec2 last = ivec2(lens.zw) - 1;
  vec3 middle = texelFetch(toned, pixel, 0).rgb;
  float m = luma(middle);
  float nw = luma(texelFetch(toned, clamp(pixel + ivec2(-1, 1), ivec2(0), last), 0).rgb);
  float ne = luma(texelFetch(toned, clamp(pixel + ivec2(1, 1), ivec2(0), last), 0).rgb);
  float sw = luma(texelFetch(toned, clamp(pixel + ivec2(-1, -1), ivec2(0), last), 0).rgb);
  float se = luma(texelFetch(toned, clamp(pixel + ivec2(1, -1), ivec2(0), last), 0).rgb);
  float low = min(m, min(min(nw, ne), min(sw, se))), high = max(m, max(max(nw, ne), max(sw, se)));
  if (high - low < max(0.03, 0.1 * high)) return middle; // no edge here

#ifdef FLAT
  // A tone between two others is an edge that is smooth already, as lines are, which this would fray.
  vec4 corners = vec4(nw, ne, sw, se);
  vec4 off = min(corners - low, high - corners);
  float most_off = max(max(max(off.x, off.y), max(off.z, off.w)), min(m - low, high - m));
  if (most_off > 0.2 * (high - low)) return middle;
#endif
  vec2 direction = vec2((nw + ne) - (sw + se), (nw + sw) - (ne + se)); // across the gradient
  float shorten = 1.0 / (min(abs(direction.x), abs(direction.y)) + max(0.03125 * (nw + ne + sw + se), 0.0078));
  vec2 step_along = clamp(direction * shorten, vec2(-8.0), vec2(8.0)) / lens.zw;
  vec2 at = gl_FragCoord.xy / lens.zw;
  vec3 two = 0.5 * (textureLod(toned, at - step_along / 6.0, 0.0).rgb + textureLod(toned, at + step_along / 6.0, 0.0).rgb);
  vec3 four = 0.5 * two + 0.25 * (textureLod(toned, at - step_along * 0.5, 0.0).rgb +
                                  textureLod(toned, at + step_along * 0.5, 0.0).rgb);
  float brightness = luma(four);
  return brightness < low || brightness > high ? two : four;
}

void main() {
#ifdef FLAT
  result = vec4(antialiased(ivec2(gl_FragCoord.xy)), 1.0);
#else
  result = vec4(antialiased(ivec2(gl_FragCoord.xy)) + dither(uvec2(gl_FragCoord.xy)), 1.0);
#endif
}
#endif
