// Slopes of the smoothed heights by central differences; beyond the border is the mirror image.
#include "screen.glsl"

#ifdef FRAGMENT_STAGE
#include "height_map_kernel.glsl"
layout(binding = 0) uniform sampler2D smooth_heights; // height, share
layout(location = 0) out vec4 result;                 // height, m; share of water; slopes along x and z

float height(ivec2 at) {
  ivec2 size = textureSize(smooth_heights, 0);
  return texelFetch(smooth_heights, ivec2(mirrored(at.x, size.x), mirrored(at.y, size.y)), 0).x;
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec2 rise = vec2(height(at + ivec2(1, 0)) - height(at - ivec2(1, 0)), height(at + ivec2(0, 1)) - height(at - ivec2(0, 1)));
  result = vec4(texelFetch(smooth_heights, at, 0).xy, 0.5 * rise * kernel.w);
}
#endif
