// The sky behind everything else.
#include "frame.glsl"
#include "screen.glsl"

#ifdef FRAGMENT_STAGE
#include "sky.glsl"

layout(location = 0) out vec4 result; // linear light; 0 for no depth

void main() {
  result = vec4(sky(normalize(to_world(view_ray(place)))), 0.0);
}
#endif
