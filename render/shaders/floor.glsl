// The floor: a plane without end.
#include "frame.glsl"

#ifdef VERTEX_STAGE
// Four triangles from the point of the plane nearest to the eye to points at infinity. They only choose the pixels, so
// that none above the horizon is worked on; the fragment stage meets its ray with the plane exactly.
void main() {
  const vec2 WAYS[4] = vec2[4](vec2(1, 0), vec2(0, 1), vec2(-1, 0), vec2(0, -1));
  int i = gl_VertexID % 3;
  vec2 way = WAYS[(gl_VertexID / 3 + i / 2) % 4];
  vec3 p = mat3(world_to_view) * (i == 0 ? vec3(0.0, floor_plane.x - eye.y, 0.0) : vec3(way.x, 0.0, way.y));
  gl_Position = project(p);
  if (i != 0) gl_Position.z = 0.0;
}
#endif

#ifdef FRAGMENT_STAGE
#include "sky.glsl"
#include "sun.glsl"

layout(location = 0) out vec4 result; // linear light; depth along the view axis

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
  vec3 albedo = mix(vec3(0.58, 0.53, 0.45) * shade, vec3(0.25, 0.23, 0.20), in_grout);
  SunLight sunlit = sun_light(p);
  vec3 sun = sun_colour.rgb * max(sun_direction.y, 0.0) / PI * sunlit.direct * sunlit.focus;
  vec3 light = albedo * (sun + sky_average(vec3(0.0, 1.0, 0.0)) * sunlit.diffuse);
  float reach = length(p.xz - eye.xz) / floor_plane.z;
  float grazing = 1.0 - 1.0 / slant;
  vec3 haze = sky_at_horizon(normalize(vec3(ray.x, 0.0, ray.z)));
  grazing *= grazing * grazing;
  light = mix(light, haze, 0.02 + 0.2 * grazing * grazing); // a little polished
  return mix(haze, light, exp(-reach * reach));
}
#endif

void main() {
  vec3 ray = to_world(view_ray(gl_FragCoord.xy / lens.zw * 2.0 - 1.0));
  float t = (floor_plane.x - eye.y) / ray.y;
  if (!(t > eye.w && t < FAR)) discard; // at the horizon
  result = vec4(floor_light(eye.xyz + ray * t, t), t);
  gl_FragDepth = depth_of(t);
}
#endif
