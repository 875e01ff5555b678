// Light from the iso-surface (Xiao, Zhang, Yang 2017, section 3.4): the sky and the scene in it, and what comes through it
// along one refracted ray, which water takes away on a way as long as the water is thick (van der Laan, Green, Sainz 2009).
// METAL: a liquid that mirrors all of it. WITHIN: the eye may be in the water.
// A side wall with water on it mirrors that ray beyond the critical angle, or the edges of a tank would fade.
#include "frame.glsl"
#define TILES 32
#include "screen.glsl"

#ifdef FRAGMENT_STAGE
layout(std140, binding = 1) uniform Params {
  ivec4 ends[2];        // of the bodies of each shape
  vec4 optics;          // refractive index, spacing of particles, m; -
};
#define body_end int[6](ends[0].x, ends[0].y, ends[0].z, ends[0].w, ends[1].x, ends[1].y)
layout(binding = 8) uniform sampler2D background; // linear light, depth
#include "scene.glsl"
#include "scene_light.glsl"
#include "container.glsl"

layout(binding = 0) uniform sampler2D normals;    // outward unit normal, depth
layout(binding = 1) uniform sampler2D colours;    // of the water, linear
layout(binding = 2) uniform sampler2D thickness;  // metres of water along the ray, of all bodies
layout(binding = 3) uniform sampler2D behind;     // metres of water behind a surface, as far as they were followed, its depth
layout(location = 0) out vec4 result;

const float DEEP = 8.0; // spacings, also in raycast_behind.glsl

// Metres of water behind the surface at a depth: those that rays close by were followed for, of the same surface. Where there
// is more water than that, or none close by, what the particles add up to on the ray. `wet`: there is water at the side wall ahead.
float metres_behind(float depth, out bool wet) {
  vec2 at = gl_FragCoord.xy * 0.5 - 0.5, share = fract(at);
  float sum = 0.0, weights = 0.0, at_wall = 0.0, splatted = textureLod(thickness, place * 0.5 + 0.5, 0.0).r;
  for (int k = 0; k < 4; ++k) {
    ivec2 tap = clamp(ivec2(floor(at)) + ivec2(k & 1, k >> 1), ivec2(0), textureSize(behind, 0) - 1);
    vec2 there = texelFetch(behind, tap, 0).xy, near = mix(1.0 - share, share, vec2(k & 1, k >> 1));
    float w = (near.x * near.y + 1e-3) * max(1.0 - abs(there.y - depth) / (2.0 * optics.y), 0.0);
    sum += w * abs(there.x);
    at_wall += there.x < 0.0 ? w : 0.0;
    weights += w;
  }
  wet = at_wall > 0.5 * weights;
  if (weights <= 0.0) return min(splatted, DEEP * optics.y);
  float metres = sum / weights;
  return metres > 0.999 * DEEP * optics.y ? max(metres, splatted) : metres;
}

// What is left of light on t metres of water, and what the water itself sends back there.
vec3 through_water(vec3 light, float t, vec3 p, vec3 normal, vec3 tint) {
  vec3 extinction = max(absorption.rgb + scattering.rgb, 1e-6);
  vec3 left = exp(-extinction * t);
  SunLight sunlit = sun_light(p);
  // Clear water sends light back from all of its depth, liquids that scatter much from a matt skin.
  float facing = dot(normal, sun_direction.xyz), skin = 1.0 - exp(-optics.y * scattering.g);
  float lit = mix(0.09 + 0.09 * facing, max(facing, 0.0) / PI, skin);
  vec3 source = sun_colour.rgb * sunlit.direct * lit + sky_average(normal) * sunlit.diffuse * 0.9;
  return tint * (light * left + scattering.rgb / extinction * (1.0 - left) * source);
}

// The light of the scene along a ray in the water, `path` metres from the eye; `mirrors`: the wall that it meets does. t: its way.
vec3 scene_through(vec3 p, vec3 way, float path, bool mirrors, out float t) {
  Meeting meeting = meet_scene(p, way);
  float wall = room_from(p, way).y;
  t = 0.0;
  float at_wall = wall + 1e-4 * container_max.w; // a solid flush with the wall is met, not the wall
  for (int i = 0; i < int(mirrors && meeting.t > at_wall); ++i) {
    t = wall;
    p += way * wall;
    way = reflect(way, wall_normal(p));
    meeting = meet_scene(p, way);
  }
  path += t;
  t += meeting.t;
  return past_edges(p, way, meeting.t, path, light_from(p, way, meeting, pixel_at(path + min(meeting.t, 1e4))));
}

#ifdef METAL
// Nothing goes in.
vec3 light_of(vec3 p, vec3 way, vec3 normal, float depth, float path) {
  float x = 1.0 - clamp(-dot(normal, way), 0.0, 1.0), x2 = x * x;
  vec3 mirrored = reflect(way, normal), share = reflectance.rgb + (1.0 - reflectance.rgb) * x2 * x2 * x;
  return share * (scene_light(p, mirrored, path) + sun_mirrored(p, mirrored));
}
#else
vec3 from_outside(vec3 p, vec3 way, vec3 normal, float depth, float path, vec3 colour) {
  bool wet;
  float metres = metres_behind(depth, wet), t;
  vec3 tint = mix(vec3(1.0), colour, 1.0 - exp(-metres / (0.5 * optics.y)));
  vec3 mirrored = reflect(way, normal), bent = refract(way, normal, 1.0 / optics.x);
  float wall = room_from(p, bent).y;
  bool mirrors = wet && mirrored_by_wall(p + bent * wall, bent, optics.x);
  metres = mirrors ? metres : min(metres, wall);
  vec3 behind = scene_through(p, bent, path, mirrors, t);
  vec3 inside = through_water(behind, min(t, metres), p, texelFetch(normals, ivec2(gl_FragCoord.xy), 0).xyz, tint);
  return mix(inside, scene_light(p, mirrored, path) + sun_mirrored(p, mirrored), schlick(-dot(normal, way)));
}

#ifdef WITHIN
const vec3 UP = vec3(0.0, 1.0, 0.0);

// A solid in the water; or out into the air and, beyond the critical angle, mirrored.
vec3 from_within(vec3 p, vec3 way, vec3 normal, float depth, float path, vec3 colour) {
  vec4 solid = texelFetch(background, ivec2(gl_FragCoord.xy), 0);
  if (solid.a > 0.0 && depth > 0.999 * solid.a) return through_water(solid.rgb, path, p, UP, colour);
  vec3 mirrored = reflect(way, normal), bent = refract(way, normal, optics.x);
  float mirror = bent == vec3(0.0) ? 1.0 : schlick(-dot(bent, normal)), down;
  vec3 out_there = bent == vec3(0.0) ? vec3(0.0) : scene_light(p, bent, path);
  vec3 mirrored_light = scene_through(p, mirrored, path, false, down);
  vec3 light = out_there * (1.0 - mirror) + mirror * through_water(mirrored_light, min(down, 4.0 * path), p, UP, vec3(1.0));
  return through_water(light, path, p, UP, colour);
}
#endif

vec3 light_of(vec3 p, vec3 way, vec3 normal, float depth, float path) {
  vec3 colour = texelFetch(colours, ivec2(gl_FragCoord.xy), 0).rgb;
#ifdef WITHIN
  if (depth < 0.0) return from_within(p, way, normal, -depth, path, colour);
#endif
  return from_outside(p, way, normal, depth, path, colour);
}
#endif

void main() {
  vec4 s = texelFetch(normals, ivec2(gl_FragCoord.xy), 0);
  if (s.w == 0.0) discard; // the background shows
  vec3 ray = to_world(view_ray(place)), way = normalize(ray);
  vec3 normal = facing_eye(s.w > 0.0 ? s.xyz : -s.xyz, way);
  result = vec4(light_of(eye.xyz + ray * abs(s.w), way, normal, s.w, length(ray) * abs(s.w)), 1.0);
}
#endif
