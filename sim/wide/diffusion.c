// Diffusion of what stands in `second`, velocities or colours, over the positions in `first`: see diffusion.c.
#include "sim/solver.h"
#include "sim/wide/kernels.h"

void WIDE(sim_diffuse)(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  const SimDiffusion *d = &step->diffusion;
  const SimNeighbours *lists = step->neighbours;
  const SimCubic *cubic = &step->cubic;
  const SimParticles *p = step->particles;
  SimF inverse_h = sim_f(cubic->inverse_h), zero = sim_f(0), half = sim_f(0.5f), one = sim_f(1), four = sim_f(4);
  SimF share = sim_f(d->share * 2 * cubic->value_scale), soft = sim_f(SIM_DIFFUSE_SOFT * cubic->h * cubic->h);
  SimF flow = sim_f(d->spread / cubic->diffuse_moment * 6 * cubic->gradient_scale);
  SimF gain = sim_f(d->gain), keep = sim_f(d->keep), before = sim_f(d->before);
  for (int32_t i = begin; i < end; i += SIM_LANES) {
    const uint32_t *index = lists->index + (size_t)lists->start[i / SIM_CHUNK] * SIM_CHUNK + i % SIM_CHUNK;
    SimF own[4], value[4], sum[3] = {zero, zero, zero};
    sim_load4(p->first + 4 * (size_t)i, own);
    sim_load4(p->second + 4 * (size_t)i, value);
    for (uint32_t k = 0; k < lists->length[i / SIM_CHUNK]; k++, index += SIM_CHUNK) {
      SimF other[4], there[4];
      sim_gather4(p->first, index, other);
      sim_gather4(p->second, index, there);
      SimF dx = own[0] - other[0], dy = own[1] - other[1], dz = own[2] - other[2];
      SimF r2 = dx * dx + dy * dy + dz * dz, r = sim_sqrt(r2), q = r * inverse_h;
      SimF a = sim_max(one - q, zero), b = sim_max(half - q, zero), a2 = a * a, b2 = four * (b * b);
      SimF weight = share * (a2 * a - b2 * b) + flow * (a2 - b2) * r / (r2 + soft);
      for (int axis = 0; axis < 3; axis++) sum[axis] = sum[axis] + weight * (there[axis] - value[axis]);
    }
    for (int axis = 0; axis < 3; axis++) {
      float *to = d->value[axis] + i;
      sim_store(to, keep * value[axis] + before * sim_load(to) + gain * sum[axis]);
    }
  }
}
