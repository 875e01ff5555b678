// The filmic curve, the sRGB transfer and dither.
vec3 filmic(vec3 x) {
  return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

vec3 to_srgb(vec3 x) {
  return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, lessThan(x, vec3(0.0031308)));
}

vec3 to_screen(vec3 light) {
  return to_srgb(filmic(0.66 * max(light, 0.0)));
}

// Triangular noise of one step of eight bits hides banding; the same for the same pixel every time.
float dither(uvec2 p) {
  uint h = p.x * 1664525u + p.y * 22695477u + 1013904223u;
  h = (h ^ (h >> 15)) * 2246822519u;
  h = (h ^ (h >> 13)) * 3266489917u;
  h ^= h >> 16;
  return ((float(h & 0xffffu) + float(h >> 16)) / 65535.0 - 1.0) * 0.5 / 255.0;
}
