// What the filters share: where they read and write, and what a window is. A tap outside the picture sees no water.
#include "frame.glsl"
#define OUTPUTS 1
#define FORMAT rg32f
#include "tile_pass.glsl"
#ifndef VERTEX_STAGE
layout(binding = 0) uniform sampler2D inverse_depths; // of front and back
layout(std140, binding = 1) uniform Params {
  vec4 window;          // taps on either side; half of the window, m (0: taps lie on neighbouring pixels); range, m; of the filter
};

vec2 inverse_at(ivec2 at) {
  return in_picture(at) ? texelFetch(inverse_depths, at, 0).xy : vec2(0.0);
}

// Distance of the taps in pixels around a point with this inverse depth.
float stride_at(float inverse_depth) {
  return max(1.0, window.y * inverse_depth * lens.w / (2.0 * lens.y) / window.x);
}

vec2 smoothed(ivec2 at, vec2 middle); // of a pixel with water

void pass(ivec2 at) {
  vec2 middle = inverse_at(at);
  if (middle.x > 0.0) middle = smoothed(at, middle);
  result_0 = vec4(middle, 0.0, 0.0);
}
#endif
