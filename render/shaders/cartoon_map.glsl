// What the passes over the maps of drawn water share (cartoon_surface.h). A map holds the inverse depth, 0 where there is no
// water, its change from pixel to pixel along both axes as far as it is known, and the share of water around the pixel.
// SCALE is the number of the picture's pixels across one of the map.
#include "frame.glsl"
#define OUTPUTS 1
#define FORMAT rgba32f
#include "tile_pass.glsl"
#ifndef VERTEX_STAGE
layout(binding = 0) uniform sampler2D map;

const float STEEPEST = 8.0; // depth per metre across the view that can still be one surface

bool in_map(ivec2 at) {
  return all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, textureSize(map, 0)));
}

vec4 map_at(ivec2 at) {
  return in_map(at) ? texelFetch(map, at, 0) : vec4(0.0);
}

float inverse_at(ivec2 at) {
  return map_at(at).x;
}

// Metres across a pixel of the map where the inverse depth is w.
float pixel_at(float w) {
  return float(SCALE) * 2.0 * lens.y / (lens.w * w);
}
#endif
