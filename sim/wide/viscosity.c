// Viscosity: v_i += Σ_j c_ij (v_j − v_i) with pair weights that are the same from both sides, so that momentum is kept.
//
// c_ij = c W_ij (XSPH: Schechter & Bridson, Ghost SPH for Animating Water, 2012; Macklin & Müller 2013, Eq. 17) plus
// 2 ν dt |dW/dr|/r (the Laplacian of Brookshaw 1985, as Morris, Fox, Zhu, Modeling Low Reynolds Number Incompressible
// Flows Using SPH, 1997, use it), W times the volume of a particle.
#include "sim/solver.h"
#include "sim/wide/kernels.h"

void WIDE(sim_viscosity)(int32_t begin, int32_t end, const void *context) {
  const SimStep *step = context;
  const SimNeighbours *lists = step->neighbours;
  const SimCubic *cubic = &step->cubic;
  SimParticles *p = step->particles;
  SimF inverse_h = sim_f(cubic->inverse_h), zero = sim_f(0), half = sim_f(0.5f), one = sim_f(1), four = sim_f(4);
  SimF share = sim_f(step->viscosity_share * 2 * cubic->value_scale);
  SimF diffusion = sim_f(step->viscosity_diffusion * 6 * cubic->gradient_scale), soft = sim_f(0.1f * cubic->h);
  for (int32_t i = begin; i < end; i += SIM_LANES) {
    const uint32_t *index = lists->index + (size_t)lists->start[i / SIM_CHUNK] * SIM_CHUNK + i % SIM_CHUNK;
    SimF own[4], velocity[4], sum[3] = {zero, zero, zero};
    sim_load4(p->first + 4 * (size_t)i, own);
    sim_load4(p->second + 4 * (size_t)i, velocity);
    for (uint32_t k = 0; k < lists->length[i / SIM_CHUNK]; k++, index += SIM_CHUNK) {
      SimF other[4], v[4];
      sim_gather4(p->first, index, other);
      sim_gather4(p->second, index, v);
      SimF dx = own[0] - other[0], dy = own[1] - other[1], dz = own[2] - other[2];
      SimF r = sim_sqrt(dx * dx + dy * dy + dz * dz), q = r * inverse_h;
      SimF a = sim_max(one - q, zero), b = sim_max(half - q, zero), a2 = a * a, b2 = four * (b * b);
      SimF weight = share * (a2 * a - b2 * b) + diffusion * (a2 - b2) / (r + soft);
      for (int axis = 0; axis < 3; axis++) sum[axis] = sum[axis] + weight * (v[axis] - velocity[axis]);
    }
    for (int axis = 0; axis < 3; axis++) sim_store(p->now.next_velocity[axis] + i, velocity[axis] + sum[axis]);
  }
}
