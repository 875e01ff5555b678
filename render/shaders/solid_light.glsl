// Light that a matt white surface with a unit normal sends to the eye.
#include "sky.glsl"
#include "sun.glsl"

vec3 solid_light(vec3 p, vec3 normal) {
  float facing = max(dot(normal, sun_direction.xyz), 0.0);
  SunLight sunlit = sun_light(p, clear_of_solid(p, normal));
  return sun_colour.rgb * facing / PI * sunlit.direct * sunlit.focus + sky_average(normal) * sunlit.diffuse;
}
