// Vorticity confinement: Macklin & Müller, Position Based Fluids, 2013, Eq. 15 and 16, after Fedkiw, Stam, Jensen, Visual
// Simulation of Smoke, 2001. It gives back some of the turning that the sweeps over neighbours smear out: where |ω| falls
// off to one side, it pushes the water round its maximum.
//
// Scale. Eq. 16 gives dv/dt = ε (N × ω), so ε is a speed, and what it does depends on particle size and on how fast the
// water turns. Here ε is multiplied by d |ω|: dv/dt = ε d |ω| (N × ω). So ε has no unit, a vortex of given shape is spun
// up by the same share in each turn, whatever its size and speed, and the substep does not matter. |ω| is cut at 1/dt: no
// particle gains more than ε spacings a substep from a turn.
//
// Free surfaces. |ω_j| − |ω_i| stands where the paper has |ω_j|: the sum is then the gradient of |ω| and not that of the
// water's edge, and a body of water that turns as a whole is left alone.
//
// Limits: the push is not made of pairs, so momentum is kept only as far as vortices are whole (test_vorticity.c holds it
// to a small share), and it adds energy by design.
#include "sim/parallel.h"
#include "sim/world.h"

static void velocity_to_second_kernel(int32_t begin, int32_t end, const void *context) {
  const SimParticles *p = context;
  for (int32_t i = begin; i < end; i++)
    for (int k = 0; k < 4; k++) p->second[4 * (size_t)i + k] = k < 3 ? p->now.next_velocity[k][i] : 0;
}

void sim_step_vorticity(const SimStep *step) {
  SimParticles *p = step->particles;
  if (!(step->confinement > 0)) return;
  sim_parallel_for(step->threads, p->count, velocity_to_second_kernel, p);
  sim_particles_pad_zero(p, p->second);
  sim_parallel_for(step->threads, p->count, step->wide->vorticity_curl, step);
  sim_particles_pad_zero(p, p->work);
  sim_parallel_for(step->threads, p->count, step->wide->vorticity_confine, step);
}
