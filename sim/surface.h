// The surface stages: from sorted particles to what a renderer wants. Each works on any particle set, simulated or read
// from a file, and writes one or two arrays of a frame.
#ifndef LIDO_SIM_SURFACE_H
#define LIDO_SIM_SURFACE_H

#include "sim/grid.h"

/// What a surface stage reads: sorted positions and their grid.
typedef struct SimSurface {
  int32_t count, threads;
  float spacing;             ///< m, of the particles at rest
  float *const *position;    ///< m, x, y and z, each (count), sorted by the grid
  const SimGrid *grid;       ///< cells of at least SIM_SURFACE_CELL spacings
  float bounds_min[3], bounds_max[3]; ///< m, around the positions
} SimSurface;

/// Support of the density in spacings, and so the smallest cell of a frame's grid.
#define SIM_SURFACE_CELL 2.0f

/// density[i] = the share of the rest density at particle i, from particles alone (no walls).
void sim_surface_density(const SimSurface *surface, float *density);

/// particle_class[i] = SIM_SPLASH where that density is below SIM_SPLASH_DENSITY, SIM_AGGREGATED elsewhere.
#define SIM_SPLASH_DENSITY 0.55f
void sim_surface_classify(const SimSurface *surface, uint8_t *particle_class);

/// Smoothed centres and ellipsoids; see surface_anisotropy.c.
void sim_surface_anisotropy(const SimSurface *surface, const uint8_t *particle_class, float *smoothed, float *ellipsoid);

/// near_surface[i] = 1 where the particle can be seen from outside the water; `work` is (count) of scratch.
void sim_surface_flags(const SimSurface *surface, uint8_t *work, uint8_t *near_surface);

/// The nodes of a height field over the given bounds. Returns their number.
int64_t sim_surface_height_nodes(const SimSurface *surface, const float low[3], const float high[3],
                                 SimHeightField *field);
/// Fill heights and normals; `floor` is the height where there is no water.
void sim_surface_heightfield(const SimSurface *surface, float floor, const SimHeightField *field, float *height,
                             float *normal);

/// Eigenvalues (largest first) and unit eigenvectors of the symmetric matrix (xx, yy, zz, xy, xz, yz);
/// vector[k] belongs to value[k] and the three are right-handed.
void sim_eigen_symmetric(const float matrix[6], float value[3], float vector[3][3]);

#endif
