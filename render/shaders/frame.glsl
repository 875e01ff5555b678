// What every shader knows about the picture: RenderFrameBlock of picture.h.
layout(std140, binding = 0) uniform Frame {
  mat4 world_to_view;   // rotation only: subtract the eye first
  vec4 eye;             // m; near distance
  vec4 lens;            // tan of half the angle of view in x, y; picture size in pixels
  vec4 sun_direction;   // unit, towards the sun; 1 when there is a sun
  vec4 sun_colour;      // irradiance
  vec4 sun_u, sun_v;    // place in the sun map
  vec4 sun_map;         // metres across the map; 1 - 1/n, the bending of light at the surface; the water's level, m
  vec4 absorption;      // 1/m; F0
  vec4 scattering;      // 1/m
  vec4 reflectance;     // of a metal
  vec4 sky_zenith, sky_horizon;
  vec4 floor_colour[2];
  vec4 floor_plane;     // level, tile size, distance at which tiles fade out
  vec4 container_min;   // m; 1 when it is drawn
  vec4 container_max;   // m; size of the scene
  // of drawn pictures (DRAWN)
  vec4 drawn_levels;    // l of Eq. 6; 1: its ceiling; shift of the levels; width of outlines, pixels
  vec4 drawn_regions;   // T_bc, T_dc, F_bc, F_dc of Eq. 7
  vec4 drawn_ink;       // linear; cosine of the angle between normals beyond which an edge is a crease
  vec4 drawn_shade;     // what shadow leaves of a colour
  vec4 drawn_sky[3];    // overhead, half way, at the horizon
  vec4 drawn_floor[2];  // tiles, the lines between them
};

const float PI = 3.14159265359;
const float FAR = 1e9;

// The ray through a place on the screen in [-1, 1]: its length along the view axis is 1, so that a parameter t along it
// is the depth along the view axis.
vec3 view_ray(vec2 place) {
  return vec3(place * lens.xy, -1.0);
}

// An averaged normal may look away from the eye at a silhouette: turn it until the ray just comes in. Unit vectors.
vec3 facing_eye(vec3 normal, vec3 way) {
  return normalize(normal - way * max(dot(normal, way) + 0.02, 0.0));
}

vec3 to_world(vec3 view_vector) {
  return view_vector * mat3(world_to_view); // transposed: a rotation
}

vec3 to_view(vec3 world_point) {
  return mat3(world_to_view) * (world_point - eye.xyz);
}

// Clip coordinates of a point in view space; depth is reversed and reaches to infinity.
vec4 project(vec3 p) {
  return vec4(p.xy / lens.xy, eye.w, -p.z);
}

float depth_of(float t) {
  return eye.w / t;
}
