// The surface of the water from its inverse depths. Of a plane n·p = d the inverse depth is affine in the ray's x and y,
// d w = n_x x + n_y y - n_z, and so the normal is along (w_x, w_y, x w_x + y w_y - w): exact on a plane, up to its boundary.
//
// Where the water lies on a wall of its container, the normal is the wall's. Elsewhere it is of the surface before the walls
// cut it off: so near a wall too it is of the surface alone, and not of a mixture of both.
//
// ANALYTIC: the normals of the particles instead, but where a wall of the container has cut them off.
#include "frame.glsl"
#define OUTPUTS 2 // front, back: normal in world axes, depth
#define FORMAT rgba32f
#include "tile_pass.glsl"
#ifndef VERTEX_STAGE
#include "container.glsl"
layout(binding = 0) uniform sampler2D inverse_depths;
layout(binding = 3) uniform sampler2D uncut; // inverse depths before the walls
#ifdef ANALYTIC
layout(binding = 1) uniform sampler2D raw_front; // normal in world axes, depth
layout(binding = 2) uniform sampler2D raw_back;
#endif
layout(std140, binding = 1) uniform Params {
  vec4 params;          // bend, m: where three pixels in a line bend by more, they are not of one surface
};

vec2 uncut_at(ivec2 at) {
  return in_picture(at) ? texelFetch(uncut, at, 0).xy : vec2(0.0);
}

// Change from pixel to pixel: central where three belong together, else to the flatter side.
vec2 change(vec2 before, vec2 here, vec2 after, vec2 bend) {
  vec2 backward = here - before, forward = after - here;
  if (before.x <= 0.0) return after.x <= 0.0 ? vec2(0.0) : forward;
  if (after.x <= 0.0) return backward;
  vec2 flatter = mix(backward, forward, lessThan(abs(forward), abs(backward)));
  return mix(flatter, 0.5 * (forward + backward), lessThanEqual(abs(forward - backward), bend));
}

vec3 normal_of(float w, float w_x, float w_y, vec2 ray, float side) {
  return to_world(normalize(vec3(w_x, w_y, dot(ray, vec2(w_x, w_y)) - w) * side));
}

void pass(ivec2 at) {
  vec2 w = texelFetch(inverse_depths, at, 0).xy, u = uncut_at(at);
  result_0 = result_1 = vec4(0.0);
  if (w.x <= 0.0) return;
  vec2 bend = params.x * u * u, ray = ray_of(at);
  vec2 per_x = change(uncut_at(at - ivec2(1, 0)), u, uncut_at(at + ivec2(1, 0)), bend) * lens.z / (2.0 * lens.x);
  vec2 per_y = change(uncut_at(at - ivec2(0, 1)), u, uncut_at(at + ivec2(0, 1)), bend) * lens.w / (2.0 * lens.y);
  vec4 near = vec4(normal_of(u.x, per_x.x, per_y.x, ray, -1.0), 1.0 / w.x);
  vec4 far = vec4(normal_of(u.y, per_x.y, per_y.y, ray, 1.0), 1.0 / w.y);
#ifdef ANALYTIC
  vec4 raw_near = texelFetch(raw_front, at, 0), raw_far = texelFetch(raw_back, at, 0);
  if (abs(raw_near.w - near.w) < 1e-4 * near.w) near.xyz = raw_near.xyz;
  if (abs(raw_far.w - far.w) < 1e-4 * far.w) far.xyz = raw_far.xyz;
#endif
#if defined(CLIP_BOX) || defined(CLIP_GLASS)
  vec3 way = to_world(vec3(ray, -1.0));
  vec2 walls = room(way);
  if (abs(walls.x - near.w) < 1e-5 * near.w) near.xyz = wall_normal(eye.xyz + way * near.w);
  if (abs(walls.y - far.w) < 1e-5 * far.w) far.xyz = wall_normal(eye.xyz + way * far.w);
#endif
  result_0 = near;
  result_1 = far;
}
#endif
