// A grid of bits: is there water in a cell? (occupancy.h) Rays walk through it from cell to cell: Amanatides & Woo, "A fast
// voxel traversal algorithm for ray tracing", 1987. Include it with `grid` (origin, edge of a cell; m) and `cells` (their
// number along each axis) in the block of parameters. Points and unit directions are in world axes.
layout(std430, binding = 1) readonly buffer Occupancy { uint occupied[]; };

struct Walk {
  ivec3 at;             // cell
  float t;              // m to where the ray enters it
  vec3 next;            // m to where the ray leaves its slab along each axis
  vec3 across;          // m between two planes of the grid
  ivec3 pace;           // cells from one to the next
};

Walk walk_from(vec3 origin, vec3 way) {
  vec3 p = (origin - grid.xyz) / grid.w;
  way = mix(way, vec3(1e-9), lessThan(abs(way), vec3(1e-9)));
  vec3 cell = floor(p), across = grid.w / way;
  return Walk(ivec3(cell), 0.0, (cell + step(0.0, way) - p) * across, abs(across), ivec3(sign(way)));
}

bool in_grid(ivec3 cell) {
  return all(greaterThanEqual(cell, ivec3(0))) && all(lessThan(cell, cells.xyz));
}

bool wet(ivec3 cell) {
  int c = (cell.z * cells.y + cell.y) * cells.x + cell.x;
  return ((occupied[c >> 5] >> uint(c & 31)) & 1u) == 1u;
}

void walk_on(inout Walk walk) {
  walk.t = min(walk.next.x, min(walk.next.y, walk.next.z));
  bvec3 crossed = lessThanEqual(walk.next, vec3(walk.t));
  walk.next += mix(vec3(0.0), walk.across, crossed);
  walk.at += ivec3(mix(vec3(0.0), vec3(walk.pace), crossed));
}

// Metres from a point in the water to the first dry cell; FAR: there is none.
float way_to_air(vec3 origin, vec3 way) {
  Walk walk = walk_from(origin, way);
  while (in_grid(walk.at) && wet(walk.at)) walk_on(walk);
  return in_grid(walk.at) ? walk.t : FAR;
}

// Metres of wet cells on a way of t metres that begins in the grid.
float wet_way(vec3 origin, vec3 way, float t) {
  Walk walk = walk_from(origin, way);
  float sum = 0.0;
  while (in_grid(walk.at) && walk.t < t) {
    float begin = walk.t;
    bool in_water = wet(walk.at);
    walk_on(walk);
    if (in_water) sum += min(walk.t, t) - begin;
  }
  return sum;
}
