// The raw depths of aggregated water as inverse depths: what the smoothing reads.
#include "frame.glsl"
#define OUTPUTS 1 // 1 / depth of front and back; 0 where there is no water
#define FORMAT rg32f
#include "tile_pass.glsl"
#ifndef VERTEX_STAGE
layout(binding = 0) uniform sampler2D raw;     // 1 / depth of the front, depth of the back

void pass(ivec2 at) {
  vec2 w = texelFetch(raw, at, 0).xy;
  result_0 = vec4(w.x > 0.0 && w.x * w.y > 1.0 ? vec2(w.x, 1.0 / w.y) : vec2(0.0), 0.0, 0.0);
}
#endif
