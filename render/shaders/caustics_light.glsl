// The map of light, irradiance across the refracted sunlight in that of the sun: each triangle of the grid, where it has
// landed, with the light it took in spread over the area that it has there. Triangles thinner than a pixel, as at the bright
// lines, would slip between the pixels' middles: they are widened and as much dimmer. Those that a surface like needles tears far
// apart are shrunk, or filling them would take forever. SOLID_SHADOW: solids over the water keep light from it.
#include "frame.glsl"

#ifdef VERTEX_STAGE
layout(std140, binding = 1) uniform Params {
  vec4 grid;            // x and z of its first point, distance of points, m; –
  vec4 squares;         // number along x; m² of one, on the ground; m² of the map; its pixels along an axis
  vec4 colour;          // which colours it is; –
};
layout(binding = 0) uniform sampler2D landings;
noperspective out vec3 light;
noperspective out vec3 start; // on the surface, m

const vec2 OUTSIDE = vec2(4.0);
const float THINNEST = 0.5, LONGEST = 32.0; // pixels

// Corners of the triangle; every other square is cut along its other diagonal.
ivec2 corner_of(int triangle, int corner) {
  int square = triangle / 2;
  ivec2 at = ivec2(square % int(squares.x), square / int(squares.x));
  ivec2 c = (triangle & 1) == 0 ? ivec2(corner & 1, corner >> 1) : ivec2(1 - (corner & 1), 1 - (corner >> 1));
  return at + (((at.x + at.y) & 1) == 0 ? c : ivec2(1 - c.x, c.y));
}

// Corner i of a triangle that holds the one given, if that is not longer than LONGEST, and is at least THINNEST wide and high.
// Of the two halves of a square one grows to this side and one to that. `area`: of it, px².
vec2 widened(vec2 p[3], int i, inout float area) {
  vec3 lengths = vec3(distance(p[1], p[2]), distance(p[2], p[0]), distance(p[0], p[1]));
  float longest = max(lengths.x, max(lengths.y, lengths.z));
  float shrink = min(LONGEST / max(longest, 1e-6), 1.0);
  vec2 middle = (p[0] + p[1] + p[2]) / 3.0;
  for (int k = 0; k < 3; ++k) p[k] = mix(middle, p[k], shrink);
  lengths *= shrink;
  longest *= shrink;
  int apex = longest == lengths.x ? 0 : longest == lengths.y ? 1 : 2;
  vec2 a = p[(apex + 1) % 3], b = p[(apex + 2) % 3];
  vec2 along = longest > 1e-6 ? (b - a) / longest : vec2(1.0, 0.0), across = vec2(-along.y, along.x);
  if (dot(p[apex] - a, across) < 0.0) across = -across;
  float height = dot(p[apex] - a, across);
  float more_height = max(THINNEST - height, 0.0), more_length = max(THINNEST - longest, 0.0);
  area = 0.5 * max(longest, THINNEST) * max(height, THINNEST);
  if (i == apex) return p[i] + across * more_height;
  return p[i] + along * (0.5 * more_length) * (i == (apex + 1) % 3 ? -1.0 : 1.0);
}

void main() {
  int triangle = gl_VertexID / 3, corner = gl_VertexID % 3;
  vec2 p[3];
  float taken[3], heights[3], area;
  for (int i = 0; i < 3; ++i) {
    vec4 landing = texelFetch(landings, corner_of(triangle, i), 0);
    p[i] = landing.xy * squares.w;
    taken[i] = landing.z;
    heights[i] = landing.w;
  }
  vec2 xz = grid.xy + vec2(corner_of(triangle, corner)) * grid.z;
  start = vec3(xz.x, heights[corner], xz.y);
  vec2 at = widened(p, corner, area);
  light = colour.rgb * (taken[corner] * 0.5 * squares.y * squares.w * squares.w / (squares.z * area));
  gl_Position = vec4(taken[0] + taken[1] + taken[2] > 0.0 ? at / squares.w * 2.0 - 1.0 : OUTSIDE, 0.0, 1.0);
}
#endif

#ifdef FRAGMENT_STAGE
#include "sun.glsl"
noperspective in vec3 light;
noperspective in vec3 start;
layout(location = 0) out vec4 result;

void main() {
  result = vec4(max(light, 0.0), 0.0); // rounding at edges may go below
#ifdef SOLID_SHADOW
  float bias = 1.5 * max(sun_map.x, sun_map.y) / float(textureSize(sun_solid, 0).x);
  result *= past_solids(sun_solid, sun_place(start), dot(start, sun_direction.xyz) + bias);
#endif
}
#endif
