// Light from the water: what is mirrored and what is refracted, by Fresnel's equations (Cords 2007, section 2.5).
//
// SURFACE: pixels of the height field; objects in and over it are seen in their maps (MAPPED) or met by rays. SIDES: those of the
// container's walls, flat water through which rays meet everything. SUBMERGED: the eye is in the water.
#include "frame.glsl"
#ifndef SUBMERGED
#define TILES 32
#endif
#include "screen.glsl"

#ifdef FRAGMENT_STAGE
layout(std140, binding = 1) uniform Params {
  ivec4 ends[2];        // of the bodies of each shape
  vec4 spread;          // dispersion: the index of blue light less that of red; –
};
#define body_end int[6](ends[0].x, ends[0].y, ends[0].z, ends[0].w, ends[1].x, ends[1].y)
layout(binding = 0) uniform sampler2D surface;    // outward normal, depth
layout(binding = 8) uniform sampler2D background; // linear light, depth
#include "pool.glsl"
#include "height_map.glsl"
#ifdef MAPPED
layout(std430, binding = 5) readonly buffer Objects { int object_of_body[]; };
#endif
#include "scene.glsl"
#include "scene_light.glsl"
#include "container.glsl"
#include "fresnel.glsl"
#include "pool_water.glsl"
#include "water_colours.glsl"
#ifdef MAPPED
#include "plane_water.glsl"
#include "object_maps.glsl"
#endif
layout(location = 0) out vec4 result;

vec3 refracted_light(vec3 p, vec3 way, float path) {
  float metres;
  vec3 light = light_in_water(p, way, path, metres);
  float lit = lit_along(p, way, metres);
  light = tinted(through_water(light, metres, 1.0, lit), p.xz, 0, metres);
#ifdef MAPPED
  Seen seen = see_objects(p, way, metres, false);
  vec3 object = through_water(seen.light.rgb, seen.t, seen.light.a, lit);
  light = light * (1.0 - seen.light.a) + tinted(object, p.xz, 0, seen.t);
#endif
  return light;
}

vec3 reflected_light(vec3 p, vec3 way, float path) {
#ifndef SIDES
  way.y = abs(way.y); // a wave's back would mirror the water before it
#endif
  vec3 light = scene_light(p, way, path) + sun_mirrored(p, way);
#ifdef MAPPED
  Seen seen = see_objects(p, way, 4.0 * container_max.w, true);
  light = light * (1.0 - seen.light.a) + seen.light.rgb;
#endif
  return light;
}

// Into the water. Each colour is bent by its own index where there is dispersion.
vec3 bent_light(vec3 p, vec3 way, vec3 normal, float path) {
#ifdef DISPERSION
  vec3 light;
  for (int k = 0; k < 3; ++k) {
    float index = optics.x + spread.x * (0.5 * float(k) - 0.5);
    light[k] = refracted_light(p, refract(way, normal, 1.0 / index), path)[k];
  }
  return light;
#else
  return refracted_light(p, refract(way, normal, 1.0 / optics.x), path);
#endif
}

void main() {
  vec3 ray = to_world(view_ray(place)), way = normalize(ray);
#ifdef SUBMERGED
  float metres;
  vec3 light = light_in_water(eye.xyz, way, 0.0, metres);
  result = vec4(tinted(through_water(light, metres, 1.0, lit_along(eye.xyz, way, metres)), eye.xz, 0, metres), 1.0);
#else
  vec4 s = texelFetch(surface, ivec2(gl_FragCoord.xy), 0);
#ifdef SIDES
  if (s.w == 0.0 || s.y != 0.0) discard;
#else
  if (s.w == 0.0 || s.y == 0.0) discard;
#endif
  vec3 normal = facing_eye(s.xyz, way), p = eye.xyz + ray * s.w;
  float path = length(ray) * s.w, mirror = fresnel(-dot(normal, way), optics.x);
  result = vec4(mix(bent_light(p, way, normal, path), reflected_light(p, reflect(way, normal), path), mirror), 1.0);
#endif
}
#endif
