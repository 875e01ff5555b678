// Bilateral filter of the normals (Xiao, Zhang, Yang 2017, section 3.3; Aurich & Weule 1995): weights fall with the
// distance of the points on the surface and with the angle between the normals, so that edges stay.
#include "frame.glsl"
#define OUTPUTS 1 // outward unit normal in world axes, depth
#define FORMAT rgba32f
#include "tile_pass.glsl"
#ifndef VERTEX_STAGE
layout(std140, binding = 1) uniform Params {
  vec4 window;          // half of it, m; taps on either side; -; standard deviation of normals
};
layout(binding = 0) uniform sampler2D normals;
layout(binding = 1) uniform sampler2D colours; // linear; alpha 0 on a wall, whose normal is exact

void pass(ivec2 at) {
  vec4 middle = texelFetch(normals, at, 0);
  result_0 = middle;
  if (middle.w == 0.0 || texelFetch(colours, at, 0).a == 0.0) return;
  float depth = abs(middle.w), pixel = 2.0 * lens.y / lens.w * depth;
  int taps = int(window.y);
  float stride = max(1.0, window.x / pixel / window.y);
  vec3 here = vec3(ray_of(at), -1.0) * depth, sum = vec3(0.0);
  for (int v = -taps; v <= taps; ++v) {
    for (int u = -taps; u <= taps; ++u) {
      ivec2 tap = at + ivec2(round(vec2(u, v) * stride));
      vec4 n = in_picture(tap) ? texelFetch(normals, tap, 0) : vec4(0.0);
      vec3 apart = vec3(ray_of(tap), -1.0) * abs(n.w) - here, turned = n.xyz - middle.xyz;
      float near = dot(apart, apart) / (window.x * window.x), like = dot(turned, turned) / (window.w * window.w);
      sum += n.xyz * (n.w == 0.0 ? 0.0 : exp(-2.0 * near - 0.5 * like));
    }
  }
  result_0.xyz = normalize(sum);
}
#endif
