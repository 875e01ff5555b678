// Light along a ray through water.
//
// Imai, Kanamori, Mitani, Real-Time Screen-Space Liquid Rendering with Complex Refractions, 2016, Eqs. 6–9, once as they
// stand (optics_chain) and once with every ray traced on (optics_tree):
//   c = F b(r) + (1 − F) c(t), F by Schlick, r and t by Snell, and exp(−a l) for each length l in water.
// Schlick's cosine is that on the air's side, whichever way the light goes: F = F0 + (1 − F0)(1 − cos)⁵.
#ifndef LIDO_TESTS_REFERENCE_OPTICS_H
#define LIDO_TESTS_REFERENCE_OPTICS_H

#include "tests/reference/water.h"

typedef struct Optics {
  const Environment *environment;
  const Water *water;
  Vec absorption;          ///< 1/m per channel
  double refractive_index; ///< of the water
} Optics;

/// The whole tree of reflections and refractions. Where a branch's weight falls below 1e-4, or at the surface number
/// max_depth + 1 of its path, it takes the environment straight on.
Vec optics_tree(const Optics *optics, WaterRay ray, int max_depth);

/// The paper's chain: only refracted rays are traced on, up to max_refractions of them; reflected rays, and the last
/// refracted one, take the environment in their direction, past all water. Every refracted ray is attenuated over its
/// length to the next surface, the last one too; reflected ones are not. Total reflection ends the chain with F = 1.
Vec optics_chain(const Optics *optics, WaterRay ray, int max_refractions);

#endif
