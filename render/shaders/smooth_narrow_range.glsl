// The narrow-range filter: Truong & Yuksel, "A Narrow-Range Filter for Screen-Space Fluid Rendering", 2018. A Gaussian that
// takes farther neighbours for points a little behind the middle, and leaves out nearer ones together with their mirror
// images. What counts as near or far grows with the range of the depths met on the way outwards, so that tilted surfaces
// pass. STEP: along a line of the picture; without it, a last small window of two dimensions against the streaks.
//
// The back of the water is seen from behind: there depths count backwards.
#include "smoothing.glsl"
#ifndef VERTEX_STAGE
struct Narrow {
  vec2 near, far, clamped, sum, weights;
};

vec2 depths_at(ivec2 at) {
  vec2 w = inverse_at(at);
  return w.x > 0.0 ? vec2(1.0, -1.0) / w : vec2(FAR);
}

// A tap and its mirror image.
void add(inout Narrow n, vec2 a, vec2 b, vec2 weight) {
  bvec2 nearer = lessThan(min(a, b), n.near);
  vec2 pair = mix(a, n.clamped, greaterThan(a, n.far)) + mix(b, n.clamped, greaterThan(b, n.far));
  vec2 taken = weight * mix(vec2(1.0), vec2(0.0), nearer);
  n.sum += taken * pair;
  n.weights += 2.0 * taken;
  vec2 low = min(mix(a, vec2(FAR), greaterThan(a, n.far)), mix(b, vec2(FAR), greaterThan(b, n.far)));
  vec2 high = max(mix(a, vec2(-FAR), greaterThan(a, n.far)), mix(b, vec2(-FAR), greaterThan(b, n.far)));
  n.near = mix(min(n.near, low - window.z), n.near, nearer);
  n.far = mix(max(n.far, high + window.z), n.far, nearer);
}

vec2 smoothed(ivec2 at, vec2 middle) {
  vec2 z = vec2(1.0, -1.0) / middle;
  Narrow n = Narrow(z - window.z, z + window.z, z + window.w, z, vec2(1.0));
  int taps = int(window.x);
#ifdef STEP
  float stride = stride_at(middle.x);
  vec2 sigma = window.y * middle * lens.w / (6.0 * lens.y);
  for (int k = 1; k <= taps; ++k) {
    ivec2 offset = STEP * int(round(float(k) * stride));
    float d = float(offset.x + offset.y);
    add(n, depths_at(at + offset), depths_at(at - offset), exp(-d * d / (2.0 * sigma * sigma)));
  }
#else
  float sigma = window.x / 2.0;
  for (int y = 0; y <= taps; ++y) {
    for (int x = -taps; x <= taps; ++x) {
      if (y == 0 && x <= 0) continue;
      ivec2 offset = ivec2(x, y);
      add(n, depths_at(at + offset), depths_at(at - offset), vec2(exp(-float(x * x + y * y) / (2.0 * sigma * sigma))));
    }
  }
#endif
  return vec2(1.0, -1.0) * n.weights / n.sum;
}
#endif
