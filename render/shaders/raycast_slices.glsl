// The depths at which a ray can meet the field, as bits: the depth of the grid's box is cut into slices, and a texel has a bit for
// each slice in which a particle could have any share in the field. The first and the last bit stand for all that is before
// and beyond the box. Include it after a block of parameters with `grid` and `cells` (neighbours.glsl) and `field_of`.
const int SLICES = 128;

// Depth at which slice 1 begins, depth of a slice.
vec2 slices() {
  vec3 size = vec3(cells.xyz) * grid.w + 2.0 * field_of.x, middle = to_view(grid.xyz + 0.5 * vec3(cells.xyz) * grid.w);
  vec3 axis = abs(to_world(vec3(0.0, 0.0, -1.0)));
  float begin = max(-middle.z - 0.5 * dot(axis, size), eye.w), end = max(-middle.z + 0.5 * dot(axis, size), begin);
  return vec2(begin, max((end - begin) / float(SLICES - 2), 1e-6));
}

// A hair of a slice more, so that where a slice begins is always in it.
int slice_at(float depth, vec2 s) {
  return int(clamp(floor((depth - s.x) / s.y + 1e-3) + 1.0, 0.0, float(SLICES - 1)));
}

float begin_of(int slice, vec2 s) {
  return slice == 0 ? eye.w : s.x + float(slice - 1) * s.y;
}

// The bits of the slices from 0 up to one, without it.
uvec4 slices_before(int slice) {
  ivec4 count = clamp(slice - ivec4(0, 32, 64, 96), 0, 32);
  uvec4 below = (uvec4(1) << uvec4(count & 31)) - 1u;
  return mix(below, uvec4(0xffffffffu), equal(count, ivec4(32)));
}

// The first slice of the set from one on; SLICES: there is none.
int next_slice(uvec4 set, int from) {
  uvec4 rest = set & ~slices_before(from);
  ivec4 first = findLSB(rest) + ivec4(0, 32, 64, 96);
  ivec4 found = mix(first, ivec4(SLICES), equal(rest, uvec4(0)));
  return min(min(found.x, found.y), min(found.z, found.w));
}
