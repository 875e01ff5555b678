// Friction of walls and obstacles on the layer of water beside them.
//
// On a spacing's way along the wall the wall takes the share f, SimObstacleDef.friction, of the sliding speed u:
// du/ds = −k u/d with k = −ln(1 − f), so du/dt = −k u²/d. Over a substep that is u → u/(1 + k |u| dt/d) exactly. It depends on the
// way alone, not on substeps, particle size or speed, and is the form of a turbulent wall's drag, u² times a coefficient.
// f = 0 slips freely; f = 1 sticks: the layer moves with the wall.
//
// The layer is where the wall's share of the density is at least half of what it is for a particle that touches the wall:
// from about ¾ of a spacing on there is none. The second layer is slowed by the water's own viscosity.
#include <math.h>

#include "sim/parallel.h"
#include "sim/world.h"

typedef struct Friction {
  const SimStep *step;
  float least; ///< share of the density, from which on a particle lies beside a wall
} Friction;

// What is left of the sliding speed.
static float left_over(float friction, float speed, float way) {
  if (!(friction < 1)) return 0;
  return 1 / (1 - logf(1 - friction) * speed * way);
}

static void rub(const SimStep *step, int32_t i, const SimSolid *solid) {
  float *const *v = step->particles->now.next_velocity;
  float size2 = 0, along = 0, u[3], speed2 = 0;
  for (int k = 0; k < 3; k++) {
    u[k] = v[k][i] - solid->velocity[k];
    size2 += solid->gradient[k] * solid->gradient[k];
    along += u[k] * solid->gradient[k];
  }
  if (!(size2 > 0)) return;
  for (int k = 0; k < 3; k++) {
    u[k] -= along / size2 * solid->gradient[k];
    speed2 += u[k] * u[k];
  }
  float loss = 1 - left_over(solid->friction, sqrtf(speed2), step->dt / step->cubic.spacing);
  for (int k = 0; k < 3; k++) v[k][i] -= loss * u[k];
  if (!step->reaction || solid->body[0] < 0) return;
  // The floating body there gets the opposite.
  sim_reaction_solid(step->reaction, i, solid);
  for (int k = 0; k < 3; k++) step->reaction->notes[i].shift[0][k] = -loss * u[k] * step->dt;
}

static void friction_kernel(int32_t begin, int32_t end, const void *context) {
  const Friction *c = context;
  const SimParticles *p = c->step->particles;
  for (int32_t first = begin; first < end; first += SIM_CHUNK) {
    if (!p->near[first / SIM_CHUNK]) continue;
    if (c->step->reaction)
      sim_reaction_none(c->step->reaction, first, first + SIM_CHUNK < end ? first + SIM_CHUNK : end);
    int32_t last = first + SIM_CHUNK < end ? first + SIM_CHUNK : end;
    for (int32_t i = first; i < last; i++) {
      SimSolid solid;
      // The share was stored by the last density sweep: cheap to ask first.
      if (p->solid[4 * (size_t)i + 3] < c->least) continue;
      sim_boundary_solid(c->step->boundary, NULL, p->first + 4 * (size_t)i, &solid);
      if (solid.friction > 0) rub(c->step, i, &solid);
    }
  }
}

void sim_step_friction(const SimStep *step) {
  const SimBoundary *boundary = step->boundary;
  bool any = boundary->friction > 0;
  for (int32_t b = 0; b < boundary->body_count; b++) any = any || boundary->bodies[b].friction > 0;
  if (!any) return;
  float slope;
  Friction context = {step, 0.5f * sim_wall_share(&boundary->wall, 0.5f * step->cubic.spacing, &slope)};
  sim_parallel_for(step->threads, step->particles->count, friction_kernel, &context);
  sim_step_collect(step);
}
