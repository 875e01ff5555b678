// Frames: copies of the present state, or of particles from elsewhere, with the surface stages that are asked for.
#include "sim/frame.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "sim/memory.h"
#include "sim/parallel.h"
#include "sim/ripple.h"
#include "sim/surface.h"
#include "sim/world.h"

struct SimFrameBuffer {
  SimFrame frame;
  int32_t threads;
  // Of particles whose order or neighbours are not those of a world: see surface_of.
  SimCellSort sort;
  SimNeighbours lists;
  float *axis[3], *four; ///< m, the frame's positions as axes and side by side (particles.h)
  int32_t *cell_start;   ///< of a world's frame
  uint32_t *id;
  float *position, *velocity, *density, *colour, *radius;
  uint8_t *particle_class, *near_surface, *exposed;
  float *smoothed, *ellipsoid, *height, *normal, *underside, *second;
  uint8_t *node_state; ///< of the height field, to fill it with
  int32_t *node_queue;
  SimObstacle *obstacles;
};

SimFrameBuffer *sim_frame_buffer_create(void) {
  return sim_allocate(sizeof(SimFrameBuffer));
}

void sim_frame_buffer_destroy(SimFrameBuffer *buffer) {
  if (!buffer) return;
  sim_grid_free(&buffer->sort);
  sim_neighbours_free(&buffer->lists);
  void *blocks[] = {buffer->axis[0],      buffer->axis[1],   buffer->axis[2],   buffer->four,
                    buffer->cell_start,   buffer->id,        buffer->position,  buffer->velocity,
                    buffer->density,      buffer->colour,    buffer->radius,    buffer->particle_class,
                    buffer->near_surface, buffer->exposed,   buffer->smoothed,  buffer->ellipsoid,
                    buffer->height,       buffer->normal,    buffer->obstacles, buffer->node_state,
                    buffer->node_queue,   buffer->underside, buffer->second};
  for (size_t k = 0; k < sizeof blocks / sizeof *blocks; k++) sim_release(blocks[k]);
  sim_release(buffer);
}

// Whole chunks and one more, for the kernels in wide floats; so an empty frame has arrays too.
static size_t padded(int32_t count) {
  return ((size_t)count + 2 * SIM_CHUNK - 1) / SIM_CHUNK * SIM_CHUNK;
}

static bool reserve_floats(float **array, size_t count) {
  return sim_reserve((void **)array, count, sizeof(float));
}

// Arrays that a frame has only if its particles do.
typedef struct Arrays {
  bool id, velocity, density, colour, radius;
} Arrays;

static bool reserve_particles(SimFrameBuffer *buffer, int32_t count, Arrays has) {
  size_t n = padded(count);
  return reserve_floats(&buffer->position, 3 * n) &&
         (!has.id || sim_reserve((void **)&buffer->id, n, sizeof(uint32_t))) &&
         (!has.velocity || reserve_floats(&buffer->velocity, 3 * n)) &&
         (!has.density || reserve_floats(&buffer->density, n)) &&
         (!has.colour || reserve_floats(&buffer->colour, 3 * n)) && (!has.radius || reserve_floats(&buffer->radius, n));
}

static bool reserve_order(SimFrameBuffer *buffer, int32_t count) {
  size_t n = padded(count);
  bool ok = reserve_floats(&buffer->four, 4 * n);
  for (int k = 0; ok && k < 3; k++) ok = reserve_floats(&buffer->axis[k], n);
  return ok;
}

static bool reserve_surface(SimFrameBuffer *buffer, int32_t count, unsigned needs, bool has_class) {
  size_t n = padded(count);
  if ((has_class || needs & (SIM_NEED_CLASS | SIM_NEED_ANISOTROPY)) &&
      !sim_reserve((void **)&buffer->particle_class, n, 1))
    return false;
  if (needs & SIM_NEED_SURFACE &&
      (!sim_reserve((void **)&buffer->near_surface, n, 1) || !sim_reserve((void **)&buffer->exposed, n, 1)))
    return false;
  return !(needs & SIM_NEED_ANISOTROPY) ||
         (reserve_floats(&buffer->smoothed, 3 * n) && reserve_floats(&buffer->ellipsoid, 6 * n));
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

static bool height_field(SimFrameBuffer *buffer, const SimSurface *surface, bool layers, SimError *error) {
  SimHeightField *field = &buffer->frame.height_field;
  size_t nodes = (size_t)sim_surface_height_nodes(surface, field);
  if (!reserve_floats(&buffer->height, nodes) || !reserve_floats(&buffer->normal, 3 * nodes) ||
      (layers && (!reserve_floats(&buffer->underside, nodes) || !reserve_floats(&buffer->second, nodes))) ||
      (surface->body_count > 0 && (!sim_reserve((void **)&buffer->node_state, nodes, 1) ||
                                   !sim_reserve((void **)&buffer->node_queue, nodes, sizeof(int32_t)))))
    return sim_fail(error, "out of memory");
  float floor = buffer->frame.container.min[1];
  SimHeightArrays arrays = {.height = buffer->height,
                            .normal = buffer->normal,
                            .underside = layers ? buffer->underside : NULL,
                            .second = layers ? buffer->second : NULL,
                            .state = buffer->node_state,
                            .queue = buffer->node_queue};
  if (surface->ripple) { // waves that never hang over
    sim_ripple_heights(surface->ripple, surface->container, field, floor, surface->threads, buffer->height,
                       buffer->normal);
    for (size_t node = 0; layers && node < nodes; node++) buffer->underside[node] = buffer->second[node] = floor;
  } else {
    sim_surface_heightfield(surface, floor, field, &arrays);
  }
  field->height = buffer->height;
  field->normal = buffer->normal;
  field->underside = arrays.underside;
  field->second = arrays.second;
  return true;
}

// The stages that are needed, in an order in which each finds what it reads. The first three share one sweep over the
// neighbours, whose time is that of the classification. `density`, if any, gets the particles' share of the rest density.
static bool run_surface_stages(SimFrameBuffer *buffer, const SimSurface *surface, unsigned needs, bool has_class,
                               float *density, SimProfile *profile, SimError *error) {
  SimFrame *frame = &buffer->frame;
  double since = sim_milliseconds();
  bool anisotropy = needs & SIM_NEED_ANISOTROPY, flags = needs & SIM_NEED_SURFACE;
  bool classes = anisotropy || needs & SIM_NEED_CLASS;
  frame->particle_class = classes ? buffer->particle_class : NULL;
  frame->smoothed = anisotropy ? buffer->smoothed : NULL;
  frame->ellipsoid = anisotropy ? buffer->ellipsoid : NULL;
  frame->near_surface = flags ? buffer->near_surface : NULL;
  frame->height_field = (SimHeightField){.spacing = 0};
  if (density || anisotropy || flags || (classes && !has_class)) {
    sim_surface_sweep(surface, &(SimSurfaceSums){.density = density,
                                                 .particle_class = classes ? buffer->particle_class : NULL,
                                                 .class_given = has_class,
                                                 .smoothed = anisotropy ? buffer->smoothed : NULL,
                                                 .covariance = anisotropy ? buffer->ellipsoid : NULL,
                                                 .exposed = flags ? buffer->exposed : NULL});
    lap(profile, SIM_STAGE_classify, &since);
  }
  if (anisotropy) {
    sim_surface_ellipsoids(surface->wide, surface->count, frame->particle_radius, buffer->ellipsoid, surface->threads);
    lap(profile, SIM_STAGE_anisotropy, &since);
  }
  if (flags) {
    sim_surface_flags(surface, buffer->exposed, buffer->near_surface);
    lap(profile, SIM_STAGE_flags, &since);
  }
  if (needs & (SIM_NEED_HEIGHT_FIELD | SIM_NEED_SECOND_LAYER)) {
    if (!height_field(buffer, surface, needs & SIM_NEED_SECOND_LAYER, error)) return false;
    lap(profile, SIM_STAGE_height_field, &since);
  }
  return true;
}

static SimSurface surface_of(const SimFrameBuffer *buffer, const SimWide *wide, float *const position[3],
                             const float *four, const SimNeighbours *lists) {
  const SimFrame *frame = &buffer->frame;
  SimSurface surface = {.wide = wide,
                        .count = frame->count,
                        .threads = buffer->threads,
                        .spacing = 2 * frame->particle_radius,
                        .node_spacing = 2 * frame->particle_radius,
                        .position = {position[0], position[1], position[2]},
                        .four = four,
                        .grid = &frame->grid,
                        .lists = lists,
                        .container = frame->has_container ? &frame->container : NULL};
  memcpy(surface.bounds_min, frame->bounds_min, sizeof surface.bounds_min);
  memcpy(surface.bounds_max, frame->bounds_max, sizeof surface.bounds_max);
  return surface;
}

static bool fail_crowded(const SimFrame *frame, SimError *error) {
  return sim_fail(error, "the particles are crowded into one place: more than their radius %g m allows",
                  (double)frame->particle_radius);
}

static bool build_lists(SimFrameBuffer *buffer, const SimWide *wide, float *const position[3], SimError *error) {
  const SimFrame *frame = &buffer->frame;
  float spacing = 2 * frame->particle_radius;
  SimNeighbourResult result = sim_neighbours_build(&buffer->lists, wide, &frame->grid, position, frame->count,
                                                   SIM_SURFACE_REACH * spacing, buffer->threads);
  if (result == SIM_NEIGHBOURS_NO_MEMORY) return sim_fail(error, "out of memory");
  if (result == SIM_NEIGHBOURS_CROWDED)
    return sim_fail(
        error,
        "%d particles have more neighbours than can be listed: they are too many, or crowded into one place, "
        "more than their radius %g m allows",
        frame->count, (double)frame->particle_radius);
  return true;
}

// ---- From a world ----------------------------------------------------------------------------------------------------

typedef struct CopyContext {
  const SimWorld *world;
  const uint32_t *order; ///< of the frame's particles; NULL: that of the world
  SimFrameBuffer *buffer;
} CopyContext;

static void copy_kernel(int32_t begin, int32_t end, const void *context) {
  const CopyContext *c = context;
  const SimSorted *now = &c->world->particles.now;
  SimFrameBuffer *buffer = c->buffer;
  for (int64_t i = begin; i < end; i++) {
    size_t from = c->order ? c->order[i] : (size_t)i;
    buffer->id[i] = now->id[from];
    buffer->density[i] = c->world->particles.density[from] * c->world->def.rest_density;
    for (int k = 0; k < 3; k++) {
      buffer->position[3 * i + k] = now->position[k][from];
      buffer->velocity[3 * i + k] = now->velocity[k][from];
    }
    for (int k = 0; c->world->particles.coloured && k < 3; k++) buffer->colour[3 * i + k] = now->colour[k][from];
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

// The frame's positions once more, in the form that the kernels in wide floats read.
static void split_kernel(int32_t begin, int32_t end, const void *context) {
  const SimFrameBuffer *buffer = context;
  for (int64_t i = begin; i < end; i++) {
    buffer->four[4 * i + 3] = 0;
    for (int k = 0; k < 3; k++) buffer->four[4 * i + k] = buffer->axis[k][i] = buffer->position[3 * i + k];
  }
}

static void split_positions(SimFrameBuffer *buffer) {
  int32_t count = buffer->frame.count;
  sim_parallel_for(buffer->threads, count, split_kernel, buffer);
  sim_particles_pad(&(SimParticles){.count = count}, buffer->four);
}

// What the surface stages read of a world. Where its support is their reach, they share its lists; where it is longer,
// only its order; where it is shorter, its cells are too small for them, and the frame has an order of its own.
static bool world_surface(const SimWorld *world, unsigned needs, SimFrameBuffer *buffer, SimSurface *surface,
                          SimError *error) {
  const SimParticles *p = &world->particles;
  float reach = SIM_SURFACE_REACH * world->cubic.spacing;
  bool lists = needs & (SIM_NEED_CLASS | SIM_NEED_ANISOTROPY | SIM_NEED_SURFACE);
  if (world->cubic.h < reach) {
    if (!reserve_order(buffer, p->count)) return sim_fail(error, "out of memory");
    split_positions(buffer);
    *surface = surface_of(buffer, world->wide, buffer->axis, buffer->four, &buffer->lists);
    return !lists || build_lists(buffer, world->wide, buffer->axis, error);
  }
  bool shared = world->cubic.h == reach;
  *surface = surface_of(buffer, world->wide, p->now.position, p->first, shared ? &world->neighbours : &buffer->lists);
  return shared || !lists || build_lists(buffer, world->wide, p->now.position, error);
}

// The order of the frame's particles and its grid.
static bool order_world(const SimWorld *world, SimFrameBuffer *buffer, const uint32_t **order, SimError *error) {
  float reach = SIM_SURFACE_REACH * world->cubic.spacing;
  *order = NULL;
  if (world->cubic.h >= reach) return copy_grid(buffer, &world->sort.grid, error);
  SimPositions places = sim_positions(world->particles.now.position);
  if (!sim_grid_sort(&buffer->sort, places, world->particles.count, sim_cells(reach), world->threads))
    return sim_fail(error, "out of memory");
  *order = buffer->sort.order;
  buffer->frame.grid = buffer->sort.grid;
  return true;
}

const SimFrame *sim_world_frame(SimWorld *world, unsigned needs, SimFrameBuffer *buffer, SimError *error) {
  if (!sim_world_settle(world, error)) return NULL;
  double since = sim_milliseconds();
  int32_t count = world->particles.count;
  Arrays has = {.id = true, .velocity = true, .density = true, .colour = world->particles.coloured};
  if (!reserve_particles(buffer, count, has) || !reserve_surface(buffer, count, needs, false))
    return sim_fail(error, "out of memory"), NULL;
  SimFrame *frame = &buffer->frame;
  buffer->threads = world->threads;
  frame->index = world->advances;
  frame->time = world->time;
  frame->count = count;
  frame->particle_radius = world->def.particle_radius;
  frame->container = world->def.container;
  frame->has_container = true;
  const uint32_t *order;
  if (!order_world(world, buffer, &order, error) || !copy_obstacles(buffer, world, error)) return NULL;
  sim_parallel_for(world->threads, count, copy_kernel, &(CopyContext){world, order, buffer});
  frame->id = buffer->id;
  frame->position = buffer->position;
  frame->velocity = buffer->velocity;
  frame->density = buffer->density;
  frame->colour = world->particles.coloured ? buffer->colour : NULL;
  frame->radius = NULL;
  bounds_of(frame);
  SimSurface surface;
  if (!world_surface(world, needs, buffer, &surface, error)) return NULL;
  SimRipple ripple;
  if (world->def.ripple) {
    sim_ripple_at(&world->def, world->time, &ripple);
    surface.ripple = &ripple;
    surface.node_spacing = sim_ripple_spacing(&world->def);
  } else {
    surface.bodies = world->bodies;
    surface.body_count = world->def.obstacle_count;
  }
  lap(&world->profile, SIM_STAGE_frame, &since);
  return run_surface_stages(buffer, &surface, needs, false, NULL, &world->profile, error) ? frame : NULL;
}

// ---- From particles that come from elsewhere --------------------------------------------------------------------------

// Whether a stage reads neighbour lists, and whether one reads positions as axes and side by side.
static bool needs_lists(unsigned needs, bool has_class) {
  return needs & (SIM_NEED_ANISOTROPY | SIM_NEED_SURFACE) || (needs & SIM_NEED_CLASS && !has_class);
}

static bool needs_order(unsigned needs, bool has_class) {
  return needs_lists(needs, has_class) || needs & (SIM_NEED_HEIGHT_FIELD | SIM_NEED_SECOND_LAYER);
}

static bool check_set(const SimParticleSet *set, SimError *error) {
  if (set->count < 0 || set->count > SIM_MAX_SET_PARTICLES)
    return sim_fail(error, "particle count must be in [0, %d], got %d", SIM_MAX_SET_PARTICLES, set->count);
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

static void gather_kernel(int32_t begin, int32_t end, const void *context) {
  const SetContext *c = context;
  const SimParticleSet *set = c->set;
  SimFrameBuffer *buffer = c->buffer;
  const size_t vector = 3 * sizeof(float);
  for (int64_t i = begin; i < end; i++) {
    int64_t from = buffer->sort.order[i];
    memcpy(buffer->position + 3 * i, set->position + 3 * from, vector);
    if (set->id) buffer->id[i] = set->id[from];
    if (set->velocity) memcpy(buffer->velocity + 3 * i, set->velocity + 3 * from, vector);
    if (set->colour) memcpy(buffer->colour + 3 * i, set->colour + 3 * from, vector);
    if (set->radius) buffer->radius[i] = set->radius[from];
    if (set->particle_class) buffer->particle_class[i] = set->particle_class[from] ? SIM_AGGREGATED : SIM_SPLASH;
  }
}

// The set's particles in the order of their cells. Sorted where they are: no array of theirs is copied but for the frame.
static bool sort_set(const SimParticleSet *set, SimFrameBuffer *buffer, SimError *error) {
  SimFrame *frame = &buffer->frame;
  SimPositions places = {{0}, 3};
  for (int k = 0; k < 3 && set->position; k++) places.axis[k] = set->position + k;
  const SimCells cells = {.size = SIM_SURFACE_REACH * 2 * frame->particle_radius, .each = 0.5f};
  if (!sim_grid_sort(&buffer->sort, places, set->count, cells, buffer->threads))
    return sim_fail(error, "out of memory");
  frame->grid = buffer->sort.grid;
  sim_parallel_for(buffer->threads, set->count, gather_kernel, &(SetContext){set, buffer});
  frame->id = set->id ? buffer->id : buffer->sort.order;
  frame->position = buffer->position;
  frame->velocity = set->velocity ? buffer->velocity : NULL;
  frame->colour = set->colour ? buffer->colour : NULL;
  frame->radius = set->radius ? buffer->radius : NULL;
  return true;
}

static void bounds_of_set(const SimParticleSet *set, SimFrame *frame) {
  frame->has_container = set->container != NULL;
  if (set->container) frame->container = *set->container;
  bounds_of(frame);
  if (set->container) return;
  memcpy(frame->container.min, frame->bounds_min, sizeof frame->bounds_min);
  memcpy(frame->container.max, frame->bounds_max, sizeof frame->bounds_max);
}

static void scale_kernel(int32_t begin, int32_t end, const void *context) {
  const SimFrameBuffer *buffer = context;
  for (int32_t i = begin; i < end; i++) buffer->density[i] *= 1000;
}

// Density and surface stages of a sorted set. Those that read neighbour lists share them; a density alone does without. A
// heap is refused whatever is needed, because who gets the frame may search around particles, too.
static bool measure_set(SimFrameBuffer *buffer, unsigned needs, bool has_class, SimError *error) {
  SimFrame *frame = &buffer->frame;
  const SimWide *wide = sim_wide();
  bool lists = needs_lists(needs, has_class), density = needs & SIM_NEED_DENSITY;
  if (sim_grid_candidates(&frame->grid, SIM_SURFACE_REACH * 2 * frame->particle_radius) > SIM_MAX_CANDIDATES)
    return fail_crowded(frame, error);
  if (needs_order(needs, has_class)) split_positions(buffer);
  if (lists && !build_lists(buffer, wide, buffer->axis, error)) return false;
  SimSurface surface = surface_of(buffer, wide, buffer->axis, buffer->four, &buffer->lists);
  float *swept = density && lists ? buffer->density : NULL;
  if (!run_surface_stages(buffer, &surface, needs, has_class, swept, NULL, error)) return false;
  frame->density = density ? buffer->density : NULL;
  if (density && !lists)
    sim_surface_density(wide, &frame->grid, frame->position, frame->count, surface.spacing, buffer->density,
                        buffer->threads);
  if (density) sim_parallel_for(buffer->threads, frame->count, scale_kernel, buffer);
  return true;
}

const SimFrame *sim_frame_from_particles(const SimParticleSet *set, unsigned needs, int32_t threads,
                                         SimFrameBuffer *buffer, SimError *error) {
  if (!check_set(set, error)) return NULL;
  Arrays has = {set->id, set->velocity, needs & SIM_NEED_DENSITY, set->colour, set->radius};
  bool has_class = set->particle_class;
  if (!reserve_particles(buffer, set->count, has) ||
      (needs_order(needs, has_class) && !reserve_order(buffer, set->count)) ||
      !reserve_surface(buffer, set->count, needs, has_class))
    return sim_fail(error, "out of memory"), NULL;
  SimFrame *frame = &buffer->frame;
  buffer->threads = sim_parallel_threads(threads);
  *frame = (SimFrame){.index = set->index, .time = set->time, .count = set->count};
  frame->particle_radius =
      set->particle_radius > 0 ? set->particle_radius : sim_estimate_radius(set->position, set->count);
  if (!sort_set(set, buffer, error)) return NULL;
  bounds_of_set(set, frame);
  return measure_set(buffer, needs, has_class, error) ? frame : NULL;
}
