// The drawn water's picture (Rocha Neto, Guimarães, Apolinário, Mello 2014, section III-D): a few flat tones, the scene behind
// where the water faces the eye, the scene before it where it is grazed, never quite both.
#include "frame.glsl"
#define TILES 32
#include "screen.glsl"

#ifdef FRAGMENT_STAGE
layout(binding = 0) uniform sampler2D body_surface;  // normal, depth
layout(binding = 1) uniform sampler2D body_map;      // -, -, -, cover
layout(binding = 2) uniform sampler2D drop_surface;
layout(binding = 3) uniform sampler2D drop_map;
layout(binding = 4) uniform sampler2D thickness;     // m
layout(binding = 8) uniform sampler2D background;    // linear light, depth
layout(binding = 9) uniform sampler2D inked;         // the same with its outlines
layout(binding = 10) uniform sampler2D raw;          // -, depth of the farthest back
layout(binding = 11) uniform sampler2D tint;         // COLOURED: linear colour times m, m
layout(std140, binding = 1) uniform Params {
  ivec4 ends[2];        // of the bodies of each shape
  vec4 water[3];        // C_f of the dark, the medium and the bright region
  vec4 splash[2];       // drops in the light, and away from it
  vec4 reflection;      // K_Rmax, K_Rmin; cosines between which reflection gives way to transparency
  vec4 transparency;    // K_Tmax, K_Tmin of Eq. 5; m of clear water; λ of Eq. 10
  vec4 particle;        // m, its radius
};
#define body_end int[6](ends[0].x, ends[0].y, ends[0].z, ends[0].w, ends[1].x, ends[1].y)
#include "drawn.glsl"
#include "container.glsl"
#include "scene.glsl"
#include "cartoon_layer.glsl"

layout(location = 0) out vec4 result;
layout(location = 1) out float tone;     // 1 to 3: dark, medium, bright water; 4, 5: drops in the light and away from it
layout(location = 2) out vec4 surface;   // normal, depth of what is seen of the water

// Eqs. 4 and 5: `most` where the cosine between normal and view is small, for reflection, `least` where it is large, and a
// cubic between.
float by_angle(float cosine, float grazed, float faced) {
  return mix(grazed, faced, smoothstep(reflection.z, reflection.w, cosine));
}

float brightness(vec3 colour) {
  return dot(colour, vec3(0.2126, 0.7152, 0.0722));
}

// C_f of a region. Water of a colour of its own is as bright in each region, beside the others, as water without.
vec3 paint(int region) {
  vec3 natural = water[region].rgb;
#ifdef COLOURED
  vec4 own = textureLod(tint, place * 0.5 + 0.5, 0.0);
  own.rgb = own.a > 0.0 ? own.rgb / own.a : vec3(1.0);
  float most = max(own.r, max(own.g, own.b)), least = min(own.r, min(own.g, own.b));
  float colourful = most > 0.0 ? 1.0 - least / most : 1.0; // white is no colour: it tints nothing
  vec3 painted = own.rgb * brightness(natural) / max(brightness(water[MEDIUM].rgb), 1e-6);
  return mix(natural * own.rgb, painted, colourful);
#else
  return natural;
#endif
}

float light_level(vec3 p, vec3 normal) {
  float in_sun = step(0.5, sun_past_solids(clear_of_solid(p, normal)));
  return level_of_light(dot(normal, sun_direction.xyz) * in_sun);
}

// Eq. 9: what is behind the water, displaced the more, the more water there is. What is in front of the water is not.
vec3 scene_behind(vec3 normal, float depth, float metres) {
  vec2 shift = (mat3(world_to_view) * normal).xy * metres * transparency.w; // Eq. 10
  vec2 at = gl_FragCoord.xy + shift / (depth * lens.xy) * 0.5 * lens.zw;
  ivec2 pixel = ivec2(clamp(at, vec2(0.0), lens.zw - 1.0));
  float there = texelFetch(background, pixel, 0).a;
  bool in_front = there > 0.0 && there < depth;
  return texelFetch(inked, in_front ? ivec2(gl_FragCoord.xy) : pixel, 0).rgb;
}

vec3 scene_before(vec3 p, vec3 way) {
  Meeting meeting = meet_scene(p, way);
  return light_from(p, way, meeting, pixel_at(distance(p, eye.xyz) + min(meeting.t, 1e4)));
}

vec3 water_light(Layer body, vec3 p, vec3 v, float metres, float level) {
  vec3 light = drawn_light(level) * paint(region_of_light(level));
  float facing = dot(body.normal, v);
#ifdef REFRACTION
  // Eq. 8. The print has F_r there; the share of the scene behind is the transparency F_t.
  float seen = exp(-metres / transparency.z) * by_angle(facing, transparency.y, transparency.x);
  light = mix(light, scene_behind(body.normal, body.depth, metres), seen);
#endif
#ifdef REFLECTION
  vec3 n = facing_eye(body.normal, -v);
  light += scene_before(p + n * particle.x, reflect(-v, n)) * by_angle(facing, reflection.x, reflection.y); // Eq. 3
#endif
  return light;
}

// The walls of the container cut the body off, which lies flat on them.
Layer cut_by_walls(Layer body, vec3 ray) {
#if defined(CLIP_BOX) || defined(CLIP_GLASS)
  vec2 inside = room(ray);
  float back = texelFetch(raw, ivec2(gl_FragCoord.xy / lens.zw * vec2(textureSize(raw, 0))), 0).y;
  bool wet = inside.x < min(inside.y, max(back, body.depth)) && body.depth < inside.y;
  if (!wet) body.cover = 0.0;
  if (body.depth < inside.x) {
    body.depth = inside.x;
    body.normal = wall_normal(eye.xyz + ray * inside.x);
  }
#endif
  return body;
}

void main() {
  vec3 ray = to_world(view_ray(place)), v = -normalize(ray);
  vec4 behind = texelFetch(background, ivec2(gl_FragCoord.xy), 0);
  // Where a solid stands flush with a wall on which water lies, the solid is seen.
  float solid = behind.a > 0.0 ? behind.a * (1.0 - 5e-4) : FAR;
  float metres = textureLod(thickness, place * 0.5 + 0.5, 0.0).r;
  vec3 light = behind.rgb;
  tone = 0.0;
  surface = vec4(0.0, 0.0, 0.0, behind.a);

#ifdef SUBMERGED
  // To an eye in the water its own colour would hide all: it is seen through four times as far.
  float level = level_of_light(sun_direction.y);
  light = mix(drawn_light(level) * paint(region_of_light(level)), texelFetch(inked, ivec2(gl_FragCoord.xy), 0).rgb,
              exp(-metres / (4.0 * transparency.z)));
  tone = 1.0 + float(region_of_light(level));
#else
  Layer body = cut_by_walls(layer_at(body_surface, body_map, 2.0 * particle.x), ray);
  if (body.depth >= solid) body.cover = 0.0;
  vec3 p = eye.xyz + ray * body.depth;
  float level = light_level(p, body.normal);
  if (body.cover > 0.0) light = mix(light, water_light(body, p, v, metres, level), body.cover);
  if (body.cover >= 0.5) {
    tone = 1.0 + float(region_of_light(level));
    surface = vec4(body.normal, body.depth);
  }
  Layer drop = layer_at(drop_surface, drop_map, 2.0 * particle.x);
  if (drop.depth >= solid || (body.cover >= 0.5 && drop.depth > body.depth)) drop.cover = 0.0;
  bool lit = region_of_light(light_level(eye.xyz + ray * drop.depth, drop.normal)) != DARK;
  light = mix(light, splash[lit ? 0 : 1].rgb, drop.cover);
  if (drop.cover >= 0.5) {
    tone = lit ? 4.0 : 5.0;
    surface = vec4(drop.normal, drop.depth);
  }
#endif
  result = vec4(light, 1.0);
}
#endif
