// Spheres by ray casting, one quad around each. Compiled as SURFACE (normal, depth and colour of the nearest),
// THICKNESS (metres of water along the eye's ray, added), GAUSSIAN (the same, spread as a Gaussian; TINTED: its colour at the surface) or SUN (the same along the sun's rays, and the height of the
// nearest surface).
#include "frame.glsl"
#include "sphere.glsl"

layout(std140, binding = 1) uniform Splat {
  vec4 splat;           // radius factor, water per chord, target size in pixels
  vec4 splat_more;      // 1 when every particle has a colour, 0 when all share one; -
};

#ifdef VERTEX_STAGE
layout(std430, binding = 0) readonly buffer Spheres { vec4 spheres[]; };
#if defined(SURFACE) || defined(TINTED)
layout(std430, binding = 1) readonly buffer Colours { vec4 colours[]; };
flat out vec4 tint;
#endif
flat out vec4 sphere;   // centre in view space (SUN: along the sun map's axes), radius
noperspective out vec2 at; // SURFACE, THICKNESS: x and y of the pixel's ray; SUN: offset from the centre in metres

const vec2 CORNERS[6] = vec2[6](vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, -1), vec2(1, 1), vec2(-1, 1));

void main() {
  int index = gl_VertexID / 6;
  vec2 corner = CORNERS[gl_VertexID % 6];
  vec4 s = spheres[index];
  float r = s.w * splat.x;
#if defined(SURFACE) || defined(TINTED)
  tint = colours[index * int(splat_more.x)];
#endif
#ifdef SUN
  at = corner * r;
  vec2 uv = vec2(dot(s.xyz, sun_u.xyz) + sun_u.w, dot(s.xyz, sun_v.xyz) + sun_v.w) + at / sun_map.xy;
  sphere = vec4(0.0, 0.0, dot(s.xyz, sun_direction.xyz), r);
  gl_Position = vec4(uv * 2.0 - 1.0, 0.0, 1.0);
#else
  vec3 c = to_view(s.xyz);
  sphere = vec4(c, r);
  vec4 bounds = bounds_of(c, r);
  at = mix(bounds.xy, bounds.zw, corner * 0.5 + 0.5);
  gl_Position = hidden(c, r) ? vec4(2.0, 2.0, 0.0, 1.0) : vec4(at / lens.xy, 0.0, 1.0);
#endif
}
#endif

#ifdef FRAGMENT_STAGE
flat in vec4 sphere;
noperspective in vec2 at;

#ifdef SUN
layout(location = 0) out vec4 result; // thickness, -, -, height

void main() {
  float h2 = sphere.w * sphere.w - dot(at, at);
  if (h2 <= 0.0) discard;
  float h = sqrt(h2);
  result = vec4(2.0 * h * splat.y, 0.0, 0.0, sphere.z + h);
}
#else

// Where the ray meets the sphere: depths of entry and exit; entry > exit when it misses. Measured from the foot of the
// perpendicular from the centre, which stays precise for small spheres far away.
vec2 meet(vec3 ray) {
  float rr = dot(ray, ray);
  float middle = dot(ray, sphere.xyz) / rr;
  vec3 foot = ray * middle - sphere.xyz;
  float h2 = (sphere.w * sphere.w - dot(foot, foot)) / rr;
  float h = sqrt(max(h2, 0.0));
  return h2 > 0.0 ? vec2(middle - h, middle + h) : vec2(1.0, 0.0);
}

#ifdef SURFACE
flat in vec4 tint;
layout(location = 0) out vec4 surface;
layout(location = 1) out vec4 colour;

void main() {
  vec3 ray = vec3(at, -1.0);
  vec2 t = meet(ray);
  if (t.x > t.y || t.x < eye.w) discard;
  surface = vec4(to_world((ray * t.x - sphere.xyz) / sphere.w), t.x);
  colour = tint;
  gl_FragDepth = depth_of(t.x);
}
#else
layout(binding = 0) uniform sampler2D background;
layout(location = 0) out vec4 thickness;

// Depth of what is behind the water.
float depth_behind() {
  float behind = texelFetch(background, ivec2(gl_FragCoord.xy * lens.zw / splat.zw), 0).a;
  return behind > 0.0 ? behind : FAR;
}

#ifdef TINTED
flat in vec4 tint;
layout(binding = 1) uniform sampler2D surface; // 1 / depth
#endif

#ifdef GAUSSIAN
// splat.x is where it is cut off, in standard deviations; splat.y its highest value, in radii.
void main() {
  vec3 ray = vec3(at, -1.0);
  float rr = dot(ray, ray), middle = dot(ray, sphere.xyz) / rr, r = sphere.w / splat.x;
  vec3 foot = ray * middle - sphere.xyz;
  float h2 = dot(foot, foot);
  if (h2 > sphere.w * sphere.w) discard;
  float seen = clamp(0.5 + (depth_behind() - middle) * sqrt(rr) / (2.0 * r), 0.0, 1.0);
  float metres = splat.y * r * exp(-0.5 * h2 / (r * r)) * seen;
#ifdef TINTED
  float front = texelFetch(surface, ivec2(gl_FragCoord.xy * vec2(textureSize(surface, 0)) / splat.zw), 0).x;
  float behind = front > 0.0 ? (middle - 1.0 / front) * sqrt(rr) / (6.0 * r) : 0.0;
  thickness = vec4(tint.rgb, 1.0) * metres * exp(-max(behind, 0.0));
#else
  thickness = vec4(metres, 0.0, 0.0, 0.0);
#endif
}
#else
void main() {
  vec3 ray = vec3(at, -1.0);
  vec2 t = meet(ray);
  if (t.x > t.y) discard;
  float end = min(t.y, depth_behind());
  thickness = vec4(max(end - max(t.x, 0.0), 0.0) * length(ray) * splat.y, 0.0, 0.0, 0.0);
}
#endif
#endif
#endif
#endif
