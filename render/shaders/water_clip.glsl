// Smoothed water ends at the walls of its container. Particles near a wall are drawn on its other side as well
// (quadrics.c), so that the surface goes on beyond it; here it is cut off, and lies flat on the glass.
#include "frame.glsl"
#define OUTPUTS 1 // 1 / depth of front and back; 0 where there is no water
#define FORMAT rg32f
#include "tile_pass.glsl"
#ifndef VERTEX_STAGE
#include "container.glsl"
layout(binding = 0) uniform sampler2D inverse_depths; // of front and back

void pass(ivec2 at) {
  vec2 w = texelFetch(inverse_depths, at, 0).xy;
  if (w.x > 0.0) {
    vec2 z = 1.0 / w;
#ifdef SUBMERGED
    z.x = eye.w;
#endif
#if defined(CLIP_BOX) || defined(CLIP_GLASS)
    vec2 inside = room(to_world(vec3(ray_of(at), -1.0)));
    bool wet = inside.x < min(inside.y, z.y) && z.x < inside.y;
    z = vec2(max(z.x, inside.x), min(z.y, inside.y));
    w = wet ? 1.0 / z : vec2(0.0);
#else
    w = 1.0 / z;
#endif
  }
  result_0 = vec4(w, 0.0, 0.0);
}
#endif
