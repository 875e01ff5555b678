// Ellipsoids and balls by ray casting, one quad around each: Sigg, Weyrich, Botsch, Gross, "GPU-Based Ray-Casting of
// Quadratic Surfaces", 2006. An ellipsoid is the image of the unit ball under a symmetric matrix T; with A = T Tᵀ in view
// space a plane n·x = 0 through the eye touches it where (n·c)² = nᵀA n, which bounds it on the screen, and the ray meets
// it where (x − c)ᵀ A⁻¹ (x − c) = 1.
//
// SPHERES: balls. COLOUR: the particle's colour at the front. DEPTHS: front and back at once, to be blended by the maximum:
// (1 / depth of the front, depth of the back). Otherwise the normal and depth of the front or, with BACK, of the back; of a
// ball, instead of the normal, the way from its centre to the surface, which tells its radius as well. SUBMERGED: backs
// only as far as the first air.
#include "frame.glsl"
#include "sphere.glsl"

#ifdef VERTEX_STAGE
#ifdef SPHERES
struct Ball {
  vec4 centre;          // m; radius
  vec4 colour;          // linear; -
};
layout(std430, binding = 0) readonly buffer Balls { Ball balls[]; };
#else
struct Ellipsoid {
  vec4 centre;          // m; largest semi-axis, m
  vec4 shape[2];        // T: xx, yy, zz, xy; xz, yz, -, -
  vec4 colour;          // linear; -
};
layout(std430, binding = 0) readonly buffer Ellipsoids { Ellipsoid ellipsoids[]; };
flat out vec3 inverse_diagonal, inverse_off; // A⁻¹: xx, yy, zz; xy, xz, yz
#endif
flat out vec4 centre;   // in view space; radius
#ifdef COLOUR
flat out vec3 colour;
#endif
noperspective out vec2 at; // x and y of the pixel's ray

const vec2 CORNERS[6] = vec2[6](vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, -1), vec2(1, 1), vec2(-1, 1));

#ifndef SPHERES
// Lowest and highest x / depth of what touches the planes through the eye, for one axis.
vec2 touching(float c, float d, float across, float mixed, float along) {
  float a = d * d - along, b = c * d + mixed, e = c * c - across;
  float root = sqrt(max(b * b - a * e, 0.0));
  return vec2(b - root, b + root) / a;
}
#endif

void main() {
  vec2 corner = CORNERS[gl_VertexID % 6] * 0.5 + 0.5;
#ifdef SPHERES
  vec4 ball = balls[gl_VertexID / 6].centre;
  centre = vec4(to_view(ball.xyz), ball.w);
#ifdef COLOUR
  colour = balls[gl_VertexID / 6].colour.rgb;
#endif
  vec4 bounds = bounds_of(centre.xyz, centre.w);
#else
  Ellipsoid e = ellipsoids[gl_VertexID / 6];
  centre = vec4(to_view(e.centre.xyz), e.centre.w);
#ifdef COLOUR
  colour = e.colour.rgb;
#endif
  mat3 shape = mat3(vec3(e.shape[0].x, e.shape[0].w, e.shape[1].x), vec3(e.shape[0].w, e.shape[0].y, e.shape[1].y),
                    vec3(e.shape[1].x, e.shape[1].y, e.shape[0].z));
  mat3 turned = mat3(world_to_view) * shape;
  mat3 A = turned * transpose(turned);
  mat3 inverted = inverse(A);
  inverse_diagonal = vec3(inverted[0][0], inverted[1][1], inverted[2][2]);
  inverse_off = vec3(inverted[0][1], inverted[0][2], inverted[1][2]);
  // Where all of it is in front of the eye; else the bounds of the ball around it.
  vec4 bounds = bounds_of(centre.xyz, centre.w);
  if (-centre.z > 1.5 * centre.w) {
    vec2 x = touching(centre.x, -centre.z, A[0][0], A[0][2], A[2][2]);
    vec2 y = touching(centre.y, -centre.z, A[1][1], A[1][2], A[2][2]);
    bounds = vec4(max(vec2(x.x, y.x), -lens.xy), min(vec2(x.y, y.y), lens.xy));
  }
#endif
  at = mix(bounds.xy, bounds.zw, corner);
  gl_Position = hidden(centre.xyz, centre.w) ? vec4(2.0, 2.0, 0.0, 1.0) : vec4(at / lens.xy, 0.0, 1.0);
}
#endif

#ifdef FRAGMENT_STAGE
flat in vec4 centre;
noperspective in vec2 at;

// Depths of entry and exit, entry > exit when the ray misses, and A⁻¹ from the centre to what `offset` is for.
// Measured from where the ray passes the centre's depth, which stays precise for small bodies far away.
#ifdef SPHERES
vec3 weigh(vec3 v) {
  return v / (centre.w * centre.w);
}
#else
flat in vec3 inverse_diagonal, inverse_off;

vec3 weigh(vec3 v) {
  return inverse_diagonal * v + inverse_off.xxy * v.yxx + inverse_off.yzz * v.zzy;
}
#endif

#ifdef SUBMERGED
layout(binding = 0) uniform sampler2D air; // depth at which it begins
#endif

layout(location = 0) out vec4 result;
#ifdef COLOUR
flat in vec3 colour;
#endif

void main() {
  vec3 ray = vec3(at, -1.0);
  vec3 from = ray * -centre.z - centre.xyz;
  vec3 weighed_ray = weigh(ray);
  float a = dot(ray, weighed_ray), b = dot(from, weighed_ray), c = dot(from, weigh(from)) - 1.0;
  float h = b * b - a * c;
  if (h <= 0.0) discard;
  h = sqrt(h);
  float front = -centre.z + (-b - h) / a, back = -centre.z + (-b + h) / a;
#ifdef SUBMERGED
  if (back > texelFetch(air, ivec2(gl_FragCoord.xy), 0).x) discard;
#endif
#ifdef DEPTHS
  if (back < eye.w) discard;
  result = vec4(1.0 / max(front, eye.w), back, 0.0, 0.0);
#else
#ifdef BACK
  float t = back;
#else
  float t = front;
#endif
  if (t < eye.w) discard;
#if defined(COLOUR)
  result = vec4(colour, 1.0);
#elif defined(SPHERES)
  result = vec4(to_world(ray * t - centre.xyz), t);
#else
  result = vec4(to_world(normalize(weigh(ray * t - centre.xyz))), t);
#endif
  gl_FragDepth = depth_of(t);
#endif
}
#endif
