// Local linear regression of the inverse depth along one axis of the picture. A plane has an affine inverse depth, so that
// a least-squares line keeps it whatever the weights are, up to its very boundary. Local regression: Cleveland, "Robust
// Locally Weighted Regression and Smoothing Scatterplots", 1979; Fan & Gijbels, "Local Polynomial Modelling", 1996.
#include "smoothing.glsl"
#ifndef VERTEX_STAGE
// (1 - t²)², close to a Gaussian; of a square.
vec2 kernel(vec2 t2) {
  vec2 k = max(1.0 - t2, 0.0);
  return k * k;
}

// window.w: a half window in pixels below which this step leaves the water as it is.
vec2 smoothed(ivec2 at, vec2 middle) {
  int taps = int(window.x);
  vec2 half_window = window.y * middle * lens.w / (2.0 * lens.y); // pixels
  bvec2 too_small = lessThan(half_window, vec2(window.w));
  half_window = max(half_window, 1.5);
  vec2 stride = max(vec2(1.0), half_window / (window.x + 0.5));
  vec2 per_range = 1.0 / (window.z * middle * middle); // a depth that differs by d has an inverse that differs by d w²
  vec2 per_half = 1.0 / half_window;
  vec2 s0 = vec2(1.0), s1 = vec2(0.0), s2 = vec2(0.0), t0 = vec2(0.0), t1 = vec2(0.0);
  for (int k = -taps; k <= taps; ++k) {
    if (k == 0) continue;
    ivec2 offset = ivec2(round(float(k) * stride));
    vec2 w = vec2(inverse_at(at + STEP * offset.x).x, inverse_at(at + STEP * offset.y).y);
    vec2 x = vec2(offset) * per_half, change = (w - middle) * per_range;
    vec2 weight = kernel(x * x) * kernel(change * change);
    weight = mix(weight, vec2(0.0), lessThanEqual(w, vec2(0.0)));
    s0 += weight;
    s1 += weight * x;
    s2 += weight * x * x;
    t0 += weight * change;
    t1 += weight * x * change;
  }
  vec2 determinant = s0 * s2 - s1 * s1;
  bvec2 line = greaterThan(determinant, 1e-6 * s0 * s0);
  vec2 value = mix(t0 / s0, (s2 * t0 - s1 * t1) / max(determinant, 1e-12), line);
  return middle + mix(value / per_range, vec2(0.0), too_small);
}
#endif
