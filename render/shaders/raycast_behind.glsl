// Metres of water behind the iso-surface, along the ray that it bends, as far as they are few: there the particles splatted for
// the thickness are too coarse. At half the picture's resolution: the ray of one pixel in four is followed.
//
// Where the ray meets water on a side wall of its container, the wall may mirror it. What it is followed in behind the wall is
// the water's mirror image, which is what the field has there.
#include "frame.glsl"
#define SCALE 2
#define OUTPUTS 1 // metres of water behind the surface, at most DEEP, negative: there is water at the side wall ahead; depth of
                  // the surface, 0: there is none
#define FORMAT rg32f
#include "tile_pass.glsl"
#ifndef VERTEX_STAGE
#include "raycast_field.glsl"
layout(binding = 0) uniform sampler2D surface; // depth, negative where the ray comes out of water
layout(binding = 1) uniform sampler2D normals; // outward unit normal

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

// Metres to where the ray leaves the water at whose surface it begins, or DEEP.
float way_out() {
  float t = 0.0, f = 1e-3; // on the surface it is zero: the water is on this side
  for (int i = 0; i < 2; ++i) {
    vec4 next = spacing * LOOKS[i], ahead = above_iso(next);
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
  vec3 seen = way, normal = facing_eye(texelFetch(normals, pixel, 0).xyz, seen);
  cast_from(eye.xyz + way * along * begin, refract(seen, normal, 1.0 / blend.w));
  float metres = way_out(), wall = room_from(origin, way).y;
  bool at_side = wall < FAR && wall_normal(origin + way * wall).y == 0.0, wet = at_side && metres >= wall;
  // A wall that is farther than the ray was followed is looked at by itself.
  for (int i = 0; i < int(at_side && !wet && metres >= 0.999 * DEEP * spacing); ++i) {
    wet = above_iso(wall - spacing * vec4(0.6, 0.5, 0.4, 0.3)).x > 0.0;
  }
  result_0 = vec4(wet ? -metres : min(metres, wall), begin, 0.0, 0.0);
}
#endif
