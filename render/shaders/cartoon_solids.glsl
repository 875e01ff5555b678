// What is seen where there is no water: an unknown normal, and the depth of the background.
#include "frame.glsl"
#include "screen.glsl"

#ifdef FRAGMENT_STAGE
layout(binding = 0) uniform sampler2D background; // linear light, depth
layout(location = 0) out vec4 surface;

void main() {
  surface = vec4(0.0, 0.0, 0.0, texelFetch(background, ivec2(gl_FragCoord.xy), 0).a);
}
#endif
