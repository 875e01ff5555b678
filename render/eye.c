#include "render/eye.h"

#include <stddef.h>

// In a lattice of spacing 2 r the kernel (1 − q²)³ with a support of 4 r sums up to its integral, 64π/315 · (4 r)³, in cubes
// of (2 r)³; at a flat surface to half of that.
bool render_eye_in_water(const SimFrame *frame, const float eye[3]) {
  const float support = 4 * frame->particle_radius, most = support * support;
  float sum = 0;
  for (int32_t i = 0; i < frame->count; ++i) {
    const float *p = frame->position + 3 * (size_t)i;
    const float x = p[0] - eye[0], y = p[1] - eye[1], z = p[2] - eye[2], d2 = x * x + y * y + z * z;
    if (!(d2 < most) || frame->particle_class[i] != SIM_AGGREGATED) continue;
    const float a = 1 - d2 / most;
    sum += a * a * a;
  }
  const float lattice = 5.106f;
  return sum > 0.48f * lattice;
}
