// The container that holds the water: a box (CLIP_BOX), a round glass (CLIP_GLASS), or none. Its top is open.
#ifdef CLIP_GLASS
#include "glass.glsl"
#endif

// Depths between which the ray from the eye, of length 1 along the view axis, is in the container.
vec2 room(vec3 ray) {
#if defined(CLIP_BOX) || defined(CLIP_GLASS)
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
#else
  return vec2(-FAR, FAR);
#endif
}

// Unit normal of the wall that is nearest to a point, out of the container.
vec3 wall_normal(vec3 p) {
#if defined(CLIP_BOX) || defined(CLIP_GLASS)
  vec3 below = p - container_min.xyz, above = container_max.xyz - p;
#ifdef CLIP_GLASS
  vec2 from = p.xz - 0.5 * (container_min.xz + container_max.xz);
  float radius = 0.5 * min(container_max.x - container_min.x, container_max.z - container_min.z);
  return radius - length(from) < below.y ? vec3(from.x, 0.0, from.y) / max(length(from), 1e-9) : vec3(0.0, -1.0, 0.0);
#else
  vec2 side = min(below.xz, above.xz);
  if (below.y < min(side.x, side.y)) return vec3(0.0, -1.0, 0.0);
  return side.x < side.y ? vec3(below.x < above.x ? -1.0 : 1.0, 0.0, 0.0)
                         : vec3(0.0, 0.0, below.z < above.z ? -1.0 : 1.0);
#endif
#else
  return vec3(0.0);
#endif
}
