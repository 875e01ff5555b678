// Obstacles of a frame as solids on the processor: how far points are from them and how far they reach. Plain C: no GL.
#ifndef LIDO_RENDER_SOLIDS_H
#define LIDO_RENDER_SOLIDS_H

#include "render/render.h"

/// An obstacle as it can be drawn. A mesh stands for the box around its vertices, along its own axes.
typedef struct RenderSolid {
  SimShape shape;
  int32_t steps;        // stairs
  float axis[3][3];     // unit, its own axes in the world
  float centre[3];      // m, of the box along its own axes
  float half[3];        // m, of that box
  float min[3], max[3]; // m, of the box around it along the world's axes
} RenderSolid;

/// false: it is absurd (no size, a place that is not a number) and drawn nowhere.
bool render_solid_take(RenderSolid *solid, const SimObstacle *obstacle);

/// Distance of a point from its surface, m, negative inside. Outside it is exact but for meshes, inside but for stairs and
/// meshes.
float render_solid_distance(const RenderSolid *solid, const float point[3]);

/// How far it reaches from its centre in a unit direction, m. Stairs: their box.
float render_solid_extent(const RenderSolid *solid, const float direction[3]);

/// The box around several along the world's axes; min > max when there are none.
void render_solids_bounds(const RenderSolid *solids, int32_t count, float min[3], float max[3]);

#endif
