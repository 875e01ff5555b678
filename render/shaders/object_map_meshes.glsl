// Meshes as the plane water around them shows them: every corner is drawn where it is seen (see object_map.glsl; EYES is 0). Plane
// water bends straight edges, and where an edge goes through the surface it has a kink: large triangles are drawn in pieces.
#include "frame.glsl"
#include "body.glsl"
#include "pool.glsl"
#include "plane_water.glsl"

layout(std140, binding = 1) uniform Which {
  ivec4 which;          // body, object, pieces along the edge of a triangle; –
};

#ifdef VERTEX_STAGE
layout(std430, binding = 1) readonly buffer Corners {
  float corners[];      // position (m) and unit normal of each corner, in the body's own axes
};
out vec3 at, normal;
out float over;         // m over the plane
out float path;         // m from the plane along the ray

// Weights of a triangle's corners in a corner of one of its pieces, which lie in rows from the first corner on: row r has 2 r + 1.
vec3 in_triangle(int piece, int corner) {
  int row = int(sqrt(float(piece) + 0.5)), k = piece - row * row, column = k / 2;
  ivec2 at_corner = (k & 1) == 0 ? ivec2(row + int(corner > 0), column + int(corner == 2))
                                 : ivec2(row + int(corner == 1), column + int(corner > 0));
  vec2 share = vec2(at_corner.x - at_corner.y, at_corner.y) / float(which.z);
  return vec3(1.0 - share.x - share.y, share);
}

void main() {
  Body body = bodies[which.x];
  vec4 plane = objects[which.y].plane;
  int pieces = which.z * which.z, triangle = gl_VertexID / (3 * pieces), i = 18 * triangle;
  vec3 weights = in_triangle(gl_VertexID / 3 % pieces, gl_VertexID % 3), p = vec3(0.0), n = vec3(0.0);
  for (int corner = 0; corner < 3; ++corner, i += 6) {
    p += weights[corner] * vec3(corners[i], corners[i + 1], corners[i + 2]);
    n += weights[corner] * vec3(corners[i + 3], corners[i + 4], corners[i + 5]);
  }
  at = body.position.xyz + rotate(body.rotation, p);
  normal = rotate(body.rotation, n);
  over = height_over(plane, at);
#ifdef REFLECTED
  vec3 shown = mirrored(plane, at), view = to_view(shown);
  path = abs(over) * distance(eye.xyz, shown) / max(height_over(plane, eye.xyz) + abs(over), 1e-6);
#else
  vec3 shown = refraction_point(plane, at, optics.x), view = to_view(shown);
  path = distance(shown, at);
#endif
  vec4 clip = project(view);
  clip.xy *= lens.zw / (lens.zw + 2.0 * optics.y);
  clip.z = clip.w / (1.0 + path);
  gl_Position = clip;
}
#endif

#ifdef FRAGMENT_STAGE
#include "solid_light.glsl"
in vec3 at, normal;
in float over, path;
layout(location = 0) out vec4 colour;   // linear light, 1
layout(location = 1) out float way;     // m from the plane along the ray

void main() {
#ifdef REFLECTED
  if (over < 0.0) discard;
#else
  if (over > 0.0) discard;
#endif
  colour = vec4(bodies[which.x].colour.rgb * solid_light(at, normalize(normal)), 1.0);
  way = max(path, 1e-5);
}
#endif
