// From the smoothed sun map: the water's smooth surface as a normal, and how strongly its bumps focus sunlight on what
// lies below. A ray that meets the surface at x is bent and lands at x + d k grad h, d being the depth below, h the
// height towards the sun, k = 1 - 1/n for small slopes; so light is spread over the area det(1 + d k H), H the Hessian.
#include "frame.glsl"
#ifdef COMPUTE_STAGE
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D map;      // thickness, height, coverage
layout(binding = 0, rgba32f) writeonly uniform image2D water;  // thickness, height, coverage, focus
layout(binding = 1, rgba32f) writeonly uniform image2D normals;

float height(ivec2 at, float fallback) {
  vec4 m = texelFetch(map, clamp(at, ivec2(0), textureSize(map, 0) - 1), 0);
  return m.z > 0.0 ? m.y : fallback;
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = textureSize(map, 0);
  if (any(greaterThanEqual(at, size))) return;
  vec4 m = texelFetch(map, at, 0);
  if (m.z <= 0.0) {
    imageStore(water, at, vec4(m.xyz, 1.0));
    imageStore(normals, at, vec4(sun_direction.xyz, 0.0));
    return;
  }
  vec2 d = sun_map.xy / vec2(size); // metres per texel
  float e = height(at + ivec2(1, 0), m.y), w = height(at - ivec2(1, 0), m.y);
  float n = height(at + ivec2(0, 1), m.y), s = height(at - ivec2(0, 1), m.y);
  float ne = height(at + ivec2(1, 1), m.y), nw = height(at + ivec2(-1, 1), m.y);
  float se = height(at + ivec2(1, -1), m.y), sw = height(at - ivec2(1, 1), m.y);
  vec2 slope = vec2(e - w, n - s) / (2.0 * d);
  vec3 normal = sun_direction.xyz - slope.x * sun_u.xyz * sun_map.x - slope.y * sun_v.xyz * sun_map.y;

  float huu = (e - 2.0 * m.y + w) / (d.x * d.x), hvv = (n - 2.0 * m.y + s) / (d.y * d.y);
  float huv = (ne - nw - se + sw) / (4.0 * d.x * d.y);
  float k = m.x * sun_map.z;
  float spread = (1.0 + k * huu) * (1.0 + k * hvv) - k * k * huv * huv;
  float focus = clamp(1.0 / max(abs(spread), 1e-3), 0.7, 1.9);
  // At its rim the water's height says nothing about its slope.
  imageStore(water, at, vec4(m.xyz, mix(1.0, focus, smoothstep(0.9, 1.0, m.z))));
  imageStore(normals, at, vec4(normalize(normal), 0.0));
}
#endif
