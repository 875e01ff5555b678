// One triangle that covers the target. With TILES: only the picture's tiles with water in them, a quad each.
#ifdef VERTEX_STAGE
layout(location = 0) out vec2 place; // [-1, 1]

#ifdef TILES
layout(std430, binding = 7) readonly buffer Tiles { uint tiles[]; };

void main() {
  const vec2 CORNERS[6] = vec2[6](vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 0), vec2(1, 1), vec2(0, 1));
  int tile = gl_VertexID / 6, row = int(ceil(lens.z / float(TILES)));
  vec2 pixel = (vec2(tile % row, tile / row) + CORNERS[gl_VertexID % 6]) * float(TILES);
  place = min(pixel / lens.zw, vec2(1.0)) * 2.0 - 1.0;
  gl_Position = tiles[tile] == 1u ? vec4(place, 0.0, 1.0) : vec4(2.0, 2.0, 0.0, 1.0);
}
#else
void main() {
  place = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(place, 0.0, 1.0);
}
#endif
#else
layout(location = 0) in vec2 place;
#endif
