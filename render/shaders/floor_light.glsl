// Light that the floor's point p sends back along the unit direction `way` in which a ray came to it; `across`: metres
// across the ray that a pixel covers there. Needs frame, sky and sun.
#ifdef FLOOR_CHECKER
vec3 floor_light(vec3 p, vec3 way, float across) {
  vec2 square = floor(p.xz / floor_plane.y);
  return floor_colour[int(mod(square.x + square.y, 2.0))].rgb;
}
#endif

#if defined(FLOOR_TILES) && defined(DRAWN)
#include "drawn_floor.glsl"
#elif defined(FLOOR_TILES)
// The part of [a, b] that lies in grout, where each tile begins with `width` of it (all in tiles).
vec2 grout_between(vec2 a, vec2 b, float width) {
  vec2 up_to_a = floor(a) * width + min(fract(a), width);
  vec2 up_to_b = floor(b) * width + min(fract(b), width);
  return (up_to_b - up_to_a) / (b - a);
}

float hash(vec2 p) {
  return fract(sin(dot(p, vec2(12.9898, 78.233))) * 43758.5453);
}

// Pale tiles, each a little different, with fine grout; filtered over the pixel's footprint on the floor.
vec3 floor_light(vec3 p, vec3 way, float across) {
  vec2 at = p.xz / floor_plane.y;
  float slant = 1.0 / max(abs(way.y), 1e-6);
  vec2 stretch = abs(way.xz) * (slant - 1.0) + 1.0;
  vec2 footprint = max(across / floor_plane.y * stretch, 1e-4) * 1.2;
  vec2 grout = grout_between(at - 0.5 * footprint, at + 0.5 * footprint, 0.025);
  float in_grout = grout.x + grout.y - grout.x * grout.y;
  float flat_out = clamp(1.5 - max(footprint.x, footprint.y) * 2.0, 0.0, 1.0);
  float shade = 1.0 + (hash(floor(at)) - 0.5) * 0.12 * flat_out;
  vec3 albedo = mix(vec3(0.58, 0.53, 0.45) * shade, vec3(0.25, 0.23, 0.20), in_grout);
  SunLight sunlit = sun_light(p);
  vec3 sun = sun_colour.rgb * max(sunlit.way.y, 0.0) / PI * sunlit.direct * sunlit.focus;
  vec3 light = albedo * (sun + sky_average(vec3(0.0, 1.0, 0.0)) * sunlit.diffuse);
  float reach = length(p.xz - eye.xz) / floor_plane.z;
  float grazing = 1.0 - 1.0 / slant;
  vec3 haze = sky_at_horizon(normalize(vec3(way.x, 1e-30, way.z)));
  grazing *= grazing * grazing;
  light = mix(light, haze, 0.02 + 0.2 * grazing * grazing); // a little polished
  return mix(haze, light, exp(-reach * reach));
}
#endif
