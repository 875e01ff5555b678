// Sums along a column of the rows' sums, and from them the plane that fits best: its height at the texel.
#include "screen.glsl"

#ifdef FRAGMENT_STAGE
#include "height_map_kernel.glsl"
layout(binding = 0) uniform sampler2D row_moments;
layout(binding = 1) uniform sampler2D row_more;
layout(location = 0) out vec4 result; // height, m; share of water

bool wet(ivec2 node) {
  return heights[mirrored(node.y, nodes.y) * nodes.x + mirrored(node.x, nodes.x)] < DRY;
}

// Between the nodes, linearly.
float share_of_water(ivec2 texel) {
  ivec2 low = texel / nodes.z;
  vec2 f = vec2(texel - low * nodes.z) / float(nodes.z);
  vec4 w = vec4(wet(low), wet(low + ivec2(1, 0)), wet(low + ivec2(0, 1)), wet(low + ivec2(1, 1)));
  vec2 along = mix(w.xz, w.yw, f.x);
  return mix(along.x, along.y, f.y);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  Window w = window(texel.y);
  vec3 of_one = vec3(0.0), of_h = vec3(0.0); // Σw·(1, x, z), Σwh·(1, x, z)
  vec3 of_xx = vec3(0.0);                    // Σw·(xx, xz, zz)
  vec2 range = vec2(DRY, -DRY);
  for (int k = w.first; k <= w.last; ++k) {
    ivec2 at = ivec2(texel.x, mirrored(k, nodes.y));
    vec4 m = texelFetch(row_moments, at, 0), n = texelFetch(row_more, at, 0);
    float z = float(k) - w.at, weighted = weight(z);
    of_one += weighted * vec3(m.xy, m.x * z);
    of_xx += weighted * vec3(m.z, m.y * z, m.x * z * z);
    of_h += weighted * vec3(m.w, n.x, m.w * z);
    range = vec2(min(range.x, n.y), max(range.y, n.z));
  }
  float h = 0.0;
  if (of_one.x > 0.0) {
    vec3 mean = of_one / of_one.x;
    vec3 spread = of_xx / of_one.x - vec3(mean.y * mean.y, mean.y * mean.z, mean.z * mean.z);
    vec2 along = (of_h.yz - of_h.x * mean.yz) / of_one.x;
    // A hair of stiffness: nodes on a line, or a single one, say nothing about the slope across.
    spread.xz += 1e-6 * (spread.x + spread.z) + 1e-7 * dot(mean.yz, mean.yz) + 1e-9;
    vec2 slope = vec2(spread.z * along.x - spread.y * along.y, spread.x * along.y - spread.y * along.x) /
                 max(spread.x * spread.z - spread.y * spread.y, 1e-30);
    h = of_h.x / of_one.x - dot(slope, mean.yz);
    float margin = 0.5 * (range.y - range.x); // nodes all on one side may say too much of the other
    h = clamp(h, range.x - margin, range.y + margin);
  }
  result = vec4(h + kernel.z, share_of_water(texel), 0.0, 0.0);
}
#endif
