// Normals of the iso-surface from the particles around it (Xiao, Zhang, Yang 2017, section 3.3): the gradient of a kernel
// sum (Eq. 2), the direction in which the particles vary least (Eqs. 3, 4), and the latter as far as both agree (Eqs. 5, 6).
// The colours of the particles mix in the field's weights.
#include "frame.glsl"
#define OUTPUTS 2 // outward unit normal in world axes, depth; colour, linear, alpha 0 on a wall
#define FORMAT rgba32f
#include "tile_pass.glsl"
#ifndef VERTEX_STAGE
#include "raycast_field.glsl"
layout(binding = 14) uniform samplerBuffer colours; // linear; –; without TINTED one for all
layout(binding = 0) uniform sampler2D surface;      // depth, negative where the ray comes out of water

// One rotation of Jacobi's method, which makes a[p][q] zero; the columns of v are the axes.
void rotate_axes(inout mat3 a, inout mat3 v, int p, int q) {
  float apq = a[p][q];
  if (abs(apq) < 1e-20) return;
  float theta = (a[q][q] - a[p][p]) / (2.0 * apq);
  float t = (theta < 0.0 ? -1.0 : 1.0) / (abs(theta) + sqrt(theta * theta + 1.0));
  float c = inversesqrt(t * t + 1.0), s = t * c;
  mat3 turn = mat3(1.0);
  turn[p][p] = turn[q][q] = c;
  turn[q][p] = s;
  turn[p][q] = -s;
  a = transpose(turn) * a * turn;
  v = v * turn;
}

// Eigenvector of the least eigenvalue of a covariance (Jacobi 1846; four sweeps are exact to rounding). false: no direction
// is the least by more than rounding, as around one particle or two.
bool least_axis(mat3 a, out vec3 axis) {
  mat3 v = mat3(1.0);
  for (int sweep = 0; sweep < 4; ++sweep) {
    rotate_axes(a, v, 0, 1);
    rotate_axes(a, v, 0, 2);
    rotate_axes(a, v, 1, 2);
  }
  vec3 value = vec3(a[0][0], a[1][1], a[2][2]);
  float least = min(value.x, min(value.y, value.z)), most = max(value.x, max(value.y, value.z));
  float middle = value.x + value.y + value.z - least - most;
  axis = least == value.x ? v[0] : least == value.y ? v[1] : v[2];
  return middle - least > 1e-4 * most && most > 1e-5;
}

// Sums around a point in units of the reach, which keeps them precise.
float weights = 0.0;
vec3 gradient = vec3(0.0), first = vec3(0.0), diagonal = vec3(0.0), off = vec3(0.0);

// A particle, or its image in a wall, at x.
void add(vec3 x) {
  float q = length(x), rest = max(1.0 - q, 0.0), w = max(1.0 - q * q * q, 0.0);
  gradient -= x * (rest * rest / max(q, 1e-6)); // Eq. 2 with the spiky kernel
  weights += w;
  first += w * x;
  diagonal += w * x * x;
  off += w * x.xxy * x.yzz;
}

void pass(ivec2 at) {
  float depth = texelFetch(surface, at, 0).x;
  result_0 = result_1 = vec4(0.0);
  if (depth == 0.0) return;
  vec3 p = eye.xyz + to_world(vec3(ray_of(at), -1.0)) * abs(depth);
  float h = field_of.x, reach = field_of.w;
  vec4 mixed = vec4(0.0);
  int near = walls_within(p, reach);
  EACH_NEIGHBOUR(p, max(reach, h), sphere, i)
    vec3 x = (sphere.xyz - p) / reach;
    add(x);
#ifdef TINTED
    float edge = 2.0 * sphere.w;
    mixed += vec4(texelFetch(colours, i).rgb, 1.0) * (edge * edge * edge * kernel(length(x) * reach / h));
#endif
    for (int image = near; image != 0; image = (image - 1) & near) {
      vec3 twin = sphere.xyz, no_way = vec3(0.0);
      mirror(image, twin, no_way);
      add((twin - p) / reach);
    }
  END_NEIGHBOURS
  vec3 basic = dot(gradient, gradient) > 1e-12 ? normalize(gradient) : -normalize(to_world(vec3(ray_of(at), -1.0)));
  vec3 normal = basic;
#ifdef PCA
  vec3 mean = first / max(weights, 1e-6);
  diagonal = diagonal / max(weights, 1e-6) - mean * mean;
  off = off / max(weights, 1e-6) - mean.xxy * mean.yzz;
  vec3 least;
  if (least_axis(mat3(diagonal.x, off.x, off.y, off.x, diagonal.y, off.z, off.y, off.z, diagonal.z), least)) {
    least = dot(least, basic) < 0.0 ? -least : least;
    float w = blend.z < 0.0 ? min(1.0, exp(blend.x * (dot(basic, least) - blend.y))) : blend.z;
    normal = normalize(mix(basic, least, w));
  }
#endif
  vec2 walls = room(to_world(vec3(ray_of(at), -1.0)));
  bool at_wall = abs(depth) <= walls.x * (1.0 + 1e-5) || -depth >= walls.y * (1.0 - 1e-5);
  if (at_wall) normal = wall_normal(p);
#ifdef TINTED
  vec3 colour = mixed.rgb / max(mixed.a, 1e-12);
#else
  vec3 colour = texelFetch(colours, 0).rgb; // all particles share it
#endif
  result_0 = vec4(normal, depth);
  result_1 = vec4(colour, at_wall ? 0.0 : 1.0);
}
#endif
