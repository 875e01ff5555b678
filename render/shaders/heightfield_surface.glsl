// The water's surface: normal and depth at every pixel. The height field as triangles, with the normals of its texels; SIDES:
// the water that stands against the walls of the container that face the eye, from the floor up to the surface.
#include "frame.glsl"
#include "pool.glsl"
#include "height_map.glsl"
#if defined(CLIP_GLASS)
#include "glass.glsl"
#endif

#ifdef VERTEX_STAGE
const vec2 CORNERS[6] = vec2[6](vec2(0, 0), vec2(0, 1), vec2(1, 1), vec2(0, 0), vec2(1, 1), vec2(1, 0));
out vec3 at;
flat out vec3 outward;  // of a wall

// Height of the water at a node of the mesh; at the floor where there is none.
vec3 node(ivec2 i) {
  ivec2 texel = min(i * numbers.w, textureSize(height_surface, 0) - 1);
  vec2 xz = ((vec2(texel) + 0.5) / vec2(textureSize(height_surface, 0)) - height_place.zw) / height_place.xy;
  vec4 s = texelFetch(height_surface, texel, 0);
  return vec3(xz.x, s.y > 0.0 ? s.x : floor_plane.x, xz.y);
}

#ifdef SIDES
const int PIECES = 96;

void main() {
  int piece = gl_VertexID / 6;
  vec2 corner = CORNERS[gl_VertexID % 6];
  vec4 s;
#ifdef CLIP_GLASS
  Glass glass = glass_of_container();
  float angle = mix(glass.front.x, glass.front.y, (float(piece) + corner.x) / float(PIECES));
  outward = vec3(cos(angle), 0.0, sin(angle));
  vec2 xz = glass.centre + glass.radius * INSIDE * outward.xz;
  s = water_surface(xz);
  at = vec3(xz.x, s.x, xz.y);
  bool faces_eye = true;
#else
  // Along the two walls of x, then those of z.
  int along_z = numbers.z - 1, along_x = numbers.y - 1;
  int wall = piece < along_z ? 0 : piece < 2 * along_z ? 1 : piece < 2 * along_z + along_x ? 2 : 3;
  int i = piece - (wall == 0 ? 0 : wall == 1 ? along_z : wall == 2 ? 2 * along_z : 2 * along_z + along_x) + int(corner.x);
  ivec2 at_node = wall < 2 ? ivec2(wall == 0 ? 0 : numbers.y - 1, i) : ivec2(i, wall == 2 ? 0 : numbers.z - 1);
  at = node(at_node);
  s = texelFetch(height_surface, min(at_node * numbers.w, textureSize(height_surface, 0) - 1), 0);
  outward = wall < 2 ? vec3(wall == 0 ? -1 : 1, 0, 0) : vec3(0, 0, wall == 2 ? -1 : 1);
  int axis = wall < 2 ? 0 : 2;
  float limit = outward[axis] > 0.0 ? container_max[axis] : container_min[axis];
  bool at_wall = abs(at[axis] - limit) < 1.5 * height_range.z;
  at[axis] = limit;
  bool faces_eye = at_wall && dot(eye.xyz - at, outward) > 0.0;
#endif
  at -= outward * (2e-4 * container_max.w); // behind a body that stands against the wall
  at.y = corner.y > 0.0 ? s.y > 0.0 ? s.x : floor_plane.x : min(container_min.y, s.x);
  gl_Position = faces_eye ? project(to_view(at)) : vec4(2.0, 2.0, 0.0, 1.0);
}
#else
void main() {
  int quad = gl_VertexID / 6, across = numbers.y - 1;
  ivec2 i = ivec2(quad % across, quad / across);
  outward = vec3(0.0);
  float wet = 0.0;
  for (int k = 0; k < 4; ++k) wet += texelFetch(height_surface, min((i + ivec2(k & 1, k >> 1)) * numbers.w,
                                                                   textureSize(height_surface, 0) - 1), 0).y;
  at = node(i + ivec2(CORNERS[gl_VertexID % 6]));
  gl_Position = wet > 0.0 ? project(to_view(at)) : vec4(2.0, 2.0, 0.0, 1.0);
}
#endif
#endif

#ifdef FRAGMENT_STAGE
#if defined(SIDES) && defined(BODIES)
layout(std140, binding = 1) uniform Params {
  ivec4 ends[2];        // of the bodies of each shape
};
#define body_end int[6](ends[0].x, ends[0].y, ends[0].z, ends[0].w, ends[1].x, ends[1].y)
#undef MESHES
#define MESHES 0 // only the background's picture has them
layout(binding = 8) uniform sampler2D background;
#include "scene.glsl"

// Is a body so close behind the wall that no water has room there? The height field goes on through bodies.
bool behind_is_body(vec3 p, vec3 inward) {
  Meeting meeting = meet_scene(p - inward * height_range.z, inward);
  return meeting.what == BODY && meeting.t < 2.0 * height_range.z;
}
#endif
in vec3 at;
flat in vec3 outward;
layout(location = 0) out vec4 result; // outward unit normal in world axes, depth (m)

void main() {
  float t = 1.0 / gl_FragCoord.w;
  if (t < eye.w) discard;
#ifdef SIDES
#ifdef BODIES
  if (behind_is_body(at, -outward)) discard;
#endif
  result = vec4(outward, t);
#ifdef CLIP_GLASS
  result.xz = normalize(at.xz - glass_of_container().centre);
#endif
#else
#ifdef CLIP_GLASS
  Glass glass = glass_of_container();
  if (distance(at.xz, glass.centre) > glass.radius * INSIDE) discard;
#endif
  result = vec4(water_normal(water_surface(at.xz)), t);
#endif
}
#endif
