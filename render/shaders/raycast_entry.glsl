// Where rays can meet the field: the particles as balls of the kernel's support, drawn at a quarter of the picture's resolution
// and a little larger, so that no pixel of a texel is left out. Each sets the bits of the slices of depth that it covers.
#include "frame.glsl"
#include "sphere.glsl"

#ifdef VERTEX_STAGE
layout(std140, binding = 1) uniform Params {
  vec4 grid;            // origin, edge of a cell; m
  ivec4 cells;
  vec4 field_of;        // support, m; -
  vec4 target_size;     // pixels of the target across and up; -
};
#include "raycast_slices.glsl"
layout(binding = 12) uniform samplerBuffer spheres; // centre, radius; m
flat out uvec4 covered;

const vec2 CORNERS[6] = vec2[6](vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, -1), vec2(1, 1), vec2(-1, 1));

void main() {
  vec4 sphere = texelFetch(spheres, gl_VertexID / 6);
  vec3 c = to_view(sphere.xyz);
  float r = field_of.x;
  bool none = sphere.w <= 0.0 || outside(c, r);
  vec4 bounds = none ? vec4(0.0) : bounds_of(c, r);
  vec2 corner = CORNERS[gl_VertexID % 6], s = slices();
  vec2 at = mix(bounds.xy, bounds.zw, corner * 0.5 + 0.5) / lens.xy + corner / target_size.xy;
  gl_Position = none ? vec4(2.0, 2.0, 0.0, 1.0) : vec4(at, 0.0, 1.0);
  float hair = 2e-3 * s.y;
  covered = slices_before(slice_at(-c.z + r + hair, s) + 1) & ~slices_before(slice_at(-c.z - r - hair, s));
}
#endif

#ifdef FRAGMENT_STAGE
flat in uvec4 covered;
layout(location = 0) out uvec4 result;

void main() {
  result = covered;
}
#endif
