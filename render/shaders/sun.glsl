// How much sunlight reaches a point: shadows of obstacles, and what the water above it lets through. POOL: in the water of a
// height field, what its surface refracts (pool_light.glsl).
#ifdef WATER_SHADOW
layout(binding = 5) uniform sampler2D sun_normal; // of the water's smooth surface
layout(binding = 6) uniform sampler2D sun_water;  // thickness, height towards the sun, coverage, focus
#endif
#ifdef SOLID_SHADOW
layout(binding = 7) uniform sampler2D sun_solid;  // height of the nearest obstacle towards the sun
#endif

vec2 sun_place(vec3 p) {
  return vec2(dot(p, sun_u.xyz) + sun_u.w, dot(p, sun_v.xyz) + sun_v.w);
}

#include "past_solids.glsl"

float sun_past_solids(vec3 p) {
#ifdef SOLID_SHADOW
  vec2 size = vec2(textureSize(sun_solid, 0));
  float bias = 1.5 * max(sun_map.x / size.x, sun_map.y / size.y);
  return past_solids(sun_solid, sun_place(p), dot(p, sun_direction.xyz) + bias);
#else
  return 1.0;
#endif
}

// A little off the surface of a solid: there the filter's 4·4 texels, which reach 2.8 texels from the middle, see past the
// solid's own slope, however the sun grazes it.
vec3 clear_of_solid(vec3 p, vec3 normal) {
#ifdef SOLID_SHADOW
  float texel = max(sun_map.x, sun_map.y) / float(textureSize(sun_solid, 0).x);
  return p + normal * (2.8 * texel * length(cross(normal, sun_direction.xyz)));
#else
  return p;
#endif
}

struct SunLight {
  vec3 way;             // unit, towards where it comes from
  vec3 direct;          // share of the sunlight that reaches the point, without focus
  float focus;          // bundling of that light by the water's bumps
  vec3 diffuse;         // the same of the sky's light
  float path;           // metres of water between the point and the sun
  float below;          // metres below the water's smooth surface, along the sunlight; negative above it
};

// Light at a point in, below or beside the water. Besides absorbing, water scatters: its shadow is darker than its tint.
// Shadows of solids are looked up at `past_solids`.
SunLight sun_light_by_particles(vec3 p, vec3 past_solids) {
  SunLight light = SunLight(sun_direction.xyz, vec3(1.0), 1.0, vec3(1.0), 0.0, -FAR);
#ifdef WATER_SHADOW
  vec4 water = textureLod(sun_water, sun_place(p), 0.0);
  if (water.z > 0.0 && water.x > 0.0) {
    light.below = water.y - dot(p, sun_direction.xyz);
    light.path = clamp(light.below, 0.0, water.x);
    light.direct = exp(-(absorption.rgb + scattering.rgb) * light.path);
    light.focus = mix(1.0, water.w, light.path / water.x);
    light.diffuse = exp(-absorption.rgb * 0.7 * light.path);
  }
#endif
  light.direct *= sun_past_solids(past_solids);
  return light;
}

#include "pool_light.glsl"

// The same on a solid's surface with this outward normal, whose own slope casts no shadow on it.
SunLight sun_light_on(vec3 p, vec3 normal) {
  SunLight light = sun_light_by_particles(p, clear_of_solid(p, normal));
#ifdef POOL
  into_pool(p, normal, light);
#endif
  return light;
}

SunLight sun_light(vec3 p) {
  SunLight light = sun_light_by_particles(p, p);
#ifdef POOL
  into_pool(p, vec3(0.0), light);
#endif
  return light;
}
