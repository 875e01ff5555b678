// The field whose iso-surface is the water's (Xiao, Zhang, Yang 2017, Eq. 1): the sum over particles of mass times kernel, as
// a share of the rest density, so that it is about 1 within water and 1/2 where a flat pool ends.
layout(std140, binding = 1) uniform Params {
  vec4 grid;            // origin, edge of a cell; m
  ivec4 cells;
  vec4 field_of;        // support h, m; iso-value; spacing of particles at rest, m; radius R of the normals, m
  vec4 blend;           // d, k of Eq. 6; fixed weight of the PCA normal, negative: Eq. 6; refractive index
};
#include "container.glsl"
#include "neighbours.glsl"

// Cubic spline (Monaghan 1992) of support h times the volume of a particle at rest.
float kernel(float q) {
  float rest = 1.0 - q;
  float inner = 6.0 * q * q * (q - 1.0) + 1.0, outer = 2.0 * rest * rest * rest;
  return q < 0.5 ? inner : max(outer, 0.0);
}

vec4 kernel(vec4 q) {
  vec4 outer = max(1.0 - q, 0.0), inner = max(0.5 - q, 0.0);
  return 2.0 * outer * outer * outer - 8.0 * inner * inner * inner;
}

// The field at four points in ascending order on a line, p + way t (m, unit): one visit of the particles serves them all, and
// they cost more than the kernels. A sum over the images of particles in walls is one over the particles along the image of
// the line.
vec4 field_along(vec3 p, vec3 way, vec4 t) {
  float h = field_of.x, middle = 0.5 * (t.x + t.w), half_way = t.w - middle;
  vec3 start = p + way * middle;
  vec4 sum = vec4(0.0), at = (t - middle) / h;
  int near = walls_within(start, h + half_way);
  for (int image = near;; image = (image - 1) & near) {
    vec3 from = start, along = way;
    mirror(image, from, along);
    EACH_ALONG(from, along * half_way, h, sphere, i)
      vec3 c = (sphere.xyz - from) / h;
      float edge = 2.0 * sphere.w;
      sum += edge * edge * edge * kernel(sqrt(max(dot(c, c) + at * (at - 2.0 * dot(c, along)), 0.0)));
    END_NEIGHBOURS
    if (image == 0) break;
  }
  return sum * 8.0 / (PI * h * h * h);
}

// A ray: where it begins, unit direction, its metres in one of the unit that places on it are told in, the spacing of particles at
// rest in that unit.
vec3 origin, way;
float along, spacing;

// That through a pixel; places are depths.
void cast_through(ivec2 at) {
  vec3 ray = to_world(vec3(ray_of(at), -1.0));
  origin = eye.xyz;
  along = length(ray);
  way = ray / along;
  spacing = field_of.z / along;
}

// Places are metres from p.
void cast_from(vec3 p, vec3 unit_way) {
  origin = p;
  way = unit_way;
  along = 1.0;
  spacing = field_of.z;
}

// The field less the iso-value at four places on the ray in ascending order.
vec4 above_iso(vec4 t) {
  return field_along(origin, way, t * along) - field_of.y;
}

// The place between t.x and t.y, where the field is f.x and f.y above the iso-value on different sides of it, at which it is
// just that: of five parts, the first that changes sides, and in it the parabola through one more point.
float narrow(vec2 t, vec2 f) {
  float part = 0.2 * (t.y - t.x), begin = t.x;
  vec4 inner = above_iso(t.x + part * vec4(1.0, 2.0, 3.0, 4.0));
  float before = 2.0 * f.x - inner.x, from = f.x, to = inner.x, after = inner.y; // a straight line before the first point
  for (int k = 1; k <= 4 && (to > 0.0) == (from > 0.0); ++k) {
    before = from;
    from = to;
    to = after;
    after = k < 3 ? inner[k + 1] : f.y;
    begin += part;
  }
  float bend = begin == t.x ? after - 2.0 * to + from : to - 2.0 * from + before;
  // from + b x + a x²: of its roots the one between 0 and 1, where it goes the way that it goes from end to end.
  float a = 0.5 * bend, b = to - from - a, root = sign(to - from) * sqrt(max(b * b - 4.0 * a * from, 0.0));
  float x = clamp(b * root > 0.0 ? -2.0 * from / (b + root) : (root - b) / (2.0 * a), 0.0, 1.0);
  return begin + part * x;
}
