// From linear light to what a screen shows. FILMIC: exposure, a filmic curve (Narkowicz, "ACES Filmic Tone Mapping
// Curve", 2015), the sRGB transfer. FLAT: exposure and the sRGB transfer, so that a drawing's colours stay what they are.
// Otherwise the linear values as they are.
#include "frame.glsl"
#include "screen.glsl"

#ifdef FRAGMENT_STAGE
#include "curve.glsl"
layout(binding = 0) uniform sampler2D picture;
layout(std140, binding = 1) uniform Tone {
  vec4 tone;            // exposure
};
layout(location = 0) out vec4 result;

void main() {
  vec3 light = texelFetch(picture, ivec2(gl_FragCoord.xy), 0).rgb;
#ifdef FILMIC
  light = to_screen(light * tone.x);
#elif defined(FLAT)
  light = to_srgb(clamp(light * tone.x, 0.0, 1.0));
#endif
  result = vec4(light, 1.0);
}
#endif
