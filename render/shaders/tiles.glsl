// Mark the tiles of the picture that spheres may touch, so that later passes leave the others out.
#include "frame.glsl"
#include "sphere.glsl"
#ifdef COMPUTE_STAGE
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) readonly buffer Spheres { vec4 spheres[]; };
layout(std430, binding = 1) writeonly buffer Tiles { uint tiles[]; }; // every writer of a tile writes 1
layout(std140, binding = 1) uniform Params {
  vec4 params;          // radius factor, number of spheres, width of the dispatch, tiles in a row
  vec4 size;            // of a tile in pixels; vec4s from one sphere to the next
};

void main() {
  uint index = gl_GlobalInvocationID.y * uint(params.z) + gl_GlobalInvocationID.x;
  if (index >= uint(params.y)) return;
  vec4 s = spheres[index * uint(size.y)];
  vec3 c = to_view(s.xyz);
  float r = s.w * params.x;
  if (hidden(c, r)) return;
  vec4 bounds = (bounds_of(c, r) / lens.xyxy * 0.5 + 0.5) * lens.zwzw; // pixels
  ivec4 range = ivec4(clamp(bounds, vec4(0.0), lens.zwzw - 1.0) / size.x);
  for (int y = range.y; y <= range.w; ++y) {
    for (int x = range.x; x <= range.z; ++x) tiles[y * int(params.w) + x] = 1u;
  }
}
#endif
