// Which tiles of the picture the water is in: those with pixels of its height field, and those with pixels of its flat sides.
#include "frame.glsl"
#ifdef COMPUTE_STAGE
#define TILES 32
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D surface;    // outward normal, depth
layout(std430, binding = 0) writeonly buffer Top { uint with_surface[]; };
layout(std430, binding = 1) writeonly buffer Sides { uint with_sides[]; };

void main() {
  ivec2 size = ivec2(lens.zw), tiles = (size + TILES - 1) / TILES, tile = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(tile, tiles))) return;
  ivec2 from = tile * TILES, to = min(from + TILES, size);
  bool top = false, side = false;
  for (int y = from.y; y < to.y && !(top && side); ++y) {
    for (int x = from.x; x < to.x; ++x) {
      vec4 s = texelFetch(surface, ivec2(x, y), 0);
      top = top || (s.w > 0.0 && s.y != 0.0);
      side = side || (s.w > 0.0 && s.y == 0.0);
    }
  }
  int i = tile.y * tiles.x + tile.x;
  with_surface[i] = uint(top);
  with_sides[i] = uint(side);
}
#endif
