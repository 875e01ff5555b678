// The obstacles of a frame as exact shapes: where a ray meets them, and how far away they are.
//
// Boxes, balls, cylinders, capsules and stairs. Triangle meshes are left out, and so is what is absurd (no size, a place
// that is not a number), as in the renderer.
#ifndef LIDO_TESTS_REFERENCE_SOLIDS_H
#define LIDO_TESTS_REFERENCE_SOLIDS_H

#include "sim/frame.h"
#include "tests/reference/vec.h"

/// One convex part; stairs are one box for each step.
typedef struct Solid {
  SimShape shape;     ///< SIM_BOX, SIM_SPHERE, SIM_CYLINDER or SIM_CAPSULE
  Vec half;           ///< m, of the box around it; a capsule's y is half its straight part
  Vec position;       ///< m
  double rotation[4]; ///< unit quaternion x, y, z, w
  Vec colour;         ///< linear
} Solid;

typedef struct Solids {
  Solid *solid; ///< (count)
  int count;
} Solids;

Solids solids_create(const SimFrame *frame);
void solids_destroy(Solids *solids);

/// The first entry of the ray origin + t·direction, t > 0: its t, outward unit normal and solid. NULL: none.
const Solid *solids_meet(const Solids *solids, Vec origin, Vec direction, double *t, Vec *normal);

/// Distance to the nearest surface, m, negative inside; *outward is the direction in which it grows fastest.
/// INFINITY where there is no solid.
double solids_distance(const Solids *solids, Vec p, Vec *outward);

#endif
