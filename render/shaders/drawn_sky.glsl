// The sky of a drawing: three flat colours, a bank of cumulus clouds in the colour of the horizon, and a flat sun. Include it
// after frame.glsl.

// The part of a pixel on the inner side of an edge `distance` away, both as an angle; what is mirrored is as sharp.
float within(float distance) {
  return clamp(distance * lens.w / (2.0 * lens.y) + 0.5, 0.0, 1.0);
}

// Height of a row of `count` round puffs over the angle x all around; each has its own size.
float puffs(float x, float count, float seed) {
  float at = x / (2.0 * PI) * count + seed, own = floor(at);
  float highest = 0.0;
  for (float k = -1.0; k < 1.5; ++k) {
    float cell = mod(own + k, count);
    float size = 0.55 + 0.45 * fract(sin(cell * 12.9898 + seed) * 43758.5453);
    float aside = (at - own - k - 0.5) / size;
    highest = max(highest, size * sqrt(max(1.0 - aside * aside, 0.0)));
  }
  return highest;
}

// Large puffs with small ones on their backs.
float cumulus(float x, float seed) {
  float swell = 0.5 + 0.5 * cos(3.0 * x + seed) * cos(2.0 * x - 2.0 * seed);
  return 0.25 + 0.75 * swell * puffs(x, 41.0, seed) + 0.3 * puffs(x, 97.0, seed + 3.7);
}

vec3 sky(vec3 d) {
  float around = atan(d.z, d.x), height = asin(clamp(d.y, -1.0, 1.0));
  vec3 colour = mix(drawn_sky[0].rgb, drawn_sky[1].rgb, within(0.42 - height));
  float from_sun = distance(d, sun_direction.xyz);
  colour = mix(colour, mix(drawn_sky[2].rgb, vec3(1.0), 0.6), sun_direction.w * within(0.055 - from_sun));
  vec3 behind = mix(drawn_sky[1].rgb, drawn_sky[2].rgb, 0.45);
  colour = mix(colour, behind, within(0.13 * cumulus(around, 1.3) - height));
  return mix(colour, drawn_sky[2].rgb, within(0.085 * cumulus(around + 0.4, 4.1) - height));
}

vec3 sky_at_horizon(vec3 d) {
  return drawn_sky[2].rgb;
}

vec3 sky_average(vec3 normal) {
  return mix(drawn_sky[2].rgb * drawn_shade.rgb, mix(drawn_sky[1].rgb, drawn_sky[2].rgb, 0.5), 0.5 + 0.5 * normal.y);
}
