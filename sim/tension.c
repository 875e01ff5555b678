// Surface tension: see tension.h; the sweeps are in wide/tension.c.
#include "sim/tension.h"

#include <math.h>

#include "sim/parallel.h"
#include "sim/world.h"

#define PI 3.14159265358979323846
// Shares of the tension: see tension.h.
#define COHESION 0.125
#define CURVATURE 0.27
// Of Brackbill's bound, √(ρ d³/2πσ) (Brackbill, Kothe, Zemach, A Continuum Method for Modeling Surface Tension, 1992, Eq. 61).
// From 0.5 on the drops of pbf simmer.
#define COURANT 0.4

double sim_tension_longest(const SimWorld *world) {
  double sigma = (double)world->def.surface_tension, d = (double)world->cubic.spacing;
  return sigma > 0 ? COURANT * sqrt((double)world->def.rest_density * d * d * d / (2 * PI * sigma)) : INFINITY;
}

void sim_step_tension(const SimStep *from, const SimWorldDef *def, const float *place) {
  if (!(def->surface_tension > 0)) return;
  SimStep step = *from;
  step.reaction = NULL;
  if (place == step.particles->second) step.boundary = step.start; // where particles are, and walls with them
  SimParticles *p = step.particles;
  double sigma = (double)def->surface_tension, density = (double)def->rest_density, h = (double)step.cubic.h;
  double gamma = sigma * 7040 / (21 * density * density * h * h), mass = density * (double)step.cubic.volume;
  step.cohesion = (float)(COHESION * gamma * mass * 32 / (PI * h * h * h));
  step.curvature = (float)(CURVATURE * sigma / (density * 3 * h * h / 80));
  step.place = place;
  sim_parallel_for(step.threads, p->count, step.wide->tension_normal, &step);
  sim_particles_pad_zero(p, p->work);
  sim_parallel_for(step.threads, p->count, step.wide->tension_force, &step);
}
