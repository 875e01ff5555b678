// The surface stages: from sorted particles to what a renderer wants. Each works on any particle set, simulated or read
// from a file, and writes one or two arrays of a frame.
//
// Three of them share one sweep over the neighbours: density and class, the moments that smoothed centres and ellipsoids
// are made of, and which particles are exposed (wide/surface.c). The ellipsoids are then made of the covariances
// (wide/ellipsoid.c) and the flags of the exposed particles (surface_flags.c).
#ifndef LIDO_SIM_SURFACE_H
#define LIDO_SIM_SURFACE_H

#include "sim/boundary.h"
#include "sim/kernels.h"
#include "sim/neighbours.h"

/// Reach of the surface stages in spacings: the support of the density, R of the anisotropy, and so the radius of the
/// neighbour lists and the smallest cell of a frame's grid.
#define SIM_SURFACE_REACH 2.0f

/// What a surface stage reads: sorted positions, their grid and their neighbours.
typedef struct SimSurface {
  const SimWide *wide;
  int32_t count, threads;
  float spacing;            ///< m, of the particles at rest
  const float *position[3]; ///< m, x, y and z, each (count), sorted by the grid; readable a SIM_CHUNK further
  const float *four;        ///< m, (count, 4): the same side by side, infinitely far ones behind the last (particles.h)
  const SimGrid *grid;      ///< cells of at least SIM_SURFACE_REACH spacings
  const SimNeighbours *lists;         ///< of exactly SIM_SURFACE_REACH spacings
  float bounds_min[3], bounds_max[3]; ///< m, around the positions
  const SimContainer *container;      ///< what holds the water; NULL: nothing is known to
  int32_t body_count;
  const SimBody *bodies; ///< (body_count), obstacles in the water
  const struct SimRipple *ripple; ///< the water where it is a sum of waves; NULL: particles
  float node_spacing;             ///< m, of the height field's nodes
} SimSurface;

/// A particle of less than this share of the rest density is a splash.
#define SIM_SPLASH_DENSITY 0.55f

/// What the sweep writes; an array that is NULL is left out. All have room for whole chunks and one chunk more.
typedef struct SimSurfaceSums {
  float *density;          ///< (count): share of the rest density, from particles alone (no walls)
  uint8_t *particle_class; ///< (count): SIM_SPLASH or SIM_AGGREGATED by that density …
  bool class_given;        ///< … unless it is there already
  float *smoothed;         ///< m, (count, 3): smoothed centres
  float *covariance; ///< m², (chunks, 6, SIM_CHUNK): xx, yy, zz, xy, xz, yz; all zero where the shape is a sphere
  uint8_t *exposed;  ///< (count): 1 where the particle lies at the outside of the water; 0 in the room behind
} SimSurfaceSums;

/// One sweep over all neighbours. `smoothed` and `covariance` go together and need classes.
void sim_surface_sweep(const SimSurface *surface, const SimSurfaceSums *sums);

/// What the kernel of the sweep reads.
typedef struct SimSweepContext {
  const SimSurface *surface;
  SimSurfaceSums sums;
  SimCubic cubic; ///< of support SIM_SURFACE_REACH
} SimSweepContext;

/// The density alone, from the grid instead of lists: bytes as those of the sweep. `position` is (count, 3), in the
/// grid's order; `density` (count).
void sim_surface_density(const SimWide *wide, const SimGrid *grid, const float *position, int32_t count, float spacing,
                         float *density, int32_t threads);

/// What its kernel reads.
typedef struct SimDensityContext {
  const SimGrid *grid;
  const float *position;
  SimCubic cubic; ///< of support SIM_SURFACE_REACH
  float *density;
} SimDensityContext;

/// Turn covariances into ellipsoids in place: (chunks, 6, SIM_CHUNK) becomes (count, 6), see SimFrame. `radius` is that of
/// a particle, m.
void sim_surface_ellipsoids(const SimWide *wide, int32_t count, float radius, float *covariance, int32_t threads);

/// What the kernel of the ellipsoids reads.
typedef struct SimEllipsoidContext {
  float radius, *ellipsoid;
} SimEllipsoidContext;

/// near_surface[i] = 1 where the particle can be seen from outside the water.
void sim_surface_flags(const SimSurface *surface, const uint8_t *exposed, uint8_t *near_surface);

/// The nodes of a height field: over the container, where there is one, so that they stay in place from frame to frame; else
/// over the particles and what they reach. Returns their number.
int64_t sim_surface_height_nodes(const SimSurface *surface, SimHeightField *field);

/// m, x and z of the middle of a glass. Returns its radius; 0: the container is a box, or there is none.
float sim_height_glass(const SimContainer *container, float axis[2]);

/// Where a height field is written, and room to work in: one element a node (`normal`: three). `underside` and `second` are NULL
/// where no second layer is wanted; the last two are needed where there are bodies.
typedef struct SimHeightArrays {
  float *height, *normal, *underside, *second;
  uint8_t *state;
  int32_t *queue;
} SimHeightArrays;

/// Fill heights and normals; `floor` is the height where there is no water.
void sim_surface_heightfield(const SimSurface *surface, float floor, const SimHeightField *field,
                             const SimHeightArrays *arrays);

/// What the kernels of the height field read.
typedef struct SimHeightContext {
  const SimSurface *surface;
  const SimHeightField *field;
  float radius, step, iso, floor; ///< m, m, iso-value, m
  const SimContainer *walls;      ///< the mirrors; NULL: none
  float axis[2], glass;           ///< m, x and z of the middle and radius of a round glass; 0: it is a box
  const SimBoundary *solids;      ///< bodies, and a wall for the water that φ is a sum over; NULL: none
  float *height, *normal, *underside, *second; ///< as in SimHeightArrays
} SimHeightContext;

/// Whether a node lies outside a glass, farther than those that a cell on its rim needs.
static inline bool sim_height_beyond(const SimHeightContext *c, float x, float z) {
  float dx = x - c->axis[0], dz = z - c->axis[1], most = c->glass + 1.5f * c->field->spacing;
  return c->glass > 0 && dx * dx + dz * dz > most * most;
}

/// Let the surface go on through bodies and up to them: see surface_height_fill.c.
void sim_surface_height_fill(const SimHeightContext *context, const SimHeightArrays *arrays);

#endif
