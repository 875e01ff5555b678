// What neighbouring water evens out: velocity (viscosity) and colour (mixing).
//
// In a substep y_i changes by Σ_j w_ij (y_j − y_i), with weights that are the same from both sides, so that momentum, or
// the amount of a dye, is kept. w_ij has two parts:
//
// - Flow: 2 D dt V |dW/dr| r/(r² + 0.01 h²), the Laplacian of Brookshaw, A Method of Calculating Radiative Heat Diffusion in
//   Particle Simulations, 1985, as Morris, Fox, Zhu, Modeling Low Reynolds Number Incompressible Flows Using SPH, 1997,
//   Eq. 21, use it for viscosity. D is ν of the liquid or the diffusivity of the colour, m²/s. Divided by
//   Σ V |dW/dr| r³/(3 (r² + 0.01 h²)) of the lattice, so that a smooth field there diffuses with D exactly.
// - Share: c V W dt/τ (XSPH: Schechter & Bridson, Ghost SPH for Animating Water, 2012; Macklin & Müller, Position Based Fluids,
//   2013, Eq. 17). The papers take the share c in each substep, whatever its length. Here c is the share in the time
//   τ = 0.1 √(d/g), the substep of pbf for water at rest, so that a run with shorter substeps does not become thicker.
//   Without gravity there is no such time, and c is the share in a substep as in the papers.
//
// Large D. An explicit step is stable up to Σ_j w_ij ≤ 1. Viscosity beyond that takes s stages of the same sweep, whose
// combination (Runge-Kutta-Legendre: Meyer, Balsara, Aslam, A Second-Order Accurate Super Time-Stepping Formulation for
// Anisotropic Thermal Conduction, 2012, Eq. 6–8, first order) is stable up to (s² + s)/2 times as much: 100 stages do the work of
// 5000 substeps. It damps the waves that are too fast for the step like an implicit method, not more accurately. Colours
// must not leave the range that they had, which a Legendre polynomial does not promise: they take that many plain steps.
#include <math.h>

#include "sim/parallel.h"
#include "sim/world.h"

// How much larger Σ w may be than in the lattice: torn, jittered and compressed water.
#define CROWD 1.5

typedef struct Swap {
  float *four, **value;
} Swap;

static void to_second_kernel(int32_t begin, int32_t end, const void *context) {
  const Swap *swap = context;
  for (int32_t i = begin; i < end; i++)
    for (int k = 0; k < 4; k++) swap->four[4 * (size_t)i + k] = k < 3 ? swap->value[k][i] : 0;
}

static void swap_kernel(int32_t begin, int32_t end, const void *context) {
  const Swap *swap = context;
  for (int32_t i = begin; i < end; i++)
    for (int k = 0; k < 3; k++) {
      float *a = &swap->four[4 * (size_t)i + k], *b = &swap->value[k][i], t = *a;
      *a = *b, *b = t;
    }
}

// Σ w in the lattice, with a margin.
static double degree(const SimStep *step, double share, double spread) {
  const SimCubic *cubic = &step->cubic;
  return CROWD * (share + spread * (double)cubic->diffuse_degree / (double)cubic->diffuse_moment);
}

// The s stages: Y_1 = Y_0 + μ' L Y_0, Y_j = μ Y_{j−1} + ν Y_{j−2} + μ μ' L Y_{j−1}, μ = (2j − 1)/j, ν = (1 − j)/j,
// μ' = 2/(s² + s). Y_{j−1} stands in `second`, Y_{j−2} in the array that gets Y_j.
static void stages(SimStep *step, float *value[3], int32_t count) {
  SimParticles *p = step->particles;
  SimDiffusion *d = &step->diffusion;
  Swap swap = {p->second, value};
  float part = 2 / ((float)count * (float)(count + 1));
  for (int k = 0; k < 3; k++) d->value[k] = value[k];
  sim_parallel_for(step->threads, p->count, to_second_kernel, &swap);
  sim_particles_pad(p, p->second);
  for (int32_t j = 1; j <= count; j++) {
    d->keep = (float)(2 * j - 1) / (float)j;
    d->before = (float)(1 - j) / (float)j;
    d->gain = d->keep * part;
    if (j > 1) sim_parallel_for(step->threads, p->count, swap_kernel, &swap);
    sim_parallel_for(step->threads, p->count, step->wide->diffuse, step);
  }
}

void sim_step_viscosity(const SimStep *from) {
  SimStep step = *from;
  SimDiffusion *d = &step.diffusion;
  *d = (SimDiffusion){.share = from->viscosity_share, .spread = 2 * from->viscosity * from->dt};
  if (!(d->share > 0 || d->spread > 0)) return;
  double most = degree(&step, (double)d->share, (double)d->spread);
  stages(&step, step.particles->now.next_velocity, (int32_t)fmax(1, ceil((sqrt(1 + 8 * most) - 1) / 2)));
}

void sim_step_mix(const SimStep *from) {
  SimStep step = *from;
  float whole = 2 * from->colour_diffusion * from->dt;
  if (!(whole > 0) || !from->particles->coloured) return;
  int32_t count = (int32_t)fmax(1, ceil(degree(&step, 0, (double)whole)));
  step.diffusion = (SimDiffusion){.spread = whole / (float)count};
  for (int32_t k = 0; k < count; k++) stages(&step, step.particles->now.colour, 1);
}
