// What the tests of the simulator share.
#ifndef LIDO_TEST_SIM_TEST_H
#define LIDO_TEST_SIM_TEST_H

// clang-format off
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
// clang-format on
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "sim/sim.h"

/// Random numbers that are the same on every machine: uniform in [0, 1).
double test_random(uint64_t *state);

/// A Def with one block in a container that fits the numbers of spacings given; radius 0.025, two threads.
SimWorldDef test_def(const float container[3], SimBlockDef *block, const float block_size[3]);

/// sim_world_create that fails the test with the message.
SimWorld *test_create(const SimWorldDef *def);
/// Advance `frames` sixtieths of a second; fails the test with the message.
void test_advance(SimWorld *world, int frames);
/// The frame, failing the test where there is none.
const SimFrame *test_frame(SimWorld *world, unsigned needs, SimFrameBuffer *buffer);

/// FNV-1a of ids, positions, velocities and densities, in the order of the frame.
uint64_t test_hash(const SimFrame *frame);

/// The same of what the surface stages wrote, on top of another hash.
uint64_t test_hash_surface(const SimFrame *frame, uint64_t hash);

/// Positions of a lattice nx × ny × nz, each displaced by up to jitter spacings; to be freed.
float *test_lattice(int nx, int ny, int nz, double spacing, double jitter, uint64_t seed);

/// Fails unless every particle of the frame is inside the container.
void test_inside_container(const SimFrame *frame);
/// Fails if a particle of the frame is inside an obstacle (none of them a mesh) by more than a tenth of a spacing.
void test_outside_obstacles(const SimFrame *frame);

#endif
