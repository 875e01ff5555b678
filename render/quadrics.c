#include "render/quadrics.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

// struct Ellipsoid of quadric.glsl, std430.
typedef struct Ellipsoid {
  float centre[3], reach; // m; reach: no less than the largest semi-axis
  float shape[6];         // T: xx, yy, zz, xy, xz, yz
  float unused[2];
  float colour[4]; // linear; –
} Ellipsoid;

// struct Ball of quadric.glsl, std430.
typedef struct Ball {
  float centre[3], radius; // m
  float colour[4];         // linear; –
} Ball;

// ---- One particle ----------------------------------------------------------------------------------------------------

static bool valid_centre(const float p[3]) {
  // Comparisons are false for NaN.
  return fabsf(p[0]) < RENDER_FARTHEST && fabsf(p[1]) < RENDER_FARTHEST && fabsf(p[2]) < RENDER_FARTHEST;
}

// At least the largest eigenvalue of T: the largest row sum.
static float reach_of(const float t[6]) {
  const float x = fabsf(t[0]) + fabsf(t[3]) + fabsf(t[4]), y = fabsf(t[1]) + fabsf(t[3]) + fabsf(t[5]),
              z = fabsf(t[2]) + fabsf(t[4]) + fabsf(t[5]);
  return fmaxf(x, fmaxf(y, z));
}

static float determinant(const float t[6]) {
  return t[0] * (t[1] * t[2] - t[5] * t[5]) - t[3] * (t[3] * t[2] - t[5] * t[4]) + t[4] * (t[3] * t[5] - t[1] * t[4]);
}

// false: it cannot be drawn. A matrix that is nearly flat would divide by nothing.
static bool take_ellipsoid(Ellipsoid *e, const float centre[3], const float shape[6], float scale) {
  const float reach = scale * reach_of(shape);
  if (!valid_centre(centre) || !(reach > 0 && reach < RENDER_FARTHEST)) return false;
  if (!(scale * scale * scale * determinant(shape) > 1e-6f * reach * reach * reach)) return false;
  for (int k = 0; k < 3; ++k) e->centre[k] = centre[k];
  for (int k = 0; k < 6; ++k) e->shape[k] = scale * shape[k];
  e->reach = reach;
  return true;
}

// out = adj(T) v: along T⁻¹ v
static void adjugate_times(const float t[6], const float v[3], float out[3]) {
  const float xx = t[1] * t[2] - t[5] * t[5], yy = t[0] * t[2] - t[4] * t[4], zz = t[0] * t[1] - t[3] * t[3];
  const float xy = t[4] * t[5] - t[3] * t[2], xz = t[3] * t[5] - t[4] * t[1], yz = t[3] * t[4] - t[0] * t[5];
  out[0] = xx * v[0] + xy * v[1] + xz * v[2];
  out[1] = xy * v[0] + yy * v[1] + yz * v[2];
  out[2] = xz * v[0] + yz * v[1] + zz * v[2];
}

// Smoothed centres sink into the water at its surface, and flat ellipsoids reach less far above them than balls. They are
// moved back, outwards along the ellipsoid's shortest axis, which T⁻² (x − x̄) is nearly along. A particle inside the water
// has hardly moved and stays.
static void lifted_centre(const SimFrame *frame, int32_t i, float lift, float centre[3]) {
  const float *p = frame->position + 3 * (size_t)i, *smoothed = frame->smoothed + 3 * (size_t)i;
  const float *t = frame->ellipsoid + 6 * (size_t)i, r = frame->particle_radius;
  float moved[3], half[3], out[3];
  for (int k = 0; k < 3; ++k) moved[k] = (p[k] - smoothed[k]) / r;
  adjugate_times(t, moved, half);
  const float size = fmaxf(fmaxf(fabsf(half[0]), fabsf(half[1])), fmaxf(fabsf(half[2]), 1e-30f));
  for (int k = 0; k < 3; ++k) half[k] /= size; // squares of squares of small lengths would vanish
  adjugate_times(t, half, out);
  const float length = sqrtf(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
  const float far = sqrtf(moved[0] * moved[0] + moved[1] * moved[1] + moved[2] * moved[2]);
  const float x = fminf(fmaxf((far - 0.1f) / 0.2f, 0), 1);
  const float by = length > 0 ? lift * r * x * x * (3 - 2 * x) / length : 0;
  for (int k = 0; k < 3; ++k) centre[k] = smoothed[k] + by * out[k];
}

// Water without a colour of its own is white: it colours nothing.
static void take_colour(float colour[4], const SimFrame *frame, int32_t i) {
  for (int k = 0; k < 3; ++k) {
    const float c = frame->colour != NULL ? frame->colour[3 * (size_t)i + (size_t)k] : 1;
    colour[k] = c > 0 ? fminf(c, 1) : 0; // NaN becomes 0
  }
  colour[3] = 0;
}

static bool take_ball(Ball *ball, const SimFrame *frame, int32_t i, float scale) {
  const float *centre = frame->position + 3 * (size_t)i;
  const float radius = scale * (frame->radius != NULL ? frame->radius[i] : frame->particle_radius);
  if (!valid_centre(centre) || !(radius > 0 && radius < RENDER_FARTHEST)) return false;
  for (int k = 0; k < 3; ++k) ball->centre[k] = centre[k];
  ball->radius = radius;
  take_colour(ball->colour, frame, i);
  return true;
}

// ---- At walls --------------------------------------------------------------------------------------------------------

// Water lies against the walls of its container, particles only near them. What is nearer than this, in radii, is drawn once
// more as its mirror image behind the wall, and so the surface goes on there until the pass that clips the smoothed depths
// cuts it off (water_clip.glsl).
#define AT_WALL 4.0f
#define MOST_IMAGES 8

// Mirror at the plane through `point` with the unit normal n.
static void mirror(Ellipsoid *e, const float point[3], const float n[3]) {
  const float *t = e->shape;
  const float away =
      2 * ((e->centre[0] - point[0]) * n[0] + (e->centre[1] - point[1]) * n[1] + (e->centre[2] - point[2]) * n[2]);
  // T' = H T H, where H = 1 - 2 n nᵀ: T - 2 (n uᵀ + u nᵀ) + 4 (n·u) n nᵀ with u = T n.
  const float u[3] = {t[0] * n[0] + t[3] * n[1] + t[4] * n[2], t[3] * n[0] + t[1] * n[1] + t[5] * n[2],
                      t[4] * n[0] + t[5] * n[1] + t[2] * n[2]};
  const float nu = u[0] * n[0] + u[1] * n[1] + u[2] * n[2];
  static const int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
  for (int k = 0; k < 3; ++k) e->centre[k] -= away * n[k];
  for (int k = 0; k < 6; ++k) {
    const int a = row[k], b = column[k];
    e->shape[k] += 4 * nu * n[a] * n[b] - 2 * (n[a] * u[b] + u[a] * n[b]);
  }
}

// Images of all `count` in a plane behind them.
static int add_images(Ellipsoid out[MOST_IMAGES], int count, const float point[3], const float n[3]) {
  for (int i = 0; i < count; ++i) {
    out[count + i] = out[i];
    mirror(&out[count + i], point, n);
  }
  return 2 * count;
}

// The nearest place on the round wall of a glass.
static int add_round_image(Ellipsoid out[MOST_IMAGES], int count, const SimContainer *container, float near) {
  const float x = (container->min[0] + container->max[0]) / 2, z = (container->min[2] + container->max[2]) / 2;
  const float radius = fminf(container->max[0] - container->min[0], container->max[2] - container->min[2]) / 2;
  const float dx = out[0].centre[0] - x, dz = out[0].centre[2] - z, from = hypotf(dx, dz);
  if (!(from > 0 && fabsf(radius - from) < near)) return count;
  const float n[3] = {dx / from, 0, dz / from}, point[3] = {x + radius * n[0], 0, z + radius * n[2]};
  return add_images(out, count, point, n);
}

// Images of the first one in the walls, edges and corners of the container that are near it; their number with it.
static int add_wall_images(Ellipsoid out[MOST_IMAGES], const SimContainer *container, float near) {
  const bool round = container->shape == SIM_CONTAINER_GLASS;
  int count = round ? add_round_image(out, 1, container, near) : 1;
  for (int k = 0; k < 3; ++k) {
    if (round && k != 1) continue;
    const float low = out[0].centre[k] - container->min[k];
    const float high = k != 1 ? container->max[k] - out[0].centre[k] : FLT_MAX; // the top is open
    if (!(fabsf(fminf(low, high)) < near)) continue;
    const float n[3] = {k == 0, k == 1, k == 2};
    count = add_images(out, count, low < high ? container->min : container->max, n);
  }
  return count;
}

// A ball as an ellipsoid, which can be mirrored.
static bool take_sphere(Ellipsoid *e, const SimFrame *frame, int32_t i, float scale) {
  const float r = frame->radius != NULL ? frame->radius[i] : frame->particle_radius;
  return take_ellipsoid(e, frame->position + 3 * (size_t)i, (const float[6]){r, r, r}, scale);
}

static bool take_aggregated(Ellipsoid *e, const SimFrame *frame, int32_t i, const RenderQuadricSettings *settings) {
  if (settings->spheres) return take_sphere(e, frame, i, settings->scale);
  const float own = frame->radius != NULL ? frame->radius[i] / frame->particle_radius : 1;
  float centre[3];
  lifted_centre(frame, i, settings->lift, centre);
  return take_ellipsoid(e, centre, frame->ellipsoid + 6 * (size_t)i, settings->scale * own);
}

// The ellipsoid and its images behind walls; their number, 0 when it cannot be drawn.
static int32_t take_with_images(Ellipsoid out[MOST_IMAGES], const SimFrame *frame,
                                const RenderQuadricSettings *settings, int32_t i) {
  if (!take_aggregated(&out[0], frame, i, settings)) return 0;
  take_colour(out[0].colour, frame, i);
  return frame->has_container ? add_wall_images(out, &frame->container, AT_WALL * frame->particle_radius) : 1;
}

// ---- All of them -----------------------------------------------------------------------------------------------------

static bool reserve(void **memory, int32_t *capacity, int32_t count, size_t size, RenderError *error) {
  if (count <= *capacity) return true;
  void *grown = realloc(*memory, 2 * (size_t)count * size);
  if (grown == NULL) return gpu_fail(error, "out of memory for %d particles", count);
  *memory = grown;
  *capacity = 2 * count;
  return true;
}

static bool add_particle(RenderQuadrics *quadrics, const SimFrame *frame, int32_t i,
                         const RenderQuadricSettings *settings, RenderError *error) {
  const bool as_ball = settings->splashes_apart && frame->particle_class[i] == SIM_SPLASH;
  if (as_ball) {
    if (!reserve(&quadrics->ball_staging, &quadrics->ball_capacity, quadrics->ball_count + 1, sizeof(Ball), error))
      return false;
    quadrics->ball_count +=
        take_ball((Ball *)quadrics->ball_staging + quadrics->ball_count, frame, i, settings->ball_scale);
    return true;
  }
  if (!reserve(&quadrics->ellipsoid_staging, &quadrics->ellipsoid_capacity, quadrics->ellipsoid_count + MOST_IMAGES,
               sizeof(Ellipsoid), error))
    return false;
  Ellipsoid *ellipsoid = (Ellipsoid *)quadrics->ellipsoid_staging + quadrics->ellipsoid_count;
  quadrics->ellipsoid_count += take_with_images(ellipsoid, frame, settings, i);
  return true;
}

bool render_quadrics_upload(RenderQuadrics *quadrics, const SimFrame *frame, const RenderQuadricSettings *settings,
                            RenderError *error) {
  quadrics->ellipsoid_count = quadrics->ball_count = 0;
  for (int32_t i = 0; i < frame->count; ++i) {
    if (settings->surface_only && !frame->near_surface[i]) continue;
    if (!add_particle(quadrics, frame, i, settings, error)) return false;
  }
  return gpu_buffer_write(&quadrics->ellipsoids, "ellipsoids", quadrics->ellipsoid_staging,
                          sizeof(Ellipsoid) * (size_t)quadrics->ellipsoid_count, error) &&
         gpu_buffer_write(&quadrics->balls, "balls", quadrics->ball_staging,
                          sizeof(Ball) * (size_t)quadrics->ball_count, error);
}

float render_quadrics_nearest(const RenderQuadrics *quadrics, const RenderPicture *picture) {
  const float *m = picture->block.world_to_view, *eye = picture->block.eye, *lens = picture->block.lens;
  const Ellipsoid *ellipsoids = quadrics->ellipsoid_staging;
  float nearest = RENDER_FARTHEST;
  for (int32_t i = 0; i < quadrics->ellipsoid_count; ++i) {
    const Ellipsoid *e = &ellipsoids[i];
    const float p[3] = {e->centre[0] - eye[0], e->centre[1] - eye[1], e->centre[2] - eye[2]};
    float v[3];
    for (int k = 0; k < 3; ++k) v[k] = m[k] * p[0] + m[4 + k] * p[1] + m[8 + k] * p[2];
    const float depth = -v[2], reach = e->reach;
    if (depth > reach && depth < nearest && fabsf(v[0]) < depth * lens[0] + reach &&
        fabsf(v[1]) < depth * lens[1] + reach) {
      nearest = depth;
    }
  }
  return nearest;
}

void render_quadrics_destroy(RenderQuadrics *quadrics) {
  gpu_buffer_destroy(&quadrics->ellipsoids);
  gpu_buffer_destroy(&quadrics->balls);
  free(quadrics->ellipsoid_staging);
  free(quadrics->ball_staging);
  *quadrics = (RenderQuadrics){0};
}

// ---- Drawing ---------------------------------------------------------------------------------------------------------

static const char *const kind_defines[] = {"", "#define SPHERES 1\n"};
static const char *const surface_defines[] = {"", "#define BACK 1\n", "#define DEPTHS 1\n", "#define COLOUR 1\n"};

void render_quadrics_clear(RenderQuadricSurface surface, const GpuTarget *out) {
  const float nothing[4] = {0, 0, 0, 0};
  gpu_clear_colour(out, 0, nothing);
  if (surface != RENDER_DEPTHS) gpu_clear_depth(out, surface == RENDER_BACK ? GPU_NEAREST : GPU_FARTHEST);
}

bool render_quadrics_draw(RenderPicture *picture, const RenderQuadrics *quadrics, const RenderQuadricPass *pass,
                          RenderError *error) {
  static const char *const labels[] = {"ellipsoids", "balls"};
  static const GpuDepth depths[] = {GPU_DEPTH_WRITE, GPU_DEPTH_WRITE_FARTHEST, GPU_DEPTH_OFF, GPU_DEPTH_WRITE};
  char defines[96];
  snprintf(defines, sizeof defines, "%s%s%s", kind_defines[pass->kind], surface_defines[pass->surface],
           pass->air != NULL ? "#define SUBMERGED 1\n" : "");
  const GpuProgramDesc desc = {.label = labels[pass->kind], .file = "quadric.glsl", .defines = defines};
  if (!gpu_program_prepare(pass->program, &desc, error)) return false;
  const bool balls = pass->kind == RENDER_BALLS;
  const int32_t count = balls ? quadrics->ball_count : quadrics->ellipsoid_count;
  const size_t each = balls ? sizeof(Ball) : sizeof(Ellipsoid);
  const int32_t most = gpu_block_elements(picture->gpu, each, error);
  if (most == 0) return false;
  for (int64_t first = 0; first < count; first += most) {
    const int64_t left = count - first;
    const int32_t drawn = left < most ? (int32_t)left : most;
    gpu_draw(picture->gpu, &(GpuDraw){
                               .program = pass->program,
                               .target = pass->out,
                               .vertices = 6 * drawn,
                               .depth = depths[pass->surface],
                               .blend = pass->surface == RENDER_DEPTHS ? GPU_BLEND_MAX : GPU_BLEND_OFF,
                               .in = {.storage = {balls ? &quadrics->balls : &quadrics->ellipsoids},
                                      .parts = {{each * (size_t)first, each * (size_t)drawn}},
                                      .textures = {pass->air},
                                      .frame = &picture->uniforms},
                           });
  }
  return true;
}
