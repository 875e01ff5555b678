// Where sunlight lands that the water's surface takes in at the points of a grid: Eq. 3, carried to the floor or to the first
// solid in the way. Solids are met in a map of their heights: from the floor's depth, the height seen where the light would
// arrive gives the next guess (Shah, Konttinen & Pattanaik, "Caustics Mapping", 2007).
#include "frame.glsl"
#include "screen.glsl"

#ifdef FRAGMENT_STAGE
layout(std140, binding = 1) uniform Params {
  vec4 grid;            // x and z of its first point, distance of points, m; refractive index
  vec4 texture_place, slope, walls; // height_place, height_slope, caustic_walls of pool.glsl
  vec4 u, v, way;       // the map's axes; unit, the refracted sunlight; height of the floor, m
};
#include "height_beyond.glsl"
#include "fresnel.glsl"
#ifdef SOLIDS
layout(binding = 9) uniform sampler2D solids; // height along the map's axis, m
#endif
layout(location = 0) out vec4 landing; // place in the map, [0, 1]; light taken in by a square metre of the ground, in the sun's;
                                       // height of the surface, m

vec2 map_place(vec3 p) {
  return vec2(dot(p, u.xyz) + u.w, dot(p, v.xyz) + v.w);
}

// Metres from p along d to where it lands.
float flight(vec3 p, vec3 d) {
  float to_floor = max((way.w - p.y) / d.y, 0.0), t = to_floor;
#ifdef SOLIDS
  for (int i = 0; i < 4; ++i) {
    float height = texelFetch(solids, ivec2(map_place(p + d * t) * vec2(textureSize(solids, 0))), 0).x;
    t = clamp((height + dot(p, way.xyz)) / -dot(d, way.xyz), 0.0, to_floor);
  }
#endif
  return t;
}

void main() {
  vec2 xz = grid.xy + floor(gl_FragCoord.xy) * grid.z;
  vec4 surface = surface_beyond(xz, texture_place, slope, walls);
  vec3 p = vec3(xz.x, surface.x, xz.y), up = vec3(-surface.z, 1.0, -surface.w), normal = normalize(up);
  vec3 d = refract(-sun_direction.xyz, normal, 1.0 / grid.w);
  float facing = dot(normal, sun_direction.xyz);
  float taken = surface.y * max(dot(up, sun_direction.xyz), 0.0) * (1.0 - fresnel(facing, grid.w));
  bool lands = facing > 0.0 && d.y < -0.05;
  landing = vec4(map_place(lands ? p + d * flight(p, d) : p), lands ? taken : 0.0, p.y);
}
#endif
