// The baseline: the bilateral filter on depths, iterated (Green, "Screen Space Fluid Rendering for Games", 2010; Imai et
// al., "Real-Time Screen-Space Liquid Rendering with Two-Sided Refractions", 2014). The spatial standard deviation is a
// third of half the window.
#include "smoothing.glsl"
#ifndef VERTEX_STAGE
vec2 smoothed(ivec2 at, vec2 middle) {
  int taps = int(window.x);
  vec2 own = 1.0 / middle, sum = vec2(0.0), weights = vec2(0.0);
  for (int b = -taps; b <= taps; ++b) {
    for (int a = -taps; a <= taps; ++a) {
      ivec2 to = at + ivec2(a, b);
      vec2 w = inverse_at(to);
      if (w.x <= 0.0) continue;
      vec2 z = 1.0 / w, dz = (z - own) / window.z;
      vec2 weight = exp(-4.5 * float(a * a + b * b) / (window.x * window.x) - 0.5 * dz * dz);
      sum += weight * z;
      weights += weight;
    }
  }
  return weights / sum;
}
#endif
