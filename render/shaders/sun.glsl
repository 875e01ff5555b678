// How much sunlight reaches a point: shadows of obstacles, and what the water above it lets through.
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

// Percentage-closer filtering over 4·4 texels, with the fractional place as weights so that edges are smooth.
float sun_past_solids(vec3 p) {
#ifdef SOLID_SHADOW
  vec2 size = vec2(textureSize(sun_solid, 0));
  vec2 at = sun_place(p) * size - 0.5;
  vec2 f = fract(at);
  vec2 base = (floor(at) + 0.5) / size;
  float bias = 1.5 * max(sun_map.x / size.x, sun_map.y / size.y);
  float height = dot(p, sun_direction.xyz) + bias;
  vec4 a = vec4(lessThan(textureGather(sun_solid, base + vec2(-0.5, -0.5) / size), vec4(height)));
  vec4 b = vec4(lessThan(textureGather(sun_solid, base + vec2(1.5, -0.5) / size), vec4(height)));
  vec4 c = vec4(lessThan(textureGather(sun_solid, base + vec2(-0.5, 1.5) / size), vec4(height)));
  vec4 d = vec4(lessThan(textureGather(sun_solid, base + vec2(1.5, 1.5) / size), vec4(height)));
  // Rows of texels from bottom to top; gather's order is (0,1) (1,1) (1,0) (0,0).
  vec4 weight = vec4(1.0 - f.x, 1.0, 1.0, f.x);
  float sum = (1.0 - f.y) * dot(vec4(a.wz, b.wz), weight) + dot(vec4(a.xy, b.xy), weight) +
              dot(vec4(c.wz, d.wz), weight) + f.y * dot(vec4(c.xy, d.xy), weight);
  return sum / 9.0;
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
  vec3 direct;          // share of the sunlight that reaches the point, without focus
  float focus;          // bundling of that light by the water's bumps
  vec3 diffuse;         // the same of the sky's light
  float path;           // metres of water between the point and the sun
  float below;          // metres below the water's smooth surface, along the sunlight; negative above it
};

// Light at a point in, below or beside the water. Besides absorbing, water scatters: its shadow is darker than its tint.
// Shadows of solids are looked up at `past_solids`.
SunLight sun_light(vec3 p, vec3 past_solids) {
  SunLight light = SunLight(vec3(1.0), 1.0, vec3(1.0), 0.0, -FAR);
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

SunLight sun_light(vec3 p) {
  return sun_light(p, p);
}
