// The particles around a point, by the cells in which they are sorted (neighbour_grid.h). Include it after a block of
// parameters that begins with `grid` (origin, edge of a cell; m) and `cells` (their number along each axis).
//
//   EACH_NEIGHBOUR(p, reach, sphere, index) … END_NEIGHBOURS
//   EACH_ALONG(p, half_way, reach, sphere, index) … END_NEIGHBOURS
//
// visit every particle nearer than `reach` to p, or to the line from p − half_way to p + half_way, and some more. Particles
// outside the grid are in its cells at the border.
layout(binding = 12) uniform samplerBuffer spheres;     // centre, radius; m
layout(binding = 13) uniform isamplerBuffer cell_start; // of the particles in cell (z size.y + y) size.x + x and, next, their end

ivec3 cell_of(vec3 p) {
  return ivec3(clamp(floor((p - grid.xyz) / grid.w), vec3(0.0), vec3(cells.xyz - 1)));
}

// Of a row of cells in the direction of x, those that reach into the neighbourhood of a line; none: y < x.
ivec2 cells_of_row(int y, int z, vec3 p, vec3 half_way, float reach) {
  vec2 at = vec2(y, z), low = grid.yz + at * grid.w, high = low + grid.w;
  low = mix(low, vec2(-1e30), lessThan(at, vec2(0.5)));
  high = mix(high, vec2(1e30), greaterThan(at, vec2(cells.yz) - 1.5));
  vec2 apart = max(max(low - p.yz, p.yz - high), vec2(0.0));
  float left = max(length(apart) - length(half_way.yz), 0.0);
  float across = abs(half_way.x) + sqrt(max(reach * reach - left * left, 0.0));
  vec2 ends = clamp(floor((p.x + vec2(-across, across) - grid.x) / grid.w), vec2(0.0), vec2(cells.x - 1));
  return left < reach ? ivec2(ends) : ivec2(0, -1);
}

#define EACH_ALONG(p, half_way, reach, sphere, index) \
  { \
    ivec3 low_ = cell_of(p - abs(half_way) - reach), high_ = cell_of(p + abs(half_way) + reach); \
    for (int z_ = low_.z; z_ <= high_.z; ++z_) { \
      for (int y_ = low_.y; y_ <= high_.y; ++y_) { \
        ivec2 x_ = (z_ * cells.y + y_) * cells.x + cells_of_row(y_, z_, p, half_way, reach); \
        int end_ = texelFetch(cell_start, x_.y + 1).x; \
        for (int index = texelFetch(cell_start, x_.x).x; index < end_; ++index) { \
          vec4 sphere = texelFetch(spheres, index);

#define EACH_NEIGHBOUR(p, reach, sphere, index) EACH_ALONG(p, vec3(0.0), reach, sphere, index)
#define END_NEIGHBOURS } } } }
