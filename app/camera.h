// The eye of the window: it orbits a target, pans with the point under the cursor and zooms. Pure functions on plain
// values; lengths in metres, angles in radians, pixels counted from the top left corner of the picture.
#ifndef LIDO_APP_CAMERA_H
#define LIDO_APP_CAMERA_H

#include "render/render.h"

typedef struct Camera {
  float target[3];                  ///< m, what the eye looks at and turns around
  float yaw;                        ///< about y, (−π, π]; 0: the eye is on the target's +z side
  float pitch;                      ///< above the horizon, at most CAMERA_MAX_PITCH either way
  float distance;                   ///< m, from the eye to the target, in [min_distance, max_distance]
  float min_distance, max_distance; ///< m, > 0
  float vertical_fov;               ///< degrees
} Camera;

/// 89°: short of the pole, where "up" would flip.
#define CAMERA_MAX_PITCH 1.5533430f

/// The camera of a view. Zoom limits come from the size of what is looked at (m, its diagonal), widened to hold the
/// view's own distance. Eye on the target: looks along −z from a distance of `size`.
Camera camera_from_view(const RenderView *view, float size);
RenderView camera_view(const Camera *camera);

/// Turn around the target: half a turn for a drag across the height of the picture. The scene follows the hand.
void camera_orbit(Camera *camera, float dx, float dy, int height);

/// Move so that the point of the target's plane under the cursor stays under it.
void camera_pan(Camera *camera, float dx, float dy, int height);

/// One step (a click of the wheel, positive: nearer) changes the distance by a tenth, within the limits.
void camera_zoom(Camera *camera, float steps);

/// The ray from the eye through a pixel of a width × height picture; (width/2, height/2) is its centre.
void camera_ray(const RenderView *view, float x, float y, int width, int height, float origin[3], float direction[3]);

/// Where a point appears in the picture. false: it lies behind the eye.
bool camera_project(const RenderView *view, const float point[3], int width, int height, float *x, float *y);

/// The picture's axes as unit vectors: right, up, and into the picture. Looking straight down, up is −z.
void camera_axes(const RenderView *view, float right[3], float up[3], float forward[3]);

#endif
