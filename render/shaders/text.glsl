// Characters of the bitmap font, white on a dark veil so that they can be read over anything.
layout(std140, binding = 1) uniform Text {
  vec4 page;            // picture size in pixels, scale
};

#ifdef VERTEX_STAGE
struct Glyph {
  vec2 place;
  uint index, unused;
};
layout(std430, binding = 0) readonly buffer Glyphs { Glyph glyphs[]; };
flat out uint index;
noperspective out vec2 cell; // place in the glyph's cell of 6 x 11 font pixels, one of them left and above

const vec2 CORNERS[6] = vec2[6](vec2(0, 0), vec2(0, 1), vec2(1, 1), vec2(0, 0), vec2(1, 1), vec2(1, 0));

void main() {
  Glyph glyph = glyphs[gl_VertexID / 6];
  cell = CORNERS[gl_VertexID % 6] * vec2(6.0, 11.0) - 1.0;
  index = glyph.index;
  vec2 pixel = glyph.place + cell * page.z;
  gl_Position = vec4(vec2(2.0, -2.0) * pixel / page.xy + vec2(-1.0, 1.0), 0.0, 1.0);
}
#endif

#ifdef FRAGMENT_STAGE
layout(std430, binding = 1) readonly buffer Font { uint rows[]; };
flat in uint index;
noperspective in vec2 cell;
layout(location = 0) out vec4 result; // premultiplied

void main() {
  ivec2 at = ivec2(floor(cell));
  bool inside = at.x >= 0 && at.x < 5 && at.y >= 0 && at.y < 9;
  bool ink = inside && ((rows[index * 9u + uint(max(at.y, 0))] >> uint(4 - clamp(at.x, 0, 4))) & 1u) == 1u;
  result = ink ? vec4(1.0) : vec4(0.0, 0.02, 0.04, 0.45);
}
#endif
