// Frames: copies of the present state, or of particles from elsewhere, with the surface stages that are asked for.
#include "sim/frame.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "sim/memory.h"
#include "sim/parallel.h"
#include "sim/surface.h"
#include "sim/world.h"

struct SimFrameBuffer {
  SimFrame frame;
  int32_t threads;
  SimCellSort sort;    ///< of particle sets
  float *unsorted[3];  ///< m, positions of a particle set before sorting
  float *sorted[3];    ///< m, the frame's positions once more, as a structure of arrays
  int32_t *cell_start; ///< of a world's frame
  uint32_t *id;
  float *position, *velocity, *density, *colour, *radius;
  uint8_t *particle_class, *near_surface, *work;
  float *smoothed, *ellipsoid, *height, *normal;
  SimObstacle *obstacles;
};

SimFrameBuffer *sim_frame_buffer_create(void) {
  return sim_allocate(sizeof(SimFrameBuffer));
}

void sim_frame_buffer_destroy(SimFrameBuffer *buffer) {
  if (!buffer) return;
  sim_grid_free(&buffer->sort);
  for (int k = 0; k < 3; k++) {
    sim_release(buffer->unsorted[k]);
    sim_release(buffer->sorted[k]);
  }
  void *blocks[] = {buffer->cell_start,   buffer->id,     buffer->position, buffer->velocity,
                    buffer->density,      buffer->colour, buffer->radius,   buffer->particle_class,
                    buffer->near_surface, buffer->work,   buffer->smoothed, buffer->ellipsoid,
                    buffer->height,       buffer->normal, buffer->obstacles};
  for (size_t k = 0; k < sizeof blocks / sizeof *blocks; k++) sim_release(blocks[k]);
  sim_release(buffer);
}

static bool reserve_particles(SimFrameBuffer *buffer, int32_t count, unsigned needs) {
  size_t n = (size_t)count + 1; // never zero, so that an empty frame has arrays too
  bool ok = sim_reserve((void **)&buffer->id, n, sizeof(uint32_t)) &&
            sim_reserve((void **)&buffer->position, 3 * n, sizeof(float)) &&
            sim_reserve((void **)&buffer->velocity, 3 * n, sizeof(float)) &&
            sim_reserve((void **)&buffer->density, n, sizeof(float)) &&
            sim_reserve((void **)&buffer->colour, 3 * n, sizeof(float)) &&
            sim_reserve((void **)&buffer->radius, n, sizeof(float)) &&
            sim_reserve((void **)&buffer->particle_class, n, 1);
  for (int k = 0; ok && k < 3; k++)
    ok = sim_reserve((void **)&buffer->sorted[k], n, sizeof(float)) &&
         sim_reserve((void **)&buffer->unsorted[k], n, sizeof(float));
  if (ok && needs & SIM_NEED_SURFACE)
    ok = sim_reserve((void **)&buffer->near_surface, n, 1) && sim_reserve((void **)&buffer->work, n, 1);
  if (ok && needs & SIM_NEED_ANISOTROPY)
    ok = sim_reserve((void **)&buffer->smoothed, 3 * n, sizeof(float)) &&
         sim_reserve((void **)&buffer->ellipsoid, 6 * n, sizeof(float));
  return ok;
}

// ---- Surface stages --------------------------------------------------------------------------------------------------

static void bounds_of(SimFrame *frame) {
  for (int k = 0; k < 3; k++) {
    frame->bounds_min[k] = frame->container.min[k];
    frame->bounds_max[k] = frame->container.max[k];
  }
  for (int32_t i = 0; i < frame->count; i++)
    for (int k = 0; k < 3; k++) {
      float x = frame->position[3 * (int64_t)i + k];
      if (i == 0 || x < frame->bounds_min[k]) frame->bounds_min[k] = x;
      if (i == 0 || x > frame->bounds_max[k]) frame->bounds_max[k] = x;
    }
}

static void lap(SimProfile *profile, SimStage stage, double *since) {
  double now = sim_milliseconds();
  if (profile) profile->milliseconds[stage] += now - *since;
  *since = now;
}

static bool height_field(SimFrameBuffer *buffer, const SimSurface *surface, SimError *error) {
  SimFrame *frame = &buffer->frame;
  // The field covers the container, where there is one: its nodes stay in place from frame to frame.
  const float *low = frame->has_container ? frame->container.min : frame->bounds_min;
  const float *high = frame->has_container ? frame->container.max : frame->bounds_max;
  size_t nodes = (size_t)sim_surface_height_nodes(surface, low, high, &frame->height_field);
  if (!sim_reserve((void **)&buffer->height, nodes, sizeof(float)) ||
      !sim_reserve((void **)&buffer->normal, 3 * nodes, sizeof(float)))
    return sim_fail(error, "out of memory");
  sim_surface_heightfield(surface, low[1], &frame->height_field, buffer->height, buffer->normal);
  frame->height_field.height = buffer->height;
  frame->height_field.normal = buffer->normal;
  return true;
}

// The stages that are needed, in an order in which each finds what it reads.
static bool run_surface_stages(SimFrameBuffer *buffer, unsigned needs, bool has_class, SimProfile *profile,
                               SimError *error) {
  SimFrame *frame = &buffer->frame;
  SimSurface surface = {.count = frame->count,
                        .threads = buffer->threads,
                        .spacing = 2 * frame->particle_radius,
                        .position = buffer->sorted,
                        .grid = &frame->grid};
  memcpy(surface.bounds_min, frame->bounds_min, sizeof surface.bounds_min);
  memcpy(surface.bounds_max, frame->bounds_max, sizeof surface.bounds_max);
  double since = sim_milliseconds();
  frame->particle_class = frame->near_surface = NULL;
  frame->smoothed = frame->ellipsoid = NULL;
  frame->height_field = (SimHeightField){{0, 0}, {0, 0}, 0, NULL, NULL};
  if (needs & (SIM_NEED_CLASS | SIM_NEED_ANISOTROPY)) {
    if (!has_class) sim_surface_classify(&surface, buffer->particle_class);
    frame->particle_class = buffer->particle_class;
    lap(profile, SIM_STAGE_classify, &since);
  }
  if (needs & SIM_NEED_ANISOTROPY) {
    sim_surface_anisotropy(&surface, buffer->particle_class, buffer->smoothed, buffer->ellipsoid);
    frame->smoothed = buffer->smoothed;
    frame->ellipsoid = buffer->ellipsoid;
    lap(profile, SIM_STAGE_anisotropy, &since);
  }
  if (needs & SIM_NEED_SURFACE) {
    sim_surface_flags(&surface, buffer->work, buffer->near_surface);
    frame->near_surface = buffer->near_surface;
    lap(profile, SIM_STAGE_flags, &since);
  }
  if (needs & SIM_NEED_HEIGHT_FIELD) {
    if (!height_field(buffer, &surface, error)) return false;
    lap(profile, SIM_STAGE_height_field, &since);
  }
  return true;
}

// ---- From a world ----------------------------------------------------------------------------------------------------

typedef struct CopyContext {
  const SimWorld *world;
  SimFrameBuffer *buffer;
} CopyContext;

static void copy_kernel(int32_t begin, int32_t end, const void *context) {
  const CopyContext *c = context;
  const SimSorted *now = &c->world->particles.now;
  SimFrameBuffer *buffer = c->buffer;
  for (int32_t i = begin; i < end; i++) {
    buffer->id[i] = now->id[i];
    buffer->density[i] = c->world->particles.density[i] * c->world->def.rest_density;
    for (int k = 0; k < 3; k++) {
      buffer->sorted[k][i] = buffer->position[3 * (int64_t)i + k] = now->position[k][i];
      buffer->velocity[3 * (int64_t)i + k] = now->velocity[k][i];
    }
    for (int k = 0; c->world->particles.coloured && k < 3; k++) buffer->colour[3 * (int64_t)i + k] = now->colour[k][i];
  }
}

static bool copy_grid(SimFrameBuffer *buffer, const SimGrid *grid, SimError *error) {
  size_t cells = (size_t)grid->size[0] * (size_t)grid->size[1] * (size_t)grid->size[2];
  if (!sim_reserve((void **)&buffer->cell_start, cells + 1, sizeof(int32_t))) return sim_fail(error, "out of memory");
  memcpy(buffer->cell_start, grid->cell_start, (cells + 1) * sizeof(int32_t));
  buffer->frame.grid = *grid;
  buffer->frame.grid.cell_start = buffer->cell_start;
  return true;
}

static bool copy_obstacles(SimFrameBuffer *buffer, const SimWorld *world, SimError *error) {
  size_t count = (size_t)world->def.obstacle_count;
  buffer->frame.obstacle_count = world->def.obstacle_count;
  buffer->frame.obstacles = NULL;
  if (count == 0) return true;
  if (!sim_reserve((void **)&buffer->obstacles, count, sizeof(SimObstacle))) return sim_fail(error, "out of memory");
  memcpy(buffer->obstacles, world->obstacles, count * sizeof(SimObstacle));
  buffer->frame.obstacles = buffer->obstacles;
  return true;
}

const SimFrame *sim_world_frame(SimWorld *world, unsigned needs, SimFrameBuffer *buffer, SimError *error) {
  if (!sim_world_settle(world, error)) return NULL;
  double since = sim_milliseconds();
  int32_t count = world->particles.count;
  if (!reserve_particles(buffer, count, needs)) return sim_fail(error, "out of memory"), NULL;
  SimFrame *frame = &buffer->frame;
  buffer->threads = world->threads;
  frame->index = world->advances;
  frame->time = world->time;
  frame->count = count;
  frame->particle_radius = world->def.particle_radius;
  frame->container = world->def.container;
  frame->has_container = true;
  sim_parallel_for(world->threads, count, copy_kernel, &(CopyContext){world, buffer});
  frame->id = buffer->id;
  frame->position = buffer->position;
  frame->velocity = buffer->velocity;
  frame->density = buffer->density;
  frame->colour = world->particles.coloured ? buffer->colour : NULL;
  frame->radius = NULL;
  bounds_of(frame);
  if (!copy_grid(buffer, &world->sort.grid, error) || !copy_obstacles(buffer, world, error)) return NULL;
  lap(&world->profile, SIM_STAGE_frame, &since);
  return run_surface_stages(buffer, needs, false, &world->profile, error) ? frame : NULL;
}

// ---- From particles that come from elsewhere --------------------------------------------------------------------------

static bool check_set(const SimParticleSet *set, SimError *error) {
  if (set->count < 0 || set->count > SIM_MAX_PARTICLES)
    return sim_fail(error, "particle count must be in [0, %d], got %d", SIM_MAX_PARTICLES, set->count);
  if (set->count > 0 && !set->position) return sim_fail(error, "the particles have no positions");
  for (int64_t i = 0; i < set->count; i++)
    for (int k = 0; k < 3; k++)
      if (!(fabsf(set->position[3 * i + k]) <= 1e15f))
        return sim_fail(error, "particle %lld: position must be finite, got %g", (long long)i,
                        (double)set->position[3 * i + k]);
  if (!(set->particle_radius >= 0 && set->particle_radius <= 1e12f))
    return sim_fail(error, "particle_radius must be finite and not negative, got %g", (double)set->particle_radius);
  return true;
}

typedef struct SetContext {
  const SimParticleSet *set;
  SimFrameBuffer *buffer;
} SetContext;

static void split_kernel(int32_t begin, int32_t end, const void *context) {
  const SetContext *c = context;
  for (int64_t i = begin; i < end; i++)
    for (int k = 0; k < 3; k++) c->buffer->unsorted[k][i] = c->set->position[3 * i + k];
}

static void gather_kernel(int32_t begin, int32_t end, const void *context) {
  const SetContext *c = context;
  const SimParticleSet *set = c->set;
  SimFrameBuffer *buffer = c->buffer;
  const float zero[3] = {0, 0, 0};
  for (int64_t i = begin; i < end; i++) {
    int64_t from = buffer->sort.order[i];
    buffer->id[i] = set->id ? set->id[from] : (uint32_t)from;
    memcpy(buffer->position + 3 * i, set->position + 3 * from, sizeof zero);
    memcpy(buffer->velocity + 3 * i, set->velocity ? set->velocity + 3 * from : zero, sizeof zero);
    if (set->colour) memcpy(buffer->colour + 3 * i, set->colour + 3 * from, sizeof zero);
    if (set->radius) buffer->radius[i] = set->radius[from];
    if (set->particle_class) buffer->particle_class[i] = set->particle_class[from] ? SIM_AGGREGATED : SIM_SPLASH;
    for (int k = 0; k < 3; k++) buffer->sorted[k][i] = set->position[3 * from + k];
  }
}

static bool sort_set(const SimParticleSet *set, float cell, SimFrameBuffer *buffer, SimError *error) {
  SetContext context = {set, buffer};
  sim_parallel_for(buffer->threads, set->count, split_kernel, &context);
  if (!sim_grid_sort(&buffer->sort, buffer->unsorted, set->count, cell, buffer->threads))
    return sim_fail(error, "out of memory");
  if (sim_grid_candidates(&buffer->sort.grid, 2 * cell) > 1e13)
    return sim_fail(error, "the particles are crowded into one place: more than their radius %g m allows",
                    (double)(cell / SIM_SURFACE_CELL / 2));
  sim_parallel_for(buffer->threads, set->count, gather_kernel, &context);
  return true;
}

static void scale_kernel(int32_t begin, int32_t end, const void *context) {
  float *density = ((const SetContext *)context)->buffer->density;
  for (int32_t i = begin; i < end; i++) density[i] *= 1000;
}

const SimFrame *sim_frame_from_particles(const SimParticleSet *set, unsigned needs, int32_t threads,
                                         SimFrameBuffer *buffer, SimError *error) {
  if (!check_set(set, error)) return NULL;
  if (!reserve_particles(buffer, set->count, needs)) return sim_fail(error, "out of memory"), NULL;
  SimFrame *frame = &buffer->frame;
  buffer->threads = sim_parallel_threads(threads);
  *frame = (SimFrame){.index = set->index, .time = set->time, .count = set->count};
  frame->particle_radius =
      set->particle_radius > 0 ? set->particle_radius : sim_estimate_radius(set->position, set->count);
  if (!sort_set(set, SIM_SURFACE_CELL * 2 * frame->particle_radius, buffer, error)) return NULL;
  frame->id = buffer->id;
  frame->position = buffer->position;
  frame->velocity = buffer->velocity;
  frame->density = buffer->density;
  frame->colour = set->colour ? buffer->colour : NULL;
  frame->radius = set->radius ? buffer->radius : NULL;
  frame->grid = buffer->sort.grid;
  frame->has_container = set->container != NULL;
  if (set->container) frame->container = *set->container;
  bounds_of(frame);
  if (!set->container) {
    memcpy(frame->container.min, frame->bounds_min, sizeof frame->bounds_min);
    memcpy(frame->container.max, frame->bounds_max, sizeof frame->bounds_max);
  }
  SimSurface surface = {set->count, buffer->threads, 2 * frame->particle_radius, buffer->sorted, &frame->grid, {0},
                        {0}};
  sim_surface_density(&surface, buffer->density);
  sim_parallel_for(buffer->threads, set->count, scale_kernel, &(SetContext){set, buffer});
  return run_surface_stages(buffer, needs, set->particle_class != NULL, NULL, error) ? frame : NULL;
}
