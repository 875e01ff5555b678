// Objects that stand in the water, or over or under its surface, and what plane water shows of them: Cords, "Refraction of
// Water Surface Intersecting Objects in Interactive Environments", 2007, sections 2.1 to 2.3. Plain C on plain arrays: no GL.
//
// An object is an obstacle, or several that are close to each other. The surface around it is taken for a plane; from it
// come the eye that a mirror there would have (Eq. 1), the eye from which its part below is seen (Eqs. 2, 3) and by how
// much that picture must be stretched (Figure 3). Around objects that stand in the surface, the height field is pulled
// to their planes.
#ifndef LIDO_RENDER_WATER_OBJECTS_H
#define LIDO_RENDER_WATER_OBJECTS_H

#include "render/render.h"

/// Most objects of a picture; when there are more, they are grouped over larger distances.
#define RENDER_MAX_WATER_OBJECTS 32

typedef struct RenderWaterObject {
  float plane[4];         // unit normal upwards; dot(normal, p) + w is a point's height over it, m
  bool crosses;           // stands in the surface: some of it lies above the plane and some below
  float centre[3], reach; // m, a ball around all of it
  float axis[2][3]; // m, the ends of its main axis, the lower one first: of a single body its own that is nearest to
                    // upright, else the upright one of the box around it
  float a[3]; // m, the point of plane and object nearest to the eye; of an object under water where the eye sees the
              // top of its axis, of one in the air the foot of its bottom
  float b[3]; // m, the lowest point of its main axis, at or below the plane
  float eye_reflected[3]; // m, Eq. 1
  float eye_refracted[3]; // m, Eq. 2
  float seen_b[3];        // m, where on the plane the eye really sees b (b'_real of Figure 3)
  float unscaled_b[3];    // m, where on the plane the one refracted eye shows b (b' of Figure 3)
  float half_width; // m, of its cross-section with the plane, or of itself: a circle around `middle` that holds it
  float middle[3];  // m, of that circle, on the plane
} RenderWaterObject;

typedef struct RenderWaterObjects {
  RenderWaterObject objects[RENDER_MAX_WATER_OBJECTS];
  int32_t count;
  int32_t
      *of_obstacle; // (frame->obstacle_count): index of its object; −1: it belongs to the surroundings (outside of the
                    // container, like the wall of a pool, or under all of it) or it is absurd
  float
      *heights; // (field.size[1], field.size[0]) m: the frame's, NaN where there is no water, pulled to the planes near
                // objects and continued a little into them
  SimHeightField field; // the frame's with these heights; of no nodes where the frame's is absurd
  // Scratch.
  struct RenderSolid *solids;        // (2 · capacity), sorted by object
  float *levels;                     // (capacity) m
  int32_t *parents;                  // (capacity)
  uint8_t *marks;                    // as many as heights
  size_t capacity, heights_capacity; // obstacles and nodes there is room for
} RenderWaterObjects;

/// Find objects, planes and eyes of a frame, and its height field pulled to the planes. `index`: refractive index of the water.
/// false: out of memory.
bool render_water_objects_find(RenderWaterObjects *found, const SimFrame *frame, const float eye[3],
                               const RenderHeightfield *settings, float index, RenderError *error);
void render_water_objects_destroy(RenderWaterObjects *found);

/// Where light from the point `below` (at or below the plane) leaves the plane water of this index for the eye at or above it
/// (Snell; Fermat's point on the plane). An eye below the plane: where the straight line meets it, or its foot.
void render_refraction_point(const float plane[4], const float eye[3], const float below[3], float index,
                             float point[3]);

/// Has a height field nodes, of a number and at places that can be drawn?
bool render_field_is_sensible(const SimHeightField *field);

/// Distance of a point from an obstacle, m, negative inside. Exact for box, ball, cylinder and capsule, for stairs outside of
/// them; a mesh stands for the box around it. INFINITY for an absurd obstacle.
float render_obstacle_distance(const SimObstacle *obstacle, const float point[3]);

#endif
