// The floor of a drawing: tiles of one colour with thin lines, which end before they crowd, one flat shadow, and three steps
// from there to the colour of the horizon. Include it after frame.glsl, sky.glsl and sun.glsl.
#include "drawn_shadow.glsl"

// The part of [a, b] that lies on lines, where each tile begins and ends with half of one (all in tiles).
vec2 lines_between(vec2 a, vec2 b, vec2 width) {
  a += 0.5 * width;
  b += 0.5 * width;
  vec2 up_to_a = floor(a) * width + min(fract(a), width), up_to_b = floor(b) * width + min(fract(b), width);
  return (up_to_b - up_to_a) / (b - a);
}

vec3 floor_light(vec3 p, vec3 way, float across) {
  float slant = 1.0 / max(abs(way.y), 1e-6);
  vec2 stretch = abs(way.xz) * (slant - 1.0) + 1.0;
  vec2 at = p.xz / floor_plane.y, footprint = max(across / floor_plane.y * stretch, 1e-4);
  vec2 on_line = lines_between(at - 0.5 * footprint, at + 0.5 * footprint, vec2(0.03));
  on_line *= 1.0 - smoothstep(0.1, 0.3, footprint);
  vec3 colour = mix(drawn_floor[0].rgb, drawn_floor[1].rgb, max(on_line.x, on_line.y));

  float along = across * slant;
  vec2 ahead = way.xz / max(length(way.xz), 1e-6);
  float past_water = drawn_past_water(p, across * vec3(-ahead.y, 0.0, ahead.x), along * vec3(ahead.x, 0.0, ahead.y));
  float sunlit = min(drawn_past_solids(p, sqrt(across * along)), past_water);
  colour *= mix(vec3(1.0), drawn_shade.rgb, sun_direction.w * (1.0 - sunlit));

  float reach = length(p.xz - eye.xz), step_length = 0.2 * floor_plane.z;
  float soft = min(along, 0.25 * reach + 1e-6); // at the horizon a pixel reaches for ever
  vec3 steps = clamp((reach - vec3(1.0, 2.0, 4.0) * step_length) / soft + 0.5, 0.0, 1.0);
  return mix(colour, drawn_sky[2].rgb, dot(steps, vec3(1.0 / 3.0)));
}
