// The map of light as the sun's disc blurs it: it is half a degree wide, some millimetres on the floor of a pool, about as much
// as a pixel of the map. Weights are 1 2 1 along rows and columns.
#include "screen.glsl"

#ifdef FRAGMENT_STAGE
layout(binding = 0) uniform sampler2D raw;
layout(location = 0) out vec4 light;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(raw, 0) - 1;
  ivec4 around = clamp(ivec4(at - 1, at + 1), ivec4(0), last.xyxy);
  light = 0.25 * texelFetch(raw, at, 0);
  light += 0.125 * (texelFetch(raw, ivec2(around.x, at.y), 0) + texelFetch(raw, ivec2(around.z, at.y), 0) +
                    texelFetch(raw, ivec2(at.x, around.y), 0) + texelFetch(raw, ivec2(at.x, around.w), 0));
  light += 0.0625 * (texelFetch(raw, around.xy, 0) + texelFetch(raw, around.zy, 0) + texelFetch(raw, around.xw, 0) +
                     texelFetch(raw, around.zw, 0));
}
#endif
