// Metres of water behind the iso-surface, as far as it is thinner than a few spacings, where the particles splatted for the
// thickness are too coarse. At half the picture's resolution: the ray of one pixel in four is followed.
#include "frame.glsl"
#define SCALE 2
#define OUTPUTS 1 // metres of water behind the surface, at most DEEP; depth of that surface, 0: there is none
#define FORMAT rg32f
#include "tile_pass.glsl"
#ifndef VERTEX_STAGE
#include "raycast_field.glsl"
layout(binding = 0) uniform sampler2D surface; // depth, negative where the ray comes out of water

const float DEEP = 8.0;        // spacings, also in raycast_light.glsl
const vec4 LOOKS[2] = vec4[2](vec4(0.35, 0.8, 1.4, 2.2), vec4(3.2, 4.6, 6.2, DEEP));

// The first pixel of a square of four that shows a surface from outside; the first, if none does.
ivec2 pixel_of(ivec2 at) {
  for (int k = 0; k < 4; ++k) {
    ivec2 pixel = at * 2 + ivec2(k & 1, k >> 1);
    if (in_picture(pixel) && texelFetch(surface, pixel, 0).x > 0.0) return pixel;
  }
  return at * 2;
}

// The depth at which the ray leaves the water that it comes into at one, or DEEP behind it.
float way_out(float begin) {
  float t = begin, f = 1e-3; // on the surface it is zero: the water is on this side
  for (int i = 0; i < 2; ++i) {
    vec4 next = begin + spacing * LOOKS[i], ahead = above_iso(next);
    for (int k = 0; k < 4; ++k) {
      if (ahead[k] < 0.0) return narrow(vec2(t, next[k]), vec2(f, ahead[k]));
      t = next[k];
      f = ahead[k];
    }
  }
  return t;
}

void pass(ivec2 at) {
  ivec2 pixel = pixel_of(at);
  float begin = texelFetch(surface, pixel, 0).x;
  result_0 = vec4(0.0);
  if (begin <= 0.0) return;
  cast_through(pixel);
  float end = room(way * along).y;
  result_0 = vec4((min(way_out(begin), end) - begin) * along, begin, 0.0, 0.0);
}
#endif
