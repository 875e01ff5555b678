// Light in a drawing: a few levels of it, with sharp edges between them (Rocha Neto, Guimarães, Apolinário, Mello 2014,
// section III-D). Include it after frame.glsl.

// Eq. 6, of which the print forgets to multiply by l: the cosine between light and normal, quantised.
float level_of_light(float cosine) {
  float x = drawn_levels.x * max(cosine, 0.0) + drawn_levels.z;
  bool bright = drawn_levels.y > 0.0;
  return clamp(bright ? ceil(x) : floor(x), bright ? 1.0 : 0.0, drawn_levels.x) / drawn_levels.x;
}

const int DARK = 0, MEDIUM = 1, BRIGHT = 2;

int region_of_light(float level) {
  return level > drawn_regions.x ? BRIGHT : level < drawn_regions.y ? DARK : MEDIUM;
}

// Eq. 7, of which the print exchanges the two factors: bright levels are made brighter, dark ones darker.
float drawn_light(float level) {
  int region = region_of_light(level);
  return level * (region == BRIGHT ? drawn_regions.z : region == DARK ? drawn_regions.w : 1.0);
}

// ---- Lines -----------------------------------------------------------------------------------------------------------

const float DRAWN_EDGE = 0.35; // half of the width of the container's edges, in that of outlines

// The part of a pixel that a line covers whose middle is `distance` pixels away.
float line_coverage(float distance, float half_width) {
  return clamp(half_width + 0.5 - abs(distance), 0.0, 1.0) * min(2.0 * half_width, 1.0);
}
