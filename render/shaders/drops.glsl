// Balls of water in the air: each pixel's ray is mirrored at the ball, and bent through it to what lies behind: the sky, or the
// picture where the ray comes down to the height of the water.
#include "frame.glsl"
#include "sphere.glsl"
#include "pool.glsl"

#ifdef VERTEX_STAGE
layout(std430, binding = 1) readonly buffer Spheres { vec4 spheres[]; }; // centre and radius, colour
flat out vec4 centre;   // in world axes; radius
flat out vec3 colour;
noperspective out vec2 at; // x and y of the pixel's ray

const vec2 CORNERS[6] = vec2[6](vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 0), vec2(1, 1), vec2(0, 1));

void main() {
  centre = spheres[2 * (gl_VertexID / 6)];
  colour = spheres[2 * (gl_VertexID / 6) + 1].rgb;
  vec3 c = to_view(centre.xyz);
  vec4 bounds = bounds_of(c, centre.w);
  at = mix(bounds.xy, bounds.zw, CORNERS[gl_VertexID % 6]);
  gl_Position = hidden(c, centre.w) ? vec4(2.0, 2.0, 0.0, 1.0) : vec4(at / lens.xy, 0.0, 1.0);
}
#endif

#ifdef FRAGMENT_STAGE
#include "sky.glsl"
#include "sun.glsl"
#include "fresnel.glsl"
layout(binding = 0) uniform sampler2D behind;  // the picture without drops
flat in vec4 centre;
flat in vec3 colour;
noperspective in vec2 at;
layout(location = 0) out vec4 result;

// What a ray sees that leaves the ball downwards: the picture where it meets the height of the water, if that is in it.
vec3 light_below(vec3 p, vec3 way) {
  float t = max(p.y - height_range.y, 4.0 * centre.w) / max(-way.y, 1e-3);
  vec3 v = to_view(p + way * t);
  vec2 there = v.xy / (max(-v.z, eye.w) * lens.xy);
  vec2 pixel = clamp((there * 0.5 + 0.5) * lens.zw, vec2(0.0), lens.zw - 1.0);
  return texelFetch(behind, ivec2(pixel), 0).rgb;
}

void main() {
  vec3 ray = to_world(vec3(at, -1.0)), way = normalize(ray), from = eye.xyz - centre.xyz;
  // Measured from the foot of the perpendicular, which keeps small balls far away precise.
  float middle = -dot(from, way);
  vec3 foot = from + way * middle;
  float h2 = centre.w * centre.w - dot(foot, foot);
  if (h2 <= 0.0) discard;
  float t = middle - sqrt(h2), depth = t / length(ray);
  if (depth < eye.w) discard;
  vec3 normal = (from + way * t) / centre.w, p = eye.xyz + way * t;

  vec3 in_it = refract(way, normal, 1.0 / optics.x);
  float chord = -2.0 * centre.w * dot(in_it, normal);
  vec3 far_normal = normalize(normal * centre.w + in_it * chord);
  vec3 out_of_it = refract(in_it, -far_normal, optics.x);
  out_of_it = out_of_it == vec3(0.0) ? in_it : out_of_it;
  vec3 through = out_of_it.y > 0.0 ? sky(out_of_it) : light_below(p + in_it * chord, out_of_it);

  vec3 mirrored = reflect(way, normal), half_way = normalize(sun_direction.xyz - way);
  float glint = 12.0 * pow(max(dot(half_way, normal), 0.0), 300.0);
  vec3 sky_seen = mirrored.y > 0.0 ? sky(mirrored) : light_below(p, mirrored);
  vec3 sun_seen = sun_colour.rgb * sun_past_solids(p) * glint * 0.05;
  float mirror = fresnel(-dot(normal, way), optics.x);
#ifdef TINTED
  through *= mix(vec3(1.0), colour, 1.0 - exp(-chord / colour_grid.w));
#endif
  result = vec4(mix(through * exp(-absorption.rgb * chord), sky_seen, mirror) + sun_seen, 1.0);
  gl_FragDepth = depth_of(depth);
}
#endif
