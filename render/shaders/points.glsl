// The points style's picture: the sphere at each pixel as a bead of water. Light that comes through from behind is
// absorbed along the way, the water scatters some sunlight itself, and its surface mirrors sky and sun.
#include "frame.glsl"
#define TILES 32
#include "screen.glsl"

#ifdef FRAGMENT_STAGE
#include "sky.glsl"
#include "sun.glsl"

layout(binding = 0) uniform sampler2D surface;    // normal, depth
layout(binding = 1) uniform sampler2D tint;       // colour, spray
layout(binding = 2) uniform sampler2D thickness;  // metres of water along the ray
layout(binding = 3) uniform sampler2D background; // linear light, depth
layout(location = 0) out vec4 result;

// What lies behind, displaced by the surface's tilt.
vec3 behind(vec3 n, float metres, float depth) {
  vec2 shift = -(mat3(world_to_view) * n).xy * 0.3 * min(metres, 0.15 * container_max.w) / depth / lens.xy;
  vec2 pixel = clamp(gl_FragCoord.xy + shift * lens.zw * 0.5, vec2(0.0), lens.zw - 1.0);
  vec4 bent = texelFetch(background, ivec2(pixel), 0);
  bool in_front = bent.a > 0.0 && bent.a < depth;
  return in_front ? texelFetch(background, ivec2(gl_FragCoord.xy), 0).rgb : bent.rgb;
}

// At the surface that the sun sees, its smooth relief evens out the beads.
vec3 smooth_normal(vec3 n, vec3 p, float share) {
#ifdef WATER_SHADOW
  vec3 relief = textureLod(sun_normal, sun_place(p), 0.0).xyz;
  return normalize(mix(n, relief, share));
#else
  return n;
#endif
}

void main() {
  vec4 s = texelFetch(surface, ivec2(gl_FragCoord.xy), 0);
  if (s.w == 0.0) discard; // the background shows
  vec4 colour = texelFetch(tint, ivec2(gl_FragCoord.xy), 0);
  float metres = textureLod(thickness, place * 0.5 + 0.5, 0.0).r;
  vec3 ray = to_world(view_ray(place));
  vec3 p = eye.xyz + ray * s.w;
  vec3 v = -normalize(ray);
  SunLight sunlit = sun_light(p);
  float on_top = 1.0 - smoothstep(0.015, 0.04, abs(sunlit.below) / container_max.w);
  vec3 n = smooth_normal(s.xyz, p, 0.8 * on_top);

  // What comes through, and what the water scatters of sun and sky on the way.
  vec3 extinction = max(absorption.rgb + scattering.rgb, 1e-6);
  // A drop bends what is behind it away at its rim, which therefore looks darker: that is what shows its outline.
  float rim = clamp(dot(s.xyz, v), 0.0, 1.0);
  vec3 through = mix(0.55, 0.95, smoothstep(0.0, 0.7, rim)) * exp(-extinction * metres);
  float bead = 0.85 + 0.15 * dot(s.xyz, sun_direction.xyz);
  vec3 source = sun_colour.rgb * sunlit.direct * mix(1.0, sunlit.focus, 0.25) * bead * 0.18 + sky_average(n) * sunlit.diffuse * 0.9;
  vec3 light = behind(n, metres, s.w) * through + scattering.rgb / extinction * (1.0 - through) * source;
  light *= colour.rgb;

  // Froth: white in sun and sky.
  float lit = max(0.5 + 0.5 * dot(s.xyz, sun_direction.xyz), 0.0);
  light = mix(light, 0.75 * (sun_colour.rgb * sunlit.direct * lit / PI + sky_average(n)), 0.4 * colour.a);

  // Sky and sun in the surface.
  float facing = clamp(dot(n, v), 0.0, 1.0);
  float fresnel = absorption.a + (1.0 - absorption.a) * pow(1.0 - facing, 5.0);
  vec3 mirrored = sky(reflect(-v, n));
  vec3 half_way = normalize(v + sun_direction.xyz);
  float smooth_or_drop = max(on_top * on_top * on_top, colour.a); // beads in a wall of water are not seen as drops
  float glint = smooth_or_drop * mix(8.0, 40.0, colour.a) * pow(clamp(dot(n, half_way), 0.0, 1.0), 300.0);
  light = mix(light, mirrored, fresnel) + sun_colour.rgb * sunlit.direct * fresnel * glint;
  result = vec4(light, 1.0);
}
#endif
