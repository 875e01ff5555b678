// How much sunlight reaches a point: shadows of obstacles, and what the water above it lets through.
#ifdef WATER_SHADOW
layout(binding = 6) uniform sampler2D sun_water; // thickness, height towards the sun, coverage, focus
#endif
#ifdef SOLID_SHADOW
layout(binding = 7) uniform sampler2D sun_solid; // height of the nearest obstacle towards the sun
#endif

vec2 sun_place(vec3 p) {
  return vec2(dot(p, sun_u.xyz) + sun_u.w, dot(p, sun_v.xyz) + sun_v.w);
}

// Metres of water between the point and the sun.
float sun_path(vec3 p) {
#ifdef WATER_SHADOW
  vec4 water = textureLod(sun_water, sun_place(p), 0.0);
  return water.z > 0.0 ? clamp(water.y - dot(p, sun_direction.xyz), 0.0, water.x) : 0.0;
#else
  return 0.0;
#endif
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

// Sunlight that reaches a point in or below the water, as a share of what falls on top.
vec3 sun_light(vec3 p) {
#ifdef WATER_SHADOW
  vec4 water = textureLod(sun_water, sun_place(p), 0.0);
  float path = water.z > 0.0 ? clamp(water.y - dot(p, sun_direction.xyz), 0.0, water.x) : 0.0;
  float below = water.z * smoothstep(0.0, 0.02 * container_max.w, path);
  vec3 light = exp(-absorption.rgb * path) * mix(1.0, water.w, below);
#else
  vec3 light = vec3(1.0);
#endif
  return light * sun_past_solids(p);
}
