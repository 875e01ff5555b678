// Surface tension: see tension.h; the sweeps are in wide/tension.c.
#include "sim/tension.h"

#include <math.h>
#include <stdlib.h>
#include "sim/parallel.h"
#include "sim/world.h"

#define PI 3.14159265358979323846

double sim_tension_longest(const SimWorld *world) {
  double sigma = (double)world->def.surface_tension, d = (double)world->cubic.spacing;
  return sigma > 0 ? sqrt((double)world->def.rest_density * d * d * d / (2 * PI * sigma)) : INFINITY;
}

void sim_step_tension(const SimStep *from, const SimWorldDef *def, const float *place) {
  if (!(def->surface_tension > 0)) return;
  SimStep step = *from;
  SimParticles *p = step.particles;
  double sigma = (double)def->surface_tension, density = (double)def->rest_density, h = (double)step.cubic.h;
  double gamma = sigma * 7040 / (21 * density * density * h * h), mass = density * (double)step.cubic.volume;
  double ca = 0.5, cb = 0.5;
  if (getenv("X_CA")) ca = atof(getenv("X_CA"));
  if (getenv("X_CB")) cb = atof(getenv("X_CB"));
  step.cohesion = (float)(ca * gamma * mass * 32 / (PI * h * h * h));
  step.curvature = (float)(cb * sigma / (density * 0.0375 * h * h));
  step.place = place;
  sim_parallel_for(step.threads, p->count, step.wide->tension_normal, &step);
  sim_particles_pad_zero(p, p->work);
  sim_parallel_for(step.threads, p->count, step.wide->tension_force, &step);
}
