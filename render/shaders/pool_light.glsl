// Sunlight in the water of a height field: what the surface above a point refracts, absorbed on its way down. Cords 2007,
// section 2.4: traced caustics from the map of light, simple ones by Eq. 4. Included by sun.glsl.
#ifdef POOL
#include "height_map.glsl"
layout(binding = 4) uniform sampler2D caustic_light; // across the refracted sunlight, in the sun's
layout(binding = 9) uniform sampler2D caustic_solid; // height of what it sees first

// Is a place within the container's walls?
bool within_walls(vec2 xz) {
  vec2 place = height_place_of(xz), rim = 0.499 / vec2(textureSize(height_surface, 0));
  vec2 size = container_max.xz - container_min.xz;
  bool outside = caustic_walls.z > 0.0 && distance(xz, caustic_walls.xy) > 0.501 * min(size.x, size.y);
  return !outside && all(greaterThanEqual(place, rim)) && all(lessThanEqual(place, 1.0 - rim));
}

// Shadows of solids along the refracted sunlight. A point on a solid is lifted off its slope.
float caustic_past_solids(vec3 p, vec3 normal) {
#ifdef SOLID_SHADOW
  float texel = 1.0 / (min(length(caustic_u.xyz), length(caustic_v.xyz)) * float(textureSize(caustic_solid, 0).x));
  p += normal * (2.8 * texel * length(cross(normal, caustic_way.xyz)));
  vec2 place = vec2(dot(p, caustic_u.xyz) + caustic_u.w, dot(p, caustic_v.xyz) + caustic_v.w);
  return past_solids(caustic_solid, place, 1.5 * texel - dot(p, caustic_way.xyz));
#else
  return 1.0;
#endif
}

// Eq. 4 of a surface, for water between the lowest and the highest; where that is nearly the same, it counts as half way.
float simple_caustics(vec4 surface) {
  vec3 n = water_normal(surface);
  float range = max(height_range.y - height_range.x, 0.1 * height_range.z);
  float height = 0.5 + (surface.x - 0.5 * (height_range.x + height_range.y)) / range;
  float intensity = caustic_simple.x * height + caustic_simple.y * abs(n.x + n.z) + caustic_simple.z;
  return caustic_simple.w > 0.0 ? max(intensity, 0.0) : 1.0;
}

// Change the light at a point outside of the water to that within, where the point is in it. Where there is water on a part of
// the way only, as at its rim, the rest stays.
void into_pool(vec3 p, vec3 normal, inout SunLight light) {
  vec3 way = caustic_way.xyz;
  float height = water_surface(p.xz).x;
  if (!(within_walls(p.xz) && p.y < height)) return;
  vec4 surface = surface_beyond(p.xz - way.xz * ((height - p.y) / -way.y), height_place, height_slope, caustic_walls);
  float share = surface.y;
  vec2 place = vec2(dot(p, caustic_u.xyz) + caustic_u.w, dot(p, caustic_v.xyz) + caustic_v.w);
#ifdef UNTRACED
  vec2 entry = p.xz - way.xz * ((surface.x - p.y) / -way.y);
  vec3 sun = vec3(share * caustic_walls.w * sun_past_solids(vec3(entry.x, surface.x, entry.y)));
#else
  vec3 sun = textureLod(caustic_light, place, 0.0).rgb;
#endif
  float path = max(surface.x - max(p.y, min(container_min.y, surface.x)), 0.0) / -way.y;
  vec3 left = exp(-(absorption.rgb + scattering.rgb) * path);
  light.direct = sun * left * caustic_past_solids(p, normal) + light.direct * (1.0 - share);
  light.focus = mix(light.focus, simple_caustics(surface), share);
  light.diffuse = mix(light.diffuse, exp(-absorption.rgb * 0.7 * path), share);
  light.path = mix(light.path, path, share);
  light.below = path;
  light.way = normalize(mix(light.way, -way, share));
}
#endif
