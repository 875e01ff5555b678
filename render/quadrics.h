// The water's surface particles as quadrics: ellipsoids where they are aggregated, balls where they are splashes (Imai,
// Kanamori, Mitani, 2016, section 4.2), and the passes that cast rays at them.
#ifndef LIDO_RENDER_QUADRICS_H
#define LIDO_RENDER_QUADRICS_H

#include "render/picture.h"

/// On the GPU: only what is sensible, and of that only what can be seen from outside the water.
typedef struct RenderQuadrics {
  GpuBuffer ellipsoids; // (ellipsoid_count) struct Ellipsoid of quadric.glsl
  GpuBuffer balls;      // (ball_count) struct Ball of quadric.glsl
  int32_t ellipsoid_count, ball_count;
  void *ellipsoid_staging, *ball_staging;
  int32_t ellipsoid_capacity, ball_capacity;
} RenderQuadrics;

/// What is made of the particles.
typedef struct RenderQuadricSettings {
  float scale;         ///< of the ellipsoids
  float lift;          ///< how far those at the surface are moved outwards, radii
  bool spheres;        ///< instead of ellipsoids balls of `scale` radii where the particles are
  bool splashes_apart; ///< splashes are balls; off: all are aggregated
  float ball_scale;    ///< radius of balls, particle radii
  bool surface_only;   ///< only what can be seen from outside the water
} RenderQuadricSettings;

/// Needs: class, near-surface flags and, but for spheres, ellipsoids.
bool render_quadrics_upload(RenderQuadrics *quadrics, const SimFrame *frame, const RenderQuadricSettings *settings,
                            RenderError *error);
/// Depth of the ellipsoid nearest to the eye among those that may be in the picture, m; RENDER_FARTHEST: there is none.
float render_quadrics_nearest(const RenderQuadrics *quadrics, const RenderPicture *picture);
void render_quadrics_destroy(RenderQuadrics *quadrics);

typedef enum RenderQuadricKind { RENDER_ELLIPSOIDS = 0, RENDER_BALLS = 1 } RenderQuadricKind;

/// Which surface a pass draws. Programs belong to the caller, one for each kind and surface.
typedef enum RenderQuadricSurface {
  RENDER_FRONT = 0, ///< outward normal in world axes and depth along the view axis (m) of the nearest front; all 0: none
  RENDER_BACK,      ///< the same of the farthest back
  RENDER_DEPTHS,    ///< 1 / depth of the nearest front (1/m), depth of the farthest back (m); both 0: none
  RENDER_COLOUR     ///< linear colour of the nearest front's particle and 1; all 0: none
} RenderQuadricSurface;

/// To be done before a surface is drawn.
void render_quadrics_clear(RenderQuadricSurface surface, const GpuTarget *out);

typedef struct RenderQuadricPass {
  RenderQuadricKind kind;
  RenderQuadricSurface surface;
  const GpuTexture *air; ///< of an eye in the water: depth at which the air begins, beyond which no back counts; else NULL
  GpuProgram *program;
  const GpuTarget *out;
} RenderQuadricPass;

bool render_quadrics_draw(RenderPicture *picture, const RenderQuadrics *quadrics, const RenderQuadricPass *pass,
                          RenderError *error);

#endif
