// The water's surface as a height field: RenderHeightMap of height_map.h.
#include "pool.glsl"
#include "height_beyond.glsl"

vec2 height_place_of(vec2 xz) {
  return xz * height_place.xy + height_place.zw;
}

// Height (m), share of water and slopes over a place.
vec4 water_surface(vec2 xz) {
  return textureLod(height_surface, height_place_of(xz), 0.0);
}

// Unit normal of a surface, upwards.
vec3 water_normal(vec4 surface) {
  return normalize(vec3(-surface.z, 1.0, -surface.w));
}

// Is there water at a place? Not beyond the outermost nodes.
bool over_water(vec2 xz) {
  vec2 place = height_place_of(xz), rim = 0.499 / vec2(textureSize(height_surface, 0));
  bool within = all(greaterThanEqual(place, rim)) && all(lessThanEqual(place, 1.0 - rim));
  return within && water_surface(xz).y >= 0.5;
}
