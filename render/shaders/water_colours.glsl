// Colours of the water, see water_colours.h; TINTED: there are some. Include it after pool.glsl.
#ifdef TINTED
layout(binding = 12) uniform samplerBuffer water_colours;

// Mean colour of a column, between the places of the grid. Layer 0: the water below, 1: what hangs over it.
vec3 water_colour(vec2 xz, int layer) {
  ivec2 size = colour_numbers.xy;
  vec2 at = clamp((xz - colour_grid.xy) / colour_grid.z, vec2(0.0), vec2(size - 1));
  ivec2 low = min(ivec2(at), max(size - 2, ivec2(0))), high = min(low + 1, size - 1);
  vec2 share = at - vec2(low);
  int first = layer * size.x * size.y, row = first + low.y * size.x, next = first + high.y * size.x;
  return mix(mix(texelFetch(water_colours, row + low.x).rgb, texelFetch(water_colours, row + high.x).rgb, share.x),
             mix(texelFetch(water_colours, next + low.x).rgb, texelFetch(water_colours, next + high.x).rgb, share.x), share.y);
}
#endif

// What is left of light on a way of so many metres in coloured water: less of the colour where it is thin.
vec3 tinted(vec3 light, vec2 xz, int layer, float metres) {
#ifdef TINTED
  return light * mix(vec3(1.0), water_colour(xz, layer), 1.0 - exp(-metres / colour_grid.w));
#else
  return light;
#endif
}
