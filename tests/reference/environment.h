// What water refracts, in the pinned form: a gradient sky, a checker floor or none, matt obstacles, no sun. The numbers
// are those that render/render.h promises.
#ifndef LIDO_TESTS_REFERENCE_ENVIRONMENT_H
#define LIDO_TESTS_REFERENCE_ENVIRONMENT_H

#include <stdbool.h>

#include "render/render.h"
#include "tests/reference/solids.h"

typedef struct Environment {
  Vec zenith, horizon; ///< linear light
  bool has_floor;
  double floor_level, tile; ///< m
  Vec floor_colour[2];
  Solids solids;
} Environment;

Environment environment_create(const SimFrame *frame, const RenderSettings *settings);
void environment_destroy(Environment *environment);

/// Light that comes towards the origin of a ray with a unit direction, past all water, and how far it has come: INFINITY
/// for the sky.
Vec environment_light(const Environment *environment, Vec origin, Vec direction, double *t);

#endif
