// The container that holds the water: a box (CLIP_BOX), a round glass (CLIP_GLASS), or none. Its top is open.
#ifdef CLIP_GLASS
#include "glass.glsl"
#endif

// Between which multiples of `ray` a line from a point is in the container.
vec2 room_from(vec3 origin, vec3 ray) {
#if defined(CLIP_BOX) || defined(CLIP_GLASS)
  vec3 inverse_ray = 1.0 / mix(ray, vec3(1e-9), lessThan(abs(ray), vec3(1e-9)));
  vec3 a = (container_min.xyz - origin) * inverse_ray, b = (container_max.xyz - origin) * inverse_ray;
  vec3 low = min(a, b), high = max(a, b);
  vec2 y = vec2(ray.y < 0.0 ? -FAR : a.y, ray.y < 0.0 ? a.y : FAR);
#ifdef CLIP_GLASS
  Glass glass = glass_of_container();
  float radius = glass.radius * INSIDE, rr = dot(ray.xz, ray.xz);
  vec2 from = origin.xz - glass.centre;
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

// Depths between which the ray from the eye, of length 1 along the view axis, is in the container.
vec2 room(vec3 ray) {
  return room_from(eye.xyz, ray);
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

// Is a ray in the water, of unit direction, mirrored where it meets a side wall at p, with air behind it?
bool mirrored_by_wall(vec3 p, vec3 way, float index) {
#if defined(CLIP_BOX) || defined(CLIP_GLASS)
  vec3 n = wall_normal(p);
  return n.y == 0.0 && dot(n, way) > 0.0 && refract(way, -n, index) == vec3(0.0);
#else
  return false;
#endif
}

// Water goes on behind the walls as its mirror image, so that it lies flat on them. A set of walls, a bit for each direction
// that has one, stands for one image; a wall is a plane with its unit normal into the container, so that dot(n, p) + w is a
// point's distance from it. That of a round glass is the plane that touches it.
#if defined(CLIP_BOX)
#define WALLS 3
#elif defined(CLIP_GLASS)
#define WALLS 2
#else
#define WALLS 0
#endif

#if WALLS > 0
// The wall of a direction that is the nearest to a point.
vec4 nearest_wall(int direction, vec3 p) {
  vec3 low = p - container_min.xyz, high = container_max.xyz - p;
  if (direction == 0) return vec4(0.0, 1.0, 0.0, -container_min.y);
#ifdef CLIP_GLASS
  vec2 middle = 0.5 * (container_min.xz + container_max.xz), from = p.xz - middle;
  float radius = 0.5 * min(container_max.x - container_min.x, container_max.z - container_min.z);
  vec2 n = -from / max(length(from), 1e-9);
  return vec4(n.x, 0.0, n.y, radius - dot(n, middle));
#else
  if (direction == 1) return low.x < high.x ? vec4(1.0, 0.0, 0.0, -container_min.x) : vec4(-1.0, 0.0, 0.0, container_max.x);
  return low.z < high.z ? vec4(0.0, 0.0, 1.0, -container_min.z) : vec4(0.0, 0.0, -1.0, container_max.z);
#endif
}

vec4 wall[WALLS]; // the nearest of each direction, set by walls_within
#endif

// The set of walls that are nearer to a point than `reach`.
int walls_within(vec3 p, float reach) {
  int near = 0;
#if WALLS > 0
  for (int k = 0; k < WALLS; ++k) {
    wall[k] = nearest_wall(k, p);
    near |= int(dot(wall[k].xyz, p) + wall[k].w < reach) << k;
  }
#endif
  return near;
}

// Image of a point and a direction in a set of walls, which are at right angles.
void mirror(int walls, inout vec3 p, inout vec3 way) {
#if WALLS > 0
  for (int k = 0; k < WALLS; ++k) {
    vec3 twice = wall[k].xyz * (2.0 * float(walls >> k & 1));
    p -= (dot(wall[k].xyz, p) + wall[k].w) * twice;
    way -= dot(wall[k].xyz, way) * twice;
  }
#endif
}
