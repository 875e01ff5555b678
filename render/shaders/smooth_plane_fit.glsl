// Local plane fitting: Imai, Kanamori, Mitani, "Real-Time Screen-Space Liquid Rendering with Complex Refractions", 2016,
// section 4.3. The plane through the weighted mean of the neighbours' points (Eq. 4) with the weighted mean of the
// particles' own normals (Eq. 3) is met by the pixel's ray (Eq. 5). VIEW_INDEPENDENT: weights by distance, section 5.
#include "smoothing.glsl"
#ifndef VERTEX_STAGE
layout(binding = 1) uniform sampler2D front; // normal in world axes, depth
layout(binding = 2) uniform sampler2D back;

struct Fit {
  vec3 normal, mean;
  float sum;
};

void add(inout Fit fit, vec3 own, vec3 point, vec3 normal) {
  vec3 d = point - own;
#ifdef VIEW_INDEPENDENT
  float d2 = dot(d, d);
#else
  float d2 = d.z * d.z;
#endif
  float w = exp(-d2 / (window.z * window.z)); // Eq. 2
  fit.normal += w * normal;
  fit.mean += w * point;
  fit.sum += w;
}

float inverse_of(Fit fit, vec3 ray, float otherwise) {
  fit.normal = mat3(world_to_view) * fit.normal;
  float inverse_depth = dot(fit.normal, ray) * fit.sum / dot(fit.normal, fit.mean);
  // A plane along the ray, or one met behind the eye, says nothing.
  return inverse_depth > 0.0 && inverse_depth < 1.0 / eye.w ? inverse_depth : otherwise;
}

vec2 smoothed(ivec2 at, vec2 middle) {
  vec3 ray = vec3(ray_of(at), -1.0), own_front = ray / middle.x, own_back = ray / middle.y;
  Fit near = Fit(vec3(0.0), vec3(0.0), 0.0), far = near;
  int taps = int(window.x);
  vec2 stride = vec2(stride_at(middle.x), stride_at(middle.y));
  for (int b = -taps; b <= taps; ++b) {
    for (int a = -taps; a <= taps; ++a) {
      ivec2 to = at + ivec2(round(vec2(a, b) * stride.x));
      vec2 w = inverse_at(to);
      if (w.x > 0.0) {
        add(near, own_front, vec3(ray_of(to), -1.0) / w.x, texelFetch(front, to, 0).xyz);
      }
      if (stride.y != stride.x) {
        to = at + ivec2(round(vec2(a, b) * stride.y));
        w = inverse_at(to);
      }
      if (w.y > 0.0) {
        add(far, own_back, vec3(ray_of(to), -1.0) / w.y, texelFetch(back, to, 0).xyz);
      }
    }
  }
  return vec2(inverse_of(near, ray, middle.x), inverse_of(far, ray, middle.y));
}
#endif
