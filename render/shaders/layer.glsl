// One intermediate of the picture as colours to look at.
#include "frame.glsl"
#include "screen.glsl"

#ifdef FRAGMENT_STAGE
#include "curve.glsl"
layout(binding = 0) uniform sampler2D layer;
layout(std140, binding = 1) uniform Layer {
  vec4 mapping;         // first channel, largest value
};
layout(location = 0) out vec4 result;

void main() {
  vec4 value = texelFetch(layer, ivec2(gl_FragCoord.xy / lens.zw * vec2(textureSize(layer, 0))), 0);
  float x = value[int(mapping.x)];
#if defined(MAP_DEPTH)
  // Hue goes round once per factor of two in distance, brightness falls with it.
  vec3 hue = 0.5 + 0.5 * cos(6.2832 * (log2(max(x, 1e-6)) + vec3(0.0, 0.33, 0.67)));
  vec3 colour = x > 0.0 ? mix(hue, vec3(1.0), 0.5) / (1.0 + 0.15 * x) : vec3(0.0);
#elif defined(MAP_NORMAL)
  vec3 colour = dot(value.xyz, value.xyz) > 0.0 ? value.xyz * 0.5 + 0.5 : vec3(0.0);
#elif defined(MAP_SCALAR)
  float s = clamp(x / mapping.y, 0.0, 1.0);
  vec3 colour = clamp(vec3(1.6 * s - 0.5, 1.1 * s + 0.02, 0.25 + 0.9 * s - 1.4 * s * s), 0.0, 1.0);
  if (x <= 0.0) colour = vec3(0.0);
#else
  vec3 colour = to_screen(value.rgb);
#endif
  result = vec4(colour, 1.0);
}
#endif
