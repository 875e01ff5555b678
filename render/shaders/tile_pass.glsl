// A pass over the pixels of the tiles with water in them: it defines OUTPUTS (1 or 2) and FORMAT before it includes this,
// and writes one pixel in pass(). A compute shader on a GPU, where that is much faster; a fragment shader on a software
// rasteriser, whose stores to images cost more than the rest of a pass (render_tile_pass chooses). Tiles without water are
// left as they were cleared.
//
// With SCALE, which RenderTilePass has as well, the target is that many times smaller than the picture.
//
// Maps of water hold the inverse depths of front and back, 0 where there is none.
#define TILES 32
#ifndef SCALE
#define SCALE 1
#endif

#ifdef COMPUTE_STAGE
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 7) readonly buffer Tiles { uint tiles[]; };
layout(FORMAT, binding = 0) writeonly uniform image2D image_0;
#if OUTPUTS > 1
layout(FORMAT, binding = 1) writeonly uniform image2D image_1;
#endif
vec4 result_0, result_1;

void pass(ivec2 at);

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy), pixel = at * SCALE, size = ivec2(lens.zw);
  int row = (size.x + TILES - 1) / TILES;
  if (any(greaterThanEqual(pixel, size)) || tiles[pixel.y / TILES * row + pixel.x / TILES] == 0u) return;
  pass(at);
  imageStore(image_0, at, result_0);
#if OUTPUTS > 1
  imageStore(image_1, at, result_1);
#endif
}
#else
#include "screen.glsl"
#endif

#ifdef FRAGMENT_STAGE
layout(location = 0) out vec4 result_0;
#if OUTPUTS > 1
layout(location = 1) out vec4 result_1;
#endif

void pass(ivec2 at);

void main() {
  pass(ivec2(gl_FragCoord.xy));
}
#endif

#ifndef VERTEX_STAGE
// x and y of the ray through the middle of a pixel.
vec2 ray_of(ivec2 at) {
  return ((vec2(at) + 0.5) / lens.zw * 2.0 - 1.0) * lens.xy;
}

bool in_picture(ivec2 at) {
  return all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(lens.zw)));
}
#endif
