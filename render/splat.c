// Ray-cast sphere impostors. Bounds of a sphere on the screen: Mara & McGuire, "2D Polyhedral Bounds of a Clipped,
// Perspective-Projected 3D Sphere", JCGT 2(2), 2013 (the tangents of its section 2).
#include "render/splat.h"

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

// All particles, in as many draws as the driver's storage blocks need.
static bool splat(RenderPicture *picture, const GpuProgram *program, float scale, const GpuTarget *out, GpuDraw draw,
                  RenderError *error) {
  const RenderParticles *particles = &picture->particles;
  const SplatParams params = {
      scale, water_per_chord(scale), {(float)out->width, (float)out->height}, particles->tinted, {0}};
  const size_t each = 4 * sizeof(float);
  const int32_t most = gpu_block_elements(picture->gpu, each, error);
  if (most == 0) return false;
  draw.program = program;
  draw.target = out;
  draw.in.storage[0] = &particles->spheres;
  draw.in.storage[1] = &particles->colours;
  draw.in.frame = &picture->uniforms;
  draw.in.params = &params;
  draw.in.params_size = sizeof params;
  for (int64_t first = 0; first < particles->count; first += most) {
    const int64_t left = particles->count - first;
    const int32_t count = left < most ? (int32_t)left : most;
    draw.vertices = 6 * count;
    draw.in.parts[0] = (GpuPart){each * (size_t)first, each * (size_t)count};
    if (particles->tinted) draw.in.parts[1] = draw.in.parts[0];
    gpu_draw(picture->gpu, &draw);
  }
  return true;
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

bool render_splat_sun(RenderPicture *picture, GpuProgram *program, float scale, const GpuTarget *out,
                      RenderError *error) {
  const GpuProgramDesc desc = {.label = "splat from the sun", .file = "splat.glsl", .defines = "#define SUN 1\n"};
  if (!gpu_program_prepare(program, &desc, error)) return false;
  const float nothing[4] = {0, 0, 0, -1e9f};
  gpu_clear_colour(out, 0, nothing);
  return splat(picture, program, scale, out, (GpuDraw){.blend = GPU_BLEND_ADD_MAX}, error);
}
