// Sky and floor behind everything else.
#include "frame.glsl"
#include "screen.glsl"

#ifdef FRAGMENT_STAGE
#include "sky.glsl"
#include "sun.glsl"

layout(location = 0) out vec4 result; // linear light; depth along the view axis, 0 for the sky

#ifdef FLOOR_CHECKER
vec3 floor_light(vec3 p, float t) {
  vec2 square = floor(p.xz / floor_plane.y);
  return floor_colour[int(mod(square.x + square.y, 2.0))].rgb;
}
#endif

#ifdef FLOOR_TILES
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
vec3 floor_light(vec3 p, float t) {
  vec2 at = p.xz / floor_plane.y;
  vec3 ray = p - eye.xyz;
  float pixel = 2.0 * lens.y / lens.w * t / floor_plane.y;
  float slant = length(ray) / max(abs(ray.y), 1e-6);
  vec2 stretch = abs(ray.xz) / length(ray) * (slant - 1.0) + 1.0;
  vec2 footprint = max(pixel * stretch, 1e-4) * 1.2;
  vec2 grout = grout_between(at - 0.5 * footprint, at + 0.5 * footprint, 0.025);
  float in_grout = grout.x + grout.y - grout.x * grout.y;
  float flat_out = clamp(1.5 - max(footprint.x, footprint.y) * 2.0, 0.0, 1.0);
  float shade = 1.0 + (hash(floor(at)) - 0.5) * 0.12 * flat_out;
  vec3 albedo = mix(vec3(0.72, 0.64, 0.52) * shade, vec3(0.34, 0.30, 0.24), in_grout);
  SunLight sunlit = sun_light(p);
  vec3 sun = sun_colour.rgb * max(sun_direction.y, 0.0) / PI * sunlit.direct * sunlit.focus;
  vec3 light = albedo * (sun + sky_average(vec3(0.0, 1.0, 0.0)) * sunlit.diffuse);
  float reach = length(p.xz - eye.xz) / floor_plane.z;
  float grazing = 1.0 - 1.0 / slant;
  light = mix(light, sky(normalize(ray * vec3(1.0, -1.0, 1.0))), 0.02 + 0.25 * pow(grazing, 8.0)); // a little polished
  vec3 haze = sky(normalize(vec3(ray.x, 0.0, ray.z)));
  return mix(haze, light, exp(-reach * reach));
}
#endif

void main() {
  vec3 ray = to_world(view_ray(place));
#ifndef FLOOR_NONE
  float t = (floor_plane.x - eye.y) / ray.y;
  if (t > eye.w && t < FAR) {
    result = vec4(floor_light(eye.xyz + ray * t, t), t);
    gl_FragDepth = depth_of(t);
    return;
  }
#endif
  result = vec4(sky(normalize(ray)), 0.0);
  gl_FragDepth = 0.0;
}
#endif
