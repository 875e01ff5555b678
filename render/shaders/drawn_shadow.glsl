// Shadows of a drawing: one flat shape with a clean edge. Include it after frame.glsl and sun.glsl.

// A soft edge, which changes by `slope` from pixel to pixel, made as sharp as the picture can show it.
float sharpened(float soft, float slope) {
  return clamp((soft - 0.5) * max(1.0 / max(slope, 1e-6), 1.0) + 0.5, 0.0, 1.0);
}

// 1: in the sun, 0: in the shadow of a solid. `across`: metres that a pixel covers there.
float drawn_past_solids(vec3 p, float across) {
#ifdef SOLID_SHADOW
  float texel = max(sun_map.x, sun_map.y) / float(textureSize(sun_solid, 0).x);
  return sharpened(sun_past_solids(p), 0.33 / texel * across);
#else
  return 1.0;
#endif
}

// 1: in the sun, 0: in the shadow of the water. Where it is covers half of a few particles' neighbourhood, its outline is
// smooth; stray drops have no shadow. `aside`, `along`: a pixel's footprint there, m.
float drawn_past_water(vec3 p, vec3 aside, vec3 along) {
#ifdef WATER_SHADOW
  vec2 at = sun_place(p), texel = 1.0 / vec2(textureSize(sun_water, 0));
  vec4 water = textureLod(sun_water, at, 0.0);
  float east = textureLod(sun_water, at + vec2(texel.x, 0.0), 0.0).z;
  float west = textureLod(sun_water, at - vec2(texel.x, 0.0), 0.0).z;
  float north = textureLod(sun_water, at + vec2(0.0, texel.y), 0.0).z;
  float south = textureLod(sun_water, at - vec2(0.0, texel.y), 0.0).z;
  vec3 slope = ((east - west) / texel.x * sun_u.xyz + (north - south) / texel.y * sun_v.xyz) * 0.5;
  bool below = water.y > dot(p, sun_direction.xyz);
  return 1.0 - (below ? sharpened(water.z, length(vec2(dot(slope, aside), dot(slope, along)))) : 0.0);
#else
  return 1.0;
#endif
}
