// The raw sun map smoothed by a Gaussian, first along u, then along v (SECOND). Spheres become soft shadows and a smooth
// surface whose bumps bend the light.
#include "frame.glsl"
#ifdef COMPUTE_STAGE
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D map;
layout(rgba32f, binding = 0) writeonly uniform image2D result;
layout(std140, binding = 1) uniform Blur {
  vec4 sigma;           // width of the Gaussian in texels along u and v
};

#ifdef SECOND
const ivec2 STEP = ivec2(0, 1);
#else
const ivec2 STEP = ivec2(1, 0);
#endif

// First pass: (thickness, -, -, height). Second pass: (thickness, height·coverage, coverage, -).
vec4 read(ivec2 at) {
  vec4 m = texelFetch(map, clamp(at, ivec2(0), textureSize(map, 0) - 1), 0);
#ifdef SECOND
  return m;
#else
  float covered = m.a > -FAR ? 1.0 : 0.0;
  return vec4(m.r, covered > 0.0 ? m.a : 0.0, covered, 0.0);
#endif
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, textureSize(map, 0)))) return;
  float width = dot(sigma.xy, vec2(STEP));
  int reach = int(ceil(2.5 * width));
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  for (int i = -reach; i <= reach; ++i) {
    float x = float(i) / width;
    float w = exp(-0.5 * x * x);
    sum += w * read(at + i * STEP);
    weights += w;
  }
  sum /= weights;
#ifdef SECOND
  sum.y = sum.z > 0.01 ? sum.y / sum.z : -FAR;
  if (sum.z <= 0.01) sum.z = 0.0;
#endif
  imageStore(result, at, sum);
}
#endif
