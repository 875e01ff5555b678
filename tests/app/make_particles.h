// Particle files as large as one likes: a pool with waves, or a block of water that has slumped into a corner, as they come
// out of another program. Written as they are made, so that the maker needs no memory; the same bytes every time.
#ifndef LIDO_TESTS_MAKE_PARTICLES_H
#define LIDO_TESTS_MAKE_PARTICLES_H

#include <stdbool.h>
#include <stdint.h>

typedef enum MadeShape { MADE_POOL, MADE_SLUMP } MadeShape;

typedef struct MadeWater {
  int32_t count;
  MadeShape shape;
  bool ascii;    ///< text instead of little-endian bytes
  bool velocity; ///< and of what it flows: vx, vy, vz
} MadeWater;

/// Write it as PLY. The water fills about the same room however many particles there are. False when the file cannot be written.
bool make_particles(const char *path, const MadeWater *water);

#endif
