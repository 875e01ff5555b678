// Lido's renderer: draws a SimFrame with OpenGL 4.5 core, in one of several published styles.
//
// The renderer never makes a context: the caller makes one current first (a window, EGL or OSMesa) and keeps it current
// for every call. All drawing goes to framebuffers of its own, so it works where there is no window at all;
// render_present copies the picture to framebuffer 0. Of simulation it knows sim/frame.h only.
//
//   RenderError error;
//   Render *render = render_create(1280, 720, &error);
//   RenderSettings settings = render_default_settings();
//   RenderView view = …;
//   if (render_draw(render, frame, &view, &settings, &error)) render_read_rgb8(render, pixels);
//
// Threads: every call from the thread that holds the context.
#ifndef LIDO_RENDER_RENDER_H
#define LIDO_RENDER_RENDER_H

#include <stddef.h>

#include "sim/frame.h"

#ifdef __cplusplus
extern "C" {
#endif

/// Why a call failed: one line without a newline, fit to be shown to a person. A shader's error names file and line.
typedef struct RenderError { char message[512]; } RenderError;

/// Where the eye is. Perspective, looking from `eye` at `target`, up as near to (0, 1, 0) as can be.
typedef struct RenderView {
  float eye[3], target[3];     ///< m
  float vertical_fov;          ///< degrees, full angle, (1, 170), default 38 (about a 35 mm lens at 16:9)
} RenderView;

typedef enum RenderToneMap {
  RENDER_TONE_NONE = 0,        ///< a PNG holds 255 × the linear value, clamped, undithered: for tests against truth
  RENDER_TONE_FILMIC = 1       ///< exposure, a filmic curve, the sRGB transfer, dither: the default
} RenderToneMap;

typedef enum RenderSky {
  RENDER_SKY_CLEAR = 0,        ///< a clear day with the sun and a soft horizon: the default
  RENDER_SKY_GRADIENT = 1      ///< exactly mix(horizon, zenith, max(0, d.y)) for a unit direction d; below the horizon: horizon
} RenderSky;

typedef enum RenderFloor {
  RENDER_FLOOR_TILES = 0,      ///< pale tiles with fine grout, fading into the horizon: the default
  RENDER_FLOOR_CHECKER = 1,    ///< exactly floor_colour[0] where floor(x/s) + floor(z/s) is even, else floor_colour[1]; unlit
  RENDER_FLOOR_NONE = 2        ///< no floor: sky everywhere
} RenderFloor;

/// How the style "refraction" makes a smooth surface of bumpy particles.
typedef enum RenderSmoothing {
  RENDER_SMOOTHING_REGRESSION = 0,   ///< lines fitted to the inverse depth along rows and columns: the default
  RENDER_SMOOTHING_PLANE_FIT = 1,    ///< iterated local planes (Imai et al. 2016, section 4.3)
  RENDER_SMOOTHING_BILATERAL = 2,    ///< iterated bilateral filter (Green 2010, Imai et al. 2014)
  RENDER_SMOOTHING_NARROW_RANGE = 3, ///< narrow-range filter (Truong & Yuksel 2018)
  RENDER_SMOOTHING_NONE = 4          ///< the particles as they are
} RenderSmoothing;

/// The style "refraction" (Imai, Kanamori, Mitani 2016); make it with render_default_settings.
typedef struct RenderRefraction {
  int32_t count;             ///< most refractions along a ray, [1, 4], default 4
  float scale;               ///< of the ellipsoids, [0.5, 2], default 1.2; 1: bounded by 1.2 radii, as in the paper
  float lift;                ///< how far ellipsoids at the surface are moved outwards, radii, [0, 2], default 0.8: then the
                             ///< picture's level is the water's; 0: they stay where smoothing has sunk them, as in the paper
  RenderSmoothing smoothing;
  float sigma;               ///< plane_fit (Eq. 2), bilateral: differences of depth that count, radii, (0, 100], default 5.3
  int32_t window;            ///< plane_fit and bilateral: taps across the window, [3, 63], default 9; 8 is as good as 9
  float reach;               ///< plane_fit: half of the window in particle radii, the same in the world however far it is,
                             ///< [0, 50]; 0 (default): the taps are neighbouring pixels
  int32_t iterations;        ///< plane_fit, bilateral, narrow_range: [1, 50], default 2
  bool view_dependent;       ///< plane_fit: weights by depth (Eq. 2), the default, or by distance (section 5)
  bool splashes_apart;       ///< splashes have depth maps of their own (default); off: one surface, as in Imai et al. 2014
  bool surface_only;         ///< draw only particles near the surface (default); off: all, which looks the same
} RenderRefraction;

/// Where the normals of the style "raycast" come from.
typedef enum RenderNormals {
  RENDER_NORMALS_BLEND = 0,    ///< PCA as far as it agrees with the gradient (Eqs. 5, 6): the default
  RENDER_NORMALS_GRADIENT = 1, ///< the gradient of a kernel sum alone (Eq. 2)
  RENDER_NORMALS_PCA = 2       ///< the direction in which the particles vary least alone (Eqs. 3, 4)
} RenderNormals;

/// The style "raycast" (Xiao, Zhang, Yang 2017); make it with render_default_settings.
typedef struct RenderRaycast {
  float iso;                 ///< value of the field at the surface, in that of water at rest, [0.01, 0.99], default 0.25; the
                             ///< paper's 10 … 30 with its 20 in the middle are 0.125 … 0.375
  float support;             ///< of the field's kernel (Eq. 1), radii, [2, 8], default 4
  RenderNormals normals;
  float normal_reach;        ///< R of Eqs. 2 to 4, radii, [2, 12], default 6: 3 spacings
  float blend_d, blend_k;    ///< of Eq. 6: [0, 1000], default 10, and [-1, 1], default 0.998
  float blend_weight;        ///< w of Eq. 5 instead of Eq. 6, [0, 1]; negative (default): Eq. 6
  float filter_reach;        ///< half of the bilateral filter's window, radii, [0, 20], default 3; 0: no filter
  float filter_angle;        ///< its standard deviation of normals, as the length of their difference, (0, 2], default 0.2
} RenderRaycast;

/// How the style "cartoon" makes a smooth surface of the particles' spheres.
typedef enum RenderCartoonSmoothing {
  RENDER_CARTOON_BILATERAL = 0,  ///< the bilateral filter of Rocha Neto et al. (Eqs. 1, 2): the default
  RENDER_CARTOON_CURVATURE = 1,  ///< curvature flow (van der Laan, Green, Sainz 2009)
  RENDER_CARTOON_NONE = 2        ///< the spheres as they are
} RenderCartoonSmoothing;

/// The colours of a drawing, linear light, [0, 1]. The water's are C_f of Eq. 8, what it would be in full light, for each of the
/// three regions of Eq. 7: three times the same is the paper's shading, different ones turn the hue with the light.
typedef struct RenderPalette {
  float dark[3], medium[3], bright[3]; ///< C_f
  float splash[2][3];                  ///< drops in the light, and away from it
  float ink[3];                        ///< outlines
  float shade[3];                      ///< what shadow leaves of a colour that is not water's
  float sky[3][3];                     ///< overhead, half way, at the horizon
  float floor[2][3];                   ///< tiles and the lines between them
} RenderPalette;

/// The style "cartoon" (Rocha Neto, Guimarães, Apolinário, Mello 2014); make it with render_default_settings.
typedef struct RenderCartoon {
  // the surface
  float scale;               ///< radius of the spheres, particle radii, [0.5, 4], default 1.5
  RenderCartoonSmoothing smoothing;
  int32_t kernel;            ///< bilateral: size of the kernel in pixels of the depth map, [0, 63]; 0 (default): by `reach`, so
                             ///< that it is the same in the world however far it is (section III-B)
  float reach;               ///< adaptive kernel, curvature: half of its size, radii, [0, 50], default 12
  bool separated;            ///< bilateral: along rows, then along columns; default false: the full kernel
  bool fitted;               ///< bilateral: the plane that fits best by the filter's weights, so that slanted water keeps its
                             ///< slope up to its borders: the default; false: the mean, as in Eqs. 1 and 2
  float range;               ///< bilateral: standard deviation in depth of what is one surface, radii, (0, 100], default 4
  bool half_resolution;      ///< depth, thickness and normals at half the picture's resolution, default true
  bool splashes_apart;       ///< drops are drawn by themselves and smear no surface (default); false: as in the paper
  // tones
  int32_t levels;            ///< l of Eq. 6, [1, 32], default 3
  bool bright_levels;        ///< the ceiling instead of the floor in Eq. 6: slightly brighter, default true
  bool steady;               ///< levels are shifted so that still water lies in the middle of one and its tone cannot
                             ///< flicker (default); false: as in the paper
  float bright_threshold, dark_threshold; ///< T_bc and T_dc of Eq. 7, [0, 1], default 0.85 and 0.5
  float bright_factor, dark_factor;       ///< F_bc and F_dc, [1, 10] and [0, 1], default 1.1 and 0.9
  // light
  bool reflection, refraction;                   ///< what the water shows beside its tones (Figure 6), default true
  float most_reflection, least_reflection;       ///< K_Rmax and K_Rmin of Eq. 4, [0, 1], default the palette's and 0
  float most_transparency, least_transparency;   ///< K_Tmax and K_Tmin of Eq. 5, [0, 1], default the palette's and 0
  float critical_angle, angle_interval;          ///< θ_c and θ_s: reflection and transparency change over within θ_s on either
                                                 ///< side of θ_c, degrees, [0, 90], default 60 and 20
  float clearness;           ///< m of water through which a share of 1/e of the scene behind is seen (T of Eq. 8 in this unit),
                             ///< [0, 1e6]; 0 (default): a twelfth of the scene's size
  float bending;             ///< λ of Eq. 10: displacement of what is behind by a metre of water, m, [-10, 10], default 0.3
  // lines
  float outline;             ///< width of outlines, pixels, [0, 16], default 3; 0: none
  float crease_angle;        ///< edges of solids and water sharper than this are outlined too, degrees, [0, 180], default 40
  RenderPalette palette;
} RenderCartoon;

/// From where the style "heightfield" draws what stands in the water into its map of refracted objects.
typedef enum RenderVirtualEyes {
  RENDER_EYES_EACH = 0,      ///< an eye for every ray, as plane water bends it (Figure 2, top): the default
  RENDER_EYES_SCALED = 1,    ///< one for each object (Eqs. 2, 3), its picture scaled to the right length (Figure 3)
  RENDER_EYES_ONE = 2        ///< one for each object, unscaled
} RenderVirtualEyes;

/// How the rays of the real surface are looked up in the maps of objects.
typedef enum RenderMapAccess {
  RENDER_ACCESS_POINT = 0,     ///< by the point in which they pass the object: the default
  RENDER_ACCESS_DIRECTION = 1  ///< by their direction alone, as in the paper
} RenderMapAccess;

/// The style "heightfield" (Cords 2007); make it with render_default_settings. Lengths in spacings are those of the particles,
/// 2 radii.
typedef struct RenderHeightfield {
  float smoothing;           ///< standard deviation of the filter of the heights, spacings, [0, 8], default 1
  bool drops;                ///< particles that fly above the surface are drawn as balls, default true
  bool second_layer;         ///< water that hangs over air (a wave that breaks, a jet) is a layer of its own and needs
                             ///< SIM_NEED_SECOND_LAYER; default false: it is filled down to the floor
  // objects
  bool mapped;               ///< objects are seen through maps of them (default); false: rays meet their geometry
  RenderVirtualEyes eyes;
  RenderMapAccess access;
  float plane_reach;         ///< the surface as far around an object makes its plane, spacings, [1, 1000], default 12
  float pull_reach;          ///< within this of an object the surface is pulled to that plane, spacings, [0, 1000], default 6
  float group_distance;      ///< objects that are closer share a plane and an eye, spacings, [0, 1000], default 1
  bool trapezium;            ///< the map of objects counts only between an object and the eye (Figure 8), default true
  float trapezium_a;         ///< a: width of the trapezium behind the object, in the object's, [0.1, 100], default 3
  float trapezium_b;         ///< b: its width at the eye, in the object's, [0.1, 100], default 3
  // caustics
  bool traced_caustics;      ///< light refracted by the surface onto floor and objects (section 2.4), default true
  bool simple_caustics;      ///< Eq. 4, default false; both may be on
  float simple_height, simple_slope, simple_base; ///< a, b and c of Eq. 4, [-100, 100], default 0.6, 2 and 0.6
  float dispersion;          ///< the refractive index of blue light less that of red, [0, 0.5], default 0; water: 0.013
} RenderHeightfield;

/// A palette with a name, and how much a liquid of these colours mirrors and lets through.
typedef struct RenderNamedPalette {
  const char *name;
  float most_reflection, most_transparency;
  RenderPalette palette;
} RenderNamedPalette;
const RenderNamedPalette *render_palette(int32_t index); ///< NULL when out of range; 0 is "lagoon", the default

/// Everything about a picture that is not the water's shape or the eye. Colours are linear light.
/// Make it with render_default_settings, change what you need.
typedef struct RenderSettings {
  uint32_t cookie;             ///< set by render_default_settings; others are refused
  const char *style;           ///< name in the style table, default "points"

  // light
  float sun_direction[3];      ///< towards the sun, need not be unit, default (−0.45, 0.75, 0.5): late morning
  float sun_colour[3];         ///< irradiance, linear, default (3.8, 3.5, 3.0)
  bool sun;                    ///< default true; off: neither sunlight nor glints
  bool shadow;                 ///< default true

  // environment
  RenderSky sky;
  float sky_zenith[3], sky_horizon[3]; ///< of the gradient sky
  RenderFloor floor;
  float floor_level;           ///< m, y of the floor's top; default NAN: the container's lowest y
  float tile_size;             ///< m, edge of a tile or checker square, default 0.2, > 0
  float floor_colour[2][3];    ///< the checker's colours
  bool container_visible;      ///< thin bright edges of the tank, default true

  // liquid
  float absorption[3];         ///< 1/m per channel, red > green > blue, default (3.2, 0.68, 0.46)
  float scattering[3];         ///< 1/m per channel: how soon light turns aside in it, default (0.14, 0.34, 0.36): a clear pool;
                               ///< "points" and "raycast" show it
  float reflectance[3];        ///< of a metal at normal incidence, [0, 1]; default 0: it lets light through. "raycast" shows it
  float refractive_index;      ///< of the liquid, default 1.333, range [1, 3]

  // picture
  RenderToneMap tone_map;
  float exposure;              ///< factor before the curve, default 1, > 0

  RenderRefraction refraction;
  RenderRaycast raycast;
  RenderCartoon cartoon;
  RenderHeightfield heightfield;

  // style "points"
  struct { float scale; } points; ///< sphere radius in particle radii, default 1.25, range [0.1, 5]
} RenderSettings;
RenderSettings render_default_settings(void);

/// Absorption, scattering, reflectance and refractive index of a liquid that has a name. Liquids that scatter much are opaque
/// a few centimetres deep.
typedef struct RenderMaterial {
  const char *name;
  float absorption[3], scattering[3], reflectance[3];
  float refractive_index;
} RenderMaterial;
const RenderMaterial *render_material(int32_t index);           ///< NULL when out of range; 0 is "water", the default
const RenderMaterial *render_material_find(const char *name);   ///< NULL when there is none
void render_use_material(RenderSettings *settings, const RenderMaterial *material);

typedef struct Render Render;

/// NULL and *error when there is no OpenGL 4.5 core context, the size is out of [1, 16384], or a shader fails.
Render *render_create(int32_t width, int32_t height, RenderError *error);
void render_destroy(Render *render); ///< NULL is allowed; the context must still be current
/// After a failed resize (out of memory) nothing can be drawn until one succeeds.
bool render_resize(Render *render, int32_t width, int32_t height, RenderError *error);

/// Draw one frame. Particles that are NaN or out of view are skipped; no particle is an empty tank, not an error.
/// false and *error: unknown style, a style's need is missing from the frame, a value out of range, GL out of memory.
bool render_draw(Render *render, const SimFrame *frame, const RenderView *view, const RenderSettings *settings,
                 RenderError *error);

/// Read back the last picture: rows from top to bottom, width·height·3 bytes.
void render_read_rgb8(Render *render, uint8_t *rgb);
/// Copy the last picture to framebuffer 0, whose size is given in pixels.
void render_present(Render *render, int32_t window_width, int32_t window_height);

// ---- Styles and their layers ---------------------------------------------------------------------------------------------

int32_t render_style_count(void);
const char *render_style_name(int32_t index);         ///< NULL when out of range
const char *render_style_summary(int32_t index);      ///< one line: what it is, after whom
/// SimNeed bits, with those that only some settings need; NULL: the default settings. 0 for an unknown style.
unsigned render_style_needs(const char *style, const RenderSettings *settings);
bool render_style_exists(const char *style);

/// A layer is an intermediate of the style: depth, normal … The background's own layers belong to every style.
int32_t render_layer_count(const char *style);
const char *render_layer_name(const char *style, int32_t index);
const char *render_layer_summary(const char *style, int32_t index); ///< one line: what it is and its unit
/// Show a layer instead of the picture in later draws; NULL: the picture. false: the style has no such layer.
bool render_show_layer(Render *render, const char *layer);
/// Read the shown layer's raw values from the last draw: rows from top to bottom, width·height·*channels floats (1 or 3).
/// `values` NULL: only set *channels. false: no layer is shown.
bool render_read_layer(Render *render, float *values, int32_t *channels);

// ---- A line of text over the picture (the window's help and figures) ------------------------------------------------------

/// Draw `text` (ASCII, lines separated by \n) over the last picture, top left corner at (x, y) pixels.
void render_text(Render *render, int32_t x, int32_t y, int32_t scale, const char *text);

// ---- Measuring -----------------------------------------------------------------------------------------------------------

typedef struct RenderPassTime {
  const char *name;
  double gpu_milliseconds;       ///< between two timestamps of the GPU
  double cpu_milliseconds;       ///< of the calling thread's clock
  double processor_milliseconds; ///< of processor time, all threads of the process: what a software renderer costs
} RenderPassTime;
/// Wait for the GPU at the end of every pass, so that the times of a pass are its own. Slower; off at first.
void render_measure_passes(Render *render, bool on);
/// Times of the passes of the last draw, in order. GPU times wait for the GPU: ask only when you want them.
/// Returns the number of passes; at most `capacity` are written.
int32_t render_pass_times(Render *render, RenderPassTime *times, int32_t capacity);

/// A number that the style tells of its last picture.
typedef struct RenderFigure { const char *name; double value; } RenderFigure;
/// Of "refraction": the share of the water's pixels in which a ray went through "splash" or "aggregated" water alone, or
/// through two bodies ("splash_aggregated" …). Waits for the GPU. Returns how many there are; at most `capacity` are written.
int32_t render_figures(Render *render, RenderFigure *figures, int32_t capacity);

/// Bytes in OpenGL's buffers, of all renderers of this process: particles, grids and other lists, not textures. A software
/// renderer holds them in the memory of the process.
size_t render_buffer_bytes(void);

/// Errors and warnings that the driver reported (KHR_debug) since creation; 0 in a correct program.
int32_t render_gl_error_count(const Render *render);
/// "vendor / renderer / version" of the context.
const char *render_gl_description(const Render *render);


#ifdef __cplusplus
}
#endif
#endif
