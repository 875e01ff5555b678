// Ray-cast sphere impostors. Bounds of a sphere on the screen: Mara & McGuire, "2D Polyhedral Bounds of a Clipped,
// Perspective-Projected 3D Sphere", JCGT 2(2), 2013 (the tangents of its section 2).
#include "render/splat.h"

#include <math.h>

// std140 block of splat.glsl
typedef struct SplatParams {
  float scale;   // radius drawn, in particle radii
  float volume;  // metres of water for a metre of chord
  float size[2]; // of the target, pixels
  float tinted;  // 1: every particle has a colour; 0: one for all
  float unused[3];
} SplatParams;

// A particle at rest stands for a cube of edge 2r; its sphere has 4/3 π (scale·r)³.
static float water_per_chord(float scale) {
  return 6 / (3.14159265f * scale * scale * scale);
}

// Spheres, in as many draws as the driver's storage blocks need. `draw` brings the second buffer, of their colours, if any.
static bool splat_spheres(RenderPicture *picture, const GpuBuffer *spheres, int32_t sphere_count,
                          const SplatParams *params, GpuDraw draw, RenderError *error) {
  const size_t each = 4 * sizeof(float);
  const int32_t most = gpu_block_elements(picture->gpu, each, error);
  if (most == 0) return false;
  draw.in.storage[0] = spheres;
  draw.in.frame = &picture->uniforms;
  draw.in.params = params;
  draw.in.params_size = sizeof *params;
  for (int64_t first = 0; first < sphere_count; first += most) {
    const int64_t left = sphere_count - first;
    const int32_t count = left < most ? (int32_t)left : most;
    draw.vertices = 6 * count;
    draw.in.parts[0] = (GpuPart){each * (size_t)first, each * (size_t)count};
    if (params->tinted > 0) draw.in.parts[1] = draw.in.parts[0];
    gpu_draw(picture->gpu, &draw);
  }
  return true;
}

static SplatParams params_of(float scale, float volume, const GpuTarget *out, bool tinted) {
  return (SplatParams){scale, volume, {(float)out->width, (float)out->height}, tinted, {0}};
}

// All particles.
static bool splat(RenderPicture *picture, const GpuProgram *program, float scale, const GpuTarget *out, GpuDraw draw,
                  RenderError *error) {
  const RenderParticles *particles = &picture->particles;
  const SplatParams params = params_of(scale, water_per_chord(scale), out, particles->tinted);
  draw.program = program;
  draw.target = out;
  draw.in.storage[1] = &particles->colours;
  return splat_spheres(picture, &particles->spheres, particles->count, &params, draw, error);
}

bool render_splat_surface(RenderPicture *picture, GpuProgram *program, float scale, const GpuTarget *out,
                          RenderError *error) {
  const GpuProgramDesc desc = {.label = "splat surface", .file = "splat.glsl", .defines = "#define SURFACE 1\n"};
  if (!gpu_program_prepare(program, &desc, error)) return false;
  const float nothing[4] = {0, 0, 0, 0};
  gpu_clear_colour(out, 0, nothing);
  gpu_clear_colour(out, 1, nothing);
  return splat(picture, program, scale, out, (GpuDraw){.depth = GPU_DEPTH_WRITE}, error);
}

bool render_splat_thickness(RenderPicture *picture, GpuProgram *program, float scale, const GpuTarget *out,
                            RenderError *error) {
  const GpuProgramDesc desc = {.label = "splat thickness", .file = "splat.glsl", .defines = "#define THICKNESS 1\n"};
  if (!gpu_program_prepare(program, &desc, error)) return false;
  const float nothing[4] = {0, 0, 0, 0};
  gpu_clear_colour(out, 0, nothing);
  const GpuDraw draw = {.blend = GPU_BLEND_ADD, .in.textures = {&picture->background.colour}};
  return splat(picture, program, scale, out, draw, error);
}

// A particle's cube of edge 2r as a Gaussian: with a standard deviation of r the sum over a lattice is even to 3 %. It is cut
// off where it has fallen to 4 %, and what that leaves out is made up for.
static bool splat_gaussians(RenderPicture *picture, const GpuProgram *program, const GpuBuffer *spheres, int32_t count,
                            bool tinted, GpuDraw draw, RenderError *error) {
  const float cut = 2.5f, pi = 3.14159265f;                           // standard deviations
  const float highest = 8 / (2 * pi * (1 - expf(-0.5f * cut * cut))); // metres of water at the middle, in radii
  const SplatParams params = params_of(cut, highest, draw.target, tinted);
  const float nothing[4] = {0, 0, 0, 0};
  gpu_clear_colour(draw.target, 0, nothing);
  draw.program = program;
  draw.blend = GPU_BLEND_ADD;
  draw.in.textures[0] = &picture->background.colour;
  return splat_spheres(picture, spheres, count, &params, draw, error);
}

bool render_splat_gaussians(RenderPicture *picture, GpuProgram *program, const GpuBuffer *spheres, int32_t count,
                            const GpuTarget *out, RenderError *error) {
  const GpuProgramDesc desc = {.label = "splat Gaussians", .file = "splat.glsl", .defines = "#define GAUSSIAN 1\n"};
  return gpu_program_prepare(program, &desc, error) &&
         splat_gaussians(picture, program, spheres, count, false, (GpuDraw){.target = out}, error);
}

bool render_splat_colours(RenderPicture *picture, GpuProgram *program, const GpuBuffer *spheres,
                          const GpuBuffer *colours, int32_t count, const GpuTexture *surface, const GpuTarget *out,
                          RenderError *error) {
  const GpuProgramDesc desc = {
      .label = "splat colours", .file = "splat.glsl", .defines = "#define GAUSSIAN 1\n#define TINTED 1\n"};
  const GpuDraw draw = {.target = out, .in = {.textures = {[1] = surface}, .storage = {[1] = colours}}};
  return gpu_program_prepare(program, &desc, error) &&
         splat_gaussians(picture, program, spheres, count, true, draw, error);
}

bool render_splat_sun(RenderPicture *picture, GpuProgram *program, float scale, const GpuTarget *out,
                      RenderError *error) {
  const GpuProgramDesc desc = {.label = "splat from the sun", .file = "splat.glsl", .defines = "#define SUN 1\n"};
  if (!gpu_program_prepare(program, &desc, error)) return false;
  const float nothing[4] = {0, 0, 0, -1e9f};
  gpu_clear_colour(out, 0, nothing);
  return splat(picture, program, scale, out, (GpuDraw){.blend = GPU_BLEND_ADD_MAX}, error);
}
