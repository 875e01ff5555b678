// What one picture is made from: everything that the passes of all styles share. Internal to the renderer.
//
// A pass is one function with named inputs and outputs and no hidden state; render.c runs the shared ones and the
// style's in the order
//   particles (upload) → sun map → background → the style's passes → front edges of the container → compose.
#ifndef LIDO_RENDER_PICTURE_H
#define LIDO_RENDER_PICTURE_H

#include "render/gpu.h"

typedef struct RenderPicture RenderPicture;

/// Distance from the eye below which nothing is drawn, m.
#define RENDER_NEAR 1e-3f
/// Particles farther than this from the origin are left out as invalid, m.
#define RENDER_FARTHEST 1e6f

static inline float render_clamp01(float x) {
  return x > 0 ? (x < 1 ? x : 1) : 0; // NaN becomes 0
}

/// The Frame block of frame.glsl, std140. Constant during a picture.
typedef struct RenderFrameBlock {
  float world_to_view[16];  // column major; rigid
  float eye[4];             // m; near distance
  float lens[4];            // tan of half the angle of view in x, y; picture size in pixels
  float sun_direction[4];   // unit, towards the sun; 1 when there is a sun, else 0
  float sun_colour[4];      // irradiance
  float sun_u[4], sun_v[4]; // dot(p, xyz) + w is the place in the sun map, [0, 1]
  float sun_map[4];         // metres across the map in u and v; 1 − 1/n; RENDER_SUN_IN_WATER: the water's level, m
  float absorption[4];      // 1/m; reflectance at normal incidence F0
  float scattering[4];      // 1/m
  float reflectance[4];     // of a metal at normal incidence; –
  float sky_zenith[4];      // of the gradient sky; –
  float sky_horizon[4];     // of the gradient sky; –
  float floor_colour[2][4]; // of the checker; –
  float floor_plane[4];     // level (m), tile size (m), distance at which tiles fade out (m), –
  float container_min[4];   // m; water level of the container, 1 when it is drawn, else 0
  float container_max[4];   // m; size of the scene (m)
  // of drawn pictures, see drawn.glsl
  float drawn_levels[4];  // l of Eq. 6; 1: its ceiling, 0: its floor; shift of the levels; width of outlines (pixels)
  float drawn_regions[4]; // T_bc, T_dc, F_bc, F_dc of Eq. 7
  float drawn_ink[4];     // linear; cosine of the angle of creases
  float drawn_shade[4];   // –
  float drawn_sky[3][4];  // –
  float drawn_floor[2][4]; // –
} RenderFrameBlock;

/// The particles on the GPU, in the frame's order; those without a sensible position or radius have a radius of 0.
typedef struct RenderParticles {
  GpuBuffer spheres; // (count) vec4: centre, radius of the particle at rest; m
  GpuBuffer colours; // (count) vec4: colour, linear; spray 0 … 1; a single one for all where `tinted` is false
  int32_t count;     // 0 when none is to be drawn
  bool spray;        // particles may differ in spray
  bool tinted;       // particles may differ in colour or spray
  float bounds_min[3], bounds_max[3]; // m, of the spheres taken; min > max when there are none
} RenderParticles;
/// `spray`: it is looked at, so that particles need a colour each even where the frame has none.
bool render_particles_upload(RenderParticles *particles, const SimFrame *frame, bool spray, RenderError *error);
void render_particles_destroy(RenderParticles *particles);

/// Which tiles of the picture spheres may touch: passes that only concern water draw these (screen.glsl with TILES).
#define RENDER_TILE_SIZE 32
typedef struct RenderTiles {
  GpuProgram program;
  GpuBuffer mask; // (rows, columns) uint32: 1 or 0
  int32_t columns, rows;
} RenderTiles;
/// Spheres that will be drawn.
typedef struct RenderTileMarks {
  const GpuBuffer *spheres; // vec4 each: centre and radius, m
  int32_t count, stride;    // stride: vec4s from one to the next
  float scale;              // drawn with this times their radius
} RenderTileMarks;
/// Output: picture->tiles, of which none is marked.
bool render_tiles_clear(RenderPicture *picture, RenderError *error);
/// Output: picture->tiles, with those marked that the spheres may touch.
bool render_tiles_mark(RenderPicture *picture, const RenderTileMarks *marks, RenderError *error);
void render_tiles_destroy(RenderTiles *tiles);
/// A pass over the pixels of the marked tiles (tile_pass.glsl). Of `desc` label, file and defines are taken. Output: the
/// colours of `target`, which are `out`.
typedef struct RenderTilePass {
  GpuProgram *program;
  GpuProgramDesc desc;
  const GpuTarget *target;
  const GpuTexture *out[GPU_MAX_COLOURS];
  GpuInputs in;  // without frame and tiles
  int32_t scale; // pixels of the picture across one of the target; 0: 1
} RenderTilePass;
bool render_tile_pass(RenderPicture *picture, const RenderTilePass *pass, RenderError *error);

/// A triangle mesh on the GPU.
typedef struct RenderMesh {
  int32_t vertex_count, triangle_count;
  unsigned char *content; // its vertices and triangles as they came, by which it is known again
  GpuBuffer corners;      // (corner_count, 6) float: position (m), unit normal; three corners for each triangle
  int32_t corner_count;   // 0 when nothing of it can be drawn
  float reach;            // m, of the farthest corner from the origin
  float half[3];          // m, of the box around the origin that holds it, along its own axes
  bool shown;             // in the picture at hand
} RenderMesh;

typedef struct RenderMeshes {
  RenderMesh *meshes; // (count)
  int32_t count;
} RenderMeshes;
/// Output: the index of the mesh with this content, made when there is none; −1 when no triangle can be drawn.
bool render_meshes_take(RenderMeshes *meshes, const SimMesh *mesh, int32_t *index, RenderError *error);
/// Drop those that have not been taken since the last call. Indices change.
void render_meshes_forget(RenderMeshes *meshes);
void render_meshes_destroy(RenderMeshes *meshes);

/// Who sees the bodies of a picture.
typedef enum RenderLooker {
  RENDER_EYE = 0,
  RENDER_SUN,         // in parallel projection: heights towards it
  RENDER_SUN_IN_WATER // the same of what lies below the level of the Frame block's sun_map[3]
} RenderLooker;

/// Solid bodies on the GPU, sorted by shape.
typedef struct RenderObstacles {
  GpuProgram program[3][SIM_SHAPE_COUNT]; // for each RenderLooker
  GpuBuffer bodies;                       // (count) struct Body of body.glsl
  int32_t count;
  int32_t first[SIM_SHAPE_COUNT + 1]; // the bodies of a shape: first[shape] … first[shape + 1] − 1
  int32_t *mesh_of_body;              // indices of meshes, from body first[SIM_MESH] on
  int32_t *obstacle_of_body;          // (count) places in the frame's list
  RenderMeshes meshes;
  float bounds_min[3], bounds_max[3]; // m; min > max when there are none
} RenderObstacles;

/// The scene as the sun sees it, from infinitely far away. Heights are metres towards the sun.
typedef struct RenderSunMap {
  GpuProgram splat_program, blur_program[2], relief_program;
  GpuTexture raw;                   // of the spheres: thickness (m), –, –, height
  GpuTexture half_blurred, blurred; // thickness, height, coverage, –
  GpuTexture water;                 // thickness, height, coverage, focus of the light on what lies below
  GpuTexture normal;                // of the smooth surface
  GpuTexture solid;                 // height of the nearest obstacle
  GpuTarget raw_target, solid_target;
} RenderSunMap;

/// Sky, floor, obstacles and the back edges of the container.
typedef struct RenderBackground {
  GpuProgram sky_program, floor_program;
  GpuProgram edge_program[2]; // back, front
  GpuProgram pane_program;
  GpuTexture colour; // rgb: linear light; a: depth along the view axis (m), 0 for the sky
  GpuTarget target;
} RenderBackground;

/// From linear light to bytes.
typedef struct RenderCompose {
  GpuProgram tone_program, smooth_program, layer_program;
  GpuTexture toned, final; // before and after antialiasing
  GpuTarget toned_target, final_target;
} RenderCompose;

struct RenderPicture {
  Gpu *gpu;
  const SimFrame *frame;
  const RenderSettings *settings;
  int32_t width, height;
  GpuBuffer uniforms;     // the Frame block
  RenderFrameBlock block; // what is in it
  bool drawn;             // in flat colours, see drawn.glsl
  char defines[256];      // compile-time choices: sky, floor, sun, shadow …
  RenderParticles particles;
  RenderTiles tiles;
  RenderObstacles obstacles;
  RenderSunMap sun_map;
  RenderBackground background;
  RenderCompose compose;
  GpuTexture depth;  // reversed depth of everything drawn so far: background, then the style's surface
  GpuTexture colour; // the style's picture in linear light
  GpuTarget target;  // colour and depth: where a style draws its picture, over a copy of the background
};

/// Camera, sun and environment into the Frame block and the compile-time choices.
bool render_frame_block_write(RenderPicture *picture, const RenderView *view, RenderError *error);

bool render_obstacles_upload(RenderPicture *picture, RenderError *error);
void render_obstacles_destroy(RenderObstacles *obstacles);
/// Draw all bodies; `draw` has target, depth, blend and the inputs beyond the bodies.
bool render_obstacles_draw(RenderPicture *picture, RenderLooker looker, GpuDraw draw, RenderError *error);

bool render_sun_map_create(RenderPicture *picture, RenderError *error);
void render_sun_map_destroy(RenderPicture *picture);
bool render_sun_map_draw(RenderPicture *picture, RenderError *error);

bool render_background_resize(RenderPicture *picture, RenderError *error);
void render_background_destroy(RenderPicture *picture);
bool render_background_draw(RenderPicture *picture, RenderError *error);
/// Glass and edges of the container that lie between the eye and the water, over the finished picture.
bool render_front_glass_draw(RenderPicture *picture, RenderError *error);

/// How a layer is turned into something to look at.
typedef enum RenderMap {
  RENDER_MAP_DEPTH = 0, // metres, near bright to far dark on a repeating hue; 0 black
  RENDER_MAP_NORMAL,    // n·0.5 + 0.5; zero vector black
  RENDER_MAP_SCALAR,    // from 0 (dark blue) over green to `top` (yellow)
  RENDER_MAP_COLOUR     // linear light, tone-mapped
} RenderMap;

typedef struct RenderLayer {
  const char *name;
  const char *summary; // what it is and its unit
  RenderMap map;
  size_t texture;            // offset of the GpuTexture in the style's state (or in RenderPicture)
  int32_t channel, channels; // first channel and how many: 1 or 3
  float top;                 // of RENDER_MAP_SCALAR
} RenderLayer;

bool render_compose_resize(RenderPicture *picture, RenderError *error);
void render_compose_destroy(RenderPicture *picture);
bool render_compose_draw(RenderPicture *picture, RenderError *error);
bool render_compose_layer(RenderPicture *picture, const RenderLayer *layer, const GpuTexture *texture,
                          RenderError *error);

#endif
