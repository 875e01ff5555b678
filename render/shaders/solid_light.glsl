// Light that a matt white surface with a unit normal sends to the eye; in a drawing, what is left of its colour.
#include "sky.glsl"
#include "sun.glsl"

#ifdef DRAWN
#include "drawn.glsl"
#include "drawn_shadow.glsl"

// Three flat tones: a colour itself, what shadow leaves of it, and one between; a cast shadow is the darkest.
vec3 solid_light(vec3 p, vec3 normal) {
  int region = region_of_light(level_of_light(dot(normal, sun_direction.xyz) * sun_direction.w));
  vec3 tone = region == BRIGHT ? vec3(1.0) : region == MEDIUM ? sqrt(drawn_shade.rgb) : drawn_shade.rgb;
  float across = 2.0 * lens.y / lens.w * distance(p, eye.xyz);
  return mix(drawn_shade.rgb, tone, drawn_past_solids(clear_of_solid(p, normal), across));
}
#else
vec3 solid_light(vec3 p, vec3 normal) {
  SunLight sunlit = sun_light_on(p, normal);
  float facing = max(dot(normal, sunlit.way), 0.0);
  return sun_colour.rgb * facing / PI * sunlit.direct * sunlit.focus + sky_average(normal) * sunlit.diffuse;
}
#endif
