// A tank and a round glass of still water, and where the eye meets their walls, computed.
#ifndef LIDO_TESTS_RENDER_WALLS_H
#define LIDO_TESTS_RENDER_WALLS_H

#include "tests/render/water.h"

#define WALL_RADIUS 0.0175f // m, of the particles
#define WALL_LEVEL 0.42f    // m, of the water
extern const SimContainer wall_tank, wall_glass;

/// Where a ray meets a wall: depth, outward normal, distance to the nearest edge of the wetted face in radii, as the eye
/// sees it: windows of a filter are as large across the ray, and larger on a wall that lies aslant.
typedef struct WallMeeting {
  double depth, normal[3], from_edge;
} WallMeeting;

/// The wall or the floor through which the ray comes in (side 0) or goes out (1); false: none, or the water's surface.
typedef bool WallMeet(const Ray *ray, int side, WallMeeting *m);
bool wall_meet_tank(const Ray *ray, int side, WallMeeting *m);
bool wall_meet_glass(const Ray *ray, int side, WallMeeting *m);

#endif
