// Normals of drawn water from its inverse depths. Of a plane n·p = d the inverse depth is affine in the ray's x and y,
// d w = n_x x + n_y y - n_z, and so the normal is along (w_x, w_y, x w_x + y w_y - w). At a silhouette the difference is
// taken to the side on which the surface goes on.
//
// FITTED: by the slopes that the filter has found.
#include "cartoon_map.glsl" // its output: normal in world axes, depth
#ifndef VERTEX_STAGE
layout(std140, binding = 1) uniform Params {
  vec4 params;          // bend, m: where three pixels in a line bend by more, they are not of one surface
};

// Change from pixel to pixel: central where three belong together, else to the flatter side.
float change(float before, float here, float after, float bend) {
  float backward = here - before, forward = after - here;
  if (before <= 0.0) return after <= 0.0 ? 0.0 : forward;
  if (after <= 0.0) return backward;
  return abs(forward - backward) <= bend ? 0.5 * (forward + backward) : abs(forward) < abs(backward) ? forward : backward;
}

void pass(ivec2 at) {
  vec4 own = map_at(at);
  float w = own.x;
  result_0 = vec4(0.0);
  if (w <= 0.0) return;
  vec2 size = vec2(textureSize(map, 0)), ray = ((vec2(at) + 0.5) / size * 2.0 - 1.0) * lens.xy;
#ifdef FITTED
  vec2 per_pixel = own.yz;
#else
  float bend = params.x * w * w;
  vec2 per_pixel = vec2(change(inverse_at(at - ivec2(1, 0)), w, inverse_at(at + ivec2(1, 0)), bend),
                    change(inverse_at(at - ivec2(0, 1)), w, inverse_at(at + ivec2(0, 1)), bend));
#endif
  vec2 slope = per_pixel * size / (2.0 * lens.xy);
  result_0 = vec4(to_world(normalize(vec3(-slope, w - dot(ray, slope)))), 1.0 / w);
}
#endif
