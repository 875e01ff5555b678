// How well a surface is restored from the particles that sample it: by a smoothing filter, or by the renderer.
#ifndef LIDO_TESTS_RENDER_QUALITY_H
#define LIDO_TESTS_RENDER_QUALITY_H

#include <stdbool.h>

#include "sim/sim.h"
#include "tests/render/reference/smooth.h"
#include "tests/render/reference/splat.h"

/// How particles fill a pool. All are disordered by up to a fifth of a spacing along each axis.
typedef enum QualityFill {
  QUALITY_COLUMNS, ///< columns whose tops lie a radius below the surface, displaced by sine waves
  QUALITY_NOISE,   ///< the same columns, displaced by independent noise
  QUALITY_LATTICE  ///< the lattice below the surface: it makes terraces
} QualityFill;

/// A pool with a known surface and a view of it.
typedef struct QualityPool {
  const char *name;
  double size[3];   ///< m, along x, (unused), z; a corner at the origin
  double radius;    ///< m, of a particle
  double level;     ///< m, mean height of the surface
  double amplitude; ///< of the waves, 1: as in quality_height; 0: flat
  double stretch;   ///< of the wave lengths
  QualityFill fill;
  float eye[3], target[3], fov;
} QualityPool;

/// Height of the surface, and its upward unit normal.
double quality_height(const QualityPool *pool, double x, double z, double normal[3]);

/// The pools by which smoothing is judged: three flat ones, then with waves.
enum { QUALITY_POOLS = 8 };
extern const QualityPool quality_pools[QUALITY_POOLS];

/// The pool's particles in columns that are moved along x by `shift`, with the surface stages done; the buffer's.
const SimFrame *quality_frame(const QualityPool *pool, double shift, SimFrameBuffer *buffer);

/// What is to be seen of a pool.
typedef struct QualityTruth {
  const QualityPool *pool;
  Pinhole pinhole;
  float *normal; ///< view space, (height, width, 3); 0 where the surface is not seen
} QualityTruth;

/// Only what lies at least `margin` radii inside the pool's outline counts as seen. The eye may be in the water: then what
/// is seen is where a ray first comes out of it.
QualityTruth quality_truth_create(const QualityPool *pool, int32_t width, int32_t height, double margin);
void quality_truth_destroy(QualityTruth *truth);

typedef struct QualityFigures {
  double mean, p95; ///< degrees, of the angle between the normals
  double flicker;   ///< degrees, mean change of the normal under the shift
  double bias;      ///< radii, mean distance above the true surface
  double rough;     ///< radii, standard deviation of that distance
  double grain;     ///< degrees, mean angle between the normals of neighbouring pixels, less what it is in truth
  double lost;      ///< share of pixels without a depth
} QualityFigures;

/// Compare surfaces with the truth: of the pool, and of the pool moved along x by half a radius.
QualityFigures quality_compare(const QualityTruth *truth, const SplatMap *still, const SplatMap *shifted);

/// A pool seen through the particles, and the truth.
typedef struct QualityCase {
  QualityTruth truth;
  SplatMap map, shifted; ///< of the particles, front; shifted by half a radius along x
} QualityCase;
QualityCase quality_case_create(const QualityPool *pool, int32_t width, int32_t height, double margin);
void quality_case_destroy(QualityCase *c);

/// Filter a case's maps and compare with the truth. `filter` gets `parameters`.
typedef void QualityFilter(const SmoothInput *input, const void *parameters, float *smoothed);
QualityFigures quality_measure(const QualityCase *c, QualityFilter *filter, const void *parameters);

/// What a filter does to exact maps, in radii: the largest distance from the surface that it should have kept.
typedef struct QualityEdges {
  double patch;   ///< a disc of a plane, tilted by 70°, seen before nothing
  double step[3]; ///< two planes facing the viewer, one 3, 6 and 12 radii behind the other
  double tilted;  ///< the last one with both planes tilted by 70° along the step
} QualityEdges;
QualityEdges quality_edges(QualityFilter *filter, const void *parameters);

#endif
