// Particles from the frame to the GPU. Positions may come from a file that nobody checked: what is not finite, or
// absurdly far away, is left out here, and no later pass needs to think of it.
#include "render/picture.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

static const float water_colour[3] = {1, 1, 1}; // no tint of its own: the liquid's absorption colours it

static bool valid_position(const float p[3]) {
  // Comparisons are false for NaN.
  return fabsf(p[0]) < RENDER_FARTHEST && fabsf(p[1]) < RENDER_FARTHEST && fabsf(p[2]) < RENDER_FARTHEST;
}

static float clamp01(float x) {
  return x > 0 ? (x < 1 ? x : 1) : 0; // NaN becomes 0
}

// Spray: a particle that is both sparse (its density is far below the water's mean) and fast is drawn whitish, as the
// froth that it stands for.
static float spray_of(const SimFrame *frame, int32_t i, float mean_density, float fast) {
  if (frame->density == NULL || frame->velocity == NULL) return 0;
  const float *v = frame->velocity + 3 * (size_t)i;
  const float speed = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  const float sparse = clamp01((0.75f - frame->density[i] / mean_density) / 0.3f);
  return sparse * clamp01((speed - 0.4f * fast) / (0.6f * fast));
}

static float mean_density_of(const SimFrame *frame) {
  double sum = 0;
  for (int32_t i = 0; frame->density != NULL && i < frame->count; ++i) {
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

static bool reserve(RenderParticles *particles, int32_t count, RenderError *error) {
  if (count <= particles->capacity) return true;
  float *grown = realloc(particles->staging, 8 * sizeof(float) * (size_t)count);
  if (grown == NULL) return gpu_fail(error, "out of memory for %d particles", count);
  particles->staging = grown;
  particles->capacity = count;
  return true;
}

static void add_to_bounds(RenderParticles *particles, const float p[3], float radius) {
  for (int k = 0; k < 3; ++k) {
    particles->bounds_min[k] = fminf(particles->bounds_min[k], p[k] - radius);
    particles->bounds_max[k] = fmaxf(particles->bounds_max[k], p[k] + radius);
  }
}

// Fill the two halves of the staging memory: spheres first, colours after them. Returns the number of particles taken.
static int32_t stage(RenderParticles *particles, const SimFrame *frame) {
  const float mean_density = mean_density_of(frame), fast = fast_of(frame);
  float *sphere = particles->staging, *colour = particles->staging + 4 * (size_t)particles->capacity;
  int32_t taken = 0;
  for (int32_t i = 0; i < frame->count; ++i) {
    const float *p = frame->position + 3 * (size_t)i;
    const float radius = frame->radius != NULL ? frame->radius[i] : frame->particle_radius;
    if (!valid_position(p) || !(radius > 0 && radius < RENDER_FARTHEST)) continue;
    const float *tint = frame->colour != NULL ? frame->colour + 3 * (size_t)i : water_colour;
    for (int k = 0; k < 3; ++k) {
      sphere[k] = p[k];
      colour[k] = clamp01(tint[k]);
    }
    sphere[3] = radius;
    colour[3] = spray_of(frame, i, mean_density, fast);
    add_to_bounds(particles, p, radius);
    sphere += 4;
    colour += 4;
    ++taken;
  }
  return taken;
}

bool render_particles_upload(RenderParticles *particles, const SimFrame *frame, RenderError *error) {
  for (int k = 0; k < 3; ++k) {
    particles->bounds_min[k] = FLT_MAX;
    particles->bounds_max[k] = -FLT_MAX;
  }
  if (frame->count < 0 || (frame->count > 0 && frame->position == NULL)) {
    return gpu_fail(error, "the frame has no positions");
  }
  if (!reserve(particles, frame->count, error)) return false;
  particles->count = stage(particles, frame);
  const size_t bytes = 4 * sizeof(float) * (size_t)particles->count;
  const float *colours = particles->staging + 4 * (size_t)particles->capacity;
  return gpu_buffer_write(&particles->spheres, "spheres", particles->staging, bytes, error) &&
         gpu_buffer_write(&particles->colours, "colours", colours, bytes, error);
}

void render_particles_destroy(RenderParticles *particles) {
  gpu_buffer_destroy(&particles->spheres);
  gpu_buffer_destroy(&particles->colours);
  free(particles->staging);
  *particles = (RenderParticles){0};
}
