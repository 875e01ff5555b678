// One step of curvature flow: van der Laan, Green, Sainz, "Screen Space Fluid Rendering with Curvature Flow", 2009: the depth
// moves with the mean curvature H of the surface, and so bumps go. The step is as long as is stable where the surface faces
// the eye. Where the water ends or breaks off, its slope across the border counts as none.
#include "cartoon_map.glsl"
#ifndef VERTEX_STAGE
layout(std140, binding = 1) uniform Params {
  vec4 params;          // of a step: variance in pixels² that it adds, halved; gap in depth that is a border, m
};

void pass(ivec2 at) {
  result_0 = map_at(at);
  float own = result_0.x;
  if (own <= 0.0) return;
  float z = 1.0 / own, d[9], gap = params.y + STEEPEST * pixel_at(own);
  for (int i = 0; i < 9; ++i) {
    float w = inverse_at(at + ivec2(i % 3 - 1, i / 3 - 1));
    d[i] = w > 0.0 && abs(1.0 / w - z) < gap ? 1.0 / w - z : 0.0;
  }
  // Over a border the other side's slope would be half of one: none.
  vec2 first = 0.5 * vec2(d[5] - d[3], d[7] - d[1]), second = vec2(d[5] + d[3], d[7] + d[1]);
  float mixed = 0.25 * (d[8] + d[0] - d[2] - d[6]);
  vec2 c = float(SCALE) * 2.0 * lens.xy / lens.zw, c2 = c * c; // of a ray from pixel to pixel
  float D = c2.y * first.x * first.x + c2.x * first.y * first.y + c2.x * c2.y * z * z;
  vec2 dD = 2.0 * (c2.y * first.x * vec2(second.x, mixed) + c2.x * first.y * vec2(mixed, second.y) + c2.x * c2.y * z * first);
  vec2 E = 0.5 * first * dD - second * D;
  float H = (c.y * E.x + c.x * E.y) / (2.0 * pow(D, 1.5));
  float time = params.x * 2.0 * min(c.x, c.y) * z;
  result_0.x = 1.0 / max(z - time * H, 0.5 * z);
}
#endif
