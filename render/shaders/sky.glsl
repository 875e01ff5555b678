// Light from the sky: radiance towards the eye from the unit direction d, and its average over a hemisphere.
#ifdef SKY_GRADIENT
vec3 sky(vec3 d) {
  return mix(sky_horizon.rgb, sky_zenith.rgb, max(0.0, d.y));
}

vec3 sky_at_horizon(vec3 d) {
  return sky_horizon.rgb;
}

vec3 sky_average(vec3 normal) {
  return mix(sky_horizon.rgb, sky_zenith.rgb, 0.25 + 0.25 * normal.y);
}
#elif defined(DRAWN)
#include "drawn_sky.glsl"
#else
const vec3 SKY_HORIZON = vec3(0.70, 0.82, 0.92);
const vec3 SKY_MIDDLE = vec3(0.17, 0.42, 0.84);
const vec3 SKY_ZENITH = vec3(0.05, 0.19, 0.56);

// A wide faint glow and a narrow bright one.
vec3 sun_glow(vec3 d) {
  float x = max(dot(d, sun_direction.xyz), 0.0);
  float x2 = x * x, x4 = x2 * x2, x16 = x4 * x4 * x4 * x4, x64 = x16 * x16 * x16 * x16;
  return sun_direction.w * (0.12 * x2 * x4 + 0.5 * x64 * x16) * vec3(1.0, 0.93, 0.80);
}

// A clear late morning: haze at the horizon, deep blue above, a glow around the sun.
vec3 sky(vec3 d) {
  float h = max(d.y, 0.0);
  vec3 blue = mix(SKY_MIDDLE, SKY_ZENITH, h);
  vec3 colour = mix(blue, SKY_HORIZON, exp(-14.0 * h));
  return colour + sun_glow(d);
}

vec3 sky_at_horizon(vec3 d) {
  return SKY_HORIZON + sun_glow(d);
}

vec3 sky_average(vec3 normal) {
  return mix(vec3(0.20, 0.20, 0.19), vec3(0.22, 0.29, 0.38), 0.5 + 0.5 * normal.y);
}
#endif
