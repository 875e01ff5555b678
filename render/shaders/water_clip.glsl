// Smoothed water ends at the walls of its container. Particles near a wall are drawn on its other side as well
// (quadrics.c), so that the surface goes on beyond it; here it is cut off, and lies flat on the glass.
#include "frame.glsl"
#define OUTPUTS 1 // 1 / depth of front and back; 0 where there is no water
#define FORMAT rg32f
#include "tile_pass.glsl"
#ifndef VERTEX_STAGE
#ifdef CLIP_GLASS
#include "glass.glsl"
#endif
layout(binding = 0) uniform sampler2D inverse_depths; // of front and back

// Depths between which the ray is in the container, whose top is open.
vec2 room(vec3 ray) {
  vec3 inverse_ray = 1.0 / mix(ray, vec3(1e-9), lessThan(abs(ray), vec3(1e-9)));
  vec3 a = (container_min.xyz - eye.xyz) * inverse_ray, b = (container_max.xyz - eye.xyz) * inverse_ray;
  vec3 low = min(a, b), high = max(a, b);
  vec2 y = vec2(ray.y < 0.0 ? -FAR : a.y, ray.y < 0.0 ? a.y : FAR);
#ifdef CLIP_GLASS
  Glass glass = glass_of_container();
  float radius = glass.radius * INSIDE, rr = dot(ray.xz, ray.xz);
  vec2 from = eye.xz - glass.centre;
  float middle = -dot(from, ray.xz) / max(rr, 1e-12);
  vec2 foot = from + ray.xz * middle;
  float h = sqrt(max((radius * radius - dot(foot, foot)) / max(rr, 1e-12), 0.0));
  return vec2(max(middle - h, y.x), min(middle + h, y.y));
#else
  return vec2(max(max(low.x, low.z), y.x), min(min(high.x, high.z), y.y));
#endif
}

void pass(ivec2 at) {
  vec2 w = texelFetch(inverse_depths, at, 0).xy;
  if (w.x > 0.0) {
    vec2 z = 1.0 / w;
#ifdef SUBMERGED
    z.x = eye.w;
#endif
#if defined(CLIP_BOX) || defined(CLIP_GLASS)
    vec2 inside = room(to_world(vec3(ray_of(at), -1.0)));
    bool wet = inside.x < min(inside.y, z.y) && z.x < inside.y;
    z = vec2(max(z.x, inside.x), min(z.y, inside.y));
    w = wet ? 1.0 / z : vec2(0.0);
#else
    w = 1.0 / z;
#endif
  }
  result_0 = vec4(w, 0.0, 0.0);
}
#endif
