// Particles from the frame to the GPU, in the frame's order. Positions may come from a file that nobody checked: what is not
// finite, or absurdly far away, gets a radius of nothing here and is drawn by no later pass.
#include "render/picture.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

static const float water_colour[3] = {1, 1, 1}; // no tint of its own: the liquid's absorption colours it

static bool valid_position(const float p[3]) {
  // Comparisons are false for NaN.
  return fabsf(p[0]) < RENDER_FARTHEST && fabsf(p[1]) < RENDER_FARTHEST && fabsf(p[2]) < RENDER_FARTHEST;
}

// Spray: a particle that is both sparse (its density is far below the water's mean) and fast is drawn whitish, as the
// froth that it stands for.
static float spray_of(const SimFrame *frame, int32_t i, float mean_density, float fast) {
  const float *v = frame->velocity + 3 * (size_t)i;
  const float speed = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  const float sparse = render_clamp01((0.75f - frame->density[i] / mean_density) / 0.3f);
  return sparse * render_clamp01((speed - 0.4f * fast) / (0.6f * fast));
}

static float mean_density_of(const SimFrame *frame) {
  double sum = 0;
  for (int32_t i = 0; i < frame->count; ++i) {
    if (frame->density[i] > 0 && frame->density[i] < 1e9f) sum += frame->density[i];
  }
  return sum > 0 ? (float)(sum / frame->count) : 1000;
}

// The speed of a fall through half the height of the scene.
static float fast_of(const SimFrame *frame) {
  const float height = frame->has_container ? frame->container.max[1] - frame->container.min[1]
                                            : frame->bounds_max[1] - frame->bounds_min[1];
  return height > 1e-4f && height < 1e6f ? sqrtf(9.81f * height) : 1;
}

static void add_to_bounds(RenderParticles *particles, const float p[3], float radius) {
  for (int k = 0; k < 3; ++k) {
    particles->bounds_min[k] = fminf(particles->bounds_min[k], p[k] - radius);
    particles->bounds_max[k] = fmaxf(particles->bounds_max[k], p[k] + radius);
  }
}

// One particle; false: it is not to be drawn.
static bool stage_one(const SimFrame *frame, int32_t i, float sphere[4], float colour[4]) {
  const float *p = frame->position + 3 * (size_t)i;
  const float radius = frame->radius != NULL ? frame->radius[i] : frame->particle_radius;
  const bool taken = valid_position(p) && radius > 0 && radius < RENDER_FARTHEST;
  const float *tint = frame->colour != NULL ? frame->colour + 3 * (size_t)i : water_colour;
  for (int k = 0; k < 3; ++k) {
    sphere[k] = taken ? p[k] : RENDER_FARTHEST;
    colour[k] = render_clamp01(tint[k]);
  }
  sphere[3] = taken ? radius : 0;
  return taken;
}

// What goes to the GPU at a time: 1 MiB of spheres, and of colours.
#define BATCH 65536
typedef struct Batch {
  float sphere[BATCH][4], colour[BATCH][4];
} Batch;

// Particles in batches, as they lie in the frame. False: none is to be drawn.
static bool send(RenderParticles *particles, const SimFrame *frame, Batch *batch) {
  const float mean_density = particles->spray ? mean_density_of(frame) : 0, fast = fast_of(frame);
  const size_t each = 4 * sizeof(float);
  bool any = false;
  for (int32_t first = 0, count; first < frame->count; first += count) {
    count = frame->count - first < BATCH ? frame->count - first : BATCH;
    for (int32_t i = 0; i < count; ++i) {
      batch->colour[i][3] = particles->spray ? spray_of(frame, first + i, mean_density, fast) : 0;
      if (!stage_one(frame, first + i, batch->sphere[i], batch->colour[i])) continue;
      add_to_bounds(particles, batch->sphere[i], batch->sphere[i][3]);
      any = true;
    }
    gpu_buffer_fill(&particles->spheres, each * (size_t)first, batch->sphere, each * (size_t)count);
    if (particles->tinted || first == 0) {
      gpu_buffer_fill(&particles->colours, each * (size_t)first, batch->colour,
                      each * (size_t)(particles->tinted ? count : 1));
    }
  }
  return any;
}

bool render_particles_upload(RenderParticles *particles, const SimFrame *frame, bool spray, RenderError *error) {
  for (int k = 0; k < 3; ++k) {
    particles->bounds_min[k] = FLT_MAX;
    particles->bounds_max[k] = -FLT_MAX;
  }
  if (frame->count < 0 || (frame->count > 0 && frame->position == NULL)) {
    return gpu_fail(error, "the frame has no positions");
  }
  const size_t each = 4 * sizeof(float), count = (size_t)frame->count;
  particles->count = 0;
  particles->spray = spray && frame->density != NULL && frame->velocity != NULL;
  particles->tinted = frame->colour != NULL || particles->spray;
  Batch *batch = malloc(sizeof *batch);
  if (batch == NULL) return gpu_fail(error, "out of memory for particles");
  const bool room = gpu_buffer_reserve(&particles->spheres, "spheres", each * count, error) &&
                    gpu_buffer_reserve(&particles->colours, "colours", each * (particles->tinted ? count : 1), error);
  if (room && send(particles, frame, batch)) particles->count = frame->count;
  free(batch);
  return room;
}

void render_particles_destroy(RenderParticles *particles) {
  gpu_buffer_destroy(&particles->spheres);
  gpu_buffer_destroy(&particles->colours);
  *particles = (RenderParticles){0};
}
