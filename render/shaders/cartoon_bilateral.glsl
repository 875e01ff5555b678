// The bilateral filter (Tomasi & Manduchi 1998; Rocha Neto et al. 2014, Eqs. 1 and 2) of the inverse depth, which is affine on
// planes: f is a Gaussian of the distance in pixels, g one of the difference in depth. Over the full kernel or, with STEP,
// along one axis.
//
// FITTED: instead of the mean of Eq. 1, the plane that fits best by the same weights (local regression: Cleveland 1979), and
// g weighs how far a tap is from the plane that the pass before has found. So slanted water keeps its slope up to its
// borders, where all taps lie on one side and their mean would pull. Narrow kernels that follow a wide one leave the slopes
// to it and average those: fitted over so little water they would tell of its roughness.
#include "cartoon_map.glsl"
#ifndef VERTEX_STAGE
layout(std140, binding = 1) uniform Params {
  vec4 window;          // half of the kernel, pixels, or 0: half of it in m; most taps on either side; range, m
  vec4 slope;           // FITTED: how much wider the range is by a metre of distance; 1: slopes are averaged instead of fitted
};

// A symmetric system of equations, in normalised offsets from the pixel: sums of weight times 1, x, y, x², xy, y², and of those
// times the tap's difference. Without taps on both axes no slope is found along the missing one.
struct Fit {
  float s, x, y, xx, xy, yy, t, tx, ty;
};

void add(inout Fit fit, float weight, vec2 o, float difference) {
  vec2 wo = weight * o;
  fit.s += weight;
  fit.x += wo.x;
  fit.y += wo.y;
  fit.xx += wo.x * o.x;
  fit.xy += wo.x * o.y;
  fit.yy += wo.y * o.y;
  fit.t += weight * difference;
  fit.tx += wo.x * difference;
  fit.ty += wo.y * difference;
}

// Difference of the plane at the pixel, and its slopes, by Cramer's rule.
vec3 plane_of(Fit fit) {
  float few = 1e-4 * fit.s;
  fit.xx += few;
  fit.yy += few;
  vec3 a = vec3(fit.s, fit.x, fit.y), b = vec3(fit.x, fit.xx, fit.xy), c = vec3(fit.y, fit.xy, fit.yy);
  vec3 d = vec3(fit.t, fit.tx, fit.ty);
  return vec3(dot(d, cross(b, c)), dot(a, cross(d, c)), dot(a, cross(b, d))) / dot(a, cross(b, c));
}

void pass(ivec2 at) {
  vec4 own = map_at(at);
  result_0 = own;
  if (own.x <= 0.0) return;
  float pixel = pixel_at(own.x), half_size = max(window.x > 0.0 ? window.x : window.y / pixel, 1.0);
  int taps = int(clamp(ceil(half_size), 1.0, window.z));
  float stride = max(1.0, half_size / float(taps)), per_range = 1.0 / (own.x * own.x);
  float spatial = -4.5 / (half_size * half_size); // f's standard deviation is a third of half the kernel
  vec2 slopes = vec2(0.0);
  Fit fit = Fit(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
#ifdef STEP
  {
    int row = 0, across = taps;
#else
  for (int row = -taps; row <= taps; ++row) {
    int across = int(sqrt(float(taps * taps - row * row)) + 0.5); // the corners of the square weigh nothing
#endif
    for (int column = -across; column <= across; ++column) {
#ifdef STEP
      ivec2 offset = STEP * int(round(float(column) * stride));
#else
      ivec2 offset = ivec2(round(vec2(column, row) * stride));
#endif
      vec4 tap = map_at(at + offset);
      float w = tap.x, d2 = float(offset.x * offset.x + offset.y * offset.y);
      float difference = (w - own.x) * per_range; // m
#ifdef FITTED
      float deviation = (difference - dot(own.yz, vec2(offset)) * per_range) / (window.w + slope.x * pixel * sqrt(d2));
      float weight = w > 0.0 ? exp(spatial * d2 - 0.5 * deviation * deviation) : 0.0;
      add(fit, weight, vec2(offset) / half_size, difference);
      slopes += weight * tap.yz;
#else
      float deviation = difference / window.w, weight = exp(spatial * d2 - 0.5 * deviation * deviation);
      fit.s += w > 0.0 ? weight : 0.0;
      fit.t += w > 0.0 ? weight * difference : 0.0;
#endif
    }
  }
#ifdef FITTED
  vec3 plane = plane_of(fit) / per_range;
  result_0.x = own.x + plane.x;
  slopes = mix(plane.yz / half_size, slopes / fit.s, slope.y);
#ifdef STEP
  slopes = mix(slope.y > 0.0 ? slopes : own.yz, slopes, vec2(STEP));
#endif
  result_0.yz = slopes;
#else
  result_0.x = own.x + fit.t / (fit.s * per_range);
#endif
}
#endif
