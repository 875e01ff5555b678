// How far the water reaches around an eye that is in it: the depth at which the ray of a pixel first comes into the air,
// by the grid of cells that hold water. Backs of ellipsoids that lie farther are of other water.
#include "frame.glsl"
#define OUTPUTS 1
#define FORMAT r32f
#include "tile_pass.glsl"
#ifndef VERTEX_STAGE
layout(std140, binding = 1) uniform Params {
  vec4 grid;            // of occupancy: origin, edge of a cell; m
  ivec4 cells;
};
#include "occupancy.glsl"

void pass(ivec2 at) {
  vec3 way = to_world(vec3(ray_of(at), -1.0));
  float along = length(way), t = way_to_air(eye.xyz, way / along);
  result_0 = vec4(t < FAR ? t / along : FAR);
}
#endif
