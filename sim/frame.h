// One frame of water as plain arrays: what the simulator hands to the renderer, to particle files and to tests.
//
// Everything is SI: metres, seconds, kilograms; y points up. Every array belongs to whoever made the frame (a
// SimFrameBuffer) and stays valid until that maker writes its next frame. Readers never write. An array that nobody
// asked for (see SimNeed) is NULL. There is no OpenGL, no file and no window type here, so a frame can be made by hand
// in a test of the renderer.
#ifndef LIDO_SIM_FRAME_H
#define LIDO_SIM_FRAME_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/// What a reader wants computed. A style of the renderer declares its needs; only these stages run.
typedef enum SimNeed {
  SIM_NEED_NOTHING = 0,          ///< positions, ids, the grid, and what the world or the file has: always there
  SIM_NEED_CLASS = 1 << 0,       ///< particle_class: splash or aggregated, by the local density
  SIM_NEED_ANISOTROPY = 1 << 1,  ///< smoothed, ellipsoid (Yu & Turk 2013)
  SIM_NEED_SURFACE = 1 << 2,     ///< near_surface
  SIM_NEED_HEIGHT_FIELD = 1 << 3,///< height_field
  SIM_NEED_DENSITY = 1 << 4,     ///< density: a world's frame has it anyway
  SIM_NEED_SECOND_LAYER = 1 << 5,///< height_field, with its underside and second
  SIM_NEED_ALL = (1 << 6) - 1
} SimNeed;

/// Class of a particle. A particle file may bring its own; it is then used as it is.
typedef enum SimClass { SIM_SPLASH = 0, SIM_AGGREGATED = 1 } SimClass;

/// The uniform grid in which a frame's particles are sorted: cell c = (z·size[1] + y)·size[0] + x holds the
/// particles cell_start[c] … cell_start[c + 1] − 1, and cells that follow each other in x are contiguous in memory.
typedef struct SimGrid {
  float origin[3];             ///< m, the corner of cell (0, 0, 0)
  float cell_size;             ///< m, at least the support radius
  int32_t size[3];             ///< number of cells along x, y, z
  const int32_t *cell_start;   ///< (size[0]·size[1]·size[2] + 1), written by grid_sort
} SimGrid;

/// The free surface as a height over the floor, on the nodes of a regular grid in x and z
/// (Cords & Staadt 2007, Eq. 5). Node (i, k) is at x = origin[0] + i·spacing, z = origin[1] + k·spacing.
///
/// Where there is a container, nodes span it, so that they stay in place from frame to frame: the first and the last ones stand on
/// its walls (those farthest along the shorter side may stand behind, by less than a spacing, where no spacing divides both sides),
/// and water is level up to them. Around a glass they span the square; those up to 1½ spacings outside the wall are
/// mirror images of the water inside, so that cells on the rim are whole, and farther out there is no water. Without a
/// container they span the particles and two or three spacings around. Where an obstacle stands in the water, the surface goes
/// on through it. One that lies just under the surface leaves it as the water above says.
///
/// Where water hangs over: in a wave that breaks, under a jet, on a table, there may be a second layer. A column's layers are found
/// from above: the water at `height` ends in `underside`, if an obstacle-free stretch of air of a spacing or more is below; the next
/// water below it begins at `second`. What comes after counts as water down to the floor.
typedef struct SimHeightField {
  int32_t size[2];             ///< number of nodes along x and z; 0 when it was not asked for
  float origin[2];             ///< m, x and z of node (0, 0)
  float spacing;               ///< m, between neighbouring nodes
  const float *height;         ///< m, (size[1], size[0]); container.min[1], the lowest y, where there is no water
  const float *normal;         ///< unit, (size[1], size[0], 3); (0, 1, 0) where there is no water
  const float *underside;      ///< m, (size[1], size[0]): lower end of the water at `height`; container.min[1] where no air is
                               ///< below. NULL unless the second layer was asked for, as is `second`
  const float *second;         ///< m, (size[1], size[0]): surface of the water below that air; container.min[1] where there is none
} SimHeightField;

typedef enum SimShape {
  SIM_BOX = 0,
  SIM_SPHERE = 1,
  SIM_CYLINDER = 2,            ///< along y
  SIM_CAPSULE = 3,             ///< along y, with half balls at both ends
  SIM_STAIRS = 4,              ///< a solid flight that climbs towards +x in equal steps
  SIM_MESH = 5                 ///< a closed triangle mesh
} SimShape;
#define SIM_SHAPE_COUNT 6

/// A closed triangle mesh in a body's own axes, around its centre. Normals by the right-hand rule point outwards.
typedef struct SimMesh {
  int32_t vertex_count, triangle_count;
  const float *vertex;         ///< m, (vertex_count, 3)
  const int32_t *triangle;     ///< (triangle_count, 3), indices of vertices
} SimMesh;

/// A solid body in the water. Its own axes are turned by `rotation`, then moved by `position`.
typedef struct SimObstacle {
  SimShape shape;
  float size[3];               ///< m: box, stairs: full edge lengths; sphere: (diameter, –, –); cylinder, capsule: (diameter,
                               ///< full height along y, –), a capsule at least as high as wide; mesh: unused, its vertices
                               ///< are as large as they are
  float position[3];           ///< m, the centre (of a mesh: the origin of its vertices)
  float rotation[4];           ///< unit quaternion x, y, z, w
  float colour[3];             ///< linear light, [0, 1]
  int32_t steps;               ///< stairs: number of steps, [1, 1000]; step k (from 0) reaches up to (k + 1)/steps of the
                               ///< height and begins at k/steps of the length
  const SimMesh *mesh;         ///< mesh: its triangles, in a frame of a world the world's own copy; else NULL
} SimObstacle;

typedef enum SimContainerShape {
  SIM_CONTAINER_BOX = 0,
  SIM_CONTAINER_GLASS = 1      ///< an upright cylinder around the middle of the box, as wide as its shorter horizontal side
} SimContainerShape;

/// What holds the water: axis-aligned, open at the top for the eye but closed for particles.
typedef struct SimContainer {
  float min[3], max[3];        ///< m, the inner walls, or the box around them
  SimContainerShape shape;
} SimContainer;

typedef struct SimFrame {
  int64_t index;               ///< 0, 1, 2 … in a sequence of frames
  double time;                 ///< s since the start
  int32_t count;               ///< number of particles n; may be 0
  float particle_radius;       ///< m, half the spacing of the particles at rest

  // Particles, sorted by grid cell. The order changes from frame to frame: follow one by its id.
  const uint32_t *id;          ///< (n), unique; written by particles_add or the file; else the place in the file
  const float *position;       ///< m, (n, 3)
  const float *velocity;       ///< m/s, (n, 3); NULL for a file that has none
  const float *density;        ///< kg/m³, (n); for particles from a file, estimated from their positions if needed, else NULL
  const float *colour;         ///< linear light, [0, 1], (n, 3); NULL when every particle has the default colour of water
  const float *radius;         ///< m, (n); only for files that bring radii, else NULL: use particle_radius
  float bounds_min[3], bounds_max[3]; ///< m, the box around all positions, or the container's where there are none

  // Surface stages, each NULL unless needed.
  const uint8_t *particle_class; ///< SimClass, (n), written by surface_sweep
  const float *smoothed;       ///< m, (n, 3): smoothed centres x̄, written by surface_sweep
  const float *ellipsoid;      ///< m, (n, 6): the symmetric matrix T = (xx, yy, zz, xy, xz, yz) that maps the unit ball
                               ///< onto the particle's ellipsoid around its smoothed centre, written by surface_ellipsoids
  const uint8_t *near_surface; ///< 1 where the particle can be seen from outside the water, (n), written by surface_flags
  SimHeightField height_field; ///< written by surface_heightfield

  SimGrid grid;
  SimContainer container;
  bool has_container;          ///< false for particle files: then container is the bounds
  int32_t obstacle_count;
  const SimObstacle *obstacles; ///< (obstacle_count)
} SimFrame;

#ifdef __cplusplus
}
#endif
#endif
