// The hand on a body: finds the draggable body under the cursor and turns positions of the mouse into where the body is
// wanted. No window, no simulation: plain functions on the bodies of a frame.
//
// A grasped body moves in the plane across the view through its centre, and the point of that plane under the cursor
// stays under it.
#ifndef LIDO_APP_GRAB_H
#define LIDO_APP_GRAB_H

#include "render/render.h"
#include "sim/sim.h"

/// Where a ray (unit direction) first meets the surface of a body: *distance, m along the ray, 0 from inside.
/// false: it passes by, or the body lies behind the origin.
bool grab_ray_meets(const SimObstacle *body, const float origin[3], const float direction[3], float *distance);

/// Bodies of a frame, and which of them can be dragged.
typedef struct GrabBodies {
  int32_t count;
  const SimObstacle *bodies;  ///< (count)
  const SimObstacleDef *defs; ///< (count), of the same bodies: for their motion
} GrabBodies;

/// The draggable body that the ray meets first; −1 when it meets none, or another body before.
int32_t grab_pick(const GrabBodies *bodies, const float origin[3], const float direction[3]);

/// Whether the ray meets a glass from outside. A tank is none.
bool grab_meets_glass(const SimContainer *container, const float origin[3], const float direction[3]);

typedef struct Grab {
  bool holds;      ///< a body is in the hand
  bool moved;      ///< `target` has not been taken yet
  int32_t body;    ///< which one, as long as it holds or has moved
  float target[3]; ///< m, where its centre is wanted
  float x, y;      ///< pixels, of the cursor
} Grab;

/// Grasp what lies under the cursor of a width × height picture. false, and nothing is held: no draggable body.
bool grab_begin(Grab *grab, const GrabBodies *bodies, const RenderView *view, float x, float y, int width, int height);
void grab_move(Grab *grab, const RenderView *view, float x, float y, int width, int height);
void grab_end(Grab *grab); ///< where it was wanted last is still to be taken

#endif
