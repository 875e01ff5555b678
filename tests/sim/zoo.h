// Bodies of every shape, and thin, small and degenerate ones, for the tests of walls.
#ifndef LIDO_TEST_SIM_ZOO_H
#define LIDO_TEST_SIM_ZOO_H

#include "sim_test.h"

#include "reference/meshes.h"
#include "sim/boundary.h"

#define SPACING 0.05f
#define CLEARANCE 0.025f

typedef struct Zoo {
  TestMesh ring, plate;
  SimMeshDistance *fields[2];
  SimWall wall;
} Zoo;

// Shapes of the zoo: those of SimShape, then thin, small and degenerate ones.
enum { SHEET = SIM_SHAPE_COUNT, NEEDLE, ONE_STEP, PLATE_MESH, BEAD, ROUND_CAPSULE, ZOO };

Zoo zoo_make(void);
void zoo_free(Zoo *zoo);
SimBody zoo_body(const Zoo *zoo, int which);

/// Turn a body at random, the more the larger `most` is.
void zoo_turn(SimBody *body, uint64_t *seed, float most);

/// A tank of 1 m around the bodies.
SimBoundary zoo_tank(const Zoo *zoo, SimContainerShape shape, const SimBody *bodies, int32_t count);

/// In the tank.
void zoo_random_point(uint64_t *seed, float point[3]);

#endif
