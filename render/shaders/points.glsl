// The points style's picture: the sphere at each pixel as a bead of water. Light that comes through from behind is
// absorbed along the way, the water scatters some sunlight itself, and its surface mirrors sky and sun.
#include "frame.glsl"
#include "screen.glsl"

#ifdef FRAGMENT_STAGE
#include "sky.glsl"
#include "sun.glsl"

layout(binding = 0) uniform sampler2D surface;    // normal, depth
layout(binding = 1) uniform sampler2D tint;       // colour, spray
layout(binding = 2) uniform sampler2D thickness;  // metres of water along the ray
layout(binding = 3) uniform sampler2D background; // linear light, depth
layout(location = 0) out vec4 result;

const vec3 SCATTER = vec3(0.10, 0.55, 0.62); // scattering coefficient of the water, 1/m, at unit scale

// What lies behind, displaced a little by the surface's tilt.
vec3 behind(vec2 pixel, vec3 view_normal, float metres, float depth) {
  vec2 shift = -view_normal.xy * min(metres, 0.2) * 0.2 / depth / lens.xy * lens.zw * 0.5;
  vec4 bent = texelFetch(background, ivec2(clamp(pixel + shift, vec2(0.0), lens.zw - 1.0)), 0);
  bool in_front = bent.a > 0.0 && bent.a < depth;
  return in_front ? texelFetch(background, ivec2(pixel), 0).rgb : bent.rgb;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 s = texelFetch(surface, pixel, 0);
  if (s.w == 0.0) {
    result = vec4(texelFetch(background, pixel, 0).rgb, 1.0);
    return;
  }
  vec4 colour = texelFetch(tint, pixel, 0);
  float metres = textureLod(thickness, place * 0.5 + 0.5, 0.0).r;
  vec3 ray = to_world(view_ray(place));
  vec3 p = eye.xyz + ray * s.w;
  vec3 v = -normalize(ray), n = s.xyz;

  // Sunlight at the surface point, and what the water scatters of it towards the eye.
  vec3 sun = sun_colour.rgb * sun_light(p);
  vec3 ambient = sky_average(n);
  vec3 fade = exp(-absorption.rgb * metres);
  float wrap = 0.75 + 0.25 * dot(n, sun_direction.xyz);
  vec3 extinction = absorption.rgb + SCATTER;
  vec3 scattered = SCATTER / extinction * (1.0 - exp(-extinction * metres)) * (sun * 0.25 * wrap + ambient * 0.5);
  vec3 light = behind(gl_FragCoord.xy, mat3(world_to_view) * n, metres, s.w) * fade + scattered;
  light *= colour.rgb;

  // Froth: diffuse white.
  vec3 white = 0.9 * (sun * max(dot(n, sun_direction.xyz) * 0.5 + 0.5, 0.0) / PI + ambient);
  light = mix(light, white, 0.8 * colour.a);

  // Sky and sun in the surface.
  float facing = max(dot(n, v), 0.0);
  float fresnel = absorption.a + (1.0 - absorption.a) * pow(1.0 - facing, 5.0);
  vec3 mirrored = sky(reflect(-v, n));
  vec3 half_way = normalize(v + sun_direction.xyz);
  float glint = pow(max(dot(n, half_way), 0.0), 300.0) * 40.0;
  light = mix(light, mirrored, 0.6 * fresnel) + sun * fresnel * glint;
  result = vec4(light, 1.0);
}
#endif
