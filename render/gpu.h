// The GPU layer: a thin, explicit skin over OpenGL 4.5 core.
//
// One description struct per object, in which zero means the default; a label on every object, which errors name; and
// one function, gpu_draw, that sets all state of a draw: no other file of the renderer enables, blends or masks
// anything. Depth is reversed and reaches to infinity (near / distance, so 0 is infinitely far), which keeps a glass
// and an ocean equally precise.
//
// Objects are plain structs; an object whose id is 0 does not exist, and destroying it does nothing.
#ifndef LIDO_RENDER_GPU_H
#define LIDO_RENDER_GPU_H

#include "render/render.h"

// ---- The context -----------------------------------------------------------------------------------------------------

#define GPU_MAX_PASSES 32

/// Time of one pass: two GPU timestamps, the calling thread's time between them, and the processor time of all threads.
typedef struct GpuPass {
  const char *name;
  unsigned query[2];
  double cpu_milliseconds, processor_milliseconds;
} GpuPass;

/// What belongs to the context as a whole. Must not move in memory: the driver's debug callback points to it.
typedef struct Gpu {
  unsigned vertex_array; // empty: shaders fetch their vertices themselves
  unsigned params;       // uniform buffer of the draw at hand
  bool software;         // drawn by the processor: Mesa's llvmpipe or softpipe
  size_t block_limit;    // bytes that a shader storage block may hold
  size_t block_start;    // a part of a buffer that is bound as a block begins at a multiple of this
  int32_t error_count;   // errors and warnings reported by the driver
  char description[256]; // vendor / renderer / version
  char last_error[256];  // the driver's words for the last of them
  bool measuring;        // wait for the GPU at the end of every pass
  int32_t pass_count;    // passes timed since gpu_passes_restart
  GpuPass passes[GPU_MAX_PASSES];
} Gpu;

bool gpu_create(Gpu *gpu, RenderError *error); ///< false: no OpenGL 4.5 core here
/// For tests: what is created from now on draws on a software rasteriser as it would on hardware.
void gpu_draw_like_hardware(bool on);
void gpu_destroy(Gpu *gpu);
void gpu_collect_errors(Gpu *gpu); ///< count what glGetError still holds
bool gpu_fail(RenderError *error, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 2, 3)))
#endif
    ; ///< fill *error and return false

void gpu_passes_restart(Gpu *gpu);
void gpu_pass_begin(Gpu *gpu, const char *name); ///< the name must outlive the frame
void gpu_pass_end(Gpu *gpu);
double gpu_pass_milliseconds(const GpuPass *pass); ///< waits for the GPU

// ---- Textures and targets --------------------------------------------------------------------------------------------

typedef enum GpuFormat {
  GPU_RGBA8 = 0,
  GPU_RGBA16F,
  GPU_RGBA32F,
  GPU_RG32F,
  GPU_R32F,
  GPU_RGBA32UI, // of bits: shaders fetch its texels, nothing filters or reads them
  GPU_R32I,     // of views of buffers only
  GPU_DEPTH32F,
  GPU_FORMAT_COUNT
} GpuFormat;

typedef struct GpuTextureDesc {
  const char *label;
  int32_t width, height;
  GpuFormat format;
  bool linear; // filter between texels; default: nearest
} GpuTextureDesc;

typedef struct GpuTexture {
  unsigned id;
  int32_t width, height;
  GpuFormat format;
} GpuTexture;

bool gpu_texture_create(GpuTexture *texture, const GpuTextureDesc *desc, RenderError *error);
void gpu_texture_destroy(GpuTexture *texture);
int32_t gpu_texture_channels(const GpuTexture *texture);
/// Copy all texels to a texture of the same size and format.
void gpu_texture_copy(const GpuTexture *from, const GpuTexture *to);
/// Read all texels as floats, bottom row first: width·height·gpu_texture_channels values.
void gpu_texture_read(const GpuTexture *texture, float *values);

#define GPU_MAX_COLOURS 3
typedef struct GpuTargetDesc {
  const char *label;
  const GpuTexture *colour[GPU_MAX_COLOURS];
  const GpuTexture *depth;
} GpuTargetDesc;

typedef struct GpuTarget {
  unsigned id; // framebuffer
  int32_t width, height, colour_count;
} GpuTarget;

bool gpu_target_create(GpuTarget *target, const GpuTargetDesc *desc, RenderError *error);
void gpu_target_destroy(GpuTarget *target);
void gpu_clear_colour(const GpuTarget *target, int32_t index, const float rgba[4]);
void gpu_clear_bits(const GpuTarget *target, int32_t index);
typedef enum GpuDepthClear { GPU_FARTHEST = 0, GPU_NEAREST } GpuDepthClear;
void gpu_clear_depth(const GpuTarget *target, GpuDepthClear to); ///< to infinitely far, or to the near distance

// ---- Buffers ---------------------------------------------------------------------------------------------------------

typedef struct GpuBuffer {
  unsigned id;
  size_t capacity; // bytes
  unsigned view;   // texture, see gpu_buffer_view
} GpuBuffer;

/// Make room; the content is lost. The buffer is made, or grows, as needed. false: GL is out of memory.
bool gpu_buffer_reserve(GpuBuffer *buffer, const char *label, size_t size, RenderError *error);
/// Write a part of what has been reserved.
void gpu_buffer_fill(const GpuBuffer *buffer, size_t offset, const void *data, size_t size);
/// Both: replace the content.
bool gpu_buffer_write(GpuBuffer *buffer, const char *label, const void *data, size_t size, RenderError *error);
/// Let shaders read it as a samplerBuffer (GPU_RGBA32F) or an isamplerBuffer (GPU_R32I): storage blocks are small on some
/// drivers, views are not. false: it holds more texels than the driver allows, which the message tells.
bool gpu_buffer_view(GpuBuffer *buffer, GpuFormat format, size_t texels, RenderError *error);
void gpu_buffer_destroy(GpuBuffer *buffer);
/// For tests: views hold no more texels than this, whatever the driver allows. 0: no such limit (the default).
void gpu_limit_views(size_t texels);
/// Of all buffers of this process.
size_t gpu_buffer_bytes(void);

// ---- Programs --------------------------------------------------------------------------------------------------------

/// A shader file that CMake has put into the library.
typedef struct GpuSource {
  const char *name; // "points.glsl"
  const char *text;
} GpuSource;
extern const GpuSource gpu_sources[]; // ends with a NULL name; generated

/// One file holds all stages: it is compiled once per stage with VERTEX_STAGE, FRAGMENT_STAGE or COMPUTE_STAGE defined.
typedef struct GpuProgramDesc {
  const char *label;
  const char *file;         // name in `sources`; may #include "other.glsl"
  const char *defines;      // lines "#define X 1\n" put first, default none; part of the program's identity
  bool compute;             // a compute program; default: vertex and fragment
  const GpuSource *sources; // default: gpu_sources
} GpuProgramDesc;

typedef struct GpuProgram {
  unsigned id;
  uint64_t identity; // hash of file and defines
} GpuProgram;

/// Make the program, or do nothing when it is already made from this file with these defines.
/// false: the message names file, line and the compiler's complaint; an older program stays in place.
bool gpu_program_prepare(GpuProgram *program, const GpuProgramDesc *desc, RenderError *error);
void gpu_program_destroy(GpuProgram *program);

// ---- Drawing ---------------------------------------------------------------------------------------------------------

typedef enum GpuDepth {
  GPU_DEPTH_OFF = 0,
  GPU_DEPTH_TEST, // nearer fragments pass
  GPU_DEPTH_WRITE, // nearer fragments pass and are kept
  GPU_DEPTH_WRITE_FARTHEST // farther fragments pass and are kept
} GpuDepth;

typedef enum GpuBlend {
  GPU_BLEND_OFF = 0,
  GPU_BLEND_OVER, // premultiplied: colour + (1 − alpha)·destination; the destination's alpha is kept
  GPU_BLEND_ADD,
  GPU_BLEND_MAX,    // the largest stays
  GPU_BLEND_ADD_MAX, // red, green, blue are added; of alpha the largest stays
  GPU_BLEND_OR       // bits are set, in targets of GPU_RGBA32UI
} GpuBlend;

typedef enum GpuCull { GPU_CULL_NONE = 0, GPU_CULL_BACK, GPU_CULL_FRONT } GpuCull;

#define GPU_MAX_TEXTURES 12
#define GPU_MAX_VIEWS 3
#define GPU_MAX_STORAGE 8 // as many as every OpenGL 4.5 has
/// A part of a buffer, bytes; of size 0: all of it. A storage block has a limit, which buffers of many elements exceed: they
/// are drawn in parts of gpu_block_elements.
typedef struct GpuPart {
  size_t offset, size;
} GpuPart;

/// The most elements of this size in one part, such that every part may begin where the one before it ends. At most 2²⁴,
/// so that floats and numbers of vertices count them exactly. 0: not even one fits; *error names the limit.
int32_t gpu_block_elements(const Gpu *gpu, size_t element, RenderError *error);
/// For tests: blocks hold no more than this, whatever the driver allows. 0: no such limit (the default).
void gpu_limit_blocks(size_t bytes);

/// Inputs of a draw or a dispatch. Entry i is bound to binding i of its kind; NULL entries are left unbound.
typedef struct GpuInputs {
  const GpuTexture *textures[GPU_MAX_TEXTURES]; // samplers
  const GpuBuffer *views[GPU_MAX_VIEWS];        // sampler buffers, bound behind the textures: from binding 12 on
  const GpuBuffer *storage[GPU_MAX_STORAGE];    // shader storage blocks
  GpuPart parts[GPU_MAX_STORAGE];               // of them
  const GpuBuffer *frame;                       // uniform block 0: the Frame block of frame.glsl
  const void *params;                           // uniform block 1 (std140), copied
  size_t params_size;
} GpuInputs;

/// Everything about one draw. Zero is the default throughout.
typedef struct GpuDraw {
  const GpuProgram *program;
  const GpuTarget *target;
  int32_t vertices; // of triangles; 0: one triangle that covers the target
  int32_t first_vertex;
  GpuDepth depth;
  GpuBlend blend;
  GpuCull cull;
  GpuInputs in;
} GpuDraw;
void gpu_draw(Gpu *gpu, const GpuDraw *draw);

/// One compute dispatch over `width`·`height` items in groups of 8·8. What it writes is visible to every later pass.
typedef struct GpuDispatch {
  const GpuProgram *program;
  const GpuTexture *output[GPU_MAX_COLOURS]; // image units, written
  int32_t width, height;
  GpuInputs in;
} GpuDispatch;
void gpu_dispatch(Gpu *gpu, const GpuDispatch *dispatch);

/// Copy a target's first colour to the window's framebuffer, stretched to its size.
void gpu_present(const GpuTarget *target, int32_t window_width, int32_t window_height);
/// Read a target's first colour as bytes, bottom row first.
void gpu_read_rgb8(const GpuTarget *target, uint8_t *rgb);

#endif
