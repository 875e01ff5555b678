#include "make_particles.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// The water is columns of particles over a floor of WIDE × DEEP metres, stacked from y = 0 up to its height, which they are
// stretched or squeezed a little to fill.
#define WIDE 4.0
#define DEEP 2.0
#define MEAN 0.5 // m, of the height

static double height(const MadeWater *water, double x, double z) {
  if (water->shape == MADE_POOL) return MEAN + 0.06 * sin(3.1 * x + 0.4) * cos(2.3 * z) + 0.02 * sin(11 * x + 7 * z);
  return 1.9 * MEAN * exp(-0.5 * x * x) + 0.12 + 0.02 * sin(9 * x) * sin(8 * z + 1);
}

typedef struct Columns {
  double spacing; // m
  int32_t across, deep;
} Columns;

static Columns columns_of(double spacing) {
  return (Columns){spacing, (int32_t)(WIDE / spacing), (int32_t)(DEEP / spacing)};
}

// Of column i, k: where it stands, how high it is, and of how many particles.
static int32_t column(const MadeWater *water, const Columns *c, int32_t i, int32_t k, double at[3]) {
  at[0] = (i + 0.5) * c->spacing;
  at[2] = (k + 0.5) * c->spacing;
  at[1] = height(water, at[0], at[2]);
  return (int32_t)(at[1] / c->spacing + 0.5);
}

static int64_t particles_in(const MadeWater *water, const Columns *c) {
  int64_t sum = 0;
  double at[3];
  for (int32_t k = 0; k < c->deep; k++)
    for (int32_t i = 0; i < c->across; i++) sum += column(water, c, i, k, at);
  return sum;
}

// The closest columns that are not too many.
static Columns fit(const MadeWater *water) {
  Columns c = columns_of(cbrt(0.8 * WIDE * DEEP * MEAN / (water->count > 0 ? water->count : 1)));
  while (particles_in(water, &c) > water->count) c = columns_of(1.001 * c.spacing);
  return c;
}

// A little disorder: [−1, 1), from the particle's number and the axis.
static double disorder(int32_t particle, int axis) {
  uint32_t x = (uint32_t)particle * 2654435761u + (uint32_t)axis * 40503u + 1;
  x ^= x >> 15, x *= 2246822519u, x ^= x >> 13;
  return x / 2147483648.0 - 1;
}

static void put(FILE *stream, const MadeWater *water, const double values[6]) {
  int count = water->velocity ? 6 : 3;
  for (int k = 0; k < count; k++) {
    float value = (float)values[k];
    uint32_t word;
    memcpy(&word, &value, sizeof word);
    uint8_t bytes[4] = {(uint8_t)word, (uint8_t)(word >> 8), (uint8_t)(word >> 16), (uint8_t)(word >> 24)};
    if (water->ascii)
      fprintf(stream, "%.9g%c", (double)value, k == count - 1 ? '\n' : ' ');
    else
      fwrite(bytes, 1, sizeof bytes, stream);
  }
}

static void put_moved(FILE *stream, const MadeWater *water, double spacing, int32_t particle, double values[6]) {
  for (int axis = 0; axis < 3; axis++) values[axis] += 0.15 * spacing * disorder(particle, axis);
  put(stream, water, values);
}

// Layer over layer; whatever the count leaves over is drops that fall on the water.
static void put_all(FILE *stream, const MadeWater *water) {
  const Columns c = fit(water);
  int32_t made = 0, before = -1;
  for (int32_t j = 0; made > before; j++) {
    before = made;
    for (int32_t k = 0; k < c.deep; k++)
      for (int32_t i = 0; i < c.across; i++) {
        double at[3];
        int32_t high = column(water, &c, i, k, at);
        if (j >= high) continue;
        double values[6] = {at[0], at[1] * (j + 0.5) / high, at[2], 0.5 * sin(at[0]), 0.1 * cos(at[2]), 0.2};
        put_moved(stream, water, c.spacing, made++, values);
      }
  }
  for (; made < water->count; made++) {
    double values[6] = {0, 0, 0, 0.5, -4, 0.2};
    for (int axis = 0; axis < 3; axis++) values[axis] = 0.5 + 0.5 * disorder(made, axis + 3);
    values[0] *= WIDE, values[1] = (2 + values[1]) * MEAN, values[2] *= DEEP;
    put_moved(stream, water, c.spacing, made, values);
  }
}

bool make_particles(const char *path, const MadeWater *water) {
  FILE *stream = fopen(path, "wb");
  if (!stream) return false;
  setvbuf(stream, NULL, _IOFBF, 1 << 18);
  fprintf(stream, "ply\nformat %s 1.0\nelement vertex %d\n", water->ascii ? "ascii" : "binary_little_endian",
          water->count);
  fputs("property float x\nproperty float y\nproperty float z\n", stream);
  if (water->velocity) fputs("property float vx\nproperty float vy\nproperty float vz\n", stream);
  fputs("end_header\n", stream);
  put_all(stream, water);
  bool fine = !ferror(stream);
  return fclose(stream) == 0 && fine;
}
