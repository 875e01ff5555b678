// Where each pixel's ray meets the iso-surface (Xiao, Zhang, Yang 2017, sections 3.1 and 3.2). A ray begins where the first
// particle could have any share in the field, which particles drawn at a lower resolution tell, and goes on in steps in
// which the field cannot reach the iso-value: its curvature has a bound.
#include "frame.glsl"
#define OUTPUTS 1 // depth along the view axis, negative where the ray comes out of water or ends in it, 0: there is no surface
#define FORMAT r32f
#include "tile_pass.glsl"
#ifndef VERTEX_STAGE
#include "raycast_field.glsl"
#include "raycast_slices.glsl"
layout(binding = 0) uniform usampler2D entries; // slices of depth in which there is any field
layout(binding = 1) uniform sampler2D background;

const int STEPS = 1000;
const float LEAST = 0.1, MOST = 0.45; // spacings between two points that are looked at

// How far apart, in spacings, may two points be that are f away from the iso-value, so that the field does not reach it in
// between? A function whose second derivative is at least −c exceeds its chord by at most c δ² / 8. Here c is that of a lone
// particle in its middle, 96 / (π h⁵), or that of a lattice where it ends, 1.45 / h² as measured, and a quarter more.
float stride(float f) {
  float h = field_of.x / field_of.z, h2 = h * h;
  return sqrt(8.0 * abs(f) / max(38.2 / (h2 * h2 * h), 1.8 / h2));
}

void pass(ivec2 at) {
  result_0 = vec4(0.0);
  uvec4 occupied = texelFetch(entries, at / 4, 0);
  if (occupied == uvec4(0)) return;
  float behind = texelFetch(background, at, 0).a;
  cast_through(at);
  vec2 walls = room(way * along), s = slices();
  float t = max(eye.w, walls.x), end = min(behind > 0.0 ? behind : FAR, walls.y), f = -field_of.y;
  bool known = false, inside = false; // is f the field at t? Is t in the water?
  for (int i = 0; i < STEPS && t < end; ++i) {
    int slice = slice_at(t, s), next_one = next_slice(occupied, slice);
    if (next_one == SLICES) return;
    if (next_one > slice) {
      t = begin_of(next_one, s); // nothing before it has a share in the field
      known = true;
      f = -field_of.y;
      if (t >= end) return;
    }
    float step = clamp(0.9 * stride(f), LEAST, MOST) * spacing;
    vec4 next = min(t + step * (known ? vec4(1.0, 2.0, 3.0, 4.0) : vec4(0.0, 1.0, 2.0, 3.0)), end);
    vec4 there = above_iso(next);
    for (int k = 0; k < 4; ++k) {
      if (!known) {
        known = true;
        inside = there.x > 0.0;
        if (inside && t == walls.x) {
          result_0 = vec4(t); // water begins at the wall itself
          return;
        }
      } else if ((there[k] > 0.0) != inside) {
        float found = narrow(vec2(t, next[k]), vec2(f, there[k]));
        if (found < end || inside) result_0 = vec4(inside ? -min(found, end) : found);
        return;
      } else if (step > stride(min(abs(f), abs(there[k]))) * spacing && step > LEAST * spacing) {
        f = sign(f) * min(abs(f), abs(there[k])); // it could have changed sides twice: look closer
        break;
      }
      t = next[k];
      f = there[k];
    }
  }
  if (inside) result_0 = vec4(-end); // a solid ends the water, or a wall
}
#endif
