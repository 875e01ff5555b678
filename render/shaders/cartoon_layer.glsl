// A layer of drawn water in the picture's resolution, from maps that may have half of it. Where the texels around a pixel are
// of two pieces of water, one in front of the other, the pixel belongs to that which has most of it, and only its texels are
// mixed: so edges stay edges, and are straight lines between the texels instead of steps.
struct Layer {
  float cover;          // share of the pixel that is water
  vec3 normal;          // outward, unit, in world axes
  float depth;          // m along the view axis; 0 where there is no water
};

// `apart`: m, what two pieces of water are apart.
Layer layer_at(sampler2D surfaces, sampler2D maps, float apart) {
  vec2 size = vec2(textureSize(surfaces, 0)), at = gl_FragCoord.xy * size / lens.zw - 0.5;
  ivec2 base = ivec2(floor(at)), last = ivec2(size) - 1;
  vec2 f = at - vec2(base);
  vec4 weights = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
  vec4 texel[4];
  vec3 point[4];
  vec4 front = vec4(0.0); // the nearest texel
  vec3 front_point = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 place = clamp(base + ivec2(i & 1, i >> 1), ivec2(0), last);
    texel[i] = texelFetch(surfaces, place, 0);
    weights[i] = texel[i].w > 0.0 ? weights[i] : 0.0;
    point[i] = to_world(vec3(((vec2(place) + 0.5) / size * 2.0 - 1.0) * lens.xy, -1.0)) * texel[i].w;
    bool nearer = texel[i].w > 0.0 && (front.w == 0.0 || texel[i].w < front.w);
    front = nearer ? texel[i] : front;
    front_point = nearer ? point[i] : front_point;
  }
  vec4 of_front;
  for (int i = 0; i < 4; ++i) {
    vec3 way = point[i] - front_point;
    of_front[i] = abs(dot(way, front.xyz)) < apart || abs(dot(way, texel[i].xyz)) < apart ? 1.0 : 0.0;
  }
  float all = dot(weights, vec4(1.0)), share = dot(weights, of_front);
  weights *= 2.0 * share >= all ? of_front : 1.0 - of_front;
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 4; ++i) sum += weights[i] * vec4(texel[i].xyz, texel[i].w > 0.0 ? 1.0 / texel[i].w : 0.0);
  float cover = textureLod(maps, gl_FragCoord.xy / lens.zw, 0.0).w, edge = max(fwidth(cover), 1e-4);
  cover = all > 0.0 ? clamp((cover - 0.5) / edge + 0.5, 0.0, 1.0) : 0.0;
  return Layer(cover, sum.xyz / max(length(sum.xyz), 1e-6), sum.w > 0.0 ? dot(weights, vec4(1.0)) / sum.w : 0.0);
}
