// Mark the tiles of the picture that lines may touch, so that the passes that follow leave the others out: those near a pixel
// at which the inverse depth is not as on a plane, or the normal turns
// or is no longer known.
#include "frame.glsl"
#ifdef COMPUTE_STAGE
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 7) writeonly buffer Tiles { uint tiles[]; }; // every writer of a tile writes 1
layout(binding = 0) uniform sampler2D surface;
#include "outline_surface.glsl"

vec4 texel(ivec2 at) {
  return texelFetch(surface, clamp(at, ivec2(0), ivec2(lens.zw) - 1), 0);
}

float inverse_of(vec4 texel) {
  return texel.a > 0.0 ? 1.0 / texel.a : 0.0;
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, ivec2(lens.zw)))) return;
  vec4 here = texel(at), right = texel(at + ivec2(1, 0)), above = texel(at + ivec2(0, 1));
  float inverse = inverse_of(here);
  float bend_x = inverse_of(texel(at - ivec2(1, 0))) - 2.0 * inverse + inverse_of(right);
  float bend_y = inverse_of(texel(at - ivec2(0, 1))) - 2.0 * inverse + inverse_of(above);
  bool bent = max(abs(bend_x), abs(bend_y)) > 0.4 * least_bend(inverse);
#ifdef NORMALS
  bool turns_right = right.rgb != vec3(0.0) && dot(here.rgb, right.rgb) < drawn_ink.a;
  bool turns_above = above.rgb != vec3(0.0) && dot(here.rgb, above.rgb) < drawn_ink.a;
  bool known = here.rgb != vec3(0.0), ends = known != (right.rgb != vec3(0.0)) || known != (above.rgb != vec3(0.0));
  bent = bent || ends || (known && (turns_right || turns_above));
#endif
  if (!bent) return;
  int margin = int(ceil(drawn_levels.w)) + 3, columns = int(ceil(lens.z / float(TILES)));
  ivec2 low = max(at - margin, ivec2(0)) / TILES, high = min(at + margin, ivec2(lens.zw) - 1) / TILES;
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x; x <= high.x; ++x) tiles[y * columns + x] = 1u;
  }
}
#endif
