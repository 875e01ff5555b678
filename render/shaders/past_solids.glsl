// Share of the light that passes the solids of a map of heights to a place in it, at a height. Percentage-closer filtering
// over 4·4 texels, with the fractional place as weights so that edges are smooth.
float past_solids(sampler2D solids, vec2 place, float height) {
  vec2 size = vec2(textureSize(solids, 0));
  vec2 at = place * size - 0.5;
  vec2 f = fract(at);
  vec2 base = (floor(at) + 0.5) / size;
  vec4 a = vec4(lessThan(textureGather(solids, base + vec2(-0.5, -0.5) / size), vec4(height)));
  vec4 b = vec4(lessThan(textureGather(solids, base + vec2(1.5, -0.5) / size), vec4(height)));
  vec4 c = vec4(lessThan(textureGather(solids, base + vec2(-0.5, 1.5) / size), vec4(height)));
  vec4 d = vec4(lessThan(textureGather(solids, base + vec2(1.5, 1.5) / size), vec4(height)));
  // Rows of texels from bottom to top; gather's order is (0,1) (1,1) (1,0) (0,0).
  vec4 weight = vec4(1.0 - f.x, 1.0, 1.0, f.x);
  float sum = (1.0 - f.y) * dot(vec4(a.wz, b.wz), weight) + dot(vec4(a.xy, b.xy), weight) +
              dot(vec4(c.wz, d.wz), weight) + f.y * dot(vec4(c.xy, d.xy), weight);
  return sum / 9.0;
}
